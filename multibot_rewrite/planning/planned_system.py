# SPDX-License-Identifier: Apache-2.0
"""The plan of a fleet: what should run, by its remap table and its descriptions."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from multibot_rewrite.base.conventions import BY_HAND, SENT_BY_EVERY_NODE, USUAL_FRAMES
from multibot_rewrite.base.naming import NAMESPACE, TF_TOPICS, Naming, spelled
from multibot_rewrite.knowledge.records import UNKNOWN, NodeFacts
from multibot_rewrite.planning.of_runs import each_once, ends_of
from multibot_rewrite.planning.records import Table
from multibot_rewrite.planning.ways import deliveries
from multibot_rewrite.system.records import (
    HOST,
    MAY,
    NO_ORIGIN,
    NOWHERE,
    PLUGIN,
    PROCESS,
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

    def planned_robot(name: str) -> Robot:
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
        robots=tuple(map(planned_robot, names)),
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
    """Return by robot the full names, as patterns, of nodes that its nodes make for themselves."""
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
