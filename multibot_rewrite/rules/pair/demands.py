"""Rules about what a plan asks beyond names: who may send, what is offered, which node of several."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from fnmatch import fnmatchcase

from multibot_rewrite.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.graph.wording import SEVERAL, shorten
from multibot_rewrite.rules.declaration import graph_rule
from multibot_rewrite.rules.pair.causes import DOES
from multibot_rewrite.rules.pair.comparison import View
from multibot_rewrite.system.records import PUBLISHES, TOPIC, End, Topic, alternatives

# How the nodes of ros_gz_bridge are called.
_BRIDGES = ("bridge", "parameter_bridge")


@graph_rule(
    "MG121",
    "sender-not-planned",
    ERROR,
    drawn="cross-talk",
    what="A node publishes a topic that others alone may publish, by `senders` of the plan.",
    why="Both are obeyed in turn: a robot that gets velocities from two nodes shakes, or drives where"
    " nobody wants it. A tool may not do it either.",
    fix="Stop the node, or remap what it publishes. If it is right, add it to `senders` of the topic"
    " in the plan.",
    bad="""\
planned: topic /robot1/cmd_vel from /robot1/twist_mux
as planned: /robot1/twist_mux publishes /robot1/cmd_vel
running: /teleop_twist_keyboard publishes /robot1/cmd_vel
""",
    good="""\
planned: topic /robot1/cmd_vel from /robot1/twist_mux
as planned: /robot1/twist_mux publishes /robot1/cmd_vel
running: /teleop_twist_keyboard publishes /robot1/cmd_vel_teleop
""",
    line=3,
)
def sender_not_planned(view: View) -> Iterator[Finding]:
    """Of topics with senders; one finding for each other node."""
    for topic in (it for it in view.plan.topics if it.senders):
        allowed = shorten(topic.senders, SEVERAL)
        for node in dict.fromkeys(it.node for it in _publishers(view, topic)):
            if not _may_send(topic, node):
                message = f"publishes {topic.name}, which only {allowed} may publish"
                hint = (
                    f"stop it or remap it; if it is right, add it to topics: {topic.name}: senders"
                )
                yield sender_not_planned.finding(message, hint, **_about(view, topic, node))


def _may_send(topic: Topic, node: str) -> bool:
    return any(fnmatchcase(node, pattern) for pattern in topic.senders)


def _publishers(view: View, topic: Topic) -> Iterator[End]:
    ends = view.by_name.get(topic.name, ())
    return (it for it in ends if (it.kind, it.role) == (TOPIC, PUBLISHES))


def _about(view: View, topic: Topic, node: str) -> dict[str, object]:
    robot = view.ownership.robot(topic.name) or view.robot_of.get(node, "")
    return {"robot": robot, "node": node, "names": (topic.name,)}


@graph_rule(
    "MG122",
    "several-senders",
    ERROR,
    drawn="cross-talk",
    what="Several nodes publish a topic that has `one_sender` in the plan.",
    why="Subscribers get the messages of both in turn.",
    fix="Stop all but one, or put a twist_mux before the topic.",
    bad="""\
planned: topic /robot1/cmd_vel from one node
as planned: /robot1/planner publishes /robot1/cmd_vel
running: /robot1/joystick publishes /robot1/cmd_vel
""",
    good="""\
planned: topic /robot1/cmd_vel from one node
as planned: /robot1/planner publishes /robot1/cmd_vel
""",
    line=2,
)
def several_senders(view: View) -> Iterator[Finding]:
    """One finding a topic, at the sender that is not planned if there is one."""
    for topic in (it for it in view.plan.topics if it.one_sender):
        nodes = dict.fromkeys(it.node for it in _publishers(view, topic))
        if len(nodes) > 1:
            planned = (TOPIC, PUBLISHES, topic.name)
            others = [
                it
                for it in nodes
                if (it, *planned) not in view.planned and not _may_send(topic, it)
            ]
            node = next(iter((*others, *nodes)))
            listed = shorten(nodes, SEVERAL)
            message = f"{topic.name} has {len(nodes)} senders: {listed}; the plan has one"
            hint = f"stop {node}, or put a twist_mux before the topic"
            yield several_senders.finding(message, hint, **_about(view, topic, node))


@graph_rule(
    "MG123",
    "other-qos-offered",
    ERROR,
    what="A publisher offers another QoS than `qos` of its topic in the plan.",
    why="Subscriptions that come later, or ask for more, get no message.",
    fix="Set the publisher's QoS, by its parameter or a qos_overrides parameter, or correct the plan.",
    bad="""\
