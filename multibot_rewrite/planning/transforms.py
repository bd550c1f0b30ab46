# SPDX-License-Identifier: Apache-2.0
"""The tf frames of a robot, and which of its nodes sends them: description, odometry, map."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING

from multibot_rewrite.base.grouping import chain_ends
from multibot_rewrite.base.naming import Naming, spelled
from multibot_rewrite.knowledge.conditions import holds
from multibot_rewrite.system.records import PUBLISHES, Edge, edge_of

if TYPE_CHECKING:
    from lxml.etree import _Element

    from multibot_rewrite.description.steps.collect import Inventory
    from multibot_rewrite.knowledge.records import NodeFacts

STATE_PUBLISHER = "robot_state_publisher"
NO_PLAIN: Mapping[tuple[str, str], str] = {}


Edges = Mapping[tuple[str, str], Sequence[Edge]]


def edges_of(
    robot: str,
    inventory: Inventory,
    facts: Iterable[NodeFacts],
    plugins: Iterable[NodeFacts],
    naming: Naming,
    word: str = "",
    plain: Mapping[tuple[str, str], str] = NO_PLAIN,
) -> dict[tuple[str, str], list[Edge]]:
    """Return the transforms that a robot's nodes send, by robot and node: description, odometry, map.

    ``word`` is the robot's name in its frames, empty if that is its name; ``plain`` are links from
    xacro arguments that nodes name differently.
    """
    tree = list(tree_of(inventory, naming, word or robot))
    children = {edge.child for edge in tree}
    links = links_of(inventory, naming, word or robot)
    root = next((link for link in links if link not in children), "")
    by_naming = partial(spelled, naming, word or robot, "frame")
    result = {(robot, node.name): [*sent_by(node, "")] for node in plugins}
    nodes = tuple(facts)
    # What code makes of a frame that robots share, as map_ned of map.
    shared = tuple(f"<{it}_frame=" for it in naming.shared_frames)
    described = state_publisher_of(nodes)
    for node in nodes:
        named = _named_once(by_naming) if _is_static(node) else by_naming
        frames = [
            frame._replace(default=plain.get(("link", frame.default)) or named(frame.default))
            if frame.default
            and not (frame.in_code or frame.is_kept or frame.parameter.startswith(shared))
            else frame
            for frame in node.frames
        ]
        own = [*sent_by(node._replace(frames=tuple(frames)), root)]
        result[robot, node.name] = tree if node.name == described else own
    return result


def state_publisher_of(nodes: Sequence[NodeFacts]) -> str:
    """Return the node that sends the robot's own description (not that of a dock); or empty."""
    found = [node.name for node in nodes if node.package == STATE_PUBLISHER]
    return STATE_PUBLISHER if STATE_PUBLISHER in found else next(iter(found), "")


def _named_once(by_naming: Callable[[str], str]) -> Callable[[str], str]:
    """Return ``by_naming`` as a function that keeps a frame which has the robot's name already."""
    own = by_naming("x").removesuffix("x")
    return lambda frame: frame if own and frame.startswith(own) else by_naming(frame)


def tree_of(inventory: Inventory, naming: Naming, robot: str) -> Iterator[Edge]:
    """Yield the transforms that a robot's robot_state_publisher sends for its rewritten description."""
    for it in edges_in(inventory.document.root):
        parent, child = (at_run_time(naming, robot, link) for link in (it.parent, it.child))
        yield it._replace(parent=parent, child=child)


def links_of(inventory: Inventory, naming: Naming, robot: str) -> list[str]:
    """Return a description's links as frames on tf; those below ``<gazebo>`` are in none."""
    root = inventory.document.root
    own = [it.get("name", "") for it in root.iterfind("link")]
    links = own if root.tag == "robot" else inventory.declared["link"]
    return [at_run_time(naming, robot, link) for link in links]


def at_run_time(naming: Naming, robot: str, link: str) -> str:
    """Return the frame of a link: nodes may put the robot's name before it."""
    return spelled(naming, robot, "frame", link) if naming.layout.at_run_time else link


def edges_in(root: _Element) -> Iterator[Edge]:
    """Yield the transforms that robot_state_publisher sends for the joints of a description."""
    yield from (it for _, it in tree_joints(root))


