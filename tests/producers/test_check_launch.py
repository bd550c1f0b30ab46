# SPDX-License-Identifier: Apache-2.0
"""What would run by a launch: names by rcl's rules, transforms by parameters, and what hurts there.

The launch graphs are records as the evidence has them. Expectations: rcl's remapping (remap.c), the
code of the nodes and of tf2_ros.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import pytest
import yaml
from launched_nodes import AT

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.producers.launch import child
from multibot_rewrite.producers.launch.records import (
    LaunchedNode,
    LaunchGraph,
    LaunchNote,
    ParameterText,
)
from multibot_rewrite.producers.launch.running import Knowledge
from multibot_rewrite.producers.launch.snapshot import launched
from multibot_rewrite.rules.launch.judge import judge_launch
from multibot_rewrite.system.records import System

TF = (("/tf", "tf"), ("/tf_static", "tf_static"))
URDF = '<robot name="r"><link name="base_link"/><link name="laser"/><joint name="j" type="fixed">\
<parent link="base_link"/><child link="laser"/></joint></robot>'
Graph = Callable[..., System]


@pytest.fixture(scope="module")
def known() -> Knowledge:
    return Knowledge(built_in("jazzy").nodes, load_known_nodes("", "jazzy"), "jazzy")


@pytest.fixture
def run(known: Knowledge) -> Graph:
    def made(*nodes: LaunchedNode, notes: Sequence[LaunchNote] = ()) -> System:
        return launched(LaunchGraph(nodes, tuple(notes)), known).system

    return made


def node(
    program: str, name: str, space: str = "/robot1", rules: object = (), **more: object
) -> LaunchedNode:
    """Return a launched node; ``container``, ``arguments`` and values of parameters by name."""
    package, executable = program.split("/")
    container, arguments = more.pop("container", ""), more.pop("arguments", ())
    own = yaml.safe_dump({"/**": {"ros__parameters": more}})
    texts = (ParameterText("", own),) if more else ()
    given = (package, executable, name, space, rules, texts, container, arguments, "", AT)
    return LaunchedNode(*given)  # type: ignore[arg-type]


def publisher(space: str, rules: object = (), **more: object) -> LaunchedNode:
    more = {"robot_description": URDF, **more}
    return node("robot_state_publisher/robot_state_publisher", "rsp", space, rules, **more)


def codes(made: System) -> set[str]:
    return {it.code for it in diagnose(made).findings}


def names(made: System, of: str) -> set[tuple[str, str]]:
    return {(it.role, it.name) for it in made.ends if it.node == of}


def test_two_of_a_program_whose_name_is_not_known_are_not_two_of_one_name(run: Graph) -> None:
    """The code of spawn.py names it: `create_node("entity_spawner")`. A name given twice counts."""
    assert not codes(made := run(*[node("acme/spawn.py", "", "/")] * 2))
    assert not [it for it in made.environment.caveats if "rcl refuses" in it.message]
    assert codes(run(*[node("acme/spawn.py", "spawner", "/")] * 2)) == {"MG301"}


def test_what_nothing_in_the_launch_sends_is_told_as_in_a_build(run: Graph) -> None:
    (found,) = diagnose(run(publisher("/robot1"))).findings
    assert (found.code, found.level, found.names) == ("MG316", "note", ("/robot1/joint_states",))


@pytest.mark.parametrize(("release", "wanted"), [("jazzy", "Twist"), ("kilted", "TwistStamped")])
def test_the_type_that_a_release_has_by_default(release: str, wanted: str) -> None:
    """nav2_util twist_publisher.hpp: false in 1.3.13, true in 1.4.2."""
    facts = Knowledge(built_in(release).nodes, load_known_nodes("", release), release)
    monitor = node("nav2_collision_monitor/collision_monitor", "collision_monitor")
    for given, type_ in (({}, wanted), ({"enable_stamped_cmd_vel": False}, "Twist")):
        one = (
            monitor if not given else node("nav2_collision_monitor/collision_monitor", "c", **given)
        )
        made = launched(LaunchGraph((one,)), facts).system
        (found,) = {it.type for it in made.ends if it.name == "/robot1/cmd_vel"}
        assert found == f"geometry_msgs/msg/{type_}"


def test_a_controller_that_two_spawners_load_is_told(known: Knowledge) -> None:
    """What an event starts has the launch configurations of the end: those of the last robot."""

    def said(*nodes: LaunchedNode) -> list[str]:
        found = judge_launch(launched(LaunchGraph(nodes), known))
        return [it.message for it in found if it.code == "MG722"]

    both = [node("controller_manager/spawner", "", "/robot2", arguments=("drive",)) for _ in "ab"]
    assert said(*both) == ["/robot2/controller_manager gets drive from 2 spawners"]
    assert said(both[0], both[0]._replace(namespace="/robot1")) == []


@pytest.mark.parametrize(
    ("nodes", "notes", "said"),
    [
        ((node("acme/driver", "driver"),), (), "/robot1/driver (acme/driver)"),
        ((publisher("/robot1", TF, robot_description=""),), (), "/robot1/rsp"),
        ((), (LaunchNote(AT, "decided only at run time"),), f"{AT}: decided only at run time"),
        ((node("gazebo_ros/spawn_entity.py", ""),), (), "plugins of a spawned model make"),
        ((publisher("/robot1", (("/tf", "1tf"),)),), (), "rcl refuses"),
    ],
)
def test_what_is_not_known_is_said_and_makes_nothing_right(
    run: Graph, nodes: tuple[LaunchedNode, ...], notes: tuple[LaunchNote, ...], said: str
) -> None:
    caveats = run(*nodes, notes=notes).environment.caveats
    assert any(it.incomplete and said in it.message for it in caveats)


def test_the_command_reports_and_compares(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "two.launch.py"
    file.write_text("")
    graphs = {
        "wrong": LaunchGraph((publisher("/robot1"), publisher("/robot2"))),
        "right": LaunchGraph((publisher("/robot1", TF), publisher("/robot2", TF))),
        "open": LaunchGraph((publisher("/robot1", TF), node("acme/driver", "driver"))),
    }
    orders = []

    def read(order: object) -> LaunchGraph:
        orders.append(order)
        return graphs[dict(order.arguments)["as"]]  # type: ignore[attr-defined]

    monkeypatch.setattr(child, "launch_graph", read)

    def code(*words: str) -> int:
        return main([words[0], *words[1:], "--distro", "jazzy"])

    assert code("check-launch", str(file), "as:=wrong") == 1
    assert "MG402" in capsys.readouterr().out
    assert code("check-launch", str(file), "as:=right") == 0
    assert code("check-launch", str(file), "as:=open") == 3
    assert "acme/driver" in capsys.readouterr().err
    plan = tmp_path / "plan.yaml"
    assert code("plan", str(file), "as:=right", "-o", str(plan)) == 0
    assert code("check-launch", str(file), "as:=right", "--plan", str(plan)) == 0
    capsys.readouterr()
    assert code("check-launch", str(file), "as:=wrong", "--plan", str(plan)) == 1
    assert "should publish topic /robot1/tf" in capsys.readouterr().out
    assert code("plan", str(file), "as:=right", "--node-set", "nav2") == 2
    assert "--node-set" in capsys.readouterr().err
    assert not any(it.trusted for it in orders)  # type: ignore[attr-defined]
    assert code("check-launch", str(file), "as:=right", "--trust") == 0
    assert orders[-1].trusted  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["nowhere.launch.py"], "No such file"),
        (["no_such_package", "x.launch.py"], "no_such_package"),
        (["a", "b", "c"], "FILE NAME:=VALUE"),
        (["x.launch.py", "robots=2"], "NAME:=VALUE"),
    ],
)
def test_bad_words_are_one_line(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check-launch", *words]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line


def simulated(space: str) -> str:
    """Return a description with gz_ros2_control in a namespace."""
    rules = "<remapping>~/odom:=odom</remapping><remapping>/tf:=tf</remapping>"
    home = f"<ros><namespace>{space}</namespace>{rules}</ros>"
    plugin = f'<plugin filename="gz_ros2_control-system" name="gz_ros2_control::\
GazeboSimROS2ControlPlugin">{home}<parameters>/made/c.yaml</parameters></plugin>'
    return URDF.replace("</robot>", f"<gazebo>{plugin}</gazebo></robot>")


def controlled(known: Knowledge, space: str, asked: str) -> System:
    """One robot in gz, and a spawner that asks for a manager."""
    sections = {
        "controller_manager": {"drive": {"type": "diff_drive_controller/DiffDriveController"}},
        "drive": {"odom_frame_id": "odom", "base_frame_id": "base_link"},
    }
    text = yaml.safe_dump(
        {"/**": {name: {"ros__parameters": values} for name, values in sections.items()}}
    )
    spawner = node("controller_manager/spawner", "s", "/robot1", arguments=("drive", "-c", asked))
    twice = (spawner, spawner._replace(place=AT._replace(line=9)))
    graph = LaunchGraph(
        (publisher("/robot1", robot_description=simulated(space)), *twice),
        (),
        (("/made/c.yaml", ParameterText("", text)),),
    )
    return launched(graph, known).system


def test_a_spawner_that_asks_for_another_manager_is_told(known: Knowledge) -> None:
    made = controlled(known, "other", "controller_manager")
    assert [it.name for it in made.nodes] == ["/robot1/rsp"]
    assert any(
        "/robot1/controller_manager is started by no node of the launch and no plugin" in it.message
        for it in made.environment.caveats
    )


def test_a_bridge_has_services_and_images_in_ros(run: Graph) -> None:
    """parameter_bridge.cpp takes ``SERVICE@TYPE``, image_bridge.cpp names of topics."""
    service = ("/world/w/control@ros_gz_interfaces/srv/ControlWorld",)
    made = run(
        node("ros_gz_bridge/parameter_bridge", "b", arguments=service),
        node("ros_gz_image/image_bridge", "i", rules=(("/cam", "front"),), arguments=("/cam",)),
    )
    assert ("serves", "/world/w/control") in names(made, "/robot1/b")
    assert names(made, "/robot1/i") == {("publishes", "/robot1/front")}
    assert not any(it.incomplete for it in made.environment.caveats)


LASER = """<robot name="r"><link name="base_link"/><gazebo reference="base_link"><sensor name="s"
 type="ray"><plugin name="laser" filename="libgazebo_ros_ray_sensor.so"><ros>
 <namespace>{0}</namespace><remapping>~/out:=scan</remapping></ros></plugin></sensor></gazebo></robot>"""


def test_plugins_of_gazebo_classic_are_nodes_and_it_has_the_clock(run: Graph) -> None:
    """gazebo_ros node.cpp: the plugin's name is the node's; gazebo_ros_init.cpp: /clock."""
    state = publisher("/robot1", TF, robot_description=LASER.format("/robot1"))
    words = ("-entity", "robot1", "-topic", "/robot1/robot_description")
    spawner = node("gazebo_ros/spawn_entity.py", "", "/", arguments=words)
    made = run(state, spawner, node("gazebo_ros/gzserver", "", "/"))
    assert ("publishes", "/robot1/scan") in names(made, "/robot1/laser")
    assert names(made, "/gazebo") == {("publishes", "/clock")}
    assert made.environment.caveats == ()
    alone = run(state, node("gazebo_ros/gzserver", "", "/"))
    assert "/robot1/laser" not in {it.name for it in alone.nodes}, "nothing spawns it"


@pytest.mark.parametrize(
    ("nodes", "sent"),
    [
        ((("gazebo_ros/gzserver", ()),), 1), ((("gazebo_ros/gzserver", ()),) * 2, 1),
        ((("gazebo_ros/gzserver", ("-s", "libgazebo_ros_init.so")),), 1),
        ((("gazebo_ros/gzserver", ("-s", "libgazebo_ros_factory.so")),), 0),
        ((("gazebo_ros/spawn_entity.py", ()),), 1), ((("gazebo_ros/other", ()),), 0),
        ((("gazebo_ros/gzserver", ("-s", "x")), ("gazebo_ros/spawn_entity.py", ())), 0),
        ((("ros_gz_sim/gzserver", ()),), 0),
    ],
)  # fmt: skip
def test_who_has_the_clock_of_gazebo_classic(
    run: Graph, nodes: tuple[tuple[str, tuple[str, ...]], ...], sent: int
) -> None:
    """Who spawns has it running, if in another launch; a command line may not load its plugin."""
    made = run(*(node(program, "", "/", arguments=words) for program, words in nodes))
    found = [it for it in made.ends if (it.role, it.name) == ("publishes", "/clock")]
    assert [(it.node, it.type) for it in found] == [("/gazebo", "rosgraph_msgs/msg/Clock")] * sent


BRIDGE = "rosbridge_server/rosbridge_websocket"


def test_a_port_in_a_file_for_all_is_that_of_the_nodes_that_read_it(run: Graph) -> None:
    """Nav2's nodes declare what they read, and no node of it a port or a device."""
    servers = ("nav2_map_server/map_saver_server", "nav2_controller/controller_server", BRIDGE)
    made = run(
        *(
            node(it, f"n{at}", space, port=9090, video_device="/dev/video0")
            for space in ("/robot1", "/robot2")
            for at, it in enumerate(servers)
        )
    )
    assert {it.node for it in made.addresses} == {"/robot1/n2", "/robot2/n2"}


