# SPDX-License-Identifier: Apache-2.0
"""Dangers of what is between a sender and a robot: relays to another robot, limits left out."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.base.conventions import chooses
from multibot_rewrite.base.findings.finding import ERROR, Finding, Remap
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.rules.declaration import system_rule
from multibot_rewrite.rules.system.commands import LIMITS
from multibot_rewrite.system import words
from multibot_rewrite.system.index import Ends, Index, at_work, nodes_of, once
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES
from multibot_rewrite.system.words import last_word

# What holds several networks, or a simulator, together.
_BRIDGE = lazy_compile("bridge|gz|gazebo|isaac|webots|zenoh|domain|free_fleet")


@system_rule("MG314", "relayed-to-another-robot", ERROR, meant=(PUBLISHES,))
def relayed_to_another_robot(seen: Index) -> Iterator[Finding]:
    """Report relays, except a node that also publishes what it reads: a bridge to another network."""
    read = {
        (end.node, seen.plain(ends.name)): ends
        for ends in _body_topics(seen)
        for end in at_work(ends.subscribers)
        if not seen.robot(end.node)
    }
    for ends in _body_topics(seen):
        for node in nodes_of(ends.publishers):
            source = read.get((node, seen.plain(ends.name)))
            if source is None or node in nodes_of(ends.subscribers):
                continue
            owner, other = seen.robot(source.name), seen.robot(ends.name)
            yield relayed_to_another_robot.finding(
                f"reads {source.name} of {owner} and publishes {ends.name} of {other}",
                f"correct one of the two topics: {other} gets the data of {owner}",
                robot=other, node=node, names=(ends.name,),
            )  # fmt: skip


@once
def _body_topics(seen: Index) -> Sequence[Ends]:
    """Return the robots' topics for commands and for sensor data."""
    return [
        it
        for it in seen.topics
        if (words.is_of_a_body(it.type) or words.moves(seen.plain(it.name), it.type))
        and seen.robot(it.name)
    ]


@system_rule("MG315", "limits-left-out", ERROR, meant=(PUBLISHES, SUBSCRIBES))
def limits_left_out(seen: Index) -> Iterator[Finding]:
    """Yield nodes that send past what limits commands, except docking_server: it is meant to."""
    yield from _mux_left_out(seen)
    for ends in _velocities(seen):
        nodes = nodes_of(ends.publishers)
        limits = [it for it in nodes if last_word(it) in LIMITS]
        for node in nodes if limits else ():
            if last_word(node) == "controller_server":
                yield limits_left_out.finding(
                    f"publishes {ends.name}, and so does {limits[0]}, which should limit it",
                    "pass it the rule cmd_vel:=cmd_vel_nav, so that velocity_smoother reads it first",
                    robot=seen.robot(node), node=node, names=(ends.name,),
                    remaps=(Remap(node, ends.name, f"{ends.name.rpartition('/')[0]}/cmd_vel_nav"),),
                )  # fmt: skip


def _mux_left_out(seen: Index) -> Iterator[Finding]:
    """Yield drivers that read an input of a mux whose output no node reads."""
    chosen = [it for it in _velocities(seen) if not at_work(it.subscribers)]
    for ends in chosen:
        for mux in filter(chooses, nodes_of(ends.publishers)):
            for given in _velocities(seen):
                readers = nodes_of(at_work(given.subscribers))
                drivers = [it for it in readers if it != mux and _tail(seen, it) not in LIMITS]
                if mux in readers and drivers and given.publishers:
                    yield limits_left_out.finding(
                        f"obeys {given.name}, an input of {mux}; no node reads its output {ends.name}",
                        f"pass it the rule {_tail(seen, given.name)}:={_tail(seen, ends.name)}",
                        robot=seen.robot(drivers[0]), node=drivers[0], names=(given.name, ends.name),
                        remaps=tuple(Remap(it, given.name, ends.name) for it in drivers),
                    )  # fmt: skip


def _tail(seen: Index, name: str) -> str:
    """Return the last word of a name without its robot's."""
    return last_word(seen.plain(name))


def _velocities(seen: Index) -> Iterator[Ends]:
    return (it for it in seen.orders.values() if words.moves(seen.plain(it.name), it.type))


@system_rule("MG329", "data-in-a-circle", ERROR, meant=(PUBLISHES, SUBSCRIBES))
def data_in_a_circle(seen: Index) -> Iterator[Finding]:
    """Yield nodes that read what they send, alone or as a pair; bridges and joint states excepted."""
    passed: dict[tuple[str, str], tuple[str, Ends]] = {}
    for node, (read, sent) in _passed_topics(seen).items():
        both = [it for it in read if it in sent]
        # With several it is a bridge, whatever it is called.
        for ends in both if len(both) == 1 else ():
            yield data_in_a_circle.finding(
                f"reads {ends.name}, on which it sends",
                "remap its input or its output to another topic",
                robot=seen.robot(node), node=node, names=(ends.name,),
            )  # fmt: skip
        if len(read) == len(sent) == 1 and not both:
            passed[read[0].name, sent[0].name] = node, sent[0]
    for (source, given), (node, sent_) in passed.items():
        other, back = passed.get((given, source), ("", sent_))
        # Of the two it is the one that sends where others send as well.
        if other and (len(sent_.publishers), given) > (len(back.publishers), source):
            yield data_in_a_circle.finding(
                f"makes {given} from {source}, and {other} makes {source} from {given}",
                "let one of the two publish on another topic",
                robot=seen.robot(node), node=node, names=(given,),
            )  # fmt: skip


def _passed_topics(seen: Index) -> Mapping[str, tuple[list[Ends], list[Ends]]]:
    """Return by node (topics read, topics sent) of commands and sensors, if it does both."""
    found: dict[str, tuple[list[Ends], list[Ends]]] = defaultdict(lambda: ([], []))
    for ends in seen.topics:
        body = words.is_of_a_body(ends.type) and ends.type != words.JOINTS
        if body or words.moves(seen.plain(ends.name), ends.type):
            for at, side in enumerate((ends.subscribers, ends.publishers)):
                for node in nodes_of(at_work(side)):
                    found[node][at].append(ends)
    own = {it: both for it, both in found.items() if all(both)}
    return {
        it: (read, sent)
        for it, (read, sent) in own.items()
        if read[0].type == sent[0].type and not _BRIDGE.search(_tail(seen, it))
    }
