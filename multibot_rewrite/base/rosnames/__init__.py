"""ROS 2 names and remap rules, as rcl 9.2 (Jazzy) reads them. Pure text, no ROS needed."""

from __future__ import annotations

from multibot_rewrite.base.rosnames.names import (
    MAX_TOKEN,
    NameFault,
    check_full_name,
    check_namespace,
    check_node_name,
    check_robot_name,
    check_topic_name,
    expand,
    propose_token,
)
from multibot_rewrite.base.rosnames.rules import (
    SERVICE_SCHEME,
    TOPIC_SCHEME,
    BoundNode,
    RemapRule,
    bind,
    parse_remap,
    read_remap,
    remapped_node,
    resolve_bound,
    resolve_name,
    split_remap,
)

__all__ = [
    "MAX_TOKEN",
    "SERVICE_SCHEME",
    "TOPIC_SCHEME",
    "BoundNode",
    "NameFault",
    "RemapRule",
    "bind",
    "check_full_name",
    "check_namespace",
    "check_node_name",
    "check_robot_name",
    "check_topic_name",
    "expand",
    "parse_remap",
    "propose_token",
    "read_remap",
    "remapped_node",
    "resolve_bound",
    "resolve_name",
    "split_remap",
]
