# SPDX-License-Identifier: Apache-2.0
"""What a node as it runs is called, its topics and services under its rules, and its tf lookups."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.base.conventions import USUAL_FRAMES, WORLD_FRAMES
from multibot_rewrite.base.naming import NAMESPACE, Naming, spelled
from multibot_rewrite.base.rosnames import (
    BoundNode,
    RemapRule,
    bind,
    expand,
    parse_remap,
    resolve_bound,
)
from multibot_rewrite.knowledge.records import TRANSPORTS, Endpoint, NodeFacts
from multibot_rewrite.planning.records import Rule, Run
from multibot_rewrite.system.records import ACTION, MAY, RUNS, SERVICE, TOPIC, End, Lookup, Sure

_PART = "/_action/send_goal"
_OF_ROBOTS = frozenset(USUAL_FRAMES) - frozenset(WORLD_FRAMES)


def parsed(rules: Iterable[Rule]) -> tuple[RemapRule, ...]:
    """Return remap rules as rcl parses them."""
    found = (parse_remap(f"{source}:={target}") for source, target in rules)
    return tuple(rule for rule in found if rule is not None)


def with_names(run: Run) -> Run:
    """Return the run with the names of its ends; those that are made at run time have none."""
    own = bind(run.name, run.namespace, parsed(run.rules))
    bare = bind(run.name, run.namespace, ())
    space = run.process_namespace
    helper = bind(run.name, space, parsed(run.process_rules)) if space else own
    ends = (it for it in run.fact.endpoints if it.name and "<" not in it.name)
    return run._replace(
        names=tuple(
            (it, _name_of(run, it, bare if it.fixed else helper if it.helper else own))
            for it in ends
        )
    )


def name_made_of_other_end(end: Endpoint, bound: BoundNode) -> str:
    """Return the name that a node makes of another end's (camera_common.cpp getCameraInfoTopic)."""
    return sibling(resolve_bound(end.beside, end.kind, bound), end.name)


def asked_alone(node: NodeFacts, end: Endpoint) -> str:
    """Return the name that a node of a robot alone asks for, under the rules of its node set."""
    others = (it.remapped for it in node.endpoints if it.name == end.beside and it.remapped)
    return sibling(next(others, end.beside), end.name) if end.beside else end.name


def sibling(other: str, name: str) -> str:
    """Return a name with its last segment next to another name."""
    return f"{other[: other.rfind('/') + 1]}{name.rpartition('/')[2]}"


def _name_of(run: Run, end: Endpoint, bound: BoundNode) -> str:
    """Return the full name of an end under the rules."""
    if end.beside:
        return resolve_bound(name_made_of_other_end(end, bound), end.kind, bound)
    name = end.name
    # A name that its node resolves in the namespace above its own.
    if end.above and not str(run.value(end.parameter) or "").startswith("/"):
        name = expand(name.lstrip("/"), run.namespace.rpartition("/")[0] or "/", "")
    if end.kind == ACTION:
        # It is services and topics with names of their own; a rule for its name reaches none.
        return resolve_bound(f"{name}{_PART}", SERVICE, bound).removesuffix(_PART)
    return resolve_bound(name, end.kind, bound)


def ends_of(run: Run) -> Iterator[End]:
    """Yield the ends of a node; those under a condition may be there."""
    full_name = run.full_name
    for end, name in run.names:
        given = run.values.get(end.parameter)
        yield End(
            end.kind,
            end.role,
            name,
            end.type,
            "",
            f"{full_name}{end.by}",
            None,
            run.process,
            end.name,
            end.also,
            Sure(MAY.word, end.when) if end.when else RUNS,
            given.place if given else run.place,
        )


def each_once(ends: Iterable[End]) -> Iterator[End]:
    """Yield the ends; of optional ones only one of each name that no other end has."""
    every = dict.fromkeys(ends)
    known = {(it.node, it.kind, it.role, it.name): it for it in every if it.sure == RUNS}
    for it in every:
        if it.sure == RUNS or known.setdefault((it.node, it.kind, it.role, it.name), it) is it:
            yield it


def lookups_of(run: Run, prefix: str = "") -> Iterator[Lookup]:
    """Yield frames that a node reads, by parameter or usual default, and does not send."""
    own = {name for it in run.fact.sends for name in it[:2]}
    for it in (frame for frame in run.fact.frames if frame.parameter not in own):
        found = run.values.get(it.parameter)
        if found and isinstance(found.value, str) and found.value:
            yield Lookup(run.full_name, f"{prefix}{found.value.lstrip('/')}", place=found.place)
        elif not found and it.default in _OF_ROBOTS:
            yield Lookup(run.full_name, f"{prefix}{it.default}")


# What an action is made of (rcl_action names.c): three services and two topics.
ACTION_PARTS = (
    ("_action/send_goal", SERVICE),
    ("_action/cancel_goal", SERVICE),
    ("_action/get_result", SERVICE),
    ("_action/feedback", TOPIC),
    ("_action/status", TOPIC),
)


def placed(robot: str, node: str, naming: Naming, apart: bool = False) -> tuple[str, str]:
    """Return the namespace and name that a robot's node runs under; ``apart`` as in ``NodeFacts``."""
    # A costmap is a node in its own namespace, whatever its robot.
    above, _, name = node.strip("/").rpartition("/")
    if apart or naming.topics == NAMESPACE:
        return "/" + "/".join(filter(None, [robot, above])), name
    return f"/{above}", spelled(naming, robot, "node", name)


def expanded(endpoint: Endpoint) -> Iterator[tuple[str, str]]:
    """Yield (name, kind) as rcl sees an endpoint: several of an action, none if made at run time."""
    name = endpoint.name
    if "<" in name:
        return
    if endpoint.kind != ACTION:
        yield endpoint.kind, name
    else:
        yield TOPIC, name
        yield from ((kind, f"{name}/{part}") for part, kind in ACTION_PARTS)
    if endpoint.transport:
        yield from ((TOPIC, f"{name}/{transport}") for transport in TRANSPORTS)


def target_of(name: str, kind: str, robot: str, naming: Naming) -> str:
    """Return the target of the rule for ``name``; empty if no rule is needed.

    With namespaces targets are relative, so the rule is the same for every robot; a relative name that
    all robots share would be each robot's own without a rule.
    """
    if name.startswith("~"):
        return ""
    # An action's parts and an image's transports are found from the one name alone.
    base, action, part = name.partition("/_action/")
    rest = action + part
    if not action and name.rpartition("/")[2] in TRANSPORTS:
        base, slash, last = name.rpartition("/")
        base, rest = (base, slash + last) if base else (name, "")
    if not naming.shared_topics.isdisjoint((name.strip("/"), base.strip("/"))):
        below = naming.topics == NAMESPACE and not name.startswith("/")
        return f"/{name.rstrip('/')}" if below else ""
    if naming.topics == NAMESPACE:
        return name.strip("/") if name.startswith("/") else ""
    target = spelled(naming, robot, SERVICE if kind == SERVICE and not rest else TOPIC, base)
    return target + rest if target != base else ""
