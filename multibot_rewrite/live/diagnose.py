# SPDX-License-Identifier: Apache-2.0
"""A graph -> its robots, the layout that it looks like, and what is wrong with it. Pure."""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.grouping import sets_by_key
from multibot_rewrite.base.naming import LAYOUTS, Layout
from multibot_rewrite.base.wording import SEVERAL, plural, shorten, unique
from multibot_rewrite.producers.bags.recording import RECORDER, is_recorded
from multibot_rewrite.rules.check import ABSENCE, in_domain, inconclusive_where_in_doubt, judge
from multibot_rewrite.rules.folded import in_order
from multibot_rewrite.rules.system.commands import command_for_several_robots
from multibot_rewrite.rules.system.differing import BETWEEN_ROBOTS
from multibot_rewrite.rules.system.likes import driver_missing, less_than_another_robot
from multibot_rewrite.system.coverage import Coverage, coverage
from multibot_rewrite.system.domains import named, side_by_side, space_of, unnamed
from multibot_rewrite.system.guess import GuessedRobot, guess_robots, whose_by_guess
from multibot_rewrite.system.index import (
    NO_COUNTS,
    TF,
    Index,
    Known,
    at_work,
    ends_of,
    index,
    nodes_of,
)
from multibot_rewrite.system.ownership import whose_by_plan
from multibot_rewrite.system.records import PUBLISHES, SERVES, TOPIC, Robot, System, surely
from multibot_rewrite.system.tf_copies import tree_topic

# So many tf topics are named.
MOST_TOPICS = 3
# Rules that hold robots against each other, which they are in whatever domain.
HELD_AGAINST = frozenset((*BETWEEN_ROBOTS, less_than_another_robot.code))


class Diagnosis(NamedTuple):
    """What is seen of a system that nobody planned.

    ``layout`` is the one that the robots' names look like; None where there is only one robot, or
    where tf is shared and frames have no robot's name, so that robots collide. ``tf`` has the nodes
    that send on each tf topic.
    """

    graph: System
    robots: tuple[GuessedRobot, ...]
    whose: Index
    layout: Layout | None
    tf: tuple[tuple[str, tuple[str, ...]], ...]
    findings: tuple[Finding, ...]

    @property
    def coverage(self) -> Coverage:
        """How much of the robots is in the graph, or in the launch file."""
        nodes = (it._replace(robot=self.whose.robot(it.name)) for it in self.graph.nodes)
        robots = (Robot(it.name) for it in self.robots if not it.only_frames)
        return coverage(self.graph._replace(nodes=tuple(nodes), robots=tuple(robots)))


def diagnose(
    graph: System, messages: Mapping[str, int] = NO_COUNTS, names: System | None = None
) -> Diagnosis:
    """Return what a graph is by itself, and the findings about it.

    ``messages`` counts those of each topic, if they were counted; the plan ``names`` says whose
    names are."""
    robots = guess_robots(surely(graph))
    if names:
        robots = tuple(GuessedRobot(it.name, f"/{it.space}") for it in names.robots)
    known = Known(messages=messages, seconds=graph.environment.seconds)
    seen = index(graph, whose_by_plan(names) if names else whose_by_guess(robots), known)
    found = inconclusive_where_in_doubt(judge(seen), graph)
    # The nodes that publish on each tf topic or its tf_static.
    sent = (it for it in surely(graph).ends if (it.kind, it.role) == (TOPIC, PUBLISHES))
    nodes = sets_by_key((tree_topic(it.name), it.node) for it in sent if it.type == TF)
    tf = tuple((topic, tuple(sorted(nodes[topic]))) for topic in sorted(nodes))
    own_frames = any(robot.before or robot.behind for robot in robots)
    namespaces = any(robot.namespace for robot in robots)
    wanted = (own_frames, any(seen.robot(topic) for topic, _ in tf), namespaces)
    fitting = (it for it in LAYOUTS if wanted == (it.frames, it.tf_per_robot, it.namespaced))
    layout = next(fitting, None) if robots else None
    if names:
        layout = next(it for it in LAYOUTS if it.name == names.layout)
    return Diagnosis(graph, robots, seen, layout, tf, tuple(found))


def diagnose_domains(each: Mapping[int, Diagnosis]) -> Diagnosis:
    """Return what is wrong in several ROS domains: in each by itself, and between their robots."""
    views = {at: it.graph if it.robots else named(it.graph, at) for at, it in each.items()}
    together = diagnose(side_by_side(views))
    spaces = {at: "" if it.robots else space_of(at) for at, it in each.items()}
    alone = [
        (at, it, {spaces[at] + name for name in it.names})
        for at, one in each.items()
        for it in one.findings
    ]
    lost = driver_missing.code
    told = {name for _, it, names in alone if it.code != lost for name in names}
    held = [it for it in together.findings if it.code in HELD_AGAINST and told.isdisjoint(it.names)]
    missed = {name for it in held if it.code == lost for name in it.names}
    every = [
        *(
            _sent_elsewhere(in_domain(it, at), together, each, at)
            for at, it, names in alone
            if it.code != lost or missed.isdisjoint(names)
        ),
        *(_sent_elsewhere(unnamed(it), together, each) for it in held),
    ]
    carried = [*_carried_across(each)]
    said = {(it.node, it.names) for it in carried}
    every = [*(it for it in every if (it.node, it.names) not in said), *carried]
    return together._replace(findings=tuple(in_order(together.whose, every)))


