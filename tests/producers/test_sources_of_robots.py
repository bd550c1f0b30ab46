# SPDX-License-Identifier: Apache-2.0
"""What the sources of a robot name becomes ends, addresses, interfaces and transforms of a system."""

from __future__ import annotations

import pytest
from given_parameters import run_given
from lxml import etree

from multibot_rewrite.description.rewriters.plugin_definitions import load_definitions
from multibot_rewrite.knowledge.records import (
    UNKNOWN,
    Endpoint,
    FrameParameter,
    NodeFacts,
    SentTransform,
)
from multibot_rewrite.planning.records import Given, Run
from multibot_rewrite.producers.addresses import held_by, of_hardware, of_parameters
from multibot_rewrite.producers.ends import bridge_rows, edges_off, sensor_frames, sensor_on
from multibot_rewrite.producers.launch.beside_ends import prefix_of
from multibot_rewrite.producers.launch.known_node import known_node
from multibot_rewrite.producers.launch.records import LaunchNote
from multibot_rewrite.producers.launch.snapshot import _caveats, _clocks, _measured, _Part, _refused
from multibot_rewrite.producers.launch.spawners import params_text, ros2_run, ros_arguments
from multibot_rewrite.related_files.yaml_text import read_yaml
from multibot_rewrite.system.records import (
    COMPUTER,
    DEVICE,
    OFF,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    UNTOLD,
    Address,
    Caveat,
    End,
    Heard,
    Parameter,
    Place,
)

AT, THERE = Place("p.yaml", 3), Place("p.yaml", 7)


def given(name: str, known: str = "", manager: str = "", **values: object) -> Run:
    found = {key: Given(it, THERE) for key, it in values.items()}  # type: ignore[arg-type]
    return run_given(name, known, "", found, AT, manager)


def test_the_rows_of_a_bridge_in_a_namespace() -> None:
    """ros_gz_bridge bridge_config.cpp: a row with one name has it on both sides."""
    text = b"""\
- {ros_topic_name: scan, gz_topic_name: gz, ros_type_name: a/msg/B, direction: GZ_TO_ROS}
- {ros_topic_name: /cmd, direction: ROS_TO_GZ}
- topic_name: both
- gz_topic_name: only_gz
- ros_type_name: a/msg/B
"""
    found = [it.end for it in bridge_rows(read_yaml(text, "b.yaml"), "robot1")]
    assert [(it.role, it.name, it.type, it.place.line) for it in found] == [
        (PUBLISHES, "/robot1/scan", "a/msg/B", 1),
        (SUBSCRIBES, "/cmd", "", 2),
        ("", "/robot1/both", "", 3),
        ("", "/robot1/only_gz", "", 4),
    ]
    assert {it.node for it in found} == {"/ros_gz_bridge"}
    assert next(it.end.name for it in bridge_rows(read_yaml(text, "b"))) == "/scan"


_ON_PLATE = """<robot name="r"><link name="base"/><link name="plate"/>
<joint name="j" type="fixed"><parent link="base"/><child link="plate"/></joint>
<gazebo reference="plate"><sensor name="s"><topic>scan</topic>{}</sensor></gazebo>{}</robot>"""
_KEPT = "<gazebo reference='j'><preserveFixedJoint>true</preserveFixedJoint></gazebo>"
_NESTED = """<sdf><model name="r"><model name="arm"><link name="hand"><sensor name="s">
<topic>/scan</topic></sensor></link></model><link name="base"/></model></sdf>"""


@pytest.mark.parametrize(
    ("text", "frame", "link"),
    [
        (_ON_PLATE.format("", ""), "robot1/base/s", "plate"),
        (_ON_PLATE.format("", _KEPT), "robot1/plate/s", "plate"),
        (_ON_PLATE.format("<gz_frame_id>laser</gz_frame_id>", ""), "laser", "plate"),
        # Sensor.cc of gz-sensors8 reads no <frame_id>, and no <ignition_frame_id>.
        (_ON_PLATE.format("<frame_id>laser</frame_id>", ""), "robot1/base/s", "plate"),
        (
            _ON_PLATE.format("<ignition_frame_id>l</ignition_frame_id>", ""),
            "robot1/base/s",
            "plate",
        ),
        (_NESTED, "robot1/arm/hand/s", "hand"),
    ],
)
def test_the_frame_of_a_sensor_is_its_place_or_what_it_says(
    text: str, frame: str, link: str
) -> None:
    """gz-sim Sensors.cc: model::link::sensor without the world; sdformat merges fixed links."""
    sensors = [*sensor_frames(etree.fromstring(text), "robot1", "jazzy")]
    for topic in ("scan", "/scan/points"):
        found = sensor_on(topic, sensors)
        assert found and (found.frame, found.link) == (frame, link)
    assert sensor_on("/scanner", sensors) is None


