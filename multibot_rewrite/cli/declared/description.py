# SPDX-License-Identifier: Apache-2.0
"""``urdf-postfix`` and ``urdf-lint``."""

from __future__ import annotations

from multibot_rewrite.base.findings.finding import ERROR
from multibot_rewrite.base.naming import WORLD_SYSTEMS
from multibot_rewrite.cli.declared.shared import (
    COUNT,
    DISTRO,
    EVERYTHING,
    FINDINGS,
    FINDINGS_OUTPUT,
    GENERAL,
    NAMING,
    ROBOTS,
    ROOTS,
    TRUST,
    URDF,
    VOCABULARY,
    Command,
    Example,
    OptionGroup,
    argument,
    choice,
    each,
    form,
    output,
    path_option,
    several,
    switch,
    value,
)

POSTFIX_FORMS = ("description", "changes")
IN_PLACE = switch("--in-place", about="write the result over the input")
POSTFIX = Command(
    "urdf-postfix",
    "rewrite",
    "%(prog)s INPUT ROBOT... [NAME:=VALUE...] [options]",
    "Put a robot's name into all names that robots must not share, and verify it.",
    (
        Example("urdf-postfix rover.urdf robot1", "to standard output"),
        Example("urdf-postfix rover.urdf robot1 -o robot1.urdf"),
        Example("urdf-postfix rover.urdf.xacro robot1 robot2 -o 'out/{robot}.urdf' use_sim:=true"),
        Example(
            "urdf-postfix arm.urdf.xacro left right -o 'out/{robot}.urdf' tf_prefix:='{robot}_'",
            "an argument of its own",
        ),
        Example("urdf-postfix rover.urdf robot1 --layout frames-per-robot --affix prefix"),
        Example("urdf-postfix rover.urdf -n 3 -o 'out/{robot}.urdf'", "robot1, robot2, robot3"),
        Example("urdf-postfix rover.urdf left --affix prefix --separator _", "left_base_link"),
        Example("urdf-postfix rover.srdf robot1 --urdf rover.urdf", "an SRDF with its URDF"),
        Example("urdf-postfix nav2_params.yaml robot1 --urdf rover.urdf", "or RViz, MoveIt"),
        Example("urdf-postfix robot1.urdf robot1 --undo", "undo it, with the same options"),
        Example("urdf-postfix --why rover.urdf:34", "why is this (not) renamed?"),
        Example("cat rover.urdf | urdf-postfix - robot1 --diff"),
    ),
    (
        OptionGroup(
            "input",
            (
                argument(
                    "input",
                    "INPUT",
                    "URDF, SDF, SRDF or xacro; a related file (with --urdf); or - for standard input",
                    "?",
                ),
                argument(
                    "words",
                    "ROBOT",
                    "names of robots; NAME:=VALUE is for xacro, with {robot} for the robot's name",
                    "*",
                ),
                ROBOTS,
                COUNT,
                URDF,
                VOCABULARY,
                DISTRO,
                TRUST,
            ),
        ),
        OptionGroup(
            "output",
            (
                output("write it there; {robot} is the robot's name, FOLDER/ its {robot}/NAME"),
                IN_PLACE,
                choice(
                    "--world-systems",
                    "HOW",
                    WORLD_SYSTEMS,
                    "Gazebo systems of the whole world, such as Sensors: keep them (default for one"
                    " robot); or leave them out, so that the world loads each once (default for"
                    " several)",
                ),
                switch("--diff", about="print a unified diff instead of the result"),
                form(POSTFIX_FORMS, "the result, or every change for every robot as JSON"),
            ),
        ),
        OptionGroup(
            "other jobs",
            (
                switch(
                    "--undo",
                    about="remove the robot's name again; give the options that put it there",
                ),
                path_option(
                    "--xacro",
                    "with --undo: the xacro whose arguments (NAME:=VALUE) put the robot's name"
                    " into names; these stay",
                ),
                switch("--force", about="rewrite again a file that has this robot's name"),
                value(
                    "--why",
                    metavar="FILE:LINE",
                    about="show which rule reads the values in that line, and why",
                ),
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
    "Find faults of robot descriptions, and what several robots would share.",
    (
        Example("urdf-lint urdf/", "descriptions, SRDF, parameters, RViz, MoveIt"),
        Example("urdf-lint rover.urdf --select MB2,MB5", "references and structure only"),
        Example("urdf-lint rover.urdf.xacro sim:=gz", "with xacro arguments, too"),
        Example("urdf-lint rover.urdf --robots robot1,robot2 --layout frames-per-robot"),
        Example("urdf-lint urdf/ --format sarif -o out/lint.sarif"),
        Example("urdf-lint rover.urdf --fix --diff", "show what --fix would change"),
        Example("multibot inspect MB202", "what a finding is, why, the fix"),
        Example("multibot inspect MB", "all rules"),
    ),
    (
        OptionGroup(
            "input",
            (
                argument(
                    "words",
                    "PATH",
                    "files, folders, or - for standard input; NAME:=VALUE is for xacro",
                    "*",
                ),
                value(
                    "--config",
                    metavar="FILE",
                    about="urdf-lint.toml or pyproject.toml; default: the nearest one above",
                ),
                value(
                    "--changed-since",
                    metavar="REV",
                    about="only files that changed since a git revision",
                ),
                EVERYTHING,
                ROOTS._replace(keywords={**ROOTS.keywords, "default": None}),
                URDF,
                VOCABULARY,
                DISTRO,
                TRUST,
            ),
        ),
        OptionGroup(
            "output",
            (
                FINDINGS_OUTPUT,
                switch("--fix", about="apply the safe fixes"),
                switch("--diff", about="with --fix: print what would change, write nothing"),
            ),
        ),
        OptionGroup(
            "checks",
            (
                ROBOTS,
                several("--target", "A,B", "also check what is lost in these formats: mjcf"),
                value("--baseline", metavar="FILE", about="report only findings not in FILE"),
                path_option("--write-baseline", "write the current findings, for --baseline"),
            ),
        ),
        NAMING,
        FINDINGS,
        GENERAL,
    ),
    "0 nothing found (notes do not count); 1 findings; 2 wrong use, nothing to lint, or a rule that"
    " crashed",
    findings_first=True,
)

RENAME = Command(
    "rename",
    "rename",
    "%(prog)s OLD NEW FOLDER [NAME:=VALUE...] [options]",
    "Rename a link, joint, frame or topic in a package's own files.",
    (
        Example("multibot rename base_footprint base_ground my_robot_description --kind link"),
        Example("multibot rename wheel_l left_wheel src/ --kind joint --diff", "look first"),
    ),
    (
        OptionGroup(
            "input",
            (
                argument("old", "OLD", "the name as it is in the expanded description"),
                argument("new", "NEW", "the name that it gets"),
                argument("folder", "FOLDER", "the package, or a folder of packages"),
                argument("words", "NAME:=VALUE", "arguments that its xacros need", "*"),
                choice(
                    "--kind",
                    "KIND",
                    ("link", "joint", "frame", "topic"),
                    "what it names; default: link",
                    default="link",
                ),
                VOCABULARY,
                DISTRO,
                TRUST,
            ),
        ),
        OptionGroup(
            "output",
            (
                switch("--diff", about="print a patch and change nothing"),
                output("write the patch there"),
            ),
        ),
        GENERAL,
    ),
    "0 done; 2 wrong use, a name that is not there or taken, or one that cannot be changed alone",
    more="It changes the xacro files that make the name, plain descriptions, SRDFs, parameters, RViz"
    " configs, bridges, MoveIt's files and behavior trees. It changes all of them, or none.",
)
ADOPT = Command(
    "adopt",
    "adopt",
    "%(prog)s FOLDER [NAME:=VALUE...] [options]",
    "Give a description package a prefix and a namespace.",
    (
        Example("multibot adopt my_robot_description", "print the patch"),
        Example("multibot adopt my_robot_description --in-place"),
    ),
    (
        OptionGroup(
            "input",
            (
                argument("folder", "FOLDER", "the package, or a folder of packages"),
                argument("words", "NAME:=VALUE", "arguments that its xacros need", "*"),
                VOCABULARY,
                DISTRO,
                TRUST,
            ),
        ),
        OptionGroup("output", (output("write the patch there"), IN_PLACE)),
        GENERAL,
    ),
    "0 done; 2 wrong use, or no place for the prefix that changes nothing else",
    more="It checks each description twice. With an empty prefix the result is what it was. With"
    " prefix:=robot1_ every link, joint, frame, sensor and name of ros2_control begins with it."
    " With namespace:=robot1 plugins and sensors are in that. Launch files hand both on.",
)
JOIN = Command(
    "join",
    "join",
    "%(prog)s FILE [NAME:=VALUE...] FILE... --at LINK [options]",
    "Join robot descriptions: a gripper on an arm, an arm on a base.",
    (
        Example("multibot join arm.urdf gripper.urdf --at tool0 -o robot.urdf"),
        Example("multibot join arm.urdf hand.urdf --at tool0 --prefix hand_"),
        Example('multibot join base.urdf arm.urdf --at plate --pose "0.2 0 0 0 0 1.57"'),
        Example("multibot join robot.urdf.join -o robot.urdf", "parts listed in a file"),
        Example(
            "multibot join base.urdf arm.urdf.xacro type:=ur5e arm.urdf.xacro type:=ur3e"
            " --at left_plate --at right_plate --prefix left_ --prefix right_",
            "two arms on a base",
        ),
        Example("multibot join robot.urdf --undo -o parts/", "the parts again, byte by byte"),
    ),
    (
        OptionGroup(
            "input",
            (
                argument(
                    "words",
                    "FILE",
                    "the first part, then those that are fixed to it or to one before;"
                    " NAME:=VALUE behind a xacro is for it",
                    "+",
                ),
                VOCABULARY,
                DISTRO,
                TRUST,
            ),
        ),
        OptionGroup(
            "parts, once for each behind the first, in their order",
            (
                each("--at", "LINK", "the link that it is fixed to, by its name in the result"),
                each("--pose", "POSE", '"x y z roll pitch yaw" of its root there; metres, radians'),
                each("--prefix", "WORD", "what goes before its names, such as left_"),
            ),
        ),
        OptionGroup(
            "output",
            (
                output("write the result there; with --undo a folder"),
                switch("--undo", about="write the parts of a joined FILE again"),
            ),
        ),
        GENERAL,
    ),
    "0 done; 2 wrong use, a file that cannot be read, or parts that cannot be joined",
    more="Each run checks that every part can be taken out of the result as it was, and that no joint"
    " inside a part has changed. Names that two parts have are refused: give one a --prefix."
    "\n\nA .join file has all of it as YAML, and every command that takes a description takes one. It"
    " joins files beside, too: a part may have srdf, controllers, moveit and rviz (docs/package.md):"
    "\n\n  join:\n    - {description: arm.urdf}\n"
    "    - {description: hand.urdf, prefix: hand_, at: {parent: tool0, pose: {z: 0.1}}}",
)
