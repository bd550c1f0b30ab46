# SPDX-License-Identifier: Apache-2.0
"""The plan of a fleet -> what each robot may say and hear in Zenoh: rules of access control. Pure.

Source: zenoh ``DEFAULT_CONFIG.json5`` (access_control): a message passes where a rule's key expression
includes its own. rmw_zenoh ``docs/design.md`` has the keys: a topic or service is
``DOMAIN/NAME/TYPE/HASH``. What is latched is in the cache of an advanced publisher, whose keys go on
with ``@adv`` (zenoh-ext ``advanced_publisher.rs``); ``**`` does not match a part that begins with @.
"""

from collections.abc import Iterable, Mapping, Sequence
from itertools import takewhile
from typing import NamedTuple

from multibot_rewrite.base.conventions import OF_EVERY_NODE, SENT_BY_ANY_NODE
from multibot_rewrite.planning.domain_bridge import DOMAIN_BRIDGE, beyond
from multibot_rewrite.producers.zenoh import SPACE
from multibot_rewrite.system.domains import domain_of
from multibot_rewrite.system.records import (
    ACTION,
    PUBLISHES,
    SERVES,
    End,
    Robot,
    System,
    nodes_by_robot,
)

Rule = dict[str, object]
IN, OUT = "ingress", "egress"
# Where rules are applied: what leaves a robot's session comes in at a router, and passes its own.
SESSION, OWN_ROUTER, FLEET_ROUTER = "session", "own router", "fleet's router"
_FLOWS = {
    SESSION: ((OUT,), (IN,)),
    OWN_ROUTER: ((OUT, IN), (OUT, IN)),
    FLEET_ROUTER: ((IN,), (OUT,)),
}
_SENDS = ["put", "delete", "reply", "declare_queryable"]
_ASKS = ["declare_subscriber", "query"]
_LIVELINESS = ["liveliness_token", "liveliness_query", "declare_liveliness_subscriber", "reply"]


class Rights(NamedTuple):
    """A robot's keys in Zenoh: its ``own``, others that it sends or hears; and its domains."""

    robot: str
    own: tuple[str, ...]
    sends: tuple[str, ...]
    hears: tuple[str, ...]
    domains: tuple[int, ...]


def rights(plan: System, domain: int) -> list[Rights]:
    """Return what each robot may do in its domain, or in ``domain`` if the plan has none."""
    # All below its namespace is its own, unless another robot has names there too. Of all other
    # names it has those that its nodes have in the plan.
    numbers, bridged = domain_of(plan), beyond(plan)
    bridges = {it.name for it in plan.nodes if it.node_set == DOMAIN_BRIDGE}
    whole = plan
    plan = plan._replace(nodes=tuple(it for it in plan.nodes if it.name not in bridges))
    owner = {it.name: it.robot for it in plan.nodes}
    by_robot: dict[str, list[End]] = {robot.name: [] for robot in plan.robots}
    for end in plan.ends:
        if robot := owner.get(end.node):
            by_robot[robot].append(end)
    nodes = nodes_by_robot(plan)
    names = {
        robot: [*nodes[robot], *(end.name for end in ends)] for robot, ends in by_robot.items()
    }
    # The namespace that all nodes of a robot are in, where no other robot has a name.
    spaces = {}
    for robot in by_robot:
        levels = zip(*(node.split("/")[1:-1] for node in nodes[robot]), strict=False)
        common = [it[0] for it in takewhile(lambda it: len(set(it)) == 1, levels)]
        space = f"/{'/'.join(common)}/"
        others = (name for other, mine in names.items() if other != robot for name in mine)
        if common and not any(name.startswith(space) for name in others):
            spaces[robot] = space
    found = [
        _rights_of(
            robot,
            nodes[robot.name],
            by_robot[robot.name],
            spaces.get(robot.name, ""),
            plan.shared_topics,
            numbers.get(robot.name, domain),
        )
        for robot in plan.robots
    ]
    return [_with_bridge(it, whole, numbers, bridged) for it in found] if bridges else found


