# SPDX-License-Identifier: Apache-2.0
"""Small systems without a plan: all that is said of them, and where an exception ends.

Of ``rules/system``: clocks, commands, differing, frame_ids, instead, likes, lookups, matching, names,
states, tf_topics, transforms.
"""

from __future__ import annotations

import pytest
from graph_examples import read_system

from multibot_rewrite.rules.check import judge
from multibot_rewrite.system.records import MAY, PUBLISHES

TWIST = "geometry_msgs/msg/Twist"
SCAN, IMU, TEXT = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Imu", "std_msgs/msg/String"
CLOCK = "rosgraph_msgs/msg/Clock"
TRIGGER = "std_srvs/srv/Trigger"


def said(*lines: str) -> list[str]:
    """Code, level, node or else robot, and message of each finding."""
    found = judge(read_system("\n".join(f"running: {it}" for it in lines)))
    return [f"{it.code} {it.level} {it.node or it.robot}: {it.message}" for it in found]


@pytest.mark.parametrize(
    ("lines", "found"),
    [
        (
            ["/a", "/a", "/b", "/b"],
            [f"MG301 error /{it}: 2 nodes have the name /{it}" for it in "ab"],
        ),
        (
            ["/a", "/a", "/b", "/b", "/c", "/c"],
            ["MG301 error /a: 3 nodes run more than once: /a, /b, /c"],
        ),
        (["/rviz2", "/rviz2"], []),
    ],
)
def test_nodes_of_one_name(lines: list[str], found: list[str]) -> None:
    assert said(*lines) == found


@pytest.mark.parametrize(
    ("reader", "senders", "meant"),
    [
        # What chooses is idle without an input, unless that is misspelt.
        ("twist_mux cmd_vel_joyy", "x cmd_vel_joy", "error x cmd_vel_joy"),
        ("twist_mux cmd_vel_joyy", "x cmd_vel_joy, y cmd_vel_nav", "error x cmd_vel_joy"),
        ("twist_mux cmd_vel_nav", "x cmd_vel_joy", ""),
        ("driver cmd_vel", "x velocity", "error x velocity"),
        ("driver cmd_vel", "x velocity, y speed", ""),
        # It reads that already.
        ("driver cmd_vel", "driver velocity", ""),
    ],
)
def test_which_command_a_reader_may_have_meant(reader: str, senders: str, meant: str) -> None:
    def line(words: str, does: str) -> str:
        node, name = words.split()
        return f"/robot1/{node} {does} /robot1/{name} {TWIST} as /{name}"

    sent = [line(it, "publishes") for it in senders.split(", ")]
    found = [it for it in said(line(reader, "subscribes"), *sent) if it.startswith("MG303")]
    (node, name), (level, sender, other) = reader.split(), meant.split() or ("", "", "")
    miss = f"subscribes to /robot1/{name}, which no node publishes"
    there = f"/robot1/{sender} publishes /robot1/{other}"
    assert found == [f"MG303 {level} /robot1/{node}: {miss}; {there}"] * bool(meant)


@pytest.mark.parametrize(
    ("reader", "sender", "is_meant"),
    [
        ("docking_server detected_dock_pose", "following_server filtered_dynamic_pose", False),
        ("docking_server detected_dock_pose", "finder dock_location", True),
        ("docking_server detected_dock_pose", "finder other/detected_dock_pose", True),
    ],
)
def test_of_plain_data_the_names_have_something_in_common(
    reader: str, sender: str, is_meant: bool
) -> None:
    pose = "geometry_msgs/msg/PoseStamped"
    (one, asked), (other, sent) = reader.split(), sender.split()
    found = said(
        f"/robot1/{one} subscribes /robot1/{asked} {pose} as {asked}",
        f"/robot1/{other} publishes /robot1/{sent} {pose} as {sent}",
    )
    assert any(it.startswith("MG303") for it in found) is is_meant


def test_what_only_may_be_sent_is_not_meant() -> None:
    """Nav2's controller_server sends motion_target with one of its plugins only."""
    seen = read_system(
        "running: /robot1/dock subscribes /robot1/dock_pose geometry_msgs/msg/PoseStamped\n"
        "running: /robot1/find publishes /robot1/dock_aim geometry_msgs/msg/PoseStamped"
    )
    ends = (it._replace(sure=MAY) if it.role == PUBLISHES else it for it in seen.system.ends)
    assert "MG303" not in {
        it.code for it in judge(seen._replace(system=seen.system._replace(ends=tuple(ends))))
    }


PAIR = (f"/robot1/amcl subscribes /clock {CLOCK}", f"/robot2/amcl subscribes /clock {CLOCK}")
BRIDGE = f"/ros_gz_bridge publishes /clock {CLOCK}"


@pytest.mark.parametrize(
    "row",
    [
        (*PAIR,
         "MG501 error /robot1/amcl: on simulated time (use_sim_time), but no node publishes"
         " /clock: /robot1/amcl; the same for /robot2/amcl"),
        (PAIR[0], f"/robot1/gz publishes /robot1/clock {CLOCK}",
         "MG501 error /robot1/amcl: on simulated time (use_sim_time), but no node publishes"
         " /clock: /robot1/amcl; /robot1/gz publishes /robot1/clock"),
        # Tools subscribe to whatever there is.
        (f"/rviz2 subscribes /clock {CLOCK}", ""),
        (*PAIR, BRIDGE, ""),
        (*PAIR, BRIDGE, BRIDGE.replace("ros_gz_bridge", "player"),
         "MG502 error /player: /player and /ros_gz_bridge publish /clock"),
        (*PAIR, BRIDGE, "/robot1/ekf_node",
         "MG503 error /robot1/ekf_node: not on simulated time, as /robot1/amcl is:"
         " /robot1/ekf_node"),
        # A node that is not known to go by time, and one that only looks.
        (*PAIR, BRIDGE, "/robot1/driver", "/robot1/rviz2", ""),
        (PAIR[0], BRIDGE, "/robot2/ekf_node",
         "MG503 warning /robot2/ekf_node: robot2 is on the machine's time, /robot1/amcl on"
         " simulated time"),
        (PAIR[0], BRIDGE, "/clock goes back 2.5 s",
         "MG504 warning /ros_gz_bridge: the time on /clock went back by 2.5 s; /ros_gz_bridge"
         " sends it"),
    ],
)  # fmt: skip
def test_clocks(row: tuple[str, ...]) -> None:
    *lines, found = row
    assert said(*lines) == [found] * bool(found)


