# SPDX-License-Identifier: Apache-2.0
"""Dangers of what is between a sender and a robot: relays to another robot, limits left out."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.base.conventions import chooses
from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.rules.declaration import system_rule
from multibot_rewrite.system import words
from multibot_rewrite.system.index import Ends, Index, at_work, nodes_of, once
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, TOPIC
from multibot_rewrite.system.tool_nodes import last_word

# Of Nav2, between its controller and the robot: they limit velocities, and stop before obstacles.
_LIMITS = ("velocity_smoother", "collision_monitor")
_CONTROLLER = "controller_server"
_BRIDGE = lazy_compile("bridge|gz|gazebo|isaac|webots|zenoh|domain|free_fleet")


@system_rule(
    "MG314",
    "relayed-to-another-robot",
    ERROR,
    meant=(PUBLISHES,),
    what="A node of no robot, such as a relay or bridge, reads data of one robot and publishes it "
    "as data of another. The data are commands, or what the robot measures.",
    why="Who drives the one robot moves the other, or one is localized with the scan of the other.",
    fix="Correct the robot's name in the topics of the relay. Where one robot is meant to do what the"
    " other does, write the relay into the plan.",
    bad="""\
running: /robot1/driver subscribes /robot1/cmd_vel geometry_msgs/msg/Twist
running: /robot2/driver subscribes /robot2/cmd_vel geometry_msgs/msg/Twist
running: /relay subscribes /robot1/cmd_vel geometry_msgs/msg/Twist
running: /relay publishes /robot2/cmd_vel geometry_msgs/msg/Twist
""",
    good="""\
running: /robot1/driver subscribes /robot1/cmd_vel geometry_msgs/msg/Twist
running: /relay subscribes /robot1/joy_vel geometry_msgs/msg/Twist
running: /relay publishes /robot1/cmd_vel geometry_msgs/msg/Twist
""",
    line=4,
)
def relayed_to_another_robot(seen: Index) -> Iterator[Finding]:
    """Who also publishes what it reads is a bridge of all robots to another network."""
    read = {
        (end.node, seen.plain(ends.name)): ends
        for ends in _of_bodies(seen)
        for end in at_work(ends.subscribers)
        if not seen.robot(end.node)
    }
    for ends in _of_bodies(seen):
        for node in nodes_of(ends.publishers):
            source = read.get((node, seen.plain(ends.name)))
            if source is None or node in nodes_of(ends.subscribers):
                continue
            owner, other = seen.robot(source.name), seen.robot(ends.name)
            yield relayed_to_another_robot.finding(
                f"reads {source.name} of {owner} and publishes {ends.name} of {other}",
                f"a name in its topics is wrong: {other} gets what is of {owner}",
                robot=other,
                node=node,
                names=(ends.name,),
            )


@once
def _of_bodies(seen: Index) -> Sequence[Ends]:
    """The robots' topics with commands, and with what a body measures."""
    return [
        it
        for it in seen.by_name.values()
        if it.kind == TOPIC
        and (words.is_of_a_body(it.type) or words.moves(seen.plain(it.name), it.type))
        and seen.robot(it.name)
    ]


@system_rule(
    "MG315",
    "limits-left-out",
    ERROR,
    meant=(PUBLISHES, SUBSCRIBES),
    what="Nav2's controller_server sends velocities on the topic on which velocity_smoother or "
    "collision_monitor sends them, after it has limited them. Or a driver reads an input of "
    "twist_mux, and no node reads its output.",
    why="The robot obeys what was not limited or chosen: nothing stops it before an obstacle.",
    fix="Pass the remap rule cmd_vel:=cmd_vel_nav to controller_server, as Nav2's launch files do; give"
    " the driver the output of twist_mux.",
    bad="""\
running: /robot1/controller_server publishes /robot1/cmd_vel geometry_msgs/msg/Twist
running: /robot1/collision_monitor subscribes /robot1/cmd_vel_smoothed geometry_msgs/msg/Twist
running: /robot1/collision_monitor publishes /robot1/cmd_vel geometry_msgs/msg/Twist
""",
    good="""\
running: /robot1/controller_server publishes /robot1/cmd_vel_nav geometry_msgs/msg/Twist
running: /robot1/collision_monitor subscribes /robot1/cmd_vel_nav geometry_msgs/msg/Twist
running: /robot1/collision_monitor publishes /robot1/cmd_vel geometry_msgs/msg/Twist
""",
)
def limits_left_out(seen: Index) -> Iterator[Finding]:
    """docking_server sends beside collision_monitor, as it is made."""
    yield from _mux_left_out(seen)
    for ends in _velocities(seen):
        nodes = nodes_of(ends.publishers)
        limits = [it for it in nodes if last_word(it) in _LIMITS]
        for node in nodes if limits else ():
            if last_word(node) == _CONTROLLER:
                yield limits_left_out.finding(
                    f"publishes {ends.name} beside {limits[0]}, which is to limit it",
                    "pass it the rule cmd_vel:=cmd_vel_nav, so that velocity_smoother reads it first",
                    robot=seen.robot(node),
                    node=node,
                    names=(ends.name,),
                )


