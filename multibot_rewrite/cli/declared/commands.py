# SPDX-License-Identifier: Apache-2.0
"""Every command line of the package: what it takes, what it is for, what its exit codes mean."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from multibot_rewrite.cli.declared.description import ADOPT, JOIN, LINT, POSTFIX, RENAME
from multibot_rewrite.cli.declared.fleet import BUILD, INIT, PLAN, REHEARSE, VIEW
from multibot_rewrite.cli.declared.graph import CHECK, CHECK_LAUNCH, SNAPSHOT
from multibot_rewrite.cli.declared.shared import (
    DISTRO,
    GENERAL,
    RESULT_OUTPUT,
    TRUST,
    VOCABULARY,
    Command,
    Example,
    OptionGroup,
    argument,
    form,
    output_group,
    path_option,
)

REPORT_FORMS = ("table", "json")

INSPECT = Command(
    "inspect",
    "inspect",
    "%(prog)s [CODE... | NAME | FILE] [NAME:=VALUE...] [options]",
    "Explain a finding, a plugin, a xacro, a fleet or a node.",
    (
        Example("multibot inspect MB202", "a finding: what it is, why, how to fix it"),
        Example("multibot inspect MB", "all rules of urdf-lint; MG: those of check"),
        Example("multibot inspect libgazebo_ros_diff_drive.so", "which of its values are names?"),
        Example("multibot inspect arm.urdf.xacro", "which argument goes into which names?"),
        Example("multibot inspect fleet.yaml", "what its launch files start, for whom"),
        Example("multibot inspect my_package/driver.py", "what a node does, by its source"),
        Example("multibot inspect --suggest rover.urdf -o acme.vocab", "draft what is missing"),
        Example("multibot inspect", "all that is known: plugins, then rules"),
    ),
    (
        OptionGroup(
            "input",
            (
                argument(
                    "words",
                    "NAME",
                    "a finding's code, its beginning, or its name; a library, class, element or"
                    " sensor type; a xacro file, and NAME:=VALUE for it; a fleet file",
                    "*",
                ),
                path_option(
                    "--suggest",
                    "write a file of plugin definitions, for the plugins of this description that"
                    " are not known; NAME:=VALUE is for xacro",
                ),
                VOCABULARY,
                DISTRO,
                TRUST,
            ),
        ),
        output_group(RESULT_OUTPUT, form(REPORT_FORMS, "how it is written")),
        GENERAL,
    ),
    "0 done; 2 wrong use, an unknown name, or a file that cannot be read",
    more="To find what an argument affects, the xacro is expanded again with another value for it.",
)

PROGRAMS = (POSTFIX, LINT)
COMMANDS: Mapping[str, Command] = MappingProxyType(
    {
        it.name: it
        for it in (
            ADOPT,
            BUILD,
            CHECK,
            CHECK_LAUNCH,
            INIT,
            INSPECT,
            JOIN,
            PLAN,
            REHEARSE,
            RENAME,
            SNAPSHOT,
            VIEW,
        )
    }
)