@pytest.mark.parametrize(
    ("has", "asks", "code"),
    [
        (f"publishes /left_arm/scan {SCAN}", f"subscribes /arm_left/scan {SCAN}", "MG303"),
        ("serves /left_arm/dock acme/srv/Dock", "calls /arm_left/dock acme/srv/Dock", "MG304"),
    ],
)
def test_what_another_robot_has_is_not_meant(has: str, asks: str, code: str) -> None:
    """Robots left_arm and arm_left are two; where there are no such robots, it may be a slip."""
    names = ("arm_left", "left_arm")
    lines = (f"running: /left_arm/driver {has}", f"running: /arm_left/reader {asks}")
    seen = read_system("\n".join(lines))

    def robot(name: str) -> str:
        return next((it for it in names if name.startswith(f"/{it}/")), "")

    slips = judge(seen._replace(robots=(), robot=lambda _: "", memo={}))
    of_two = judge(seen._replace(robots=names, robot=robot, memo={}))
    assert (code, "error") in {(it.code, it.level) for it in slips}
    assert code not in {it.code for it in of_two if it.level == "error"}


ODOM = "nav_msgs/msg/Odometry"
MORE = {"lidar": ("scan", SCAN), "imu": ("imu/data", IMU), "driver": ("odom", ODOM)}
BOTH = tuple(
    f"/robot{at}/{node} publishes /robot{at}/{name} {type_}"
    for node, (name, type_) in MORE.items()
    for at in (1, 2)
)
FRAMES = tuple(f"transform robot{it}/base -> robot{it}/laser on /tf" for it in (1, 2))
LIDAR = "/robot{}/lidar has range_max {}"


@pytest.mark.parametrize(
    "row",
    [
        (*BOTH, LIDAR.format(1, 10), LIDAR.format(2, 20),
         "MG328 warning /robot2/lidar: has range_max 20, not 10 as /robot1/lidar"),
        (*BOTH, LIDAR.format(1, 10), LIDAR.format(2, 10), ""),
        # Each robot's own.
        (*BOTH, "/robot1/lidar has serial_port 1", "/robot2/lidar has serial_port 2", ""),
        (*BOTH, "/robot1/lidar has x 1", "/robot2/lidar has x 2", ""),
        (*BOTH, "/robot1/lidar has frame robot1/l", "/robot2/lidar has frame robot2/l", ""),
        (*BOTH, LIDAR.format(1, 10), ""),
        (*BOTH[:4], LIDAR.format(1, 10), LIDAR.format(2, 20), ""),
        (BOTH[0], BOTH[1].replace(SCAN, "sensor_msgs/msg/PointCloud2"), *BOTH[2:],
         "MG328 warning /robot2/lidar: has /robot2/scan sensor_msgs/msg/PointCloud2, not"
         " sensor_msgs/msg/LaserScan as /robot1/lidar (/robot1/scan)"),
        (*BOTH, "/robot1/scan came 600 times", "/robot2/scan came 200 times",
         "MG326 warning robot2: /robot2/scan came at 3.3 Hz, /robot1/scan at 10.0 Hz"),
        (*BOTH, "/robot1/scan came 600 times", "/robot2/scan came 201 times", ""),
        (*BOTH, "/robot1/scan came 9 times", "/robot2/scan came 0 times", ""),
        (*BOTH, "/robot1/scan came 10 times", "/robot2/scan came 0 times",
         "MG326 warning robot2: /robot2/scan has no message, /robot1/scan has 10"),
        (*BOTH, *FRAMES, "frame_id robot2/laser on /robot1/scan",
         "MG411 error /robot1/lidar: frame_id of /robot1/scan is robot2/laser, a frame of"
         " robot2; sent by /robot1/lidar"),
    ],
)  # fmt: skip
def test_robots_beside_each_other(row: tuple[str, ...]) -> None:
    *lines, found = row
    assert said(*lines) == [found] * bool(found)


TF, CHANGE = "tf2_msgs/msg/TFMessage", "lifecycle_msgs/srv/ChangeState"
DOOR = "acme_msgs/srv/Door"
MANAGER = f"/robot1/lifecycle_manager calls /robot1/amcl/change_state {CHANGE}"
LISTED = (
    "MG304 calls /robot1/amcl/change_state, which no node serves: /robot1/amcl is in its list, and"
    " does not run{}; it waits for /robot1/amcl and activates nothing after it: start it{}"
)
LEFT_OUT = ", or leave /robot1/amcl out of node_names of /robot1/lifecycle_manager"
LOCALIZES = (("initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped"), ("tf", TF))
SENDS = {it: f"{it} publishes /tf {TF}" for it in ("/robot1/a", "/robot1/b", "/robot2/b")}
TWICE = (
    "transform map -> {0} on /tf by /robot1/a",
    "transform odom -> {0} on /tf by {1}",
)
RULES = "/tf:=tf and /tf_static:=tf_static"
SAME = "MB412 has the same as /robot1/a: "
WAITS = f"/robot1/amcl subscribes /robot1/scan {SCAN} as scan"


CHANGE, TF = "lifecycle_msgs/srv/ChangeState", "tf2_msgs/msg/TFMessage"
TREE = (
    f"/robot1/state publishes /robot1/tf {TF}",
    "transform robot1/base -> robot1/laser on /robot1/tf by /robot1/state",
)
ELSEWHERE = (
    "but the tf of robot1 is on /robot1/tf; pass -r /tf:=tf -r /tf_static:=tf_static to each"
    " node; if it shares a process, to the whole process"
)


