# SPDX-License-Identifier: Apache-2.0
"""A vendor's bridge in a namespace below the robot's, and models whose name is a path, as Clearpath's.

Expected from clearpath_generator_gz: the bridge of a sensor is started in NAMESPACE/sensors, where
ros_gz_bridge expands the relative ROS names of its file; robots are spawned as NAMESPACE/robot.
"""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from fleet_folder import built_fleet

from multibot_rewrite.base.model import InputError
from multibot_rewrite.checks.build import Outputs

ROW = """\
- ros_topic_name: {}
  gz_topic_name: /model/robot/imu
  ros_type_name: sensor_msgs/msg/Imu
  gz_type_name: gz.msgs.IMU
  direction: GZ_TO_ROS
"""
FILTER = "ekf_filter_node: {ros__parameters: {imu0: sensors/imu_0/data, odom_frame: odom}}\n"
FLEET = """\
layout: L1
description: r.urdf
node_sets: robot_localization
robots:
  - {name: robot1, model: robot1/robot}
  - {name: robot2, model: robot2/robot}
related_files: {bridge: b.yaml, params: p.yaml}
"""


def made(folder: Path, name: str, more: str = "") -> Outputs:
    (folder / "r.urdf").write_text('<robot name="r"><link name="base_link"/></robot>')
    (folder / "b.yaml").write_text(ROW.format(name))
    (folder / "p.yaml").write_text(FILTER)
    (folder / "fleet.yaml").write_text(f"{FLEET}{more}")
    return built_fleet(folder / "fleet.yaml")


def first_row(outputs: Outputs) -> dict[str, str]:
    (text,) = (it.data for it in outputs.files if it.path == "robot2/bridge.yaml")
    row: dict[str, str] = yaml.safe_load(text)[0]
    return row


@pytest.mark.parametrize(
    ("name", "more", "topic"),
    [
        ("imu_0/data", "bridge_namespace: sensors\n", "/robot2/sensors/imu_0/data"),
        ("imu_0/data", "bridge_namespace: /sensors/\n", ""),
        ("imu_0/data", "", "/robot2/imu_0/data"),
        ("/imu_0/data", "bridge_namespace: sensors\n", "/robot2/imu_0/data"),
        ('"<namespace>/imu_0/data"', "bridge_namespace: sensors\n", "/robot2/imu_0/data"),
    ],
)
def test_relative_names_are_below_the_bridge(
    name: str, more: str, topic: str, tmp_path: Path
) -> None:
    if not topic:
        with pytest.raises(InputError, match="bridge_namespace"):
            made(tmp_path, name, more)
        return
    row = first_row(made(tmp_path, name, more))
    assert row["ros_topic_name"] == topic
    assert row["gz_topic_name"] == "/model/robot2/robot/imu"


ROV = """<robot name="rov"><link name="a"/><link name="b"/><joint name="fin" type="continuous">
<parent link="a"/><child link="b"/></joint><gazebo>
<plugin filename="gz-sim-thruster-system" name="gz::sim::systems::Thruster">
<namespace>rov</namespace><joint_name>fin</joint_name></plugin></gazebo></robot>"""


@pytest.mark.parametrize("layout", ["L1", "L2", "L4"])
def test_a_row_follows_the_word_that_a_system_makes_its_topic_of(
    layout: str, tmp_path: Path
) -> None:
    """What is below the model's own name follows the spawner, with the same text in front."""
    rows = ROW.format("a").replace("/model/robot/imu", "/model/rov/joint/fin/cmd_thrust")
    rows += ROW.format("b").replace("/model/robot/imu", "/model/rov/odometry")
    (tmp_path / "rov.urdf").write_text(ROV)
    (tmp_path / "b.yaml").write_text(rows)
    (tmp_path / "fleet.yaml").write_text(
        f"description: rov.urdf\nlayout: {layout}\nsimulator: gazebo\n"
        "robots: [{name: robot1}, {name: robot2}]\nrelated_files: {bridge: b.yaml}\n"
    )
    outputs = built_fleet(tmp_path / "fleet.yaml")
    files = {it.path: it.data for it in outputs.files}
    joint = "fin" if layout == "L1" else "fin_robot2"
    made = [it["gz_topic_name"] for it in yaml.safe_load(files["robot2/bridge.yaml"])]
    assert made[:2] == [f"/model/rov_robot2/joint/{joint}/cmd_thrust", "/model/robot2/odometry"]
    assert b"<namespace>rov_robot2</namespace>" in files["robot2/rov.urdf"]


SYSTEM = """\
structure:
  nodes:
    /robot1/{namespace}imu_bridge:
      pkg: ros_gz_bridge
      exec: parameter_bridge
      params: {{config_file: /etc/vendor/{file}}}
"""


@pytest.mark.parametrize(
    ("namespace", "file", "more", "topic"),
    [
        ("sensors/", "b.yaml", "", "/robot2/sensors/imu_0/data"),
        ("", "b.yaml", "", "/robot2/imu_0/data"),
        ("sensors/", "other.yaml", "", "/robot2/imu_0/data"),
        ("sensors/", "b.yaml", "bridge_namespace: mine\n", "/robot2/mine/imu_0/data"),
    ],
)
def test_a_launch_file_says_where_its_bridge_runs(
    namespace: str, file: str, more: str, topic: str, tmp_path: Path
) -> None:
    system = SYSTEM.format(namespace=namespace, file=file)
    (tmp_path / "system_model.yaml").write_text(system)
    row = first_row(made(tmp_path, "imu_0/data", f"launch: system_model.yaml\n{more}"))
    assert row["ros_topic_name"] == topic
