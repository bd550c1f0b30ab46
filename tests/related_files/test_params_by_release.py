# SPDX-License-Identifier: Apache-2.0
"""Parameter files by release: prefixes before frames, slashes, what is deprecated or not sent.

Expectations are from ros2_controllers (diff_drive_controller.cpp, steering_controllers_library.cpp,
doc/migration.rst), controller_interface/tf_prefix.hpp and nav2_amcl/src/amcl_node.cpp.
"""

from __future__ import annotations

import pytest
from made_params import codes, made, section

from multibot_rewrite.knowledge.parameters import built_in_nodes

DRIVES = ("diff_drive_controller", "mecanum_drive_controller", "omni_wheel_drive_controller")


def lines(node: str, *given: str, release: str) -> list[str]:
    """Return the section's lines for robot1."""
    return [it.strip() for it in made(section(node, *given), distro=release)[0].splitlines()]


def prefix_of(written: list[str], release: str, namespace: str = "/robot1") -> str:
    """Return what the controllers' code puts before frames, as it is in the release's sources."""
    given = dict(it.split(": ", 1) for it in written if ": " in it and not it.startswith("#"))
    prefix = given.get("tf_frame_prefix", "").strip('"')
    if given.get("tf_frame_prefix_enable", "true") == "false":
        return ""
    if release in ("lyrical", "rolling"):
        prefix = prefix.replace("~", namespace, 1)
    prefix = prefix or namespace
    prefix = prefix if prefix.endswith("/") else prefix + "/"
    return prefix.removeprefix("/")


@pytest.mark.sample(1)
@pytest.mark.parametrize("node", DRIVES)
@pytest.mark.parametrize("release", ["jazzy", "kilted", "lyrical", "rolling"])
@pytest.mark.parametrize(
    "given",
    [
        pytest.param((), id="nothing"),
        pytest.param(('tf_frame_prefix: ""',), id="empty"),
        pytest.param(("tf_frame_prefix: ~",), id="null"),
        pytest.param(('tf_frame_prefix: "~"',), id="namespace"),
        pytest.param(("tf_frame_prefix: rover", "tf_frame_prefix_enable: true"), id="another"),
        pytest.param(("tf_frame_prefix_enable: false",), id="off"),
    ],
)
def test_a_drive_puts_no_prefix_before_frames(
    node: str, release: str, given: tuple[str, ...]
) -> None:
    assert prefix_of(lines(node, "use_sim_time: true", *given, release=release), release) == ""


def test_the_code_of_the_test_has_a_prefix() -> None:
    assert prefix_of([], "jazzy") == "robot1/"
    assert prefix_of(['tf_frame_prefix: ""'], "lyrical") == "robot1/"
    assert prefix_of(["tf_frame_prefix: ~/arm"], "lyrical") == "robot1/arm/"


@pytest.mark.parametrize("node", DRIVES)
def test_what_is_deprecated_is_not_inserted(node: str) -> None:
    assert "tf_frame_prefix_enable: false" in lines(node, "use_sim_time: true", release="kilted")
    later = lines(node, "use_sim_time: true", release="lyrical")
    assert "tf_frame_prefix: /" in later
    assert not [it for it in later if it.startswith("tf_frame_prefix_enable")]


@pytest.mark.parametrize("node", DRIVES)
def test_a_switch_that_is_on_is_turned_off(node: str) -> None:
    """The build's own check of what it wrote takes true for a prefix."""
    text, findings = made(section(node, "tf_frame_prefix_enable: true"), distro="lyrical")
    assert "tf_frame_prefix_enable: false" in text
    assert codes(findings) == ["MB869"]


@pytest.mark.parametrize("node", ["ackermann_steering_controller", "tricycle_steering_controller"])
def test_a_steering_controller_has_no_prefix_unless_it_is_told(node: str) -> None:
    assert 'tf_frame_prefix: "/"' in lines(node, 'tf_frame_prefix: "~"', release="lyrical")
    assert "tf_frame_prefix: /" in lines(node, "tf_frame_prefix: rover", release="lyrical")
    assert 'tf_frame_prefix: ""' in lines(node, 'tf_frame_prefix: ""', release="lyrical")
    assert "tf_frame_prefix" not in made(section(node, "open_loop: true"), distro="lyrical")[0]


