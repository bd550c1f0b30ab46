# SPDX-License-Identifier: Apache-2.0
"""The plan of a fleet, by its remap table and its descriptions; and the file that it is."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from multibot_rewrite.base.conventions import BY_HAND, SENT_BY_EVERY_NODE, USUAL_FRAMES
from multibot_rewrite.base.file_kinds import PLAN, ROBOTS, recognised, refuse_others
from multibot_rewrite.base.grouping import sets_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import NAMESPACE, TF_TOPICS, Naming, spelled
from multibot_rewrite.knowledge.records import UNKNOWN, NodeFacts
from multibot_rewrite.knowledge.yaml_with_lines import unknown
from multibot_rewrite.planning.of_runs import each_once, ends_of
from multibot_rewrite.planning.records import Table
from multibot_rewrite.planning.ways import HOST, PLUGIN, PROCESS, deliveries
from multibot_rewrite.system import json
from multibot_rewrite.system.environment import MAX_DOMAIN
from multibot_rewrite.system.records import (
    MAY,
    NO_ORIGIN,
    NOWHERE,
    RUNS,
    End,
    Node,
    Robot,
    Sure,
    System,
)

if TYPE_CHECKING:
    from multibot_rewrite.description.steps.collect import Inventory

NOTHING: Mapping[str, Sequence[str]] = {}
NO_WORDS: Mapping[str, str] = {}


def robot_words(plan: System) -> dict[str, str]:
    """Return the words that stand for robots in texts, each with the name of its robot."""
    return words_of({it.name: (it.tag, it.namespace) for it in plan.robots})


def words_of(others: Mapping[str, Iterable[str]]) -> dict[str, str]:
    """Return the names of robots, and words that stand for one robot alone, with its name."""
    robots = sets_by_key((word, name) for name, words in others.items() for word in words if word)
    only = {word: min(names) for word, names in robots.items() if len(names) == 1}
    return {name: name for name in others} | {k: it for k, it in only.items() if k not in others}


def vacuous(plan: System) -> str:
    """Return why a graph without nodes would be as planned; empty for a plan that expects something."""
    if not plan.robots:
        return "no robot is planned"
    needed = {it.robot for it in plan.nodes if it.sure.word == RUNS.word or it.sure.instead}
    idle = [it.name for it in plan.robots if it.name not in needed]
    verb = "has" if len(idle) == 1 else "have"
    return f"{', '.join(idle)} {verb} no node that must run" if idle else ""


def expect(
    table: Table,
    naming: Naming,
    frames: Mapping[str, Sequence[str]],
    named: Mapping[str, Sequence[str]] = NOTHING,
    words: Mapping[str, str] = NO_WORDS,
    maybe_real: Container[str] = (),
    called: Mapping[str, str] = NO_WORDS,
) -> System:
    """Return the plan that follows from a remap table.

    ``frames`` are the declared frames of each robot, ``named`` further frames in its description.
    ``words`` has the name of a robot in its frames, if it differs; plugins of ``maybe_real`` robots may
    be missing. All of them have the robots by their namespaces; ``called`` has their names.
    """
    # The default frames of parameters; a name in <> stands for another parameter.
    facts = {id(it.fact): it.fact for it in table.runs if not it.written}
    defaults = (frame.default.strip("/") for it in facts.values() for frame in it.frames)
    usual = dict.fromkeys((*(it for it in defaults if it and "<" not in it), *USUAL_FRAMES))

    def robot(name: str) -> Robot:
        word, own = words.get(name, name), tuple(frames.get(name, ()))
        others = (*named.get(name, ()), *(spelled(naming, word, "frame", frame) for frame in usual))
        known = {*own, *naming.shared_frames}
        further = tuple(it for it in dict.fromkeys(others) if it not in known)
        known_as = called.get(name, name)
        own_names = (it if it != known_as else "" for it in (word, name))
        return Robot(known_as, own, tf_topic(name, naming), further, *own_names)

    # By robot: the full names of its nodes, each with whether it runs.
    own: dict[str, dict[str, Sure]] = {}
    for it in table.runs:
        may = it.robot and (it.fact.when or (it.written and it.robot in maybe_real))
        found = own.setdefault(it.robot, {})
        found[it.full_name] = MAY if may or it.node in BY_HAND else found.get(it.full_name, RUNS)
    made, always = _private_nodes(table), _private_nodes(table, always=True)
    names = dict.fromkeys((*frames, *filter(None, own)))
    nodes = []
    for name in (*names, ""):
        sure, robot_name = own.get(name, {}), called.get(name, name)
        nodes += [Node(full, robot=robot_name, sure=it) for full, it in sure.items()]
        optional = tuple(full for full, it in sure.items() if it is MAY)
        # Those that they make for themselves: always, or by a parameter.
        for full in (it for it in made.get(name, ()) if name and it not in sure):
            runs = full in always.get(name, ()) and not full.startswith(optional)
            nodes.append(Node(full, robot=robot_name, sure=RUNS if runs else MAY))
    return System(
        nodes=tuple(_placed(nodes, table)),
        ends=tuple(dict.fromkeys(_planned(table))),
        robots=tuple(map(robot, names)),
        layout=table.layout,
        shared_topics=tuple(sorted(f"/{topic}" for topic in naming.shared_topics)),
        shared_frames=tuple(sorted(naming.shared_frames)),
        # What nodes for all robots make for themselves.
        ignored_nodes=made.get("", ()),
    )


def named_frames(inventory: Inventory) -> tuple[str, ...]:
    """Return the frames that a description names anywhere, such as those of its plugins' messages."""
    values = (
        claim.value.strip()
        for claim in inventory.claims
        if "frame" in claim.site.kinds and claim.site.form == "whole"
    )
    return tuple(dict.fromkeys(filter(None, values)))