planned: topic /map from /map_server transient_local
as planned: /map_server publishes /map nav_msgs/msg/OccupancyGrid reliable volatile
""",
    good="""\
planned: topic /map from /map_server transient_local
as planned: /map_server publishes /map nav_msgs/msg/OccupancyGrid reliable transient_local
""",
    line=2,
)
def other_qos_offered(view: View) -> Iterator[Finding]:
    """Where the snapshot knows what is offered."""
    for topic in (it for it in view.plan.topics if it.qos):
        for end in _publishers(view, topic):
            different = list(_different(topic, end))
            if different:
                message = f"{topic.name} is published with {', '.join(different)}"
                hint = f"set it with qos_overrides.{topic.name}.publisher in its parameters"
                yield other_qos_offered.finding(message, hint, **_about(view, topic, end.node))


def _different(topic: Topic, end: End) -> Iterator[str]:
    """Each policy that is not as planned; one whose word is not known is none."""
    for policy, word in topic.qos if end.qos else ():
        offered = getattr(end.qos, policy)
        if offered not in (word, "UNKNOWN", "SYSTEM_DEFAULT"):
            yield f"{policy} {offered}, the plan has {word}"


@graph_rule(
    "MG124",
    "no-alternative-runs",
    ERROR,
    absence=True,
    drawn="missing",
    what="Of a group of nodes in `one_of` of the plan, none runs.",
    why="What each of them would do for the robot is done by nobody.",
    fix="Start one of them.",
    bad="""\
planned: one of /robot1/amcl, /robot1/slam_toolbox
as planned: /robot1/driver
planned: /robot1/amcl
planned: /robot1/slam_toolbox
""",
    good="""\
planned: one of /robot1/amcl, /robot1/slam_toolbox
as planned: /robot1/driver
planned: /robot1/amcl
as planned: /robot1/slam_toolbox
""",
)
def no_alternative_runs(view: View) -> Iterator[Finding]:
    """A robot of which nothing runs has a finding of its own."""
    for group in alternatives(view.plan):
        robot = _robot_of(view, group)
        if not (robot and _absent(view, robot)) and view.seen.keys().isdisjoint(group):
            message = f"none of {shorten(group, SEVERAL)} is in the graph; the plan has one of them"
            yield no_alternative_runs.finding(
                message, "start one of them", robot=robot, names=group
            )


@graph_rule(
    "MG125",
    "several-alternatives-run",
    ERROR,
    what="Of a group of nodes in `one_of` of the plan, more than one runs.",
    why="They do the same thing: two localizations send the same transform, two controllers command"
    " the same joints.",
    fix="Stop all but one.",
    bad="""\
planned: one of /robot1/amcl, /robot1/slam_toolbox
as planned: /robot1/amcl
as planned: /robot1/slam_toolbox
""",
    good="""\
planned: one of /robot1/amcl, /robot1/slam_toolbox
as planned: /robot1/amcl
planned: /robot1/slam_toolbox
""",
)
def several_alternatives_run(view: View) -> Iterator[Finding]:
    """One finding a group."""
    for group in alternatives(view.plan):
        running = [node for node in group if node in view.seen]
        if len(running) > 1:
            message = f"{shorten(running, SEVERAL)} run at once; the plan has one of them"
            hint = f"stop {shorten(running[1:], SEVERAL)}"
            about = {"robot": _robot_of(view, group), "node": running[0], "names": tuple(running)}
            yield several_alternatives_run.finding(message, hint, **about)


@graph_rule(
    "MG126",
    "bridged-topic-missing",
    ERROR,
    absence=True,
    drawn="missing",
    what="A topic that a ros_gz_bridge has to carry has no publisher (GZ_TO_ROS) or no subscription"
    " (ROS_TO_GZ) of its type. It is a warning where nothing at all is bridged: robots may be real.",
    why="The simulated robot does not move, or its sensor is never seen: `/robot2/cmd_vel` is"
    " published, and nobody passes it on to the simulator.",
    fix="Start a bridge with the file that `multibot build` wrote for the robot, or add the row to"
    " yours. For real robots write `simulator: none` in the fleet file.",
    bad="""\