@pytest.mark.parametrize(
    ("release", "frame"),
    [("humble", "old"), ("jazzy", "gz"), ("kilted", "sdf"), ("lyrical", "sdf")],
)
def test_the_parameter_that_names_a_frame_is_that_of_the_release(release: str, frame: str) -> None:
    """ign-sensors6 Sensor.cc:148 ignition_frame_id first, gz-sensors8 Sensor.cc:188 gz_frame_id alone,
    gz-sensors9 Sensor.cc:181 sdf's FrameId first."""
    texts = {"frame_id": "sdf", "gz_frame_id": "gz", "ignition_frame_id": "old"}
    inside = "".join(f"<{name}>{text}</{name}>" for name, text in texts.items())
    root = etree.fromstring(_ON_PLATE.format(inside, ""))
    assert [it.frame for it in sensor_frames(root, "robot1", release)] == [frame]


HARDWARE = (
    """<robot><ros2_control><hardware><plugin>{}</plugin>{}</hardware></ros2_control></robot>"""
)


@pytest.mark.parametrize(
    ("plugin", "params", "found"),
    [
        ("acme/Arm", {"robot_ip": " 10.0.0.2 ", "speed": "3"}, [("device", "10.0.0.2")]),
        (" mock_components/GenericSystem ", {"robot_ip": "10.0.0.2"}, []),
        ("fake_components/GenericSystem", {"robot_ip": "10.0.0.2"}, []),
        ("acme/Arm", {"robot_ip": ""}, []),
        ("acme/Arm", {}, []),
        # What a class is known to open nothing of.
        ("gz_ros2_control/GazeboSimSystem", {"robot_ip": "10.0.0.2"}, []),
        ("gz_ros2_control/GazeboSimSystem", {"robot_ip": "/dev/ttyUSB0"}, []),
    ],
)
def test_the_devices_of_a_description(
    plugin: str, params: dict[str, str], found: list[tuple[str, str]]
) -> None:
    inside = "".join(f'<param name="{name}">{it}</param>' for name, it in params.items())
    root = etree.fromstring(HARDWARE.format(plugin, inside))
    made = [*of_hardware(root, "/m", AT, load_definitions((), "jazzy"))]
    assert [(it.kind, it.value) for it in made] == found
    assert all(it == Address(it.kind, "robot_ip", it.value, "/m", AT) for it in made)


@pytest.mark.parametrize(
    ("plugin", "params", "found"),
    [
        (
            "robotiq_driver/RobotiqGripperHardwareInterface",
            {},
            [("computer", "COM_port", "/dev/ttyUSB0")],
        ),
        ("ethercat_driver/EthercatDriver", {}, [("computer", "master_id", "0")]),
        ("dynamixel_hardware/DynamixelHardware", {"use_dummy": "true", "usb_port": "/dev/a"}, []),
        (
            "ur_robot_driver/URPositionHardwareInterface",
            {"robot_ip": "10.0.0.2", "reverse_port": "50001", "kinematics/hash": "calib_1"},
            [
                ("device", "robot_ip", "10.0.0.2"),
                ("computer", "reverse_port", "50001"),
                ("calibration", "kinematics/hash", "calib_1"),
            ],
        ),
        (
            "lbr_ros2_control::SystemInterface",
            {"port_id": "30200", "remote_host": "INADDR_ANY"},
            [("computer", "port_id", "30200")],
        ),
    ],
)
def test_what_a_known_class_opens_is_that_of_the_definitions(
    plugin: str, params: dict[str, str], found: list[tuple[str, str, str]]
) -> None:
    """default_serial_factory.cpp of robotiq_driver, ec_master.hpp of ethercat_driver_ros2,
    hardware_interface.cpp:700 of ur_robot_driver, system_interface.cpp:393 of lbr_fri_ros2_node_set."""
    inside = "".join(f'<param name="{name}">{it}</param>' for name, it in params.items())
    root = etree.fromstring(HARDWARE.format(plugin, inside))
    made = of_hardware(root, "/m", AT, load_definitions((), "jazzy"))
    assert [(it.kind, it.name, it.value) for it in made] == found


