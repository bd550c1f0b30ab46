"""A plan and a recording -> findings. Nothing is said of nodes: a recording has none."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from typing import Any

from multibot_rewrite.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.findings.rule import Rule, declare
from multibot_rewrite.graph.bags.recording import RecordedTopic, Recording
from multibot_rewrite.graph.wording import SEVERAL, shorten
from multibot_rewrite.record import NamedTuple
from multibot_rewrite.rules.ownership import NameOwnership, frame_ownership, name_ownership
from multibot_rewrite.system.conventions import EVERYBODYS
from multibot_rewrite.system.records import PUBLISHES, TOPIC, End, System

# Topics of one robot and of another are as often, unless something is wrong: so many times.
RATIO = 3.0
# Fewer messages say nothing of a rate.
ENOUGH = 10
# What who comes late has to get as well.
LATCHED = ("tf_static", "robot_description", "map")


def _rule(code: str, name: str, level: str, *words: str) -> Rule:
    what, why, fix, bad, good = words
    return declare(
        code, name, level, what=what, why=why, fix=fix, bad=bad, good=good, formats=("recording",)
    )


WRONG_TYPE = _rule(
    *("MG601", "recorded-type", ERROR),
    "A topic was recorded with another type than the plan has.",
    "Nodes of the two types do not hear each other.",
    "Start the node that the plan has, or make the plan anew.",
    "planned: /robot1/cmd_vel geometry_msgs/msg/TwistStamped, recorded: geometry_msgs/msg/Twist\n",
    "planned: /robot1/cmd_vel geometry_msgs/msg/Twist, recorded: geometry_msgs/msg/Twist\n",
)
NO_ROBOT = _rule(
    *("MG602", "recorded-without-robot", ERROR),
    "A topic that each robot has was recorded under a name of no robot of the plan.",
    "All robots use it, or none does: one command moves both, or nobody hears it.",
    "Start the node in its robot's namespace, with the rules of `multibot plan`.",
    "planned: /robot1/scan, recorded: /scan\n",
    "planned: /robot1/scan, recorded: /robot1/scan\n",
)
OTHERS_FRAME = _rule(
    *("MG603", "header-of-another-robot", ERROR),
    "Messages on a robot's topic are in a frame of another robot.",
    "The data is placed where the other robot is.",
    "Set the node's `frame_id` parameter, or `<frame_id>` of its plugin, to the robot's own frame.",
    "recorded: /robot1/scan with header.frame_id robot2/laser\n",
    "recorded: /robot1/scan with header.frame_id robot1/laser\n",
)
UNKNOWN_FRAME = _rule(
    *("MG604", "header-frame-unknown", ERROR),
    "Messages on a robot's topic are in a frame that the plan does not have.",
    "No transform leads there: what uses tf drops every message.",
    "Set the node's `frame_id` parameter, or `<frame_id>` of its plugin, to the robot's own frame.",
    "planned: frame robot1/laser, recorded: /robot1/scan with header.frame_id laser\n",
    "planned: frame robot1/laser, recorded: /robot1/scan with header.frame_id robot1/laser\n",
)
SILENT = _rule(
    *("MG605", "recorded-silent", WARNING),
    "A topic was recorded without a message, and another robot's has messages.",
    "Its node runs and sends nothing.",
    "Look at the node's log: a sensor without a connection, a plugin without its link.",
    "recorded: /robot1/scan 0 messages, /robot2/scan 600 messages\n",
    "recorded: /robot1/scan 600 messages, /robot2/scan 600 messages\n",
)
MISSING = _rule(
    *("MG606", "recorded-for-some-robots", ERROR),
    "The plan has a topic for each robot; of some it was recorded, of this one not.",
    "The node did not run, or ran under another name.",
    "Start it for each robot; if only some were to be recorded, pass `--ignore MG606`.",
    "planned: /robot1/odom, /robot2/odom, recorded: /robot1/odom\n",
    "planned: /robot1/odom, /robot2/odom, recorded: /robot1/odom, /robot2/odom\n",
)
SLOW = _rule(
    *("MG607", "recorded-rate", WARNING),
    "A robot's topic came three times less often than the same topic of another robot.",
    "It was lost in the network, or its node has no time.",
    "Compare CPU and network of the robots, and the QoS of the recorder: best effort loses messages.",
    "recorded: /robot1/scan at 10.0 Hz, /robot2/scan at 1.0 Hz\n",
    "recorded: /robot1/scan at 10.0 Hz, /robot2/scan at 9.8 Hz\n",
)
TOO_MANY = _rule(
    *("MG608", "recorded-publishers", ERROR),
    "More publishers were recorded on a robot's topic than the plan has.",
    "Two senders of a command or of odometry work against each other.",
    "Stop the second one, or name it in the plan.",
    "planned: /robot1/odom from one node, recorded: /robot1/odom of 2 publishers\n",
    "planned: /robot1/odom from one node, recorded: /robot1/odom of 1 publisher\n",
)
NOT_LATCHED = _rule(
    *("MG609", "recorded-not-latched", ERROR),
    "A map, description or `tf_static` was offered without `transient_local`.",
    "Who starts later never gets it.",
    "Publish it with durability transient local.",
    "recorded: /robot1/tf_static volatile\n",
    "recorded: /robot1/tf_static transient_local\n",
)
OTHERS_TF = _rule(
    *("MG610", "recorded-tf-of-another-robot", ERROR),
    "Transforms of one robot were recorded on the tf topic of another.",
    "Who listens to the other robot's tf gets two trees, and its own robot's listeners none.",
    "Start its nodes with the rules `/tf:=tf` and `/tf_static:=tf_static`, in its own namespace.",
    "recorded: /robot1/tf with robot2/odom -> robot2/base_link\n",
    "recorded: /robot2/tf with robot2/odom -> robot2/base_link\n",
)
RULES = (
    *(WRONG_TYPE, NO_ROBOT, OTHERS_FRAME, UNKNOWN_FRAME, SILENT, MISSING, SLOW, TOO_MANY),
    *(NOT_LATCHED, OTHERS_TF),
)


class _Planned(NamedTuple):
    """The plan by topic. ``plain`` are the names without a robot's, each with its names by robot."""

    plan: System
    ends: Mapping[str, list[End]]
    plain: Mapping[str, Mapping[str, str]]
    names: NameOwnership
    frames: NameOwnership

    def robot(self, topic: str) -> str:
        """Whose topic it is; empty for one of all robots."""
        return "" if topic in (*self.plan.shared_topics, *EVERYBODYS) else self.names.robot(topic)