planned: topic /robot1/scan over a bridge that publishes sensor_msgs/msg/LaserScan
planned: topic /robot1/cmd_vel over a bridge that subscribes geometry_msgs/msg/Twist
as planned: /robot1/robot_state_publisher
running: /robot1/ros_gz_bridge publishes /robot1/scan sensor_msgs/msg/LaserScan
""",
    good="""\
planned: topic /robot1/scan over a bridge that publishes sensor_msgs/msg/LaserScan
planned: topic /robot1/cmd_vel over a bridge that subscribes geometry_msgs/msg/Twist
as planned: /robot1/robot_state_publisher
running: /robot1/ros_gz_bridge publishes /robot1/scan sensor_msgs/msg/LaserScan
running: /robot1/ros_gz_bridge subscribes /robot1/cmd_vel geometry_msgs/msg/Twist
""",
    line=2,
)
def bridged_topic_missing(view: View) -> Iterator[Finding]:
    """One finding for a robot; one for all where nothing is bridged."""
    rows = [(topic, role) for topic in view.plan.topics for role in topic.bridge]
    missing = [(topic, role) for topic, role in rows if not _is_carried(view, topic, role)]
    if missing and len(missing) == len(rows):
        running = not all(_absent(view, it.name) for it in view.plan.robots)
        yield from [_not_carried(view, "", missing, WARNING)] * running
        return
    by_robot: dict[str, list[tuple[Topic, str]]] = defaultdict(list)
    for topic, role in missing:
        by_robot[view.ownership.robot(topic.name)].append((topic, role))
    for robot, own in by_robot.items():
        if not (robot and _absent(view, robot)):
            yield _not_carried(view, robot, own, ERROR)


def _absent(view: View, robot: str) -> bool:
    """A robot of which nothing runs has a finding of its own."""
    return view.seen.keys().isdisjoint(view.own[robot])


def _is_carried(view: View, topic: Topic, role: str) -> bool:
    """Whether anything does with a topic what a bridge has to do."""
    ends = (it for it in view.by_name.get(topic.name, ()) if (it.kind, it.role) == (TOPIC, role))
    return any(topic.type in ("", it.type) for it in ends)


def _not_carried(view: View, robot: str, rows: Sequence[tuple[Topic, str]], level: str) -> Finding:
    topic, role = rows[0]
    more = f"; so it is with {len(rows) - 1} more of the bridge" if len(rows) > 1 else ""
    type_ = f" with the type {topic.type}" if topic.type else ""
    verb = DOES[role]
    message = f"nothing {verb} {topic.name}{type_}, which a ros_gz_bridge has to carry{more}"
    names = tuple(dict.fromkeys(it.name for it, _ in rows))
    hint = f"{_bridges_there(view, robot)}; for real robots write simulator: none in the fleet file"
    return bridged_topic_missing.finding(message, hint, level=level, robot=robot, names=names)


def _bridges_there(view: View, robot: str) -> str:
    bridges = [it for it in view.seen if it.rpartition("/")[2].endswith(_BRIDGES)]
    own = [it for it in bridges if view.ownership.robot(it) == robot] or bridges
    if not own:
        return "no ros_gz_bridge is in the graph: start one with the robot's bridge.yaml"
    return f"add the row to the file of {shorten(own)}"


def _robot_of(view: View, nodes: Iterable[str]) -> str:
    return next((view.robot_of[node] for node in nodes if node in view.robot_of), "")