@pytest.mark.parametrize(
    ("role", "type_", "node", "heard"),
    [
        (PUBLISHES, "sensor_msgs/msg/Imu", "/a", True),
        (SUBSCRIBES, "sensor_msgs/msg/Imu", "/a", False),
        (PUBLISHES, "std_msgs/msg/String", "/a", False),
        (PUBLISHES, "sensor_msgs/msg/Imu", "/b", False),
    ],
)
def test_the_frame_of_a_plugin_is_that_of_the_measurements_it_sends(
    role: str, type_: str, node: str, heard: bool
) -> None:
    part = _Part(node, (End(TOPIC, role, "/imu", type_, "", node, None, ""),), ())
    assert [*_measured([part], {"/a": "imu_link"})] == [Heard("/imu", "imu_link")] * heard


def test_what_a_launch_does_not_say_is_told_once() -> None:
    node = Run("", "n", "/r", "n", (), program="acme/arm", place=AT)
    viewer, bridge = (
        node._replace(name="rviz2"), node._replace(program="ros_gz_bridge/parameter_bridge"),
    )  # fmt: skip
    tree = node._replace(name="rsp", fact=NodeFacts("rsp", "robot_state_publisher", ()))
    notes = [
        LaunchNote(AT, "x is lost"), LaunchNote(THERE, "x is lost"),
        LaunchNote(AT, "it fails", fails=True),
    ]  # fmt: skip
    assert [*_caveats([], [viewer, bridge])] == [] == [*_refused([])]
    assert [*_caveats(notes, [node, node._replace(name="m"), viewer, bridge, tree])] == [
        Caveat("launch-not-whole", True, "p.yaml:3: x is lost"),
        Caveat(
            "node-not-known", True,
            "2 nodes not known, with all topics and frames: /r/n (acme/arm), /r/m (acme/arm);"
            " describe them in a file of nodes (--nodes, docs/node-sets.md)",
        ),
        Caveat(
            "description-not-known", True,
            "the description is not known, so neither are its frames: /r/rsp",
        ),
    ]  # fmt: skip
    assert [*_refused(["/a (x)"])] == [Caveat("rcl-refuses", True, "rcl refuses 1 node: /a (x)")]


@pytest.mark.parametrize(
    ("switch", "values", "prefix"),
    [
        ("", {}, ""), ("", {"tf_prefix": "/a/"}, "a/"), ("", {"tf_prefix": ""}, ""),
        ("on", {}, "r/"), ("on", {"on": True}, "r/"), ("on", {"on": False}, ""),
        ("on", {"tf_frame_prefix": "b"}, "b/"), ("on", {"tf_frame_prefix": "b", "on": False}, ""),
        ("on", {"tf_prefix": "a"}, "r/"),
    ],
)  # fmt: skip
def test_what_a_node_puts_before_its_frames(
    switch: str, values: dict[str, object], prefix: str
) -> None:
    """ros_filter.cpp: tf_prefix; diff_drive_controller.cpp: its namespace, unless it is told not to."""
    facts = NodeFacts("n", "a", (), prefix_switch=switch)
    given = {name: Given(it, THERE) for name, it in values.items()}  # type: ignore[arg-type]
    node = Run("", "n", "/r", "n", (), facts, values=given, program="acme/arm", place=AT)
    assert prefix_of(node) == prefix
    assert prefix_of(node._replace(fact=UNKNOWN)) == (
        f"{values['tf_prefix']}".strip("/") + "/" if values.get("tf_prefix") else ""
    )


WORDS_OF_DEVICES = (
    "robot_ip robot_ip_address robot_address ip ip_address ip_addr controller_ip delto_ip device_ip"
    " sensor_ip sensor_hostname lidar_ip camera_ip hostname"
)
WRITTEN = (
    "save_path save_dir save_folder save_directory output_path output_dir output_folder"
    " output_directory output_file log_path log_dir log_file record_path recording_path bag_path"
)


