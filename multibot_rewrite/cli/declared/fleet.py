# SPDX-License-Identifier: Apache-2.0
"""The commands about a fleet: build, init, plan, rehearse, view."""

from __future__ import annotations

from multibot_rewrite.base.findings.finding import ERROR
from multibot_rewrite.base.naming import LAYOUTS
from multibot_rewrite.cli import values
from multibot_rewrite.cli.declared.shared import (
    COUNT,
    DISTRO,
    FINDINGS,
    FINDINGS_OUTPUT,
    FROM,
    GENERAL,
    KNOWN_NODES,
    LAYOUT_NAMES,
    LIVE,
    LIVE_CODES,
    NAMING,
    PICTURES,
    ROBOTS,
    ROOTS,
    TRUST,
    VOCABULARY,
    Command,
    Example,
    Option,
    OptionGroup,
    argument,
    choice,
    form,
    output,
    output_group,
    path_option,
    repeated,
    several,
    switch,
)

# The plan, and besides those of ``spelling.table_formats``, which a help text does not import.
PLAN_FORMS = ("plan", "table", "ros-args", "launch", "yaml", "json", "gazebo", "bridge", "sros2")
# Those of ``spelling.ways``.
EVERY_WAY = "all"
WAYS = ("process", "host", "component", "spawner", "plugin")

_DESCRIPTION = OptionGroup(
    "input",
    (
        argument("input", "INPUT", "the robot's description before any rewrite, or a fleet file"),
        argument("words", "ROBOT", "names of robots; NAME:=VALUE is for xacro", "*"),
        ROBOTS,
        COUNT,
        several(
            "--stack",
            "NAME",
            "nodes that every robot runs besides robot_state_publisher (docs/stacks.md)",
            [],
        ),
        *KNOWN_NODES,
        repeated(
            "--launch",
            "'[PACKAGE] FILE NAME:=VALUE...'",
            "a launch file that starts each robot's nodes, with its arguments, as ros2 launch takes it,"
            " or a system_model.yaml; it is read, nothing is started (docs/launch.md)",
        ),
        ROOTS,
        VOCABULARY,
        DISTRO,
        TRUST,
    ),
)
_FLEET_FILE = "A fleet file (*.yaml) has its own robots, stacks and layout."
_FLEET_TEXT = """\
A fleet file, as multibot init writes it; only robots is required (docs/fleet-file.md):

  layout: frames-per-robot
  description: rover.urdf
  companions: {params: params.yaml, rviz: one_robot.rviz}   # files for one robot
  robots:
    - {name: robot1, pose: {x: 0.0, y: 0.0}}
    - {name: robot2, pose: {x: 0.0, y: 2.0}}

A build writes these files for every robot. It writes one RViz config for all robots if their\
 frames differ. Then ros2 launch out/fleet.launch.py starts the robots, and multibot check\
 out/plan.yaml checks whether they run as planned."""
