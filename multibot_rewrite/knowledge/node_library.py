"""Files of nodes and stacks -> records; errors name file and line."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TypeVar

from multibot_rewrite.knowledge.endpoint_entries import checked_endpoint, endpoints_of
from multibot_rewrite.knowledge.fact_words import (
    FACT_KEYS,
    check_apart,
    condition_of,
    releases_of,
    source_of,
    text_and_words,
    variants,
)
from multibot_rewrite.knowledge.records import (
    Claim,
    Endpoint,
    FrameParameter,
    NodeFacts,
    SentTransform,
)
from multibot_rewrite.knowledge.yaml_with_lines import (
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
from multibot_rewrite.model import UsageError
from multibot_rewrite.record import NamedTuple
from multibot_rewrite.releases import share_release
from multibot_rewrite.rosnames import check_node_name
from multibot_rewrite.system.records import ROLES

NODE_WORDS = (
    *("package", "host", "plugin", "shared", "note", "when"),
    *("with", "frames", "sends", "ids", "claims", "fixed"),
    *("nodl", "apart"),
)
SENT_KEYS = ("child", "if")
CLAIM_KINDS = ("command", "state")
CLAIM_KEYS = (*CLAIM_KINDS, "if", "releases")
NODE_KEYS = (*NODE_WORDS, *FACT_KEYS, *ROLES)
STACK_KEYS = ("about", "include", "container", "nodes", "releases")
ENTRY_KEYS = ("node", "as", "plugin", "shared", "when", "with", "names", "remaps", "releases")
FILE_KEYS = ("parts", "nodes", "stacks")
NOTHING: Mapping[str, str] = {}
Known = TypeVar("Known")


class Stack(NamedTuple):
    """Nodes that are started together; ``include`` are stacks that it contains, ``releases`` the
    words for the releases that have it.

    ``container`` is the node among them that all others are loaded into as components, if any.
    """

    about: str
    include: tuple[str, ...]
    nodes: tuple[NodeFacts, ...]
    releases: str = ""
    container: str = ""


class NodeLibrary(NamedTuple):
    """Known parts (endpoints that many nodes have), nodes and stacks.

    It is of one release, or of all of them, with ``release`` empty. ``elsewhere`` says of nodes and
    stacks that this release lacks which releases have them.
    """

    parts: Mapping[str, tuple[Endpoint, ...]]
    nodes: Mapping[str, NodeFacts]
    stacks: Mapping[str, Stack]
    release: str = ""
    elsewhere: Mapping[str, str] = NOTHING


def stack_of(library: NodeLibrary, name: str) -> tuple[NodeFacts, ...]:
    """The nodes of a stack, each once; nodes of included stacks come first.

    The name of a node is a stack of that node alone. Raises UsageError for other names, and for
    what the library's release lacks.
    """
    if name in library.elsewhere:
        hint = "name one of these releases, or leave the stack out"
        has = f"it is in {library.elsewhere[name]}"
        raise UsageError(f"{library.release} has no node of stack {name!r}; {has}; {hint}")
    if name not in library.stacks and name in library.nodes:
        return (library.nodes[name],)
    if name not in library.stacks:
        raise UsageError(unknown("stack", name, library.stacks, library.nodes))
    found = tuple(dict.fromkeys(_gathered(library, name, ())))
    for node in found:
        if any(_are_one(node, other) for other in found):
            raise UsageError(
                f"stack {name!r} has two different nodes called {node.name!r}; "
                "rename one of them with 'as'"
            )
    return found


def _are_one(node: NodeFacts, other: NodeFacts) -> bool:
    """Have two nodes one name in one release?"""
    if node is other or node.name != other.name:
        return False
    return share_release(node.releases, other.releases)


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
    top = table(read_yaml_with_lines(text, file), "the file", FILE_KEYS)
    new = {key: table(item, key) for key, item in top.items()}
    parts = dict(library.parts)
    parts |= {name: _part(item) for name, item in new.get("parts", {}).items()}
    nodes = dict(library.nodes)
    nodes |= {name: _node(name, item, parts) for name, item in new.get("nodes", {}).items()}
    known = {*library.stacks, *new.get("stacks", {})}
    grown = library._replace(parts=parts, nodes=nodes)
    stacks = {name: _stack(item, grown, known) for name, item in new.get("stacks", {}).items()}
    whole = grown._replace(stacks={**library.stacks, **stacks})
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
    return tuple(endpoints_of(table(item, "a part", ROLES)))


def _node(name: str, item: YamlItem, parts: Mapping[str, tuple[Endpoint, ...]]) -> NodeFacts:
    keys = table(item, f"node {name!r}", NODE_KEYS)
    _check_node_name(item, name)
    frames = tuple(_frames(keys))
    return NodeFacts(
        name,
        word_of(keys, "package"),
        (*endpoints_of(keys), *_taken_over(keys, parts)),
        flag_of(keys, "shared"),
        word_of(keys, "note"),
        host=word_of(keys, "host"),
        when=word_of(keys, "when"),
        frames=frames,
        fixed=words_of(keys, "fixed"),
        sends=tuple(_sends(keys, frames)),
        claims=tuple(read_claims(keys)),
        nodl=words_of(keys, "nodl"),
        ids=tuple((name, word(it, f"ids {name}")) for name, it in table_of(keys, "ids").items()),
        releases=releases_of(keys),
        source=source_of(keys),
        plugin=word_of(keys, "plugin"),
        apart=flag_of(keys, "apart"),
    )


def _frames(keys: Mapping[str, YamlItem]) -> Iterator[FrameParameter]:
    for name, item in table_of(keys, "frames").items():
        found = []
        for it in variants(item):
            words = text_and_words(it, f"frame {name}", "default")
            default = word_of(words, "default")
            found.append(FrameParameter(name, default, releases_of(words), source_of(words)))
        check_apart(item, f"frame {name}", [it.releases for it in found])
        yield from found


def _sends(
    keys: Mapping[str, YamlItem], frames: Iterable[FrameParameter]
) -> Iterator[SentTransform]:
    """The transforms that a node publishes, as the parameters that hold their frames."""
    known = {frame.parameter: frame.parameter for frame in frames}
    for parent, item in table_of(keys, "sends").items():
        if parent not in known:
            wrong(item, unknown("frame", parent, known))
        if isinstance(item.value, str):
            yield SentTransform(parent, _known(item, "frame", known))
            continue
        sent = table(item, f"sends {parent}", SENT_KEYS)
        if "child" not in sent:
            wrong(item, f"sends {parent} has no child; write {{child: ..., if: ...}}")
        yield SentTransform(parent, _known(sent["child"], "frame", known), condition_of(sent))


def read_claims(keys: Mapping[str, YamlItem]) -> Iterator[Claim]:
    """The interfaces under ``claims``: ``{command: TEMPLATE}`` or ``{state: TEMPLATE}``."""
    for item in entries_of(keys, "claims"):
        claim = table(item, "a claim", CLAIM_KEYS)
        kinds = [it for it in CLAIM_KINDS if it in claim]
        if len(kinds) != 1:
            wrong(item, "a claim is of one kind; write {command: ...} or {state: ...}")
        for template in words_of(claim, kinds[0]):
            yield Claim(kinds[0], template, condition_of(claim), releases_of(claim))


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
        releases_of(keys),
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
        known=node.name,
        plugin=word_of(keys, "plugin", node.plugin),
        shared=flag_of(keys, "shared", node.shared),
        when=word_of(keys, "when", node.when),
        releases=releases_of(keys) or node.releases,
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
        first = endpoint.named_from or endpoint.name
        yield checked_endpoint(item, endpoint._replace(name=name, fixed="", named_from=first))


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
            checked_endpoint(item, e._replace(remapped=target)) if e.name == given else e
            for e in endpoints
        )
    return endpoints
