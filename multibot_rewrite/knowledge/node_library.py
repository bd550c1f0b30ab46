# SPDX-License-Identifier: Apache-2.0
"""Files of nodes and node sets -> records; errors name file and line."""

import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from typing import NamedTuple

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.nearest import unknown
from multibot_rewrite.base.releases import share_release
from multibot_rewrite.knowledge.node_entries import (
    GRAPH_KEYS,
    NODE_KEYS,
    PARAMETER_KEYS,
    check_name,
    checked_endpoint,
    endpoints_of,
    read_guesses,
    read_node,
    read_parameters,
    taken_over,
)
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts, NodeParameters
from multibot_rewrite.knowledge.yaml_with_lines import (
    YamlItem,
    condition_of,
    entries,
    entries_of,
    flag_of,
    known_word,
    read_yaml_with_lines,
    releases_of,
    table,
    table_of,
    word,
    word_of,
    words_of,
    wrong,
)
from multibot_rewrite.system.records import ROLES

NODE_SET_KEYS = ("about", "include", "container", "nodes", "remaps", "releases")
ENTRY_KEYS = (
    *("node", "as", "plugin", "shared", "when", "with", "names", "remaps", "releases"),
    *("parameters", "by_sensor"),
)
ENTRY_OF_NODE = tuple(dict.fromkeys((*NODE_KEYS, *PARAMETER_KEYS)))
# The schema of such a file, for editors.
FILE_KEYS = ("parts", "nodes", "node_sets", "guesses", "sent")
NOTHING: Mapping[str, str] = {}
NO_PARAMETERS: Mapping[str, NodeParameters] = {}
NO_GUESSES: Mapping[str, tuple[str, ...]] = {}


class NodeSet(NamedTuple):
    """Nodes that are started together.

    ``include`` are node sets that it contains, ``releases`` the words for the releases that have
    it. ``container`` is the node among them that all others are loaded into as components, if any.
    ``remaps`` are a node of it or of an included node set, a name of the node, and what that is
    remapped to here."""

    about: str
    include: tuple[str, ...]
    nodes: tuple[NodeFacts, ...]
    releases: str = ""
    container: str = ""
    remaps: tuple[tuple[str, str, str], ...] = ()


class NodeLibrary(NamedTuple):
    """Known parts (endpoints that many nodes have), nodes and node sets.

    It is of one release, or of all of them, with ``release`` empty. ``elsewhere`` says of nodes and
    node sets that this release lacks which releases have them. ``parameters`` are those of nodes,
    by the last name of each, in all releases; ``guesses`` the last words of other parameters by the
    kind that they suggest, ``sent`` frames that nodes send."""

    parts: Mapping[str, tuple[Endpoint, ...]]
    nodes: Mapping[str, NodeFacts]
    node_sets: Mapping[str, NodeSet]
    release: str = ""
    elsewhere: Mapping[str, str] = NOTHING
    parameters: Mapping[str, NodeParameters] = NO_PARAMETERS
    guesses: Mapping[str, tuple[str, ...]] = NO_GUESSES
    sent: frozenset[str] = frozenset()


def nodes_of_set(library: NodeLibrary, name: str) -> tuple[NodeFacts, ...]:
    """Return the nodes of a node set, each once, those of included node sets first.

    A known node is a node set of that node alone. Raises UsageError for any other name, and for
    what the library's release lacks."""
    if name in library.elsewhere:
        hint = "name one of these releases, or leave the node set out"
        has = f"it is in {library.elsewhere[name]}"
        raise UsageError(f"node set {name!r} has no node in {library.release}; {has}; {hint}")
    if name not in library.node_sets and name in library.nodes:
        return (library.nodes[name],)
    if name not in library.node_sets:
        raise UsageError(unknown("node set", name, library.node_sets, library.nodes))
    found = tuple(dict.fromkeys(_all_nodes(library, name, ())))
    for node in found:
        others = (it for it in found if it is not node and it.name == node.name)
        if any(share_release(node.releases, other.releases) for other in others):
            raise UsageError(
                f"node set {name!r} has two different nodes called {node.name!r}; "
                "rename one of them with 'as'"
            )
    return found


def with_included(library: NodeLibrary, name: str) -> Iterator[str]:
    """Yield the names of a node set and of all that it includes; a node is no node set."""
    yield name
    for other in library.node_sets[name].include if name in library.node_sets else ():
        yield from with_included(library, other)


