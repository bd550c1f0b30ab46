"""What is open in a robot, asked of each step alone. What needs and gives what is said here by hand."""

from __future__ import annotations

import pytest
from lxml import etree

from multibot_rewrite.closure.frames import frame_gaps
from multibot_rewrite.closure.gap import Gap
from multibot_rewrite.closure.interfaces import interface_gaps
from multibot_rewrite.closure.moveit import moveit_gaps
from multibot_rewrite.closure.topics import End, closed, topic_gaps
from multibot_rewrite.companions.yaml_text import read_yaml
from multibot_rewrite.evidence.hardware import Exported, exported
from multibot_rewrite.evidence.records import Given, GivenNode
from multibot_rewrite.knowledge.records import Claim
from multibot_rewrite.knowledge.stacks import load_nodes
from multibot_rewrite.releases import NEWEST_LTS
from multibot_rewrite.system.records import Place

IMU, SCAN = "sensor_msgs/msg/Imu", "sensor_msgs/msg/LaserScan"
HERE = Place("bridge.yaml", 4)


def end(
    node: str, role: str, name: str, type_: str = IMU, kind: str = "topic", sure: bool = True
) -> End:
    return End(node, kind, role, name, type_, name.rpartition("/")[2], node, HERE, sure)


READS = end("ekf", "subscribes", "/r/imu/data")


def told(*ends: End, more: tuple[End, ...] = ()) -> list[tuple[str, str, str]]:
    return [(it.node, it.name, it.near) for it in topic_gaps([READS, *ends], more)]


def test_what_nothing_sends_is_a_gap() -> None:
    assert told() == [("ekf", "/r/imu/data", "")]


def test_what_is_sent_closes_it_whoever_sends_it() -> None:
    sent = end("bridge", "publishes", "/r/imu/data")
    assert told(sent) == []
    assert told(more=(sent,)) == []
    # It is not known which end the bridge has: it may send it.
    assert told(end("bridge", "", "/r/imu/data")) == []


def test_another_reader_or_another_kind_closes_nothing() -> None:
    assert told(end("rviz", "subscribes", "/r/imu/data"))[0][1:] == ("/r/imu/data", "")
    assert told(end("bridge", "serves", "/r/imu/data", kind="service")) == [
        ("ekf", "/r/imu/data", "")
    ]


def test_a_client_needs_its_server() -> None:
    calls = end("lifecycle", "calls", "/r/load_map", "nav2_msgs/srv/LoadMap", "service")
    serves = calls._replace(node="map_server", role="serves")
    assert [it.name for it in topic_gaps([calls])] == ["/r/load_map"]
    assert list(topic_gaps([calls, serves])) == []


def test_the_only_topic_of_its_type_is_meant_and_where_it_is() -> None:
    other = end("bridge", "publishes", "/r/other_name")._replace(place=Place("b.yaml", 7))
    gap = next(topic_gaps([READS, other]))
    assert (gap.near, gap.near_place, gap.place) == ("/r/other_name", Place("b.yaml", 7), HERE)


@pytest.mark.parametrize(
    "sent",
    [
        end("bridge", "publishes", "/r/imu", SCAN),
        end("bridge", "publishes", "/r/imu", ""),
        end("ekf", "publishes", "/r/imu"),
        end("bridge", "serves", "/r/imu", kind="service"),
    ],
    ids=["another type", "no type", "its own", "a service"],
)
def test_what_is_not_meant(sent: End) -> None:
    assert told(sent)[0] == ("ekf", "/r/imu/data", "")


def test_of_several_the_one_with_the_same_last_word_is_meant() -> None:
    sent = [end("bridge", "publishes", it) for it in ("/r/imu_raw/dat", "/r/gyro_front/data")]
    assert told(*sent) == [("ekf", "/r/imu/data", "/r/gyro_front/data")]


def test_of_several_with_that_word_the_one_most_like_it_is_meant() -> None:
    sent = [end("bridge", "publishes", it) for it in ("/r/gyroscope/data", "/r/imu0/data")]
    assert told(*sent) == [("ekf", "/r/imu/data", "/r/imu0/data")]


def test_what_people_send_is_no_gap_by_either_name() -> None:
    command = end("drive", "subscribes", "/r/cmd_vel")
    remapped = command._replace(name="/r/drive_input")
    assert list(topic_gaps([command, remapped])) == []
    assert next(topic_gaps([remapped._replace(code_name="input")])).name == "/r/drive_input"


def test_an_end_on_a_condition_is_no_gap() -> None:
    assert list(topic_gaps([READS._replace(sure=False)])) == []


def test_the_keys_of_what_is_closed() -> None:
    sent = end("bridge", "publishes", "/r/imu/data")
    open_ = end("ekf", "subscribes", "/r/odom")
    assert closed([READS, sent, open_]) == {("topic", "subscribes", "ekf", "data")}
    assert closed([READS, open_], [sent]) == {("topic", "subscribes", "ekf", "data")}


SYSTEM = """<robot name="r">
  <ros2_control name="a" type="system">
    <joint name="wheel">
      <command_interface name="velocity"/>
      <state_interface name="position"/>
    </joint>
    <sensor name="imu"><state_interface name="orientation.x"/></sensor>
    <gpio name="io"><command_interface name="led"/></gpio>
    <other name="no"><command_interface name="led"/></other>
  </ros2_control>
</robot>"""


