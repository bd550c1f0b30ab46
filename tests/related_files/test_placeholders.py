# SPDX-License-Identifier: Apache-2.0
"""What stands for a robot in vendors' files means the same in parameters, RViz, bridges and trees.

Expected: a name as if the file were for one robot without a namespace, with the robot's name then.
"""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from multibot_rewrite.checks.build import Outputs, make_outputs
from multibot_rewrite.checks.judged_plan import plan_fleet
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.related_files.names.placeholders import without_robot

FORMS = (
    *("<robot_namespace>", "<namespace>", "<robot_name>", "$(var ns)", "$(var namespace)"),
    *("$(arg namespace)", "${namespace}", "${ns}"),
)
ROVER = """\
<robot name="rover">
  <link name="base_link"/><link name="lidar_link"/>
  <joint name="mast" type="fixed"><parent link="base_link"/><child link="lidar_link"/></joint>
</robot>
"""
PARAMS = """\
"IT/amcl":
  ros__parameters: {base_frame_id: "IT/base_link", scan_topic: "/IT/scan"}
acme:
  ros__parameters: {who: "IT", text: "it is IT", namespace: "IT", topic: "IT/image", area: "<area>/x"}
"""
BRIDGE = """\
- ros_topic_name: "IT/odom2"
  gz_topic_name: "/model/IT/odometry"
  ros_type_name: nav_msgs/msg/Odometry
  gz_type_name: gz.msgs.Odometry
  direction: GZ_TO_ROS
"""
RVIZ = """\
Visualization Manager:
  Displays:
    - {Class: rviz_default_plugins/Path, Name: path, Topic: {Value: "/IT/plan"}}
    - {Class: rviz_default_plugins/Axes, Name: axes, Reference Frame: "IT/lidar_link"}
    - {Class: rviz_default_plugins/RobotModel, Name: model, TF Prefix: "IT",
       Description Topic: {Value: "IT/robot_description", Durability Policy: Transient Local}}
  Global Options: {Fixed Frame: map}
"""
TREE = """\
<root BTCPP_format="4"><BehaviorTree ID="M">
  <Spin server_name="IT/spin" robot_base_frame="/IT/base_link" spin_dist="{IT}"/>
</BehaviorTree></root>
"""
FLEET = """\
layout: LAYOUT
affix: prefix
description: rover.urdf
node_sets: [localization, navigation]
robots: [{name: robot1}, {name: robot2}]
related_files: {params: p.yaml, bridge: b.yaml, rviz: r.rviz, behavior_trees: t.xml}
"""


def made(folder: Path, form: str, layout: str) -> Outputs:
    (folder / "rover.urdf").write_text(ROVER)
    in_xml = form.replace("<", "&lt;")
    for name, text in {"p.yaml": PARAMS, "b.yaml": BRIDGE, "r.rviz": RVIZ}.items():
        (folder / name).write_text(text.replace("IT", form))
    (folder / "t.xml").write_text(TREE.replace("{IT}", "{it}").replace("IT", in_xml))
    (folder / "fleet.yaml").write_text(FLEET.replace("LAYOUT", layout))
    return make_outputs(plan_fleet(read_fleet(str(folder / "fleet.yaml"), "", {})))