def test_a_prefix_of_a_launch_file_is_reported() -> None:
    _, findings = made(
        section("diff_drive_controller", "tf_frame_prefix: $(var prefix)"), distro="lyrical"
    )
    assert codes(findings) == ["MF116"]


@pytest.mark.parametrize(
    ("node", "release", "line", "level"),
    [
        ("amcl", "humble", "odom_frame_id: r1/odom", "note"),
        ("amcl", "kilted", "odom_frame_id: r1/odom", "note"),
        ("amcl", "lyrical", "odom_frame_id: /r1/odom", "warning"),
        ("diff_drive_controller", "humble", "odom_frame_id: /r1/odom", "warning"),
    ],
)
def test_a_slash_is_taken_off_where_the_node_does(
    node: str, release: str, line: str, level: str
) -> None:
    text, findings = made(section(node, "odom_frame_id: /odom"), distro=release)
    assert line in text
    assert [(it.code, it.level) for it in findings] == [("MB301", level)]


def test_a_joint_group_controller_is_deprecated_from_lyrical_on() -> None:
    text = section(
        "controller_manager", "arm: {type: effort_controllers/JointGroupEffortController}"
    )
    assert codes(made(text, distro="kilted")[1]) == []
    assert codes(made(text, distro="lyrical")[1]) == ["MB869"]
    flat = section(
        "controller_manager", "arm.type: velocity_controllers/JointGroupVelocityController"
    )
    assert codes(made(flat, distro="rolling")[1]) == ["MB869"]


@pytest.mark.parametrize(
    ("given", "found"),
    [
        (("interfaces: [position, temperature]",), ["MB871"]),
        (("interfaces: [position, effort]",), []),
        (("interfaces: [effort]", "publish_dynamic_joint_states: true"), ["MB869"]),
        (("interfaces: [pos]", "map_interface_to_joint_state: {position: pos}"), []),
    ],
)
def test_interfaces_that_nobody_publishes(given: tuple[str, ...], found: list[str]) -> None:
    text = section("joint_state_broadcaster", *given)
    assert codes(made(text, distro="lyrical")[1]) == found
    assert codes(made(text, distro="kilted")[1]) == []


@pytest.mark.parametrize(
    ("node", "line", "release", "others"),
    [
        # nav2_behaviors: costmap_topic until Humble, local_costmap_topic since Iron.
        ("behavior_server", "costmap_topic: local_costmap/costmap_raw", "jazzy", "humble"),
        ("behavior_server", "local_costmap_topic: x", "humble", "jazzy, kilted, lyrical, rolling"),
        # nav2_collision_monitor: the transport of a source is new in 1.5.
        ("collision_monitor", "scan.transport_type: raw", "kilted", "lyrical, rolling"),
        ("collision_monitor", "scan: {transport_type: raw}", "kilted", "lyrical, rolling"),
    ],
)
def test_a_parameter_that_only_other_releases_have(
    node: str, line: str, release: str, others: str
) -> None:
    _, findings = made(section(node, line), distro=release)
    (found,) = (it for it in findings if it.code == "MB870")
    assert (found.level, found.line) == ("note", 3)
    assert found.message.endswith(f"is not in {release}, only in {others}")
    assert codes(made(section(node, line), distro=others.rpartition(" ")[2])[1]).count("MB870") == 0


def test_a_node_that_only_another_release_has_is_told_once() -> None:
    known = built_in_nodes("humble")
    amcl = known.nodes["amcl"]
    later = amcl._replace(releases="rolling")
    known = known._replace(nodes={**known.nodes, "amcl": later})
    text = section("amcl", "saved_pose_filepath: /tmp/x")
    _, found = made(text, distro="humble", known=known)
    assert [it.message for it in found if it.code == "MB870"] == [
        "node amcl is not in humble, only in rolling"
    ]
