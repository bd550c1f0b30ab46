# SPDX-License-Identifier: Apache-2.0
"""ROS 2 names and remap rules, as rcl 9.2 (Jazzy) reads them. Pure text, no ROS needed."""

from __future__ import annotations

from multibot_rewrite.base.rosnames.names import (
    MAX_TOKEN as MAX_TOKEN,
)
from multibot_rewrite.base.rosnames.names import (
    MOST as MOST,
)
from multibot_rewrite.base.rosnames.names import (
    NameFault as NameFault,
)
from multibot_rewrite.base.rosnames.names import (
    check_full_name as check_full_name,
)
from multibot_rewrite.base.rosnames.names import (
    check_namespace as check_namespace,
)
from multibot_rewrite.base.rosnames.names import (
    check_node_name as check_node_name,
)
from multibot_rewrite.base.rosnames.names import (
    check_robot_name as check_robot_name,
)
from multibot_rewrite.base.rosnames.names import (
    check_robot_names as check_robot_names,
)
from multibot_rewrite.base.rosnames.names import (
    check_topic_name as check_topic_name,
)
from multibot_rewrite.base.rosnames.names import (
    expand as expand,
)
from multibot_rewrite.base.rosnames.names import (
    numbered_names as numbered_names,
)
from multibot_rewrite.base.rosnames.names import (
    propose_token as propose_token,
)
from multibot_rewrite.base.rosnames.rules import (
    SERVICE_SCHEME as SERVICE_SCHEME,
)
from multibot_rewrite.base.rosnames.rules import (
    TOPIC_SCHEME as TOPIC_SCHEME,
)
from multibot_rewrite.base.rosnames.rules import (
    BoundNode as BoundNode,
)
from multibot_rewrite.base.rosnames.rules import (
    RemapRule as RemapRule,
)
from multibot_rewrite.base.rosnames.rules import (
    bind as bind,
)
from multibot_rewrite.base.rosnames.rules import (
    parse_remap as parse_remap,
)
from multibot_rewrite.base.rosnames.rules import (
    read_remap as read_remap,
)
from multibot_rewrite.base.rosnames.rules import (
    remapped_node as remapped_node,
)
from multibot_rewrite.base.rosnames.rules import (
    resolve_bound as resolve_bound,
)
from multibot_rewrite.base.rosnames.rules import (
    resolve_name as resolve_name,
)
from multibot_rewrite.base.rosnames.rules import (
    split_remap as split_remap,
)
