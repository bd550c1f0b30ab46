# SPDX-License-Identifier: Apache-2.0
"""Classes -> the endpoints of a node: its class, its bases, what they make, the plugins they load."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterator
from typing import NamedTuple

from multibot_rewrite.producers.sources.expressions import is_node, last, template_arguments
from multibot_rewrite.producers.sources.records import (
    ARGUMENT,
    HELPER,
    OWN,
    Api,
    Call,
    Class,
    apis,
)
from tools.interfaces.scope import (
    Index,
    Resolved,
    Scope,
    bound,
    bound_types,
    nearest,
    text_in,
    type_of,
)
from tools.interfaces.table import Fact

DEEPEST = 12
# The function in which a package of tree nodes names its classes.
REGISTERS = "BT_REGISTER_NODES"
# How functions outside of classes are called that make what a node has.
FACTORY = "create"
_LOADER = re.compile(r"ClassLoader<\s*([\w:]+)")


class Visit(NamedTuple):
    """A class on the way: what it is given, what its template is given, when, and by which node.

    With a ``function`` it is one outside of classes.
    """

    found: Class
    given: dict[str, str]
    types: dict[str, str]
    condition: str = ""
    way: str = ""
    above: tuple[str, ...] = ()
    function: str = ""


def facts_of(
    index: Index, node: str, root: Class, others: frozenset[tuple[str, str]]
) -> Iterator[Fact]:
    """Yield what a node declares. ``others`` are classes that are nodes of their own."""
    seen: set[tuple[str, ...]] = set()
    waiting = deque([Visit(root, {}, bound_types(root, ""))])
    while waiting:
        visit = waiting.popleft()
        key = (
            visit.found.name,
            visit.function,
            visit.way,
            *visit.given.values(),
            *visit.types.values(),
        )
        if key in seen or len(visit.above) > DEEPEST:
            continue
        seen.add(key)
        scope = _scope(index, visit)
        for call in _calls(index, visit):
            yield from _declared(index, node, visit, scope, call)
        waiting.extend(it for it in _below(index, visit, scope) if _key(it.found) not in others)


def _key(found: Class) -> tuple[str, str]:
    return found.place.package, found.name


def _scope(index: Index, visit: Visit) -> Scope:
    owners = (visit.found.name, *_bases(index, visit.found))
    return Scope(visit.found.place, owners, visit.given, visit.types)


def _bases(index: Index, found: Class, depth: int = 0) -> Iterator[str]:
    for base in found.bases if depth < DEEPEST else ():
        yield last(base)
        for above in nearest(index.classes.get(last(base), ()), found.place)[:1]:
            yield from _bases(index, above, depth + 1)


def _calls(index: Index, visit: Visit) -> tuple[Call, ...]:
    """Return what the class itself does; another package may have one of its name."""
    rows = index.calls.get(visit.found.name, ())
    if visit.function:
        return nearest(index.functions[visit.function], visit.found.place)
    return tuple(it for it in rows if it.place.package == visit.found.place.package)


def _declared(index: Index, node: str, visit: Visit, scope: Scope, call: Call) -> Iterator[Fact]:
    if call.function in apis():  # A function of this name hands its own arguments on.
        return
    name, types = _function(index, scope, call)
    for api in apis().get(name, ()):
        nodes, named = _told_apart(index, scope, call)
        if (api.node == OWN and not nodes) or (ARGUMENT in api.name and not named.text):
            continue
        said = _name(api, named)
        on = text_in(index, scope, call.function, call.on).text if call.on else ""
        yield Fact(
            node,
            api.role,
            said.text,
            _type(index, scope, api, types) or _type_of_member(index, scope, call.on),
            _way(api, [on, *nodes], node) or visit.way,
            said.parameter,
            _both(visit.condition, call.condition),
            call.place,
        )


def _name(api: Api, argument: Resolved) -> Resolved:
    if ARGUMENT not in api.name:
        return Resolved(api.name)
    return argument._replace(text=api.name.replace(ARGUMENT, argument.text))


def _told_apart(index: Index, scope: Scope, call: Call) -> tuple[list[str], Resolved]:
    """Return the arguments that are nodes, and the first that is none."""
    nodes, others = [], []
    for given in call.given:
        found = text_in(index, scope, call.function, given)
        if is_node(given) or is_node(found.text):
            nodes.append(found.text)
        else:
            others.append(found)
    return nodes, next(iter(others), Resolved(""))


def _function(index: Index, scope: Scope, call: Call) -> tuple[str, tuple[str, ...]]:
    """Return the name of what is called or made, and its template arguments, in an expression."""
    name, types = call.name, call.types
    for owner in scope.owners:
        for alias in index.aliases.get(name, ()):
            if alias.owner == owner:
                return last(alias.type), template_arguments(alias.type)
    member = _member(index, scope, name)
    return (last(member), template_arguments(member)) if member else (name, types)


def _member(index: Index, scope: Scope, name: str) -> str:
    """Return the type of a member that is initialised."""
    for owner in scope.owners:
        for found in index.classes.get(owner, ()):
            if name in found.members:
                return found.members[name]
    return ""


def _type(index: Index, scope: Scope, api: Api, types: tuple[str, ...]) -> str:
    if not api.type.isdigit():
        return api.type
    at = int(api.type)
    return type_of(index, scope, types[at]) if at < len(types) else ""


def _type_of_member(index: Index, scope: Scope, name: str) -> str:
    """Return the type of the messages of a member that is told later what to subscribe to; empty for
    any other member."""
    member = _member(index, scope, name.strip("<>"))
    made = next(iter(apis().get(last(member), ())), None)
    return _type(index, scope, made, template_arguments(member)) if made else ""


def _way(api: Api, nodes: list[str], node: str) -> str:
    private = next((it for it in nodes if it.startswith("<Node:")), "")
    if private and private != f"<Node:{node}>":
        return f"private {private[6:-1]}".strip()
    return "helper" if api.node == HELPER and not any(nodes) else ""


def _both(one: str, other: str) -> str:
    return "; ".join(dict.fromkeys(filter(None, (one, other))))


def _below(index: Index, visit: Visit, scope: Scope) -> Iterator[Visit]:
    """Bases, what is made, members, and plugins."""
    above = (*visit.above, visit.found.name)
    made = {}
    for call in _calls(index, visit):
        name, types = _function(index, scope, call)
        types = tuple(type_of(index, scope, it) for it in types)
        given = tuple(text_in(index, scope, call.function, it).text for it in call.given)
        made[name] = (given, types, call.condition)
        if name == "ClassLoader":
            yield from _plugins(index, visit, types[0] if types else "", above)
        if name == "BehaviorTreeEngine":
            yield from _tree_nodes(index, visit, above)
        yield from _visits(index, visit, name, given, types, call.condition, above)
    for base in visit.found.bases:
        given, types, _ = made.get(last(base), ((), (), ""))
        types = types or tuple(type_of(index, scope, it) for it in template_arguments(base))
        yield from _visits(index, visit, last(base), given, types, "", visit.above)
    for type_ in visit.found.members.values():
        for loaded in _LOADER.findall(type_):
            yield from _plugins(index, visit, loaded, above)
        if last(type_) not in made and "ptr" not in type_ and "Ptr" not in type_:
            yield from _visits(index, visit, last(type_), (), template_arguments(type_), "", above)


def _visits(
    index: Index,
    visit: Visit,
    name: str,
    given: tuple[str, ...],
    types: tuple[str, ...],
    condition: str,
    above: tuple[str, ...],
) -> Iterator[Visit]:
    if name in above or name in apis():
        return
    only = _both(visit.condition, condition)
    found = nearest(index.classes.get(name, ()), visit.found.place)[:1]
    for it in found:
        own = bound_types(it, f"{name}<{', '.join(types)}>")
        yield Visit(it, bound(index, name, given), own, only, visit.way, above)
    if (
        not found
        and name.startswith(FACTORY)
        and nearest(index.functions.get(name, ()), visit.found.place)
    ):
        free = Class("", (), (), {}, visit.found.place)
        yield Visit(free, bound(index, name, given), {}, only, visit.way, (*above, name), name)


def _tree_nodes(index: Index, visit: Visit, above: tuple[str, ...]) -> Iterator[Visit]:
    """Every node of a behavior tree; they use a helper node that the server makes."""
    for call in index.calls.get("", ()):
        if call.function == REGISTERS:
            name = last(call.types[0]) if call.name == "registerNodeType" else call.name
            only = _both(visit.condition, f"tree has {name}")
            for it in _visits(index, visit, name, call.given, (), "", above):
                yield it._replace(way="helper", condition=only)


def _plugins(index: Index, visit: Visit, base: str, above: tuple[str, ...]) -> Iterator[Visit]:
    """Every class that is loaded as this one."""
    for name in index.plugins.get(last(base), ()):
        for found in nearest(index.classes.get(name, ()), visit.found.place)[:1]:
            types = bound_types(found, "")
            yield Visit(
                found, {}, types, _both(visit.condition, f"plugin {name}"), visit.way, above
            )