def _all_nodes(library: NodeLibrary, name: str, above: tuple[str, ...]) -> Iterator[NodeFacts]:
    """Yield the nodes of a node set and of those it includes; raises UsageError for a circle."""
    if name in above:
        raise UsageError(
            f"node set {name!r} includes itself, remove one: {' -> '.join((*above, name))}"
        )
    node_set = library.node_sets[name]
    for other in node_set.include:
        yield from (_in_set(it, node_set) for it in _all_nodes(library, other, (*above, name)))
    yield from (_in_set(it, node_set) for it in node_set.nodes)


def _in_set(node: NodeFacts, node_set: NodeSet) -> NodeFacts:
    """Return the node under a node set's rules, as a component if the node set has a container."""
    rules = {given: target for name, given, target in node_set.remaps if name == node.name}
    ends = (it._replace(remapped=rules.get(it.name, it.remapped)) for it in node.endpoints)
    node = node._replace(endpoints=tuple(ends)) if rules else node
    kept = node.host or node.shared or node.name == node_set.container or not node_set.container
    return node if kept else node._replace(container=node_set.container)


def extend(library: NodeLibrary, text: str, file: str, own: bool = False) -> NodeLibrary:
    """Return the library with what a YAML text adds or changes; raises UsageError with the line.

    An entry replaces what was known of a node's endpoints, and adds to its parameters. ``own``
    means that the text is of this package."""
    text = re.sub(r"(?m)^stacks:", "node_sets:", text)  # as files of 0.2.0 call them
    top = table(read_yaml_with_lines(text, file, own), "the file", FILE_KEYS)
    new = {key: table(top[key], key) for key in ("parts", "nodes", "node_sets") if key in top}
    given_parts = {
        name: tuple(endpoints_of(table(item, "a part", ROLES)))
        for name, item in new.get("parts", {}).items()
    }
    parts = {**library.parts, **given_parts}
    nodes, parameters = dict(library.nodes), dict(library.parameters)
    for name, item in new.get("nodes", {}).items():
        keys = table(item, f"node {name!r}", ENTRY_OF_NODE)
        # A node in its own namespace is known by its last name in parameter files.
        last = name.rpartition("/")[2]
        found = read_parameters(last, keys, parameters.get(last))
        in_files = not keys.keys().isdisjoint(PARAMETER_KEYS)
        if in_files:
            parameters[last] = found
        if not (in_files and keys.keys().isdisjoint(GRAPH_KEYS)):
            node, old = read_node(name, item, keys, parts, found.forms), nodes.get(name)
            if old is not None and old.package == node.package:
                # It is started as before, where its new entry says nothing else.
                programs, component = node.programs or old.programs, node.component or old.component
                node = node._replace(programs=programs, component=component)
            nodes[name] = node
    known = {*library.node_sets, *new.get("node_sets", {})}
    grown = library._replace(
        parts=parts,
        nodes=nodes,
        parameters=parameters,
        guesses={**library.guesses, **dict(read_guesses(top))},
        sent=library.sent | frozenset(words_of(top, "sent")),
    )
    node_sets = {
        name: _read_node_set(item, grown, known) for name, item in new.get("node_sets", {}).items()
    }
    whole = grown._replace(node_sets={**library.node_sets, **node_sets})
    for name, item in new.get("node_sets", {}).items():
        # Includes and names can be checked only when all node sets are known.
        try:
            found_nodes = nodes_of_set(whole, name)
        except UsageError as error:
            wrong(item, str(error))
        for of_node, rules in table_of(table(item, "a node set", NODE_SET_KEYS), "remaps").items():
            ends = [end for it in found_nodes if it.name == of_node for end in it.endpoints]
            if not ends:
                wrong(rules, unknown("node", of_node, {it.name for it in found_nodes}))
            for given, target in table(rules, f"remaps of {of_node}").items():
                _check_rule(target, given, ends)
    return whole


def _check_rule(item: YamlItem, given: str, ends: Iterable[Endpoint]) -> None:
    """Raise UsageError for a rule of a name that no endpoint has, or to one that is not allowed."""
    found = next((it for it in ends if it.name == given), None)
    if found is None:
        wrong(item, unknown("name", given, {it.name for it in ends}))
    checked_endpoint(item, found._replace(remapped=word(item, f"remaps {given}")))