@pytest.mark.parametrize(
    "row",
    [
        (f"/robot1/rsp publishes /robot1/tf {TF}", f"/rviz2 subscribes /tf {TF}",
         "MG405 listens to /tf, on which no node sends; robots send on /robot1/tf; start it with"
         " -r /tf:=/robot1/tf -r /tf_static:=/robot1/tf_static, one for each robot"),
        # The topic of static transforms is called as its tf topic is, wherever the word stands.
        (f"/rsp_robot1 publishes /tf/robot1 {TF}", f"/rviz2 subscribes /tf {TF}",
         "MG405 listens to /tf, on which no node sends; robots send on /tf/robot1; start it with"
         " -r /tf:=/tf/robot1 -r /tf_static:=/tf_static/robot1, one for each robot"),
        (f"/robot1/rsp publishes /robot1/tf {TF}", f"/robot1/base publishes /old/tf {TF}",
         "MG405 /robot1/base sends tf on /old/tf, but the tf of robot1 is on /robot1/tf; pass"
         " -r /tf:=tf -r /tf_static:=tf_static to each node; if it shares a process, to the"
         " whole process"),
        (f"/x publishes /robot1/tf {TF}", "transform robot2/a -> robot2/b on /robot1/tf",
         "transform robot1/a -> robot1/b on /robot1/tf",
         "MG405 robot2/b of robot2 on /robot1/tf, which is of robot1; start its nodes in its own"
         f" namespace, with the rules {RULES}"),
        (f"/robot1/rsp publishes /robot1/tf {TF}", f"/x publishes /tf {TF}",
         "transform robot1/a -> robot1/b on /robot1/tf by /robot1/rsp",
         "transform robot1/b -> robot1/c on /tf by /x",
         "MG405 /x sends robot1/c on /tf, but the tf of robot1 is on /robot1/tf; start it in the"
         f" namespace of robot1, with the rules {RULES}"),
        (SENDS["/robot1/a"], SENDS["/robot1/b"],
         *(it.format("robot1/base", "/robot1/b") for it in TWICE),
         "MG401 frame robot1/base has 2 parents on /tf: map and odom; two of the nodes that send"
         " on /tf: /robot1/a, /robot1/b"),
        (SENDS["/robot1/a"], SENDS["/robot2/b"],
         *(it.format("robot1/base", "/robot2/b") for it in TWICE),
         "MG401 frame robot1/base has 2 parents on /tf: map and odom; two of the nodes that send"
         " on /tf: /robot1/a, /robot2/b; a node of another robot that has the names of robot1?"),
        (f"/robot1/lidar publishes /robot1/scan {SCAN}",
         "transform robot1/a -> robot1/laser on /tf",
         "frame_id robot1/laser on /robot1/scan 9 s old",
         "MG417 the stamps on /robot1/scan are 9 s old; see the clock of /robot1/lidar,"
         " or that of its machine"),
        (WAITS, "/robot1/amcl subscribes /robot1/imu sensor_msgs/msg/Imu as imu",
         "MG316 no known node sends /robot1/imu, /robot1/scan; unless a driver of the robot"
         " does, add a node or node set that does"),
        (WAITS, WAITS.replace("robot1", "robot2"),
         f"/robot2/lidar publishes /robot2/scan {SCAN}",
         "MG316 no node sends /robot1/scan, and one sends /robot2/scan; start what sends it for"
         " the other robot"),
        (MANAGER, LISTED.format("", LEFT_OUT)),
        (MANAGER, "/robot1/amlc",
         f"{LISTED.partition('{}')[0]}; /robot1/amlc runs; write /robot1/amlc for /robot1/amcl in"
         " node_names of /robot1/lifecycle_manager"),
        (MANAGER, "/amcl",
         LISTED.format("; /amcl runs", " in the namespace, with -r __ns:=/robot1")),
        (f"/own calls /door {DOOR}", "/x",
         "MG304 calls /door, which no node serves; start the node that serves it, or leave out"
         " what calls it"),
        (f"/own calls /door {DOOR}", f"/x serves /gate {DOOR}",
         "MG304 calls /door, which no node serves; /x serves /gate; pass the rule /door:=/gate,"
         " or start it in the namespace of the robot"),
        # A program outside of two robots, and a node of one that runs.
        (f"/fleet calls /robot1/drive/reset {TRIGGER}", "/robot1/drive", "/robot2/drive",
         "MG304 calls /robot1/drive/reset, which no node serves; start the node that serves it, or"
         " leave out what calls it"),
        (f"/fleet calls /robot1/drive/reset {TRIGGER}", "/robot1/x", "/robot2/drive", ""),
        # Many have a service of such a type: another one is not what is meant.
        (f"/own calls /door {TRIGGER}", f"/x serves /gate {TRIGGER}",
         "MG304 calls /door, which no node serves; start the node that serves it, or leave out"
         " what calls it"),
        ("/robot1/a holds device port 1", "/robot1/a holds device ip 2",
         "/robot2/b holds device port 1", "/robot2/b holds device ip 2",
         f"{SAME}port 1, ip 2; one device has one driver: give each robot its own"),
        ("/robot1/a holds computer port 1", "/robot2/b holds computer port 1",
         f"{SAME}port 1; the second one on a computer cannot open it: give each robot its own,"
         " or a computer"),
        ("/robot1/a holds device port 1", "/robot1/b holds device port 1", ""),
        ("/robot1/a holds device port 1", "/robot2/b holds device port 2", ""),
        (f"/teleop_twist_keyboard publishes /robot1/out_vel {TWIST}",
         f"/robot1/driver subscribes /robot1/wheels/speed {TWIST}",
         f"/robot1/a publishes /robot1/wheels/speed {TWIST}",
         "MG308 publishes /robot1/out_vel, which no node reads; /robot1/driver reads"
         " /robot1/wheels/speed; /robot1/driver obeys /robot1/a there: put twist_mux before the"
         " robot's driver, each sender with a topic of its own"),
        # Who is no person's hand may send for somebody else.
        (f"/robot1/program publishes /robot1/out_vel {TWIST}",
         f"/robot1/driver subscribes /robot1/wheels/speed {TWIST}",
         f"/robot1/a publishes /robot1/wheels/speed {TWIST}", ""),
        ("/robot1/manager controls a/position by arm", "/robot1/gz controls a/position by arm",
         "MG512 a/position is commanded by arm of /robot1/manager and arm of /robot1/gz;"
         " two controller managers for one robot: stop one, or unload its controller"),
        ("/robot1/manager controls a/position by arm",
         "/robot1/manager controls a/position by hand",
         "MG512 a/position is commanded by arm of /robot1/manager and hand of /robot1/manager;"
         " spawn hand with --inactive"),
        # Two interfaces of the same two are told once; each robot has its own.
        ("/robot1/manager controls a/position by arm",
         "/robot1/manager controls a/position by hand",
         "/robot1/manager controls b/position by arm",
         "/robot1/manager controls b/position by hand",
         "/robot2/manager controls a/position by arm",
         "MG512 a/position is commanded by arm of /robot1/manager and hand of /robot1/manager;"
         " spawn hand with --inactive"),
        ("/robot1/manager keeps arm inactive", "/robot1/manager keeps hand unconfigured",
         "MG513 none of its controllers is active: arm (inactive), hand (unconfigured);"
         " ros2 control list_controllers -c /robot1/manager; see the log of the spawners"),
        ("/robot1/manager keeps arm inactive", "/robot1/manager controls a/position by hand", ""),
        ("/robot1/a is inactive", "/robot1/b is inactive", "/robot1/c is active",
         "MG511 /robot1/a, /robot1/b are inactive, not active; no node activates it: is that"
         " meant?; ros2 lifecycle get /robot1/a"),
        (f"/robot1/manager calls /robot1/a/change_state {CHANGE}",
         f"/robot1/a serves /robot1/a/change_state {CHANGE}", "/robot1/a is inactive",
         "MG511 /robot1/a is inactive, not active; see the log of /robot1/manager; ros2"
         " lifecycle get /robot1/a"),
        # Whose frames are on which topic.
        (*TREE, f"/bridge publishes /tf {TF}",
         "transform robot1/odom -> robot1/base on /tf by /bridge",
         "MG405 /bridge sends robot1/base on /tf, but the tf of robot1 is on /robot1/tf; start"
         " it in the namespace of robot1, with the rules /tf:=tf and /tf_static:=tf_static"),
        # What hears the tree may be a relay; what is in it is a copy; one joins it to the world.
        (*TREE, f"/bridge publishes /tf {TF}", f"/bridge subscribes /robot1/tf {TF}",
         "transform robot1/odom -> robot1/base on /tf by /bridge", ""),
        (*TREE, f"/bridge publishes /tf {TF}",
         "transform robot1/base -> robot1/laser on /tf by /bridge", ""),
        (*TREE, f"/bridge publishes /tf {TF}",
         "transform world -> robot1/base on /tf by /bridge", ""),
        (*TREE, f"/robot1/driver publishes /tf {TF}",
         "transform robot1/odom -> robot1/base on /tf by /robot1/driver",
         f"MG405 /robot1/driver sends tf on /tf, {ELSEWHERE}"),
        # A bridge's topic below the robot's is not its tree, where all others send on /tf.
        (*tuple(
             line
             for it in ("robot1", "robot2")
             for line in (
                 f"/{it}/bridge publishes /{it}/gz/tf {TF}", f"/{it}/bridge publishes /tf {TF}",
                 f"/{it}/state publishes /tf {TF}",
                 f"transform {it}/base -> {it}/laser on /tf by /{it}/state",
             )
         ), ""),
        # To send on another robot's tree as well is no excuse.
        (*TREE, f"/robot1/driver publishes /robot2/tf {TF}",
         f"/robot1/driver publishes /robot1/tf {TF}",
         "MG405 /robot1/driver sends tf on /robot2/tf, but the tf of robot1 is on /robot1/tf; a"
         " namespace or remap rule of robot1 names robot2; pass -r /tf:=tf -r"
         " /tf_static:=tf_static to each node; if it shares a process, to the whole process"),
        (*TREE, f"/robot1/amcl subscribes /tf {TF}",
         f"MG405 /robot1/amcl hears tf on /tf, {ELSEWHERE}"),
        (*TREE, f"/robot1/amcl subscribes /tf {TF}", f"/robot1/nav subscribes /tf {TF}",
         f"MG405 /robot1/amcl, /robot1/nav hear tf on /tf, {ELSEWHERE}"),
        (*TREE, f"/robot1/amcl subscribes /robot2/tf {TF}",
         f"/robot2/state publishes /robot2/tf {TF}",
         "MG405 /robot1/amcl hears tf on /robot2/tf, but the tf of robot1 is on /robot1/tf;"
         " a namespace or remap rule of robot1 names robot2; pass -r /tf:=tf -r"
         " /tf_static:=tf_static to each node; if it shares a process, to the whole process"),
        (*TREE, f"/rviz2 subscribes /tf {TF}",
         "MG405 listens to /tf, on which no node sends; robots send on /robot1/tf; start it"
         " with -r /tf:=/robot1/tf -r /tf_static:=/robot1/tf_static, one for each robot"),
        # A localizer that has no publisher of transforms at all.
        (*(f"/robot1/amcl subscribes /robot1/{name} {type_}" for name, type_ in LOCALIZES),
         "transform odom -> base_link on /robot1/tf by /robot1/driver",
         "MG415 sends no map -> odom on /robot1/tf, and no other node does; it sends no transforms"
         " at all: set tf_broadcast: true of /robot1/amcl"),
        (*TREE, f"/rviz2 subscribes /robot1/tf {TF}", ""),
        ("/robot1/a has use_sim_time true", "/robot1/b has use_sim_time false",
         "/robot1/c has use_sim_time false", "/robot1/rviz2 has use_sim_time true",
         "MG514 use_sim_time is true for /robot1/a, and not for /robot1/b, /robot1/c;"
         " set use_sim_time: false of /robot1/a: it is the same for all nodes of a robot"),
    ],
)  # fmt: skip
def test_what_is_wrong_and_what_to_do(row: tuple[str, ...]) -> None:
    *lines, found = row
    system = read_system("\n".join(f"running: {it}" for it in lines))
    assert [f"{it.code} {it.message}; {it.hint}" for it in judge(system)] == [found] * bool(found)