CLASSIC = """<robot name="r"><link name="base_link"/><gazebo>
<plugin name="joints" filename="libgazebo_ros_joint_state_publisher.so"><ros>
<namespace>/robot1</namespace>
<remapping>~/out:=joint_states</remapping></ros></plugin>
<plugin name="control" filename="libgazebo_ros2_control.so"><ros>
<namespace>/robot1</namespace></ros></plugin>
</gazebo></robot>"""


def test_classic_makes_a_manager_beside_its_plugins(run: Graph) -> None:
    """gazebo_ros2_control_plugin.cpp of humble: a node with the plugin's name, and one called
    controller_manager. Which way ``~/out`` goes is not in the rule."""
    state = node("robot_state_publisher/robot_state_publisher", "state", robot_description=CLASSIC)
    words = ("-entity", "robot1", "-topic", "/robot1/robot_description")
    spawn = node("gazebo_ros/spawn_entity.py", "spawn", arguments=words)
    ends = run(state, spawn)
    assert "/robot1/controller_manager" in {it.name for it in ends.nodes}
    assert all(it.role for it in ends.ends)


@pytest.mark.parametrize(
    ("release", "second"), [("humble", "/robot1/odom"), ("jazzy", "/robot2/odom")]
)
def test_rules_of_the_process_are_those_of_the_first_robot(release: str, second: str) -> None:
    """gazebo_ros2_control_plugin.cpp of humble sets the global arguments of the process; each manager
    of jazzy has its own (gz_ros2_control_plugin.cpp)."""
    nodes = []
    for robot in ("robot1", "robot2"):
        rule = f"<remapping>~/odom:=/{robot}/odom</remapping></ros>"
        text = CLASSIC.replace("</ros></plugin>\n</gazebo>", f"{rule}</plugin></gazebo>")
        words = ("-entity", robot, "-topic", f"/{robot}/robot_description")
        state = publisher(f"/{robot}", robot_description=text.replace("/robot1<", f"/{robot}<"))
        nodes += [state, node("gazebo_ros/spawn_entity.py", "spawn", arguments=words)]
    known = Knowledge(built_in(release).nodes, load_known_nodes("", release), release)
    made = launched(LaunchGraph(tuple(nodes)), known).nodes
    rules = {it.full_name: dict(it.rules).get("~/odom") for it in made}
    assert rules["/robot1/controller_manager"] == "/robot1/odom"
    assert rules["/robot2/controller_manager"] == second


