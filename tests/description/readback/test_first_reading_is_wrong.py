# SPDX-License-Identifier: Apache-2.0
"""The rewrite misses something wherever it looks, so its own proof holds: the second reading says so.

Each fault is put into the code that both passes of the rewrite share. The second reading shares the
definitions with them and nothing else.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, NamedTuple

import pytest

from multibot_rewrite import rewrite
from multibot_rewrite.base import naming
from multibot_rewrite.description.rewriters import insert, remap_rules, tree
from multibot_rewrite.description.rewriters.tree import TreeNode, builtin_tree
from multibot_rewrite.description.sources import job
from multibot_rewrite.description.steps import collect, plan, verify

ROVER = """\
<robot name="rover">
  <link name="base"/><link name="wheel"/>
  <joint name="axle" type="continuous"><parent link="base"/><child link="wheel"/></joint>
  <gazebo>%s</gazebo>
</robot>
"""
DRIVE = '<plugin name="drive" filename="libgazebo_ros_diff_drive.so">%s</plugin>'
# Neither is on by itself.
ODOM = "<publish_odom>true</publish_odom><publish_odom_tf>true</publish_odom_tf>"
IMU = '<plugin name="imu" filename="libgazebo_ros_imu_sensor.so">%s</plugin>'
LASER = '<plugin name="laser" filename="libgazebo_ros_laser.so">%s</plugin>'
GZ = '<plugin name="gz::sim::systems::DiffDrive" filename="gz-sim-diff-drive-system">%s</plugin>'
NOBODY = '<plugin name="own" filename="libnobody_knows.so">%s</plugin>'
SCAN = "</gazebo><gazebo reference='base'><sensor name='lidar' type='gpu_lidar'>%s</sensor>"


class Fault(NamedTuple):
    """``names`` of ``owner`` are ``instead``; the plugin is ``source``, and ``shared`` what meets."""

    owner: Any
    name: str
    instead: Any
    source: str
    shared: str
    layout: str = "both"


def nothing(*_: object) -> tuple[()]:
    return ()


def none(*_: object) -> None:
    return None


def own_text(element: Any) -> str:
    """Return the text before anything else, comments too."""
    return (element.text or "").strip()


def majority(found: Any, element: Any) -> Any:
    """Return the release with more of the tags, whatever <ros> says."""
    tags = {child.tag for child in element}
    return max(found, key=lambda section: (len(section.tags & tags), section.ros))


def without(*kinds: str) -> Callable[..., dict[str, str]]:
    """Return the kinds that are renamed, without some."""
    right = naming._active_separators
    return lambda *given: {k: it for k, it in right(*given).items() if k not in kinds}


def unseen(path: str) -> Callable[[TreeNode, Any], None]:
    """Return a tree that has no place for the sites at a path."""
    right = TreeNode._add_site
    return lambda node, site: None if site.path == path else right(node, site)


FAULTS = {
    "no default is inserted": Fault(insert, "_of_defaults", nothing, DRIVE % "", "frame 'odom'"),
    "no namespace is inserted": Fault(insert, "_of_defaults", nothing, IMU % "", "node '/imu'"),
    "no rule is inserted": Fault(insert, "_remaps", nothing, DRIVE % ODOM, "topic '/tf'"),
    "no rule is inserted for a wired topic": Fault(
        insert, "_remaps", nothing, DRIVE % ODOM, "topic '/odom'", "postfix"
    ),
    "an empty namespace is taken for one": Fault(
        insert, "text_of", lambda _: "x", IMU % "<ros><namespace/></ros>", "node '/imu'"
    ),
    "a namespace behind a comment is not read": Fault(
        collect,
        "text_of",
        own_text,
        IMU % "<ros><namespace><!-- --> /a</namespace></ros>",
        "node '/a/imu'",
    ),
    "a topic behind a comment is not read": Fault(
        collect,
        "text_of",
        own_text,
        LASER % "<topicName><!-- -->/scan</topicName>",
        "topic '/scan'",
    ),
    "a rule behind a comment is not read": Fault(
        collect,
        "text_of",
        own_text,
        DRIVE % "<ros><remapping><!-- -->cmd_vel:=/cmd</remapping></ros>",
        "topic '/cmd'",
    ),
    "topics stay": Fault(
        naming,
        "_topic_affix",
        none,
        LASER % "<topicName>/scan</topicName>",
        "topic '/scan'",
        "postfix",
    ),
    "topics of gz stay": Fault(
        naming, "_topic_affix", none, GZ % "<topic>/cmd</topic>", "topic '/cmd'"
    ),
    "topics of sensors stay": Fault(
        naming, "_topic_affix", none, SCAN % "<topic>scan</topic>", "topic '/scan'"
    ),
    "namespaces stay": Fault(
        naming,
        "_namespace_affix",
        none,
        IMU % "<ros><namespace>/a</namespace></ros>",
        "node '/a/imu'",
    ),
    "nodes stay": Fault(
        naming, "_active_separators", without("node"), IMU % "", "node '/imu'", "postfix"
    ),
    "frames stay": Fault(
        naming,
        "_active_separators",
        without("frame"),
        DRIVE % "<odometry_frame>o</odometry_frame>",
        "frame 'o'",
    ),
    "links stay": Fault(naming, "_active_separators", without("link"), "", "frame 'base'"),
    "a rule is not read": Fault(
        remap_rules,
        "remap",
        nothing,
        DRIVE % "<ros><remapping>cmd_vel:=/cmd</remapping></ros>",
        "topic '/cmd'",
    ),
    "a parameter has no place in the tree": Fault(
        TreeNode,
        "_add_site",
        unseen("topicName"),
        LASER % "<topicName>/scan</topicName>",
        "topic '/scan'",
    ),
    "a namespace has no place in the tree": Fault(
        TreeNode,
        "_add_site",
        unseen("ros/namespace"),
        IMU % "<ros><namespace>/a</namespace></ros>",
        "node '/a/imu'",
    ),
    "plugins are not told apart": Fault(
        tree,
        "SELECTORS",
        tree.SELECTORS | {"plugin": lambda _: []},
        IMU % "<ros><namespace>/a</namespace></ros>",
        "node '/a/imu'",
    ),
    "an unknown plugin with <ros> is nothing": Fault(
        tree,
        "SELECTORS",
        tree.SELECTORS | {"plugin": lambda _: []},
        NOBODY % "<ros><namespace>/a</namespace></ros>",
        "node '/a/own'",
    ),
}


def found(fault: Fault) -> tuple[set[str], tuple[str, ...]]:
    """Return what is shared by the words of the findings, and why the rewrite is not verified."""
    result = rewrite(ROVER % fault.source, "robot1", layout=fault.layout)
    said = (re.search(r"would have the (\w+ '[^']*')", it.message) for it in result.findings)
    return {it[1] for it in said if it}, result.not_verified


@pytest.mark.sample(1)
@pytest.mark.parametrize("fault", FAULTS.values(), ids=FAULTS)
def test_the_second_reading_names_what_is_shared(
    monkeypatch: pytest.MonkeyPatch, fault: Fault
) -> None:
    builtin_tree.cache_clear()
    shared, _ = found(fault)
    assert fault.shared not in shared, "without the fault there is nothing to find"
    monkeypatch.setattr(fault.owner, fault.name, fault.instead)
    builtin_tree.cache_clear()
    try:
        shared, why = found(fault)
    finally:
        builtin_tree.cache_clear()
    assert fault.shared in shared
    assert any("shared by all robots" in it for it in why)


# The release is chosen by tags.
BY_TAGS = Fault(
    tree,
    "_by_ros",
    majority,
    IMU % "<ros/><topicName>imu</topicName><bodyName>base</bodyName>",
    "node '/imu'",
)


def test_the_second_reading_sees_a_plugin_of_the_other_ros(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What decides for the whole document does not count either."""
    monkeypatch.setattr(job, "ros_shown", lambda *_: "")
    test_the_second_reading_names_what_is_shared(monkeypatch, BY_TAGS)


def test_nothing_is_inserted_at_all(monkeypatch: pytest.MonkeyPatch) -> None:
    """By the plan, nor asked for by the proof."""
    for module in (plan, verify):
        monkeypatch.setattr(module, "insertions", lambda *_: [])
    fault = FAULTS["no default is inserted"]._replace(source=DRIVE % ODOM + IMU % "")
    assert found(fault)[0] >= {"frame 'odom'", "topic '/tf'", "node '/imu'", "node '/drive'"}