def test_what_a_system_exports_by_kind_and_line() -> None:
    found = [tuple(it) for it in exported(etree.fromstring(SYSTEM), "r.urdf")]
    assert found == [
        ("command", "wheel/velocity", ("r.urdf", 4)),
        ("state", "wheel/position", ("r.urdf", 5)),
        ("state", "imu/orientation.x", ("r.urdf", 7)),
        ("command", "io/led", ("r.urdf", 8)),
    ]


FILE = Place("c.yaml", 3)
DRIVE = load_nodes(NEWEST_LTS)["ekf_filter_node"]._replace(
    claims=(Claim("command", "<joints>/velocity", ""), Claim("state", "<joints>/position", ""))
)
KNOWN = {"drive": DRIVE}


def controller(*joints: str, name: str = "base", manager: str = "controller_manager") -> GivenNode:
    values = {"joints": Given(list(joints), Place("c.yaml", 9))}
    return GivenNode(name, "drive", "acme/Drive", values, FILE, manager)


def lacking(*given: GivenNode, text: str = SYSTEM) -> list[Gap]:
    exports: list[Exported] = list(exported(etree.fromstring(text), "r.urdf"))
    return list(interface_gaps(given, KNOWN, exports))


def test_a_controller_whose_joints_the_hardware_has() -> None:
    assert lacking(controller("wheel")) == []


def test_an_interface_that_the_hardware_lacks_and_the_one_that_is_meant() -> None:
    command, state = lacking(controller("whel"))
    assert (command.name, command.node) == ("command interface whel/velocity", "base")
    assert (command.near, command.near_place) == ("wheel/velocity", Place("r.urdf", 4))
    assert (state.near, state.near_place) == ("wheel/position", Place("r.urdf", 5))
    assert command.place == Place("c.yaml", 9)
    assert command.key != state.key


def test_the_kind_of_an_interface_counts() -> None:
    text = SYSTEM.replace("command_interface", "state_interface")
    assert [it.name for it in lacking(controller("wheel"), text=text)] == [
        "command interface wheel/velocity"
    ]


def test_interfaces_of_another_controller_are_there() -> None:
    pid = controller("wheel", name="ns/pid")
    assert lacking(pid, controller("pid/wheel")) == []
    assert len(lacking(pid, controller("pi/wheel"))) == 2


def test_without_hardware_or_without_a_manager_nothing_is_said() -> None:
    assert lacking(controller("whel"), text='<robot name="r"/>') == []
    assert lacking(controller("whel", manager="")) == []


def ekf(**values: object) -> GivenNode:
    given = {it: Given(value, Place("ekf.yaml", 5)) for it, value in values.items()}  # type: ignore[arg-type]
    return GivenNode("ekf", "ekf_filter_node", "", given, FILE)


OFF = ekf(publish_tf=False, odom_frame="odom", base_link_frame="base", world_frame="odom")


def test_a_transform_that_is_switched_off_and_that_nobody_sends() -> None:
    both = [OFF, OFF._replace(name="second")]
    (gap,) = frame_gaps(both, load_nodes(NEWEST_LTS), ["imu_link"])
    place = Place("ekf.yaml", 5)
    assert (gap.kind, gap.name, gap.node, gap.place) == ("frame", "base", "ekf", place)


def test_a_transform_that_another_one_sends_is_no_gap() -> None:
    assert list(frame_gaps([OFF], load_nodes(NEWEST_LTS), ["base"])) == []


def test_a_filter_of_the_map_would_send_another_one() -> None:
    of_map = OFF._replace(values={**OFF.values, "world_frame": Given("map", FILE)})
    assert [it.name for it in frame_gaps([of_map], load_nodes(NEWEST_LTS), [])] == ["odom"]


def test_a_filter_that_sends_has_no_gap() -> None:
    on = OFF._replace(values={**OFF.values, "publish_tf": Given(True, FILE)})
    assert list(frame_gaps([on], load_nodes(NEWEST_LTS), [])) == []


MOVEIT = """\
move_group:
  ros__parameters:
    moveit_simple_controller_manager:
      controller_names: [arm, hand, absent]
      arm:
        joints: [wheel, elbo]
      hand: {type: GripperCommand}
      unnamed: {joints: [x]}
"""


def test_what_moveit_sends_to_and_nobody_declares() -> None:
    values = {"joints": Given(["wheel", "elbow"], Place("c.yaml", 9))}
    given = [controller(name="ns/arm")._replace(values=values), controller(name="hands")]
    joint, missing = moveit_gaps([read_yaml(MOVEIT.encode(), "moveit.yaml")], given)
    assert (joint.kind, joint.name, joint.node) == ("joint", "joint elbo of arm", "MoveIt")
    assert (joint.place, joint.near, joint.near_place) == (
        Place("moveit.yaml", 6),
        "elbow",
        Place("c.yaml", 9),
    )
    assert (missing.kind, missing.name) == ("controller", "controller hand")
    assert (missing.place, missing.near, missing.near_place) == (
        Place("moveit.yaml", 7),
        "hands",
        FILE,
    )


def test_without_declared_controllers_nothing_is_said_of_moveit() -> None:
    document = read_yaml(MOVEIT.encode(), "moveit.yaml")
    assert list(moveit_gaps([document], [controller(name="arm", manager="")])) == []
