# SPDX-License-Identifier: Apache-2.0
"""Where the robots of a fleet collide, by the names that they declare, and names that nothing uses."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Protocol

from multibot_rewrite.base.conventions import SHARED_TOPICS, WORLD_FRAMES
from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, declare
from multibot_rewrite.base.grouping import sets_by_key
from multibot_rewrite.base.naming import FRAME_KINDS, TF_TOPICS, TOPIC_KINDS, Naming
from multibot_rewrite.base.nearest import MISTYPED, nearest
from multibot_rewrite.description.readback.meeting import (
    FRAMES as FRAMES_COLLIDE,
    LOOKUP,
    NOT_TAKEN,
    OF_COMPUTER,
    OPENED,
    Meeting,
    advice,
    code_of,
    meetings,
    said,
)
from multibot_rewrite.description.readback.nodes import RuntimeName
from multibot_rewrite.description.readback.reading import NODE
from multibot_rewrite.description.readback.xml import elements_at
from multibot_rewrite.description.rewriters.plugin_definitions.grammar import split_path
from multibot_rewrite.description.sources.own_names import name_robot
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.fleet.robots.member import Member, line_of
from multibot_rewrite.fleet.robots.own_values import Written, own_value, sources_of
from multibot_rewrite.fleet.robots.rewritten_robots import SET_PREFIX, RewrittenRobot, at_robot
from multibot_rewrite.knowledge.records import MANAGER
from multibot_rewrite.planning.records import Table
from multibot_rewrite.planning.transforms import Edges
from multibot_rewrite.rules.description.multirobot.named_robots import robots_share_a_name
from multibot_rewrite.rules.system.transforms import robots_name_twice
from multibot_rewrite.system.records import KINDS

NOTHING: Mapping[str, Written] = MappingProxyType({})
ONE_DOMAIN: Mapping[str, int] = MappingProxyType({})
# What nodes of two domains may both have.
_OF_ROS = frozenset((NODE, *KINDS))


def robots_meet(
    table: Table,
    members: Sequence[Member],
    naming: Naming,
    written: Mapping[str, Written] = NOTHING,
    domains: Mapping[str, int] = ONE_DOMAIN,
) -> Iterator[Finding]:
    """Yield an error for each name that two robots have and that is not shared.

    ``written`` are the robots' files, by namespace, ``domains`` theirs by name, if not in one."""
    shared = [it for member in members for it in member.shared]
    spawned = {it.robot for it in table.runs if it.fact.is_controller}
    if not spawned.issuperset(it.robot for it in members):
        # The rewrite says what to do about these.
        yield from (it for it in shared if it.code == NOT_TAKEN)
    if len(members) == 1:
        # There is no second robot: what a rewrite says of any two of them. An address is right for one.
        for one in (one for one in shared if one.code != NOT_TAKEN):
            yield one._replace(level=WARNING if one.code == OPENED else _level(one.code))
        return
    by_robot = {it.robot: it for it in members}
    names = {it.robot: it.name for it in members}
    for it in meetings(_run_names(table, members), naming):
        robot, other = (names.get(one, one) for one in (it.robot, it.other))
        if it.name.kind in _OF_ROS and domains.get(robot) != domains.get(other):
            continue
        called = it._replace(robot=robot, other=other)
        yield _finding(called, by_robot.get(it.robot), written.get(it.robot))


def _run_names(table: Table, members: Sequence[Member]) -> Mapping[str, Sequence[RuntimeName]]:
    """Return what each robot has at run time, first by its description."""
    made = (it for it in table.runs if it.fact.of_hardware)
    ruled = sets_by_key((run.robot, end.name) for run in made for end, _ in run.names)
    found: dict[str, list[RuntimeName]] = {}
    for member in members:
        # The table has rules for the names of the nodes that its hardware makes.
        # What is of their computers is a note of its own (of_robots).
        own = (
            it for it in member.reading.names if not (it.of_controllers or it.kind in OF_COMPUTER)
        )
        found[member.robot] = [
            *(it for it in own if it.tag != "ros2_control" or it.name not in ruled[member.robot]),
            *member.published,
        ]
    for it in table.runs:
        if it.robot and not it.written:
            its = RuntimeName(NODE, it.full_name, "", 0, it.node)
            found.setdefault(it.robot, []).append(its)
    for run in (it for it in table.runs if it.robot):
        full_name = run.full_name
        found.setdefault(run.robot, []).extend(
            RuntimeName(end.kind, name, "", 0, full_name, type=end.type)
            for end, name in run.names
            # That no rule reaches one is told of its node.
            if not end.fixed
        )
    return found


