# SPDX-License-Identifier: Apache-2.0
"""What a fleet would do: starts, drives, sees, plans, and one tree of transforms, for each robot.

A robot drives where each topic that its reader or its Nav2 sends commands on reaches its own drive and
no other's, and each goal of its MoveIt its own controllers; it sees where what its nodes read is sent
by its own sensors; it plans where each frame that its nodes look up is in one tree with its own links.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import programs
from fleet import End, Fleet
from nodes import Node
from programs import MAP
from trees import (
    LOOKED_UP,
    ODOMETRY,
    SENT,
    TF,
    Edge,
    connected,
    is_static,
    moving_of,
    static_of,
    whole,
)
from twins import Fault, models_twice, sent_twice, topics_twice, twins

COMMANDS = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
# They pass a command on: what they read is sent again.
PASSING = ("velocity_smoother", "collision_monitor", "twist_mux", "twist_stamper", "twist_marker")
# They write commands of their own.
SENDING = (
    *("controller_server", "behavior_server", "docking_server", "following_server", "move_group"),
)
SEEN = tuple(
    f"{it}"
    for it in (
        *("sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Image", "sensor_msgs/msg/PointCloud2"),
        *("sensor_msgs/msg/Imu", "sensor_msgs/msg/JointState", "nav_msgs/msg/Odometry"),
        "sensor_msgs/msg/CameraInfo",
    )
)
JOINT_STATE = "sensor_msgs/msg/JointState"
SYNCHRONISED = SEEN[:3]
# What moves joints to where a client says, and by which messages.
MOVING = (
    *("joint_trajectory_controller", "forward_command_controller", "gripper_action_controller"),
    *("parallel_gripper_action_controller", "admittance_controller"),
)
TRAJECTORY = "trajectory_msgs/msg/JointTrajectory"
POSED = (TRAJECTORY, "std_msgs/msg/Float64MultiArray")
GOALS = tuple(programs.GOALS.values())
# What systems of the simulator are moved by.
SIMULATED = ("gz.msgs.Twist", "gz.msgs.JointTrajectory")
DRIVING = (
    "diff_drive_controller",
    "mecanum_drive_controller",
    "ackermann_steering_controller",
    "tricycle_controller",
    "omni_wheel_drive_controller",
    "bicycle_steering_controller",
)


def judged(fleet: Fleet) -> tuple[Fault, ...]:
    """Every fault of a fleet."""
    found = [Fault(*it) for it in fleet.faults]
    found += [*twins(fleet), *models_twice(fleet), *topics_twice(fleet), *sent_twice(fleet)]
    for robot in fleet.robots:
        found += drives(fleet, robot)
        found += sees(fleet, robot)
        found += plans(fleet, robot)
    return tuple(dict.fromkeys(found))


def done(fleet: Fleet) -> dict[str, dict[str, str]]:
    """Return what each robot does: "yes", "no" or "unknown: PROGRAM" for each word; a word is
    missing where the robot has nothing to do it with. A program that was not read may do
    anything."""
    wrong = {(it.robot, it.what) for it in judged(fleet)}
    return {robot: dict(words(fleet, robot, wrong)) for robot in fleet.robots}


def words(fleet: Fleet, robot: str, wrong: set[tuple[str, str]]) -> Iterator[tuple[str, str]]:
    nodes = [it for it in fleet.nodes if it.robot == robot]
    unknown = ", ".join(what for who, what in fleet.unknown if who in ("", robot))
    has = {
        "starts": True,
        "drives": any(it[0] == robot for it in heard(fleet)),
        "sees": any(it.robot == robot for it in readers(fleet)),
        "plans": any(it.what in LOOKED_UP for it in nodes),
    }
    for word, is_there in has.items():
        if (robot, word) in wrong or ("", word) in wrong:
            yield word, "no"
        elif unknown:
            yield word, f"unknown: {unknown}"
        elif is_there:
            yield word, "yes"


def said(found: dict[str, str]) -> str:
    """Return the words of a robot in one line."""
    return ", ".join(
        {"yes": word, "no": f"no {word}"}.get(it, f"{word} {it}") for word, it in found.items()
    )


def heard(fleet: Fleet) -> Iterator[tuple[str, str, str]]:
    """Whose drive or arm hears a topic or has an action, and of which type."""
    plain = {it.fqn: it.what for it in fleet.nodes}
    robots, plugins = {model: robot for robot, model in fleet.models.items()}, classic(fleet)
    for it in fleet.ends:
        what = plain.get(it.node, "")
        driving = what in DRIVING or it.node in plugins | ends_commands(fleet)
        heard = it.role == "subscribes" and it.type in COMMANDS and it.sure and driving
        posed = it.role == "subscribes" and it.type in POSED and (what in MOVING or driving)
        if heard or posed or (it.role == "serves" and it.type in GOALS and what in MOVING):
            yield it.robot, it.name, it.type
    for end in fleet.gz:
        for row in fleet.bridges:
            if (
                end.role == "hears"
                and end.type in SIMULATED
                and row.to_gz
                and (row.gz, row.gz_type) == (end.topic, end.type)
            ):
                yield robots[end.model], row.ros, row.type


def ends_commands(fleet: Fleet) -> set[str]:
    """Vendors' nodes that read commands and pass none on: they drive."""
    own = {it.fqn for it in fleet.nodes if it.own}
    return own - {it.node for it in fleet.ends if it.role == "publishes" and it.type in COMMANDS}


