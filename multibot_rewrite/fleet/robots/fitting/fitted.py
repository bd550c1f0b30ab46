# SPDX-License-Identifier: Apache-2.0
"""Settings of a robot's nodes that no file of the robot makes: they fit what its description and its
files have.

What the user's files say stays. A node that a node set adds gets the type of commands, the frames
and the transforms with which it works with them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.fleet.file.robot_spec import RobotSpec
from multibot_rewrite.fleet.robots.fitting.commands import (
    by_way_of_relays,
    driving,
    of_one_type,
    own_mux,
    through_a_mux,
    to_the_drive,
)
from multibot_rewrite.fleet.robots.fitting.node_topics import usual_values
from multibot_rewrite.fleet.robots.fitting.sensors import (
    by_sensor,
    hearing_sensors,
    offered_topics,
    with_odometry,
)
from multibot_rewrite.fleet.robots.fitting.transforms import (
    root_link,
    sent_by_plugins,
    with_root,
    without_second_senders,
)
from multibot_rewrite.fleet.robots.member import Member
from multibot_rewrite.knowledge.records import MOVE_GROUP, TWIST_MUX, NodeFacts
from multibot_rewrite.producers.evidence.filling import sent_with
from multibot_rewrite.spelling.bridged_topics import TF_TYPE
from multibot_rewrite.spelling.records import Run
from multibot_rewrite.system.records import Edge

RVIZ = "rviz2"


class Described(NamedTuple):
    """What a description has for the nodes of its robot: the transforms that its plugins send, the
    topics of its sensors by type, and its root, where a usual link of the body is below it."""

    sent: tuple[Edge, ...]
    offered: Mapping[str, Sequence[str]]
    root: str


def described(member: Member, spec: RobotSpec) -> Described:
    """Return what the description has, under the names that it has there."""
    return Described(sent_by_plugins(member, spec), offered_topics(member, spec), root_link(member))


def free_nodes(own: Iterable[str], given: Iterable[Run]) -> frozenset[str]:
    """Return those of the nodes that no parameter file has a section for: what they are set to is the
    build's to choose."""
    filed = [f"/{it.node}" for it in given]
    return frozenset(it for it in own if not any(one.endswith(f"/{it}") for one in filed))


def fitted(
    nodes: Sequence[NodeFacts],
    own: Collection[str],
    free: Collection[str],
    given: Sequence[Run],
    known: Mapping[str, NodeFacts],
    has: Described,
    spec: RobotSpec,
) -> tuple[NodeFacts, ...]:
    """Return the nodes, those that are ``free`` with the settings that fit the others. ``own`` are
    those that the build starts: what no file sets of them is the build's to set, too."""
    offered = with_odometry(has.offered, nodes)
    settled = []
    for it in nodes:
        if it.name in free:
            hears = hearing_sensors(by_sensor(it, offered), nodes, offered)
            settled.append(_settled(with_root(_as_listed(hears, spec), has.root)))
        else:
            settled.append(it._replace(usual=()))
    muxes = own_mux(settled, own)
    settled = [to_the_drive(it) if it.name in muxes else it for it in settled]
    usual = dict(one for it in nodes if it.name in muxes for one in it.usual)
    if muxes:
        settled = [*through_a_mux(driving(settled, muxes), own, usual, known[TWIST_MUX])]
    routed = by_way_of_relays(driving(settled, own), own)
    typed = of_one_type(routed, own, free, given, known, spec)
    return tuple(without_second_senders(typed, free, has.sent))


def _as_listed(node: NodeFacts, spec: RobotSpec) -> NodeFacts:
    """Return the node without the names that it makes of a list which no file gives it: they may come,
    if a file is added. So may those of the panels and displays that RViz has in its usual file, where
    the robot has another one."""
    if node.kind == MOVE_GROUP and spec.companions.get("moveit"):
        return node
    shows = node.kind == RVIZ and bool(spec.companions.get("rviz"))
    ends = []
    for it in node.endpoints:
        # It is made at run time, in the namespace of its robot; an absolute one all would share.
        is_made_below = "<" in it.name and not it.name.startswith("/")
        may_come = is_made_below or (shows and it.type != TF_TYPE)
        ends.append(it._replace(when="open: file") if may_come and not it.when else it)
    return node._replace(endpoints=tuple(ends))


def _settled(node: NodeFacts) -> NodeFacts:
    """Return the node as the parameters of its node set make it."""
    if not node.usual:
        return node
    values = usual_values(node)
    frames = tuple(
        it._replace(default=str(values[it.parameter].value), given=True)
        if it.parameter in values
        else it
        for it in node.frames
    )
    with_them = node._replace(frames=frames)
    return with_them._replace(sends=tuple(sent_with(with_them, values)))
