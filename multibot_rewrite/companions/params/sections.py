"""The sections of a ROS parameter file: which node each is for, and what their keys become.

As rcl_yaml_param_parser reads them: nested keys before ``ros__parameters`` are joined with ``/``;
``*`` is one token of a node's full name, ``**`` any number of them.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

import yaml

from multibot_rewrite.companions.context import Context, full_name
from multibot_rewrite.companions.params.known import Known, KnownNode
from multibot_rewrite.companions.template import GRAPH
from multibot_rewrite.companions.yaml_text import (
    Splice,
    YamlText,
    anchors,
    line_of,
    pairs,
    replaced,
)
from multibot_rewrite.model import ERROR, WARNING, Finding, InputError
from multibot_rewrite.naming import spelled
from multibot_rewrite.rosnames import check_node_name

PARAMETERS = "ros__parameters"
MANAGER = "controller_manager"
_ANY = ("*", "**")
# What a launch file fills.
_FILLED = re.compile(r"[<${]")
_PATTERN = re.compile(r"/[A-Za-z0-9_/*]+")
_MARK = re.compile(r"[&*][^\s*\[\]{},/:]")
# Nodes of old releases that live inside another: they have sections, and no names of their own.
_INNER = ("_rclcpp_node", "_client")
# A key that only files of that kind have -> what such a file is.
_OTHER_FILES = {
    "Visualization Manager": "an RViz configuration, which goes under rviz",
    "Panels": "an RViz configuration, which goes under rviz",
    "image": "a map, which its map_server loads and which no robot's name is in",
    "joint_limits": "MoveIt's joint limits, which go under moveit",
    "controller_names": "MoveIt's controllers, which go under moveit",
    "moveit_simple_controller_manager": "MoveIt's controllers, which go under moveit",
    "planner_configs": "MoveIt's planners, which go under moveit",
    "initial_positions": "initial positions of joints, which xacro reads",
    "robots": "a fleet file",
}


class Section(NamedTuple):
    """One ``ros__parameters``: the keys above it, the path that they are, and its mapping.

    ``full`` is the full name of the robot's node, with holes, or the pattern the path is. ``node``
    is what is known of it. ``wild`` tells that the path is a pattern; ``shared`` that one node
    serves all robots; ``inner`` that it is part of another node.
    """

    keys: tuple[yaml.ScalarNode, ...]
    path: str
    body: yaml.MappingNode
    full: str
    node: KnownNode | None
    wild: bool
    shared: bool
    inner: bool


class Found(NamedTuple):
    """A section before anything is known of it."""

    keys: tuple[yaml.ScalarNode, ...]
    path: str
    body: yaml.MappingNode


def finding(
    document: YamlText, node: yaml.Node, code: str, level: str, message: str, hint: str
) -> Finding:
    """A finding at the place of ``node``."""
    mark = node.start_mark
    return Finding(code, level, message, hint, document.file, mark.line + 1, mark.column + 1)


def found_sections(document: YamlText) -> list[Found]:
    """Every section in its order; InputError for a file that rcl would not take or that is none."""
    _check_file(document)
    found = list(_below(document, document.root, ()))
    if not found:
        raise InputError(f"{document.file}:1: no ROS 2 parameter file: {_what_else(document)}")
    return found


def _check_file(document: YamlText) -> None:
    if document.root is not None and PARAMETERS not in document.text:
        raise InputError(f"{document.file}:1: no ROS 2 parameter file: {_what_else(document)}")
    # Nearly no file has one, and this look is far quicker.
    for line, text in anchors(document) if _MARK.search(document.text) else ():
        raise InputError(f"{document.file}:{line}: {text}: rcl takes no anchors; write it out")
    if isinstance(document.root, yaml.MappingNode):
        return
    what = "nothing is in it" if document.root is None else _what_else(document)
    raise InputError(f"{document.file}:1: no ROS 2 parameter file: {what}")


def _what_else(document: YamlText) -> str:
    """What a file without parameters seems to be."""
    root = document.root
    if isinstance(root, yaml.SequenceNode):
        keys = {key.value for item in root.value for key, _ in pairs(item)}
        bridge = keys & {"topic_name", "ros_topic_name", "gz_topic_name"}
        return "a bridge's, which goes under bridge" if bridge else "it is a list"
    if not isinstance(root, yaml.MappingNode):
        return "it holds one word"
    keys = {key.value for key, _ in pairs(root)}
    found = next((what for key, what in _OTHER_FILES.items() if key in keys), "")
    inner = {key.value for _, value in pairs(root) for key, _ in pairs(value)}
    if not found and "kinematics_solver" in inner:
        found = "MoveIt's kinematics, which go under moveit"
    other = f"no key is {PARAMETERS}, so it is ROS 1's or read by a node itself; for ROS 2"
    return found or f"{other} put each node's parameters below {PARAMETERS}:"


def _below(
    document: YamlText, node: yaml.Node | None, above: tuple[yaml.ScalarNode, ...]
) -> Iterator[Found]:
    _check_keys(document, node)
    for key, value in pairs(node):
        if key.value != PARAMETERS:
            yield from _below(document, value, (*above, key))
            continue
        if not above:
            place = f"{document.file}:{line_of(key)}"
            raise InputError(f"{place}: {PARAMETERS} is below no node's name; write /**: above it")
        if isinstance(value, yaml.MappingNode):
            path = "/".join(it.value.strip("/") for it in above)
            yield Found(above, path, value)
        elif not (isinstance(value, yaml.ScalarNode) and not value.value):
            place = f"{document.file}:{line_of(value)}"
            raise InputError(f"{place}: {PARAMETERS} holds no mapping; write names and values")


def _check_keys(document: YamlText, node: yaml.Node | None) -> None:
    if not isinstance(node, yaml.MappingNode):
        return
    for key, _ in node.value:
        if not isinstance(key, yaml.ScalarNode):
            place = f"{document.file}:{line_of(key)}"
            raise InputError(f"{place}: a key is a mapping or a list; write a name")


def known_sections(found: Iterable[Found], context: Context, known: Known) -> list[Section]:
    """The sections with what is known of their nodes and the names these run under."""
    found = list(found)
    types = controller_types(found)
    return [_section(it, context, known, types) for it in found]


def _section(it: Found, context: Context, known: Known, types: Mapping[str, str]) -> Section:
    name = it.path.rpartition("/")[2]
    filled = bool(_FILLED.search(it.path))
    wild = filled or any(token in _ANY for token in it.path.split("/"))
    place = context.nodes.get(name if wild else it.path, "")
    shared = bool(place) and GRAPH not in place
    if filled:
        full = it.path
    else:
        full = _full_wild(it.path, name, context) if wild else place or _full(it.path, context)
    inner = name.endswith(_INNER)
    node = None if name in _ANY else identified(name, it.body, known, types)
    return Section(it.keys, it.path, it.body, full, node, wild, shared, inner)


def _full(path: str, context: Context) -> str:
    return full_name(path, context.topics.naming)


def _full_wild(path: str, name: str, context: Context) -> str:
    """A pattern holds in any namespace; only a node's own name can change in it."""
    own = name if name in _ANY else spelled(context.topics.naming, GRAPH, "node", name)
    return f"/{path[: len(path) - len(name)]}{own}"


