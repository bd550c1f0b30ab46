"""What files of nodes and stacks say, read with file and line into records."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple, TypeVar

from multibot_rewrite.model import UsageError
from multibot_rewrite.remap.marked import (
    Item,
    entries,
    flag,
    read_marked,
    table,
    unknown,
    word,
    words,
    wrong,
)
from multibot_rewrite.remap.records import (
    ACTION,
    PUBLISHES,
    ROLES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Endpoint,
    Frame,
    NodeFacts,
)

NODE_KEYS = ("package", "host", "shared", "note", "with", "frames", "fixed", *ROLES)
ENDPOINT_WORDS = ("type", "parameter", "remapped", "when", "fixed", "note")
ENDPOINT_KEYS = (*ENDPOINT_WORDS, "also", "transport", "helper")
STACK_KEYS = ("about", "include", "nodes")
ENTRY_KEYS = ("node", "as", "shared", "when", "with", "names", "remaps")
_TYPE = re.compile(r"[a-z][a-z0-9_]*/(msg|srv|action)/[A-Za-z][A-Za-z0-9_]*")
_TOKEN = r"(?:[A-Za-z0-9_]|<[^<>/]+>)+"
_NAME = re.compile(rf"(?:~/|/)?{_TOKEN}(?:/{_TOKEN})*")
_NODE = re.compile(rf"{_TOKEN}(?:/{_TOKEN})*")
Known = TypeVar("Known")


class Stack(NamedTuple):
    """Nodes that are started together; ``include`` names the stacks it has as well."""

    about: str
    include: tuple[str, ...]
    nodes: tuple[NodeFacts, ...]


class Library(NamedTuple):
    """What files of nodes and stacks say: parts (endpoints many nodes have), nodes, stacks."""

    parts: Mapping[str, tuple[Endpoint, ...]]
    nodes: Mapping[str, NodeFacts]
    stacks: Mapping[str, Stack]


def stack_of(library: Library, name: str) -> tuple[NodeFacts, ...]:
    """The nodes of a stack, those of the stacks it includes first, each once.

    The name of a node stands for a stack of it alone. Raises UsageError for other names.
    """
    if name not in library.stacks and name in library.nodes:
        return (library.nodes[name],)
    if name not in library.stacks:
        raise UsageError(unknown("stack", name, library.stacks, library.nodes))
    found: dict[str, NodeFacts] = {}
    for node in _gathered(library, name, ()):
        if found.setdefault(node.name, node) != node:
            raise UsageError(
                f"stack {name!r} has two different nodes {node.name!r}; "
                "give one of them another name with 'as'"
            )
    return tuple(found.values())


def _gathered(library: Library, name: str, above: tuple[str, ...]) -> Iterator[NodeFacts]:
    if name in above:
        raise UsageError(f"stack {name!r} includes itself: {' -> '.join((*above, name))}")
    for other in library.stacks[name].include:
        yield from _gathered(library, other, (*above, name))
    yield from library.stacks[name].nodes


def extended(library: Library, text: str, file: str) -> Library:
    """``library`` and what a YAML text adds to it or says anew."""
    top = table(read_marked(text, file), "the file", Library._fields)
    new = {key: table(item, key) for key, item in top.items()}
    parts = dict(library.parts)
    parts |= {name: _part(item) for name, item in new.get("parts", {}).items()}
    nodes = dict(library.nodes)
    nodes |= {name: _node(name, item, parts) for name, item in new.get("nodes", {}).items()}
    known = {*library.stacks, *new.get("stacks", {})}
    grown = Library(parts, nodes, library.stacks)
    stacks = {name: _stack(item, grown, known) for name, item in new.get("stacks", {}).items()}
    whole = Library(parts, nodes, {**library.stacks, **stacks})
    for name, item in new.get("stacks", {}).items():
        _check_stack(whole, name, item)
    return whole


def _check_stack(library: Library, name: str, item: Item) -> None:
    """Includes and names can only be judged once all stacks are there."""
    try:
        stack_of(library, name)
    except UsageError as error:
        wrong(item, str(error))


def _part(item: Item) -> tuple[Endpoint, ...]:
    return tuple(_endpoints(table(item, "a part", ROLES)))


def _node(name: str, item: Item, parts: Mapping[str, tuple[Endpoint, ...]]) -> NodeFacts:
    keys = table(item, f"node {name!r}", NODE_KEYS)
    if not _NODE.fullmatch(name):
        wrong(item, f"{name!r} is no node name; write tokens of letters, digits and underscores")
    endpoints = _endpoints(keys)
    texts = {key: word(keys[key], key) for key in ("package", "note", "host") if key in keys}
    return NodeFacts(
        name,
        texts.get("package", ""),
        (*endpoints, *_taken_over(keys, parts)),
        "shared" in keys and flag(keys["shared"], "shared"),
        texts.get("note", ""),
        host=texts.get("host", ""),
        frames=tuple(_frames(keys)),
        fixed=words(keys["fixed"], "fixed") if "fixed" in keys else (),
    )


def _taken_over(
    keys: Mapping[str, Item], parts: Mapping[str, tuple[Endpoint, ...]]
) -> Iterator[Endpoint]:
    for entry in entries(keys["with"], "with") if "with" in keys else ():
        yield from _known(entry, "part", parts)


def _known(item: Item, what: str, known: Mapping[str, Known]) -> Known:
    name = word(item, what)
    if name not in known:
        wrong(item, unknown(what, name, known))
    return known[name]


def _frames(keys: Mapping[str, Item]) -> Iterator[Frame]:
    for parameter, default in table(keys["frames"], "frames").items() if "frames" in keys else ():
        yield Frame(parameter, word(default, f"frame {parameter}"))


def _endpoints(keys: Mapping[str, Item]) -> Iterator[Endpoint]:
    for role in ROLES:
        for name, item in table(keys[role], role).items() if role in keys else ():
            yield _endpoint(role, name, item)


def _endpoint(role: str, name: str, item: Item) -> Endpoint:
    if isinstance(item.value, str):
        return _checked(item, Endpoint(_kind(role, item.value), role, name, item.value))
    keys = table(item, f"{role} {name!r}", ENDPOINT_KEYS)
    texts = {key: word(keys[key], key) for key in ENDPOINT_WORDS if key in keys}
    endpoint = Endpoint(_kind(role, texts.get("type", "")), role, name)._replace(
        **texts,
        also=words(keys["also"], "also") if "also" in keys else (),
        transport="transport" in keys and flag(keys["transport"], "transport"),
        helper="helper" in keys and flag(keys["helper"], "helper"),
    )
    return _checked(item, endpoint)


def _kind(role: str, type_: str) -> str:
    if role in (PUBLISHES, SUBSCRIBES):
        return TOPIC
    return ACTION if "/action/" in type_ else SERVICE


def _checked(item: Item, endpoint: Endpoint) -> Endpoint:
    """The endpoint, if its name and types are such; a name not known yet is out of reach."""
    if not _NAME.fullmatch(endpoint.name):
        wrong(item, f"{endpoint.name!r} is no topic, service or action name; write it as in code")
    for type_ in filter(None, (endpoint.type, *endpoint.also)):
        if not _TYPE.fullmatch(type_):
            wrong(item, f"{type_!r} is no type; write it like std_msgs/msg/String")
    if "<" not in endpoint.name or endpoint.fixed:
        return endpoint
    source = f"parameter {endpoint.parameter}" if endpoint.parameter else "its configuration"
    return endpoint._replace(fixed=f"the name is made at run time from {source}")


def _stack(item: Item, library: Library, stacks: Iterable[str]) -> Stack:
    keys = table(item, "a stack", STACK_KEYS)
    includes = entries(keys["include"], "include") if "include" in keys else ()
    include = tuple(_known(entry, "stack", {name: name for name in stacks}) for entry in includes)
    nodes = entries(keys["nodes"], "nodes") if "nodes" in keys else ()
    about = word(keys["about"], "about") if "about" in keys else ""
    return Stack(about, include, tuple(_placed(entry, library) for entry in nodes))


def _placed(item: Item, library: Library) -> NodeFacts:
    """A node as a stack has it."""
    if isinstance(item.value, str):
        return _known(item, "node", library.nodes)
    keys = table(item, "an entry", ENTRY_KEYS)
    if "node" not in keys:
        wrong(item, "the entry names no node; write {node: ...}")
    node = _known(keys["node"], "node", library.nodes)
    endpoints = (*node.endpoints, *_taken_over(keys, library.parts))
    endpoints = _remapped(_named(endpoints, keys), keys)
    return node._replace(
        name=word(keys["as"], "as") if "as" in keys else node.name,
        shared=flag(keys["shared"], "shared") if "shared" in keys else node.shared,
        when=word(keys["when"], "when") if "when" in keys else node.when,
        endpoints=endpoints,
    )


def _named(endpoints: tuple[Endpoint, ...], keys: Mapping[str, Item]) -> tuple[Endpoint, ...]:
    """The endpoints under the names that parameters give them."""
    for given, item in table(keys["names"], "names").items() if "names" in keys else ():
        if not any(_has(endpoint, given) for endpoint in endpoints):
            wrong(item, unknown("name", given, {endpoint.name for endpoint in endpoints}))
        values = words(item, f"names {given}")
        endpoints = tuple(
            new
            for endpoint in endpoints
            for new in (
                [_renamed(item, endpoint, given, value) for value in values]
                if _has(endpoint, given)
                else [endpoint]
            )
        )
    return endpoints


def _has(endpoint: Endpoint, given: str) -> bool:
    return given in endpoint.name if given.startswith("<") else given == endpoint.name


def _renamed(item: Item, endpoint: Endpoint, given: str, value: str) -> Endpoint:
    return _checked(item, endpoint._replace(name=endpoint.name.replace(given, value), fixed=""))


def _remapped(endpoints: tuple[Endpoint, ...], keys: Mapping[str, Item]) -> tuple[Endpoint, ...]:
    """The endpoints with what the usual launch file's own rules make of them."""
    for given, item in table(keys["remaps"], "remaps").items() if "remaps" in keys else ():
        if all(endpoint.name != given for endpoint in endpoints):
            wrong(item, unknown("name", given, {endpoint.name for endpoint in endpoints}))
        target = word(item, f"remaps {given}")
        endpoints = tuple(e._replace(remapped=target) if e.name == given else e for e in endpoints)
    return endpoints