def classic(fleet: Fleet) -> set[str]:
    return {it.fqn for it in fleet.nodes if it.what.endswith(".so")}


def reached(fleet: Fleet, topic: str, kind: str) -> set[str]:
    """Return the robots whose drives move when something is sent on a topic."""
    topics = carried(fleet, topic, kind)
    return {robot for robot, name, sort in heard(fleet) if (name, sort) in topics}


def carried(fleet: Fleet, topic: str, kind: str) -> set[tuple[str, str]]:
    """Return the topics and types on which a command is sent again by those that pass it on."""
    passing = {it.fqn for it in fleet.nodes if it.what in PASSING or it.own}
    topics, queue = {(topic, kind)}, [(topic, kind)]
    while queue:
        one = queue.pop()
        through = {
            it.node
            for it in fleet.ends
            if it.role == "subscribes" and (it.name, it.type) == one and it.node in passing
        }
        for it in fleet.ends:
            out = it.name, it.type
            sent = it.node in through and it.role == "publishes" and it.type in COMMANDS
            if sent and out not in topics:
                topics.add(out)
                queue.append(out)
    return topics


def drives(fleet: Fleet, robot: str) -> Iterator[Fault]:
    """Commands for a robot that move another, or nothing."""
    own = [it for it in heard(fleet) if it[0] == robot]
    has_drive = own or any(
        end.role == "hears" and end.type in SIMULATED and end.model == fleet.models.get(robot)
        for end in fleet.gz
    )
    if not has_drive:
        for it in senders(fleet, robot) if fleet.whole else ():
            why = f"{it.node} sends {it.type} on {it.name}, which nothing reads that drives"
            yield Fault(robot, "drives", why)
        return
    if not own:
        yield Fault(robot, "drives", "no topic of ROS reaches its drive")
    for _, topic, kind in own:
        yield from wrong(robot, topic, reached(fleet, topic, kind))
    said = fleet.told.get(robot)
    if said and said not in {topic for _, topic, _ in own}:
        whom = set().union(*(reached(fleet, said, kind) for kind in COMMANDS))
        if whom != {robot}:
            why = f"the line for its reader sends to {said}: that moves {sorted(whom)}"
            last = {name for kind in COMMANDS for name, _ in carried(fleet, said, kind)} - {said}
            why += f"; it goes on to {', '.join(sorted(last))}" if last else ""
            heard_on = ", ".join(sorted({topic for _, topic, _ in own}))
            why += f"; its drive hears {heard_on}" if heard_on else ""
            yield Fault(robot, "drives", why)
    yield from misplaced(fleet, robot)
    for it in senders(fleet, robot):
        whom = reached(fleet, it.name, it.type)
        if whom != {robot}:
            why = f"{it.node} sends {it.type} on {it.name}: that moves {sorted(whom) or 'nothing'}"
            last = {name for name, _ in carried(fleet, it.name, it.type)} - {it.name}
            why += f"; it goes on to {', '.join(sorted(last))}" if last else ""
            yield Fault(robot, "drives", why)


