# SPDX-License-Identifier: Apache-2.0
"""NoDL documents -> facts of nodes, above those of the library.

A document cannot say everything: conditions, helper nodes, which names an image_transport adds, the
launch file's own rules. These stay from the library where it knows the same endpoint.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.rosnames import expand
from multibot_rewrite.knowledge.conditions import NODL, OPEN_KIND
from multibot_rewrite.knowledge.node_library import NodeLibrary, stack_of
from multibot_rewrite.knowledge.nodl.document import Document, Parameter
from multibot_rewrite.knowledge.nodl.lookup import (
    Identity,
    Interfaces,
    file_of,
    identities,
    load,
    shown,
)
from multibot_rewrite.knowledge.records import TRANSPORTS, Endpoint, FrameParameter, NodeFacts
from multibot_rewrite.system.records import SERVES, SERVICE, SUBSCRIBES, TOPIC

EVERY_NODE = "every_node"
# An endpoint of the library alone keeps its rule, and is not asked for: the document may be partial.
NOT_IN_NODL = f"{OPEN_KIND}: {NODL}"
TYPE_DESCRIPTION = Endpoint(SERVICE, SERVES, "~/get_type_description")
_TF = ("/tf", "/tf_static")
_TF_TYPE = "tf2_msgs/msg/TFMessage"
_IMAGE = "sensor_msgs/msg/Image"
_FRAME = lazy_compile(r"(?:.*[._])?frame(?:_id)?")


class _Slot(NamedTuple):
    """What an endpoint is called from outside, for a node in the root namespace."""

    kind: str
    role: str
    name: str


class NodeKnowledge(NamedTuple):
    """What is known of nodes: a library, NoDL documents above it, and above both the nodes that the
    user's own file describes (``own``, by name), which the library has."""

    library: NodeLibrary
    interfaces: Interfaces
    own: frozenset[str] = frozenset()


def nodes_of(known: NodeKnowledge, stack: str) -> Iterator[NodeFacts]:
    """The nodes of a stack, each as its NoDL document says where there is one.

    A name that is no stack of the library may be that of a document. Raises UsageError.
    """
    library = known.library
    alone = None if stack in library.stacks or stack in library.nodes else _alone(known, stack)
    yield from [alone] if alone else (declared(known, it) for it in stack_of(library, stack))


def declared(known: NodeKnowledge, node: NodeFacts) -> NodeFacts:
    """The node as its NoDL document says; itself where there is none. Raises UsageError."""
    usual = node.kind
    if usual in known.own:
        return node
    names = dict.fromkeys((node.name, *node.programs, usual))
    found = (file_of(known.interfaces, Identity(node.package, name)) for name in names)
    file = next(filter(None, found), "")
    if not file:
        return node
    return _merged(node, usual, load(file, known.interfaces), known.library.parts)


def _alone(known: NodeKnowledge, name: str) -> NodeFacts | None:
    """A node that only a document describes; its name may be given as ``package/name``."""
    found = [it for it in sorted(identities(known.interfaces)) if name in (it.name, shown(it))]
    if len(found) > 1:
        both = " or ".join(map(shown, found))
        raise UsageError(f"stack {name!r} may be {both}; name one of them")
    if not found:
        return None
    bare = NodeFacts(found[0].name, found[0].package, ())
    document = load(file_of(known.interfaces, found[0]), known.interfaces)
    return _merged(bare, bare.name, document, known.library.parts)


def _merged(
    node: NodeFacts,
    usual: str,
    document: Document,
    parts: Mapping[str, tuple[Endpoint, ...]],
) -> NodeFacts:
    ours = {_slot(end, usual): end for end in reversed(node.endpoints)}
    theirs = {_slot(end, usual): end for end in _folded(_own(document.endpoints, parts))}
    ends = [_both(end, ours.get(slot)) for slot, end in theirs.items()]
    for end in node.endpoints:
        if _slot(end, usual) not in theirs:
            ends.append(end._replace(when=end.when or NOT_IN_NODL))
    return node._replace(
        endpoints=tuple(ends),
        frames=tuple(_frames(node, document.parameters)),
        interface=document.file,
    )


def _slot(end: Endpoint, node: str) -> _Slot:
    above, _, own = node.rpartition("/")
    name = end.name if "<" in end.name else expand(end.name, f"/{above}", own)
    return _Slot(end.kind, end.role, name)


def _own(ends: Iterable[Endpoint], parts: Mapping[str, tuple[Endpoint, ...]]) -> Iterator[Endpoint]:
    """The endpoints without those that ROS gives every node."""
    usual = {(it.role, _last(it)) for it in (*parts.get(EVERY_NODE, ()), TYPE_DESCRIPTION)}
    yield from (end for end in ends if (end.role, _last(end)) not in usual)


def _last(end: Endpoint) -> str:
    return end.name.rpartition("/")[2]


def _folded(ends: Iterable[Endpoint]) -> Iterator[Endpoint]:
    """An image and its image_transport topics as one; tf may be heard by a helper node."""
    found = list(ends)
    topics = {(end.role, end.name) for end in found if end.kind == TOPIC}
    images = {
        (end.role, end.name)
        for end in found
        if end.type == _IMAGE and any((end.role, f"{end.name}/{it}") in topics for it in TRANSPORTS)
    }
    for end in found:
        base, _, last = end.name.rpartition("/")
        if last in TRANSPORTS and (end.role, base) in images:
            continue
        heard = end.role == SUBSCRIBES and end.name in _TF and end.type == _TF_TYPE
        yield end._replace(transport=(end.role, end.name) in images, helper=heard)


def _both(end: Endpoint, ours: Endpoint | None) -> Endpoint:
    """The endpoint of a document with what the library knows besides of it."""
    if ours is None:
        return end
    # A document made from a running node has a private name in full.
    name = ours.name if ours.name.startswith("~") else end.name
    also = tuple(dict.fromkeys(it for it in (*end.also, *ours.also) if it != end.type))
    return ours._replace(name=name, type=end.type, also=also, source=end.source)


def _frames(node: NodeFacts, parameters: Iterable[Parameter]) -> Iterator[FrameParameter]:
    """The frame ids in parameters: those the library names, by their names otherwise."""
    given = {it.name: it.default for it in parameters if it.type == "string" and it.default}
    if node.frames or node.sends:
        yield from (it._replace(default=given.get(it.parameter, it.default)) for it in node.frames)
        return
    yield from (FrameParameter(*it) for it in given.items() if _FRAME.fullmatch(it[0]))
