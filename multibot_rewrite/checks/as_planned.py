# SPDX-License-Identifier: Apache-2.0
"""Compares a plan with what would run of the folder that was built for it.

What the plan leaves to others is none of it: a simulator, the bringup of a robot, a node that is
started by hand or on a condition.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence, Set

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.knowledge.records import MANAGER
from multibot_rewrite.producers.launch.launched import NOT_WHOLE
from multibot_rewrite.rules.check import ABSENCE, absences, check_view
from multibot_rewrite.rules.launch.judge import CLAIMS
from multibot_rewrite.rules.system import (
    clocks,
    matching,
    names,
    planned_ends,
    planned_frames,
    planned_nodes,
    relays,
    sharing,
    tf_pieces,
    transforms,
)
from multibot_rewrite.rules.system.commands import command_to_nobody
from multibot_rewrite.rules.system.unsent import is_for_driver
from multibot_rewrite.rules.with_plan import subject_of
from multibot_rewrite.system.index import Index, index
from multibot_rewrite.system.ownership import whose_by_plan
from multibot_rewrite.system.parameters import LIST_CONTROLLERS
from multibot_rewrite.system.records import (
    HOST,
    RUNS,
    SERVES,
    SPAWNER,
    Environment,
    Place,
    System,
    doubts,
    surely,
)

# Parameters and descriptions may have them whatever the build does: types, trees of tf, and frames that
# no parameter file names. Between robots they are the build's.
_OF_SOURCES = frozenset(
    it.code
    for it in (
        *(matching.types_differ, relays.limits_left_out, sharing.topic_of_several_robots),
        *(transforms.frame_with_two_parents, transforms.robots_frames_collide),
        *(transforms.tf_cycle, transforms.static_and_moving, transforms.transform_of_two_senders),
        planned_frames.frame_without_robot_name,
    )
)
# Both sides are known by the launch file, and they miss each other by name.
_MISSED = (names.topic_names_miss.code, names.server_names_miss.code, command_to_nobody.code)
# What a simulator may give that the launch file does not start.
_OF_OTHERS = clocks.no_clock.code
# What a node of the launch file has is known, whatever else runs.
_LACKS = planned_ends.missing_endpoint.code
_OF_NODES = (planned_nodes.missing_node.code, planned_nodes.missing_robot.code, _LACKS)


def not_as_planned(
    planned: System,
    seen: System,
    started: Set[str],
    told: Sequence[Finding],
    real: Set[str] = frozenset(),
) -> Iterator[Finding]:
    """Yield as errors what ``multibot check`` would report of the running fleet.

    ``started`` are the planned nodes that the launch file starts. What the build has ``told`` is
    reported as there. ``real`` robots have drivers that no file names."""
    running = {it.name: it for it in seen.nodes}
    found = check_view(planned, seen._replace(environment=Environment()))
    if not found:
        return
    by_plan, there = (index(it, whose_by_plan(planned)) for it in (planned, seen))
    open_, known = (
        open_names(by_plan, told),
        lists_by_key((subject_of(by_plan, it), it) for it in told),
    )
    for it in found:
        level, place = _level(it, planned, seen, started), Place(it.file, it.line, it.column)
        if not it.file and it.node in running:
            place = running[it.node].place
        if level and it.robot in real and is_for_driver(there, it):
            level = NOTE
        if not level or any((it.code, name) in open_ for name in it.names):
            continue
        here = it._replace(file=place.file, line=place.line, column=place.column)
        yield from (one._replace(level=level) for one in known.get(subject_of(by_plan, it), [here]))


def is_of_sources(it: Finding) -> bool:
    """Return whether a finding's code is for a fault that one robot's sources may have."""
    return bool(it.robot) and it.code in (*_OF_SOURCES, *_MISSED)


def open_names(by_plan: Index, told: Iterable[Finding]) -> frozenset[tuple[str, str]]:
    """Return codes and names of what is open by the plan or the reports already."""
    lacking = [it for it in (*told, *absences(by_plan)) if it.code in ABSENCE]
    alone = (it for it in lacking if it.code not in _MISSED or len(it.names) == 1)
    found = {(it.code, name) for it in alone for name in it.names}
    calls = (it for it in lacking if it.code == names.server_names_miss.code)
    return frozenset(found | {(planned_ends.missing_endpoint.code, it.names[0]) for it in calls})


def _level(it: Finding, planned: System, seen: System, started: Set[str]) -> str:
    """Return the level of a finding; empty for what is no fault of the folder."""
    if it.code in _OF_NODES:
        return ERROR if _is_to_be_started(it, planned, seen, started) else ""
    if it.code in CLAIMS and it.level == WARNING:
        return ERROR
    if it.level != ERROR or it.code == _OF_OTHERS:
        return ""
    if it.code == tf_pieces.tf_tree_in_pieces.code:
        senders = {
            one for edge in planned.edges if edge.child in it.names for one in edge.publishers
        }
        # Is the transform that of a node that may be missing and is not started? A simulator may send
        # any other.
        left = any(one.name in senders - started and one.sure != RUNS for one in planned.nodes)
        return NOTE if left else "" if doubts(seen) else WARNING
    if it.code == planned_nodes.bridged_topic_missing.code:
        return ERROR if _is_read(seen) else ""
    sure = it.code not in ABSENCE or not doubts(seen)
    return ERROR if sure or _names_what_a_node_lacks(it, planned, seen, started) else ""


def _names_what_a_node_lacks(it: Finding, planned: System, seen: System, started: Set[str]) -> bool:
    """Return whether a finding names what a started node lacks, compared with the plan."""
    there = {(one.node, one.kind, one.role, one.name) for one in seen.ends}
    named = (one for one in surely(planned).ends if one.name in it.names)
    lacks = [one.node for one in named if (one.node, one.kind, one.role, one.name) not in there]
    of_nodes = (it._replace(code=_LACKS, node=node) for node in lacks)
    return any(_is_to_be_started(one, planned, seen, started) for one in of_nodes)


def _is_read(seen: System) -> bool:
    """Return whether all that the launch file starts is known, with its parameters."""
    return all(it.code != NOT_WHOLE for it in doubts(seen))


def _is_to_be_started(it: Finding, planned: System, seen: System, started: Set[str]) -> bool:
    """Return whether the launch file is to start the node, or one of the robot."""
    # What a node has depends on its parameters, a controller on its manager.
    if it.code == planned_nodes.missing_robot.code:
        return any(one.robot == it.robot and one.name in started for one in planned.nodes)
    own = next((one for one in planned.nodes if one.name == it.node), None)
    if own is None or it.node not in started:
        return False
    if it.code == planned_nodes.missing_node.code:
        loaded = own.way == SPAWNER or (own.way == HOST and not own.taker)
        home = own.name.rpartition("/")[0]
        managers = (one.name for one in seen.nodes if one.known == MANAGER)
        return not loaded or any(one.rpartition("/")[0] == home for one in managers)
    known = any(one.known for one in seen.nodes if one.name == it.node)
    # The manager of the plan is told the type of its controllers.
    robots = {one.name: one.robot for one in planned.nodes}
    serving = {
        robots.get(one.node)
        for one in planned.ends
        if (one.role, one.type) == (SERVES, LIST_CONTROLLERS)
    }
    return _is_read(seen) and (known or (own.way == SPAWNER and own.robot in serving))