def senders(fleet: Fleet, robot: str) -> list[End]:
    """Return the ends on which nodes of a robot send commands of their own, and goals."""
    every = (it for it in fleet.nodes if it.robot == robot)
    nodes = {it.fqn for it in every if it.what in SENDING or it.own}
    kinds = {"publishes": COMMANDS, "calls": GOALS}
    return [it for it in fleet.ends if it.node in nodes and it.type in kinds.get(it.role, ())]


def misplaced(fleet: Fleet, robot: str) -> Iterator[Fault]:
    """Joints that move_group moves by a controller which has others: it refuses the trajectory
    (joint_trajectory_controller.cpp, validate_trajectory_msg)."""
    joints = {it.fqn: set(it.values.get("joints") or ()) for it in fleet.nodes}
    has = {
        (it.name, it.type): joints[it.node]
        for it in fleet.ends
        if it.role == "serves" and it.type in GOALS
    }
    for node in (it for it in fleet.nodes if it.robot == robot and it.what == "move_group"):
        goals = [it for it in senders(fleet, robot) if it.node == node.fqn]
        for (_, wanted), goal in zip(programs.handles(node.values), goals, strict=True):
            strange = sorted(set(wanted) - has.get((goal.name, goal.type), set(wanted)))
            if strange:
                why = f"{node.fqn} moves {', '.join(strange)} by {goal.name}, which has others"
                yield Fault(robot, "drives", why)


def wrong(robot: str, topic: str, whom: set[str]) -> Iterator[Fault]:
    for other in sorted(whom - {robot}):
        yield Fault(robot, "drives", f"{topic} moves {other}, too")


def readers(fleet: Fleet) -> list[End]:
    """Return the ends that read a sensor or odometry."""
    return [it for it in fleet.ends if it.role == "subscribes" and it.type in SEEN and it.sure]


def sees(fleet: Fleet, robot: str) -> Iterator[Fault]:
    """Readers of a robot without a sender, or with another's."""
    yield from waits(fleet, robot)
    for it in (it for it in readers(fleet) if it.robot == robot):
        whose = set(senders_of(fleet, it.name, it.type))
        if whose - {robot, ""}:
            others = ", ".join(sorted(whose - {robot, ""}))
            yield Fault(robot, "sees", f"{it.node} reads {it.name}, which {others} sends")
        elif it.name in frames_sent(fleet) and not is_placed(fleet, robot, it):
            frame = frames_sent(fleet)[it.name]
            why = f"{it.node} reads {it.name} in the frame {frame}, which is not with its links"
            yield Fault(robot, "sees", why)
        elif not whose and offered(fleet, robot, it.type):
            had = ", ".join(sorted(offered(fleet, robot, it.type)))
            yield Fault(
                robot, "sees", f"{it.node} reads {it.name}, which no node sends; it has {had}"
            )
        elif not whose and (is_posed(fleet, robot) if it.type == JOINT_STATE else fleet.whole):
            yield Fault(robot, "sees", f"{it.node} reads {it.name}, which no node sends")


def is_posed(fleet: Fleet, robot: str) -> bool:
    """Whether a robot has controllers that move joints."""
    return any(it.robot == robot and it.what in MOVING for it in fleet.nodes)


