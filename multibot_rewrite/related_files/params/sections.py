# SPDX-License-Identifier: Apache-2.0
"""The sections of a ROS parameter file: the node that each is for, and its key for a robot.

As rcl_yaml_param_parser reads them: nested keys before ``ros__parameters`` are joined with ``/``;
``*`` is one token of a node's full name, ``**`` any number of them.
"""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

import yaml

from multibot_rewrite.base.conventions import PLACEHOLDER, ROWS, WORLD_NODES
from multibot_rewrite.base.model import FOR_ROS_1, InputError
from multibot_rewrite.base.naming import spelled
from multibot_rewrite.knowledge.node_sets import apart_nodes, is_apart
from multibot_rewrite.knowledge.parameters import KnownNodes
from multibot_rewrite.knowledge.records import NodeParameters
from multibot_rewrite.related_files.context import NAMESPACE_SLOT, Context, full_name
from multibot_rewrite.related_files.names.placeholders import without_robot
from multibot_rewrite.related_files.yaml_text import YamlText, anchors, names_below, pairs, refused

PARAMETERS = "ros__parameters"
MANAGER = "controller_manager"
ANY = ("*", "**")
_TO_DO = f"put each node's parameters below {PARAMETERS}:"
_MARK = re.compile(r"[&*][^\s*\[\]{},/:]")
NO_NAME = "a key is a mapping or a list; use a name as key"
# Helper nodes of old releases: they have sections, but no names of their own.
INNER = ("_rclcpp_node", "_client")
# A key that only one kind of file has -> what that file is.
_OTHER_FILES = {" ".join(key): said for key, said in ROWS["other files"]}


class ParamSection(NamedTuple):
    """One ``ros__parameters``: the keys above it, the path that they are, and its mapping.

    ``full`` is the full name of the robot's node, with slots, or the pattern in the path. ``node``
    is what is known about it. ``wild`` is true if the path is a pattern, ``shared`` if one node
    serves all robots, ``inner`` if it is part of another node.
    """

    keys: tuple[yaml.ScalarNode, ...]
    path: str
    body: yaml.MappingNode
    full: str
    node: NodeParameters | None
    wild: bool
    shared: bool
    inner: bool


class RawSection(NamedTuple):
    """A section before its node is looked up."""

    keys: tuple[yaml.ScalarNode, ...]
    path: str
    body: yaml.MappingNode


def raw_sections(document: YamlText) -> list[RawSection]:
    """Return every section in order; InputError for a file that rcl rejects or without a section."""
    is_map = document.root is None or isinstance(document.root, yaml.MappingNode)
    has_parameters = document.root is None or PARAMETERS in document.text
    # Hardly any file has one, and this search is far quicker.
    marks = anchors(document) if has_parameters and _MARK.search(document.text) else ()
    for line, text in marks:
        place = f"{document.file}:{line}"
        raise InputError(f"{place}: rcl takes no anchors or aliases ({text}); write the value out")
    found = list(_sections_below(document, document.root, ())) if has_parameters and is_map else []
    if not found:
        raise _other_kind(document)
    return found


def without_own(found: Iterable[RawSection], own: Collection[str]) -> list[RawSection]:
    """Return the sections of a file for one robot, without the robot's name before their paths."""
    made = []
    for it in found:
        above = next((f"{word}/" for word in own if it.path.startswith(f"{word}/")), "")
        made.append(it._replace(path=it.path.removeprefix(above)))
    return made


def _other_kind(document: YamlText) -> InputError:
    """Return the error for a file without parameters."""
    what, cause = _looks_like(document.root), ""
    if not what:
        what = (
            f"it has no {PARAMETERS} key, so it is for ROS 1 or a node reads it directly; for ROS 2"
        )
        what, cause = f"{what} {_TO_DO}", FOR_ROS_1
    return InputError(f"{document.file}:1: not a ROS 2 parameter file: {what}", cause)