@pytest.mark.parametrize(
    ("type_", "called"),
    [
        ("LaserScan", "laser lidar scan"),
        ("PointCloud2", "lidar velodyne ouster depth"),
        ("Imu", "imu"),
        ("Image", "optical"),
        ("NavSatFix", "gps gnss navsat"),
    ],
)
def test_a_frame_that_is_called_as_such_a_sensors_is_may_be_meant(type_: str, called: str) -> None:
    for word in called.split():
        lines = (
            f"/robot1/driver publishes /robot1/out sensor_msgs/msg/{type_}",
            f"transform robot1/base -> robot1/front_{word}_link on /tf",
            "frame_id sensor on /robot1/out",
        )
        system = read_system("\n".join(f"running: {it}" for it in lines))
        (found,) = (it for it in judge(system) if it.code == "MG412")
        assert found.level == "warning"
        assert found.hint == f"set the frame of /robot1/driver to robot1/front_{word}_link"


POSE, STRING = "geometry_msgs/msg/PoseStamped", "std_msgs/msg/String"
GO, STOP = "nav2_msgs/action/NavigateToPose", "std_srvs/srv/Trigger"
DRIVE = f"/robot1/driver subscribes /robot1/cmd_vel {TWIST}"
SERVER = f"/robot1/controller_server publishes /robot1/cmd_vel {TWIST}"
TWO_DRIVES = (DRIVE, SERVER, DRIVE.replace("1", "2"), SERVER.replace("1", "2"))
NAMES_ROBOT1 = "correct the namespace, remap rule or parameter of robot2 that names robot1"
CHOOSE = "put twist_mux before the robot's driver, each sender with a topic of its own"
PLAY = "play it in another ROS_DOMAIN_ID, or with --remap {0}:={0}_of_bag"


def unread(name: str, meant: str = "/robot1/cmd_vel", beside: str = "") -> str:
    do = f"start it in the robot's namespace, or pass the rule {name}:={meant}"
    do = f"/robot1/driver obeys {beside} there: {CHOOSE}" if beside else do
    return f"publishes {name}, which no node reads; /robot1/driver reads {meant}; {do}"


NAV = "/robot1/controller_server"


