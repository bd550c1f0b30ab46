# SPDX-License-Identifier: Apache-2.0
"""Fleets whose names are words of other names, and rows of bridges with names of their own: they are
built, and ``check-launch`` finds no error in them.

Expectations: gz-sim Sensors.cc (a sensor is called by its model where the description names no frame),
ros_gz_bridge bridge_config.cpp (a row has a name of its own on each side).
"""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from drawn_builds import run
from drawn_fleets import BRIDGE, KINDS

pytestmark = pytest.mark.usefixtures("here")
ROVER = KINDS["gz rover"].text.replace("ROBOT", "rover")
UNNAMED = ROVER.replace("<gz_frame_id>lidar_link</gz_frame_id>", "")
LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")
FRAMES = "{{ros_topic_name: {}, gz_topic_name: tf, ros_type_name: tf2_msgs/msg/TFMessage,\
 gz_type_name: gz.msgs.Pose_V, direction: GZ_TO_ROS}}"


def built(data: dict[str, object], files: dict[str, str]) -> tuple[str, str]:
    """Return what build and check-launch say; both find no error."""
    for path, text in files.items():
        Path(path).write_text(text)
    Path("fleet.yaml").write_text(yaml.safe_dump({"distro": "jazzy", **data}))
    code, of_build = run("build", "fleet.yaml", "-o", "out")
    assert code == 0, of_build
    code, of_check = run("check-launch", "out/fleet.launch.py", "--plan", "out/plan.yaml")
    assert code in (0, 3), of_check
    assert " error: " not in of_check
    return of_build, of_check


@pytest.mark.sample(2)
@pytest.mark.parametrize("layout", LAYOUTS)
def test_robots_may_be_called_as_words_of_frames_and_topics(layout: str) -> None:
    """The first robot has none of these frames; topics below that of a lidar end with ``points``."""
    other = {"description": "barrow.urdf", "simulator": "none"}
    rovers = [
        {"name": name, "description": "rover.urdf", "pose": {"x": 3 * at}}
        for at, name in enumerate(("link", "lidar", "scan", "a"))
    ]
    files = {"rover.urdf": ROVER, "barrow.urdf": KINDS["barrow"].text}
    built({"layout": layout, "robots": [{"name": "barrow1", **other}, *rovers]}, files)


@pytest.mark.sample(2)
@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_model_may_be_called_as_another_robot_and_more(layout: str) -> None:
    robots = [{"name": "rover"}, {"name": "amr_01", "model": "rover_2", "pose": {"x": 3}}]
    data = {"layout": layout, "description": "rover.urdf", "robots": robots}
    said, _ = built(data, {"rover.urdf": UNNAMED})
    assert "MG411" not in said


@pytest.mark.sample(2)
@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("name", ["gz/tf", "gz_tf"])
def test_a_row_may_bring_the_frames_of_the_simulator_elsewhere(layout: str, name: str) -> None:
    """They are nobody's tree then; that the robot's tree lacks them is a warning that says where they
    are."""
    robots = [{"name": "a"}, {"name": "b", "pose": {"x": 3}}]
    related_files = {"bridge": ["rows.yaml"]}
    data = {"layout": layout, "description": "rover.urdf", "related_files": related_files}
    files = {"rover.urdf": ROVER, "rows.yaml": f"{BRIDGE}- {FRAMES.format(name)}\n"}
    for said in built({**data, "robots": robots}, files):
        if layout != "frames-per-robot":
            (line,) = (it for it in said.splitlines() if "MG406" in it)
            assert "warning" in line and "ros_gz_bridge" in line and "bring it to tf, too" in line


@pytest.mark.sample(2)
@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("names", [("left_arm", "arm_left"), ("robot_a", "robota")])
def test_robots_of_names_alike_do_not_mean_each_other(names: tuple[str, str], layout: str) -> None:
    """The one has no lidar and no odometry, the other nothing that drives it: that is no error, and
    neither is meant by the other's topics."""
    cart = {"name": names[0], "description": "cart.urdf", "node_sets": ["nav2"]}
    rover = {"name": names[1], "description": "rover.urdf", "pose": {"x": 3}}
    files = {"rover.urdf": ROVER, "cart.urdf": KINDS["plain cart"].text}
    built({"layout": layout, "robots": [cart, rover]}, files)


@pytest.mark.parametrize("name", ["bridge", "container", "teleop"])
def test_a_node_is_no_tool_because_its_robot_is_called_so(name: str) -> None:
    """amcl_bridge is the amcl of the robot that is called bridge, and counts as such."""
    robots = [{"name": name}, {"name": "b", "pose": {"x": 3}}]
    data = {"layout": "postfix", "description": "rover.urdf", "node_sets": "nav2", "robots": robots}
    for said in built(data, {"rover.urdf": ROVER}):
        (counted,) = (it for it in said.splitlines() if " nodes each" in it)
        assert " to " not in counted.partition(" nodes each")[0]


CAMERA = """<gazebo reference="lidar_link"><sensor name="cam" type="camera"><topic>camera/image</topic>
<camera><camera_info_topic>camera/camera_info</camera_info_topic></camera>
<gz_frame_id>lidar_link</gz_frame_id></sensor></gazebo></robot>"""
SEEN = """\
perception:
  ros__parameters:
    image_topic: camera/image
    topics: [camera/image, /{}/image]
"""


@pytest.mark.sample(2)
@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_robot_may_be_called_as_a_part_of_all(layout: str) -> None:
    """camera/image is the topic of a camera, also of the robot that is called camera. A word that is no
    part of a robot still tells of one."""
    robots = [{"name": "camera"}, {"name": "rex", "pose": {"x": 3}}]
    data = {"layout": layout, "description": "rover.urdf", "robots": robots}
    data["related_files"] = {"params": ["seen.yaml"]}
    files = {"rover.urdf": ROVER.replace("</robot>", CAMERA)}
    said, _ = built(data, {**files, "seen.yaml": SEEN.format("camera")})
    assert "MB863" not in said
    Path("seen.yaml").write_text(SEEN.format("rex"))
    code, said = run("build", "fleet.yaml", "-o", "other")
    assert code == 1
    assert "seen.yaml:4:" in said and "error: MB863" in said


JOINT_STATES = """<gazebo><plugin name="jsp" filename="libgazebo_ros_joint_state_publisher.so">
<ros>{}</ros><joint_name>left_wheel_joint</joint_name></plugin></gazebo></robot>"""


@pytest.mark.sample(2)
@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize(
    "rule",
    [
        "<remapping>__node:=other</remapping>",
        "<remapping>__ns:=/below</remapping>",
        "<argument>__node:=other</argument>",
    ],
)
def test_a_plugin_of_gazebo_classic_may_name_its_node_by_a_rule(rule: str, layout: str) -> None:
    """rcl takes __node and __ns before any other rule (rcl node.c, rcl_remap_node_name); gazebo_ros
    node.cpp hands both elements on as arguments."""
    text = KINDS["classic rover"].text.replace("ROBOT", "rover")
    robots = [{"name": "a"}, {"name": "b", "pose": {"x": 3}}]
    data = {"distro": "humble", "layout": layout, "description": "rover.urdf", "robots": robots}
    files = {"rover.urdf": text.replace("</robot>", JOINT_STATES.format(rule))}
    for said in built(data, files):
        assert not {code for code in ("MR103", "MG101", "MG108") if code in said}, said