def _with_bridge(
    given: Rights, plan: System, numbers: Mapping[str, int], beyond_: Mapping[str, str]
) -> Rights:
    """Return the rights with those of the robot's domain_bridge: one process, nodes in two domains."""
    at = {
        it.name: numbers["" if it.name in beyond_ else given.robot]
        for it in plan.nodes
        if it.node_set == DOMAIN_BRIDGE and beyond_.get(it.name, it.robot) == given.robot
    }
    ends = [it for it in plan.ends if it.node in at]
    own = [f"{number}{name}/**" for name, number in at.items()]
    sends = [_zenoh_key(at[it.node], it) for it in ends if it.role == PUBLISHES]
    sends += [f"{it}{name}/*/*" for it in {*at.values()} for name in SENT_BY_ANY_NODE]
    hears = [_zenoh_key(at[it.node], it) for it in ends if it.role != PUBLISHES]
    return Rights(
        given.robot,
        tuple(dict.fromkeys((*given.own, *_with_latched_keys(own)))),
        tuple(dict.fromkeys((*given.sends, *_with_latched_keys(sorted(sends))))),
        tuple(dict.fromkeys((*given.hears, *_with_latched_keys(sorted(hears))))),
        tuple(dict.fromkeys((*given.domains, *at.values()))),
    )


def _rights_of(
    robot: Robot,
    nodes: Iterable[str],
    ends: Iterable[End],
    space: str,
    shared: Iterable[str],
    domain: int,
) -> Rights:
    """Return the rights of nodes. Each may listen to tf and to what all robots share."""
    # Without a namespace at least the parameter and lifecycle services of its nodes are its own.
    own = [f"{domain}{space}**"] if space else [f"{domain}{it}/*/*/*" for it in nodes]
    sends: set[str] = set()
    hears: set[str] = set()
    for end in ends:
        if not (space and end.name.startswith(space)):
            (sends if end.role in (PUBLISHES, SERVES) else hears).add(_zenoh_key(domain, end))
    static = "/".join("tf_static" if word == "tf" else word for word in robot.tf_topic.split("/"))
    tf = () if space and robot.tf_topic.startswith(space) else (robot.tf_topic, static)
    sends |= {f"{domain}{name}/*/*" for name in (*SENT_BY_ANY_NODE, *tf)}
    hears |= {f"{domain}{name}/*/*" for name in (*OF_EVERY_NODE, *shared, *tf)}
    keys = (
        _with_latched_keys(own),
        _with_latched_keys(sorted(sends)),
        _with_latched_keys(sorted(hears)),
    )
    return Rights(robot.name, *keys, (domain,))


def _zenoh_key(domain: int, end: End) -> str:
    """Return the key of an end; an action has its services and topics below ``_action``."""
    return f"{domain}{end.name}/_action/*/*/*" if end.kind == ACTION else f"{domain}{end.name}/*/*"


def _with_latched_keys(keys: Sequence[str]) -> tuple[str, ...]:
    return (*keys, *(f"{key}/@adv/**" for key in keys))


def robot_rules(given: Rights, side: str = SESSION) -> list[Rule]:
    """Return the rules of a robot for one side: its sessions, its own router, the fleet's router."""
    out, back = _FLOWS[side]
    name = given.robot
    found = [
        _allow(f"{name}_own", [*_SENDS, *_ASKS], (OUT, IN), given.own),
        _allow(f"{name}_sends", _SENDS, out, given.sends),
        _allow(f"{name}_is_asked", _ASKS, back, given.sends),
        _allow(f"{name}_hears", _SENDS, back, given.hears),
        _allow(f"{name}_asks", _ASKS, out, given.hears),
    ]
    return [*found, graph_rule(f"{name}_graph", given.domains)]


def graph_rule(name: str, domains: Iterable[int]) -> Rule:
    """Return the rule that lets everybody see which nodes run, and what is latched."""
    keys = [key for it in domains for key in (f"{SPACE}/{it}/**", f"{it}/**/@adv/**")]
    return _allow(name, _LIVELINESS, (OUT, IN), keys)


def all_rule(name: str, domains: Iterable[int]) -> Rule:
    """Return the rule for an operator of all robots."""
    keys = [key for it in domains for key in (f"{it}/**", f"{it}/**/@adv/**")] + [f"{SPACE}/**"]
    return _allow(name, list(dict.fromkeys([*_SENDS, *_ASKS, *_LIVELINESS])), (OUT, IN), keys)


def _allow(name: str, messages: Sequence[str], flows: Sequence[str], keys: Sequence[str]) -> Rule:
    """Return a rule that allows these messages at these keys."""
    return {
        "id": name,
        "messages": list(messages),
        "flows": list(flows),
        "permission": "allow",
        "key_exprs": list(keys),
    }


def access_control(parts: Iterable[tuple[dict[str, object], Sequence[Rule]]]) -> dict[str, object]:
    """Return the access control: subjects with the rules of each, everything else denied."""
    given = list(parts)
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": [rule for _, rules in given for rule in rules],
        "subjects": [subject for subject, _ in given],
        "policies": [
            {"rules": [rule["id"] for rule in rules], "subjects": [subject["id"]]}
            for subject, rules in given
        ],
    }
