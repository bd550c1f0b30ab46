"""A planned fleet -> every file that belongs to it, in memory: one function a kind of file."""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache
from typing import NamedTuple

from multibot_rewrite.bulk import uncollected
from multibot_rewrite.companions.context import Companion
from multibot_rewrite.companions.graph_names import known_topics
from multibot_rewrite.companions.rviz import RvizRobot, rviz
from multibot_rewrite.companions.template import GRAPH, SPELLED, fill
from multibot_rewrite.companions.yaml_text import YamlText, quoted, read_yaml
from multibot_rewrite.fleet import expected
from multibot_rewrite.fleets import bridge, spawn, teleop, transforms
from multibot_rewrite.fleets.companions import Kin, behavior_trees, kin_of, lua, moveit, params
from multibot_rewrite.fleets.consistency import consistency
from multibot_rewrite.fleets.describe import Described
from multibot_rewrite.fleets.plan import FleetPlan
from multibot_rewrite.fleets.started import alone, started
from multibot_rewrite.fleets.written import Written
from multibot_rewrite.graph.plan_file import to_yaml
from multibot_rewrite.model import Finding, UsageError
from multibot_rewrite.remap import forms
from multibot_rewrite.remap.bridge import bridge as carried
from multibot_rewrite.remap.records import Table
from multibot_rewrite.sources import read_file

PLAN, TABLE, COMMANDS = "plan.yaml", "remappings.yaml", "commands.md"


class Artefact(NamedTuple):
    """A file to be written: its path below the output folder, its text, what it is made from."""

    path: str
    data: bytes
    sources: tuple[str, ...] = ()


Made = Iterator[Artefact | Finding]


class Artefacts(NamedTuple):
    """Everything of a fleet, in the order of paths, and what a person should know about it."""

    files: tuple[Artefact, ...]
    findings: tuple[Finding, ...]


def make_artefacts(plan: FleetPlan) -> Artefacts:
    """Every file of a fleet; raises InputError for a companion that cannot be read or rewritten."""
    with uncollected():
        made = [it for make in _MAKERS for it in make(plan)]
        files = sorted(it for it in made if isinstance(it, Artefact))
        _check_apart(files)
        told = [it for it in made if isinstance(it, Finding)]
        told += [it for robot in plan.robots for it in robot.findings]
        written = [Written(it.path, it.data.decode("utf-8", "replace"), it.sources) for it in files]
        told += consistency(plan, started(plan), written, told)
        return Artefacts(tuple(files), tuple(_once(plan, told)))


def _check_apart(files: Sequence[Artefact]) -> None:
    for one, other in itertools.pairwise(files):
        if one.path == other.path:
            both = " and ".join(", ".join(it.sources) or "the fleet" for it in (one, other))
            raise UsageError(f"{one.path}: two results would go to this one file, of {both}")


def _once(plan: FleetPlan, findings: Iterable[Finding]) -> list[Finding]:
    """Sorted by place; what is the same for several robots of the fleet file is said of the first."""
    robots = {(it.spec.file, it.spec.line): it.spec.name for it in plan.robots}
    alike: dict[tuple[str, ...], list[Finding]] = {}
    for it in sorted(set(findings), key=lambda it: (*it[4:], it.code, it.message)):
        name = robots.get((it.file, it.line))
        place = (it.file,) if name else (it.file, str(it.line), str(it.column))
        message = it.message.replace(name, "\0") if name else it.message
        alike.setdefault((it.code, message, it.hint, *place), []).append(it)
    return [_of_many(first, len(more)) for first, *more in alike.values()]


def _of_many(first: Finding, more: int) -> Finding:
    if not more:
        return first
    return first._replace(message=f"{first.message}; so for {more} robots more")


def _descriptions(plan: FleetPlan) -> Made:
    for robot in plan.robots:
        source = robot.spec.description
        yield Artefact(_own(robot, _plain(source)), robot.description, (source,))
        if robot.srdf:
            yield Artefact(_own(robot, _plain(robot.spec.srdf)), robot.srdf, (robot.spec.srdf,))


def _plain(path: str) -> str:
    """The file's name once xacro is expanded."""
    name = os.path.basename(path).removesuffix(".xacro")
    return name if "." in name else f"{name}.urdf"


def _own(robot: Described, name: str) -> str:
    return f"{robot.spec.name}/{name}"


def _companions(plan: FleetPlan) -> Made:
    kinds: dict[str, Callable[[FleetPlan, Kin, str], Companion]] = {
        "params": params,
        "moveit": moveit,
        "behavior_trees": behavior_trees,
        "lua": lua,
    }
    for kind, make in kinds.items():
        for kin in kin_of(plan):
            for path in kin.robots[0].spec.companions.get(kind, ()):
                made = make(plan, kin, path)
                yield from (_said(it, kin.robots[0]) for it in made.findings)
                for robot in kin.robots:
                    text = fill(made.template, robot.spec.namespace, robot.spec.spelled)
                    yield Artefact(_own(robot, os.path.basename(path)), text.encode(), (path,))


def _said(finding: Finding, robot: Described) -> Finding:
    """A finding about a file for any robot, told with the names of the first."""
    words = {GRAPH: robot.spec.namespace, SPELLED: robot.spec.spelled}
    message, hint = finding.message, finding.hint
    for hole, word in words.items():
        message, hint = message.replace(hole, word), hint.replace(hole, word)
    return finding._replace(message=message, hint=hint)


