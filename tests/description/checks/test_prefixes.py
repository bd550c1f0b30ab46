# SPDX-License-Identifier: Apache-2.0
"""A parameter that code puts in front of names: at its default, and made by an argument of a xacro."""

from __future__ import annotations

import pytest

from multibot_rewrite import rewrite

LIFT = """<robot name="r"><link name="base"/><link name="floor_0"/><link name="cab"/>
<joint name="f" type="fixed"><parent link="base"/><child link="floor_0"/></joint>
<joint name="lift" type="fixed"><parent link="base"/><child link="cab"/></joint>
<gazebo><plugin name="gz::sim::systems::Elevator" filename="gz-sim-elevator-system">{}</plugin></gazebo>
</robot>"""
GIVEN = "<floor_link_prefix>level_</floor_link_prefix><door_joint_prefix>d_</door_joint_prefix>"


@pytest.mark.parametrize(("inside", "value"), [("", "floor_"), (GIVEN, "level_")])
@pytest.mark.parametrize("layout", ["postfix", "frames-per-robot"])
def test_a_prefix_counts_as_written_where_it_has_its_default(
    inside: str, value: str, layout: str
) -> None:
    """gz-sim Elevator.cc:185 to 189: floor_ and door_ where they are absent."""
    text = LIFT.format(inside)
    told = rewrite(text, "robot1", layout=layout)
    assert told.not_verified == ("2 prefix parameters that no postfix reaches",)
    assert any(repr(value) in it.message for it in told.findings if it.code == "MB422")
    made = rewrite(text, "robot1", layout=layout, affix="prefix")
    assert made.not_verified == ()
    assert f"<floor_link_prefix>robot1/{value}</floor_link_prefix>" in made.text


SENSOR = '<sensor name="{}" type="camera"/>'
CAMERA = """<robot name="r"><link name="base"/><gazebo reference="base">{}</gazebo><gazebo>
<plugin name="p" filename="librealsense_gazebo_plugin.so">{}</plugin></gazebo></robot>"""


@pytest.mark.parametrize(
    ("names", "inside", "affix", "reasons"),
    [
        # RealSensePlugin.cpp:37, 133 to 145: the prefix is empty, the sensors color, depth, ired1.
        (("color",), "", "prefix", "1 name fixed in a plugin's code"),
        (("color", "depth"), "", "postfix", "2 names fixed in a plugin's code"),
        (("front",), "", "prefix", ""),
        (("color",), "<prefix></prefix>", "prefix", ""),
        (("c_color",), "<prefix>c_</prefix>", "prefix", ""),
        (
            ("c_color",),
            "<prefix>c_</prefix>",
            "postfix",
            "1 prefix parameter that no postfix reaches",
        ),
    ],
)
def test_sensors_whose_names_code_makes_behind_a_prefix(
    names: tuple[str, ...], inside: str, affix: str, reasons: str
) -> None:
    text = CAMERA.format("".join(map(SENSOR.format, names)), inside)
    made = rewrite(text, "robot1", layout="postfix", affix=affix)
    assert ", ".join(made.not_verified) == reasons
