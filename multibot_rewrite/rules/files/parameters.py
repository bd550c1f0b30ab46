"""Parameters that their node does not declare as they are written."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.companions.kinds import PARAMS
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.rules.files import declared
from multibot_rewrite.rules.files.records import Remark


def _drive(line: str) -> str:
    """An example: a controller; the line is the fifth."""
    return (
        "controller_manager:\n"
        "  ros__parameters: {drive: {type: diff_drive_controller/DiffDriveController}}\n"
        "drive:\n"
        "  ros__parameters:\n"
        f"    {line}\n"
    )


@rule(
    "MB850",
    "unknown-parameter",
    WARNING,
    what="A parameter file sets a parameter that its node, controller or plugin of Nav2 does not have, "
    "with a name nearly that of one it has.",
    why="The node does not declare it, so the value has no effect, and the node runs with its default: "
    "odometry from base_link, a speed without limit.",
    fix="Correct the name. Parameters come from the generate_parameter_library files of the "
    "package where its sources are there, else from installed NoDL documents and the sources of the "
    "release.",
    bad=_drive("base_frame_idd: base_footprint"),
    good=_drive("base_frame_id: base_footprint"),
    line=5,
    formats=(PARAMS,),
)
def unknown_parameter(file: NamedFile) -> Iterator[Remark]:
    """Parameters of known nodes and controllers."""
    return declared.unknown_parameters(file)


@rule(
    "MB851",
    "parameter-type",
    WARNING,
    what="The value of a parameter has another type than the one that its node declares: 1 where "
    "1.0 is needed, a text for a number.",
    why="rclcpp throws InvalidParameterTypeException: the node does not come up, or its "
    "controller is not loaded.",
    fix="Write the type that is declared; a double needs a point.",
    bad=_drive("wheel_separation: 1"),
    good=_drive("wheel_separation: 1.0"),
    line=5,
    formats=(PARAMS,),
)
def parameter_type(file: NamedFile) -> Iterator[Remark]:
    """Parameters whose declarations all have one type."""
    return declared.wrong_types(file)


@rule(
    "MB852",
    "parameter-out-of-bounds",
    WARNING,
    what="The value of a parameter is outside of the bounds that its node checks.",
    why="generate_parameter_library rejects it ('Invalid value set during initialization'): the "
    "controller is not loaded. An empty name in a list of joints is taken, and no interface has it.",
    fix="Write a value within the bounds; the message has them.",
    bad=_drive("wheel_radius: -0.1"),
    good=_drive("wheel_radius: 0.1"),
    line=5,
    formats=(PARAMS,),
)
def parameter_out_of_bounds(file: NamedFile) -> Iterator[Remark]:
    """Parameters that generate_parameter_library checks."""
    return declared.out_of_bounds(file)