@pytest.mark.slow
@pytest.mark.sample(4)
@pytest.mark.parametrize(
    ("form", "layout", "base", "lidar"),
    [
        *((it, "frames-per-robot", "robot2/base_link", "robot2/lidar_link") for it in FORMS),
        ("<namespace>", "frame-prefix", "robot2/base_link", "robot2/lidar_link"),
        ("$(var ns)", "tf-per-robot", "base_link", "lidar_link"),
    ],
)
def test_one_meaning_in_every_file(
    form: str, layout: str, base: str, lidar: str, tmp_path: Path
) -> None:
    outputs = made(tmp_path, form, layout)
    text = {it.path: it.data.decode() for it in outputs.files}
    params = yaml.safe_load(text["robot2/p.yaml"])
    amcl = params["/robot2/amcl"]["ros__parameters"]
    assert (amcl["base_frame_id"], amcl["scan_topic"]) == (base, "/robot2/scan")
    own = params["/robot2/acme"]["ros__parameters"]
    assert (own["who"], own["text"], own["namespace"]) == ("robot2", "it is robot2", "robot2")
    assert own["topic"].lstrip("/") in ("robot2/image", "image")
    rows = yaml.safe_load(text["robot2/bridge.yaml"])
    assert rows[0]["ros_topic_name"] == "/robot2/odom2"
    assert rows[0]["gz_topic_name"] == "/model/robot2/odometry"
    shown = text.get("r.rviz", "") + text.get("robot2/r.rviz", "")
    assert "/robot2/plan" in shown
    assert f'Reference Frame: "{lidar}"' in shown or f"Reference Frame: {lidar}" in shown
    # RViz puts it before the links of the description, which have the robot's name or none in tf.
    prefix = "robot2" if layout == "frame-prefix" else '""'
    assert f"TF Prefix: {prefix}," in shown.replace('"robot2"', "robot2")
    assert f'"{form}"' not in shown
    tree = text["robot2/t.xml"]
    assert f'robot_base_frame="{base}"' in tree
    assert 'server_name="/robot2/spin"' in tree or 'server_name="spin"' in tree
    assert {it.code for it in outputs.findings} & {"MB105", "MB312", "MB890", "MB882"} == set()
    # One that is not the robot stays, and only it is said to stay.
    assert own["area"] == "<area>/x"


@pytest.mark.parametrize(
    ("value", "name"),
    [
        ("<namespace>/imu", "imu"), ("/<namespace>/imu", "imu"), ("<robot_name>_imu", "imu"),
        ("${prefix}imu", "imu"), ("$(var tf_prefix)imu", "imu"), ("imu", "imu"), ("", ""),
        ("<namespace>", "<namespace>"), ("<namespace>/", "<namespace>/"),
        ("<namespace>/<side>/imu", "<namespace>/<side>/imu"), ("<side>/imu", "<side>/imu"),
        ("a/<namespace>/imu", "a/<namespace>/imu"), ("<namespaces>/imu", "<namespaces>/imu"),
        ("<namespace>/$(var x)", "<namespace>/$(var x)"), ("{namespace}/imu", "{namespace}/imu"),
    ],
)  # fmt: skip
def test_a_name_without_the_robot(value: str, name: str) -> None:
    assert without_robot(value) == name


@pytest.mark.parametrize(
    ("layout", "prefix"), [("frames-per-robot", ""), ("frame-prefix", "robot1"), ("L1", "")]
)
def test_a_prefix_alone_is_none_where_frames_have_it(
    layout: str, prefix: str, tmp_path: Path
) -> None:
    (tmp_path / "rover.urdf").write_text(ROVER)
    (tmp_path / "p.yaml").write_text(
        'ekf_filter_node: {ros__parameters: {odom_frame: odom, tf_prefix: "<namespace>"}}\n'
    )
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(
        f"layout: {layout}\naffix: prefix\ndescription: rover.urdf\nnode_sets: robot_localization\n"
        "robots: [{name: robot1}, {name: robot2}]\nrelated_files: {params: p.yaml}\n"
    )
    outputs = make_outputs(plan_fleet(read_fleet(str(fleet), "", {})))
    (text,) = (it.data for it in outputs.files if it.path == "robot1/p.yaml")
    ekf = yaml.safe_load(text)["/robot1/ekf_filter_node"]["ros__parameters"]
    assert ekf["tf_prefix"] == prefix
    assert ekf["odom_frame"] == ("robot1/odom" if layout == "frames-per-robot" else "odom")
    assert [it for it in outputs.findings if it.code in ("MB105", "MB882")] == []
