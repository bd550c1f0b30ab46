# SPDX-License-Identifier: Apache-2.0
"""Dangers of time: no clock, two clocks, mixed ones, and stamps of another time than now."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence, Set
from fnmatch import translate
from math import inf, isinf

from multibot_rewrite.base.conventions import CLOCK, TIMED
from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, Remap, Setting
from multibot_rewrite.base.grouping import lists_by_key, sets_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.wording import and_then, only, shorten, unique
from multibot_rewrite.rules.declaration import system_rule
from multibot_rewrite.rules.system.causes import Cause, to_set
from multibot_rewrite.system import words
from multibot_rewrite.system.index import Index, at_work, nodes_of, once, robots_of, sent_on
from multibot_rewrite.system.parameters import parameter_text
from multibot_rewrite.system.records import (
    PUBLISHES,
    RUNS,
    SIM_TIME,
    SUBSCRIBES,
    TOPIC,
    Edge,
    without_clock,
)
from multibot_rewrite.system.words import is_viewer, last_word

_IS_TIMED = lazy_compile("|".join(map(translate, TIMED)))

_TYPE = "rosgraph_msgs/msg/Clock"
_SENT = (TOPIC, PUBLISHES, CLOCK)


@system_rule("MG501", "no-clock", ERROR, absence=True)
def no_clock(seen: Index) -> Iterator[Finding]:
    """Yield a finding for each robot on simulated time without a clock."""
    by_robot = _on_simulated_time(seen)
    if _clock_senders(seen):
        return
    for robot, nodes in by_robot.items():
        who = shorten(nodes)
        message = f"on simulated time (use_sim_time), but {seen.nobody} publishes {CLOCK}: {who}"
        bridge = f"start the simulator's bridge for {CLOCK}"
        cause = to_set(SIM_TIME, parameter_text(False), *nodes)
        cause = cause._replace(hint=f"{SIM_TIME}: false on a real robot, or {bridge}")
        planned = seen.expected.by_key if seen.expected else ()
        listens = any((it, TOPIC, SUBSCRIBES, CLOCK) in planned for it in nodes)
        if listens or any(planned_clocks(seen).get(it) == parameter_text(True) for it in nodes):
            cause = Cause(bridge)
        if other := next((it for it in seen.topics if it.type == _TYPE and it.publishers), None):
            message += f"; {other.publishers[0].node} publishes {other.name}"
            sender = other.publishers[0].node
            rule = f"pass the rule {other.name}:={CLOCK} to {sender}: all robots have one clock"
            cause = Cause(rule, remaps=(Remap(sender, other.name, CLOCK),))
        yield no_clock.finding(
            message, **cause._asdict(), robot=robot, node=nodes[0], names=(CLOCK,)
        )


def _clock_senders(seen: Index) -> tuple[str, ...]:
    return nodes_of(seen.ends_at(TOPIC, CLOCK).publishers)


def _on_simulated_time(seen: Index) -> dict[str, list[str]]:
    """Return the nodes that surely subscribe to the clock, by robot; no tools, which read anything."""
    readers = at_work(it for it in seen.ends_at(TOPIC, CLOCK).subscribers if it.sure == RUNS)
    nodes = (it for it in nodes_of(readers) if not seen.is_tool(it))
    return lists_by_key((seen.robot(it), it) for it in nodes)


@system_rule("MG502", "two-clocks", ERROR)
def two_clocks(seen: Index) -> Iterator[Finding]:
    """Report several clocks on a topic, also of two nodes with one name."""
    nodes = _clock_senders(seen)
    times = {node: _clock_nodes(seen, node) for node in nodes}
    if sum(max(1, count) for count in times.values()) > 1:
        who = and_then(nodes) if len(nodes) > 1 else f"{times[nodes[0]]} nodes {nodes[0]}"
        cause = Cause("a clock bridge for each robot, or two simulators: keep one")
        if played := [it for it in nodes if last_word(it).startswith(words.PLAYER)][
            : len(nodes) - 1
        ]:
            cause = Cause(
                "play the bag without --clock", settings=(Setting(played[0], "--clock", ""),)
            )
        message = f"{who} publish {CLOCK}"
        yield two_clocks.finding(message, **cause._asdict(), node=nodes[0], names=(CLOCK,))


def _clock_nodes(seen: Index, node: str) -> int:
    """Return how many nodes of a name publish the clock; all of them if their processes are unknown."""
    processes = _processes(seen)[node]
    if "" in processes or len(processes) < seen.nodes.get(node, 0):
        return seen.nodes.get(node, 0)
    ends = (it for it in seen.by_node[node] if (it.kind, it.role, it.name) == _SENT)
    return len({it.process for it in ends} & processes)


@once
def _processes(seen: Index) -> Mapping[str, Set[str]]:
    """Return the processes of all nodes by name."""
    return sets_by_key((it.name, it.process) for it in seen.system.nodes)


@system_rule("MG504", "clock-stands-or-goes-back", ERROR, absence=True)
def clock_stands_or_goes_back(seen: Index) -> Iterator[Finding]:
    """Report a clock as it was heard; two clocks are another finding."""
    clocks, nodes = (
        _clock_senders(seen),
        [it for own in _on_simulated_time(seen).values() for it in own],
    )
    for it in (one for one in seen.system.heard if one.topic == CLOCK and len(clocks) == 1):
        about = {"node": clocks[0], "names": (CLOCK,)}
        if it.back:
            message = f"the time on {CLOCK} went back by {it.back:g} s; {clocks[0]} sends it"
            cause = "is a bag played in a loop, or was the simulation reset?"
            yield clock_stands_or_goes_back.finding(message, cause, level=WARNING, **about)
        elif it.age == inf and nodes:
            message = f"{CLOCK} stopped: {clocks[0]} sends no time, and {nodes[0]} waits for it"
            yield clock_stands_or_goes_back.finding(message, "is the simulation paused?", **about)


@system_rule("MG503", "clocks-mixed", ERROR, absence=True)
def clocks_mixed(seen: Index) -> Iterator[Finding]:
    """Report also a robot that is not on simulated time as the others are."""
    return mixed_clocks(seen)


def mixed_clocks(seen: Index) -> Iterator[Finding]:
    """Report robots some of whose nodes are on simulated time and some on the machine's."""
    yield from _not_as_planned(seen)
    simulated = {node for nodes in _on_simulated_time(seen).values() for node in nodes}
    if not simulated or not _clock_senders(seen):
        return
    untold = without_clock(seen.system)
    asked = [it for it in seen.nodes if not is_viewer(it) and it not in untold]
    timed = {it for it in asked if compares_times(last_word(seen.plain(it)))}
    timed -= planned_clocks(seen).keys()
    first, their = min(simulated), {*map(seen.robot, simulated)}
    by_robot = lists_by_key((seen.robot(node), node) for node in sorted(timed))
    every = lists_by_key((seen.robot(it), it) for it in asked if it not in simulated)
    for robot, own in by_robot.items():
        others = [node for node in own if node not in simulated]
        if others and robot in their:
            simulated_one = next((it for it in own if it in simulated), first)
            message = f"not on simulated time, as {simulated_one} is: {shorten(others)}"
            cause, level = "set use_sim_time: true for all nodes of the robot", ERROR
        elif others and robot:
            message = f"{robot} is on the machine's time, {first} on simulated time"
            cause = f"if {robot} is not a real robot in a simulation, set use_sim_time: true for it"
            level = WARNING
        else:
            continue
        yield clocks_mixed.finding(
            message, cause, level=level, robot=robot, node=others[0], names=(CLOCK,),
            settings=tuple(Setting(it, SIM_TIME, parameter_text(True)) for it in every[robot]),
        )  # fmt: skip


