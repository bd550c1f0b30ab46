# SPDX-License-Identifier: Apache-2.0
"""The system of a fleet as it is written: by its table, the transforms of its nodes, its bridges."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice

from multibot_rewrite.base.conventions import OF_EVERY_NODE, is_tool_word
from multibot_rewrite.description.rewriters.own_defaults import frame_sites
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.fleet import Fleet
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_file import OutputFile, line_in_source
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.robot_groups import group_robots
from multibot_rewrite.producers.ends import (
    BRIDGE_FILE,
    BRIDGE_NODE,
    NEEDS,
    bridge_ends,
    bridge_rows,
    either_way,
    plugin_ends,
)
from multibot_rewrite.producers.sensor_frames import sensor_frames, sensor_on
from multibot_rewrite.producers.transforms import edge
from multibot_rewrite.spelling.of_runs import ends_of
from multibot_rewrite.spelling.plan import tf_topic
from multibot_rewrite.spelling.records import Run
from multibot_rewrite.spelling.transforms import STATE_PUBLISHER, tree_joints
from multibot_rewrite.spelling.ways import merged
from multibot_rewrite.system.records import (
    MAY,
    NOWHERE,
    PUBLISHES,
    RUNS,
    UNKNOWN_NODES,
    Caveat,
    Edge,
    End,
    Environment,
    Heard,
    Node,
    Place,
    Robot,
    System,
    edge_of,
)

# Of robots that differ in their names alone two show where they meet.
SHOWN = 2
_MAY_RUN = "a driver that no file names may run"
DRIVERS = Environment(caveats=(Caveat(UNKNOWN_NODES, True, _MAY_RUN),))


def of_each_kind(plan: FleetPlan) -> list[RewrittenRobot]:
    """Some robots of each kind: the others are the same but for their names."""
    return [it for group in group_robots(plan) for it in islice(group.robots, SHOWN)]


def with_robots(fleet: Fleet, robots: Iterable[RewrittenRobot]) -> Fleet:
    """What a fleet has of some robots and for all."""
    kept = {"", *(it.spec.namespace for it in robots)}
    table = fleet.table._replace(runs=tuple(it for it in fleet.table.runs if it.robot in kept))
    return fleet._replace(
        table=table,
        inventories={name: it for name, it in fleet.inventories.items() if name in kept},
        described={name: it for name, it in fleet.described.items() if name in kept},
        edges={key: it for key, it in fleet.edges.items() if key[0] in kept},
    )


def written_system(
    plan: FleetPlan, fleet: Fleet, shown: Sequence[RewrittenRobot], texts: Sequence[OutputFile]
) -> System:
    """What runs on these robots by the files that were made, with the places in the sources."""
    robots = {"", *(it.spec.namespace for it in shown)}
    runs = [it for it in fleet.table.runs if it.robot in robots]
    nodes = {it.full_name: _node(it) for it in merged(runs)}
    # Rules of a plugin are for its whole process: topics of controllers that the table does not have.
    by_process = (end for it in shown for end in plugin_ends(it.member.reading) if end.sure == MAY)
    edges = (edge for it in shown for edge in _edges(fleet, it))
    return System(
        nodes=(*nodes.values(), *_bridges(shown, texts)),
        ends=(*_ends(runs, nodes), *_bridged(shown, texts), *by_process),
        edges=tuple(edges),
        robots=tuple(Robot(it.spec.namespace) for it in shown),
        environment=DRIVERS,
        heard=tuple(heard for it in shown for heard in _heard(fleet, it, texts)),
    )


def _node(run: Run) -> Node:
    # A person starts a tool, or nobody does.
    sure = MAY if run.fact.when or is_tool_word(run.code_name) else RUNS
    return Node(run.full_name, robot=run.robot, known=run.node, sure=sure, place=run.place)


def _ends(runs: Iterable[Run], nodes: Mapping[str, Node]) -> Iterator[End]:
    for node, end in ((nodes[run.full_name], end) for run in runs for end in ends_of(run)):
        if end.name in OF_EVERY_NODE:
            continue
        # A node with parameters is meant to run: what it needs has to be there.
        needs = end.role in NEEDS and node.place != NOWHERE
        sure = end.sure if end.sure != RUNS else RUNS if needs else node.sure
        place = end.place if end.place != NOWHERE else node.place
        yield from either_way(end._replace(node=node.name, sure=sure, place=place))


def _bridges(robots: Iterable[RewrittenRobot], texts: Iterable[OutputFile]) -> Iterator[Node]:
    paths = {it.path for it in texts}
    for it in robots:
        if f"{it.spec.name}/{BRIDGE_FILE}" in paths:
            name = it.spec.namespace
            yield Node(f"/{name}/{BRIDGE_NODE}", robot=name, known=BRIDGE_NODE)


def _bridged(robots: Iterable[RewrittenRobot], texts: Iterable[OutputFile]) -> Iterator[End]:
    """What the bridges carry; a row for both ways may be for one of them."""
    spaces = {f"{it.spec.name}/{BRIDGE_FILE}": f"/{it.spec.namespace}" for it in robots}
    spaces[BRIDGE_FILE] = ""
    for text in (it for it in texts if it.path in spaces):
        node = f"{spaces[text.path]}/{BRIDGE_NODE}"
        for it in bridge_ends(text.yaml):
            place = Place(*line_in_source(text, it.place.line)) if text.sources else NOWHERE
            yield from either_way(it._replace(node=node, place=place))


def _heard(fleet: Fleet, robot: RewrittenRobot, texts: Iterable[OutputFile]) -> Iterator[Heard]:
    """The frames of what a robot's bridge has from sensors whose description names none; those that it
    names are compared with its links."""
    if robot.spec.simulator == REAL:
        return
    roots = (fleet.inventories[robot.spec.namespace].document.root, robot.member.source.root)
    sensors, sources = ([*sensor_frames(it, robot.spec.model)] for it in roots)
    for text in (it for it in texts if it.path == f"{robot.spec.name}/{BRIDGE_FILE}"):
        for end, inside, frame in bridge_rows(text.yaml):
            it = sensor_on(inside, sensors)
            if end.role == PUBLISHES and it and not frame and not it.is_named:
                old = sources[sensors.index(it)]
                place = Place(robot.member.source.file, old.line)
                yield Heard(end.name, it.frame, link=old.link, place=place)


def of_robot(whole: System, robot: str) -> System:
    """What one robot has of a fleet's system; what nodes for all robots need is left out."""
    nodes = {it.name: it.robot for it in whole.nodes if it.robot in ("", robot)}
    other = {it.name for it in whole.nodes} - nodes.keys()
    ends = (
        it
        for it in whole.ends
        if it.node not in other and (nodes.get(it.node) == robot or it.role not in NEEDS)
    )
    kept = tuple(it for it in whole.nodes if it.name in nodes)
    own = (it for it in whole.edges for node in it.publishers if _is_of(node, robot, nodes))
    return whole._replace(nodes=kept, ends=tuple(ends), edges=tuple(own))


