# SPDX-License-Identifier: Apache-2.0
"""What each finding is about, and the states of endpoints, nodes and frames that follow from it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.rules.check import RULES
from multibot_rewrite.system.index import Index, ends_of
from multibot_rewrite.system.records import alternatives
from multibot_rewrite.system.tf_copies import tree_topic

OK, LEAK, CROSS_TALK, MISSING = "ok", "leak", "cross-talk", "missing"
UNEXPECTED, CLASH = "unexpected", "clash"
# The worst first.
STATES = (LEAK, CROSS_TALK, CLASH, MISSING, UNEXPECTED, OK)
FAULTY = frozenset({LEAK, CROSS_TALK, CLASH, MISSING})
STATE_OF_CODE = {it.code: str(it.options["drawn"]) for it in RULES.values() if it.options["drawn"]}
# For all other codes.
STATE_OF_LEVEL = {ERROR: CLASH, WARNING: UNEXPECTED}
TF_CODES = ("MG2", "MG4")
# A frame where it is drawn: the tf topic of its tree, and its name.
FrameKey = tuple[str, str]


class Targets(NamedTuple):
    """What a finding is about."""

    nodes: tuple[str, ...]
    names: tuple[str, ...]
    frames: tuple[FrameKey, ...]


def merged(targets: Iterable[Targets]) -> Targets:
    """Return the nodes, names and frames of several findings, each once."""
    nodes, names, frames = zip(*targets, strict=True)
    return Targets(*(tuple(dict.fromkeys(chain(*part))) for part in (nodes, names, frames)))


class States(NamedTuple):
    """States by (node, name) and by node, and the codes of the findings about a frame.

    ``names`` are all that findings are about.
    """

    endpoints: Mapping[tuple[str, str], str]
    nodes: Mapping[str, str]
    frames: Mapping[FrameKey, tuple[str, ...]]
    names: frozenset[str]


def worst(states: Iterable[str]) -> str:
    """Return the worst of some states; ``ok`` if there are none."""
    return min(states, key=STATES.index, default=OK)


def find_targets(plan: Index, seen: Index, findings: Iterable[Finding]) -> tuple[Targets, ...]:
    """Return the nodes, names and frames of each finding, by its fields and its message."""
    homes = (tree_topic(robot.tf_topic) for robot in plan.system.robots)
    topics = [*dict.fromkeys((*(tree.topic for tree in seen.trees if tree.edges), *homes))]
    found = []
    for finding in findings:
        of_topics = finding.names and all(any(ends_of(seen, name)) for name in finding.names)
        if of_topics or not finding.code.startswith(TF_CODES):
            found.append(_endpoint_targets(plan, seen, finding))
            continue
        # The frames on the topics that the message names; else on the robot's own, or on any topic.
        words = {tree_topic(word) for word in words_of(finding.message)}
        robot = plan.declared.get(finding.robot)
        own = [topic for topic in topics if robot and topic == tree_topic(robot.tf_topic)]
        of_frames = [topic for topic in topics if topic in words] or own or topics
        frames = tuple((topic, frame) for topic in of_frames for frame in finding.names)
        found.append(Targets((finding.node,) if finding.node else (), (), frames))
    return tuple(found)


def make_states(findings: Iterable[Finding], targets: Sequence[Targets]) -> States:
    """Return the states of everything in findings; the worst if there are several."""
    endpoints: dict[tuple[str, str], str] = {}
    nodes: dict[str, str] = {}
    frames: dict[FrameKey, tuple[str, ...]] = {}
    for finding, about in zip(findings, targets, strict=True):
        state = STATE_OF_CODE.get(finding.code) or STATE_OF_LEVEL.get(finding.level, OK)
        for node in about.nodes:
            for name in about.names:
                endpoints[node, name] = worst((state, endpoints.get((node, name), OK)))
            if not about.names:
                nodes[node] = worst((state, nodes.get(node, OK)))
        for frame in about.frames:
            frames[frame] = tuple(dict.fromkeys((*frames.get(frame, ()), finding.code)))
    return States(endpoints, nodes, frames, frozenset(chain(*(it.names for it in targets))))


def _endpoint_targets(plan: Index, seen: Index, finding: Finding) -> Targets:
    # Nothing else is called like a node of which the finding speaks.
    one_of = {node for group in alternatives(plan.system) for node in group}
    nodes = tuple(
        it
        for it in finding.names
        if it in one_of or (it in seen.nodes and not any(ends_of(seen, it)))
    )
    names = tuple(it for it in finding.names if it not in nodes)
    if nodes:
        return Targets(nodes, names, ())
    users = dict.fromkeys(end.node for name in names for end in ends_of(seen, name))
    if not finding.node:
        robot = plan.declared.get(finding.robot)
        return Targets(tuple(plan.own[robot.name] if robot else sorted(users)), names, ())
    words = words_of(finding.message)
    rule = RULES.get(finding.code)
    others = [node for node in users if node in words or (rule and rule.options["all_ends"])]
    return Targets(tuple(dict.fromkeys((finding.node, *sorted(others)))), names, ())


def robots_of(plan: Index, finding: Finding) -> set[str]:
    """Return the robots of a finding, and those of a node, name or frame in it."""
    in_tf = finding.code.startswith(TF_CODES)
    of_name = plan.of_frames.robot if in_tf else plan.of_names.robot
    words = words_of(finding.message)
    found = {finding.robot, *finding.robots, *map(of_name, finding.names)}
    found |= {plan.robot(it) for it in (finding.node, *words) if it.startswith("/")}
    found |= {it for it in words if it in plan.declared} - plan.of_names.ambiguous_words
    return found & plan.declared.keys()


def words_of(message: str) -> set[str]:
    """Return the words of a message, without punctuation."""
    return {word.strip(",:;?()'") for word in message.split()}
