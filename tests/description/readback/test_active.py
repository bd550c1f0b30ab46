# SPDX-License-Identifier: Apache-2.0
"""What runs in a description and whether it is known what it opens, by the sources of the programs."""

from __future__ import annotations

import pytest
from lxml import etree

from multibot_rewrite import rewrite, rewrite_all, strip
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.description.checks.meeting import GIVEN, given
from multibot_rewrite.description.readback.active import active_parts, says_what_it_opens
from multibot_rewrite.description.readback.meeting import NOT_TAKEN
from multibot_rewrite.description.readback.other_topics import as_valid_topic
from multibot_rewrite.description.readback.reading import read
from multibot_rewrite.description.readback.xml import read_xml
from multibot_rewrite.description.rewriters.plugin_definitions import load_definitions

ROBOT = (
    '<robot name="r"><link name="world"/><link name="a"/><joint name="j" type="revolute">'
    '<parent link="world"/><child link="a"/></joint>{}</robot>'
)


def robot(inside: str) -> str:
    return ROBOT.format(inside)


def plugin(name: str, inside: str = "") -> str:
    return f'<gazebo><plugin name="p" filename="lib{name}.so">{inside}</plugin></gazebo>'


def hardware(class_: str, inside: str = "") -> str:
    block = f"<hardware><plugin>{class_}</plugin></hardware>"
    return f'<ros2_control name="h" type="system">{inside or block}<joint name="j"/></ros2_control>'


def why(text: str, layout: str = "postfix", distro: str = "jazzy") -> tuple[str, ...]:
    return rewrite(text, "robot1", layout=layout, distro=distro).not_verified


@pytest.mark.parametrize(
    ("inside", "reason"),
    [
        (hardware("my_robot_hardware/MyRobotSystem"), "1 hardware class not known"),
        ('<webots><plugin type="my_driver.my_driver.MyDriver"/></webots>', "1 plugin not known"),
        ("<gazebo><include><uri>model://eye</uri></include></gazebo>", "1 included model not read"),
        (
            '<gazebo><plugin name="gz::sim::systems::PythonSystemLoader" '
            'filename="gz-sim-python-system-loader-system"><module_name>m</module_name></plugin></gazebo>',
            "1 plugin not known",
        ),
        (
            '<gazebo reference="a"><sensor name="s" type="acme_sonar"/></gazebo>',
            "1 plugin not known",
        ),
        (plugin("gazebo_yarp_camera"), "1 plugin not known"),
        # A plugin in a plugin (gz-sim SystemManager.cc: it is read by the system around it).
        (
            plugin("ArduPilotPlugin", '<plugin name="q" filename="libunheard.so"/>'),
            "1 plugin not known",
        ),
    ],
)
@pytest.mark.parametrize("layout", ["postfix", "tf-per-robot", "frames-per-robot", "both"])
def test_nothing_active_is_proved_by_silence(inside: str, reason: str, layout: str) -> None:
    assert reason in why(robot(inside), layout)


def test_a_plugin_written_for_ros_1_beside_one_for_ros_2_is_that_of_ros_2() -> None:
    """gazebo_ros_camera.cpp of ROS 2: its node is called as the plugin, whatever ROS 1's tags say."""
    old = plugin("gazebo_ros_camera", "<cameraName>c</cameraName><frameName>a</frameName>")
    new = plugin("gazebo_ros_imu_sensor", "<ros/>")
    made = [rewrite(robot(it), "robot1", layout="postfix") for it in (old, new, old + new)]
    assert [it.not_verified for it in made] == [(), (), ()]
    cameras = [it.text.partition("camera.so")[2].partition("</plugin>")[0] for it in made]
    assert ["<ros>" in it for it in cameras] == [False, False, True]


@pytest.mark.parametrize(
    ("inside", "loaded"),
    [
        (plugin("gazebo_grasp_fix"), ["humble"]),
        # One file for both: the Gazebo that is started passes over what it has not.
        (
            plugin("gazebo_grasp_fix") + plugin("gz-sim-pose-publisher-system"),
            ["humble", "jazzy", "lyrical"],
        ),
        ("<!-- libgazebo_grasp_fix.so -->", ["humble", "jazzy", "lyrical"]),
    ],
)
def test_a_plugin_of_classic_is_not_proved_where_no_gazebo_loads_it(
    inside: str, loaded: list[str]
) -> None:
    """REP 2000: Humble is the last release with Gazebo Classic."""
    given = {it: why(robot(inside), distro=it) for it in ("humble", "jazzy", "lyrical")}
    assert [it for it, reason in given.items() if not reason] == loaded


