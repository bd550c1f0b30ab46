# SPDX-License-Identifier: Apache-2.0
"""Two equal robots of which one has something otherwise, one unnamed robot with open ends, and QoS:
each fault is told where its healthy twin is quiet, by a graph alone."""

from __future__ import annotations

import pytest
from graph_examples import read_system

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.live.diagnose import diagnose

ROBOT = """\
/R/lidar publishes /R/scan sensor_msgs/msg/LaserScan reliable volatile
/R/drive publishes /R/odom nav_msgs/msg/Odometry reliable volatile
/R/drive subscribes /R/cmd_vel geometry_msgs/msg/Twist reliable volatile
/R/controller publishes /R/cmd_vel geometry_msgs/msg/Twist reliable volatile
/R/amcl subscribes /R/scan sensor_msgs/msg/LaserScan reliable volatile
/R/amcl subscribes /R/odom nav_msgs/msg/Odometry reliable volatile
/R/battery publishes /R/battery_state sensor_msgs/msg/BatteryState reliable volatile
/R/ui subscribes /R/battery_state sensor_msgs/msg/BatteryState reliable volatile
/R/nav serves /R/go std_srvs/srv/Trigger
/R/ui calls /R/go std_srvs/srv/Trigger
/R/controller has max_vel 5
/R/amcl is active
"""
FIRST, SECOND, ALONE = (ROBOT.replace("/R", it) for it in ("/robot1", "/robot2", ""))
TF = "tf2_msgs/msg/TFMessage"


def found(text: str) -> list[Finding]:
    lines = (f"running: {it}\n" for it in text.splitlines() if it)
    return [*diagnose(read_system("".join(lines)).system).findings]


# What is otherwise in the second of two robots: the old words, the new ones, the code.
OTHERWISE = {
    "a node is off": (
        "/robot2/battery publishes /robot2/battery_state"
        " sensor_msgs/msg/BatteryState reliable volatile",
        "",
        "MG322",
    ),
    "a state": ("/robot2/amcl is active", "/robot2/amcl is inactive", "MG511"),
    "a type": ("odom nav_msgs/msg/Odometry", "odom geometry_msgs/msg/PoseStamped", "MG328"),
    "a parameter": ("max_vel 5", "max_vel 9", "MG328"),
    "a QoS that does not fit": (
        "/robot2/scan sensor_msgs/msg/LaserScan reliable volatile\n/robot2/drive p",
        "/robot2/scan sensor_msgs/msg/LaserScan best_effort volatile\n/robot2/drive p",
        "MG307",
    ),
    "the server of its sibling": (
        "/robot2/ui calls /robot2/go",
        "/robot2/ui calls /robot1/go",
        "MG311",
    ),
    "a scan under another name": ("publishes /robot2/scan", "publishes /robot2/points", "MG303"),
}


@pytest.mark.parametrize("what", OTHERWISE)
def test_what_is_otherwise_in_one_of_two_equal_robots(what: str) -> None:
    old, new, code = OTHERWISE[what]
    assert old in SECOND
    seen = found(FIRST + SECOND.replace(old, new))
    assert code in {it.code for it in seen}
    assert {it.robot for it in seen if it.code == code} == {"robot2"}


# One robot without a name: what takes the place of what, the code, and what the line names.
OPEN = {
    "a lidar under another name": (
        "publishes /scan",
        "publishes /narrow_scan",
        ("/scan", "/narrow_scan"),
    ),
    "an output of a mux": (
        "publishes /cmd_vel",
        "publishes /cmd_vel_out",
        ("/cmd_vel", "/cmd_vel_out"),
    ),
    "commands elsewhere": (
        "subscribes /cmd_vel",
        "subscribes /robo/cmd_vel",
        ("/robo/cmd_vel", "/cmd_vel"),
    ),
    "a private service": ("serves /go", "serves /nav/go", ("/go", "/nav/go")),
    "stamped and not": (
        "publishes /cmd_vel geometry_msgs/msg/Twist ",
        "publishes /cmd_vel geometry_msgs/msg/TwistStamped ",
        ("/cmd_vel", "TwistStamped"),
    ),
}


@pytest.mark.parametrize("what", OPEN)
def test_open_ends_of_one_robot_without_a_name_are_told_with_both_names(what: str) -> None:
    old, new, named = OPEN[what]
    assert old in ALONE
    (it,) = found(ALONE.replace(old, new))
    assert it.code in ("MG303", "MG304", "MG306")
    assert all(name in it.message for name in named)


# Nodes that compare the time of messages with their own, by their code: tf2 buffers and filters.
COMPARING = (
    "robot_state_publisher", "amcl", "ekf_filter_node", "ukf_filter_node", "slam_toolbox",
    "cartographer_node", "bt_navigator", "controller_server", "planner_server", "behavior_server",
    "map_server", "velocity_smoother", "collision_monitor", "local_costmap", "global_costmap",
    "navsat_transform", "icp_odometry", "rgbd_odometry",
)  # fmt: skip


