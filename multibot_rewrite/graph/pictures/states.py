"""What each finding is about, and the states of endpoints, nodes and frames that follow from it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.graph.rules.comparison import GraphFinding, View
from multibot_rewrite.graph.rules.tf_trees import tree_topic
from multibot_rewrite.model import ERROR, WARNING

OK, LEAK, CROSS_TALK, MISSING = "ok", "leak", "cross-talk", "missing"
UNEXPECTED, CLASH = "unexpected", "clash"
# The worst first.
STATES = (LEAK, CROSS_TALK, CLASH, MISSING, UNEXPECTED, OK)
FAULTY = frozenset({LEAK, CROSS_TALK, CLASH, MISSING})
STATE_OF_CODE = {
    "MG101": MISSING,
    "MG102": MISSING,
    "MG103": LEAK,
    "MG104": CROSS_TALK,
    "MG108": UNEXPECTED,
    "MG109": MISSING,
}
# For all other codes.
STATE_OF_LEVEL = {ERROR: CLASH, WARNING: UNEXPECTED}
# These name one node, but are about all endpoints of a name.
ABOUT_ALL_ENDPOINTS = ("MG106",)
TF_CODES = "MG2"
# A frame where it is drawn: the tf topic of its tree, and its name.
FrameKey = tuple[str, str]


class Targets(NamedTuple):
    """What a finding is about."""

    nodes: tuple[str, ...]
    names: tuple[str, ...]
    frames: tuple[FrameKey, ...]


class States(NamedTuple):
    """States by (node, name) and by node, and the codes of the findings about a frame."""

    endpoints: Mapping[tuple[str, str], str]
    nodes: Mapping[str, str]
    frames: Mapping[FrameKey, tuple[str, ...]]


def worst(states: Iterable[str]) -> str:
    """The worst of some states; ``ok`` if there are none."""
    return min(states, key=STATES.index, default=OK)


def find_targets(view: View, findings: Iterable[GraphFinding]) -> tuple[Targets, ...]:
    """What each finding is about, by its fields and by the names in its message."""
    topics = [tree.topic for tree in view.trees]
    return tuple(
        Targets((), (), tuple(_frame_targets(view, finding, topics)))
        if finding.code.startswith(TF_CODES)
        else _endpoint_targets(view, finding)
        for finding in findings
    )


def make_states(findings: Iterable[GraphFinding], targets: Iterable[Targets]) -> States:
    """The states of everything that findings are about; the worst where there are several."""
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
    return States(endpoints, nodes, frames)


def _endpoint_targets(view: View, finding: GraphFinding) -> Targets:
    if not finding.node:
        robot = view.robots.get(finding.robot)
        return Targets(robot.nodes if robot else (), finding.about, ())
    users = dict.fromkeys(end.node for name in finding.about for end in view.by_name.get(name, ()))
    words = _words(finding.message)
    others = [node for node in users if finding.code in ABOUT_ALL_ENDPOINTS or node in words]
    return Targets(tuple(dict.fromkeys((finding.node, *sorted(others)))), finding.about, ())


def _frame_targets(view: View, finding: GraphFinding, topics: Sequence[str]) -> Iterator[FrameKey]:
    """The frames on the topics that the message names; else on the robot's own, or on any topic."""
    words = {tree_topic(word) for word in _words(finding.message)}
    robot = view.robots.get(finding.robot)
    own = [topic for topic in topics if robot and topic == tree_topic(robot.tf)]
    named = [topic for topic in topics if topic in words]
    return ((topic, frame) for topic in named or own or topics for frame in finding.about)


def _words(message: str) -> set[str]:
    return {word.rstrip(",:;?") for word in message.split()}
