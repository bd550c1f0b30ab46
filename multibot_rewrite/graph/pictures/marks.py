"""What each finding is about, and the states that follow for edges, nodes and frames."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.graph.rules.comparison import GraphFinding, View
from multibot_rewrite.graph.rules.trees import tree_of
from multibot_rewrite.model import ERROR, WARNING

OK, LEAK, CROSS_TALK, MISSING = "ok", "leak", "cross-talk", "missing"
UNEXPECTED, CLASH = "unexpected", "clash"
# The gravest first.
STATES = (LEAK, CROSS_TALK, CLASH, MISSING, UNEXPECTED, OK)
TROUBLE = frozenset({LEAK, CROSS_TALK, CLASH, MISSING})
STATE_OF = {
    "MG101": MISSING,
    "MG102": MISSING,
    "MG103": LEAK,
    "MG104": CROSS_TALK,
    "MG108": UNEXPECTED,
    "MG109": MISSING,
}
OTHER_CODES = {ERROR: CLASH, WARNING: UNEXPECTED}
# It is told of one node, and is about all ends of a name.
ALL_ENDS = ("MG106",)
ABOUT_TF = "MG2"
# A frame where it is drawn: the tf topic of its tree, and its name.
FrameKey = tuple[str, str]


class Targets(NamedTuple):
    """What a finding is about."""

    nodes: tuple[str, ...]
    names: tuple[str, ...]
    frames: tuple[FrameKey, ...]


class Marks(NamedTuple):
    """States by (node, name) and by node, and the codes of what is wrong with a frame."""

    ends: Mapping[tuple[str, str], str]
    nodes: Mapping[str, str]
    frames: Mapping[FrameKey, tuple[str, ...]]


def gravest(states: Iterable[str]) -> str:
    """The worst of some states; ``ok`` of none."""
    return min(states, key=STATES.index, default=OK)


def find_targets(view: View, findings: Iterable[GraphFinding]) -> tuple[Targets, ...]:
    """What each finding is about; what it does not say in its fields is read from its message."""
    topics = [tree.topic for tree in view.trees]
    return tuple(
        Targets((), (), tuple(_frames(view, finding, topics)))
        if finding.code.startswith(ABOUT_TF)
        else _ends(view, finding)
        for finding in findings
    )


def make_marks(findings: Iterable[GraphFinding], targets: Iterable[Targets]) -> Marks:
    """The states that findings give to what they are about; the gravest where there are several."""
    ends: dict[tuple[str, str], str] = {}
    nodes: dict[str, str] = {}
    frames: dict[FrameKey, tuple[str, ...]] = {}
    for finding, about in zip(findings, targets, strict=True):
        state = STATE_OF.get(finding.code) or OTHER_CODES.get(finding.level, OK)
        for node in about.nodes:
            for name in about.names:
                ends[node, name] = gravest((state, ends.get((node, name), OK)))
            if not about.names:
                nodes[node] = gravest((state, nodes.get(node, OK)))
        for frame in about.frames:
            frames[frame] = tuple(dict.fromkeys((*frames.get(frame, ()), finding.code)))
    return Marks(ends, nodes, frames)


def _ends(view: View, finding: GraphFinding) -> Targets:
    if not finding.node:
        robot = view.robots.get(finding.robot)
        return Targets(robot.nodes if robot else (), finding.about, ())
    met = dict.fromkeys(end.node for name in finding.about for end in view.by_name.get(name, ()))
    words = _words(finding.message)
    others = [node for node in met if finding.code in ALL_ENDS or node in words]
    return Targets(tuple(dict.fromkeys((finding.node, *sorted(others)))), finding.about, ())


def _frames(view: View, finding: GraphFinding, topics: Sequence[str]) -> Iterator[FrameKey]:
    """The frames on the topics that are named; else on the robot's own, or anywhere."""
    words = {tree_of(word) for word in _words(finding.message)}
    robot = view.robots.get(finding.robot)
    own = [topic for topic in topics if robot and topic == tree_of(robot.tf)]
    named = [topic for topic in topics if topic in words]
    return ((topic, frame) for topic in named or own or topics for frame in finding.about)


def _words(message: str) -> set[str]:
    return {word.rstrip(",:;") for word in message.split()}
