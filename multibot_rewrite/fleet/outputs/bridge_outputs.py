# SPDX-License-Identifier: Apache-2.0
"""The ros_gz_bridge files of a fleet: one for each robot, and one for what all robots share."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import cast

import yaml

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, declare
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_file import (
    FilesAndFindings,
    FilesToCheck,
    OutputFile,
    ReadFile,
    gz_bridge_path,
    own_yaml,
    path_for,
)
from multibot_rewrite.fleet.outputs.spawn import simulators
from multibot_rewrite.fleet.robots.fitting.fitted import brings_transforms
from multibot_rewrite.fleet.robots.member import line_of
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.robot_groups import RobotGroup, group_robots
from multibot_rewrite.planning.bridged_topics import (
    DIRECTIONS,
    BridgedTopic,
    UnbridgedTopic,
    as_yaml,
    bridged_topics,
)
from multibot_rewrite.producers.ends import BRIDGE_FILE
from multibot_rewrite.producers.launch.bridges import rows_of_text
from multibot_rewrite.related_files.bridge import (
    BOTH,
    GZ,
    MODEL_SLOT,
    ROS,
    BridgeFile,
    rewrite_bridge,
)
from multibot_rewrite.related_files.context import FileTemplate, fill_template
from multibot_rewrite.related_files.names.node_topics import robot_topic
from multibot_rewrite.related_files.rviz.read_config import text_of
from multibot_rewrite.related_files.yaml_text import (
    blocks,
    cut_out,
    found_at,
    items,
    moved,
    read_yaml,
)
from multibot_rewrite.system.records import PUBLISHES, SERVES
from multibot_rewrite.system.words import is_order, is_viewer

_GIVES = (PUBLISHES, SERVES)


def bridge_outputs(plan: FleetPlan) -> FilesToCheck:
    """Return every bridge file of a fleet; raises InputError if one cannot be read or rewritten."""
    fleet = plan.fleet
    # A vendor who bridges transforms bridges all of them.
    vendors = (it.spec for it in plan.robots if it.spec.launch and brings_transforms(it.spec))
    placed = {*fleet.placed, *(it.namespace for it in vendors)}
    topics, unbridged = bridged_topics(
        fleet.inventories, fleet.naming, fleet.models, fleet.table.runs, placed
    )
    groups = _bridges_by_group(plan)
    for group, files in groups:
        for file in files.values():
            yield from file.own.findings
            yield ReadFile(file.own.file, tuple(group.robots))
        for robot in group.robots:
            made = list(_robot_bridges(robot, files, topics))
            yield from made
            own = [it for it in unbridged if it.robot == robot.spec.namespace]
            texts = [it for it in made if isinstance(it, OutputFile)]
            given = plan.evidence_of(robot).arguments
            for it in own:
                # A bridge of the robot's launch files may have an argument for it.
                is_launched = bool(it.part) and any(it.part in word for word in given)
                if is_launched or _is_carried(it, texts, topics):
                    continue
                # The line in the source: inserted text moves those of the result.
                written = robot.member.inventory.document.root.iter(it.tag)
                number = [cast("int", one.sourceline) for one in written].index(it.line)
                line = line_of(robot.member.source, it.tag, number)
                message = f"{it.what} of {robot.spec.name} is not bridged: {it.why}"
                yield NO_TOPIC.finding(message, it.hint, file=robot.spec.description, line=line)
    yield from _shared_bridge([files for _, files in groups], topics, simulators(plan) == ["gz"])


def _bridges_by_group(plan: FleetPlan) -> list[tuple[RobotGroup, dict[str, BridgeFile]]]:
    """Return the groups of robots with their bridge files by path, each rewritten once."""
    groups = []
    for group in group_robots(plan):
        spec = group.robots[0].spec
        above = spec.bridge_namespace_of
        bridges = {
            it: rewrite_bridge(own_yaml(spec, it), group.context, above=above(it))
            for it in group.related_files.get("bridge", ())
        }
        groups.append((group, bridges))
    return groups


def given_once(plan: FleetPlan) -> list[str]:
    """Return topics and services of what runs once for all robots, whose other end robots have.

    They are those that bridges pass on of the world, and what nodes for all robots send, without
    orders. A robot that has both ends itself keeps its own."""
    fleet = plan.fleet
    once = {
        (name, True)
        for run, end, name in fleet.table.ends
        if not (run.robot or is_viewer(run.name) or is_order(name, end.type)) and end.role in _GIVES
    }
    for _, files in _bridges_by_group(plan):
        rows = (row.end for it in files.values() for row in rows_of_text(it.shared))
        once |= {(f"/{it.name.lstrip('/')}", it.role in _GIVES) for it in rows}
    once = {it for it in once if it[0].strip("/") not in fleet.naming.shared_topics}
    if not once:
        return []
    own = {(name, end.role in _GIVES) for run, end, name in fleet.table.ends if run.robot}
    topics, _ = bridged_topics(fleet.inventories, fleet.naming, fleet.models, fleet.table.runs)
    own |= {(it.ros, it.direction != DIRECTIONS["out"]) for it in topics if it.robot}
    return [
        name
        for name, gives in sorted(once)
        for its in (robot_topic(it.topics, name) for it in plan.robots)
        if (its, not gives) in own and (its, gives) not in own
    ]


def _robot_bridges(
    robot: RewrittenRobot, files: dict[str, BridgeFile], topics: Iterable[BridgedTopic]
) -> FilesAndFindings:
    """Yield a robot's bridge files: vendor's ones as they are, the others and topics as one."""
    spec = robot.spec
    texts = [
        (path, fill_bridge(file.own.template, spec.namespace, spec.tag, spec.model))
        for path, file in files.items()
    ]
    for path, own in texts:
        # A vendor's launch file starts a bridge for each of them.
        if path_for(robot, path).partition("/")[2] in dict(spec.places).values():
            yield OutputFile(path_for(robot, path), own.encode(), (path,))
    text, findings = merge_bridges(texts, [it for it in topics if it.robot == spec.namespace])
    yield from findings
    if text:
        yield OutputFile(gz_bridge_path(robot), text.encode(), tuple(files))


def _shared_bridge(
    groups: Iterable[dict[str, BridgeFile]], topics: Sequence[BridgedTopic], is_timed: bool
) -> FilesAndFindings:
    """Yield the bridge of what all robots share; ``is_timed`` if their clock is that of Gazebo."""
    shared = dict.fromkeys(
        (path, file.shared) for files in groups for path, file in files.items() if file.shared
    )
    if not shared and not is_timed and not any(it.robot for it in topics):
        return
    text, findings = merge_bridges(shared, [it for it in topics if not it.robot])
    yield from findings
    yield OutputFile(BRIDGE_FILE, text.encode(), tuple(dict.fromkeys(path for path, _ in shared)))


NO_TOPIC = declare("MF509", "sensor-without-gz-topic", WARNING, formats=("fleet-urdf",))


def _is_carried(
    topic: UnbridgedTopic, made: Iterable[OutputFile], others: Iterable[BridgedTopic]
) -> bool:
    """Return whether a user's file has a row for a topic that depends on the world."""
    known = {it.gz.lstrip("/") for it in others}
    for row in (row for it in made for row in items(read_yaml(it.data, it.path).root)):
        name = text_of(row, GZ) or text_of(row, BOTH)
        alike = topic.part or text_of(row, "gz_type_name") == topic.type
        if alike and topic.part in name and name.lstrip("/") not in known:
            return True
    return False