def waits(fleet: Fleet, robot: str) -> Iterator[Fault]:
    """Yield what rtabmap synchronises, and of which a part never comes: it drops the rest, too.
    Where its robot has nothing of the kind, no other setting would do."""
    for it in (it for it in fleet.nodes if it.robot == robot and it.what == "rtabmap"):
        node, ends = it.fqn, [end for end in fleet.ends if end.node == it.fqn]
        if programs.is_exact(it.values) and len(programs.synchronised(it.values)) > 1:
            why = f"{node} takes a scan and odometry of one stamp alone: approx_sync is not true"
            yield Fault(robot, "sees", why)
        had = {name for kind in SYNCHRONISED for name in offered(fleet, robot, kind)}
        had -= {it.name for it in ends if it.role == "publishes"}
        parts = {it for it in ends if it.role == "subscribes" and it.sure}
        lost = sorted(
            it.name
            for it in parts
            if it.type in (*SYNCHRONISED, ODOMETRY) and not [*senders_of(fleet, it.name, it.type)]
        )
        if lost and had:
            why = f"{node} waits for {', '.join(lost)}, which no node sends; it has"
            yield Fault(robot, "sees", f"{why} {', '.join(sorted(had))}")


def frames_sent(fleet: Fleet) -> dict[str, str]:
    """Return the frame of what sensors in the simulator send, by the topic of ROS."""
    return {
        row.ros: it.frame
        for row in fleet.bridges
        for it in fleet.gz
        if row.to_ros and it.topic == row.gz and it.frame
    }


def is_placed(fleet: Fleet, robot: str, reader: End) -> bool:
    """Whether a reader that looks up transforms finds the frame of what it reads."""
    topic = next((it.name for it in listening(fleet) if it.node == reader.node), None)
    if topic is None:
        return True
    near = [e for e in fleet.edges if e.topic in (topic, static_of(topic))]
    own = {it.child for it in near if it.robot in (robot, fleet.models.get(robot))}
    return any(connected(near, frames_sent(fleet)[reader.name], link) for link in own)


def listening(fleet: Fleet) -> list[End]:
    """Who listens to transforms, each with the topic that is not static."""
    return [
        it
        for it in fleet.ends
        if it.role == "subscribes" and it.type == TF and not is_static(it.name)
    ]


def senders_of(fleet: Fleet, name: str, kind: str) -> Iterator[str]:
    robots = {model: robot for robot, model in fleet.models.items()}
    yield from (
        it.robot
        for it in fleet.ends
        if it.role == "publishes" and (it.name, it.type) == (name, kind)
    )
    for row in fleet.bridges:
        if row.to_ros and (row.ros, row.type) == (name, kind):
            yield from (
                robots[it.model]
                for it in fleet.gz
                if it.role == "sends" and (it.topic, it.type) == (row.gz, row.gz_type)
            )


def offered(fleet: Fleet, robot: str, kind: str) -> set[str]:
    """Return the topics on which a robot has such messages, but for those that are made of others."""
    made = {it.fqn for it in fleet.nodes if it.what in programs.MAKING}
    ends = {
        it.name
        for it in fleet.ends
        if it.robot == robot and it.role == "publishes" and it.type == kind and it.node not in made
    }
    model = fleet.models.get(robot)
    own = {it.topic for it in fleet.gz if it.model == model and it.role == "sends"}
    return ends | {
        row.ros for row in fleet.bridges if row.to_ros and row.type == kind and row.gz in own
    }


def plans(fleet: Fleet, robot: str) -> Iterator[Fault]:
    """Frames that are not in the robot's tree, in two, or another's."""
    listens = {it.node: it.name for it in listening(fleet)}
    yield from mapless(fleet, robot)
    for it in fleet.nodes:
        topic = listens.get(it.fqn)
        if it.robot != robot or topic is None:
            continue
        near = [e for e in fleet.edges if e.topic in (topic, static_of(topic))]
        yield from unknown_frames(fleet, robot, it, topic, near)
    yield from two_parents(fleet, robot)
    yield from two_senders(fleet, robot)
    yield from one_start(fleet, robot)