def mavros(space: str, **more: object) -> LaunchedNode:
    return node("mavros/mavros_node", "", f"{space}/mavros", **more)


def of_vehicles(*vehicles: LaunchedNode) -> Sequence[LaunchedNode]:
    spaces = [it.namespace.removesuffix("/mavros") for it in vehicles]
    return (*vehicles, *(publisher(it, frame_prefix=f"{it[1:]}/") for it in spaces))


@pytest.mark.parametrize(
    ("first", "second", "meet"),
    [({}, {}, {"1"}), ({}, {"tgt_system": 1}, {"1"}), ({}, {"tgt_system": 2}, set()),
     ({"tgt_system": 3}, {"tgt_system": 3}, {"3"}), ({"tgt_system": 1}, {"tgt_system": 2}, set())],
)  # fmt: skip
def test_two_vehicles_of_mavros_with_one_system_meet(
    run: Graph, first: dict[str, int], second: dict[str, int], meet: set[str]
) -> None:
    """mavros_node.cpp: ``/uas%d`` of tgt_system, which is 1; router and UAS publish one topic each."""
    made = run(*of_vehicles(mavros("/uav1", **first), mavros("/uav2", **second)))
    found = [it for it in diagnose(made).findings if it.code == "MG320"]
    topics = {name for it in found for name in it.names}
    assert topics == {f"/uas{it}/mavlink_{end}" for it in meet for end in ("source", "sink")}


