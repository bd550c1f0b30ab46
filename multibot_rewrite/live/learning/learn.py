# SPDX-License-Identifier: Apache-2.0
"""The endpoints of running nodes, learned from their graph. Pure, needs no ROS.

The code and the remap rules of a running node are not visible, only the resulting names. Of all
names that the code may have, the one is written whose remap rule is right for the others as well.
"""

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.conventions import CLOCK
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import with_gaps
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import TF_TOPICS
from multibot_rewrite.base.rosnames import expand
from multibot_rewrite.knowledge.node_library import NodeLibrary
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.live.learning.choosing import (
    EndpointId,
    Helpers,
    Seen,
    check_seen_name,
    fold_actions,
    fold_images,
    fold_parts,
    helpers_of,
    namespace_prefix,
)
from multibot_rewrite.planning.bridged_topics import TF_TYPE
from multibot_rewrite.system.records import (
    ACTION,
    PUBLISHES,
    ROLES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    End,
    System,
)

FROM_HELPER = "asked for by transform_listener_impl_<address>"
SHARED_PROCESS = "its process has several nodes, each gets the endpoints of the helper nodes there"
EVERY_NODE, SIM_TIME = "every_node", "run: simulated"
# On every node since Jazzy, besides the endpoints of the part every_node.
SINCE_JAZZY = (SERVES, "~/get_type_description")
_TF = tuple(f"/{topic}" for topic in TF_TOPICS)
_TYPE = re.compile(r"[a-z][a-z0-9_]*/(msg|srv|action)/[A-Za-z][A-Za-z0-9_]*")
_WORDS = {TOPIC: ("msg", "action"), SERVICE: ("srv", "action"), ACTION: ("action",)}
_Slot = tuple[str, str]


class LearnedNode(NamedTuple):
    """What was learned of a node; ``seen`` is its full name in the graph.

    Its endpoints are its ``own`` and those of ``parts``, which the library describes; ``remarks``
    are notes for the user.
    """

    seen: str
    facts: NodeFacts
    own: tuple[Endpoint, ...]
    parts: tuple[str, ...]
    remarks: tuple[str, ...]


class _SeenPlace(NamedTuple):
    """Where a node was seen.

    ``base`` is the robot's namespace, empty for the root; ``node`` the node's name below it.
    ``literal_names`` are names below the base that the code is known to contain as they are,
    ``relative_names`` those that a node in its robot's namespace in every layout has without a slash.
    """

    base: str
    node: str
    literal_names: frozenset[str] = frozenset()
    relative_names: frozenset[str] = frozenset()


def learn(
    graph: System, names: Sequence[str], namespace: str, library: NodeLibrary
) -> tuple[LearnedNode, ...]:
    """Return facts of the nodes ``names`` below the robot's ``namespace``.

    ``library`` has the known parts, and the names in the code of known nodes. Raises UsageError for
    an endpoint that no node can have."""
    base = namespace_prefix(namespace)
    ends = lists_by_key((end.node, end) for end in graph.ends)
    helpers = helpers_of(graph, names)
    return tuple(
        _learn_node(name, base, ends, helpers.get(name, Helpers()), library) for name in names
    )


def _learn_node(
    name: str, base: str, ends: Mapping[str, Sequence[End]], helpers: Helpers, library: NodeLibrary
) -> LearnedNode:
    node = name.removeprefix(f"{base}/")
    known = library.nodes.get(node)
    place = _SeenPlace(base, node)
    if known:
        # Full names of what the code of a node that stands apart writes without a slash.
        names = (end.name for end in known.endpoints if known.apart and end.name[0] not in "/~<")
        relative = frozenset(f"/{name}" for name in names)
        place = _SeenPlace(base, node, frozenset(_literal_names(known)), relative)
    # The endpoints of every node, by role and name; without the clock, which some do not use.
    every = {(end.role, end.name) for end in library.parts[EVERY_NODE] if end.name != CLOCK}
    usual = frozenset({*every, SINCE_JAZZY})
    found = _with_helpers(name, ends, helpers, place)
    rest, parts = fold_parts(found.values(), library.parts, not base and "/" not in node)
    own = [end for end in rest if (end.role, end.name) not in usual]
    own.sort(key=lambda it: (ROLES.index(it.role), it.name))
    taken = (end for part in parts for end in library.parts[part])
    # That its code places it cannot be seen.
    apart = known is not None and known.apart
    facts = NodeFacts(node, "", (*own, *taken), note=f"seen as {name}", apart=apart)
    remarks = [] if ends.get(name) else ["only its name is seen, no endpoints"]
    remarks += [] if helpers.sure else [f"{SHARED_PROCESS}: {', '.join(helpers.names)}"]
    remarks += [_differences(facts, known, usual)] if known else []
    return LearnedNode(name, facts, tuple(own), parts, tuple(remarks))


def _full_name(name: str, node: str) -> str:
    """Return the full name of a name in the code of ``node``, with the robot in the root namespace."""
    above, _, own = node.rpartition("/")
    return expand(name, f"/{above}", own)