def _finding(met: Meeting, member: Member | None, written: Written | None) -> Finding:
    """Return a finding at the element of a description with the name, or else at the node."""
    name, code = met.name, code_of(met.name)
    message = said(f"{met.robot} and {met.other} would both", name, met.twin)
    found = Finding(code, _level(code), message, advice(name, together=True), names=(name.name,))
    if name.tag and member:
        if code == OPENED and written is not None:
            # How each robot gets its own of what only one can open.
            there = elements_at(name.element_in(member.source.root), split_path(name.path)[0])
            hint = own_value(sources_of(written, member, there))
            found = found._replace(hint=hint or found.hint)
        source = member.sent if name in member.published else member.source
        line = line_of(source, name.tag, name.number)
        return found._replace(file=source.file, line=line, column=1)
    return found._replace(robot=met.robot, node=name.path)


def _level(code: str) -> str:
    """Return WARNING if it depends on the order of spawning whether robots share it, else ERROR."""
    return WARNING if code in (LOOKUP, NOT_TAKEN) else ERROR


TOPICS, FRAMES = "shared_topics", "shared_frames"
NOWHERE: Mapping[str, tuple[str, int]] = {}
_UNKNOWN = "correct it, unless a node that is not known has it"
# What may be between a name and the robot's.
_BETWEEN = "/_-."
NOBODYS = declare("MF838", "shared-by-nothing", WARNING, formats=("fleet",))


class NamesOfFleet(Protocol):
    """What is asked of a fleet: its names, and the ``tags`` of robots in frames where these differ."""

    @property
    def naming(self) -> Naming:
        """Return how the robots' names are made."""

    @property
    def inventories(self) -> Mapping[str, Inventory]:
        """Return each robot's names, by the robot."""

    @property
    def table(self) -> Table:
        """Return the remap table of all robots."""

    @property
    def edges(self) -> Edges:
        """Return the planned transforms."""

    @property
    def tags(self) -> Mapping[str, str]:
        """Return the prefix or postfix of robots in frames, where it is not the robot's name."""


def shared_by_nothing(
    fleet: NamesOfFleet,
    texts: Iterable[bytes] = (),
    places: Mapping[str, tuple[str, int]] = NOWHERE,
) -> Iterator[Finding]:
    """Yield a finding for each shared name that no description and no node of the robots has.

    A name that is in one of ``texts``, those of further files of the robots, is not missed. ``places``
    are the file and line of the keys of a fleet file.
    """
    usual_topics = {*(it.strip("/") for it in SHARED_TOPICS), *TF_TOPICS}
    asked_topics = sorted(fleet.naming.shared_topics - usual_topics)
    asked_frames = sorted(fleet.naming.shared_frames - {*WORLD_FRAMES})
    if not asked_topics and not asked_frames:
        return
    frames, topics = _described_names(fleet, FRAME_KINDS), _described_names(fleet, TOPIC_KINDS)
    frames |= {
        it for sent in fleet.edges.values() for edge in sent for it in (edge.child, edge.parent)
    }
    topics |= {end.name.strip("/") for _, end, _ in fleet.table.ends}
    further = b"\n".join(texts)
    asked = (
        *((it, topics, frames, "/") for it in asked_topics),
        *((it, frames, topics, "") for it in asked_frames),
    )
    for name, own, others, slash in asked:
        if name not in own and name.encode() not in further:
            file, line = places.get(TOPICS if slash else FRAMES, ("", 0))
            what, other, key = ("topic", "frame", FRAMES) if slash else ("frame", "topic", TOPICS)
            message = f"{slash}{name} is to be shared, and no robot has a {what} of that name"
            near = nearest(name, sorted(own), MISTYPED)
            hint = f"did you mean {slash + near!r}?" if near else ""
            if name in others:
                option = f"--shared {'' if slash else '/'}{name}"
                hint = f"it is a {other}: write it below {key}, or {option}"
            level, names = WARNING if hint else NOTE, (f"{slash}{name}",)
            found = NOBODYS.finding(message, hint or _UNKNOWN, level=level, names=names)
            yield found._replace(file=file, line=line, column=min(line, 1))