def test_mavros_plugins_are_in_the_namespace_of_their_process(run: Graph) -> None:
    """plugin.hpp makes a node for each; ``__ns`` is for all nodes of a process (rcl node.c)."""
    found = {(it.role, it.name) for it in run(mavros("/uav1")).ends}
    assert found >= {
        ("publishes", "/uav1/mavros/state"),
        ("publishes", "/uav1/mavros/local_position/pose"),
        ("subscribes", "/uav1/mavros/setpoint_velocity/cmd_vel"),
        ("serves", "/uav1/mavros/cmd/arming"),
    }


CAMERA, LIDAR = "realsense2_camera/realsense2_camera_node", "ouster_ros/os_driver"


@pytest.mark.parametrize(
    ("supervisors", "other", "code", "text"),
    [
        ((), "", "MG501", "but no node publishes /clock"),
        ((), "acme/own", "MG501", "but no known node publishes /clock"),
        ((), "webots_ros2_driver/driver", "MG501", "but no known node publishes /clock"),
        (("/Ros2Supervisor",), "webots_ros2_driver/driver", "", ""),
        (("/Ros2Supervisor", "/second"), "", "MG502", "publish /clock"),
    ],
)  # fmt: skip
def test_who_has_the_clock_of_webots(
    run: Graph, supervisors: Sequence[str], other: str, code: str, text: str
) -> None:
    """ros2_supervisor.py sends it, and WebotsNode.cpp does not since 2022.1; what is not known may."""
    own = [node("webots_ros2_driver/ros2_supervisor.py", "", it, (("clock", "/clock"),))
           for it in supervisors]  # fmt: skip
    own += [node(other, "x")] if other else []
    amcl = [node("nav2_amcl/amcl", "amcl", f"/robot{it}", use_sim_time=True) for it in (1, 2)]
    found = [it for it in diagnose(run(*own, *amcl)).findings if it.code in ("MG501", "MG502")]
    assert {it.code for it in found} == ({code} if code else set())
    assert all(text in it.message for it in found)


