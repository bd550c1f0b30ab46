"""What running nodes ask for, learned from the graph they are in. Pure, no ROS needed.

The code and the rules of a running node are not visible, only the names they led to. A name is
spelled so that the rule a table makes of it serves whatever the code may say.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.graph.learning.choosing import Helpers, base_of, check_seen_name, helpers_of
from multibot_rewrite.graph.learning.folding import (
    CLOCK,
    Key,
    Seen,
    fold_actions,
    fold_images,
    fold_parts,
)
from multibot_rewrite.graph.snapshot import GraphEndpoint, Snapshot
from multibot_rewrite.model import UsageError
from multibot_rewrite.naming import TF_TOPICS
from multibot_rewrite.remap.bridged_topics import TF_TYPE
from multibot_rewrite.remap.node_library import NodeLibrary
from multibot_rewrite.remap.records import (
    ACTION,
    PUBLISHES,
    ROLES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Endpoint,
    NodeFacts,
)
from multibot_rewrite.rosnames import expand

HELPED = "asked for by transform_listener_impl_<address>"
UNSURE = "its process has several nodes, so what a helper there asks for is given to each"
BARE = "nothing of it is seen but its name"
EVERY_NODE, SIM_TIME = "every_node", "use_sim_time"
# What every node has since Jazzy, beside the part of that name.
SINCE_JAZZY = (SERVES, "~/get_type_description")
_TF = tuple(f"/{topic}" for topic in TF_TOPICS)
_TYPE = re.compile(r"[a-z][a-z0-9_]*/(msg|srv|action)/[A-Za-z][A-Za-z0-9_]*")
_WORDS = {TOPIC: ("msg", "action"), SERVICE: ("srv", "action"), ACTION: ("action",)}
_Slot = tuple[str, str]


class Learned(NamedTuple):
    """A node as it was seen, its full name there, and the facts made of it.

    Its endpoints are its ``own`` and those of ``parts``, which the library describes; ``remarks``
    are what a person should know.
    """

    seen: str
    facts: NodeFacts
    own: tuple[Endpoint, ...]
    parts: tuple[str, ...]
    remarks: tuple[str, ...]


class _Place(NamedTuple):
    """Where a node was seen.

    ``base`` is the robot's namespace, empty for the root; ``node`` the node's name below it.
    ``wired`` are names below the base that the code is known to write as they are.
    """

    base: str
    node: str
    wired: frozenset[str]


def learn(
    graph: Snapshot, names: Sequence[str], namespace: str, library: NodeLibrary
) -> tuple[Learned, ...]:
    """Facts of the nodes ``names``, seen below ``namespace``, the robot's.

    ``library`` tells which endpoints are a part, and how the code of known nodes writes its names.
    Raises UsageError for an endpoint that no node can have.
    """
    base = base_of(namespace)
    ends: dict[str, list[GraphEndpoint]] = defaultdict(list)
    for end in graph.endpoints:
        ends[end.node].append(end)
    helpers = helpers_of(graph, names)
    return tuple(
        _learned(name, base, ends, helpers.get(name, Helpers()), library) for name in names
    )


def _learned(
    name: str,
    base: str,
    ends: Mapping[str, Sequence[GraphEndpoint]],
    helpers: Helpers,
    library: NodeLibrary,
) -> Learned:
    node = name.removeprefix(f"{base}/")
    known = library.nodes.get(node)
    place = _Place(base, node, frozenset(_wired(known)) if known else frozenset())
    usual = _usual(library)
    found = _with_helpers(name, ends, helpers, place)
    rest, parts = fold_parts(found.values(), library.parts, not base and "/" not in node)
    own = sorted((end for end in rest if (end.role, end.name) not in usual), key=_order)
    taken = (end for part in parts for end in library.parts[part])
    facts = NodeFacts(node, "", (*own, *taken), note=f"seen as {name}")
    remarks = [] if ends.get(name) else [BARE]
    remarks += [] if helpers.sure else [f"{UNSURE}: {', '.join(helpers.names)}"]
    remarks += [_compared(facts, known, usual)] if known else []
    return Learned(name, facts, tuple(own), parts, tuple(remarks))


def _order(end: Endpoint) -> tuple[int, str]:
    return ROLES.index(end.role), end.name


def _usual(library: NodeLibrary) -> frozenset[_Slot]:
    """What every node has, by role and name; that it listens to the clock is worth telling."""
    every = {(end.role, end.name) for end in library.parts[EVERY_NODE] if end.name != CLOCK}
    return frozenset({*every, SINCE_JAZZY})


def _full(name: str, node: str) -> str:
    """A name of ``node`` as it is where the robot is in the root."""
    above, _, own = node.rpartition("/")
    return expand(name, f"/{above}", own)


def _wired(known: NodeFacts) -> Iterator[str]:
    """Full names that the code writes with a slash, or below its own name without a ``~``."""
    for end in known.endpoints:
        full = _full(end.name, known.name)
        if end.name.startswith("/") or (end.name[0] != "~" and full.startswith(f"/{known.name}/")):
            yield full


def _endpoints(ends: Iterable[GraphEndpoint], place: _Place) -> dict[_Slot, Endpoint]:
    """What a node asks for, by role and name as its code may write it."""
    seen, images = fold_images(fold_actions(_seen(ends)))
    found: dict[_Slot, Endpoint] = {}
    for key, types in sorted(seen.items()):
        name = _spelled(key.name, types, place)
        end = Endpoint(
            key.kind,
            key.role,
            name,
            "".join(types[:1]),
            transport=key in images,
            also=types[1:],
            when=SIM_TIME if (key.role, name) == (SUBSCRIBES, CLOCK) else "",
        )
        slot = key.role, name
        found[slot] = _joined(found[slot], end, key) if slot in found else end
    return found


def _seen(ends: Iterable[GraphEndpoint]) -> Seen:
    types: dict[Key, set[str]] = defaultdict(set)
    for end in ends:
        check_seen_name(end.kind, end.name)
        if (end.kind == TOPIC) != (end.role in (PUBLISHES, SUBSCRIBES)):
            raise UsageError(f"{end.node} {end.role} the {end.kind} {end.name}, which nobody can")
        found = types[Key(end.kind, end.role, end.name)]
        if _fits(end):
            found.add(end.type)
    return {key: tuple(sorted(found)) for key, found in types.items()}


def _fits(end: GraphEndpoint) -> bool:
    """Whether a file of nodes can hold the type; another one counts as not known."""
    found = _TYPE.fullmatch(end.type)
    return found is not None and found[1] in _WORDS[end.kind]


def _spelled(name: str, types: Sequence[str], place: _Place) -> str:
    """A name as the code may write it, so that the rule for it serves every way to write it.

    In the robot's root ``x`` and ``/x`` are one name, and the rule for ``/x`` moves both.
    """
    full = f"{place.base}/{place.node}"
    above = full.rpartition("/")[0]
    level = name.removeprefix(place.base) if name.startswith(f"{place.base}/") else name
    # tf2 writes a slash: what is seen in a namespace was led there by a rule.
    if level in place.wired or (level in _TF and TF_TYPE in types):
        return level
    if name.startswith(f"{full}/"):
        return f"~{name[len(full) :]}"
    return name[len(above) + 1 :] if above and name.startswith(f"{above}/") else level


def _joined(first: Endpoint, second: Endpoint, key: Key) -> Endpoint:
    """One endpoint of two that are spelled alike; of an action and a service, the action: its rules
    serve both."""
    if first.kind != second.kind:
        return first._replace(note=f"there is a {key.kind} of this name, too")
    types = sorted({*filter(None, (first.type, *first.also, second.type, *second.also))})
    return first._replace(
        type="".join(types[:1]),
        also=tuple(types[1:]),
        transport=first.transport or second.transport,
        note=f"seen as {key.name}, too",
    )


def _with_helpers(
    name: str, ends: Mapping[str, Sequence[GraphEndpoint]], helpers: Helpers, place: _Place
) -> dict[_Slot, Endpoint]:
    """What a node asks for, and what helper nodes ask for beside it, as its own."""
    found = _endpoints(ends.get(name, ()), place)
    for helper in helpers.names:
        private = f"{helper}/"
        asked = (end for end in ends.get(helper, ()) if not end.name.startswith(private))
        theirs = _endpoints((end for end in asked if end.name != CLOCK), place)
        for slot, end in theirs.items():
            found.setdefault(slot, end._replace(helper=True, note=HELPED))
    return found


def _compared(facts: NodeFacts, known: NodeFacts, usual: frozenset[_Slot]) -> str:
    """What was seen beside what the library says of a node of this name."""
    described = [_pattern(end, known.name) for end in known.endpoints]
    seen = {_traits(end, facts.name): end for end in facts.endpoints}
    more = [
        end
        for traits, end in seen.items()
        if (end.role, end.name) not in usual
        and end.name != CLOCK
        and not any(pattern.fullmatch(" ".join(traits)) for pattern in described)
    ]
    always = (end for end in known.endpoints if not end.when and "<" not in end.name)
    less = [end for end in always if _traits(end, known.name) not in seen]
    told = [f"seen besides: {_listed(more)}"] * bool(more)
    told += [f"not seen: {_listed(less)}"] * bool(less)
    head = f"known as {known.name} of {known.package}"
    return "; ".join([head, *(told or ["all is as described"])])


def _traits(end: Endpoint, node: str) -> tuple[str, str, str]:
    return end.kind, end.role, _full(end.name, node)


def _pattern(end: Endpoint, node: str) -> re.Pattern[str]:
    """What is made at run time may be anything, with a slash before it, too."""
    kind, role, full = _traits(end, node)
    text = re.escape(f"{kind} {role} {end.name if end.name[0] == '<' else full}")
    return re.compile(re.sub(r"<[^<>/]+>", ".+", text))


def _listed(ends: Iterable[Endpoint]) -> str:
    return ", ".join(f"{end.role} {end.name}" for end in ends)