def _mux_left_out(seen: Index) -> Iterator[Finding]:
    """A driver that reads an input of a mux whose output no node reads."""
    chosen = [it for it in _velocities(seen) if not at_work(it.subscribers)]
    for ends in chosen:
        for mux in filter(chooses, nodes_of(ends.publishers)):
            for given in _velocities(seen):
                readers = nodes_of(at_work(given.subscribers))
                drivers = [it for it in readers if it != mux and _word(seen, it) not in _LIMITS]
                if mux in readers and drivers and given.publishers:
                    yield limits_left_out.finding(
                        f"obeys {given.name}, an input of {mux}; no node reads its output {ends.name}",
                        f"pass it the rule {_word(seen, given.name)}:={_word(seen, ends.name)}",
                        robot=seen.robot(drivers[0]),
                        node=drivers[0],
                        names=(given.name, ends.name),
                    )


def _word(seen: Index, name: str) -> str:
    return last_word(seen.plain(name))


def _velocities(seen: Index) -> Iterator[Ends]:
    return (it for it in seen.orders.values() if words.moves(seen.plain(it.name), it.type))


@system_rule(
    "MG329",
    "data-in-a-circle",
    ERROR,
    meant=(PUBLISHES, SUBSCRIBES),
    what="A node reads velocities, odometry, a scan or IMU data on the topic on which it sends "
    "them. Or one relay gives them to a second one, which sends them back.",
    why="Each message comes round again: a filter believes itself, a command never ends.",
    fix="Let it read, or send, on another topic: the remap rule of one of the two names.",
    bad="""\
running: /ekf subscribes /odometry/filtered nav_msgs/msg/Odometry
running: /ekf publishes /odometry/filtered nav_msgs/msg/Odometry
""",
    good="""\
running: /ekf subscribes /odom nav_msgs/msg/Odometry
running: /ekf publishes /odometry/filtered nav_msgs/msg/Odometry
""",
    line=2,
)
def data_in_a_circle(seen: Index) -> Iterator[Finding]:
    """A bridge reads and sends each of its topics, as it is made. Joints come from several."""
    passed: dict[tuple[str, str], tuple[str, Ends]] = {}
    for node, (read, sent) in _passing(seen).items():
        both = [it for it in read if it in sent]
        # With several it is a bridge, whatever it is called.
        for ends in both if len(both) == 1 else ():
            yield data_in_a_circle.finding(
                f"reads {ends.name}, on which it sends",
                "let it read, or send, on another topic",
                robot=seen.robot(node), node=node, names=(ends.name,),
            )  # fmt: skip
        if len(read) == len(sent) == 1 and not both:
            passed[read[0].name, sent[0].name] = node, sent[0]
    for (source, given), (node, sent_) in passed.items():
        other, back = passed.get((given, source), ("", sent_))
        # Of the two it is the one that sends where others send as well.
        if other and (len(sent_.publishers), given) > (len(back.publishers), source):
            yield data_in_a_circle.finding(
                f"sends {given} of what {other} makes of {given}",
                "one of the two has to send on another topic",
                robot=seen.robot(node), node=node, names=(given,),
            )  # fmt: skip


def _passing(seen: Index) -> Mapping[str, tuple[list[Ends], list[Ends]]]:
    """The topics of such data that each node reads and sends, of nodes that do both."""
    found: dict[str, tuple[list[Ends], list[Ends]]] = defaultdict(lambda: ([], []))
    for ends in seen.topics:
        body = words.is_of_a_body(ends.type) and ends.type != words.JOINTS
        if body or words.moves(seen.plain(ends.name), ends.type):
            for at, side in enumerate((ends.subscribers, ends.publishers)):
                for node in nodes_of(at_work(side)):
                    found[node][at].append(ends)
    own = {it: both for it, both in found.items() if all(both) and not _is_bridge(it)}
    return {it: (read, sent) for it, (read, sent) in own.items() if read[0].type == sent[0].type}


def _is_bridge(node: str) -> bool:
    """Does it hold several networks, or a simulator, together?"""
    return bool(_BRIDGE.search(last_word(node)))