def _rviz(plan: FleetPlan) -> Made:
    groups: dict[str, list[Described]] = {}
    for robot in plan.robots:
        for path in robot.spec.companions.get("rviz", ()):
            groups.setdefault(path, []).append(robot)
    own = {it.robots[0].spec.name: it for it in alone(plan)} if groups else {}
    for path, robots in groups.items():
        shown = [_shown(own[robot.spec.name]) for robot in robots]
        world = transforms.world_of(plan.file, plan.fleet.naming)
        made, findings = rviz(_yaml(path), shown, world=world)
        yield from findings
        for it in made:
            name = os.path.basename(path)
            where = f"{it.robot}/{name}" if it.robot else name
            yield Artefact(where, it.text.encode(), (path,))


def _shown(plan: FleetPlan) -> RvizRobot:
    """The one robot of a plan as RViz shows it."""
    (robot,) = plan.robots
    spec = robot.spec
    names = robot.names._replace(robot=spec.spelled)
    topics = robot.topics._replace(robot=spec.namespace)
    known = known_topics(plan.fleet.table, plan.fleet.facts, spec.namespace)
    return RvizRobot(spec.name, names, topics, spec.colour, known)


def _bridges(plan: FleetPlan) -> Made:
    """One bridge a robot, and one for what is the same for all."""
    found, left = carried(plan.fleet.inventories, plan.fleet.naming)
    generated = bridge.as_spawned(found, plan.robots)
    shared: list[tuple[str, str]] = []
    for kin in kin_of(plan):
        paths = kin.robots[0].spec.companions.get("bridge", ())
        read = [(path, bridge.bridge(_yaml(path), kin.context)) for path in paths]
        for path, made in read:
            yield from made.own.findings
            shared += [(path, made.shared)] if made.shared else []
        for robot in kin.robots:
            spec = robot.spec
            words = spec.namespace, spec.spelled, spec.model
            texts = [(path, bridge.filled(it.own.template, *words)) for path, it in read]
            own = [it for it in generated if it.robot == spec.namespace]
            text, findings = bridge.merged(texts, own)
            yield from findings
            if text:
                yield Artefact(_own(robot, "bridge.yaml"), text.encode(), tuple(paths))
    if any(it.robot for it in generated) or shared:
        text, findings = bridge.merged(
            dict.fromkeys(shared), [it for it in generated if not it.robot]
        )
        yield from findings
        yield Artefact("bridge.yaml", text.encode(), tuple({path: 0 for path, _ in shared}))
    for it in left:
        hint = "give it a topic, for a bridge to carry"
        message = f"{it.what} of {it.robot} has a gz topic that only the world knows"
        file = next(r.spec.description for r in plan.robots if r.spec.namespace == it.robot)
        yield Finding("MF509", "warning", message, hint, file, it.line, 1)


def _tables(plan: FleetPlan) -> Made:
    fleet = started(plan)
    table = fleet.table
    # The same wherever the command was run.
    folder = os.path.dirname(os.path.abspath(plan.file.file))
    sources = {node: os.path.relpath(place, folder) for node, place in fleet.sources.items()}
    yield Artefact(PLAN, to_yaml(expected(fleet._replace(sources=sources))).encode())
    yield Artefact(TABLE, _remappings(table).encode())
    yield Artefact("remappings.py", forms.launch(table).encode())


def _remappings(table: Table) -> str:
    """The rules of every node, in the shape of ``multibot remap --format yaml``; where names lead
    is in the plan. Written directly: PyYAML takes longer than all the rest."""
    spell = cache(quoted)
    robots: dict[str, list[str]] = {}
    for node in table.nodes:
        rules = ", ".join(f"[{spell(it.source)}, {spell(it.target)}]" for it in node.rules)
        robots.setdefault(node.robot or forms.EVERY_ROBOT, []).append(
            f"    {spell(node.node)}:\n      namespace: {spell(node.namespace)}\n"
            f"      name: {spell(node.name)}\n      remappings: [{rules}]\n"
        )
    rows = [f"  {spell(robot)}:\n{''.join(nodes)}" for robot, nodes in robots.items()]
    head = f"layout: {spell(table.layout)}\nrobots:{'' if rows else ' {}'}\n"
    return head + "".join(rows)


def _commands(plan: FleetPlan) -> Made:
    """The lines that start what no file does, robot by robot."""
    rows = ["# Commands of this fleet\n"]
    for one in alone(plan):
        (robot,) = one.robots
        placed = transforms.place(one)
        spawned, remarks = spawn.spawns(one)
        yield from (*placed.findings, *remarks)
        rows.append(f"\n## {robot.spec.name}\n\n```sh\n")
        rows += [f"{transforms.command(it)}\n" for it in placed.transforms]
        rows += [f"{spawn.gz_command(it)}\n" for it in spawned]
        rows += [f"# Gazebo Classic: {spawn.classic_command(it)}\n" for it in spawned]
        rows += [*(f"{teleop.command(it)}\n" for it in teleop.teleops(one)), "```\n"]
        for pose in placed.initial:
            yield Artefact(_own(robot, "start_pose.yaml"), _start_pose(one, pose))
    yield Artefact(COMMANDS, "".join(rows).encode())


def _start_pose(plan: FleetPlan, pose: transforms.InitialPose) -> bytes:
    import yaml

    tables = plan.fleet.table.nodes
    node = next(it for it in tables if (it.robot, it.node) == (pose.robot, pose.node))
    full = f"{node.namespace.rstrip('/')}/{node.name}"
    data = {full: {"ros__parameters": dict(pose.values)}}
    dumper = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
    return str(yaml.dump(data, None, dumper, sort_keys=False)).encode()


def _yaml(path: str) -> YamlText:
    return read_yaml(read_file(path), path)


_MAKERS: tuple[Callable[[FleetPlan], Made], ...] = (
    _descriptions,
    _companions,
    _rviz,
    _bridges,
    _tables,
    _commands,
)
