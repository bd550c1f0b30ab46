# SPDX-License-Identifier: Apache-2.0
"""Models of MuJoCo that a description names. Expectations: mujoco_ros2_control bda2b67
mujoco_system_interface.cpp:371 (on_init), and MuJoCo's reference of its format."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite import rewrite
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.rules.settings import Settings

URDF = """<robot name="r"><link name="a"/><ros2_control name="h" type="system"><hardware>
<plugin>CLASS</plugin><param name="mujoco_model">model.xml</param></hardware></ros2_control></robot>
"""
INTERFACE = "mujoco_ros2_control/MujocoSystemInterface"


@pytest.mark.parametrize(
    ("model", "found"),
    [
        ('<worldbody><body><joint name="j"/></body></worldbody>', []),
        ("<worldbody><body><joint/></body></worldbody>", ["error model.xml:2: 1"]),
        ('<worldbody><body><joint type="slide"/><joint type="ball"/></body></worldbody>',
         ["error model.xml:2: 2"]),
        ("<worldbody>\n<body><freejoint/></body></worldbody>", ["note model.xml:3: its"]),
        ('<worldbody><body><joint type="free"/></body></worldbody>', ["note model.xml:2: its"]),
        ("<worldbody><body><freejoint/><body>\n<joint type='hinge'/></body></body></worldbody>",
         ["error model.xml:3: 1"]),
        # No joints of a body: what others have of it.
        ('<default><joint damping="1"/></default>', []),
        ('<equality><joint joint1="a" joint2="b"/></equality><sensor/>', []),
        ('<worldbody><frame><joint/></frame></worldbody>', ["error model.xml:2: 1"]),
        ('<include file="arm.xml"/>', ["error arm.xml:2: 1"]),
        ('<include file="model.xml"/><include file="gone.xml"/>', []),
    ],
)  # fmt: skip
def test_joints_of_a_model_have_names(model: str, found: list[str], tmp_path: Path) -> None:
    (tmp_path / "model.xml").write_text(f"<mujoco>\n{model}</mujoco>\n")
    arm = "<mujocoinclude>\n<body><joint type='hinge'/></body></mujocoinclude>\n"
    (tmp_path / "arm.xml").write_text(arm)
    (tmp_path / "r.urdf").write_text(URDF.replace("CLASS", INTERFACE))
    said = lint_file(str(tmp_path / "r.urdf"), Settings(select=("MB245",)))
    assert [f"{it.level} {' '.join(it.message.split()[:2])}" for it in said] == found


@pytest.mark.parametrize("class_", ["cartesian_controller_simulation/Simulator", INTERFACE])
def test_other_hardware_and_models_that_are_not_here_say_nothing(
    class_: str, tmp_path: Path
) -> None:
    if class_ != INTERFACE:
        (tmp_path / "model.xml").write_text(
            "<mujoco><worldbody><body><joint/></body></worldbody></mujoco>"
        )
    (tmp_path / "r.urdf").write_text(URDF.replace("CLASS", class_))
    assert lint_file(str(tmp_path / "r.urdf"), Settings(select=("MB245",))) == []


def test_the_topic_of_all_actuators_is_one_for_all_robots() -> None:
    """mujoco_system_interface.cpp:367: absolute, of the node of the controller manager."""
    made = rewrite(URDF.replace("CLASS", INTERFACE), "robot1", layout="frames-per-robot")
    assert made.not_verified == ("1 topic shared by all robots",)
    other = URDF.replace("CLASS", "mock_components/GenericSystem")
    assert rewrite(other, "robot1", layout="frames-per-robot").not_verified == ()