@pytest.mark.parametrize(
    "row",
    [
        (DRIVE, SERVER, f"/joystick publishes /cmd_vel {TWIST}",
         f"MG308 error /joystick: {unread('/cmd_vel', beside=NAV)}"),
        (*TWO_DRIVES, f"/joystick publishes /cmd_vel {TWIST}",
         f"MG308 error /joystick: {unread('/cmd_vel', beside=NAV)}"),
        # Stamped velocities are others.
        (DRIVE, SERVER, f"/joystick publishes /cmd_vel {TWIST}Stamped", ""),
        # A joystick of the robot itself is meant for the one that it obeys.
        (DRIVE, SERVER, f"/robot1/teleop publishes /robot1/joy_vel {TWIST}",
         f"MG308 error /robot1/teleop: {unread('/robot1/joy_vel', beside=NAV)}"),
        (DRIVE, SERVER, f"/joystick publishes /joy_vel {TWIST}", ""),
        (f"/robot1/driver subscribes /robot1/wheels/cmd_vel {TWIST}",
         f"/robot1/twist_mux publishes /robot1/cmd_vel_out {TWIST}",
         "MG308 error /robot1/twist_mux: "
         + unread("/robot1/cmd_vel_out", "/robot1/wheels/cmd_vel")),
        (f"/robot1/bt_navigator subscribes /robot1/goal_pose {POSE}",
         f"/rviz2 publishes /goal_pose {POSE}",
         "MG303 note /robot1/bt_navigator: subscribes to /robot1/goal_pose, which no node"
         " publishes; /rviz2 publishes /goal_pose; pass the rule /goal_pose:=/robot1/goal_pose"
         " to /rviz2, or start it in the namespace"),
        (DRIVE, DRIVE.replace("1", "2"), f"/robot2/teleop publishes /robot1/cmd_vel {TWIST}",
         "MG311 error /robot2/teleop: publishes /robot1/cmd_vel, a name of robot1;"
         f" {NAMES_ROBOT1}; pass the rule /robot1/cmd_vel:=cmd_vel to /robot2/teleop"),
        # Who sends to both coordinates them.
        (DRIVE, DRIVE.replace("1", "2"), f"/robot2/teleop publishes /robot1/cmd_vel {TWIST}",
         f"/robot2/teleop publishes /robot2/cmd_vel {TWIST}", ""),
        (f"/robot1/nav serves /robot1/go {GO}", f"/robot2/nav serves /robot2/go {GO}",
         f"/robot2/boss calls /robot1/go {GO}",
         f"MG311 error /robot2/boss: sends goals to /robot1/go, a name of robot1; {NAMES_ROBOT1}"),
        (f"/robot1/a serves /robot1/stop {STOP}", f"/robot2/a serves /robot2/stop {STOP}",
         f"/robot2/boss calls /robot1/stop {STOP}",
         f"MG311 error /robot2/boss: calls /robot1/stop, a name of robot1; {NAMES_ROBOT1};"
         " pass the rule /robot1/stop:=stop to /robot2/boss"),
        # Its own robot does not have it.
        (f"/robot1/a serves /robot1/stop {STOP}", "/robot2/a",
         f"/robot2/boss calls /robot1/stop {STOP}", ""),
        # Its own robot waits for it.
        (f"/robot1/a subscribes /robot1/halt {STRING}",
         f"/robot2/a subscribes /robot2/halt {STRING}",
         f"/robot2/button publishes /robot1/halt {STRING}",
         f"MG311 error /robot2/button: publishes /robot1/halt, a name of robot1; {NAMES_ROBOT1};"
         " no other node publishes /robot1/halt: start one for robot1 too"),
        (DRIVE, SERVER, f"/robot1/teleop publishes /robot1/cmd_vel {TWIST}",
         "MG312 warning /robot1/teleop: publishes /robot1/cmd_vel, and so does"
         f" /robot1/controller_server; /robot1/driver obeys both; {CHOOSE}"),
        # A goal is no motion.
        (f"/robot1/bt_navigator subscribes /robot1/goal_pose {POSE}",
         f"/robot1/a publishes /robot1/goal_pose {POSE}",
         f"/robot1/b publishes /robot1/goal_pose {POSE}", ""),
        # Two of Nav2 take turns; a mux chooses.
        (DRIVE, SERVER, SERVER.replace("controller", "behavior"), ""),
        (SERVER, SERVER.replace("controller_server", "teleop"),
         DRIVE.replace("driver", "twist_mux"), ""),
        (f"/robot1/lidar publishes /robot1/scan {SCAN}",
         f"/rosbag2_player publishes /robot1/scan {SCAN}",
         f"/rosbag2_player publishes /robot1/imu {IMU}",
         "MG313 error /rosbag2_player: plays /robot1/scan into the running system; "
         + PLAY.format("/robot1/scan")),
        (DRIVE, f"/rosbag2_player publishes /robot1/cmd_vel {TWIST}",
         "MG313 error /rosbag2_player: plays /robot1/cmd_vel into the running system; "
         + PLAY.format("/robot1/cmd_vel")),
        # What bags are for.
        (f"/robot1/slam subscribes /robot1/scan {SCAN}",
         f"/rosbag2_player publishes /robot1/scan {SCAN}", ""),
        # Nobody knows who sends them.
        (f"/x publishes /robot1/tf {TF}",
         "transform robot2/base -> robot2/laser on /robot1/tf",
         "MG405 error robot2: robot2/laser of robot2 on /robot1/tf, which is of robot1; start"
         " its nodes in its own namespace, with the rules /tf:=tf and /tf_static:=tf_static"),
    ],
)  # fmt: skip
def test_orders_and_who_obeys_them(row: tuple[str, ...]) -> None:
    """Code, level, node or else robot, message and hint."""
    *lines, found = row
    system = read_system("\n".join(f"running: {it}" for it in lines))
    assert [
        f"{it.code} {it.level} {it.node or it.robot}: {it.message}; {it.hint}"
        for it in judge(system)
    ] == [found] * bool(found)


SENT = "transform odom -> base_link on /robot1/tf by /robot1/ekf"
STILL = "transform base_link -> laser on /robot1/tf by /robot1/robot_state_publisher"
INSTEAD = (
    "/robot1/ekf sends odom -> base_link; use a frame that is sent, or name the node that does"
)


def reads(frame: str, rest: str, node: str = "planner", level: str = "warning") -> str:
    return f"MG413 {level} /robot1/{node}: reads frame {frame}, but {rest}"