def _literal_names(known: NodeFacts) -> Iterator[str]:
    """Return full names that the code has with a slash, or below the node's name without a ``~``."""
    for end in known.endpoints:
        full = _full_name(end.name, known.name)
        if end.name.startswith("/") or (end.name[0] != "~" and full.startswith(f"/{known.name}/")):
            yield full


def _endpoints(ends: Iterable[End], place: _SeenPlace) -> dict[_Slot, Endpoint]:
    """Return a node's endpoints, by role and the name that its code may have."""
    seen, images = fold_images(fold_actions(_types_by_endpoint(ends)))
    found: dict[_Slot, Endpoint] = {}
    for key, types in sorted(seen.items()):
        name = _name_in_code(key.name, types, place)
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
        found[slot] = _merge(found[slot], end, key) if slot in found else end
    return found


def _types_by_endpoint(ends: Iterable[End]) -> Seen:
    """Return by endpoint its valid types, sorted; raises UsageError for an impossible one."""
    types: dict[EndpointId, set[str]] = defaultdict(set)
    for end in ends:
        check_seen_name(end.kind, end.name)
        if (end.kind == TOPIC) != (end.role in (PUBLISHES, SUBSCRIBES)):
            raise UsageError(
                f"{end.node} {end.role} the {end.kind} {end.name}, which is impossible; record it again"
            )
        found, valid = types[EndpointId(end.kind, end.role, end.name)], _TYPE.fullmatch(end.type)
        # Another type counts as not known.
        if valid and valid[1] in _WORDS[end.kind]:
            found.add(end.type)
    return {key: tuple(sorted(found)) for key, found in types.items()}


def _name_in_code(name: str, types: Sequence[str], place: _SeenPlace) -> str:
    """Return a name that the code may have, whose remap rule is right for other possible names too."""
    full = f"{place.base}/{place.node}"
    above = full.rpartition("/")[0]
    level = name.removeprefix(place.base) if name.startswith(f"{place.base}/") else name
    if level in place.relative_names:
        return level.lstrip("/")
    # tf2 uses /tf: if it is in a namespace, a remap rule moved it there.
    if level in place.literal_names or (level in _TF and TF_TYPE in types):
        return level
    if name.startswith(f"{full}/"):
        return f"~{name[len(full) :]}"
    return name[len(above) + 1 :] if above and name.startswith(f"{above}/") else level


def _merge(first: Endpoint, second: Endpoint, key: EndpointId) -> Endpoint:
    """Return one endpoint for two with the same name in the code; of action and service the action."""
    if first.kind != second.kind:
        return first._replace(note=f"there is a {key.kind} with this name too")
    types = sorted({*filter(None, (first.type, *first.also, second.type, *second.also))})
    return first._replace(
        type="".join(types[:1]),
        also=tuple(types[1:]),
        transport=first.transport or second.transport,
        note=f"also seen as {key.name}",
    )


def _with_helpers(
    name: str, ends: Mapping[str, Sequence[End]], helpers: Helpers, place: _SeenPlace
) -> dict[_Slot, Endpoint]:
    """Return a node's endpoints, with those of its helper nodes."""
    found = _endpoints(ends.get(name, ()), place)
    for helper in helpers.names:
        private = f"{helper}/"
        public = (end for end in ends.get(helper, ()) if not end.name.startswith(private))
        theirs = _endpoints((end for end in public if end.name != CLOCK), place)
        for slot, end in theirs.items():
            found.setdefault(slot, end._replace(helper=True, note=FROM_HELPER))
    return found


def _differences(facts: NodeFacts, known: NodeFacts, usual: frozenset[_Slot]) -> str:
    """Return in words how a node differs from the one of this name in the library."""
    described = [_pattern(end, known.name) for end in known.endpoints]
    seen = {_signature(end, facts.name): end for end in facts.endpoints}
    more = [
        end
        for signature, end in seen.items()
        if (end.role, end.name) not in usual
        and end.name != CLOCK
        and not any(pattern.fullmatch(" ".join(signature)) for pattern in described)
    ]
    always = (end for end in known.endpoints if not end.when and "<" not in end.name)
    less = [end for end in always if _signature(end, known.name) not in seen]
    differences = [f"additional: {_listed(more)}"] * bool(more)
    differences += [f"not seen: {_listed(less)}"] * bool(less)
    head = f"known as {known.name} of {known.package}"
    return "; ".join([head, *(differences or ["as described there"])])


def _signature(end: Endpoint, node: str) -> tuple[str, str, str]:
    """Return kind, role and full name of an endpoint."""
    return end.kind, end.role, _full_name(end.name, node)


def _pattern(end: Endpoint, node: str) -> re.Pattern[str]:
    """Return a pattern for an endpoint: <...> in its name stands for anything, a leading slash too."""
    kind, role, full = _signature(end, node)
    text = f"{kind} {role} {end.name if end.name[0] == '<' else full}"
    return re.compile(with_gaps(re.split(r"<[^<>/]+>", text), "."))


def _listed(ends: Iterable[Endpoint]) -> str:
    """Return the roles and names of endpoints as a text."""
    return ", ".join(f"{end.role} {end.name}" for end in ends)