def _looks_like(root: yaml.Node | None) -> str:
    """Return what a file without parameters seems to be; empty if unknown."""
    if root is None:
        return f"it is empty; {_TO_DO}"
    if isinstance(root, yaml.SequenceNode):
        keys = {key.value for item in root.value for key, _ in pairs(item)}
        bridge = keys & {"topic_name", "ros_topic_name", "gz_topic_name"}
        return (
            "it is a ros_gz_bridge file; list it under bridge"
            if bridge
            else f"it is a list; {_TO_DO}"
        )
    if not isinstance(root, yaml.MappingNode):
        return f"it holds a single value; {_TO_DO}"
    keys = {key.value for key, _ in pairs(root)}
    found = next((what for key, what in _OTHER_FILES.items() if key in keys), "")
    inner = {key.value for _, value in pairs(root) for key, _ in pairs(value)}
    if not found and "kinematics_solver" in inner:
        return "it holds MoveIt kinematics; list it under moveit"
    return found


def _sections_below(
    document: YamlText, node: yaml.Node | None, above: tuple[yaml.ScalarNode, ...]
) -> Iterator[RawSection]:
    for key, _ in node.value if isinstance(node, yaml.MappingNode) else ():
        if not isinstance(key, yaml.ScalarNode):
            raise refused(document, key, NO_NAME)
    for key, value in pairs(node):
        if key.value != PARAMETERS:
            yield from _sections_below(document, value, (*above, key))
            continue
        if not above:
            what = f"{PARAMETERS} has no node name above it; write /**: above it"
            raise refused(document, key, what)
        if isinstance(value, yaml.MappingNode):
            # rcl takes / alone above a node for the root namespace.
            names = above[1:] if above[0].value == "/" and len(above) > 1 else above
            whole = "/".join(it.value.strip("/") for it in names)
            yield RawSection(above, without_robot(whole), value)
        elif not (isinstance(value, yaml.ScalarNode) and not value.value):
            raise refused(document, value, f"{PARAMETERS} must hold names and values")


def identify_sections(
    found: Iterable[RawSection], context: Context, known: KnownNodes
) -> list[ParamSection]:
    """Return the sections with their known nodes, and the names these run under."""
    found = list(found)
    types = controller_types(found)
    made = [_identified_section(it, context, known, types) for it in found]
    wild = [it for it in made if it.wild and it.node]
    # The packages that the file is for: parameters alone tell a node in any namespace.
    packages = {
        it.node.package
        for it in wild
        if it.node and it.path.rpartition("/")[2] not in known.names and not it.node.types
    }

    def is_namesake(it: ParamSection) -> bool:
        # A name says less than parameters: the plugins of mavros are called camera and imu.
        if not packages or not it.wild or it.node is None or it.node.package in packages:
            return False
        return all(name not in it.node.params for name, _ in flattened(it.body))

    return [it._replace(node=None) if is_namesake(it) else it for it in made]


def _identified_section(
    it: RawSection, context: Context, known: KnownNodes, types: Mapping[str, str]
) -> ParamSection:
    name = it.path.rpartition("/")[2]
    filled = bool(PLACEHOLDER.search(it.path))
    wild = filled or any(token in ANY for token in it.path.split("/"))
    everybodys = f"/{it.path}" if it.path in WORLD_NODES else ""
    place = context.nodes.get(name if wild else it.path, everybodys)
    shared = bool(place) and NAMESPACE_SLOT not in place
    naming = context.topics.naming
    if filled:
        full = it.path
    elif wild:
        # A pattern matches in any namespace; only the node's own name in it can change.
        places = {at.rpartition("/")[2] for at in apart_nodes(context.distro)}
        ends = context.nodes.get(name, "").endswith(f"{NAMESPACE_SLOT}/{name}")
        kept = name in ANY or name in places or ends
        own = name if kept else spelled(naming, NAMESPACE_SLOT, "node", name)
        full = f"/{it.path.removesuffix(name)}{own}"
    else:
        full = place or full_name(it.path, naming, is_apart(it.path, context.distro))
    inner = name.endswith(INNER)
    node = None if name in ANY else identify_node(name, it.body, known, types)
    return ParamSection(it.keys, it.path, it.body, full, node, wild, shared, inner)