def compare(plan: System, found: Recording) -> list[Finding]:
    """All findings about topics; those about frames are of the rules of the graph."""
    planned = _planned(plan)
    recorded = {it.name: it for it in found.topics}
    by_topic = [it for topic in found.topics for it in _of_topic(planned, topic)]
    between = _between_robots(planned, recorded, found.seconds)
    tf = _others_tf(planned, found)
    return sorted([*by_topic, *between, *tf], key=lambda it: it.code)


def _planned(plan: System) -> _Planned:
    names = name_ownership(plan)
    ends: dict[str, list[End]] = defaultdict(list)
    plain: dict[str, dict[str, str]] = defaultdict(dict)
    shared = {*plan.shared_topics, *EVERYBODYS}
    for end in plan.ends:
        if end.kind == TOPIC:
            ends[end.name].append(end)
            robot = names.robot(end.name)
            if robot and end.name not in shared:
                plain[names.without_robot(end.name, robot)][robot] = end.name
    for it in plan.robots:
        if it.frames and it.tf_topic not in shared and names.robot(it.tf_topic) == it.name:
            plain[names.without_robot(it.tf_topic, it.name)][it.name] = it.tf_topic
    return _Planned(plan, ends, plain, names, frame_ownership(plan))


def _of_topic(planned: _Planned, topic: RecordedTopic) -> Iterator[Finding]:
    yield from _type(planned, topic)
    yield from _without_robot(planned, topic)
    yield from _header(planned, topic)
    yield from _publishers(planned, topic)
    volatile = any(it.durability == "VOLATILE" for it in topic.qos)
    if volatile and {*LATCHED} & {*topic.name.split("/")[-2:]}:
        yield _about(NOT_LATCHED, planned, topic, f"{topic.name} is offered as volatile")


def _about(
    rule: Rule, planned: _Planned, topic: RecordedTopic, message: str, hint: str = ""
) -> Finding:
    return rule.finding(message, hint, robot=planned.robot(topic.name), names=(topic.name,))


def _type(planned: _Planned, topic: RecordedTopic) -> Iterator[Finding]:
    types = {it for end in planned.ends.get(topic.name, ()) for it in (end.type, *end.also)} - {""}
    if types and topic.type not in types:
        wanted = " or ".join(sorted(types))
        yield _about(
            WRONG_TYPE, planned, topic, f"{topic.name} is {topic.type}, planned is {wanted}"
        )