def _read_node_set(item: YamlItem, library: NodeLibrary, node_sets: Iterable[str]) -> NodeSet:
    keys = table(item, "a node set", NODE_SET_KEYS)
    known = {name: name for name in node_sets}
    return NodeSet(
        word_of(keys, "about"),
        tuple(known_word(entry, "node set", known) for entry in entries_of(keys, "include")),
        tuple(_read_node_of_set(entry, library) for entry in entries_of(keys, "nodes")),
        releases_of(keys),
        word_of(keys, "container"),
        tuple(
            (node, given, word(target, f"remaps {given}"))
            for node, item in table_of(keys, "remaps").items()
            for given, target in table(item, f"remaps of {node}").items()
        ),
    )


def _read_node_of_set(item: YamlItem, library: NodeLibrary) -> NodeFacts:
    """Return a node with the changes that a node set makes to it."""
    if isinstance(item.value, str):
        return known_word(item, "node", library.nodes)
    keys = table(item, "an entry", ENTRY_KEYS)
    if "node" not in keys:
        wrong(item, "the entry has no node; write {node: ...}")
    node = known_word(keys["node"], "node", library.nodes)
    endpoints = (*node.endpoints, *taken_over(keys, library.parts))
    name = word_of(keys, "as", node.name)
    check_name(keys.get("as", item), name)
    return node._replace(
        name=name,
        known=node.name,
        plugin=word_of(keys, "plugin", node.plugin),
        shared=flag_of(keys, "shared", node.shared),
        when=condition_of(keys, "when") or node.when,
        releases=releases_of(keys) or node.releases,
        endpoints=_remapped(_named(endpoints, keys), keys),
        usual=tuple(_usual(table_of(keys, "parameters"))),
        by_sensor=tuple(
            (type_, tuple(_usual(table(it, f"by_sensor {type_}"))))
            for type_, it in table_of(keys, "by_sensor").items()
        ),
    )


def _usual(values: Mapping[str, YamlItem]) -> Iterator[tuple[str, str | float]]:
    """Yield (name, value) of parameters that the node set's own file gives a node."""
    for name, item in values.items():
        if not isinstance(item.value, str | float | int):
            wrong(item, f"parameter {name} is no word or number")
        value: str | float = item.value
        # A number where a text is one: rclcpp takes no text for a number.
        for kind in (float, int):
            with suppress(ValueError):
                value = kind(item.value) if isinstance(item.value, str) else value
        yield name, value


def _named(endpoints: tuple[Endpoint, ...], keys: Mapping[str, YamlItem]) -> tuple[Endpoint, ...]:
    """Return the endpoints, those under ``names`` with the names that parameters set."""
    for given, item in table_of(keys, "names").items():
        if not any(_has_endpoint_name(endpoint, given) for endpoint in endpoints):
            wrong(item, unknown("name", given, {endpoint.name for endpoint in endpoints}))
        values = [word(entry, f"names {given}") for entry in entries(item, f"names {given}")]
        made = []
        for endpoint in endpoints:
            # One for each value if it has the name, else itself.
            names = (endpoint.name.replace(given, it) for it in values)
            first = endpoint.named_from or endpoint.name
            if _has_endpoint_name(endpoint, given):
                new = (endpoint._replace(name=it, fixed="", named_from=first) for it in names)
                made += [checked_endpoint(item, it) for it in new]
            else:
                made.append(endpoint)
        endpoints = tuple(made)
    return endpoints


def _has_endpoint_name(endpoint: Endpoint, given: str) -> bool:
    """Return whether a name is that of the endpoint, or a part of it that is made at run time."""
    return given in endpoint.name if given.startswith("<") else given == endpoint.name


def _remapped(
    endpoints: tuple[Endpoint, ...], keys: Mapping[str, YamlItem]
) -> tuple[Endpoint, ...]:
    """Return the endpoints with the remap rules of the usual launch file."""
    for given, item in table_of(keys, "remaps").items():
        _check_rule(item, given, endpoints)
        target = word(item, f"remaps {given}")
        endpoints = tuple(
            checked_endpoint(item, e._replace(remapped=target)) if e.name == given else e
            for e in endpoints
        )
    return endpoints