def identified(
    name: str, body: yaml.Node | None, known: Known, types: Mapping[str, str]
) -> KnownNode | None:
    """The known node of a section: by its controller type, its name, or what it sets."""
    top = {key.value: value for key, value in pairs(body)}
    own = top.get("type")
    type_ = types.get(name, own.value if isinstance(own, yaml.ScalarNode) else "")
    if type_ in known.types:
        return known.nodes[known.types[type_]]
    if name in known.names:
        return known.nodes[known.names[name]]
    # A controller of a type that is not known is no other node either.
    if type_ and "/" in type_:
        return None
    words = {key.partition(".")[0] for key in top}
    told = (it for it in known.nodes.values() if it.known_by and words.issuperset(it.known_by))
    return next(told, None)


def controller_types(found: Iterable[Found]) -> dict[str, str]:
    """Controller -> type, as the controller managers of the file have it."""
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


def key_splices(document: YamlText, sections: Sequence[Section]) -> list[Splice | Finding]:
    """What the keys above the sections become."""
    new: dict[int, tuple[yaml.ScalarNode, str]] = {}
    told: list[Splice | Finding] = []
    for section in sections:
        kept = section.shared or section.full == section.path
        texts = [key.value for key in section.keys] if kept else _texts(section)
        for key, text in zip(section.keys, texts, strict=True):
            _, other = new.setdefault(id(key), (key, text))
            if other != text:
                message = f"{key.value!r} holds sections that cannot have one name: {other}, {text}"
                hint = "give each section its own key: node: ros__parameters:"
                told.append(finding(document, key, "MF101", ERROR, message, hint))
    told += [_key_splice(key, text) for key, text in new.values() if text != key.value]
    return told


def _key_splice(key: yaml.ScalarNode, text: str) -> Splice:
    """A pattern needs no quotes, as long as no star comes first."""
    splice = replaced(key, text)
    return splice if key.style or not _PATTERN.fullmatch(text) else splice._replace(new=text)