@pytest.mark.parametrize(
    ("names", "text", "kind"),
    [
        (WORDS_OF_DEVICES, "10.0.0.2", DEVICE), (WORDS_OF_DEVICES, "127.0.0.1", ""),
        (WORDS_OF_DEVICES, "0.0.0.0", ""), (WORDS_OF_DEVICES, "host.local", ""),
        (WORDS_OF_DEVICES, "/dev/ttyUSB0", COMPUTER), ("serial_number serial_no", "1234", DEVICE),
        ("serial_number serial_no", "none", ""), ("serial", "1234", ""),
        ("port udp_port a.lidar_port", "1024", COMPUTER), ("port lidar_port", "1023", ""),
        ("port lidar_port", "/dev/ttyACM0", COMPUTER), ("port_1 ports", "8080", ""),
        (WRITTEN, "/data", COMPUTER), (WRITTEN, "", ""), ("path output", "/data", ""),
        ("path bus", "can0", COMPUTER), ("bus", "vcan1", COMPUTER), ("bus", "can", ""),
        ("bus", "xcan0", ""), ("bus", "/dev/", ""),
    ],
)  # fmt: skip
def test_what_one_process_has_by_a_parameter_that_is_not_known(
    names: str, text: str, kind: str
) -> None:
    """Ports below 1024 are those of the system; 127.0.0.1 is this computer."""
    for name in names.split():
        assert held_by(name, text) == held_by(f"driver.{name}", text) == kind
        found = [*of_parameters("/n", {}, {name: Given(text, THERE)})]
        assert found == ([Address(kind, name, text, "/n", THERE)] if kind else [])


@pytest.mark.parametrize(
    ("value", "notes", "told"),
    [
        (True, (), "true"), (False, (), "false"), (None, (), "false"), ("", (), UNTOLD),
        (None, ((AT, True, ""),), UNTOLD), (None, ((AT, False, "x"),), "false"),
        (None, ((THERE, True, ""),), "false"), (None, ((THERE, True, "x"),), UNTOLD),
        (True, ((AT, True, ""),), "true"),
    ],
)  # fmt: skip
def test_which_time_a_node_runs_on(
    value: object, notes: tuple[tuple[Place, bool, str], ...], told: str
) -> None:
    """The default is false (rclcpp time_source.cpp); what only a run tells is untold."""
    facts = NodeFacts("n", "a", (), known="n")
    values = {} if value is None else {"use_sim_time": Given(value, THERE)}
    node = Run("", "n", "/", "n", (), facts, values=values, program="acme/arm", place=AT)
    others = (
        node._replace(fact=UNKNOWN), node._replace(fact=facts._replace(known="")),
        node._replace(fact=facts._replace(known="static_transform_publisher")),
        node._replace(program="ros_gz_bridge/parameter_bridge"),
    )  # fmt: skip
    said = [LaunchNote(at, "lost", parameters, file) for at, parameters, file in notes]
    assert [*_clocks([node], said)] == [Parameter("/n", "use_sim_time", told)]
    mute = [Parameter("/n", "use_sim_time", UNTOLD)] if told == UNTOLD else []
    assert [[*_clocks([it], said)] for it in others] == [mute, mute, mute, []]
    untold = [*_clocks([node._replace(untold=("use_sim_time",))], [])]
    assert untold == [Parameter("/n", "use_sim_time", UNTOLD)]


EKF = NodeFacts(
    "ekf",
    "acme",
    (),
    frames=(
        FrameParameter("odom", "odom"),
        FrameParameter("base", "base"),
        FrameParameter("map", "map"),
    ),
    sends=(SentTransform("odom", "base", "publish_tf and sure"),),
)


@pytest.mark.parametrize(
    ("values", "places"),
    [
        ({"publish_tf": False, "sure": True}, [THERE]),
        ({"publish_tf": True, "sure": True}, []),
        # Two switches at once: neither alone.
        ({"publish_tf": False, "sure": False}, []),
        ({"sure": True}, []),
    ],
)
def test_a_transform_that_one_parameter_switches_off(
    values: dict[str, object], places: list[Place]
) -> None:
    found = [*edges_off([given("ekf", "ekf", **values)], {"ekf": EKF})]
    assert [it.place for it in found] == places
    assert all((it.sure, it.parent, it.child) == (OFF, "odom", "base") for it in found)
    assert [*edges_off([given("ekf", "other", **values)], {"ekf": EKF})] == []


