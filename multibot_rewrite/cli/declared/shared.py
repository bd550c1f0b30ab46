# SPDX-License-Identifier: Apache-2.0
"""The options that several commands share: each means the same everywhere."""

from __future__ import annotations

from multibot_rewrite.base.conventions import SHARED_TOPICS, WORLD_FRAMES
from multibot_rewrite.base.findings.finding import LEVELS
from multibot_rewrite.base.findings.formats import FORMATS
from multibot_rewrite.base.naming import DEFAULT_LAYOUT, LAYOUTS, SEPARATORS
from multibot_rewrite.base.releases import NEWEST_LTS, RELEASES, VARIABLE
from multibot_rewrite.cli import values
from multibot_rewrite.cli.options import (
    Option,
    OptionGroup,
    choice,
    output,
    path_option,
    several,
    switch,
    value,
)

_LAYOUTS = "; ".join(f"{it.name} ({it.short}): {it.about}" for it in LAYOUTS)
LAYOUT_NAMES = tuple(name for it in LAYOUTS for name in (it.name, it.short))
_SEPARATORS = " ".join(f"{kind}={mark}" for kind, mark in SEPARATORS.items())

NAMING = OptionGroup(
    "names of a robot",
    (
        choice("--layout", "NAME", LAYOUT_NAMES, f"{_LAYOUTS}; default: {DEFAULT_LAYOUT}"),
        choice(
            "--affix",
            "SIDE",
            ("postfix", "prefix"),
            "the robot's name goes behind names (postfix, the default) or in front (prefix)",
        ),
        choice(
            "--topics",
            "HOW",
            ("postfix", "prefix", "namespace"),
            "postfix, prefix or namespace; default: what the layout implies",
        ),
        several(
            "--separator",
            "KIND=SEP",
            "what stands between a name and the robot's; SEP alone is for all names of the"
            " description, not for ROS nodes and topics; group=SEP renames the groups of an SRDF,"
            f" too; defaults: {_SEPARATORS}",
            [],
        ),
        several(
            "--shared",
            "FRAME,/TOPIC",
            "frames, and topics with a slash in front, that all robots share; default:"
            f" {','.join((*WORLD_FRAMES, *SHARED_TOPICS))}",
            [],
        ),
    ),
)
ROBOTS = several("--robots", "A,B", "names of robots", [])
COUNT = value(
    *("-n", "--count"),
    metavar="COUNT",
    about="as many robots: robot1, robot2 and so on; of a fleet file the first ones, or more like them",
    type=values.count,
)
VOCABULARY = several(
    "--vocabulary", "FILE", "what more plugins mean by their parameters (docs/add-a-plugin.md)", []
)
EVERYTHING = switch(
    "--no-default-excludes",
    about="in folders, read build/, install/, log/ and what has a COLCON_IGNORE or AMENT_IGNORE or is"
    " ignored by git, too",
)
URDF = path_option("--urdf", "the URDF of an SRDF or of another file")
DISTRO = choice(
    "--distro",
    "NAME",
    RELEASES,
    f"the ROS 2 release that the robots run: {', '.join(RELEASES)}; default: the fleet file's or"
    f" configuration's, else {VARIABLE}, else {NEWEST_LTS}",
)
TRUST = switch(
    "--trust",
    about="let xacro files do anything: else they only compute, and read what is near (SECURITY.md)",
)
KNOWN_NODES = (
    several(
        "--nodes",
        "PATH",
        "your own nodes and stacks, a YAML file; NoDL files or folders of them, besides those of"
        " installed packages (none: use no NoDL)",
        [],
    ),
)
ROOTS = several(
    *("--roots", "A,B", "folders to look for packages in, beside those that are installed", []),
    read=values.folders,
)
FINDINGS = OptionGroup(
    "findings",
    (
        several("--select", "CODES", "only these codes, or codes that begin so: MB2,MG102", []),
        several("--ignore", "CODES", "not these; the longer of two that match wins", []),
        choice(
            "--fail-on",
            "LEVEL",
            LEVELS,
            "the lowest level that makes the exit code 1: error (default; urdf-lint: warning),"
            " warning (what is not proved fails) or note",
        ),
        choice(
            "--format",
            "FORMAT",
            tuple(FORMATS),
            f"how findings are written: {', '.join(FORMATS)}; default: text",
            default="text",
        ),
    ),
)
GENERAL = OptionGroup(
    "general",
    (
        switch("-q", "--quiet", about="findings and errors only: no summary, no notes"),
        switch(
            "-v",
            "--verbose",
            about="each robot's findings by themselves, the files written, the time it took",
        ),
        choice(
            "--color",
            "WHEN",
            ("auto", "always", "never"),
            "auto (default: on a terminal, unless NO_COLOR is set), always or never",
            default="auto",
        ),
    ),
)
LIVE = OptionGroup(
    "live graph",
    (
        value("--timeout", metavar="S", about="look S seconds (default: 15)", type=values.seconds),
        value(
            "--domain",
            metavar="N",
            about=f"instead of ROS_DOMAIN_ID, 0 to {values.MAX_DOMAIN}",
            type=values.domain,
        ),
    ),
)
# Where a graph comes from; read by ``cli/live.py``.
FROM = Option(
    ("--from",),
    "read the graph there, without ROS: what multibot snapshot wrote, or a rosgraph_msgs/Graph in YAML"
    " (again for each machine that was looked from); a recording of rosbag2 (a folder, .mcap or .db3);"
    " a Zenoh router (tcp/localhost:7447, or a session configuration .json5)",
    {
        "metavar": "SOURCE",
        "dest": "sources",
        "action": "append",
        "type": values.source,
        "default": [],
    },
)
SOURCE = OptionGroup("where the graph comes from", (FROM, *LIVE.options))


FINDINGS_OUTPUT = output("write the findings there, not to standard output")

LIVE_CODES = (
    "0 as planned; 1 findings at the level of --fail-on; 2 wrong use or unreadable input;"
    " 3 inconclusive: the view may be incomplete; 4 rclpy or its RMW, zenoh or rosbags is"
    " missing or does not start"
)
PICTURES = OptionGroup(
    "report",
    (path_option("--report", "write a page to look at, one HTML file"),),
)


RESULT_OUTPUT = output("write the result there, not to standard output")
