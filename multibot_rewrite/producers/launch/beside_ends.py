# SPDX-License-Identifier: Apache-2.0
"""What launched nodes have besides ends: transforms, frame prefixes, ros2_control interfaces."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.base.rosnames import BoundNode, expand, resolve_bound
from multibot_rewrite.description.readback.xml import root_of
from multibot_rewrite.knowledge.records import MANAGER
from multibot_rewrite.planning.records import Run
from multibot_rewrite.planning.transforms import STATE_PUBLISHER, edges_in, sent_by
from multibot_rewrite.producers.evidence.hardware import claims_of, exported
from multibot_rewrite.producers.launch.bridges import bridged_by
from multibot_rewrite.producers.launch.launched import file_of
from multibot_rewrite.producers.launch.records import LaunchGraph
from multibot_rewrite.producers.launch.running import DESCRIPTION
from multibot_rewrite.system.records import (
    CLAIMS,
    EXPORTS,
    PUBLISHES,
    TOPIC,
    Edge,
    Interface,
    edge_of,
)

TF, TF_STATIC, TF_TYPE = "/tf", "/tf_static", "tf2_msgs/msg/TFMessage"
# The transforms of the simulator, by their topic in it.
Sent = Mapping[str, Sequence[Edge]]


def edges_of(it: Run, bound: BoundNode) -> Iterator[tuple[str, Edge]]:
    """Yield (topic, transform) for what a node sends."""
    sent = [end.name for end in it.fact.endpoints if end.role == PUBLISHES and not end.when]
    whole = publishes_a_tree(it)
    for edge in (tree_of(it) or ()) if whole else _with_prefix(prefix_of(it), sent_by(it.fact, "")):
        topic = TF_STATIC if edge.static else TF
        # A driver may send its odometry on tf_static, and nodes may only have one of the two.
        named = next((name for name in sent if name.strip("/") == topic.strip("/")), "")
        if named:
            yield resolve_bound(named, TOPIC, bound), edge


def passed_on(it: Run, bound: BoundNode, inside: Sent) -> Iterator[tuple[str, Edge]]:
    """Yield (topic, transform) for what a bridge passes on from the simulator."""
    for end, own in bridged_by(it):
        if (end.role, end.type) == (PUBLISHES, TF_TYPE):
            full = resolve_bound(end.name, TOPIC, bound)
            yield from ((full, edge) for edge in inside.get(own, ()))


def _with_prefix(prefix: str, edges: Iterable[Edge]) -> list[Edge]:
    return [edge_of(prefix + it.parent, prefix + it.child, it.static) for it in edges]


def prefix_of(it: Run) -> str:
    """Return the prefix that a node adds to frames (ros_filter.cpp, diff_drive_controller.cpp)."""
    # What its code makes has it already.
    made = any("<tf_prefix=" in end for sent in it.fact.sends for end in sent[:2])
    prefix = None if made else it.value("tf_prefix")
    if switch := it.fact.prefix_switch:
        own = it.value("tf_frame_prefix") or it.namespace
        prefix = "" if it.value(switch) is False else own
    bare = str(prefix or "").strip("/")
    return f"{bare}/" if bare else ""


def publishes_a_tree(it: Run) -> bool:
    """Return whether a node sends the tree of a description."""
    return it.fact.package == STATE_PUBLISHER


def tree_of(it: Run) -> list[Edge] | None:
    """Return the transforms of a description under ``frame_prefix``; None if they are unknown."""
    prefix = str(it.value("frame_prefix") or "")
    root = root_of(it.value(DESCRIPTION))
    return None if root is None else _with_prefix(prefix, edges_in(root))


_DESCRIPTION = "robot_description"


def interfaces_of(
    nodes: Iterable[Run], published: Mapping[str, str], graph: LaunchGraph
) -> Iterator[Interface]:
    """Yield interfaces of controllers whose manager's description is in ``published``, by topic."""
    nodes = [*nodes]
    texts = {it.full_name: _description(it, published) for it in nodes if it.fact.known == MANAGER}
    for manager, text in texts.items():
        root = root_of(text)
        for own in exported(root, file_of(graph, text)) if root is not None else ():
            yield Interface(own.kind, own.name, manager, EXPORTS, own.place)
    known = {it.process for it in nodes if texts.get(it.full_name)}
    for it in nodes:
        if it.process in known and it.fact.is_controller:
            for claim in claims_of(it.fact.claims, it):
                place = claim.place if claim.place and claim.place.file else it.place
                yield Interface(claim.kind, claim.name, it.full_name, CLAIMS, place)


def _description(it: Run, published: Mapping[str, str]) -> str:
    """Return a manager's description: its parameter's, or that on the topic that it reads."""
    given = it.values.get(_DESCRIPTION)
    if given and isinstance(given.value, str) and "<robot" in given.value[:4096]:
        text = given.value
        if "<robot/>" not in text:
            return text
    rules = {old.lstrip("/~"): new for old, new in it.rules}
    topic = rules.get(_DESCRIPTION, _DESCRIPTION)
    return published.get(expand(topic, it.namespace, it.name), "")
