"""Files of nodes and stacks -> records; errors name file and line."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple, TypeVar

from multibot_rewrite.model import UsageError
from multibot_rewrite.remap.records import (
    ACTION,
    PUBLISHES,
    ROLES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Endpoint,
    FrameParameter,
    NodeFacts,
)
from multibot_rewrite.remap.yaml_with_lines import (
    YamlItem,
    entries,
    entries_of,
    flag_of,
    read_yaml_with_lines,
    table,
    table_of,
    unknown,
    word,
    word_of,
    words_of,
    wrong,
)
from multibot_rewrite.rosnames import check_full_name, check_node_name, check_topic_name, expand

NODE_KEYS = (
    *("package", "host", "plugin", "shared", "note", "with", "frames", "sends", "fixed"),
    *ROLES,
)
ENDPOINT_WORDS = ("type", "parameter", "remapped", "when", "fixed", "note")
ENDPOINT_KEYS = (*ENDPOINT_WORDS, "also", "transport", "helper")
STACK_KEYS = ("about", "include", "container", "nodes")
ENTRY_KEYS = ("node", "as", "shared", "when", "with", "names", "remaps")
_TYPE = re.compile(r"[a-z][a-z0-9_]*/(msg|srv|action)/[A-Za-z][A-Za-z0-9_]*")
# Part of a name that is only known at run time.
_MADE = re.compile(r"<[^<>/]+>")
_GIVES = {"msg": "a topic", "srv": "a service", "action": "an action"}
Known = TypeVar("Known")


class Stack(NamedTuple):
    """Nodes that are started together; ``include`` are stacks that it contains.

    ``container`` is the node among them that all others are loaded into as components, if any.
    """

    about: str
    include: tuple[str, ...]
    nodes: tuple[NodeFacts, ...]
    container: str = ""


class NodeLibrary(NamedTuple):
    """Known parts (endpoints that many nodes have), nodes and stacks."""

    parts: Mapping[str, tuple[Endpoint, ...]]
    nodes: Mapping[str, NodeFacts]
    stacks: Mapping[str, Stack]


def stack_of(library: NodeLibrary, name: str) -> tuple[NodeFacts, ...]:
    """The nodes of a stack, each once; nodes of included stacks come first.

    The name of a node is a stack of that node alone. Raises UsageError for other names.
    """
    if name not in library.stacks and name in library.nodes:
        return (library.nodes[name],)
    if name not in library.stacks:
        raise UsageError(unknown("stack", name, library.stacks, library.nodes))
    found: dict[str, NodeFacts] = {}
    for node in _gathered(library, name, ()):
        if found.setdefault(node.name, node) != node:
            raise UsageError(
                f"stack {name!r} has two different nodes called {node.name!r}; "
                "rename one of them with 'as'"
            )
    return tuple(found.values())


def with_included(library: NodeLibrary, name: str) -> Iterator[str]:
    """The names of a stack and of all stacks that it includes; a node is no stack."""
    yield name
    for other in library.stacks[name].include if name in library.stacks else ():
        yield from with_included(library, other)


def _gathered(library: NodeLibrary, name: str, above: tuple[str, ...]) -> Iterator[NodeFacts]:
    if name in above:
        raise UsageError(f"stack {name!r} includes itself: {' -> '.join((*above, name))}")
    stack = library.stacks[name]
    for other in stack.include:
        yield from (_loaded(it, stack) for it in _gathered(library, other, (*above, name)))
    yield from (_loaded(it, stack) for it in stack.nodes)


def _loaded(node: NodeFacts, stack: Stack) -> NodeFacts:
    """The node as a component, if the stack has a container for it."""
    kept = node.host or node.shared or node.name == stack.container or not stack.container
    return node if kept else node._replace(container=stack.container)


def extend(library: NodeLibrary, text: str, file: str) -> NodeLibrary:
    """``library`` with what a YAML text adds or changes."""
    top = table(read_yaml_with_lines(text, file), "the file", NodeLibrary._fields)
    new = {key: table(item, key) for key, item in top.items()}
    parts = dict(library.parts)
    parts |= {name: _part(item) for name, item in new.get("parts", {}).items()}
    nodes = dict(library.nodes)
    nodes |= {name: _node(name, item, parts) for name, item in new.get("nodes", {}).items()}
    known = {*library.stacks, *new.get("stacks", {})}
    grown = NodeLibrary(parts, nodes, library.stacks)
    stacks = {name: _stack(item, grown, known) for name, item in new.get("stacks", {}).items()}
    whole = NodeLibrary(parts, nodes, {**library.stacks, **stacks})
    for name, item in new.get("stacks", {}).items():
        _check_stack(whole, name, item)
    return whole


def _check_stack(library: NodeLibrary, name: str, item: YamlItem) -> None:
    """Includes and names can be checked only when all stacks are known."""
    try:
        stack_of(library, name)
    except UsageError as error:
        wrong(item, str(error))


def _part(item: YamlItem) -> tuple[Endpoint, ...]:
    return tuple(_endpoints(table(item, "a part", ROLES)))


def _node(name: str, item: YamlItem, parts: Mapping[str, tuple[Endpoint, ...]]) -> NodeFacts:
    keys = table(item, f"node {name!r}", NODE_KEYS)
    _check_node_name(item, name)
    frames = tuple(
        FrameParameter(parameter, word(default, f"frame {parameter}"))
        for parameter, default in table_of(keys, "frames").items()
    )
    return NodeFacts(
        name,
        word_of(keys, "package"),
        (*_endpoints(keys), *_taken_over(keys, parts)),
        flag_of(keys, "shared"),
        word_of(keys, "note"),
        host=word_of(keys, "host"),
        frames=frames,
        fixed=words_of(keys, "fixed"),
        sends=tuple(_sends(keys, frames)),
        plugin=word_of(keys, "plugin"),
    )


def _sends(
    keys: Mapping[str, YamlItem], frames: Iterable[FrameParameter]
) -> Iterator[tuple[str, str]]:
    """The transforms that a node publishes, as the parameters that hold their frames."""
    known = {frame.parameter: frame.parameter for frame in frames}
    for parent, item in table_of(keys, "sends").items():
        if parent not in known:
            wrong(item, unknown("frame", parent, known))
        yield parent, _known(item, "frame", known)


def _taken_over(
    keys: Mapping[str, YamlItem], parts: Mapping[str, tuple[Endpoint, ...]]
) -> Iterator[Endpoint]:
    for entry in entries_of(keys, "with"):
        yield from _known(entry, "part", parts)


def _known(item: YamlItem, what: str, known: Mapping[str, Known]) -> Known:
    name = word(item, what)
    if name not in known:
        wrong(item, unknown(what, name, known))
    return known[name]


def _endpoints(keys: Mapping[str, YamlItem]) -> Iterator[Endpoint]:
    for role in ROLES:
        for name, item in table_of(keys, role).items():
            yield _endpoint(role, name, item)


def _endpoint(role: str, name: str, item: YamlItem) -> Endpoint:
    if isinstance(item.value, str):
        return _checked(item, Endpoint(_kind(role, item.value), role, name, item.value))
    keys = table(item, f"{role} {name!r}", ENDPOINT_KEYS)
    endpoint = Endpoint(_kind(role, word_of(keys, "type")), role, name)._replace(
        **{key: word_of(keys, key) for key in ENDPOINT_WORDS},
        also=words_of(keys, "also"),
        transport=flag_of(keys, "transport"),
        helper=flag_of(keys, "helper"),
    )
    return _checked(item, endpoint)


def _kind(role: str, type_: str) -> str:
    if role in (PUBLISHES, SUBSCRIBES):
        return TOPIC
    return ACTION if "/action/" in type_ else SERVICE


def _checked(item: YamlItem, endpoint: Endpoint) -> Endpoint:
    """The endpoint, if its name and types are valid; no rule reaches a name made at run time."""
    for name in filter(None, (endpoint.name, endpoint.remapped)):
        text = _MADE.sub("x", name)
        fault = check_topic_name(text) or check_full_name(expand(text, "/", "node"))
        if fault:
            wrong(item, f"name {name!r}: {fault.reason}")
    for type_ in filter(None, (endpoint.type, *endpoint.also)):
        _check_type(item, endpoint, type_)
    if not _MADE.search(endpoint.name) or endpoint.fixed:
        return endpoint
    source = f"parameter {endpoint.parameter}" if endpoint.parameter else "its configuration"
    return endpoint._replace(fixed=f"the name is made at run time from {source}")


def _check_type(item: YamlItem, endpoint: Endpoint, type_: str) -> None:
    found = _TYPE.fullmatch(type_)
    if not found:
        wrong(item, f"{type_!r} is not a ROS type; write it like std_msgs/msg/String")
    # The parts of an action have types like nav2_msgs/action/Spin_FeedbackMessage.
    if endpoint.kind == TOPIC and "/action/" in type_ and "_" in type_.rpartition("/")[2]:
        return
    if found[1] != {TOPIC: "msg", SERVICE: "srv", ACTION: "action"}[endpoint.kind]:
        wrong(item, f"{endpoint.role} {endpoint.name!r}: {type_} is the type of {_GIVES[found[1]]}")


def _check_node_name(item: YamlItem, name: str) -> None:
    for token in name.split("/"):
        fault = check_node_name(token)
        if fault:
            wrong(item, f"node name {name!r}: {fault.reason}")


def _stack(item: YamlItem, library: NodeLibrary, stacks: Iterable[str]) -> Stack:
    keys = table(item, "a stack", STACK_KEYS)
    known = {name: name for name in stacks}
    return Stack(
        word_of(keys, "about"),
        tuple(_known(entry, "stack", known) for entry in entries_of(keys, "include")),
        tuple(_placed(entry, library) for entry in entries_of(keys, "nodes")),
        word_of(keys, "container"),
    )


def _placed(item: YamlItem, library: NodeLibrary) -> NodeFacts:
    """A node with the changes that a stack makes to it."""
    if isinstance(item.value, str):
        return _known(item, "node", library.nodes)
    keys = table(item, "an entry", ENTRY_KEYS)
    if "node" not in keys:
        wrong(item, "the entry has no node; write {node: ...}")
    node = _known(keys["node"], "node", library.nodes)
    endpoints = (*node.endpoints, *_taken_over(keys, library.parts))
    name = word_of(keys, "as", node.name)
    _check_node_name(keys.get("as", item), name)
    return node._replace(
        name=name,
        shared=flag_of(keys, "shared", node.shared),
        when=word_of(keys, "when", node.when),
        endpoints=_remapped(_named(endpoints, keys), keys),
    )


def _named(endpoints: tuple[Endpoint, ...], keys: Mapping[str, YamlItem]) -> tuple[Endpoint, ...]:
    """The endpoints with the names that parameters set."""
    for given, item in table_of(keys, "names").items():
        if not any(_has(endpoint, given) for endpoint in endpoints):
            wrong(item, unknown("name", given, {endpoint.name for endpoint in endpoints}))
        values = [word(entry, f"names {given}") for entry in entries(item, f"names {given}")]
        endpoints = tuple(
            new for endpoint in endpoints for new in _renamed(item, endpoint, given, values)
        )
    return endpoints


def _renamed(
    item: YamlItem, endpoint: Endpoint, given: str, values: Iterable[str]
) -> Iterator[Endpoint]:
    """One endpoint for each value if it has the name, else itself."""
    if not _has(endpoint, given):
        yield endpoint
        return
    for value in values:
        name = endpoint.name.replace(given, value)
        yield _checked(item, endpoint._replace(name=name, fixed=""))


def _has(endpoint: Endpoint, given: str) -> bool:
    """Is this its name, or a run-time part of its name?"""
    return given in endpoint.name if given.startswith("<") else given == endpoint.name


def _remapped(
    endpoints: tuple[Endpoint, ...], keys: Mapping[str, YamlItem]
) -> tuple[Endpoint, ...]:
    """The endpoints with the remap rules of the usual launch file."""
    for given, item in table_of(keys, "remaps").items():
        if all(endpoint.name != given for endpoint in endpoints):
            wrong(item, unknown("name", given, {endpoint.name for endpoint in endpoints}))
        target = word(item, f"remaps {given}")
        endpoints = tuple(
            _checked(item, e._replace(remapped=target)) if e.name == given else e for e in endpoints
        )
    return endpoints