# ---------------------------------------------------------------- ROS 1


def test_drives_of_ros_1_send_to_one_tf() -> None:
    """tf2_ros (noetic) transform_broadcaster.cpp:38: node_.advertise<tf2_msgs::TFMessage>("/tf")."""
    wheels = "<robotNamespace>/a</robotNamespace><robotBaseFrame>a</robotBaseFrame>"
    text = robot(plugin("gazebo_ros_planar_move", wheels + "<commandTopic>cmd_vel</commandTopic>"))
    reasons = [
        rewrite(text, "r", layout=it).not_verified for it in ("tf-per-robot", "frames-per-robot")
    ]
    assert ["1 topic shared by all robots" in it for it in reasons] == [True, False]


def test_a_foot_contact_of_unitree() -> None:
    """unitree_gazebo foot_contact_plugin.cc:24: /visual/ + the sensor's name + /the_force."""
    sensor = '<sensor name="foot" type="contact">{}</sensor>'
    inside = plugin("unitreeFootContactPlugin")[8:-9]
    text = robot(f'<gazebo reference="a">{sensor.format(inside)}</gazebo>')
    assert why(text, "tf-per-robot") == ("1 topic shared by all robots",)
    assert why(text, "both") == ()


# ---------------------------------------------------------------- addresses


def test_a_port_is_one_robots() -> None:
    """ArduPilotPlugin.cc: fdm_port_in is bound, 9002 where it is absent."""
    assert why(robot(plugin("ArduPilotPlugin"))) == ("1 resource shared by all robots",)
    given = plugin("ArduPilotPlugin", "<fdm_port_in>0</fdm_port_in>")
    assert why(robot(given)) == ()


def own(class_: str, **params: str) -> str:
    inside = "".join(f'<param name="{name}">{it}</param>' for name, it in params.items())
    return hardware(class_).replace("</hardware>", f"{inside}</hardware>")


@pytest.mark.parametrize(
    ("inside", "shared"),
    [
        # default_serial_factory.cpp:41 of robotiq_driver: /dev/ttyUSB0 where nothing is given.
        (own("robotiq_driver/RobotiqGripperHardwareInterface"), 1),
        (own("robotiq_driver/RobotiqGripperHardwareInterface", COM_port="none"), 0),
        (own("dynamixel_hardware/DynamixelHardware", usb_port="/dev/ttyUSB0"), 1),
        (own("dynamixel_hardware/DynamixelHardware", usb_port="/dev/a", use_dummy="true"), 0),
        # ec_master.hpp:34: the master 0.
        (own("ethercat_driver/EthercatDriver"), 1),
        (own("openarm_hardware/OpenArm_v10HW"), 1),
        # hardware_interface.cpp:700 to 714 of ur_robot_driver.
        (own("ur_robot_driver/URPositionHardwareInterface", reverse_port="50001"), 1),
        (own("ur_robot_driver/URPositionHardwareInterface", reverse_port="0"), 0),
        (own("mock_components/GenericSystem", serial_port="/dev/ttyUSB0"), 0),
    ],
)
def test_what_a_driver_opens_on_its_computer_is_one_robots(inside: str, shared: int) -> None:
    made = rewrite(robot(inside), "robot1", affix="prefix")
    found = [it for it in made.findings if it.code == "MB412"]
    assert len(found) == shared
    assert all("a computer of its own" in it.hint for it in found)
    assert any("resource" in it for it in made.not_verified) == bool(shared)


@pytest.mark.parametrize(
    ("inside", "numbers"),
    [
        # system_interface.cpp:394 of lbr_ros2_control: 30200 to 30209.
        (own("lbr_ros2_control::SystemInterface", port_id="30208"), ["30208", "30209", "30208"]),
        (
            plugin("ArduPilotPlugin", "<fdm_port_in>65530</fdm_port_in>"),
            ["65530", "65530", "65530"],
        ),
        (
            plugin("ArduPilotPlugin", "<fdm_port_in>65510</fdm_port_in>"),
            ["65510", "65520", "65530"],
        ),
    ],
)
def test_numbers_end_where_the_last_one_is(inside: str, numbers: list[str]) -> None:
    made = [*rewrite_all(robot(inside), ["a", "b", "c"])]
    found = [etree.fromstring(one.data).xpath("string(//fdm_port_in|//param)") for one in made]
    assert found == numbers
    is_shared = len(set(numbers)) < len(numbers)
    assert all(any("resource" in it for it in one.not_verified) == is_shared for one in made)