def identify_node(
    name: str, body: yaml.Node | None, known: KnownNodes, types: Mapping[str, str]
) -> NodeParameters | None:
    """Return the known node of a section: by its controller type, its name, or its parameters."""
    top = {key.value: value for key, value in pairs(body)}
    own = top.get("type")
    type_ = types.get(name, own.value if isinstance(own, yaml.ScalarNode) else "")
    if type_ in known.types:
        return known.nodes[known.types[type_]]
    if name in known.names:
        return known.nodes[known.names[name]]
    # A controller of an unknown type is not another known node either.
    if type_ and "/" in type_:
        return None
    words = {key.partition(".")[0] for key in top}
    found = (it for it in known.nodes.values() if it.known_by and words.issuperset(it.known_by))
    return next(found, None)


def controller_types(found: Iterable[RawSection]) -> dict[str, str]:
    """Return the type of each controller, as the controller managers in the file set it."""
    types = {}
    for it in found:
        if it.path.rpartition("/")[2] != MANAGER:
            continue
        for key, value in pairs(it.body):
            below = {inner.value: type_ for inner, type_ in pairs(value)}
            name, dot, last = key.value.rpartition(".")
            type_ = value if dot and last == "type" else below.get("type")
            if isinstance(type_, yaml.ScalarNode):
                types[name if dot else key.value] = type_.value
    return types


def is_for(section: str, full: str) -> bool:
    """Return whether a section of this name is for the node with this full name. Raises nothing."""
    if "*" not in section:
        return section.strip("/") == full.strip("/")
    parts = section.strip("/").split("/")
    # The numbers of parts that the words up to here fill; all ways are followed at once.
    filled = _with_skipped({0}, parts)
    for word in full.strip("/").split("/"):
        fit = [at for at, part in enumerate(parts) if at in filled and part in ("**", "*", word)]
        filled = _with_skipped({at + (parts[at] != "**") for at in fit}, parts)
    return len(parts) in filled


def meant_for(
    sections: Sequence[RawSection], reader: str, nodes: Collection[str]
) -> RawSection | None:
    """Return a section meant for ``reader`` that neither it nor another node gets; None without."""
    # None if a section of that name is for it, or if this one is for another node.
    own = [it for it in sections if it.path.rpartition("/")[2] == reader.rpartition("/")[2]]
    if any(is_for(it.path, reader) for it in own):
        return None
    return next((it for it in own if not any(is_for(it.path, node) for node in nodes)), None)


def _with_skipped(filled: set[int], parts: Sequence[str]) -> set[int]:
    """Return the positions in a pattern with those reached as ``**`` may match nothing."""
    for at, part in enumerate(parts):
        if at in filled and part == "**":
            filled.add(at + 1)
    return filled


def settings(node: yaml.Node, above: str = "") -> Iterator[tuple[str, yaml.ScalarNode, yaml.Node]]:
    """Yield (dotted name behind ``above``, key, value) of every parameter."""
    # Nested and dotted keys are the same.
    for key, value in pairs(node):
        name = f"{above}{key.value}"
        if below := names_below(value):
            yield from settings(below, f"{name}.")
        else:
            yield name, key, value


def flattened(node: yaml.Node) -> Iterator[tuple[str, yaml.ScalarNode]]:
    """Yield (dotted name, key) of every parameter."""
    return ((name, key) for name, key, _ in settings(node))


def scalars(node: yaml.Node | None) -> Iterator[tuple[yaml.ScalarNode, yaml.ScalarNode]]:
    """Yield (key, value) where the value is a single one."""
    for key, value in pairs(node):
        if isinstance(value, yaml.ScalarNode):
            yield key, value
        else:
            yield from scalars(value)