def tree_joints(root: _Element) -> Iterator[tuple[_Element, Edge]]:
    """Yield the joints of the tree, each with its transform.

    A frame of an SDF is the link that it is attached to; a joint below ``<gazebo>`` is for the
    simulator alone. Of two with one child the last by name counts (urdfdom_headers model.h
    initTree)."""
    frames = ((it.get("name", ""), it.get("attached_to", "")) for it in root.iter("frame"))
    attached = chain_ends({name: attached_to for name, attached_to in frames if attached_to})
    found: list[tuple[_Element, Edge]] = []
    for joint in root.iterfind("joint") if root.tag == "robot" else root.iter("joint"):
        ends = [joint.find(tag) for tag in ("parent", "child")]
        names = [(end.get("link") or end.text or "").strip() for end in ends if end is not None]
        if len(names) == 2:
            parent, child = (attached.get(name) or name for name in names)
            found.append((joint, edge_of(parent, child, joint.get("type") == "fixed")))
    by_name = sorted(found, key=lambda it: it[0].get("name", ""))
    last = {it.child: joint for joint, it in by_name}
    yield from ((joint, it) for joint, it in found if last[it.child] is joint)


def sent_by(node: NodeFacts, root: str) -> Iterator[Edge]:
    """Yield the transforms that a node's parameters name.

    With ``root`` that frame is the child, except for odometry frames and those that a file sets.
    """
    # tf2 takes a slash in front away (buffer_core.cpp, stripSlash).
    values = {frame.parameter: frame.default.lstrip("/") for frame in node.frames}
    given = {frame.parameter for frame in node.frames if frame.given}
    static = _is_static(node)
    for parent, child, _, fixed in (it for it in node.sends if holds(it.condition, values.get)):
        odometry = "odom" in f"{child} {values[child]}"
        base = root and not (fixed or odometry or child in given)
        edge = edge_of(values[parent], root if base else values[child], static or fixed)
        # A frame that only a file sets; a frame below itself, which tf2 refuses (buffer_core.cpp).
        if edge.parent not in ("", edge.child) and "<" not in edge.child:
            yield edge


def _is_static(node: NodeFacts) -> bool:
    """Return whether a node only sends static transforms."""
    sent = {it.name.strip("/") for it in node.endpoints if it.role == PUBLISHES}
    return "tf_static" in sent and "tf" not in sent


def with_odometry(edges: Edges, robot: str, naming: Naming) -> tuple[Edges, str]:
    """Add odom -> base for a robot whose nodes are not known to send odometry: its driver does.

    Also returns the added transform as ``parent -> child``; empty where none is added, as for an
    arm that is fixed to the world.
    """
    state = (robot, STATE_PUBLISHER)
    tree = edges.get(state, ())
    others = [it for key, own in edges.items() if key[0] == robot and key != state for it in own]
    children = {edge.child for edge in (*tree, *others)}
    roots = {edge.parent for edge in tree} - children - naming.shared_frames
    loose = {edge.child for edge in others} - {edge.parent for edge in (*tree, *others)}
    if len(roots) != 1 or len(loose) != 1:
        return edges, ""
    added = edge_of(loose.pop(), roots.pop())
    return {**edges, state: [*tree, added]}, f"{added.parent} -> {added.child}"


def frames_of(
    inventory: Inventory, sent: Iterable[Edge], naming: Naming, robot: str
) -> tuple[str, ...]:
    """Return a robot's own frames: those of its description, and those that its nodes also send.

    A ``<frame>`` of an SDF is not on tf: sdformat_urdf (jazzy, sdformat_urdf.cpp) makes a URDF of links
    and joints. Nor is a link without a joint if others have one, as that of a model in the model.
    """
    links = links_of(inventory, naming, robot)
    ends = [frame for edge in sent for frame in (edge.parent, edge.child)]
    if inventory.document.root.tag == "sdf":
        joined = [it for it in links if it in ends]
        declared = joined or links[:1]
    else:
        declared = [*links, *inventory.declared["frame"]]
    frames = dict.fromkeys((*declared, *ends))
    return tuple(frame for frame in frames if frame not in naming.shared_frames)