def _without_robot(planned: _Planned, topic: RecordedTopic) -> Iterator[Finding]:
    shared = topic.name in (*planned.plan.shared_topics, *EVERYBODYS)
    if shared or topic.name in planned.ends or planned.names.robot(topic.name):
        return
    segments = topic.name.strip("/").split("/")
    without = [segments, segments[1:], segments[:-1]]
    plain = next((it for it in ("/" + "/".join(own) for own in without) if it in planned.plain), "")
    if plain:
        wanted = shorten([*planned.plain[plain].values()], SEVERAL)
        yield _about(NO_ROBOT, planned, topic, f"{topic.name} is of no robot; planned: {wanted}")


def _header(planned: _Planned, topic: RecordedTopic) -> Iterator[Finding]:
    robot = planned.robot(topic.name)
    own = next((it for it in planned.plan.robots if it.name == robot), None)
    if own is None or not own.frames:
        return
    known = {*own.frames, *own.other_frames, *planned.plan.shared_frames}
    for frame in topic.frames:
        # Joint states, for example, need none.
        if not frame or frame.strip("/") in known:
            continue
        other = planned.frames.robot(frame)
        where = f"{topic.name}: header.frame_id is {frame!r}"
        if other and other != robot:
            yield _about(OTHERS_FRAME, planned, topic, f"{where}, which is of {other}")
        else:
            yield _about(UNKNOWN_FRAME, planned, topic, f"{where}, which is no frame of {robot}")


def _publishers(planned: _Planned, topic: RecordedTopic) -> Iterator[Finding]:
    nodes = {it.node for it in planned.ends.get(topic.name, ()) if it.role == PUBLISHES}
    one = any(it.name == topic.name and it.one_sender for it in planned.plan.topics)
    most = 1 if one else len(nodes)
    patterns = any("*" in it for it in nodes)
    if nodes and not patterns and len(topic.qos) > most and planned.robot(topic.name):
        message = f"{topic.name} has {len(topic.qos)} publishers, planned are {most}"
        yield _about(
            TOO_MANY, planned, topic, message, f"planned: {shorten(sorted(nodes), SEVERAL)}"
        )


def _others_tf(planned: _Planned, found: Recording) -> Iterator[Finding]:
    frames: dict[tuple[str, str, str], list[str]] = defaultdict(list)
    for it in found.transforms:
        home, robot = planned.robot(it.topic), planned.frames.robot(it.child)
        if home and robot and home != robot:
            frames[it.topic, home, robot].append(it.child)
    for (topic, home, robot), names in frames.items():
        message = f"{shorten(names, SEVERAL)} of {robot} on {topic}, which is of {home}"
        yield OTHERS_TF.finding(message, **_place(robot, topic))


def _between_robots(
    planned: _Planned, recorded: Mapping[str, RecordedTopic], seconds: float
) -> Iterator[Finding]:
    """Of the same topic of several robots: which has none, which has fewer messages."""
    trees = {it.tf_topic for it in planned.plan.robots}
    for names in planned.plain.values():
        sent = {
            robot: name
            for robot, name in names.items()
            if name in trees or any(it.role == PUBLISHES for it in planned.ends[name])
        }
        there = {robot: recorded[name] for robot, name in sent.items() if name in recorded}
        if there:
            yield from _missing(sent, there)
            yield from _rates(there, seconds)


def _missing(sent: Mapping[str, str], there: Mapping[str, RecordedTopic]) -> Iterator[Finding]:
    others = shorten([it.name for it in there.values()], SEVERAL)
    for robot, name in sent.items():
        if robot not in there:
            message = f"{name} was not recorded, {others} was"
            yield MISSING.finding(message, **_place(robot, name))


def _rates(there: Mapping[str, RecordedTopic], seconds: float) -> Iterator[Finding]:
    best = max(there.values(), key=lambda it: it.messages)
    if best.messages < ENOUGH or not seconds:
        return
    for robot, topic in there.items():
        if not topic.messages:
            message = f"{topic.name} has no message, {best.name} has {best.messages}"
            yield SILENT.finding(message, **_place(robot, topic.name))
        elif topic.messages * RATIO <= best.messages:
            rates = (it.messages / seconds for it in (topic, best))
            slow, usual = (f"{rate:.1f} Hz" for rate in rates)
            message = f"{topic.name} came at {slow}, {best.name} at {usual}"
            yield SLOW.finding(message, **_place(robot, topic.name))


def _place(robot: str, name: str) -> dict[str, Any]:
    return {"robot": robot, "names": (name,)}
