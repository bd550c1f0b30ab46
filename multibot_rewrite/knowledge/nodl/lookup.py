# SPDX-License-Identifier: Apache-2.0
"""The NoDL documents in the ament index, in files and in folders, and what they say of nodes.

A document does not say which node it is for; its place does. In the ament index it is the resource
``nodl/<package>__<name>`` (ament_nodl_register.cmake, ament_resolver.py of ros-tooling/nodl).

It cannot say everything: conditions, helper nodes, which names an image_transport adds, the launch
file's own rules. These stay from the library where it knows the same endpoint."""

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.bounded import read_text
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.rosnames import expand
from multibot_rewrite.knowledge.conditions import NODL, OPEN_KIND
from multibot_rewrite.knowledge.node_library import NodeLibrary, nodes_of_set
from multibot_rewrite.knowledge.nodl.document import Document, Include, Parameter, parse
from multibot_rewrite.knowledge.records import TRANSPORTS, Endpoint, FrameParameter, NodeFacts
from multibot_rewrite.system.records import SERVES, SERVICE, SUBSCRIBES, TOPIC

INDEX = os.path.join("share", "ament_index", "resource_index", "nodl")
SUFFIXES = (".nodl.yaml", ".nodl.yml", ".nodl.json")
# In place of files and folders: use no document at all.
NO_DOCUMENTS = "none"
MAX_FILES = 20_000
_BETWEEN = "__"
_PACKAGE_NAME = lazy_compile(r"<name>\s*([^<\s]+)\s*</name>")
_LOCAL, _INDEXED = "local://", "nodl://"


class Identity(NamedTuple):
    """The node that a document is for; ``package`` is empty where its place does not tell."""

    package: str
    name: str


class Interfaces(NamedTuple):
    """The documents there are: those ``given`` come before those in the folders ``installed``."""

    given: Mapping[Identity, str]
    installed: tuple[str, ...]


NONE = Interfaces({}, ())


def find_interfaces(paths: Sequence[str]) -> Interfaces:
    """Return the documents below ``paths`` and those of installed packages; raises UsageError.

    A path is a file, a folder of files or a folder where packages are installed; with ``none``
    there are no documents at all."""
    if tuple(paths) == (NO_DOCUMENTS,):
        return NONE
    given: dict[Identity, str] = {}
    for path in paths:
        for identity, file in _documents_below(path):
            first = given.setdefault(identity, file)
            if os.path.realpath(first) != os.path.realpath(file):
                both = f"{first} and {file}"
                raise UsageError(f"two interfaces of {shown(identity)}: {both}; leave one out")
    prefixes = filter(None, os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep))
    return Interfaces(given, tuple(os.path.join(it, INDEX) for it in prefixes))


def shown(identity: Identity) -> str:
    """Return an identity as a user writes it."""
    return "/".join(filter(None, identity))


def _documents_below(path: str) -> Iterator[tuple[Identity, str]]:
    if os.path.isfile(path):
        yield _identity(path, os.path.dirname(path)), path
        return
    if not os.path.isdir(path):
        raise UsageError(f"{path}: does not exist; name a NoDL file or a folder of them")
    index = os.path.join(path, INDEX)
    found = sorted(
        _documents_in_index(index) if os.path.isdir(index) else _documents_in_folder(path)
    )
    if not found:
        raise UsageError(f"{path}: there is no NoDL file (*.nodl.yaml) in this folder")
    yield from found


def _documents_in_index(index: str) -> Iterator[tuple[Identity, str]]:
    for key in os.listdir(index):
        package, between, name = key.partition(_BETWEEN)
        if between and os.path.isfile(os.path.join(index, key)):
            yield Identity(package, name), os.path.join(index, key)


def _documents_in_folder(folder: str) -> Iterator[tuple[Identity, str]]:
    seen = 0
    for place, folders, names in os.walk(folder):
        folders[:] = (it for it in folders if not it.startswith("."))
        seen += len(names)
        if seen > MAX_FILES:
            raise UsageError(f"{folder}: over {MAX_FILES} files; name the folder of the NoDL files")
        for path in (os.path.join(place, it) for it in names if it.endswith(SUFFIXES)):
            yield _identity(path, folder), path