def of_both(
    program: str, name: str, *values: dict[str, object], rules: object = ()
) -> list[LaunchedNode]:
    both = zip(("/robot1", "/robot2"), values, strict=True)
    own = [node(program, name, space, rules, **more) for space, more in both]
    return [
        *own,
        *(publisher(it.namespace, rules, frame_prefix=f"{it.namespace[1:]}/") for it in own),
    ]


@pytest.mark.parametrize(
    ("program", "name", "values", "frames"),
    [
        (CAMERA, "camera", ({}, {}), {"camera_link", "camera_depth_frame", "camera_color_frame"}),
        (CAMERA, "camera", ({"camera_name": "d"}, {"camera_name": "d", "base_frame_id": "base"}),
         {"d_depth_frame", "d_color_frame"}),
        (CAMERA, "camera", ({"enable_color": False}, {}), {"camera_link", "camera_depth_frame"}),
        (CAMERA, "camera", ({"camera_name": "one"}, {"camera_name": "two"}), set()),
        (CAMERA, "camera", ({"tf_prefix": "robot1/"}, {"tf_prefix": "robot2/"}), set()),
        (CAMERA, "camera", ({"publish_tf": False}, {"publish_tf": False}), set()),
        (LIDAR, "os_driver", ({}, {}), {"os_sensor", "os_lidar", "os_imu"}),
        (LIDAR, "os_driver", ({"pub_static_tf": False}, {}), set()),
        (LIDAR, "os_driver", ({"sensor_frame": "robot1/os"}, {"sensor_frame": "robot2/os"}),
         {"os_lidar", "os_imu"}),
        ("mavros/mavros_node", "", ({}, {"tgt_system": 2}), {"map_ned", "odom_ned", "base_link_frd"}),
    ],
)  # fmt: skip
def test_frames_that_code_makes_of_two_robots_meet(
    run: Graph, program: str, name: str, values: tuple[dict[str, object], ...], frames: set[str]
) -> None:
    """base_realsense_node.h (FRAME_ID), os_static_transforms_broadcaster.h, mavros uas_tf.cpp."""
    found = diagnose(run(*of_both(program, name, *values))).findings
    met = {it for one in found if one.code in ("MG402", "MG401") for it in one.names}
    assert frames <= met and bool(met) is bool(frames)
    own = of_both(program, name, *values, rules=TF)
    assert not {"MG402", "MG408", "MG407"} & codes(run(*own))


