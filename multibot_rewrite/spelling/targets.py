# SPDX-License-Identifier: Apache-2.0
"""What a robot's node, topic or service is called: its namespace and name, the target of its rule."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.naming import NAMESPACE, Naming, spelled
from multibot_rewrite.knowledge.records import TRANSPORTS, Endpoint
from multibot_rewrite.system.records import ACTION, SERVICE, TOPIC

# What an action is made of (rcl_action names.c): three services and two topics.
ACTION_PARTS = (
    ("_action/send_goal", SERVICE),
    ("_action/cancel_goal", SERVICE),
    ("_action/get_result", SERVICE),
    ("_action/feedback", TOPIC),
    ("_action/status", TOPIC),
)


def placed(robot: str, node: str, naming: Naming, apart: bool = False) -> tuple[str, str]:
    """The namespace and name that a robot's node runs under; ``apart`` as in ``NodeFacts``."""
    # A costmap is a node in its own namespace, whatever its robot.
    above, _, name = node.strip("/").rpartition("/")
    if apart or naming.topics == NAMESPACE:
        return "/" + "/".join(filter(None, [robot, above])), name
    return f"/{above}", spelled(naming, robot, "node", name)


def expanded(endpoint: Endpoint) -> Iterator[tuple[str, str]]:
    """The names that rcl sees for an endpoint, with their kinds: an action is services and topics.

    A name in ``<>`` is made at run time, so it yields none.
    """
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
    """The target of the rule for ``name``; empty if no rule is needed.

    With namespaces targets are relative, so the rule is the same for every robot; a relative name
    that all robots share would be each robot's own without a rule.
    """
    bare = name.strip("/")
    if name.startswith("~"):
        return ""
    if bare in naming.shared_topics:
        below = naming.topics == NAMESPACE and not name.startswith("/")
        return f"/{bare}" if below else ""
    if naming.topics == NAMESPACE:
        return bare if name.startswith("/") else ""
    base, rest = _family(name)
    target = spelled(naming, robot, SERVICE if kind == SERVICE and not rest else TOPIC, base)
    return target + rest if target != base else ""


def _family(name: str) -> tuple[str, str]:
    """The name that is renamed, and the rest below it: an action's parts and an image's
    transports are found from the one name alone."""
    base, action, part = name.partition("/_action/")
    if action:
        return base, action + part
    base, _, last = name.rpartition("/")
    return (base, f"/{last}") if base and last in TRANSPORTS else (name, "")