# ---------------------------------------------------------------- gz-transport


@pytest.mark.parametrize(
    ("text", "topic"),
    [
        ("~/cmd_vel", "/cmd_vel"),
        ("a//b", "ab"),
        ("/a@b", "/ab"),
        ("/a b", "/a_b"),
        ("/a:=b", "/ab"),
    ],
)
def test_a_valid_topic(text: str, topic: str) -> None:
    """gz-transport TopicUtils.cc:173 (04b8a170) AsValidTopic."""
    assert as_valid_topic(text) == topic


TRIGGER = (
    '<gazebo><plugin name="gz::sim::systems::TriggeredPublisher" '
    'filename="gz-sim-triggered-publisher-system"><input type="gz.msgs.Contacts" topic="{0}"/>'
    '<output type="gz.msgs.Empty" topic="stop"/><service name="/world/w/set_pose" '
    'reqType="gz.msgs.Pose" repType="gz.msgs.Boolean"/></plugin></gazebo>'
    '<gazebo reference="a"><sensor name="s" type="contact"><contact><topic>{1}</topic></contact>'
    "</sensor></gazebo>"
)


def test_ends_that_part_are_told() -> None:
    found = rewrite(robot(TRIGGER.format("hit", "~/hit")), "robot1", distro="jazzy").findings
    assert "MB438" in {it.code for it in found}


CURRENT = "<flow_velocity_topic>current/{}</flow_velocity_topic>"


@pytest.mark.parametrize("layout", ["postfix", "tf-per-robot", "frames-per-robot", "both"])
@pytest.mark.parametrize(("sent", "heard"), [("me", "me"), ("me", "sea")])
def test_a_topic_of_the_world_is_the_robots_where_it_sends_it(
    sent: str, heard: str, layout: str
) -> None:
    """uuv_gazebo_plugins UnderwaterObjectPlugin.cc: the hull subscribes to flow_velocity_topic; DAVE's
    ocean_current_model_plugin.cc advertises its own: one vehicle's, where the two are the same."""
    sender = plugin("dave_ocean_current_model_plugin", CURRENT.format(sent))
    text = robot(sender + plugin("uuv_underwater_object_ros_plugin", CURRENT.format(heard)))
    made = rewrite(text, "robot1", layout=layout)
    end, other = read_xml(made.data, "").iter("flow_velocity_topic")
    assert "MB438" not in {it.code for it in made.findings}
    assert "robot1" in str(end.text)
    assert other.text == (end.text if sent == heard else "current/sea")
    assert strip(made.data, "robot1", layout=layout) == text.encode()


P3D = plugin("gazebo_ros_p3d", "<ros/>").replace('"p"', '"q"')


@pytest.mark.parametrize(
    ("layout", "beside", "met"),
    [("tf-per-robot", P3D, True), ("postfix", P3D, False), ("tf-per-robot", "", False)],
)
def test_a_node_that_no_namespace_reaches(layout: str, beside: str, met: bool) -> None:
    """Plankton ThrusterROSPlugin.cpp makes its node with the plugin's name alone. In ROS 1 it is no
    node: uuv_simulator's plugin is a part of Gazebo's."""
    known = "<linkName>a</linkName><thrusterID>0</thrusterID>"
    text = robot(plugin("uuv_thruster_ros_plugin", known) + beside)
    found = rewrite(text, "robot1", layout=layout, distro="humble").findings
    assert [it.message.split("'")[1] for it in found if it.code == "MG301"] == ["/p"] * met


@pytest.mark.parametrize(
    ("model", "namespace", "parted"), [("r", "", False), ("r", "r", True), ("", "", False)]
)
def test_a_topic_below_the_model_is_met_in_the_namespace_of_its_name(
    model: str, namespace: str, parted: bool
) -> None:
    """rotors_gazebo_plugins gazebo_mavlink_interface.cpp:198 sends on ~/<model>/command, and
    gazebo_motor_model.cpp:301 listens on ~/<robotNamespace>/command."""
    above = f"<robotNamespace>{namespace}</robotNamespace>"
    sent = "<motorSpeedCommandPubTopic>/command</motorSpeedCommandPubTopic>"
    heard = "<commandSubTopic>command</commandSubTopic><jointName>j</jointName>"
    both = plugin("rotors_gazebo_mavlink_interface", sent) + plugin(
        "rotors_gazebo_motor_model", above + heard
    )
    text = robot(both).replace('name="r"', f'name="{model}"')
    assert ("whose ends no longer match" in str(why(text))) == parted


