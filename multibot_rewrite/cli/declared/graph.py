# SPDX-License-Identifier: Apache-2.0
"""The commands about a running system: check, check-launch, snapshot."""

from __future__ import annotations

from multibot_rewrite.base.findings.finding import ERROR
from multibot_rewrite.cli import values
from multibot_rewrite.cli.declared.shared import (
    DISTRO,
    FINDINGS,
    FINDINGS_OUTPUT,
    FROM,
    GENERAL,
    KNOWN_NODES,
    LIVE,
    LIVE_CODES,
    PICTURES,
    ROOTS,
    SOURCE,
    TRUST,
    Command,
    Example,
    OptionGroup,
    argument,
    choice,
    output,
    output_group,
    path_option,
    several,
    switch,
    value,
)

STATE = switch(
    "--state",
    about="also ask nodes for their state, within 5 s: life cycle, use_sim_time, controllers, and"
    " parameters that multibot build wrote",
)
WATCH = switch(
    "--watch",
    about="show every change until Ctrl-C or --timeout, without the frames of sensors' messages; with"
    " --state, nodes are asked when nothing has changed for a while, and again every 10 s",
)
# Of robots that are in several.
DOMAINS = several(
    "--domain",
    "N",
    f"instead of ROS_DOMAIN_ID, 0 to {values.MAX_DOMAIN}; several are looked at side by side, 11,12",
    read=values.domains,
)
LISTENING = SOURCE._replace(
    options=(*(it for it in SOURCE.options if it.names != DOMAINS.names), DOMAINS)
)
CHECK = Command(
    "check",
    "check",
    "%(prog)s [PLAN] [options]",
    "Compare the running system with a plan, or find common faults.",
    (
        Example("multibot check", "what is wrong with the robots that run now?"),
        Example("multibot check plan.yaml", "are they as planned?"),
        Example("multibot check plan.yaml --watch", "show every change until Ctrl-C"),
        Example("multibot check plan.yaml --from graph.json", "a saved graph; needs no ROS"),
        Example("multibot check before.json --from after.json", "what is gone or new?"),
        Example("multibot check --domain 11,12", "robots that have a domain each"),
        Example("multibot check --from tcp/localhost:7447", "a Zenoh router; needs no ROS"),
        Example("multibot check plan.yaml --from recording/", "a bag of rosbag2; needs no ROS"),
        Example("multibot check plan.yaml --format junit -o check.xml", "in CI"),
        Example("multibot check --suggest first/", "begin a fleet file and a plan with it"),
    ),
    (
        OptionGroup(
            "input",
            (
                argument("plan", "PLAN", "what plan or snapshot wrote, or a fleet file", "?"),
                DISTRO,
                TRUST,
            ),
        ),
        output_group(
            FINDINGS_OUTPUT,
            WATCH,
            STATE,
            path_option(
                "--suggest",
                "without PLAN: write a first fleet file, plan and description of what is seen",
                "FOLDER",
            ),
        ),
        PICTURES,
        LISTENING,
        FINDINGS,
        GENERAL,
    ),
    f"{LIVE_CODES.replace('as planned', 'as planned, or nothing wrong seen')}. With --watch it is the"
    " worst of the run; what is missing during startup does not count",
    fail_on=ERROR,
    findings_first=True,
)
CHECK_LAUNCH = Command(
    "check-launch",
    "check_launch",
    "%(prog)s [PACKAGE] FILE [NAME:=VALUE...] [options]",
    "Check what a launch file would start, without starting it.",
    (
        Example("multibot check-launch fleet.launch.py", "as ros2 launch takes it"),
        Example("multibot check-launch my_bringup two.launch.py sim:=false"),
        Example("multibot check-launch two.launch.py --plan fleet.yaml", "compare with a plan"),
    ),
    (
        OptionGroup(
            "input",
            (
                argument(
                    "words",
                    "FILE",
                    "a launch file, or a package and a file in it, and launch arguments; or a"
                    " system_model.yaml. It is read behind fences, and nothing is started",
                    "+",
                ),
                path_option(
                    "--plan",
                    "compare with it, too: what multibot plan wrote, or a fleet file",
                    "PLAN",
                ),
                *KNOWN_NODES,
                ROOTS,
                DISTRO,
                TRUST,
            ),
        ),
        output_group(FINDINGS_OUTPUT),
        PICTURES,
        FINDINGS,
        GENERAL,
    ),
    "0 nothing wrong seen, and all nodes are known; 1 findings at the level of --fail-on; 2 wrong use"
    " or unreadable input, or launch is missing; 3 inconclusive: something is decided only at run time,"
    " or not known",
    fail_on=ERROR,
    findings_first=True,
)
SNAPSHOT = Command(
    "snapshot",
    "snapshot",
    "%(prog)s [options]",
    "Show what runs in the ROS graph now, or save it.",
    (
        Example("multibot snapshot", "a table"),
        Example(
            "multibot snapshot -o graph.json --expect /robot1/amcl", "JSON, for multibot check"
        ),
        Example("multibot snapshot --form rosgraph -o graph.yaml", "for other tools"),
        Example("multibot snapshot --from tcp/localhost:7447", "what a Zenoh router knows"),
        Example(
            "multibot snapshot --from robot1.json --from robot2.json -o all.json",
            "from two machines",
        ),
        Example("multibot snapshot --form nodes --node /my_driver --stack mine -o mine.yaml"),
        Example("multibot plan rover.urdf robot1 robot2 --nodes mine.yaml --stack mine"),
        Example("multibot snapshot --node /my_driver -o my_driver.nodl.yaml", "as NoDL"),
    ),
    (
        output_group(
            output("write JSON there (- is standard output), not a table"),
            choice(
                "--form",
                "FORM",
                ("json", "rosgraph", "nodes", "nodl"),
                "json: the snapshot; rosgraph: a message of the type rosgraph_msgs/Graph (YAML, as ros2"
                " topic echo prints it); nodes: a file of nodes and stacks for multibot plan --nodes;"
                " nodl: NoDL interface files, with -o a folder for several nodes; default: nodl if -o"
                " ends in .nodl.yaml, else json",
            ),
        ),
        OptionGroup(
            "with --form nodes or nodl",
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
                    "--stack",
                    metavar="NAME",
                    about="name of the new stack; default: learned",
                    type=values.word,
                ),
                DISTRO,
            ),
        ),
        SOURCE._replace(
            options=(
                several(
                    "--expect",
                    "A,B",
                    "stop when these nodes and topics (full names) are there; QoS of these topics, too",
                    [],
                    values.full_names,
                ),
                FROM,
                STATE,
                *LIVE.options,
            )
        ),
        GENERAL,
    ),
    "0 done; 2 wrong use, unreadable input, or a node of --node that is not there or there twice; 3"
    " something may be missing in the view, which is written all the same;"
    " 4 rclpy or its RMW, or zenoh, is missing or does not start",
    more="The graph is settled when all of --expect are seen, or nothing changed for 3.5 s.",
)
