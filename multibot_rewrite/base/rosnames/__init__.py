# SPDX-License-Identifier: Apache-2.0
"""ROS 2 names and remap rules, as rcl 9.2 (Jazzy) reads them. Pure text, no ROS needed."""

from __future__ import annotations

from multibot_rewrite.base.rosnames.names import (
    MAX_TOKEN as MAX_TOKEN,
    MOST as MOST,
    NameFault as NameFault,
    check_full_name as check_full_name,
    check_name_in_code as check_name_in_code,
    check_namespace as check_namespace,
    check_node_name as check_node_name,
    check_robot_name as check_robot_name,
    check_robot_names as check_robot_names,
    check_topic_name as check_topic_name,
    expand as expand,
    numbered_names as numbered_names,
    propose_token as propose_token,
)
from multibot_rewrite.base.rosnames.rules import (
    SERVICE_SCHEME as SERVICE_SCHEME,
    TOPIC_SCHEME as TOPIC_SCHEME,
    BoundNode as BoundNode,
    RemapRule as RemapRule,
    bind as bind,
    parse_remap as parse_remap,
    read_remap as read_remap,
    remapped_node as remapped_node,
    resolve_bound as resolve_bound,
    resolve_name as resolve_name,
    split_remap as split_remap,
)