def _carried_across(each: Mapping[int, Diagnosis]) -> Iterator[Finding]:
    """Yield commands of a robot that a node in two domains carries to another robot's driver."""
    pairs = ((at, other) for at in each for other in each if at != other)
    for at, other in pairs:
        for name, ends in each[at].whose.orders.items():
            there = each[other].whose.orders.get(name)
            readers = nodes_of(at_work(ends.subscribers))
            senders = set(nodes_of(at_work(ends.publishers))).difference(readers)
            obeyed = nodes_of(at_work(there.subscribers)) if there else ()
            carriers = set(readers).intersection(nodes_of(there.publishers) if there else ())
            drivers = [it for it in readers if it not in carriers]
            for node in sorted(carriers) if drivers and senders and obeyed else ():
                yield command_for_several_robots.finding(
                    f"{node} bridges {name} of {min(senders)} from domain {at} to domain {other}:"
                    f" {drivers[0]} obeys it here, {obeyed[0]} there",
                    f"leave {name} out of the topics of {node}, or give it another name there",
                    node=node, names=(name,),
                )  # fmt: skip


def _sent_elsewhere(
    it: Finding, together: Diagnosis, each: Mapping[int, Diagnosis], at: int | None = None
) -> Finding:
    """Return the finding, with the cause if another domain has what the robot lacks."""
    missed = [name for name in it.names if it.code in ABSENCE and together.whose.robot(name)]
    for other, seen in each.items():
        ends = (end for name in missed if other != at for end in ends_of(seen.whose, name))
        sender = next((end.node for end in ends if end.role in (PUBLISHES, SERVES)), "")
        if sender:
            hint = f"{sender} of domain {other} has it: start both in one domain, or bridge it"
            return it._replace(hint=hint)
    return it


def survey(seen: Diagnosis) -> str:
    """Return robots, layout and senders on tf topics in one line; empty if nothing is there."""
    names = [robot.name for robot in seen.robots]
    if not (names or seen.graph.nodes or is_recorded(seen.graph)):
        return ""
    if not names:
        nodes = "a recording" if is_recorded(seen.graph) else plural(len(seen.graph.nodes), "node")
        said = f"{nodes}, no robot recognized by name: one, several that share all names, or none known"
    else:
        where = "what their frames have" if any(it.before for it in seen.robots) else ""
        where = "their namespaces" if any(it.namespace for it in seen.robots) else where
        where = "the plan in its folder" if seen.whose.of_names.robots else where
        robots = f"{plural(len(names), 'robot')} by {where or 'the ends of names'}"
        said = f"{robots}: {shorten(names, SEVERAL)}; layout: {_layout_in_words(seen)}"
    return "; ".join((said, *_tf_topics(seen)))


def _tf_topics(seen: Diagnosis) -> Iterator[str]:
    """Yield the tf topics, with the senders on each that is not of a single robot."""
    own, shared = [], []
    for topic, nodes in seen.tf:
        robots = unique(seen.whose.robot(node) or "no robot" for node in nodes)
        alone = nodes == (RECORDER,) or robots == (seen.whose.robot(topic),)
        if alone or _is_named_otherwise(seen):
            own.append(topic)
        else:
            count = plural(len(nodes), "node")
            shared.append(f"tf on {topic}: {count} of {shorten(robots, SEVERAL)}")
    if own:
        yield f"tf on {shorten(own, MOST_TOPICS)}"
    yield from shared[:MOST_TOPICS]
    if len(shared) > MOST_TOPICS:
        yield f"{len(shared) - MOST_TOPICS} more tf topics that are not of one robot each"


def _layout_in_words(seen: Diagnosis) -> str:
    if seen.layout and seen.whose.of_names.robots:
        return seen.layout.name
    if seen.layout:
        return f"looks like {seen.layout.name} ({seen.layout.short}: {seen.layout.about})"
    if _is_named_otherwise(seen):
        return "not known without its plan (check PLAN, check-launch --plan PLAN)"
    if any(robot.before or robot.behind for robot in seen.robots):
        return "frames have the robot's name, topics and nodes have not"
    return "none of those known: neither tf topics nor frames have the robot's name"


def _is_named_otherwise(seen: Diagnosis) -> bool:
    """Return whether each robot shows in frames alone, though names of nodes have its name."""
    whose = whose_by_guess(it._replace(only_frames=False) for it in seen.robots)
    named = {whose.robot(node.name) for node in seen.graph.nodes}
    return bool(seen.robots) and all(it.only_frames and it.name in named for it in seen.robots)