def _placed(nodes: Iterable[Node], table: Table) -> Iterator[Node]:
    """Yield each node with its plugin, further names, way and taker (without own --ros-args)."""
    known: dict[str, NodeFacts] = {}
    for run in (it for it in table.runs if it.fact.is_known):
        # Also those that it makes for itself.
        made = (f"{run.full_name}{it.by}" for it, _ in run.names if it.by)
        known |= dict.fromkeys((run.full_name, *made), run.fact)
    ways = {it.node.full_name: it for it in reversed(deliveries(table))}
    full = {(it.robot, it.node): it.full_name for it in table.runs}
    taken = {}
    for run in (it for it in table.runs if not it.fact.plugin):
        way = ways.get(run.full_name)
        if way is not None and way.way != PROCESS:
            taker = full.get((run.robot, way.taker), "")
            taken[run.full_name] = way.way, taker if way.way in (HOST, PLUGIN) else ""
    plugins = {it.full_name: it.place for it in table.runs if it.written}
    origins = {it.full_name: it.fact.origin for it in table.runs if it.fact.origin != NO_ORIGIN}
    for it in nodes:
        way_of_node, taker = taken.get(it.name, ("", ""))
        node_set, place = origins.get(it.name, NO_ORIGIN)
        fact = known.get(it.name, UNKNOWN)
        yield it._replace(
            way=way_of_node,
            taker=taker,
            plugin=plugins.get(it.name, NOWHERE),
            node_set=node_set,
            place=place,
            known=fact.kind,
            untold=tuple(one.text for one in fact.untold),
        )


def _private_nodes(table: Table, always: bool = False) -> dict[str, tuple[str, ...]]:
    """Return by robot patterns of the nodes that its nodes make for themselves, or ``always`` make."""
    found: dict[str, tuple[str, ...]] = {}
    each = ((run, end) for run in table.runs for end, _ in run.names if end.by)
    for run, end in (it for it in each if not (always and it[1].when)):
        full = f"{run.full_name}{end.by}"
        if full not in found.get(run.robot, ()):
            found[run.robot] = (*found.get(run.robot, ()), full)
    return found