def planned_clocks(seen: Index) -> dict[str, str]:
    """Return by node the clock that the plan has for it, as the value of its parameter."""
    planned = seen.expected.system.parameters if seen.expected else ()
    return {it.node: it.value for it in planned if it.name == SIM_TIME}


def _not_as_planned(seen: Index) -> Iterator[Finding]:
    """Report, once for alike nodes of a robot, clocks other than planned, by their subscriptions."""
    timed = nodes_of(seen.ends_at(TOPIC, CLOCK).subscribers)
    told = {it.node for it in seen.system.parameters if it.name == SIM_TIME}
    here = [(it, wanted) for it, wanted in planned_clocks(seen).items() if it in seen.nodes]
    differing = lists_by_key(
        ((seen.robot(node), wanted), node)
        for node, wanted in here
        if node not in told and wanted != parameter_text(node in timed)
    )
    for (robot, wanted), nodes in differing.items():
        verb = "do not subscribe" if wanted == parameter_text(True) else "subscribe"
        which = f"these nodes {verb} to {CLOCK}: {shorten(nodes)}"
        yield clocks_mixed.finding(
            f"{SIM_TIME} is planned to be {wanted}, but {which}",
            f"start them with {SIM_TIME}: {wanted}",
            robot=robot, node=nodes[0], names=tuple(nodes),
            settings=tuple(Setting(it, SIM_TIME, wanted) for it in nodes),
        )  # fmt: skip