def test_a_word_that_topics_are_made_of_is_no_topic() -> None:
    """gazebo_ros_camera.cpp publishes <camera_name>/image_raw, nothing on the word alone."""
    camera = plugin("gazebo_ros_camera", "<camera_name>eye</camera_name>")[8:-9]
    camera = f'<gazebo reference="a"><sensor name="s" type="camera">{camera}</sensor></gazebo>'
    rule = "<ros><remapping>~/out:={}</remapping></ros>"
    for out, parted in (("eye", False), ("eye/image_raw", True)):
        imu = plugin("gazebo_ros_imu_sensor", rule.format(out)).replace('"p"', '"q"')
        found = rewrite(robot(camera + imu), "robot1", distro="humble").findings
        assert ("MB438" in {it.code for it in found}) == parted


def test_services_of_the_world_keep_their_names() -> None:
    """gz-sim UserCommands.cc: /world/<world>/set_pose is served once, by the world."""
    for layout in ("postfix", "tf-per-robot"):
        made = rewrite(robot(TRIGGER.format("hit", "hit")), "robot1", layout=layout, distro="jazzy")
        assert 'name="/world/w/set_pose"' in made.text


SENSOR = (
    '<gazebo reference="a"><sensor name="s" type="{}"><topic>/boxes/a</topic>{}</sensor></gazebo>'
)
INFO = "<camera><camera_info_topic>/own</camera_info_topic></camera>"


@pytest.mark.parametrize("inside", ["<camera/>", INFO])
@pytest.mark.parametrize(
    "type_", ["boundingbox_camera", "depth_camera", "thermal_camera", "wideanglecamera"]
)
def test_the_camera_info_of_other_cameras_is_beside_their_image(type_: str, inside: str) -> None:
    """gz-sensors8 CameraSensor.cc:391: Load alone reads <camera_info_topic>, and these call that of
    Sensor; :664 AdvertiseInfo replaces the last part of the image's topic."""
    text = robot(SENSOR.format(type_, inside))
    made = rewrite(text, "robot1", distro="jazzy")
    assert made.not_verified == ("1 topic shared by all robots",)
    assert any("/boxes/a/camera_info" in it.message for it in made.findings)
    assert "camera_info_topic>" not in made.text.replace(INFO, "")
    assert rewrite(text, "robot1", topics="prefix", distro="jazzy").not_verified == ()


# ---------------------------------------------------------------- controllers


def simulated(command: str) -> str:
    joint = f'<joint name="j"><command_interface name="{command}"/></joint>'
    block = "<hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>"
    control = f'<ros2_control name="h" type="system">{block}{joint}</ros2_control>'
    manager = (
        '<gazebo><plugin name="gz_ros2_control::GazeboSimROS2ControlPlugin" '
        'filename="gz_ros2_control-system"><parameters>c.yaml</parameters></plugin></gazebo>'
    )
    return robot(control + manager)


@pytest.mark.parametrize("distro", ["jazzy", "lyrical"])
def test_an_arm_sends_no_odometry(distro: str) -> None:
    """ros2_controllers: those that send odometry claim velocity commands of their wheels
    (diff_drive_controller.cpp, command_interface_configuration)."""
    arm = rewrite(simulated("position"), "robot1", layout="tf-per-robot", distro=distro)
    base = rewrite(simulated("velocity"), "robot1", layout="tf-per-robot", distro=distro)
    assert arm.not_verified == base.not_verified == ()
    assert [it.code for it in arm.findings] == []
    # The controllers of Lyrical take no rules but those of their spawner: the summary says it.
    assert [it.code for it in base.findings] == ["MR105"] * (distro == "lyrical")
    assert given(base.findings) == GIVEN[NOT_TAKEN] * (distro == "lyrical")