@pytest.mark.parametrize(
    "row",
    [
        (SENT, "/robot1/planner looks up base_footprint",
         reads("base_footprint", f"no known node sends it; {INSTEAD}")),
        # What sends a description is not named.
        (SENT.replace("by ", "by /robot1/robot_state_publisher, "),
         "/robot1/planner looks up base_footprint",
         reads("base_footprint", f"no known node sends it; {INSTEAD}")),
        (SENT, *(f"/robot1/{it} looks up base_footprint" for it in ("planner", "amcl", "x")),
         reads(
             "base_footprint",
             f"no known node sends it; the same for /robot1/amcl, /robot1/x; {INSTEAD}",
         )),
        # On one tf of all robots its own node is named.
        (*("/robot1/planner subscribes /tf " + TF, "/robot1/planner looks up base_footprint"),
         "transform odom/robot2 -> base_link/robot2 on /tf by /robot2/ekf",
         "transform odom -> base_link on /tf by /robot1/ekf",
         reads("base_footprint", f"no known node sends it; {INSTEAD}")),
        # A map often comes from elsewhere.
        (SENT, "/robot1/planner looks up map",
         reads("map", f"no known node sends it; {INSTEAD}", level="note")),
        (SENT, "/robot1/planner looks up base_lnik",
         reads("base_lnik", "nothing sends it; did you mean base_link?")),
        (SENT, "/robot1/planner looks up tool",
         reads("tool", "nothing sends it; send it, or use a frame that is sent")),
        (SENT, "/robot1/planner looks up base_link", ""),
        (STILL, "/robot1/planner looks up odom",
         reads("odom", "nothing sends it; send it, or use a frame that is sent")),
        (STILL, "/robot1/planner looks up odom", f"/robot1/planner subscribes /robot1/tf {TF}",
         reads(
             "odom",
             "no known node sends it; name the node or node set that sends it",
             level="note",
         )),
    ],
)  # fmt: skip
def test_frames_that_are_looked_up(row: tuple[str, ...]) -> None:
    """Code, level, node, message and hint."""
    *lines, found = row
    system = read_system("\n".join(f"running: {it}" for it in lines))
    assert [f"{it.code} {it.level} {it.node}: {it.message}; {it.hint}" for it in judge(system)] == (
        [found] * bool(found)
    )


THING, IMAGE = "acme_msgs/msg/Thing", "sensor_msgs/msg/Image"
PACKED, GRID = "sensor_msgs/msg/CompressedImage", "nav_msgs/msg/OccupancyGrid"
STATES = "sensor_msgs/msg/JointState"


def hears(name: str, type_: str = THING, node: str = "reader", code: str = "") -> str:
    return f"/robot1/{node} subscribes /robot1/{name} {type_}{f' as {code}' if code else ''}"


def sends(name: str, type_: str = THING, node: str = "sender", code: str = "") -> str:
    return f"/robot1/{node} publishes /robot1/{name} {type_}{f' as {code}' if code else ''}"


