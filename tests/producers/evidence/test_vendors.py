# SPDX-License-Identifier: Apache-2.0
"""The controllers.yaml of vendors beside their expanded descriptions, before and after a rewrite.

With MULTIBOT_SOURCES=FOLDER, which holds checkouts of the vendors' repositories under their names;
skipped without. What a vendor's own file claims and its own description lacks is listed here.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import pytest
from controller_types import registered
from fleet_folder import built_fleet
from vendor_sources import VARIABLE, installed_sources, packages_below

from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.knowledge.parameters import built_in_nodes

pytestmark = pytest.mark.slow

LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")
# What the vendors' launch files replace, for one robot without a prefix.
FILLED = {"$(var tf_prefix)": "", "<namespace>/": "", "<static_covariance_orientation>": "[0.0]"}


class Robot(NamedTuple):
    """``lacks`` are controllers whose interfaces are not exported for one robot either."""

    description: str
    arguments: dict[str, str]
    controllers: str
    lacks: frozenset[str] = frozenset()


UR = "Universal_Robots_ROS2_Driver/ur_robot_driver"
FRANKA = "franka_ros2/franka_bringup/config/controllers.yaml"
KORTEX = "ros2_kortex/kortex_description"
ROBOTIQ = "ros2_robotiq_gripper/robotiq_description"
HUSARION = "husarion_ugv_ros/husarion_ugv"
WHEELS = f"{HUSARION}_controller/config"
XARM = "xarm_ros2/xarm_controller/config"
ROBOTS = {
    # The description has no effort commands; the controllers' file is for newer ones.
    "ur5e": Robot(
        f"{UR}/urdf/ur.urdf.xacro",
        {"ur_type": "ur5e", "name": "ur"},
        f"{UR}/config/ur_controllers.yaml",
        frozenset({"forward_effort_controller"}),
    ),
    # The description has no sensor fr3_tcp, an arm no wheels, the package no such type (jazzy 29cb85a).
    "fr3": Robot(
        "franka_description/robots/fr3/fr3.urdf.xacro",
        {"ros2_control": "true"},
        FRANKA,
        frozenset(
            {
                "gravity_compensation_example_controller",
                "swerve_drive_controller",
                "controller mobile_cartesian_velocity_example_controller",
            }
        ),
    ),
    "xarm6": Robot(
        "xarm_ros2/xarm_description/urdf/xarm_device.urdf.xacro",
        {"dof": "6"},
        f"{XARM}/xarm6_controllers.yaml",
    ),
    "xarm7": Robot(
        "xarm_ros2/xarm_description/urdf/xarm_device.urdf.xacro",
        {"dof": "7"},
        f"{XARM}/xarm7_controllers.yaml",
    ),
    # Without its gripper.
    "gen3": Robot(
        f"{KORTEX}/robots/gen3.xacro",
        {"dof": "7"},
        f"{KORTEX}/arms/gen3/7dof/config/ros2_controllers.yaml",
        frozenset({"robotiq_gripper_controller"}),
    ),
    # The driver exports set_gripper_max_effort, the file names effort.
    "robotiq": Robot(
        f"{ROBOTIQ}/urdf/robotiq_2f_85_gripper.urdf.xacro",
        {"use_fake_hardware": "false"},
        f"{ROBOTIQ}/config/robotiq_controllers.yaml",
        frozenset({"robotiq_gripper_controller"}),
    ),
    # Beside husarion_components_description.
    "panther": Robot(
        f"{HUSARION}_description/urdf/panther.urdf.xacro", {}, f"{WHEELS}/WH01_controller.yaml"
    ),
    "panther mecanum": Robot(
        f"{HUSARION}_description/urdf/panther.urdf.xacro", {}, f"{WHEELS}/WH02_controller.yaml"
    ),
}


sources = pytest.fixture(scope="module")(installed_sources)


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("robot", ROBOTS)
def test_claimed_interfaces_are_exported(
    robot: str, layout: str, sources: Path, tmp_path: Path
) -> None:
    it = ROBOTS[robot]
    missing = [path for path in (it.description, it.controllers) if not (sources / path).exists()]
    if missing:
        pytest.skip(f"{VARIABLE} lacks {', '.join(missing)}")
    text = (sources / it.controllers).read_text(encoding="utf-8")
    for old, new in FILLED.items():
        text = text.replace(old, new)
    (tmp_path / "controllers.yaml").write_text(text)
    arguments = ", ".join(f"{name}: {value!r}" for name, value in it.arguments.items())
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(
        f"layout: {layout}\naffix: prefix\ndistro: jazzy\ndescription: {sources / it.description}\n"
        f"arguments: {{{arguments}}}\nrobots: [{{name: left}}, {{name: right}}]\n"
        "related_files: {params: [controllers.yaml]}\nnode_sets: ros2_control\n"
    )
    outputs = built_fleet(fleet)
    found = [it for it in outputs.findings if it.code in ("MB229", "MF802")]
    lacking = {it.message.partition(" is ")[0].partition(" of ")[0] for it in found}
    # Which of them there are differs from branch to branch.
    assert lacking <= it.lacks
    assert bool(lacking) == bool(it.lacks)
    assert {it.level for it in found} <= {"warning"}
    assert [it for it in outputs.findings if it.level == "error"] == []


def test_every_registered_controller_is_known(sources: Path) -> None:
    found = {it for folder in packages_below(sources).values() for it in registered(folder)}
    assert found
    known = {type_ for release in RELEASES for type_ in built_in_nodes(release).types}
    assert sorted(found - known) == []