def test_words_that_rcl_reads() -> None:
    """rcl arguments.c: between --ros-args and -- they are ROS's own."""
    words = (
        *("own", "--ros-args", "-r", "__node:=n", "--remap", "__ns:=/a", "-r", "x:=y"),
        *(
            "-p",
            "a:=1",
            "--param",
            "b:=2",
            "--params-file",
            "f.yaml",
            "-r",
            "none",
            "--",
            "-r",
            "z:=w",
        ),
    )
    found = ros_arguments(words)
    assert (found.name, found.namespace, found.rules) == ("n", "/a", (("x", "y"),))
    assert (found.values, found.files) == ((("a", "1"), ("b", "2")), ("f.yaml",))
    assert found.own == ("own", "-r", "z:=w")
    assert ros_arguments(["--ros-args", "-r", "__name:=m"]).name == "m"
    assert params_text(found.values) == "/**:\n  ros__parameters:\n    a: 1\n    b: 2\n"
    assert params_text(()) == ""


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("ros2 run p e", ("p", "e", ())),
        ("/opt/ros/bin/ros2 run p e a b", ("p", "e", ("a", "b"))),
        ("ros2 run --prefix gdb p e", ("p", "e", ())),
        ("ros2 run -d p e", ("p", "e", ())),
        ("ros2 run p", None),
        ("ros2 launch p e", None),
        ("ros run p e", None),
    ],
)
def test_a_line_of_ros2_run(line: str, found: object) -> None:
    assert ros2_run(line.split()) == found


def launched(package: str, executable: str, name: str = "", arguments: tuple[str, ...] = ()):
    from launched_nodes import started

    return started(package, executable, name, arguments=arguments)


KNOWN = {
    it.name: it
    for it in (
        NodeFacts("driver", "acme", ()),
        NodeFacts("hosted", "acme", (), host="driver"),
        NodeFacts("camel_case", "acme", ()),
        NodeFacts("runner", "acme", (), programs=("run", "other/run")),
    )
}


@pytest.mark.parametrize(
    ("package", "executable", "name", "found"),
    [
        ("acme", "driver", "", "driver"),
        ("acme", "driver_node", "x", "driver"),
        ("acme", "x", "driver", "driver"),
        ("acme", "acme::CamelCase", "", "camel_case"),
        ("acme", "hosted", "", ""),
        ("acme", "run", "", "runner"),
        ("other", "run", "", "runner"),
        ("other", "driver", "driver", ""),
    ],
)
def test_a_launched_program_is_a_known_node(
    package: str, executable: str, name: str, found: str
) -> None:
    node = known_node(launched(package, executable, name), (), KNOWN)
    assert (node.name if node else "") == found


def test_a_node_of_a_node_set_comes_first_with_the_ends_of_its_program() -> None:
    ends = (
        Endpoint(TOPIC, PUBLISHES, "a", when="-s set"),
        Endpoint(TOPIC, PUBLISHES, "b", when="program: driver|other"),
        Endpoint(SERVICE, SERVES, "c", when="program: else"),
    )
    own = NodeFacts("driver", "acme", ends, note="of the node set")
    with_word = known_node(launched("acme", "driver", "driver", ("-s",)), (own,), KNOWN)
    assert with_word is not None and with_word.note == "of the node set"
    assert [(it.name, it.when) for it in with_word.endpoints] == [("a", ""), ("b", "")]
    without = known_node(launched("acme", "driver", "driver"), (own,), KNOWN)
    assert without is not None
    assert [it.name for it in without.endpoints] == ["b"]
    part = known_node(launched("acme", "acme::Driver", "driver"), (own,), KNOWN)
    assert part is not None
    assert [it.name for it in part.endpoints] == ["b", "c"]


def test_a_program_started_in_a_way_that_its_entry_does_not_tell_is_not_known() -> None:
    relay = {"relay": NodeFacts("relay", "t", (Endpoint(TOPIC, PUBLISHES, "<o>", when="- unset"),))}
    assert known_node(launched("t", "relay"), (), relay) is not None
    assert known_node(launched("t", "relay", arguments=("/a", "/b")), (), relay) is None
