# SPDX-License-Identifier: Apache-2.0
"""Known nodes and node sets: the data is whole, and a user's own file is read or refused in words."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from paths import ROOT

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.base.rosnames import expand
from multibot_rewrite.fleet.fleet import NO_STATE_PUBLISHER
from multibot_rewrite.knowledge.node_library import NodeLibrary, extend, nodes_of_set
from multibot_rewrite.knowledge.node_sets import built_in, load_node_set, load_nodes, user_library
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.system.records import SERVICE, TOPIC

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
    "image_proc": {"debayer_node", "rectify_mono_node", "rectify_color_node"},
    "bridge": {"ros_gz_bridge"},
    "rviz": {"rviz2"},
    "static_tf": {"static_transform_publisher"},
}


def endpoint(node: NodeFacts, role: str, name: str) -> Endpoint:
    """Return the one endpoint of a role and name."""
    (found,) = [e for e in node.endpoints if (e.role, e.name) == (role, name)]
    return found


def extra(text: str) -> NodeLibrary:
    """Return the built-in library with a user's text."""
    return extend(built_in(NEWEST_LTS), text, "mine.yaml")


@pytest.mark.parametrize("name", WANTED)
def test_a_node_set_has_its_nodes(name: str) -> None:
    assert {node.name for node in load_node_set(name, NEWEST_LTS)} >= WANTED[name]


@pytest.mark.parametrize("name", sorted(built_in(NEWEST_LTS).node_sets))
def test_a_node_set_names_each_node_once(name: str) -> None:
    names = [node.name for node in load_node_set(name, NEWEST_LTS)]
    assert names or name == NO_STATE_PUBLISHER
    assert sorted(set(names)) == sorted(names)


def test_shared_nodes_are_those_that_serve_all() -> None:
    shared = {name for name, node in load_nodes(NEWEST_LTS).items() if node.shared}
    bridges = {"domain_bridge", "foxglove_bridge", "ros_gz_bridge", "rosbridge_websocket"}
    assert shared == {*bridges, "rviz2", "map_merge", "map_merging", "Ros2Supervisor"}
    assert [node.shared for node in load_node_set("rviz_nav2", NEWEST_LTS)] == [False]


def test_a_host_is_a_node() -> None:
    nodes = load_nodes(NEWEST_LTS)
    hosts = {name: node.host for name, node in nodes.items() if node.host}
    assert hosts["local_costmap/local_costmap"] == "controller_server"
    assert [name for name, host in hosts.items() if host not in nodes] == []


@pytest.mark.parametrize("name", sorted(load_nodes(NEWEST_LTS)))
def test_a_name_made_at_run_time_is_out_of_reach(name: str) -> None:
    made = [e for e in load_nodes(NEWEST_LTS)[name].endpoints if "<" in e.name]
    assert [e.name for e in made if not e.fixed] == []


def test_a_node_set_says_what_is_made_at_run_time() -> None:
    nodes = {node.name: node for node in load_node_set("nav2", NEWEST_LTS)}
    scan = endpoint(nodes["global_costmap/global_costmap"], "subscribes", "/scan")
    assert (scan.fixed, scan.also) == ("", ("sensor_msgs/msg/PointCloud2",))
    manager = nodes["lifecycle_manager_localization"]
    called = {e.name for e in manager.endpoints if e.name.endswith("/change_state")}
    assert called == {"map_server/change_state", "amcl/change_state"}


def test_only_a_process_wide_rule_reaches_the_tf_of_a_costmap() -> None:
    nodes = load_nodes(NEWEST_LTS)
    assert endpoint(nodes["local_costmap/local_costmap"], "subscribes", "/tf").helper
    assert not endpoint(nodes["amcl"], "subscribes", "/tf").helper


def test_what_launch_files_remap_is_kept_in_mind() -> None:
    nodes = {node.name: node for node in load_node_set("nav2", NEWEST_LTS)}
    leads = {
        name: [e.remapped for e in node.endpoints if e.name == "cmd_vel"]
        for name, node in nodes.items()
    }
    nav = ["cmd_vel_nav"]
    assert leads["controller_server"] == leads["behavior_server"] == nav
    assert leads["velocity_smoother"] == nav
    assert leads["collision_monitor"] == [""]


def leads(node: NodeFacts, asked: Endpoint) -> str:
    """Where an endpoint leads in a system of one robot, started by the usual launch files."""
    above, _, name = node.name.rpartition("/")
    return expand(asked.remapped or asked.name, f"/{above}", name)


