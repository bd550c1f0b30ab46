# SPDX-License-Identifier: Apache-2.0
"""SROS2 policies that follow from a plan: an enclave a robot, so that DDS refuses what crosses them.

Source: sros2 ``policy/schemas/policy.xsd`` (the elements), ``policy/templates/dds/permissions.xsl`` (an
enclave may do what any of its profiles allows, a name may be a pattern of ``fnmatch``, an action brings
its hidden topics and services) and ``test/policies/common/node.xml`` (what every node needs).
"""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from multibot_rewrite.base.conventions import READ_BY_EVERY_NODE, SENT_BY_EVERY_NODE, tool_patterns
from multibot_rewrite.base.grouping import dicts_by_key, sets_by_key
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    End,
    System,
    nodes_by_robot,
)

TOOLS, SHARED = "/tools", "/shared"
VERSION = "0.2.0"
# Kind and role of an endpoint -> element, attribute, element of a name.
_ELEMENTS = {
    (TOPIC, PUBLISHES): ("topics", "publish", "topic"),
    (TOPIC, SUBSCRIBES): ("topics", "subscribe", "topic"),
    (SERVICE, SERVES): ("services", "reply", "service"),
    (SERVICE, CALLS): ("services", "request", "service"),
    (ACTION, SERVES): ("actions", "execute", "action"),
    (ACTION, CALLS): ("actions", "call", "action"),
}
# What rcl and rclcpp open for every node; ~ is the node.
_PARAMETERS = (
    *("describe_parameters", "get_parameter_types", "get_parameters", "list_parameters"),
    *("set_parameters", "set_parameters_atomically"),
)
_OF_EVERY_NODE = (
    *((TOPIC, PUBLISHES, name) for name in SENT_BY_EVERY_NODE),
    *((TOPIC, SUBSCRIBES, name) for name in READ_BY_EVERY_NODE),
    *((SERVICE, SERVES, f"~/{name}") for name in (*_PARAMETERS, "get_type_description")),
    *((SERVICE, CALLS, f"~/{name}") for name in _PARAMETERS),
)
_HEAD = """\
<?xml version="1.0" encoding="UTF-8"?>
<!-- Who may do what in this fleet: an enclave for each robot, {shared} for nodes that all use,
     {tools} for what people look and drive with. What is not here is refused. -->
"""
# Kind, role and name.
Allowed = tuple[str, str, str]


class Profile(NamedTuple):
    """What a node of an enclave may do; ``node`` is a full name or a pattern."""

    node: str
    allowed: tuple[Allowed, ...]


def enclave_of(robot: str) -> str:
    """Return the path of a robot's enclave."""
    return f"/{robot}"


def to_policy(plan: System, more: Iterable[End] = ()) -> str:
    """Return the policy file of a fleet; ``more`` is what nodes may have besides, by parameter."""
    from xml.sax.saxutils import escape, quoteattr  # takes half as long to import as a check does

    lines = [f'<policy version="{VERSION}">', "  <enclaves>"]
    for path, found in profiles(plan, more).items():
        lines += [f"    <enclave path={quoteattr(path)}>", "      <profiles>"]
        for profile in found:
            space, _, node = profile.node.rpartition("/")
            lines.append(f"        <profile ns={quoteattr(space or '/')} node={quoteattr(node)}>")
            for key, (plural, attribute, single) in _ELEMENTS.items():
                names = [name for kind, role, name in profile.allowed if (kind, role) == key]
                rows = [f"            <{single}>{escape(it)}</{single}>" for it in names]
                ends = f'          <{plural} {attribute}="ALLOW">', f"          </{plural}>"
                lines += [ends[0], *rows, ends[1]] if names else []
            lines.append("        </profile>")
        lines += ["      </profiles>", "    </enclave>"]
    lines += ["  </enclaves>", "</policy>"]
    return _HEAD.format(shared=SHARED, tools=TOOLS) + "\n".join(lines) + "\n"


def profiles(plan: System, more: Iterable[End] = ()) -> Mapping[str, tuple[Profile, ...]]:
    """Return each enclave with what its nodes may do."""
    ends = (*plan.ends, *more)
    allowed = dicts_by_key((end.node, (end.kind, end.role, end.name), None) for end in ends)
    result, nodes = {}, nodes_by_robot(plan)
    for robot in plan.robots:
        tf = [(TOPIC, SUBSCRIBES, f"{robot.tf_topic}{end}") for end in ("", "_static")]
        listener = Profile(f"/{robot.space}/*", tuple(tf))
        own = (_profile_with_common_rights(node, allowed[node]) for node in nodes[robot.name])
        result[enclave_of(robot.name)] = (*own, listener)
    shared = tuple(_profile_with_common_rights(node, allowed[node]) for node in nodes[""])
    # Tools read and call everything; they send what robots read and no planned node sends.
    sides = sets_by_key((end.role, end.name) for end in ends if end.kind == TOPIC)
    open_ = sorted(sides[SUBSCRIBES] - sides[PUBLISHES])
    every = ((TOPIC, SUBSCRIBES, "/*"), (SERVICE, CALLS, "/*"), (ACTION, CALLS, "/*"))
    tools = Profile("/tools", (*every, *((TOPIC, PUBLISHES, name) for name in open_)))
    others = (_profile_with_common_rights(f"/{pattern}", ()) for pattern in tool_patterns())
    return {**result, **({SHARED: shared} if shared else {}), TOOLS: (tools, *others)}


def _profile_with_common_rights(node: str, own: Iterable[Allowed]) -> Profile:
    return Profile(node, tuple(sorted({*_OF_EVERY_NODE, *own})))