GPIO = """\
controller_manager: {ros__parameters: {update_rate: 10}}
gpios:
  ros__parameters:
    type: gpio_controllers/GpioCommandController
    gpios: [lamps]
    command_interfaces:
      lamps:
        - interfaces: [red]
own: {ros__parameters: {type: acme/Own}}
bare: {ros__parameters: {type: 5}}
"""
SPAWNED = """\
from pathlib import Path
from launch import LaunchDescription
from launch.substitutions import PathSubstitution, ThisLaunchFileDir
from launch_ros.actions import Node

FILE = PathSubstitution(ThisLaunchFileDir()) / "control.yaml"

def generate_launch_description():
    return LaunchDescription([
        Node(package="controller_manager", executable="ros2_control_node", parameters=[FILE]),
        Node(package="controller_manager", executable="spawner",
             arguments=["gpios", "own", "bare", "--param-file", FILE]),
    ])
"""


def test_a_controller_has_the_type_of_its_own_section(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its spawner hands the file on (controller_manager jazzy spawner.py): any class may be there, and
    it moves what a list of one mapping names, too."""
    (tmp_path / "control.yaml").write_text(GPIO)
    (tmp_path / "bringup.launch.py").write_text(SPAWNED)
    assert main(["check-launch", str(tmp_path / "bringup.launch.py")]) == 1
    said = capsys.readouterr()
    told = [line.partition("error: ")[2] for line in said.out.splitlines() if "error: " in line]
    assert [it.partition(" (")[0] for it in told] == [
        "MG728 no parameter of /controller_manager says the type of bare"
    ]
    assert "/own (acme/Own)" in said.err


TELEOP = "teleop_twist_keyboard/teleop_twist_keyboard"
UNTOLD = ParameterText("", "", untold="stamped")


@pytest.mark.parametrize(
    ("program", "topic", "values", "types"),
    [
        (TELEOP, "cmd_vel", {}, ("Twist",)),
        (TELEOP, "cmd_vel", {"stamped": True}, ("TwistStamped",)),
        # twist_mux 4.5.0, which Jazzy has.
        ("twist_mux/twist_mux", "cmd_vel_out", {}, ("TwistStamped",)),
        ("twist_mux/twist_mux", "cmd_vel_out", {"use_stamped": False}, ("Twist",)),
        ("nav2_velocity_smoother/velocity_smoother", "cmd_vel", {}, ("Twist",)),
    ],
)
def test_a_type_that_a_parameter_chooses_has_its_default(
    run: Graph, program: str, topic: str, values: Mapping[str, object], types: Sequence[str]
) -> None:
    it = node(program, "n", **values)
    (end,) = [one for one in run(it).ends if one.name == f"/robot1/{topic}"]
    assert (end.type, *end.also) == tuple(f"geometry_msgs/msg/{one}" for one in types)
    # A value that only a run tells may be any.
    doubtful = it._replace(parameters=(*it.parameters, UNTOLD))
    (end,) = [one for one in run(doubtful).ends if one.name == f"/robot1/{topic}"]
    # What is chosen is chosen still.
    assert bool(end.also) is (types == ("Twist",))