def test_each_node_that_compares_times_has_to_be_on_the_clock_of_the_others() -> None:
    clock = "/clock rosgraph_msgs/msg/Clock"
    others = f"/ros_gz_bridge publishes {clock}\n/robot1/docking subscribes {clock}\n"
    for node in (*COMPARING, "driver"):
        seen = found(f"{others}/robot1/{node} publishes /robot1/x std_msgs/msg/String\n")
        codes = [it.code for it in seen if it.node == f"/robot1/{node}"]
        assert ("MG503" in codes) is (node != "driver"), node


SINGLE = {
    "compressed and raw": (
        "/camera publishes /image/compressed sensor_msgs/msg/CompressedImage\n"
        "/detector subscribes /image sensor_msgs/msg/Image\n",
        "MG303",
    ),
    "joint states": (
        "/jsb publishes /jsb/joint_states sensor_msgs/msg/JointState\n"
        "/robot_state_publisher subscribes /joint_states sensor_msgs/msg/JointState\n",
        "MG303",
    ),
    "a map": (
        "/slam publishes /slam/map nav_msgs/msg/OccupancyGrid\n"
        "/planner subscribes /map nav_msgs/msg/OccupancyGrid\n",
        "MG303",
    ),
    "two cameras": (
        "/a publishes /image_raw sensor_msgs/msg/Image\n"
        "/b publishes /image_raw sensor_msgs/msg/Image\n",
        "MG325",
    ),
    "a frame that nothing sends": (
        "transform map -> odom on /tf by /amcl\ntransform odom -> base_link on /tf by /drive\n"
        "/amcl looks up base_lnk\n",
        "MG413",
    ),
    "a volatile reader of what is sent once": (
        "/map_server publishes /map nav_msgs/msg/OccupancyGrid reliable transient_local\n"
        "/costmap subscribes /map nav_msgs/msg/OccupancyGrid reliable volatile\n",
        "MG309",
    ),
    "one best-effort sender among reliable ones": (
        f"/a publishes /tf {TF} reliable volatile\n/b publishes /tf {TF} best_effort volatile\n"
        f"/l subscribes /tf {TF} reliable volatile\n",
        "MG307",
    ),
    "a tool that lacks the transforms of one sender": (
        f"/a publishes /tf {TF} reliable volatile\n/b publishes /tf {TF} best_effort volatile\n"
        f"/rosbridge_websocket subscribes /tf {TF} reliable volatile\n",
        "MG307",
    ),
    "a tool that reads a map later": (
        "/map_server publishes /map nav_msgs/msg/OccupancyGrid reliable transient_local\n"
        "/rviz2 subscribes /map nav_msgs/msg/OccupancyGrid reliable volatile\n",
        "MG309",
    ),
    "commands by hand without the stamp that the drive reads": (
        "/drive subscribes /drive/cmd_vel geometry_msgs/msg/TwistStamped\n"
        "/teleop publishes /drive/cmd_vel_unstamped geometry_msgs/msg/Twist\n",
        "MG308",
    ),
    "a tf_static that is not kept, once for all its readers": (
        f"/a publishes /tf_static {TF} reliable volatile\n"
        f"/l subscribes /tf_static {TF} reliable transient_local\n"
        f"/m subscribes /tf_static {TF} reliable transient_local\n",
        "MG307",
    ),
    "one static transform of two senders": (
        f"/a publishes /tf_static {TF}\n/b publishes /tf_static {TF}\n"
        "transform base_link -> laser on /tf_static at 1 0 0 by /a, /b twice\n",
        "MG408",
    ),
}


@pytest.mark.parametrize("what", SINGLE)
def test_a_small_graph_with_one_fault_has_one_finding(what: str) -> None:
    text, code = SINGLE[what]
    (it,) = found(text)
    assert it.code == code
    # What is the same twice, or only a tool lacks, is a note; the sender comes first if at fault.
    assert (it.level == "note") == (code == "MG408" or "tool that reads" in what)
    if "tf_static that is not kept" in what:
        assert it.node == "/a"


def test_odometry_under_other_names_is_the_cause_of_a_tree_in_pieces() -> None:
    frames = ("map -> odom", "base_link -> laser", "robot1/odom -> robot1/base_link")
    lines = (f"transform {it} on /robot1/tf by /robot1/drive" for it in frames)
    (it,) = found("\n".join((f"/robot1/drive publishes /robot1/tf {TF}", *lines)))
    assert it.code == "MG406"
    assert it.hint == "robot1/odom -> robot1/base_link is sent: use one name for each frame"