_FLEET = Option(
    ("fleet",),
    "the fleet file; default: fleet.yaml",
    {"metavar": "FLEET", "nargs": "?", "default": "fleet.yaml"},
)
_FIRST = (
    "number of robots: the first ones of the file, or more like the last one; default: all of them"
)
_TABLE_CODES = "0 done; 1 findings at the level of --fail-on; 2 wrong use or unreadable input"
_BESIDE = (
    " Findings go to standard error; with a --format other than text they go to standard output, and"
    " the result needs -o."
)
INIT = Command(
    "init",
    "init",
    "%(prog)s [PATH...] [-n COUNT] [-o FLEET] [options]",
    "Write a first fleet file from robot descriptions or packages.",
    (
        Example("multibot init rover.urdf", "two robots of one description"),
        Example("multibot init -n 3 my_robot_ws/src", "search packages; three robots"),
        Example("multibot init arm.urdf.xacro rover.urdf --yes", "no questions"),
        Example("multibot init ur.urdf.xacro name:=ur ur_type:=ur5e", "arguments of the xacro"),
    ),
    (
        OptionGroup(
            "input",
            (
                argument(
                    "words",
                    "PATH",
                    "descriptions (URDF, xacro, SDF) and folders with packages; default: the working"
                    " directory; NAME:=VALUE is for xacro",
                    "*",
                ),
                TRUST,
            ),
        ),
        OptionGroup(
            "answers, asked for on a terminal if not given",
            (
                COUNT._replace(help="number of robots of each description (default: 2)"),
                ROBOTS,
                choice(
                    "--layout",
                    "NAME",
                    LAYOUT_NAMES,
                    f"{', '.join(it.name for it in LAYOUTS)}; default: what the files fit",
                ),
                choice(
                    "--simulator",
                    "NAME",
                    ("none", "gazebo"),
                    "none or gazebo; default: the simulator of the plugins",
                ),
                DISTRO,
                switch("-y", "--yes", about="ask nothing, take the defaults"),
            ),
        ),
        output_group(
            output("the fleet file; default: fleet.yaml; - prints it", default="fleet.yaml"),
            switch("--force", about="overwrite files that no build made"),
        ),
        GENERAL,
    ),
    "0 done, and it builds; 1 written, but it does not build yet; 2 wrong use, unreadable input, or "
    "no way to tell which of several robots is meant",
    more="The fleet file gives a reason for each key. Each choice is tried with a build in memory: if"
    " a layout does not work, the first one that works is taken. Editors complete and check the keys by"
    " .fleet.schema.json, which is written beside the fleet file.",
)
BUILD = Command(
    "build",
    "build",
    "%(prog)s [FLEET] [-o FOLDER] [options]",
    "Write all files that the robots of a fleet file need.",
    (
        Example("multibot build fleet.yaml", "into out/, with a folder for each robot"),
        Example("multibot build fleet.yaml --check", "for CI: report outdated files"),
        Example("multibot build --undo", "remove what a build wrote into out/"),
    ),
    (
        OptionGroup("input", (_FLEET, COUNT._replace(help=_FIRST), DISTRO, TRUST)),
        output_group(
            output("write everything into that folder; default: out/", default="out/"),
            switch(
                "--undo",
                about="remove the files that the last build wrote; those that were edited need --force",
            ),
            switch("--check", about="list files that are out of date, write nothing"),
            switch("--force", about="overwrite files that no build made"),
        ),
        FINDINGS,
        GENERAL,
    ),
    "0 done; 1 findings at the level of --fail-on, nothing was written, or with --check a file is"
    " out of date; 2 wrong use or unreadable input",
    more=_FLEET_TEXT,
    fail_on=ERROR,
)
PLAN = Command(
    "plan",
    "plan",
    "%(prog)s INPUT [ROBOT...] [NAME:=VALUE...] [options]",
    "Write the ROS graph that a fleet should have, or remap rules.",
    (
        Example("multibot plan fleet.yaml -o plan.yaml", "for multibot check"),
        Example("multibot plan fleet.yaml --form table | grep amcl", "the remap rules of a node"),
        Example("multibot plan rover.urdf robot1 --stack nav2,slam_toolbox --form ros-args"),
        Example("multibot plan fleet.yaml --form sros2 -o policy.xml", "docs/security.md"),
        Example("multibot plan my_bringup two.launch.py -o plan.yaml", "what a launch file starts"),
    ),
    (
        _DESCRIPTION,
        output_group(
            output(
                "write it there, not to standard output; a plan is YAML to read and edit; if FILE"
                " ends in .json, it is JSON, which is read ten times faster"
            ),
            form(
                PLAN_FORMS,
                "plan: for multibot check; remap rules of each node: table, ros-args (lines for a"
                " shell), launch (for launch_ros), gazebo (tags of plugins); yaml and json: the rules"
                " for programs; bridge: topics for ros_gz_bridge; sros2: a policy with an enclave for"
                " each robot",
            ),
        ),
        NAMING,
        FINDINGS,
        GENERAL,
    ),
    _TABLE_CODES,
    more=_FLEET_FILE
    + " A launch file is read with its arguments, as ros2 launch does; nothing is started."
    + _BESIDE,
    fail_on=ERROR,
)
REHEARSE = Command(
    "rehearse",
    "rehearse",
    "%(prog)s INPUT [ROBOT...] [NAME:=VALUE...] [options]",
    "Try a fleet's plan on a real ROS graph, without any robot.",
    (
        Example("multibot rehearse fleet.yaml", "are all names as planned?"),
        Example("multibot rehearse fleet.yaml --report report.html", "a page with the ROS graph"),
        Example("multibot rehearse rover.urdf robot1 robot2 --stack nav2"),
        Example(
            "multibot rehearse rover.urdf robot1 robot2 --stack nav2 --without-rules all",
            "which names would collide?",
        ),
    ),
    (
        _DESCRIPTION,
        output_group(
            FINDINGS_OUTPUT,
            path_option(
                "--save-snapshot", "write the graph that came up, as multibot snapshot does"
            ),
        ),
        OptionGroup(
            "rehearsal",
            (
                several(
                    "--without-rules",
                    "WAY",
                    f"leave out rules that are given at {', '.join(WAYS)}; all: start nodes with"
                    " namespace and name alone",
                    [],
                    values.some_of((EVERY_WAY, *WAYS)),
                ),
            ),
        ),
        PICTURES,
        LIVE,
        NAMING,
        FINDINGS,
        GENERAL,
    ),
    LIVE_CODES,
    more=_FLEET_FILE
    + " It starts a stub for every node of each robot's plugins and stack, with its"
    " own names and the rules of multibot plan. Then it looks at the graph as multibot check"
    " does. A type that is not installed is replaced.",
    fail_on=ERROR,
    findings_first=True,
)
VIEW = Command(
    "view",
    "view",
    "%(prog)s INPUT [ROBOT...] [NAME:=VALUE...] [options]",
    "Show the robots in 3D, in one HTML file that needs no network.",
    (
        Example("multibot view fleet.yaml", "all robots at their poses, in view.html"),
        Example("multibot view rover.urdf robot1 robot2 -o rover.html"),
        Example("multibot view fleet.yaml --from graph.json", "what is on tf, and where?"),
    ),
    (
        OptionGroup(
            "input",
            (
                argument(
                    "input", "INPUT", "the robot's description before any rewrite, or a fleet file"
                ),
                argument("words", "ROBOT", "names of robots; NAME:=VALUE is for xacro", "*"),
                ROBOTS,
                COUNT,
                FROM,
                DISTRO,
                TRUST,
            ),
        ),
        output_group(output("the page; default: view.html; - prints it", default="view.html")),
        NAMING,
        FINDINGS,
        GENERAL,
    ),
    "0 done; 1 the description is refused; 2 wrong use or unreadable input; 4 no trimesh or rosbags",
    more="It needs pip install 'multibot_rewrite[view]'. Meshes are put into the page.",
    fail_on=ERROR,
)