# What a node waits for in vain, and what there is instead: by what it is, not by its name alone.
INSTEAD_OF = {
    "the only one of its type": ((hears("wanted"), sends("given")), "given"),
    "two of its type": ((hears("wanted"), sends("given"), sends("other")), ""),
    "a word in common": ((hears("wheel_wanted"), sends("wheel_given"), sends("other")), "wheel_given"),
    "a short word in common": ((hears("arm_wanted"), sends("arm_given"), sends("other")), ""),
    "a word that says nothing": ((hears("data_wanted"), sends("data_given"), sends("other")), ""),
    "read by another node": ((hears("wanted"), sends("given"), hears("given", node="other")), ""),
    "of a type for many ends": ((hears("wanted", POSE), sends("given", POSE)), ""),
    "of such a type with a word in common": (
        (hears("route_wanted", POSE), sends("route_given", POSE)),
        "route_given",
    ),
    "a name that goes on": ((hears("joy", POSE), sends("joystick", POSE)), "joystick"),
    "another number": ((hears("thing_1"), sends("thing_2")), ""),
    "of a node that is called alike": ((hears("wanted", node="a"), sends("given", node="a")), ""),
    "a topic below its own node": ((hears("reader/wanted"), sends("given")), ""),
    "a node that merges": (
        (hears("wanted"), hears("more"), sends("more", node="one"), sends("given")),
        "",
    ),
    "a node that merges, and a name that goes on": (
        (hears("wanted"), hears("more"), sends("more", node="one"), sends("wanted_raw")),
        "wanted_raw",
    ),
    "of Nav2": ((hears("wanted"), sends("given", node="controller_server")), ""),
    "a scan that others read": (
        (hears("scan", SCAN), sends("laser", SCAN), hears("laser", SCAN, "slam")),
        "laser",
    ),
    "an image that others read": (
        (hears("image", IMAGE), sends("eye", IMAGE), hears("eye", IMAGE, "slam")),
        "",
    ),
    "joints of two": (
        (hears("joints", STATES), sends("arm", STATES, "arm"), sends("leg", STATES, "leg")),
        "",
    ),
    "joints that others read": (
        (hears("joints", STATES), sends("arm", STATES, "arm"), hears("arm", STATES, "planner")),
        "",
    ),
    "the joints of a description": (
        (hears("joints", STATES, "robot_state_publisher"), sends("arm", STATES, "arm"),
         hears("arm", STATES, "planner")),
        "arm",
    ),
    "a map": ((hears("map", GRID, "planner"), sends("maps/map", GRID)), "maps/map"),
    "what a costmap shows": ((hears("map", GRID, "planner"), sends("x", GRID, "local_costmap")), ""),
    "a scan by its code's name": (
        (hears("scan", SCAN, "amcl", "scan"), sends("front/scan", SCAN, "l"), sends("r", SCAN, "r")),
        "front/scan",
    ),
    "a text by its code's name": (
        (hears("word", STRING, code="word"), sends("words", STRING, code="words"),
         sends("zzz", STRING, code="zzz")),
        "words",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", INSTEAD_OF)
def test_what_is_sent_in_place_of_what_is_read(name: str) -> None:
    lines, meant = INSTEAD_OF[name]
    node, _, wanted, type_, *_ = lines[0].split()
    by = next((it.split()[0] for it in lines if f"publishes /robot1/{meant} " in it), "")
    level = "error" if type_ in (SCAN, STATES) else "warning"
    said = (
        f"MG303 {level} {node}: subscribes to {wanted}, which no node publishes; {by} publishes"
        f" /robot1/{meant}; pass the rule {wanted}:=/robot1/{meant}, or write /robot1/{meant} in its"
        " parameters"
    )
    found = judge(read_system("\n".join(f"running: {it}" for it in lines)))
    assert [f"{it.code} {it.level} {it.node}: {it.message}; {it.hint}" for it in found] == (
        [said] * bool(meant)
    )


DOORS = "acme_msgs/srv/Door"


@pytest.mark.parametrize(
    ("level", "lines", "meant"),
    [
        ("warning", (f"/robot1/a calls /robot1/open {DOORS}",
                     f"/robot1/b serves /robot1/door {DOORS}"), "/robot1/door"),
        # Somebody calls it already.
        ("warning", (f"/robot1/a calls /robot1/open {DOORS}",
                     f"/robot1/b serves /robot1/door {DOORS}",
                     f"/robot1/c calls /robot1/door {DOORS}"), ""),
        ("error", (f"/robot1/a calls /robot1/door_opn {DOORS}",
                   f"/robot1/b serves /robot1/door_open {DOORS}",
                   f"/robot1/c serves /robot1/zzz {DOORS}"), "/robot1/door_open"),
        # Of a type that many have the last word counts.
        ("warning", (f"/robot1/a calls /robot1/open {STOP}",
                     f"/robot1/b serves /robot1/door {STOP}"), ""),
        ("warning", (f"/robot1/a calls /robot1/x/stop {STOP}",
                     f"/robot1/b serves /robot1/y/stop {STOP}"), "/robot1/y/stop"),
        # In a namespace without a node, and in one with nodes.
        ("error", (f"/boss calls /cell/door {DOORS}", f"/gate serves /door {DOORS}"), "/door"),
        ("warning", (f"/boss calls /cell/door {DOORS}", f"/gate serves /door {DOORS}", "/cell/x"),
         "/door"),
    ],
)  # fmt: skip
def test_what_is_served_in_place_of_what_is_called(
    level: str, lines: tuple[str, ...], meant: str
) -> None:
    node, _, wanted, _ = lines[0].split()
    by = next((it.split()[0] for it in lines if f"serves {meant} " in it), "")
    rest = "start the node that serves it, or leave out what calls it"
    if meant:
        rest = f"{by} serves {meant}; pass the rule {wanted}:={meant}, or start it in the namespace"
        rest += " of the robot"
    said = f"MG304 {level} {node}: calls {wanted}, which no node serves; {rest}"
    found = judge(read_system("\n".join(f"running: {it}" for it in lines)))
    assert [f"{it.code} {it.level} {it.node}: {it.message}; {it.hint}" for it in found] == ([said])


ODOMETRY = "nav_msgs/msg/Odometry"
PARTS = {
    "driver": ("publishes", "odom", ODOMETRY),
    "planner": ("subscribes", "odom", ODOMETRY),
    "lidar": ("publishes", "scan", SCAN),
    "odometer": ("subscribes", "scan", SCAN),
}
LACKS_SCAN = (
    "/robot2/lidar: lacks /robot2/scan, which /robot1/lidar has; it is used by"
    " /robot2/odometer in vain; see its log;"
    " does it have other remap rules, parameters or another version?"
)
NO_LIDAR = (
    "robot2: robot2 has no lidar, as robot1 has (/robot1/lidar); /robot2/scan is used by"
    " /robot2/odometer in vain; start it for this robot too"
)


def made_of(robot: int, *but: str) -> tuple[str, ...]:
    """Return a robot of the usual parts but for some."""
    left = ((node, *it) for node, it in PARTS.items() if node not in but)
    return tuple(f"/robot{robot}/{node} {does} /robot{robot}/{name} {type_}"
                 for node, does, name, type_ in left)  # fmt: skip


def has_no(robot: int, node: str) -> str:
    lacks = f"robot{robot} has no {node}, as robot1 has (/robot1/{node})"
    return f"robot{robot}: {lacks}; start it for this robot too, if the two are to be equal"


@pytest.mark.parametrize(
    "row",
    [
        (*made_of(1), *made_of(2), ""),
        (*made_of(1), *made_of(2, "lidar"), NO_LIDAR),
        # Of two robots nobody waits for it; of three the one differs from the others.
        (*made_of(1), *made_of(2, "lidar", "odometer"), ""),
        (*made_of(1), *made_of(2), *made_of(3, "odometer"), has_no(3, "odometer")),
        # Each has one of its own, or few in common: by the reader that waits.
        (*made_of(1), *made_of(2, "lidar"), "/robot2/camera", NO_LIDAR),
        (*made_of(1, "planner"), *made_of(2, "planner", "lidar"), NO_LIDAR),
        # Each has one of its own, or few in common, and nobody waits.
        (*made_of(1), *made_of(2, "odometer"), "/robot2/camera", ""),
        (
            *made_of(1, "lidar"),
            *made_of(2, "planner", "lidar", "odometer"),
            "robot1: no node sends /robot1/scan, read by /robot1/odometer;"
            " start its driver; its log says why it ended",
        ),
        (*made_of(1), *made_of(2, "lidar"), "/robot2/lidar", LACKS_SCAN),
        (
            *made_of(1),
            *made_of(2, "lidar"),
            f"/robot2/lidar publishes /robot2/x {TEXT}",
            LACKS_SCAN,
        ),
        # What sends the fixed frames, however few nodes; not of a robot made for other things.
        (
            "/robot1/driver",
            "/robot1/robot_state_publisher",
            "/robot2/driver",
            has_no(2, "robot_state_publisher"),
        ),
        ("/robot1/robot_state_publisher", "/robot1/driver", "/robot1/arm", "/robot2/driver", ""),
        # A tool, and what is called after its process.
        (*made_of(1), "/robot1/rviz2", *made_of(2), ""),
        (*made_of(1), "/robot1/x_12345", *made_of(2), *made_of(3), ""),
    ],
)
def test_what_a_robot_lacks_that_its_likes_have(row: tuple[str, ...]) -> None:
    *lines, found = row
    judged = judge(read_system("\n".join(f"running: {it}" for it in lines)))
    told = [it for it in judged if it.code in ("MG322", "MG327")]
    assert [f"{it.node or it.robot}: {it.message}; {it.hint}" for it in told] == [found] * bool(
        found
    )
    assert all((it.level == "error") is (it.code == "MG322") for it in told)


@pytest.mark.parametrize("reader", ["/robot1/viewer", "/rviz2"])
@pytest.mark.parametrize(
    ("shown", "end", "is_meant"),
    [
        (SCAN, "subscribes /robot1/scan", False),
        (SCAN, "subscribes /robot1/cloud", True),
        ("sensor_msgs/msg/PointCloud2", "subscribes /robot1/scan", False),
    ],
)
def test_what_is_made_of_a_topic_is_not_meant_by_its_name(
    shown: str, end: str, is_meant: bool, reader: str
) -> None:
    """slam_toolbox shows the scan that it reads (slam_toolbox_common.cpp)."""
    found = said(
        f"/robot1/monitor subscribes /robot1/scan {SCAN} as scan",
        f"/robot1/slam publishes /robot1/slam/scan_visualization {shown}",
        f"/robot1/slam {end} {SCAN} as {end.rpartition('/')[2]}",
        f"{reader} subscribes /robot1/slam/scan_visualization {shown}",
    )
    assert any("scan_visualization" in it for it in found) is is_meant


@pytest.mark.parametrize(
    ("node", "type_", "is_meant"),
    [
        ("controller_server", "sensor_msgs/msg/PointCloud2", False),
        ("camera", "sensor_msgs/msg/PointCloud2", True),
        ("controller_server", TWIST, True),
    ],
)
def test_what_nav2_shows_is_no_sensor(node: str, type_: str, is_meant: bool) -> None:
    """cost_cloud of dwb_core (publisher.cpp) is a picture of costs."""
    found = said(
        f"/robot1/local_costmap/local_costmap subscribes /robot1/zed/cloud {type_} as zed/cloud",
        f"/robot1/{node} publishes /robot1/cost_cloud {type_} as cost_cloud",
    )
    assert any("cost_cloud" in it and it.startswith("MG303") for it in found) is is_meant


@pytest.mark.parametrize(
    ("topic", "type_", "is_told"),
    [("scan", SCAN, True), ("cmd_vel", TWIST, True), ("note", TEXT, False)],
)
def test_a_relay_from_one_robot_to_another(topic: str, type_: str, is_told: bool) -> None:
    """What a body measures and what moves it are a robot's own; a text may be for all."""
    found = said(
        f"/robot1/a publishes /robot1/{topic} {type_}",
        f"/relay subscribes /robot1/{topic} {type_}",
        f"/relay publishes /robot2/{topic} {type_}",
        f"/robot2/a subscribes /robot2/{topic} {type_}",
    )
    assert any(it.startswith("MG314 error /relay") for it in found) is is_told


def test_qos_is_held_against_that_of_another_robot_where_not_all_of_it_is_known() -> None:
    lines = [
        f"/robot{robot}/{node} publishes /robot{robot}/{node}/x {TEXT}{qos}"
        for robot, best in ((1, " reliable volatile"), (2, " best_effort volatile"))
        for node, qos in (("a", best), ("b", ""), ("c", ""))
    ]
    assert [it.split(":")[0] for it in said(*lines)] == ["MG328 warning /robot2/a"]


FED = (
    f"/robot1/diff_drive subscribes /robot1/drive_vel {TWIST}",
    f"/robot1/velocity_smoother subscribes /robot1/cmd_vel_nav {TWIST}",
    f"/robot1/controller_server publishes /robot1/cmd_vel_nav {TWIST}",
    f"/robot1/velocity_smoother publishes /robot1/cmd_vel {TWIST}",
)


@pytest.mark.parametrize(
    ("more", "told"),
    [
        # What assisted teleop may send is read by behavior_server, and passes nothing on.
        (
            [
                f"/robot1/behavior_server publishes /robot1/drive_vel {TWIST}",
                f"/robot1/behavior_server subscribes /robot1/cmd_vel_teleop {TWIST}",
            ],
            True,
        ),
        # A chain past the smoother leads to the drive.
        (
            [
                f"/robot1/stamper publishes /robot1/drive_vel {TWIST}",
                f"/robot1/stamper subscribes /robot1/cmd_vel_nav {TWIST}",
            ],
            False,
        ),
        # One that waits for its input is the finding.
        (
            [
                f"/robot1/stamper publishes /robot1/drive_vel {TWIST}",
                f"/robot1/stamper subscribes /robot1/cmd_vel_smoothed {TWIST}",
            ],
            False,
        ),
    ],
)
def test_velocities_of_nav2_that_pass_the_drive_by(more: list[str], told: bool) -> None:
    found = [it for it in said(*FED, *more) if it.startswith("MG308")]
    text = (
        "publishes /robot1/cmd_vel, which no node reads; /robot1/diff_drive reads /robot1/drive_vel"
    )
    assert found == ([f"MG308 error /robot1/velocity_smoother: {text}"] if told else [])


def _sent(robot: int, *children: str) -> tuple[str, ...]:
    links = (f"transform robot{robot}/base -> robot{robot}/{it} on /tf" for it in children)
    return tuple(f"{it} by /robot{robot}/robot_state_publisher" for it in links)


@pytest.mark.parametrize(
    ("frames", "level"),
    [
        (("laser", "laser"), "error"),
        (("", ""), "error"),
        (("laser", "tool"), "note"),
        (("laser", "laser wheel"), "note"),
        # Only nodes that both have are compared.
        (("laser", ""), "error"),
    ],
)
def test_only_a_robot_of_its_kind_sends_what_another_lacks(
    frames: tuple[str, str], level: str
) -> None:
    """An arm beside a rover has no drive: its joint states come from its own hardware."""
    lines = [
        f"/robot1/amcl subscribes /robot1/scan {SCAN} as scan",
        f"/robot2/amcl subscribes /robot2/scan {SCAN} as scan",
        f"/robot2/lidar publishes /robot2/scan {SCAN}",
        *(it for at, words in enumerate(frames, 1) for it in _sent(at, *words.split())),
    ]
    assert [it for it in said(*lines) if it.startswith("MG316")] == [
        f"MG316 {level} robot1: "
        + ("no node sends /robot1/scan, and one sends /robot2/scan" if level == "error" else
           "no known node sends /robot1/scan")
    ]  # fmt: skip


def test_velocities_of_nav2_that_no_input_of_the_mux_reads() -> None:
    """Nor the input of a joystick, which a person sends."""
    mux = (
        f"/robot1/twist_mux subscribes /robot1/{it} {TWIST} as <topics.*.topic>"
        for it in ("cmd_vel", "joy_teleop/cmd_vel")
    )
    lines = [
        *mux, f"/robot1/twist_mux publishes /robot1/platform/cmd_vel {TWIST} as cmd_vel_out",
        f"/robot1/controller_server publishes /robot1/cmd_vel_nav {TWIST} as cmd_vel",
    ]  # fmt: skip
    (found,) = (it for it in said(*lines) if it.startswith("MG308"))
    assert found.endswith("which no node reads; /robot1/twist_mux reads /robot1/cmd_vel")
    by_hand = [it for it in lines if "/robot1/cmd_vel " not in it]
    assert not [it for it in said(*by_hand) if "/robot1/twist_mux reads" in it]


def test_two_nodes_that_feed_each_other_and_a_part_in_millimetres() -> None:
    ends = (("a", "/x", "/y"), ("b", "/y", "/x"))
    lines = [
        f"/{node} {does} {topic} {SCAN}"
        for node, read, sent in ends
        for does, topic in (("subscribes", read), ("publishes", sent))
    ]
    assert [it for it in said(*lines) if " makes " in it] == [
        "MG329 error /a: makes /y from /x, and /b makes /x from /y"
    ]
    far = "running: transform base_link -> lidar_link on /tf_static at 150 0 200 by /camera_tf"
    (hint,) = (it.hint for it in judge(read_system(far)) if it.code == "MG418")
    assert hint == "write metres in the files that /camera_tf reads"
