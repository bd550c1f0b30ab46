# SPDX-License-Identifier: Apache-2.0
"""Defaults made of the description's own names (DiffDrive.cc, gazebo_ros_camera.cpp)."""

from __future__ import annotations

import pytest
from description_calls import load_definitions, read

from multibot_rewrite import ProofError, rewrite
from multibot_rewrite.description.rewriters import insert
from multibot_rewrite.description.rewriters.plugin_definitions.grammar import SPAWNED

DRIVE = '<plugin name="gz::sim::systems::DiffDrive" filename="gz-sim-diff-drive-system">{}</plugin>'
ODOMETRY = (
    '<plugin name="gz::sim::systems::OdometryPublisher" filename="gz-sim-odometry-publisher-system">'
    "{}</plugin>"
)
BOTH_FRAMES = "<frame_id>odom</frame_id><child_frame_id>hull</child_frame_id>"
# The second link is the root of this URDF.
URDF = """<robot name="r"><link name="wheel"/><link name="hull"/>
<joint name="j" type="fixed"><parent link="hull"/><child link="wheel"/></joint>
<gazebo>{}</gazebo></robot>"""
ON_WORLD = """<robot name="r"><link name="world"/><link name="hull"/>
<joint name="j" type="fixed"><parent link="world"/><child link="hull"/></joint>
<gazebo>{}</gazebo></robot>"""
SDF = """<sdf version="1.9"><model name="m"{}><link name="a"/><link name="b"/>{}</model></sdf>"""


def missed(text: str, release: str = "jazzy") -> list[str]:
    missed = read(text.encode(), "f", load_definitions((), release)).missed
    return [it.name.replace(SPAWNED, "{model}/") for it in missed]


@pytest.mark.parametrize(
    ("text", "names"),
    [
        (URDF.format(DRIVE.format("")), ["{model}/odom", "{model}/hull"]),
        (ON_WORLD.format(DRIVE.format("")), ["{model}/odom", "{model}/hull"]),
        (SDF.format("", DRIVE.format("")), ["{model}/odom", "{model}/a"]),
        (SDF.format(' canonical_link="b"', DRIVE.format("")), ["{model}/odom", "{model}/b"]),
        (URDF.format(DRIVE.format(BOTH_FRAMES)), []),
        (URDF.format(DRIVE.format(BOTH_FRAMES) + ODOMETRY.format("")), []),
        (URDF.format(ODOMETRY.format("")), ["{model}/odom", "{model}/base_footprint"]),
        # An empty frame is the default of DiffDrive, and the empty text for OdometryPublisher.
        (URDF.format(DRIVE.format("<frame_id/>")), ["{model}/odom", "{model}/hull"]),
        (URDF.format(ODOMETRY.format("<odom_frame/>")), ["{model}/base_footprint"]),
    ],
)
def test_frames_below_the_models_name(text: str, names: list[str]) -> None:
    assert missed(text) == names


def test_no_message_of_fortress_mecanum_has_a_frame() -> None:
    text = URDF.format(DRIVE.format("").replace("DiffDrive", "MecanumDrive"))
    text = text.replace("diff-drive", "mecanum-drive")
    assert missed(text, "humble") == []
    assert missed(text, "jazzy") == ["{model}/odom", "{model}/hull"]


@pytest.mark.parametrize("layout", ["L1", "L2", "L3", "L4"])
def test_the_second_reading_refuses_frames_that_were_not_filled_in(
    monkeypatch: pytest.MonkeyPatch, layout: str
) -> None:
    def every_host(hosts: insert.Hosts, naming: object) -> frozenset[object]:
        return frozenset(host for host, _ in hosts)

    source = URDF.format(DRIVE.format(""))
    assert b"{model}" not in rewrite(source, "robot1", layout=layout).data
    monkeypatch.setattr(insert, "second_senders", every_host)
    with pytest.raises(ProofError, match="a frame that tf does not have"):
        rewrite(source, "robot1", layout=layout)


def test_two_drives_of_nothing_but_the_world_are_filled_in_alike() -> None:
    drive = DRIVE.format("<child_frame_id>world</child_frame_id>")
    source = f'<robot name="r"><link name="world"/><gazebo>{drive}{drive}</gazebo></robot>'
    assert rewrite(source, "robot1", layout="L4").data.count(b"<frame_id>odom/robot1<") == 2


CAMERA = """<robot name="r"><link name="l"/><gazebo reference="l"><sensor name="eye" type="camera">
<plugin name="driver" filename="libgazebo_ros_camera.so"/></sensor></gazebo></robot>"""


@pytest.mark.parametrize(
    ("policy", "written"),
    [
        # In a namespace, and the sensor keeps its name: eye/image_raw stays where it is.
        ({"layout": "L1"}, None),
        # The sensor becomes eye_robot1, its topics stay below eye.
        ({"layout": "L2"}, b"<camera_name>eye</camera_name>"),
        # No namespace, and the sensor keeps its name: all robots would have eye/image_raw.
        ({"layout": "L1", "topics": "postfix"}, b"<camera_name>eye_robot1</camera_name>"),
        # The sensor's new name is just what the topics have to be below.
        ({"layout": "L4"}, None),
    ],
)
def test_a_cameras_topics_stay_where_their_readers_are(
    policy: dict[str, str], written: bytes | None
) -> None:
    made = rewrite(CAMERA, "robot1", **policy).data  # type: ignore[arg-type]
    assert (b"<camera_name>" in made) is (written is not None)
    assert written is None or written in made


def test_the_second_reading_sees_a_camera_that_all_robots_share(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(insert, "filled", lambda *_: "")
    monkeypatch.setattr(insert, "default_of", lambda *_: "")
    found = rewrite(CAMERA, "robot1", layout="L1", topics="postfix").findings
    assert "MG320" in {it.code for it in found if "eye" in it.message}


ACKERMANN = """<robot name="r"><link name="hull"/><gazebo>
<plugin filename="gz-sim-ackermann-steering-system" name="gz::sim::systems::AckermannSteering">
<steering_only>true</steering_only><use_actuator_msg>true</use_actuator_msg></plugin></gazebo></robot>"""


@pytest.mark.parametrize(("release", "topic"), [("humble", ""), ("jazzy", "/actuators/robot1")])
def test_a_default_is_that_of_the_release(release: str, topic: str) -> None:
    """AckermannSteering.cc of gz-sim8 makes it of three parameters, ignition-gazebo6 reads none."""
    made = rewrite(ACKERMANN, "robot1", distro=release)
    assert made.not_verified == ()
    assert [it.new for it in made.changes if it.old == "/actuators"] == ([topic] if topic else [])
    assert ("<frame_id>" in made.text) == (release == "humble")
