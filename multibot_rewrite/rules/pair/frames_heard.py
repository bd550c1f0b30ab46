# SPDX-License-Identifier: Apache-2.0
"""Rule about planned frames in no transform: no joint states, or another robot's description."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence, Set

from multibot_rewrite.base.conventions import SENT_FRAMES, USUAL_FRAMES
from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, Finding
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.rules.declaration import pair_rule
from multibot_rewrite.rules.pair.frame_prefixes import added_prefixes, robot_behind_prefix
from multibot_rewrite.rules.pair.name_variants import name_variants
from multibot_rewrite.rules.pair.silent_topics import silent_topics
from multibot_rewrite.rules.pair.tf_causes import JOINT_STATES
from multibot_rewrite.rules.pair.tf_senders import described_robots, sent_by_robot, state_publisher
from multibot_rewrite.rules.pair.tf_trees import frames_in, tf_trees
from multibot_rewrite.spelling.transforms import STATE_PUBLISHER
from multibot_rewrite.system.index import Index
from multibot_rewrite.system.records import PUBLISHES, TOPIC, Robot

_DESCRIPTION = "robot_description"


@pair_rule("MG208", "frame-not-received", ERROR, absence=True, drawn="missing")
def frame_not_received(plan: Index, seen: Index) -> Iterator[Finding]:
    """One finding for a robot whose senders all run. Where no transform was received at all, tf may
    not have been looked at."""
    senders = _senders(plan) if seen.system.edges else {}
    trees, strays = _trees_of(plan, seen), _strays(plan, seen)
    for robot in plan.system.robots:
        needed = senders.get(robot.name, set()) - plan.may_miss
        if not needed or not needed <= seen.nodes.keys():
            continue
        heard = trees.get(robot.name, ())
        prefixes = set(added_prefixes(robot, strays.get(robot.name, ())).values())
        left = _left_to_others(plan, seen, robot)
        expected = (it for it in robot.frames if it not in left)
        missing = [it for it in expected if not _is_heard(plan, robot, it, heard, prefixes)]
        if missing:
            yield _not_received(plan, seen, robot, missing)


def _left_to_others(plan: Index, seen: Index, robot: Robot) -> Set[str]:
    """The frames that only nodes send which may be missing by the plan, and are. A link without joints
    comes with the odometry, or not at all."""
    sent = sent_by_robot(plan, robot)
    absent = plan.may_miss - seen.nodes.keys()
    left = {name for it in sent if it.node in absent for name in it[1:]}
    links = {it for it in robot.frames if _plain(plan, robot, it) not in SENT_FRAMES}
    left |= links if len(links) == 1 else set()
    return left.difference(*(it[1:] for it in sent if it.node not in absent))


def _senders(plan: Index) -> Mapping[str, set[str]]:
    """By robot: its planned nodes that publish its tf."""
    topics = {robot.name: _tf_topics(robot) for robot in plan.system.robots}
    found: dict[str, set[str]] = defaultdict(set)
    for node, kind, role, name in plan.by_key:
        robot = plan.robot_of.get(node, "")
        if robot and (kind, role) == (TOPIC, PUBLISHES) and name in topics[robot]:
            found[robot].add(node)
    return found


def _tf_topics(robot: Robot) -> tuple[str, str]:
    return robot.tf_topic, "/".join(
        "tf_static" if it == "tf" else it for it in robot.tf_topic.split("/")
    )


def _trees_of(plan: Index, seen: Index) -> Mapping[str, list[Set[str]]]:
    """By robot: the frames on its tf topic, and on others where it sends: those have a finding of
    their own."""
    found: dict[str, list[Set[str]]] = defaultdict(list)
    for tree in tf_trees(plan, seen):
        frames = frozenset(frames_in(tree))
        for robot in {*tree.home, *tree.robots}:
            found[robot].append(frames)
    return found


def _strays(plan: Index, seen: Index) -> Mapping[str, list[str]]:
    """By robot: frames that are not planned and are its own by name, or by the topic."""
    ownership = plan.of_frames
    found: dict[str, list[str]] = defaultdict(list)
    for tree in tf_trees(plan, seen):
        home = tree.home[0] if len(tree.home) == 1 else ""
        for name in frames_in(tree):
            if name not in ownership.exact:
                own = ownership.robot(name) or home or robot_behind_prefix(ownership, name)
                found[own].append(name)
    return found


def _is_heard(
    plan: Index,
    robot: Robot,
    frame: str,
    heard: Sequence[Set[str]],
    prefixes: Set[str],
) -> bool:
    """Under its name, or under a wrong one, which has a finding of its own."""
    if any(frame in frames for frames in heard):
        return True
    plain = _plain(plan, robot, frame)
    variants = [*name_variants(plain, frame, plan.of_frames.tag(robot.name))]
    variants += [f"{prefix}{frame}" for prefix in prefixes]
    return any(not frames.isdisjoint(variants) for frames in heard)


def _not_received(plan: Index, seen: Index, robot: Robot, missing: Sequence[str]) -> Finding:
    several = f"{len(missing)} of the {len(robot.frames)} frames of {robot.name} are"
    what = several if len(missing) > 1 else f"frame {missing[0]} of {robot.name} is"
    message = f"{what} in no transform: {shorten(missing)}"
    hint = _why_not_received(plan, seen, robot, missing)
    left = _is_without_description(plan, robot, missing) and not _is_described(plan, robot)
    level = INCONCLUSIVE if left else ERROR
    return frame_not_received.finding(
        message, hint, level=level, robot=robot.name, names=tuple(missing)
    )


def _is_without_description(plan: Index, robot: Robot, missing: Sequence[str]) -> bool:
    """Does nothing of its description come? The root comes with the odometry, too."""
    described = set(robot.frames).difference(*(it[1:] for it in sent_by_robot(plan, robot)))
    described = {it for it in described if _plain(plan, robot, it) not in USUAL_FRAMES}
    return bool(described) and described.issubset(missing)


def _is_described(plan: Index, robot: Robot) -> bool:
    """Has the plan a node that sends the transforms of its description?"""
    own = plan.own[robot.name]
    told = (it for it in plan.by_key if it[1:3] == (TOPIC, PUBLISHES) and it[0] in own)
    return bool(state_publisher(plan, robot)) or any(it[3].endswith(_DESCRIPTION) for it in told)


def _plain(plan: Index, robot: Robot, frame: str) -> str:
    return plan.of_frames.without_robot(frame, robot.name)


def _why_not_received(plan: Index, seen: Index, robot: Robot, missing: Sequence[str]) -> str:
    silent = min(silent_topics(plan, seen, robot, JOINT_STATES), default="")
    if silent:
        source = "joint_state_publisher, joint_state_broadcaster or the bridge"
        return f"nothing publishes {silent}: is {source} started for {robot.name}?"
    sent = sent_by_robot(plan, robot)
    if _is_without_description(plan, robot, missing):
        publisher = state_publisher(plan, robot) or STATE_PUBLISHER
        whose = next(described_robots(plan, seen, robot), "")
        if whose:
            return f"{publisher} has the description of {whose}, whose transforms it sends"
        if not _is_described(plan, robot):
            return "no planned node sends its description: is what sends it started?"
        return f"has {publisher} the description of {robot.name}, or that of another robot?"
    unsent = [it for it in sent if not set(it[1:]).isdisjoint(missing)]
    if unsent:
        first = unsent[0]
        return f"by the plan {first.node} sends {first}: has it the parameters of {robot.name}?"
    return "which node sends it? is its joint in the joint states, is its plugin loaded?"