def met(node_set: str, asking: str, giving: str) -> tuple[set[str], set[str]]:
    """Where all endpoints of two roles lead, those of one role and those of the other."""
    found = [
        (e.role, leads(node, e))
        for node in load_node_set(node_set, NEWEST_LTS)
        for e in node.endpoints
    ]
    one, other = ({name for role, name in found if role == wanted} for wanted in (asking, giving))
    return {name for name in one if "<" not in name}, other


def test_whatever_nav2_calls_is_served_by_nav2() -> None:
    called, served = met("nav2", "calls", "serves")
    assert called - served == {"/fromLL"}


def test_what_nav2_hears_but_does_not_say() -> None:
    heard, said = met("nav2", "subscribes", "publishes")
    from_nav2 = {name for name in heard if name.startswith(("/local_", "/global_", "/cmd_vel_"))}
    own = {name for name in from_nav2 if name.count("/") == 2 or name.startswith("/cmd_vel")}
    assert own - said == {
        *("/local_costmap/footprint", "/global_costmap/footprint", "/cmd_vel_teleop"),
        *("/local_costmap/costmap_filter_info", "/global_costmap/costmap_filter_info"),
    }


def test_teleop_goes_through_the_mux() -> None:
    heard, said = met("teleop", "subscribes", "publishes")
    assert {"/joy_vel", "/key_vel"} <= heard & said
    assert "/cmd_vel" in said - heard


def test_frames_are_reported_with_their_defaults() -> None:
    frames = {it.parameter: it.default for it in load_nodes(NEWEST_LTS)["amcl"].frames}
    assert frames == {
        "base_frame_id": "base_footprint",
        "odom_frame_id": "odom",
        "global_frame_id": "map",
    }


def test_the_example_of_the_page_is_read() -> None:
    text = (
        (ROOT / "docs" / "node-sets.md").read_text().partition("```yaml\n")[2].partition("```")[0]
    )
    nodes = {node.name: node for node in nodes_of_set(extra(text), "cell")}
    assert {"move_group", "gripper_driver", "table_to_base", "twist_mux"} <= nodes.keys()
    assert endpoint(nodes["gripper_driver"], "publishes", "/gripper/image").transport
    assert endpoint(nodes["twist_mux"], "subscribes", "pad_vel").fixed == ""


def test_unknown_node_set_is_reported_with_the_nearest() -> None:
    with pytest.raises(
        UsageError, match=r"node set 'nav' is not known; did you mean 'nav2'\? known:"
    ):
        load_node_set("nav", NEWEST_LTS)


def test_a_type_may_be_left_out() -> None:
    library = extra("nodes: {a: {calls: {b: }, publishes: {c: {when: asked}}}}")
    assert [(e.kind, e.name, e.type) for e in library.nodes["a"].endpoints] == [
        (TOPIC, "c", ""),
        (SERVICE, "b", ""),
    ]