def _planned(table: Table) -> Iterator[End]:
    """Yield the ends of nodes; those of a helper without a name have no node."""
    for run in table.runs:
        # What is planned is not said by a place.
        bare = run._replace(values={}, place=NOWHERE)
        pairs = zip(run.names, ends_of(bare), strict=True)
        own = (end for (fact, _), end in pairs if (fact.by or not fact.helper) and end.role)
        yield from each_once(end for end in own if end.name not in SENT_BY_EVERY_NODE)


def tf_topic(robot: str, naming: Naming) -> str:
    """Return the tf topic of a robot in this layout."""
    topic = f"/{TF_TOPICS[0]}"
    if not naming.layout.tf_per_robot:
        return topic
    if naming.topics == NAMESPACE:
        return f"/{robot}{topic}"
    return spelled(naming, robot, "topic", topic)


HEAD = """\
# What the graph of this fleet is to look like: each robot with its nodes, and each node with its ends:
# [role, kind, name, type, name in the code]; one that only may be there has its condition besides.
# `multibot check` compares exactly this: take out what is not started, add what is. A node with
# `sure: may` may be missing. The page "The plan" of the documentation has all keys.
"""
# lifecycle_msgs/msg/State, the primary ones.
LIFECYCLE = ("unconfigured", "inactive", "active", "finalized")
# What follows ``robots:``, empty lines and comments aside.
_ROBOTS = lazy_compile(ROBOTS + rb"([^\s#])", re.MULTILINE)
_INCLUDE = lazy_compile(rb"^include:", re.MULTILINE)


def to_yaml(plan: System) -> str:
    """Return a plan as the text of a YAML file."""
    return HEAD + json.to_yaml(plan)


def read_plan(data: bytes, file: str) -> System:
    """Return the plan that a file holds; raises InputError with file, place and what to write there."""
    refuse_others(data, file, PLAN)
    plan = json.read_system(data, file)
    for wrong in _contradictions(plan):
        raise InputError(f"{file}: {wrong}")
    return plan


def _contradictions(plan: System) -> Iterator[str]:
    """Yield what is wrong in a plan or fits no graph or any graph, and what to do."""
    if not plan.layout:
        yield f"layout: missing; it is needed; {json.REMEDY}"
    if nothing := vacuous(plan):
        yield f"{nothing}, so every graph would be as planned; {json.REMEDY}"
    robots = Counter(it.name for it in plan.robots)
    for name in (it for it in robots if robots[it] > 1):
        yield f"robots: {name} is there twice; join the two"
    for domain in plan.domains:
        if domain.robot and domain.robot not in robots:
            yield f"domains: {unknown('robot', domain.robot, robots)}"
        if not 0 <= domain.number <= MAX_DOMAIN:
            yield f"domains: {domain.number}: write a ROS_DOMAIN_ID, 0 to {MAX_DOMAIN}"
    groups: dict[str, tuple[str, ...]] = {}
    for node in plan.nodes:
        if node.lifecycle and node.lifecycle not in LIFECYCLE:
            yield f"{node.name}: lifecycle: {unknown('state', node.lifecycle, LIFECYCLE)}"
        groups |= dict.fromkeys(node.sure.instead, node.sure.instead)
    for node in plan.nodes:
        group = groups.get(node.name, ())
        if group != node.sure.instead:
            written = f"write instead: [{', '.join(group)}] at each of them"
            yield f"{node.name}: sure: of these nodes one runs, or another group; {written}"


def is_fleet(data: bytes) -> bool:
    """Return whether this is a fleet file. Its robots are a list, or in files that it includes."""
    if recognised(data) == PLAN:
        return False
    found = _ROBOTS.search(data)
    return found[1] in (b"-", b"[") if found else bool(_INCLUDE.search(data))
