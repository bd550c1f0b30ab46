"""Known nodes and stacks: the data is whole, and a user's own file is read or refused in words."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.model import UsageError
from multibot_rewrite.remap.known import Library, extended, stack_of
from multibot_rewrite.remap.records import ACTION, SERVICE, TOPIC, Endpoint, NodeFacts
from multibot_rewrite.remap.stacks import built_in, load_nodes, load_stack
from multibot_rewrite.remap.stacks_page import page

ROOT = Path(__file__).parent.parent

WANTED = {
    "robot_state": {"robot_state_publisher", "joint_state_publisher"},
    "localization": {"map_server", "amcl", "lifecycle_manager_localization"},
    "nav2": {
        *("map_server", "amcl", "controller_server", "planner_server", "bt_navigator"),
        *("local_costmap/local_costmap", "global_costmap/global_costmap", "collision_monitor"),
    },
    "slam_toolbox": {"slam_toolbox"},
    "robot_localization": {"ekf_filter_node"},
    "ros2_control": {
        *("controller_manager", "joint_state_broadcaster", "diff_drive_controller"),
        "joint_trajectory_controller",
    },
    "moveit": {"move_group"},
    "teleop": {"joy_node", "teleop_twist_joy_node", "teleop_twist_keyboard", "twist_mux"},
    "perception": {"pointcloud_to_laserscan", "depthimage_to_laserscan"},
    "bridge": {"ros_gz_bridge"},
    "rviz": {"rviz2"},
    "static_tf": {"static_transform_publisher"},
}


def endpoint(node: NodeFacts, role: str, name: str) -> Endpoint:
    """The one endpoint of a role and name."""
    (found,) = [e for e in node.endpoints if (e.role, e.name) == (role, name)]
    return found


def extra(text: str) -> Library:
    """The built-in library with a user's text."""
    return extended(built_in(), text, "mine.yaml")


@pytest.mark.parametrize("name", WANTED)
def test_a_stack_has_its_nodes(name: str) -> None:
    assert {node.name for node in load_stack(name)} >= WANTED[name]


@pytest.mark.parametrize("name", sorted(built_in().stacks))
def test_a_stack_names_each_node_once(name: str) -> None:
    names = [node.name for node in load_stack(name)]
    assert names
    assert sorted(set(names)) == sorted(names)


def test_shared_nodes_are_those_that_serve_all() -> None:
    shared = {name for name, node in load_nodes().items() if node.shared}
    assert shared == {"ros_gz_bridge", "rviz2", "map_merging"}
    assert [node.shared for node in load_stack("rviz_nav2")] == [False]


def test_the_type_tells_the_kind() -> None:
    node = load_nodes()["joint_trajectory_controller"]
    kinds = {e.name: e.kind for e in node.endpoints}
    assert kinds["~/joint_trajectory"] == TOPIC
    assert kinds["~/query_state"] == SERVICE
    assert kinds["~/follow_joint_trajectory"] == ACTION


def test_the_page_of_stacks_is_current() -> None:
    assert (ROOT / "docs" / "stacks.md").read_text() == page(built_in())


def test_unknown_stack_is_told_with_the_nearest() -> None:
    with pytest.raises(UsageError, match=r"stack 'nav' is not known; did you mean 'nav2'\? known:"):
        load_stack("nav")


def test_a_user_adds_nodes_and_stacks() -> None:
    library = extra(
        "nodes:\n  gripper:\n    package: acme\n    serves: {grip: acme_msgs/srv/Grip}\n"
        "stacks:\n  cell: {include: [robot_state], nodes: [gripper, {node: amcl, as: amcl2}]}\n"
    )
    names = [node.name for node in stack_of(library, "cell")]
    assert names == ["robot_state_publisher", "joint_state_publisher", "gripper", "amcl2"]
    assert endpoint(library.nodes["gripper"], "serves", "grip").kind == SERVICE
