# SPDX-License-Identifier: Apache-2.0
"""What findings are about, the states that follow from it, and tf trees as rows of frames."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.grouping import lists_by_key
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
    """States by (node, name) and by node, codes by frame; ``names``: all that findings are about."""

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


class FrameRow(NamedTuple):
    """A frame; ``parent`` is the index of its parent's row, -1 for none. ``faults`` are in words.

    The children of a ``repeated`` frame are shown only where the frame is first.
    """

    frame: str
    parent: int
    depth: int
    robot: str
    state: str
    faults: tuple[str, ...]
    static: bool
    repeated: bool


class FrameTree(NamedTuple):
    """One tree on ``topic`` and its tf_static.

    Without ``received`` it has the frames of ``robot`` that are declared and were not received."""

    topic: str
    robot: str
    received: bool
    rows: tuple[FrameRow, ...]


def make_frame_trees(plan: Index, seen: Index, states: States) -> tuple[FrameTree, ...]:
    """Return the trees on each topic in the order of the robots, then the frames missing there."""
    edges = {tree.topic: tree.edges for tree in seen.trees if tree.edges}
    if not (edges or states.frames):
        return ()
    order = {robot: at for at, robot in enumerate(plan.declared)}
    found: list[FrameTree] = []
    home_topics = (tree_topic(robot.tf_topic) for robot in plan.system.robots)
    for topic in dict.fromkeys((*home_topics, *sorted(edges))):
        home = [robot for robot in plan.system.robots if tree_topic(robot.tf_topic) == topic]
        static = {(edge.parent, edge.child): edge.static for edge in edges.get(topic, ())}
        only = home[0].name if len(home) == 1 else ""
        frames = sorted({frame for edge in static for frame in edge})
        robot_of = {frame: plan.frame_robot(frame) or only for frame in frames}
        forest = _Forest(topic, static, lists_by_key(sorted(static)), robot_of)
        trees = []
        for rows in _trees(forest, states):
            first = next((row.robot for row in rows if row.robot), "")
            trees.append(FrameTree(topic, first, True, rows))
        found += sorted(trees, key=lambda tree: order.get(tree.robot, len(order)))
        for robot in home:
            missing = [frame for frame in robot.frames if frame not in forest.robots]
            faults = (_rule_names(states.frames.get((topic, frame), ())) for frame in missing)
            lost = tuple(
                FrameRow(frame, -1, 0, robot.name, MISSING, words, False, False)
                for frame, words in zip(missing, faults, strict=True)
            )
            found += [FrameTree(topic, robot.name, False, lost)] if lost else []
    return tuple(found)


class _Forest(NamedTuple):
    """All transforms on one topic; ``static`` by (parent, child)."""

    topic: str
    static: Mapping[tuple[str, str], bool]
    children: Mapping[str, Sequence[str]]
    robots: Mapping[str, str]


def _trees(forest: _Forest, states: States) -> Iterator[tuple[FrameRow, ...]]:
    """Yield one tree from each root; from a root of no robot one for each robot."""
    below = {child for _, child in forest.static}
    seen: set[str] = set()
    # After the roots only frames in a loop are left.
    for root in (*sorted(set(forest.children) - below), *sorted(forest.children)):
        if root in seen:
            continue
        shared = not forest.robots[root]
        parts = lists_by_key(
            (forest.robots[it] if shared else "", it) for it in forest.children[root]
        )
        for part in parts.values():
            seen.discard(root)
            yield tuple(_tree_rows(forest, states, root, part, seen))


def _tree_rows(
    forest: _Forest, states: States, root: str, first: Sequence[str], seen: set[str]
) -> Iterator[FrameRow]:
    """Yield rows depth first from ``root`` through the children ``first``, without recursion."""
    waiting = [(root, "", -1, 0)]
    at = 0
    while waiting:
        frame, parent, parent_row, depth = waiting.pop()
        codes = states.frames.get((forest.topic, frame), ())
        yield FrameRow(
            frame,
            parent_row,
            depth,
            forest.robots[frame],
            CLASH if codes else OK,
            _rule_names(codes),
            forest.static.get((parent, frame), False),
            repeated=frame in seen,
        )
        if frame not in seen:
            seen.add(frame)
            below = forest.children.get(frame, ()) if depth else first
            waiting += [(child, frame, at, depth + 1) for child in reversed(below)]
        at += 1


def _rule_names(codes: Iterable[str]) -> tuple[str, ...]:
    return tuple(RULES[code].name.replace("-", " ") for code in codes)