# Topics that several gz topics may come out on.
TF = frozenset({"/tf", "/tf_static"})
# What gz-transport takes in a topic (gz-transport TopicUtils).
_GZ_WORD = lazy_compile(r"[A-Za-z0-9_.-]+(?:/[A-Za-z0-9_.-]+)*")


def fill_bridge(template: FileTemplate, namespace: str, tag: str, model: str) -> str:
    """Return a robot's bridge file; raises InputError if its model's name is invalid in gz topics."""
    text = fill_template(template, namespace, tag)
    if MODEL_SLOT in text and not _GZ_WORD.fullmatch(model):
        raise InputError(
            f"model {model!r} cannot be part of a gz topic; use letters, digits, _ . and - only"
        )
    return text.replace(MODEL_SLOT, model)


def merge_bridges(
    texts: Iterable[tuple[str, str]], generated: Iterable[BridgedTopic]
) -> tuple[str, tuple[Finding, ...]]:
    """Return one bridge file of several texts and generated topics, and findings."""
    # An entry of a file wins over a generated one with the same gz topic. Two gz topics on one ROS
    # topic are an error.
    parts: list[str] = []
    findings: list[Finding] = []
    # By gz topic the file, by ROS topic its first gz topic.
    bridged: dict[str, int] = {}
    onto: dict[str, str] = {}
    for at, (file, text) in enumerate(texts):
        document = read_yaml(text.encode(), file)
        root = document.root
        if not isinstance(root, yaml.SequenceNode) or not root.value:
            continue
        for node, (start, end, column) in zip(root.value, blocks(document, root), strict=True):
            gz = _absolute_name(text_of(node, BOTH) or text_of(node, GZ) or text_of(node, ROS))
            ros = _absolute_name(text_of(node, BOTH) or text_of(node, ROS) or text_of(node, GZ))
            # Topics for all robots, such as the clock, are bridged once, by the first file.
            if bridged.setdefault(gz, at) == at:
                first = onto.setdefault(ros, gz)
                to_ros = text_of(node, "direction") != "ROS_TO_GZ"
                if first != gz and ros not in TF and to_ros:
                    message = f"gz topics {first} and {gz} are both bridged to ROS topic {ros}"
                    hint = "give each its own ros_topic_name"
                    findings.append(found_at(document, node, ONE_ROS_TOPIC, message, hint))
                parts.append(moved(cut_out(document, start, end), -column))
    more = [it for it in generated if _absolute_name(it.gz) not in bridged]
    return "".join(parts) + as_yaml(more), tuple(findings)


def _absolute_name(name: str) -> str:
    return f"/{name.lstrip('/')}"


ONE_ROS_TOPIC = declare("MF506", "bridge-two-on-one-topic", ERROR, formats=("bridge",))
