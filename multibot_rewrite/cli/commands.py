"""Every command line of the package: what it takes, what it is for, what its exit codes mean."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from multibot_rewrite.cli import values
from multibot_rewrite.cli.options import (
    FINDINGS,
    GENERAL,
    LIVE,
    NAMING,
    ROBOTS,
    URDF,
    VOCABULARY,
    Command,
    Example,
    Group,
    Option,
    argument,
    choice,
    form,
    output,
    several,
    switch,
    value,
)
from multibot_rewrite.findings.finding import ERROR

# What `multibot remap --form` and `multibot vocabulary --type` take; tests hold them against the
# modules that do it, which a help text does not import.
REMAP_FORMS = ("table", "ros-args", "launch", "yaml", "json", "gazebo", "markdown", "bridge")
SECTION_TYPES = ("element", "plugin", "hardware", "sensor", "block")
REPORT_FORMS = ("table", "json")
PICTURES = ("report", "mermaid", "dot")

_EXPLAIN = value(
    "--explain", metavar="CODE", about="explain a finding's code, as multibot explain does"
)
_FINDINGS_OUTPUT = output("write the findings there, not to standard output")

POSTFIX = Command(
    "urdf-postfix",
    "rewrite",
    "%(prog)s INPUT ROBOT... [NAME:=VALUE...] [options]",
    "Rewrite a robot description for one robot or many, and prove nothing was missed.",
    (
        Example("urdf-postfix rover.urdf robot1", "to standard output"),
        Example("urdf-postfix rover.urdf robot1 -o robot1.urdf"),
        Example("urdf-postfix rover.urdf.xacro robot1 robot2 -o 'out/{robot}.urdf' use_sim:=true"),
        Example("urdf-postfix rover.urdf robot1 --layout frames-per-robot --affix prefix"),
        Example("urdf-postfix rover.urdf left --affix prefix --separator _", "left_base_link"),
        Example("urdf-postfix rover.srdf robot1 --urdf rover.urdf", "an SRDF with its URDF"),
        Example("urdf-postfix robot1.urdf robot1 --strip", "undo it"),
        Example("urdf-postfix --why rover.urdf:34", "why is this (not) renamed?"),
        Example("cat rover.urdf | urdf-postfix - robot1 --diff"),
    ),
    (
        Group(
            "input",
            (
                argument("input", "INPUT", "URDF, SDF model, SRDF, xacro of one, or -", "?"),
                argument("words", "ROBOT", "names of robots; NAME:=VALUE is for xacro", "*"),
                ROBOTS,
                URDF,
                VOCABULARY,
            ),
        ),
        Group(
            "output",
            (
                output("write the result there; {robot} stands for the robot's name"),
                switch("--in-place", about="write the result over the input file"),
                switch("--diff", about="print a unified diff instead of the result"),
                value(
                    "--changes",
                    metavar="FILE",
                    about="write every change as JSON",
                    type=values.path,
                ),
            ),
        ),
        Group(
            "other jobs",
            (
                switch("--strip", about="undo a rewrite; give the options it was made with"),
                switch("--again", about="rewrite although it was rewritten for this robot"),
                value(
                    "--why",
                    metavar="FILE:LINE",
                    about="show which rule reads the values in that line, and why",
                ),
                _EXPLAIN,
            ),
        ),
        NAMING,
        FINDINGS,
        GENERAL,
    ),
    "0 done; 1 findings at the level of --fail-on, nothing was written; 2 wrong use or unreadable"
    " input",
    more="Findings go to standard error; with a --format other than text they go to standard output,"
    " and the result needs -o or --in-place.",
    fail_on=ERROR,
)

LINT = Command(
    "urdf-lint",
    "lint",
    "%(prog)s PATH... [NAME:=VALUE...] [options]",
    "Find what is wrong with robot descriptions, alone and among other robots.",
    (
        Example("urdf-lint urdf/", "every .urdf, .xacro and .srdf below it"),
        Example("urdf-lint rover.urdf --select MB2,MB5", "references and structure only"),
        Example("urdf-lint rover.urdf.xacro sim:=gz", "with xacro arguments, too"),
        Example("urdf-lint rover.urdf --robots robot1,robot2 --layout frames-per-robot"),
        Example("urdf-lint urdf/ --format sarif -o out/lint.sarif"),
        Example("urdf-lint rover.urdf --fix --diff", "show what --fix would change"),
        Example("urdf-lint --explain MB202"),
    ),
    (
        Group(
            "input",
            (
                argument("words", "PATH", "files, folders, or -; NAME:=VALUE is for xacro", "*"),
                value(
                    "--config",
                    metavar="FILE",
                    about="urdf-lint.toml or pyproject.toml; default: the nearest one above",
                ),
                value(
                    "--changed-since", metavar="REV", about="only files that git shows as changed"
                ),
                several("--roots", "A,B", "folders to look for package://NAME and $(find NAME) in"),
                URDF,
                VOCABULARY,
            ),
        ),
        Group(
            "output",
            (
                _FINDINGS_OUTPUT,
                switch("--fix", about="apply the safe fixes"),
                switch("--diff", about="with --fix: print what would change, write nothing"),
            ),
        ),
        Group(
            "checks",
            (
                ROBOTS,
                several("--target", "A,B", "names must suit these formats, too: usd, mjcf"),
                value("--baseline", metavar="FILE", about="report only findings not in FILE"),
                value(
                    "--write-baseline",
                    metavar="FILE",
                    about="write today's findings, for --baseline",
                    type=values.path,
                ),
                value(
                    "--jobs",
                    metavar="N",
                    about="processes; default: one for each processor",
                    type=values.count,
                ),
            ),
        ),
        NAMING,
        FINDINGS,
        Group("rules", (_EXPLAIN, switch("--list-rules", about="list all rules"))),
        GENERAL,
    ),
    "0 nothing found (notes do not count); 1 findings; 2 wrong use, nothing to lint, or a rule that"
    " crashed",
    findings_first=True,
)

_DESCRIPTION = Group(
    "input",
    (
        argument("input", "INPUT", "the robot's description before any rewrite, or a fleet file"),
        argument("words", "ROBOT", "names of robots; NAME:=VALUE is for xacro", "*"),
        ROBOTS,
        several("--stack", "NAME", "nodes that every robot runs (docs/stacks.md)", []),
        value("--nodes", metavar="FILE", about="your own nodes and stacks, YAML", type=values.path),
        VOCABULARY,
    ),
)
_FLEET_FILE = "A fleet file (*.yaml) has its own robots, stacks and layout."
_TABLE_CODES = "0 done; 1 findings at the level of --fail-on; 2 wrong use or unreadable input"
_LIVE_CODES = (
    "0 as planned; 1 findings at the level of --fail-on; 2 wrong use or unreadable input;"
    " 3 inconclusive: the view may be incomplete; 4 rclpy or its RMW is missing or does not start"
)
_BESIDE = (
    " Findings go to standard error; with a --format other than text they go to standard output, and"
    " the result needs -o."
)
_PICTURES = Group(
    "pictures",
    (
        value(
            "--report", metavar="FILE", about="write a page to look at, one HTML file",
            type=values.path,
        ),
        value(
            "--mermaid", metavar="FILE", about="write a flowchart for a page of Markdown",
            type=values.path,
        ),
        value("--dot", metavar="FILE", about="write a graph for Graphviz", type=values.path),
    ),
)  # fmt: skip


def _output_group(*options: Option) -> Group:
    return Group("output", options)


_RESULT = output("write the result there, not to standard output")

BUILD = Command(
    "build",
    "build",
    "%(prog)s FLEET -o FOLDER [options]",
    "Make everything a fleet needs from its fleet file.",
    (
        Example("multibot build fleet.yaml -o out/", "everything, one folder a robot"),
        Example("multibot build fleet.yaml -o out/ --check", "in CI: what is stale?"),
    ),
    (
        Group("input", (argument("fleet", "FLEET", "the fleet file, YAML"),)),
        _output_group(
            output("write everything into that folder", required=True),
            switch("--check", about="list what is stale, write nothing"),
            switch("--force", about="overwrite files that no build made"),
        ),
        FINDINGS,
        GENERAL,
    ),
    "0 done; 1 findings at the level of --fail-on, nothing was written, or with --check something is"
    " stale; 2 wrong use or unreadable input",
    fail_on=ERROR,
)
CHECK = Command(
    "check",
    "check",
    "%(prog)s PLAN [options]",
    "Compare the running system with its plan.",
    (
        Example("multibot check plan.yaml", "the graph that runs now"),
        Example("multibot check plan.yaml --watch", "show every change until Ctrl-C"),
        Example("multibot check plan.yaml --snapshot graph.json", "a saved graph; needs no ROS"),
        Example("multibot check plan.yaml --format junit -o check.xml", "in CI"),
    ),
    (
        Group(
            "input",
            (
                argument("plan", "PLAN", "what multibot plan wrote, or a fleet file"),
                value(
                    "--snapshot",
                    metavar="FILE",
                    about="what multibot snapshot wrote, instead of the live graph",
                    type=values.path,
                ),
            ),
        ),
        _output_group(
            _FINDINGS_OUTPUT,
            switch("--watch", about="show every change until Ctrl-C or --timeout"),
        ),
        _PICTURES,
        LIVE,
        FINDINGS,
        GENERAL,
    ),
    f"{_LIVE_CODES}. With --watch it is the worst that was seen; what was missing before everything"
    " was there once does not count",
    fail_on=ERROR,
    findings_first=True,
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
        Group(
            "input",
            (
                argument("words", "PATH", "files and folders; NAME:=VALUE is for xacro", "+"),
                VOCABULARY,
                value(
                    "--explained",
                    metavar="FILE",
                    about="mentions that are right: tag path, tab, reason in each line",
                ),
            ),
        ),
        _output_group(
            _RESULT,
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
        Group("input", (argument("codes", "CODE", "codes, how they begin, or names", "*"),)),
        _output_group(_RESULT),
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
        Group("input", (argument("words", "COMMAND", "default: the list of commands", "*"),)),
        GENERAL,
    ),
    "0 done; 2 an unknown command",
)
LEARN = Command(
    "learn",
    "learn",
    "%(prog)s [options]",
    "Make a file of nodes and stacks, for remap and plan, from nodes that are running now.",
    (
        Example("multibot learn --node /my_driver,/my_planner --stack mine -o mine.yaml"),
        Example("multibot learn --namespace /robot1 --stack mine -o mine.yaml", "a whole robot"),
        Example("multibot learn --snapshot graph.json --stack mine", "needs no ROS"),
        Example("multibot remap rover.urdf robot1 robot2 --nodes mine.yaml --stack mine"),
    ),
    (
        Group(
            "input",
            (
                several(
                    "--node",
                    "NODE",
                    "full names of nodes; default: all but tools",
                    [],
                    values.full_names,
                ),
                value(
                    "--namespace",
                    metavar="NS",
                    about="the robot's namespace, which its nodes are in",
                    type=values.full_name,
                ),
                value(
                    "--snapshot",
                    metavar="FILE",
                    about="what multibot snapshot wrote, instead of the live graph",
                    type=values.path,
                ),
            ),
        ),
        _output_group(
            _RESULT,
            value(
                "--stack",
                metavar="NAME",
                about="name of the new stack; default: learned",
                type=values.word,
                default="learned",
            ),
        ),
        LIVE,
        GENERAL,
    ),
    "0 done; 2 wrong use, unreadable input, or a node that is not there or there twice; 3 the view"
    " may be incomplete, what is seen is written all the same; 4 rclpy or its RMW is missing or does"
    " not start",
)
PLAN = Command(
    "plan",
    "plan",
    "%(prog)s INPUT ROBOT... [NAME:=VALUE...] [options]",
    "Write what the ROS graph of a fleet should look like, for multibot check.",
    (
        Example("multibot plan fleet.yaml -o plan.yaml"),
        Example("multibot plan rover.urdf robot1 robot2 --stack nav2 -o plan.yaml"),
    ),
    (_DESCRIPTION, _output_group(_RESULT), NAMING, FINDINGS, GENERAL),
    _TABLE_CODES,
    more=_FLEET_FILE + _BESIDE,
    fail_on=ERROR,
)
REHEARSE = Command(
    "rehearse",
    "rehearse",
    "%(prog)s INPUT ROBOT... [NAME:=VALUE...] [options]",
    "Try the plan of a fleet on a real ROS graph, without robot or simulator.",
    (
        Example("multibot rehearse rover.urdf robot1 robot2 --stack nav2"),
        Example("multibot rehearse rover.urdf robot1 robot2 --stack nav2 --report nav2.html"),
        Example(
            "multibot rehearse rover.urdf robot1 robot2 --stack nav2 --without-rules",
            "which names would collide?",
        ),
    ),
    (
        _DESCRIPTION,
        _output_group(
            _FINDINGS_OUTPUT,
            value(
                "--save-snapshot",
                metavar="FILE",
                about="write the graph that came up, as multibot snapshot does",
                type=values.path,
            ),
        ),
        Group(
            "rehearsal",
            (switch("--without-rules", about="start nodes with namespace and name alone"),),
        ),
        _PICTURES,
        LIVE,
        NAMING,
        FINDINGS,
        GENERAL,
    ),
    _LIVE_CODES,
    more=_FLEET_FILE + " Starts a stub for every node of each robot's plugins and stack with the"
    " names of its code, applies the rules of multibot remap, and looks at the graph as multibot"
    " check does. A type that is not installed is replaced. robot_state_publisher is added where no"
    " stack has it.",
    fail_on=ERROR,
    findings_first=True,
)
REMAP = Command(
    "remap",
    "remap",
    "%(prog)s INPUT ROBOT... [NAME:=VALUE...] [options]",
    "List what every node of every robot must be remapped to.",
    (
        Example("multibot remap rover.urdf robot1 robot2 --stack nav2 --layout frames-per-robot"),
        Example("multibot remap rover.urdf robot1 --stack nav2,slam_toolbox --form ros-args"),
        Example("multibot remap rover.urdf robot1 robot2 --form launch -o remaps.py"),
    ),
    (
        _DESCRIPTION,
        _output_group(
            _RESULT,
            form(
                REMAP_FORMS,
                "how rules are written (launch is for launch_ros, bridge for ros_gz_bridge)",
            ),
        ),
        NAMING,
        FINDINGS,
        GENERAL,
    ),
    _TABLE_CODES,
    more=_FLEET_FILE + _BESIDE,
    fail_on=ERROR,
)
SNAPSHOT = Command(
    "snapshot",
    "snapshot",
    "%(prog)s [options]",
    "Show what runs in the ROS graph now: nodes, endpoints, tf, environment.",
    (
        Example("multibot snapshot", "a table"),
        Example(
            "multibot snapshot -o graph.json --expect /robot1/amcl", "JSON, for multibot check"
        ),
    ),
    (
        _output_group(
            output("write JSON there (- is standard output), not a table"),
        ),
        LIVE._replace(
            options=(
                several(
                    "--expect", "NODE", "stop when these nodes are there", [], values.full_names
                ),
                several(
                    "--topic", "TOPIC", "look up QoS of these topics, too", [], values.full_names
                ),
                *LIVE.options,
            )
        ),
        GENERAL,
    ),
    "0 done; 2 wrong use; 3 something may be missing in the view, which is written all the same;"
    " 4 rclpy or its RMW is missing or does not start",
    more="The graph is settled when all of --expect are seen, or nothing changed for 3.5 s.",
)
VOCABULARY_COMMAND = Command(
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
        Group(
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
            ),
        ),
        _output_group(_RESULT, form(REPORT_FORMS, "how it is written")),
        GENERAL,
    ),
    "0 done; 2 wrong use, an unknown name or unreadable input",
)

COMMANDS: Mapping[str, Command] = MappingProxyType(
    {
        it.name: it
        for it in (
            BUILD,
            CHECK,
            COVERAGE,
            EXPLAIN,
            HELP,
            LEARN,
            PLAN,
            REHEARSE,
            REMAP,
            SNAPSHOT,
            VOCABULARY_COMMAND,
        )
    }
)
