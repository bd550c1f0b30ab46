"""The command that shows robots in 3D."""

from __future__ import annotations

from multibot_rewrite.base.findings.finding import ERROR
from multibot_rewrite.cli.declared.shared import (
    BAG,
    DISTRO,
    FINDINGS,
    GENERAL,
    NAMING,
    ROBOTS,
    SAVED,
    TRUST,
)
from multibot_rewrite.cli.options import (
    Command,
    Example,
    OptionGroup,
    argument,
    output,
    output_group,
)

VIEW = Command(
    "view",
    "view",
    "%(prog)s INPUT [ROBOT...] [NAME:=VALUE...] [options]",
    "Show the robots in 3D, in one HTML file that needs no network.",
    (
        Example("multibot view fleet.yaml", "all robots at their poses, in view.html"),
        Example("multibot view rover.urdf robot1 robot2 -o rover.html"),
        Example("multibot view fleet.yaml --snapshot graph.json", "what is on tf, and where?"),
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
                SAVED,
                BAG,
                DISTRO,
                TRUST,
            ),
        ),
        output_group(output("the page; default: view.html; - prints it", default="view.html")),
        NAMING,
        FINDINGS,
        GENERAL,
    ),
    "0 done; 1 the description is refused; 2 wrong use or unreadable input; 4 no yourdfpy or rosbags",
    more="It needs pip install 'multibot_rewrite[view]'. Meshes are put into the page.",
    fail_on=ERROR,
)
