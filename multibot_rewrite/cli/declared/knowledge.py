"""The commands about what is known: coverage, explain, help, vocabulary."""

from __future__ import annotations

from multibot_rewrite.cli import values
from multibot_rewrite.cli.declared.shared import DISTRO, GENERAL, RESULT_OUTPUT, TRUST, VOCABULARY
from multibot_rewrite.cli.options import (
    Command,
    Example,
    OptionGroup,
    argument,
    choice,
    form,
    output_group,
    value,
)

# Those of the vocabulary's grammar, which a help text does not import.
SECTION_TYPES = ("element", "plugin", "hardware", "sensor", "block")
REPORT_FORMS = ("table", "json")

ARGUMENTS = Command(
    "arguments",
    "arguments",
    "%(prog)s FILE.xacro [NAME:=VALUE...] [options]",
    "Show which argument of a xacro goes into which names, as a prefix or namespace of a robot does.",
    (
        Example("multibot arguments arm.urdf.xacro"),
        Example("multibot arguments ur.urdf.xacro name:=ur ur_type:=ur5e", "some have no default"),
    ),
    (
        OptionGroup(
            "input",
            (
                argument("words", "FILE.xacro", "a xacro; NAME:=VALUE are arguments of it", "*"),
                VOCABULARY,
                DISTRO,
                TRUST,
            ),
        ),
        output_group(RESULT_OUTPUT, form(REPORT_FORMS, "how it is written")),
        GENERAL,
    ),
    "0 done; 2 wrong use or unreadable input",
    more="The file is expanded once for each argument, with another word as its value.",
)
COVERAGE = Command(
    "coverage",
    "coverage",
    "%(prog)s PATH... [NAME:=VALUE...] [options]",
    "Show how much of a set of descriptions is known, and what is not.",
    (
        Example("multibot coverage urdf/", "every .urdf and .sdf below it"),
        Example("multibot coverage urdf/ --min-known 95", "in CI"),
        Example("multibot coverage urdf/ --form json -o coverage.json"),
    ),
    (
        OptionGroup(
            "input",
            (
                argument("words", "PATH", "files and folders; NAME:=VALUE is for xacro", "+"),
                VOCABULARY,
                DISTRO,
                TRUST,
                value(
                    "--explained",
                    metavar="FILE",
                    about="mentions that are right: tag path, tab, reason in each line",
                ),
            ),
        ),
        output_group(
            RESULT_OUTPUT,
            form(REPORT_FORMS, "how it is written"),
            value(
                "--top",
                metavar="N",
                about="rows in each table; default: 20; 0 is all",
                type=values.count,
                default=20,
            ),
            value(
                "--min-known",
                metavar="PERCENT",
                about="fail where fewer plugins are known",
                type=values.percent,
            ),
        ),
        GENERAL,
    ),
    "0 done; 1 less is known than asked for, or (with --explained) a mention is unexplained; 2 wrong"
    " use, or nothing could be read",
    more="Folders are searched for *.urdf and *.sdf; name a xacro file itself.",
)

EXPLAIN = Command(
    "explain",
    "explain",
    "%(prog)s CODE... [options]",
    "Explain the code of a finding: what it is, why it matters, how to fix it.",
    (
        Example("multibot explain MB202"),
        Example("multibot explain undeclared-link", "by its name"),
        Example("multibot explain MB2", "every code that begins so"),
        Example("multibot explain", "list all"),
    ),
    (
        OptionGroup("input", (argument("codes", "CODE", "codes, how they begin, or names", "*"),)),
        output_group(RESULT_OUTPUT),
        GENERAL,
    ),
    "0 done; 2 an unknown code",
)
HELP = Command(
    "help",
    "help_text",
    "%(prog)s [COMMAND]",
    "Show the help of a command.",
    (Example("multibot help remap"),),
    (
        OptionGroup("input", (argument("words", "COMMAND", "default: the list of commands", "*"),)),
        GENERAL,
    ),
    "0 done; 2 an unknown command",
)
VOCABULARY_LOOKUP = Command(
    "vocabulary",
    "vocabulary",
    "%(prog)s [NAME] [options]",
    "Show what is known of a plugin, hardware class or element.",
    (
        Example("multibot vocabulary", "all sections"),
        Example("multibot vocabulary libgazebo_ros_diff_drive.so"),
        Example("multibot vocabulary --suggest rover.urdf -o acme.vocab"),
    ),
    (
        OptionGroup(
            "input",
            (
                argument("words", "NAME", "a library, class, element or sensor type", "*"),
                choice("--type", "TYPE", SECTION_TYPES, f"only one of {', '.join(SECTION_TYPES)}"),
                value(
                    "--suggest",
                    metavar="FILE",
                    about="write a vocabulary file for what this description loads and nothing"
                    " knows; NAME:=VALUE is for xacro",
                    type=values.path,
                ),
                VOCABULARY,
                DISTRO,
                TRUST,
            ),
        ),
        output_group(RESULT_OUTPUT, form(REPORT_FORMS, "how it is written")),
        GENERAL,
    ),
    "0 done; 2 wrong use, an unknown name or unreadable input",
)