def test_an_empty_file_adds_nothing() -> None:
    assert extra("") == built_in(NEWEST_LTS)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("nodes: [", "mine.yaml:1:9: not valid YAML: "),
        ("a: 1\n--- \nb: 2", "mine.yaml:2:1: not valid YAML"),
        ("- a", "mine.yaml:1: the file is a list; write keys and values"),
        ("\nnode: {}", "mine.yaml:2: key 'node' is not known; did you mean 'nodes'"),
        ("nodes:\n  a: {}\n  a: {}", "mine.yaml:3: the key 'a' is repeated"),
        ("nodes:\n  ? [a]\n  : b", "mine.yaml:2: a key is a mapping or a list"),
        ("nodes: &a {b: *a}", "mine.yaml:1:15: not valid YAML: the alias is inside the"),
        ("nodes: {a: text}", "node 'a' is the text 'text'; write keys"),
        ("nodes: {1a: {}}", "mine.yaml:1: node name '1a': "),
        ("nodes: {a: {shared: 'yes'}}", "shared is the text 'yes'; write true or false"),
        ("nodes: {a: {note: {}}}", "note is a mapping; write a text"),
        ("nodes: {a: {fixed: true}}", "fixed is true or false; write a list"),
        ("nodes: {a: {with: [tf_lis]}}", "part 'tf_lis' is not known; did you mean 'tf_listener'"),
        ("nodes: {a: {calls: {b c: x}}}", "mine.yaml:1: name 'b c': "),
        (
            "nodes:\n  a:\n    calls:\n      b:\n        typ: x",
            "mine.yaml:5: key 'typ' is not known; did you mean 'type'?",
        ),
        ("nodes: {a: {calls: {b: Empty}}}", "'Empty' is not a ROS type; write it like"),
        (
            "nodes: {a: {calls: {b: std_msgs/msg/Empty}}}",
            "calls 'b': std_msgs/msg/Empty is the type of a topic",
        ),
        (
            "nodes: {a: {publishes: {b: std_srvs/srv/Empty}}}",
            "publishes 'b': std_srvs/srv/Empty is the type of a service",
        ),
        ("node_sets: {a: {nodes: [amlc]}}", "node 'amlc' is not known; did you mean 'amcl'?"),
        ("node_sets: {a: {nodes: [{as: b}]}}", "the entry has no node"),
        ("node_sets: {a: {nodes: [{node: amcl, as: a-b}]}}", "node name 'a-b': "),
        (
            "node_sets: {a: {nodes: [{node: amcl, names: {scam: x}}]}}",
            "name 'scam' is not known; did you mean 'scan'?",
        ),
        (
            "node_sets: {a: {nodes: [{node: amcl, remaps: {scam: x}}]}}",
            "name 'scam' is not known; did you mean 'scan'?",
        ),
        ("node_sets: {a: {nodes: [{node: amcl, remaps: {scan: x//y}}]}}", "name 'x//y': "),
        ("node_sets: {a: {include: [nav]}}", "node set 'nav' is not known; did you mean 'nav2'?"),
        (
            "node_sets:\n  a: {include: [b]}\n  b: {include: [a]}",
            "mine.yaml:2: node set 'a' includes itself, remove one: a -> b -> a",
        ),
        (
            "node_sets: {a: {nodes: [amcl, {node: map_server, as: amcl}]}}",
            "node set 'a' has two different nodes called 'amcl'",
        ),
    ],
)
def test_what_is_wrong_is_reported_with_its_place(text: str, message: str) -> None:
    with pytest.raises(UsageError) as caught:
        extra(text)
    assert str(caught.value).startswith("mine.yaml:")
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_file_that_cannot_be_read_is_reported(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"none\.yaml: cannot be read: No such file"):
        user_library(str(tmp_path / "none.yaml"), NEWEST_LTS)
    (tmp_path / "latin.yaml").write_bytes(b"about: \xe4")
    with pytest.raises(UsageError, match="it is not UTF-8"):
        user_library(str(tmp_path / "latin.yaml"), NEWEST_LTS)


@pytest.mark.more
def test_yaml_is_loaded_where_a_node_set_is_asked_for_only() -> None:
    code = "import sys, multibot_rewrite.knowledge.node_sets; print('yaml' in sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == "False\n"


RULES = """\
node_sets:
  here: {include: [nav2], remaps: {amcl: {scan: front/scan}, controller_server: {odom: wheels}}}
  there: {include: [here], remaps: {amcl: {scan: rear/scan}}}
"""


def test_a_node_set_remaps_names_of_the_nodes_that_it_includes() -> None:
    """The outer rule counts; the other rules of the node stay."""
    ends = {
        (name, it.name, end.name): end.remapped
        for name in ("nav2", "here", "there")
        for it in nodes_of_set(extra(RULES), name)
        for end in it.endpoints
    }
    assert ends["nav2", "amcl", "scan"] == ""
    assert ends["here", "amcl", "scan"] == "front/scan"
    assert ends["there", "amcl", "scan"] == "rear/scan"
    assert ends["there", "controller_server", "odom"] == "wheels"
    assert ends["here", "controller_server", "cmd_vel"] == "cmd_vel_nav"


@pytest.mark.parametrize(
    ("remaps", "message"),
    [
        ("{aml: {scan: x}}", "mine.yaml:1: node 'aml' is not known; did you mean 'amcl'?"),
        ("{amcl: {scam: x}}", "mine.yaml:1: name 'scam' is not known; did you mean 'scan'?"),
        ("{amcl: {scan: x//y}}", "name 'x//y': "),
        ("{amcl: scan}", "remaps of amcl is the text 'scan'; write keys and values"),
        ("{amcl: {scan: [x]}}", "remaps scan is a list; "),
    ],
)
def test_a_rule_of_a_node_set_that_cannot_be_meant_is_told(remaps: str, message: str) -> None:
    with pytest.raises(UsageError) as caught:
        extra(f"node_sets: {{here: {{include: [nav2], remaps: {remaps}}}}}")
    assert message in str(caught.value)