def test_a_node_without_rules_gets_a_namespace_in_every_layout() -> None:
    """gz_ros2_control_plugin.cpp:361 makes gz_ros_control without arguments, in ros/namespace; :446 the
    controller manager in the same, with the arguments of the plugin. A rule for the manager alone keeps
    it where the layout has it (rcl remap.c: a rule with a node's name is for that node)."""
    made = rewrite(simulated("velocity"), "robot1", distro="jazzy")
    assert made.not_verified == ()
    assert "<namespace>/robot1</namespace>" in made.text
    assert "<remapping>controller_manager_robot1:__ns:=/</remapping>" in made.text
    found = [
        it.name
        for it in read(made.data, "", load_definitions((), "jazzy")).names
        if it.kind == "node"
    ]
    assert found == ["/controller_manager_robot1", "/robot1/gz_ros_control"]
    assert strip(made.data, "robot1", distro="jazzy") == simulated("velocity").encode()


def test_a_namespace_of_the_file_is_the_helpers_alone() -> None:
    """The controller manager stays in the namespace that it had."""
    ros = "</parameters><ros><namespace>/x</namespace></ros>"
    text = simulated("velocity").replace("</parameters>", ros)
    made = rewrite(text, "robot1", distro="jazzy")
    found = [it.name for it in read(made.data, "", load_definitions((), "jazzy")).names]
    assert {"/x/controller_manager_robot1", "/x_robot1/gz_ros_control"} < set(found)
    assert made.not_verified == ()
    assert strip(made.data, "robot1", distro="jazzy") == text.encode()


def control_of_ros_1(namespace: str) -> str:
    return robot(plugin("gazebo_ros_control", namespace))


@pytest.mark.parametrize(
    ("namespace", "layout", "expected"),
    [
        ("<robotNamespace>/a</robotNamespace>", "postfix", "/a_robot1"),
        ("<robotNamespace>/a</robotNamespace>", "tf-per-robot", "/robot1/a"),
        ("<robotNamespace>/</robotNamespace>", "postfix", "/robot1"),
        ("<robotNamespace/>", "postfix", "/robot1"),
        ("<robotNamespace/>", "tf-per-robot", "/robot1"),
        ("", "tf-per-robot", "/robot1"),
    ],
)
def test_ros_1_controllers_are_apart_by_their_namespace(
    namespace: str, layout: str, expected: str
) -> None:
    """gazebo_ros_control_plugin.cpp:85-91: an absent namespace is the model's name, an empty one the
    root; :154 NodeHandle(robot_namespace_), below which controller_manager has its services."""
    made = rewrite(control_of_ros_1(namespace), "robot1", layout=layout)
    assert made.not_verified == ()
    assert f"<robotNamespace>{expected}</robotNamespace>" in made.text
    assert strip(made.data, "robot1", layout=layout) == control_of_ros_1(namespace).encode()


def test_ros_1_has_one_tf() -> None:
    """tf2_ros transform_broadcaster.cpp advertises /tf: frames alone keep robots apart."""
    drive = plugin("gazebo_ros_diff_drive", "<robotNamespace>/a</robotNamespace>")
    assert why(robot(drive), "postfix", "") == ()
    assert why(robot(drive), "tf-per-robot", "") == ("1 topic shared by all robots",)


# Sections of which nobody has looked up what they open, by type: a number that only falls.
LEFT = {"plugin": 11, "hardware": 8, "sensor": 0}


@pytest.mark.more
def test_what_is_not_known_is_counted() -> None:
    definitions = load_definitions((), NEWEST_LTS)
    for type_, most in LEFT.items():
        sections = [
            it
            for it in definitions.sections(type_)
            if it.names[0] != "any_with_ros" and not says_what_it_opens(it)
        ]
        assert len(sections) <= most, [it.name for it in sections]


@pytest.mark.parametrize(
    ("name", "library", "known"),
    [
        ("drone", "libplugin_drone.so", True),
        # gz-sim loads a class by its name, which is no node's: another library of that file name.
        ("sjtu_drone::DroneSimpleController", "libplugin_drone.so", False),
        ("a::label", "libgazebo_ros_diff_drive.so", True),
    ],
)
def test_a_class_of_gz_sim_is_no_plugin_of_classic(name: str, library: str, known: bool) -> None:
    inside = f'<gazebo><plugin name="{name}" filename="{library}"/></gazebo>'
    root = read_xml(robot(inside).encode(), "r.urdf")
    (part,) = active_parts(root, load_definitions((), NEWEST_LTS))
    assert part.is_known == known