def one_start(fleet: Fleet, robot: str) -> Iterator[Fault]:
    """Odometry that begins at a frame where another robot's begins: the two are laid on each other.
    What OdometryPublisher.cc sends is the pose in the world, and begins nowhere."""
    plain = {it.fqn: it.what for it in fleet.nodes}
    names = {model: who for who, model in fleet.models.items()}
    begins = {
        (names.get(it.robot, it.robot), it.topic, it.parent)
        for it in fleet.edges
        if (it.node.startswith("gz ") and not it.node.endswith(" odometry-publisher"))
        or plain.get(it.node) in DRIVING
    }
    for who, topic, frame in sorted(begins):
        if who != robot and (robot, topic, frame) in begins:
            yield Fault(robot, "plans", f"{frame} on {topic} is where {who} begins, too")


def mapless(fleet: Fleet, robot: str) -> Iterator[Fault]:
    """Readers of a map that no node sends: a static layer waits for it, amcl too."""
    sent = {it.name for it in fleet.ends if it.role == "publishes" and it.type == MAP}
    for it in fleet.ends:
        waits = it.role == "subscribes" and it.type == MAP and it.sure
        if waits and it.robot == robot and it.name not in sent:
            yield Fault(
                robot, "plans", f"{it.node} waits for the map {it.name}, which no node sends"
            )


def unknown_frames(
    fleet: Fleet, robot: str, node: Node, topic: str, near: list[Edge]
) -> Iterator[Fault]:
    names = [node.values.get(key) for key in LOOKED_UP.get(node.what, ())]
    # What places the map against odometry looks that up where others send it.
    near = [it for it in near if node.what not in SENT or it.node != node.fqn]
    own = {it.child for it in near if it.robot == robot or it.robot == fleet.models.get(robot)}
    for name in dict.fromkeys(str(it) for it in names if it):
        if not any(connected(near, name, link) for link in own):
            why = f"{node.fqn} looks for {name} on {topic}, where it is not with the robot's links"
            yield Fault(robot, "plans", why)


def two_senders(fleet: Fleet, robot: str) -> Iterator[Fault]:
    """Yield transforms that two nodes of a robot send: the frame jumps from one place to the other."""
    first: dict[tuple[str, str], str] = {}
    for it in one_tree(fleet.edges):
        if it.robot in (robot, fleet.models.get(robot)):
            other = first.setdefault((it.topic, it.child), it.node)
            if other != it.node:
                why = f"{it.child} on {it.topic} is placed by {other} and by {it.node}"
                yield Fault(robot, "plans", why)


def two_parents(fleet: Fleet, robot: str) -> Iterator[Fault]:
    mine = {
        (it.topic, it.child) for it in fleet.edges if it.robot in (robot, fleet.models.get(robot))
    }
    for topic, children in whole(one_tree(fleet.edges)).items():
        for child, parents in children.items():
            if len(parents) > 1 and (topic, child) in mine:
                yield Fault(
                    robot,
                    "plans",
                    f"{child} on {topic} has the parents {', '.join(sorted(parents))}",
                )
    for it in fleet.edges:
        others = {e.robot for e in fleet.edges if (e.topic, e.child) == (it.topic, it.child)} - {
            it.robot
        }
        same = {fleet.models.get(robot), robot}
        if it.robot in same and others - same - {""}:
            yield Fault(
                robot,
                "plans",
                f"{it.child} on {it.topic} is sent by {', '.join(sorted(others))}, too",
            )


def one_tree(edges: Iterable[Edge]) -> list[Edge]:
    """tf's buffer holds static and other transforms in one tree."""
    return [it._replace(topic=moving_of(it.topic)) for it in edges]