def _texts(section: Section) -> list[str]:
    """The full name, divided over the keys as it was: the first one takes what came in front."""
    tokens = section.full.strip("/").split("/")
    texts = []
    for key in reversed(section.keys[1:]):
        count = key.value.strip("/").count("/") + 1
        texts.append("/".join(tokens[-count:]))
        tokens = tokens[:-count]
    first = "/" + "/".join(tokens)
    return [first, *reversed(texts)]


def about_sections(
    document: YamlText, sections: Sequence[Section], context: Context
) -> Iterator[Finding]:
    """What a person should know of the sections: whose they are, and which of them counts."""
    told = set()
    first: dict[str, Section] = {}
    for section in sections:
        key = section.keys[-1]
        earlier = first.setdefault(section.path, section)
        if earlier is not section:
            message = (
                f"section {section.path} stands here again, after line {line_of(earlier.keys[-1])}"
            )
            hint = "rcl merges the two and PyYAML keeps the last: make them one"
            yield finding(document, key, "MF102", WARNING, message, hint)
        if section.shared and section.path not in told:
            told.add(section.path)
            message = f"{section.path} serves all robots: its section stays as it is"
            yield finding(document, key, "MF103", WARNING, message, "start it once, with this file")
        else:
            yield from _about_namespace(document, section, context)
        yield from _about_name(document, section)
    yield from _shadowed(document, sections)


def _about_namespace(document: YamlText, section: Section, context: Context) -> Iterator[Finding]:
    """A namespace that is written out: of one robot, or one below each robot's."""
    tokens = section.path.split("/")
    key = section.keys[0]
    if section.path in context.nodes or tokens[0] == "**" or section.full == section.path:
        return
    tails = ["/".join(tokens[at:]) for at in range(1, len(tokens))]
    stack = next((tail for tail in tails if tail in context.nodes), "")
    if stack or (tokens[-1] in _ANY and tokens[0] not in _ANY):
        message = f"section {section.path} is for one robot already: its namespace is written out"
        hint = f"write {stack or '/**'}: and the namespace is put there for each robot"
        yield finding(document, key, "MF104", ERROR, message, hint)
    elif tails and not section.wild and not tokens[-1].startswith(tokens[0]):
        message = f"section {section.path} has a namespace, which is put below each robot's"
        hint = f"if {tokens[0]} is a robot's name, write {tails[0]}:"
        yield finding(document, key, "MF105", WARNING, message, hint)


def _about_name(document: YamlText, section: Section) -> Iterator[Finding]:
    for at, key in enumerate(section.keys):
        if _FILLED.search(key.value):
            message = f"section {section.path} stays: a launch file has to fill it"
            hint = "write the node's name alone, and the namespace is put there"
            yield finding(document, key, "MF110", WARNING, message, hint)
            continue
        names = (it for it in key.value.strip("/").split("/") if it not in _ANY)
        faults = ((it, check_node_name(it)) for it in names)
        bad = next((f"{it!r}: {fault.reason}" for it, fault in faults if fault), "")
        if at and key.value.startswith("/"):
            bad = (
                f"{key.value!r}: a key below another starts with a slash, which makes two in a row"
            )
        if bad:
            hint = "rcl refuses the file or the section is nobody's: correct the name"
            yield finding(document, key, "MF106", WARNING, f"no node has this name: {bad}", hint)


def _shadowed(document: YamlText, sections: Sequence[Section]) -> Iterator[Finding]:
    """Of what an exact and a later wildcard section set, the later counts (rcl merges in order)."""
    for at, section in enumerate(sections):
        if not section.wild or not any(not it.wild for it in sections[:at]):
            continue
        matches = re.compile(pattern_of(section.full)).fullmatch
        here = dict(flattened(section.body))
        for earlier in sections[:at]:
            if earlier.wild or not matches(earlier.full):
                continue
            for name in here.keys() & dict(flattened(earlier.body)).keys():
                message = f"{name} of {earlier.path} is set again for {section.path}, which counts"
                hint = "put wildcard sections first"
                yield finding(document, here[name], "MF107", WARNING, message, hint)


def pattern_of(full: str) -> str:
    """The regular expression that a wildcard section is for the full names of nodes."""
    parts = {"**": "(?:/[^/]+)*", "*": "/[^/]+"}
    return "".join(parts.get(it, "/" + re.escape(it)) for it in full.strip("/").split("/"))


def flattened(node: yaml.Node, above: str = "") -> Iterator[tuple[str, yaml.ScalarNode]]:
    """Every parameter by its flattened name, with its key; nested and dotted keys are the same."""
    for key, value in pairs(node):
        name = f"{above}.{key.value}" if above else key.value
        if isinstance(value, yaml.MappingNode):
            yield from flattened(value, name)
        else:
            yield name, key
