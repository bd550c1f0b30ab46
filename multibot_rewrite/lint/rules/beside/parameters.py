"""Parameters that their node does not declare as they are written."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from multibot_rewrite.findings.finding import WARNING
from multibot_rewrite.findings.rule import rule
from multibot_rewrite.lint.beside.kinds import PARAMS
from multibot_rewrite.lint.rules.physics.shared import a_rover

if TYPE_CHECKING:
    from multibot_rewrite.lint.beside.records import Beside, Remark


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
def unknown_parameter(beside: Beside) -> Iterator[Remark]:
    """Parameters of known nodes and controllers."""
    from multibot_rewrite.lint.beside.parameters import unknown_parameters

    return unknown_parameters(beside)


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
def parameter_type(beside: Beside) -> Iterator[Remark]:
    """Parameters whose declarations all have one type."""
    from multibot_rewrite.lint.beside.parameters import wrong_types

    return wrong_types(beside)


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
def parameter_out_of_bounds(beside: Beside) -> Iterator[Remark]:
    """Parameters that generate_parameter_library checks."""
    from multibot_rewrite.lint.beside.parameters import out_of_bounds

    return out_of_bounds(beside)


def _wheels(separation: str) -> str:
    return _drive(
        "left_wheel_names: [left_joint]\n"
        "    right_wheel_names: [right_joint]\n"
        f"    wheel_separation: {separation}\n"
        "    wheel_radius: 0.1"
    )


@rule(
    "MB856",
    "controller-wheels",
    WARNING,
    what="The wheels of a diff_drive_controller are not as it is told: their separation or radius "
    "is another in the package's description, left and right are swapped, or their axes point in "
    "opposite directions.",
    why="The robot turns or drives too far or the wrong way, and its odometry says otherwise.",
    fix="Write the sizes of the description, or correct its joints.",
    bad=_wheels("0.8"),
    good=_wheels("0.4"),
    line=7,
    formats=(PARAMS,),
    beside={
        "package.xml": "<package><name>rover</name></package>",
        "urdf/rover.urdf": f'<robot name="rover">{a_rover()}</robot>',
    },
)
def controller_wheels(beside: Beside) -> Iterator[Remark]:
    """What no description of the package fits."""
    from multibot_rewrite.lint.beside.wheels import faulty_wheels

    return faulty_wheels(beside)