def _described_names(fleet: NamesOfFleet, kinds: Collection[str]) -> set[str]:
    """Return the names of some kinds in the descriptions, with and without the robot's name."""
    found: set[str] = set()
    for robot, inventory in fleet.inventories.items():
        named = (it for names in inventory.names for it in names)
        texts = {
            it.text.strip("/")
            for it in named
            if it.kind in kinds or any(kind in kinds for kind in it.kinds)
        }
        found |= texts
        for word in {robot, fleet.tags.get(robot, robot)}:
            found |= {text.replace(word, "").strip(_BETWEEN) for text in texts}
    return found


# The kinds of declared names that differ from robot to robot.
_DECLARED = ("link", "joint", "frame", "sensor", "hardware")
_KINDS = ("topic", "service")


def declared_twice(
    robots: Iterable[RewrittenRobot], naming: Naming, told: Iterable[Finding]
) -> Iterator[Finding]:
    """Yield findings for names that two robots declare, except shared names and frames in ``told``."""
    met = {name for it in told if it.code == FRAMES_COLLIDE for name in it.names}
    first: dict[tuple[str, str], RewrittenRobot] = {}
    kinds = [it for it in _DECLARED if it in naming.separators]
    for robot in robots:
        declared = robot.member.inventory.declared
        named = ((kind, name) for kind in kinds for name in declared.get(kind, ()))
        for kind, name in named:
            other = first.setdefault((kind, name), robot)
            is_told = kind in ("link", "frame") and name in met
            if other is robot or is_told or name in naming.shared_frames:
                continue
            message = f"{other.spec.name} and {robot.spec.name} would both have the {kind} {name!r}"
            hint = "give one of them another name, prefix or postfix"
            hint = SET_PREFIX if kind == "sensor" and robot.needs_prefix else hint
            yield at_robot(robots_share_a_name, robot, message, hint)


def named_twice(robots: Sequence[RewrittenRobot]) -> Iterator[Finding]:
    """Report for each description the first name that has the robot's name twice."""
    told = set()
    for it in robots:
        spec = it.spec
        starts = tuple(f"/{spec.namespace}/{spec.name}{end}" for end in "/_")
        is_named = name_robot(spec.arguments, [spec.name])
        read = (one for one in it.member.reading.names if one.kind in _KINDS)
        twice = (one.name for one in read if one.name.startswith(starts))
        name = next(twice, "") if is_named else ""
        if name and spec.description not in told:
            told.add(spec.description)
            given = spec.arguments.items()
            which = [key for key, text in given if name_robot({key: text}, [spec.name])]
            message = f"{name} has the name of robot {spec.name!r} twice"
            hint = f"write {' or '.join(which)}: '' under arguments"
            yield at_robot(robots_name_twice, it, message, hint)


OTHER_MANAGER = declare("MF850", "other-manager", ERROR, formats=("fleet",))


def other_manager(robots: Iterable[RewrittenRobot], table: Table) -> Iterator[Finding]:
    """Yield the robots whose node set has a manager that no plugin makes, though one makes another."""
    robots = [*robots]
    tables = table.by_robot(it.member.robot for it in robots)
    first: dict[str, RewrittenRobot] = {}
    for robot in robots:
        own = tables[robot.member.robot].runs
        made = [it.manager for it in robot.member.reading.nodes if it.manager]
        asked = {it.full_name for it in own if it.node == MANAGER and not it.written}
        if made and asked and asked.isdisjoint(made):
            message = f"the plugin makes {made[0]}, but spawners ask {min(asked)}"
            hint = "remove <namespace> and <controller_manager_name> of the plugin"
            # What is the same for all robots of a description is said in one line.
            at = first.setdefault(robot.spec.description, robot)
            yield at_robot(OTHER_MANAGER, at, message, hint)