def compares_times(name: str) -> bool:
    """Return whether a node of this name compares the time of messages with its own."""
    return bool(_IS_TIMED.fullmatch(name))


# A costmap waits a part of a second for a transform, tf2 keeps ten seconds (buffer_core.h).
_OLD, _AHEAD = 3.0, 1.0
_FAR_AHEAD = 5.0
# Simulated time begins at 0: no clock of a machine is so far off.
_YEAR = 3.0e7
_MEASURED = ("sensor_msgs/", "nav_msgs/msg/Odometry")


@system_rule("MG417", "stamp-of-another-time", ERROR)
def stamp_of_another_time(seen: Index) -> Iterator[Finding]:
    """Report senders with stamps of another time, all their topics as one; a bag's may be old."""
    clock = CLOCK in seen.published
    simulated = clock and any(_YEAR < abs(it.age) < inf for it in seen.system.heard)
    found: dict[tuple[tuple[str, ...], str], list[str]] = defaultdict(list)
    for topic, _, age, *_ in seen.system.heard:
        type_, senders = sent_on(seen, topic)
        played = any(last_word(it).startswith(words.PLAYER) for it in senders)
        measured = type_.startswith(_MEASURED)
        # The age of what is latched is not measured.
        offered = {it.qos.durability for it in seen.ends_at(TOPIC, topic).publishers if it.qos}
        now = simulated and not age and words.is_of_one_sensor(type_) and offered == {"VOLATILE"}
        what = _MACHINES if now else _time_fault(age, clock)
        if senders and measured and not played and what:
            found[senders, what].append(topic)
    yield from _old_transforms(seen, clock)
    for (senders, what), topics in found.items():
        yield stamp_of_another_time.finding(
            f"the stamps on {shorten(topics)} are {what}",
            **_other_clock(senders, what)._asdict(), level=WARNING if what == _ZERO else ERROR,
            robot=only(robots_of(seen, senders)), node=senders[0], names=tuple(topics),
        )  # fmt: skip


def _old_transforms(seen: Index, clock: bool) -> Iterator[Finding]:
    """Report old transforms; localizers stamp theirs ahead (amcl transform_tolerance)."""
    found: dict[tuple[str, str], list[Edge]] = defaultdict(list)
    for tree in seen.trees:
        for it in tree.edges:
            played = any(last_word(one).startswith(words.PLAYER) for one in it.publishers)
            # Many write 0 and are only asked for the latest.
            if it.static or it.several or played or isinf(it.age) or -_FAR_AHEAD < it.age < 0:
                continue
            if what := _time_fault(it.age, clock):
                found[tree.topic, what].append(it)
    for (topic, what), edges in found.items():
        listed = shorten([f"{it.parent} -> {it.child}" for it in edges])
        robot = seen.frame_robot(edges[0].child) or seen.robot(topic)
        senders = unique(it for edge in edges for it in edge.publishers)
        own = [it for it in senders if robot in ("", seen.robot(it))] or [*senders]
        # A publisher of descriptions stamps as its joints are.
        likely = [it for it in own if not seen.publishes_description(it)] or own
        yield stamp_of_another_time.finding(
            f"the stamps of {listed} on {topic} are {what}",
            **_other_clock(likely, what)._asdict(), robot=robot, node=only(likely),
            names=unique(it.child for it in edges),
        )  # fmt: skip


_ZERO = "0: its sender leaves them out"
_MACHINES = "of the machine's time, not of /clock"
_SIMULATED = "of another clock: simulated time, which nothing here has?"


def _other_clock(senders: Sequence[str], what: str) -> Cause:
    """Return which time the senders should have, or where to look."""
    if what in (_MACHINES, _SIMULATED):
        return to_set(SIM_TIME, parameter_text(what == _MACHINES), *senders)
    return Cause(f"see the clock of {shorten(senders) or 'its sender'}, or that of its machine")


def _time_fault(age: float, clock: bool) -> str:
    """Return what is wrong with a message of this age; with simulated time, the machine's is wrong."""
    if isinf(age):
        return _ZERO
    other = abs(age) > _YEAR
    if clock:
        # 0 is not known.
        return _MACHINES if age and not other else ""
    if other:
        return _SIMULATED
    if age >= _OLD:
        return f"{age:.0f} s old"
    return f"{-age:.0f} s in the future" if age <= -_AHEAD else ""