def _is_of(node: str, robot: str, nodes: Mapping[str, str]) -> bool:
    return nodes.get(node, "") == robot or node.startswith(f"/{robot}/")


def _edges(fleet: Fleet, robot: RewrittenRobot) -> Iterator[Edge]:
    name = robot.spec.namespace
    topic = tf_topic(name, fleet.naming)
    runs = {it.node: it for it in fleet.table.runs if it.robot == name}
    described = runs.get(STATE_PUBLISHER)
    root = described.full_name if described else f"/{name}/{STATE_PUBLISHER}"
    tree = robot.tree
    joints = (joint for joint, _ in tree_joints(robot.member.sent.root))
    for it, joint in zip(tree, joints, strict=True):
        place = Place(robot.spec.description, joint.sourceline or 1)  # type: ignore[arg-type]
        yield edge(it, root, place, topic)
    for it in () if name in fleet.placed else _simulated(robot):
        yield edge(it, f"/{name}/{BRIDGE_NODE}", topic=topic)
    in_tree = {*tree}
    for (owner, node), sent in fleet.edges.items():
        if owner == name:
            run = runs.get(node)
            sender, place = (run.full_name, run.place) if run else (f"/{name}/{node}", NOWHERE)
            yield from (edge(it, sender, place, topic) for it in sent if it not in in_tree)


def _simulated(robot: RewrittenRobot) -> Iterator[Edge]:
    """The transforms of gz-sim's drive and odometry systems, which the bridge brings to tf."""
    for host, section in robot.member.inventory.served:
        sites = frame_sites(host, section, robot.names.naming)
        given = [text_at(host, it.path) for it in sites]
        if len(given) == 2 and all(given):
            yield edge_of(given[0], given[1])