def _identity(path: str, folder: str) -> Identity:
    """Return the node of a document by its file name, the folders above and the package it is in."""
    name = os.path.basename(path)
    ending = next((it for it in (*SUFFIXES, os.path.splitext(name)[1]) if name.endswith(it)), "")
    stem = name.removesuffix(ending)
    package, between, own = stem.partition(_BETWEEN)
    if between and package:
        return Identity(package, own)
    package = _package_of(path)
    if package:
        return Identity(package, stem)
    below = os.path.relpath(path, folder or ".").removesuffix(ending)
    return Identity("", below.replace(os.sep, "/"))


def _package_of(path: str) -> str:
    """Return the package whose folder the file is in; empty without one."""
    folder = os.path.dirname(os.path.abspath(path))
    while folder != os.path.dirname(folder):
        try:
            found = _PACKAGE_NAME.search(read_text(os.path.join(folder, "package.xml")))
            return found[1] if found else ""
        except (OSError, ValueError):
            folder = os.path.dirname(folder)
    return ""


def file_of(interfaces: Interfaces, identity: Identity) -> str:
    """Return the document of a node; empty if there is none."""
    for wanted in (identity, Identity("", identity.name)):
        if wanted in interfaces.given:
            return interfaces.given[wanted]
    if not identity.package or os.sep in identity.name:
        return ""
    key = f"{identity.package}{_BETWEEN}{identity.name}"
    found = (os.path.join(folder, key) for folder in interfaces.installed)
    return next(filter(os.path.isfile, found), "")


def identities(interfaces: Interfaces) -> set[Identity]:
    """Return all nodes that have a document."""
    folders = filter(os.path.isdir, interfaces.installed)
    return {*interfaces.given, *(it for folder in folders for it, _ in _documents_in_index(folder))}


def load(path: str, interfaces: Interfaces) -> Document:
    """Return a document with all that it includes; raises UsageError with file and line."""
    seen = {os.path.realpath(path): path}
    documents = list(_with_included(path, interfaces, seen))
    names: dict[tuple[str, str, str], str] = {}
    for document in documents:
        ends = ((end.role, end.kind, end.name) for end in document.endpoints)
        for key in (*ends, *(("", "parameter", it.name) for it in document.parameters)):
            first = names.setdefault(key, document.file)
            if first != document.file:
                what = " ".join(filter(None, key))
                raise UsageError(f"{document.file}: {what} is in {first} too, which includes it")
    return Document(
        path,
        tuple(end for it in documents for end in it.endpoints),
        tuple(parameter for it in documents for parameter in it.parameters),
    )


def _with_included(path: str, interfaces: Interfaces, seen: dict[str, str]) -> Iterator[Document]:
    """Yield a document and those that it includes; raises UsageError."""
    try:
        document = parse(read_text(path), path)
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise UsageError(f"{path}: cannot be read: it is not UTF-8; save it as UTF-8") from None
    yield document
    for include in document.includes:
        other = _resolved_include(include, path, interfaces)
        real = os.path.realpath(other)
        if real in seen:
            raise UsageError(
                f"{include.where}: {include.ref} is included twice; remove one include"
            )
        seen[real] = other
        yield from _with_included(other, interfaces, seen)


def _resolved_include(include: Include, path: str, interfaces: Interfaces) -> str:
    ref = include.ref
    if ref.startswith(_LOCAL):
        found = os.path.join(os.path.dirname(path), ref.removeprefix(_LOCAL))
        if not os.path.isfile(found):
            raise UsageError(f"{include.where}: {ref} does not exist; correct the path")
        return found
    package, _, name = ref.removeprefix(_INDEXED).partition("/")
    if not ref.startswith(_INDEXED) or not name:
        raise UsageError(f"{include.where}: {ref} is not nodl://PACKAGE/NAME or local://FILE")
    found = file_of(interfaces, Identity(package, name))
    if not found:
        hint = "source the workspace that has it, or name its folder with --nodes"
        raise UsageError(f"{include.where}: {ref} is not installed; {hint}")
    return found


EVERY_NODE = "every_node"
# An endpoint of the library alone keeps its rule, and is not asked for: the document may be partial.
NOT_IN_NODL = f"{OPEN_KIND}: {NODL}"
TYPE_DESCRIPTION = Endpoint(SERVICE, SERVES, "~/get_type_description")
_TF = ("/tf", "/tf_static")
_IMAGE = "sensor_msgs/msg/Image"
_FRAME = lazy_compile(r"(?:.*[._])?frame(?:_id)?")


class _Slot(NamedTuple):
    """The key of an endpoint: what it is called from outside, for a node in the root namespace."""

    kind: str
    role: str
    name: str


class NodeKnowledge(NamedTuple):
    """A library, NoDL documents, which come before it, and the user's ``own`` nodes, before both."""

    library: NodeLibrary
    interfaces: Interfaces
    own: frozenset[str] = frozenset()


def nodes_of(known: NodeKnowledge, node_set: str) -> Iterator[NodeFacts]:
    """Yield the nodes of a node set or NoDL document, as documents have them; raises UsageError."""
    library = known.library
    alone = (
        None
        if node_set in library.node_sets or node_set in library.nodes
        else _node_of_document(known, node_set)
    )
    yield from [alone] if alone else (declared(known, it) for it in nodes_of_set(library, node_set))


def declared(known: NodeKnowledge, node: NodeFacts) -> NodeFacts:
    """Return the node by its NoDL document; unchanged without one. Raises UsageError."""
    usual = node.kind
    if usual in known.own:
        return node
    names = dict.fromkeys((node.name, *node.programs, usual))
    found = (file_of(known.interfaces, Identity(node.package, name)) for name in names)
    file = next(filter(None, found), "")
    if not file:
        return node
    return _merged_node(node, usual, load(file, known.interfaces), known.library.parts)


def _node_of_document(known: NodeKnowledge, name: str) -> NodeFacts | None:
    """Return a node that only a document describes; its name may be ``package/name``."""
    found = [it for it in sorted(identities(known.interfaces)) if name in (it.name, shown(it))]
    if len(found) > 1:
        both = " or ".join(map(shown, found))
        raise UsageError(f"node set {name!r} may be {both}; name one of them")
    if not found:
        return None
    bare = NodeFacts(found[0].name, found[0].package, ())
    document = load(file_of(known.interfaces, found[0]), known.interfaces)
    return _merged_node(bare, bare.name, document, known.library.parts)


def _merged_node(
    node: NodeFacts, usual: str, document: Document, parts: Mapping[str, tuple[Endpoint, ...]]
) -> NodeFacts:
    """Return a node with its document's endpoints; what only the library has is conditional."""
    ours = {_key_of(end, usual): end for end in reversed(node.endpoints)}
    # What ROS gives every node is not the node's own.
    always = {(it.role, _last_word(it)) for it in (*parts.get(EVERY_NODE, ()), TYPE_DESCRIPTION)}
    own = [end for end in document.endpoints if (end.role, _last_word(end)) not in always]
    theirs = {_key_of(end, usual): end for end in _folded(own)}
    ends = [_merged_endpoint(end, ours.get(slot)) for slot, end in theirs.items()]
    for end in node.endpoints:
        if _key_of(end, usual) not in theirs:
            ends.append(end._replace(when=end.when or NOT_IN_NODL))
    frames = tuple(_frames(node, document.parameters))
    return node._replace(endpoints=tuple(ends), frames=frames, interface=document.file)


def _frames(node: NodeFacts, parameters: Iterable[Parameter]) -> Iterator[FrameParameter]:
    """Yield the frame ids in parameters: those the library names, by their names otherwise."""
    given = {it.name: it.default for it in parameters if it.type == "string" and it.default}
    if node.frames or node.sends:
        yield from (it._replace(default=given.get(it.parameter, it.default)) for it in node.frames)
        return
    yield from (FrameParameter(*it) for it in given.items() if _FRAME.fullmatch(it[0]))


def _key_of(end: Endpoint, node: str) -> _Slot:
    """Return kind, role and full name of an endpoint of this node."""
    above, _, own = node.rpartition("/")
    name = end.name if "<" in end.name else expand(end.name, f"/{above}", own)
    return _Slot(end.kind, end.role, name)


def _last_word(end: Endpoint) -> str:
    return end.name.rpartition("/")[2]


def _folded(ends: Iterable[Endpoint]) -> Iterator[Endpoint]:
    """Yield the ends, an image and its image_transport topics as one; a helper node may read tf."""
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
        heard = end.role == SUBSCRIBES and end.name in _TF and end.type == "tf2_msgs/msg/TFMessage"
        yield end._replace(transport=(end.role, end.name) in images, helper=heard)


def _merged_endpoint(end: Endpoint, ours: Endpoint | None) -> Endpoint:
    """Return the endpoint of a document with what the library knows beyond it."""
    if ours is None:
        return end
    # A document made from a running node has a private name in full.
    name = ours.name if ours.name.startswith("~") else end.name
    also = tuple(dict.fromkeys(it for it in (*end.also, *ours.also) if it != end.type))
    return ours._replace(name=name, type=end.type, also=also, source=end.source)
