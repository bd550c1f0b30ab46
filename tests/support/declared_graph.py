# SPDX-License-Identifier: Apache-2.0
"""Endpoints of nodes as their sources declare them: ``fixtures/interfaces/RELEASE.tsv.xz``."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache

from paths import FIXTURES

from multibot_rewrite.base.rosnames import bind, resolve_bound
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.planning.of_runs import parsed
from multibot_rewrite.planning.records import Run
from multibot_rewrite.system.records import ACTION, SERVICE, TOPIC, End
from tools.interfaces.compare import is_same
from tools.interfaces.table import Fact, from_table, read_packed

# What rclcpp gives every node, and rclcpp_lifecycle those that have it (their node.cpp).
SERVICES = ("get_parameters", "set_parameters", "list_parameters", "describe_parameters",
            "get_parameter_types", "set_parameters_atomically")  # fmt: skip
STATES = {"change_state": "ChangeState", "get_state": "GetState",
          "get_available_states": "GetAvailableStates",
          "get_available_transitions": "GetAvailableTransitions",
          "get_transition_graph": "GetAvailableTransitions"}  # fmt: skip
# Aliases of types, by hand: CmdType of forward_controllers_base.hpp, picknik_twist_controller.hpp.
ALIASES = {
    "forward_command_controller": "std_msgs/msg/Float64MultiArray",
    "multi_interface_forward_command_controller": "std_msgs/msg/Float64MultiArray",
    "picknik_twist_controller": "geometry_msgs/msg/Twist",
}
# Its class is derived from that of the other, which has all (scaled_joint_trajectory_controller.hpp).
DERIVED = {"scaled_joint_trajectory_controller": "joint_trajectory_controller"}
# One of two: without stamped commands, with laser scanners, and no mode that is not started.
DEFAULT = re.compile(r"not \((is_stamped_|subscribe_to_stamped_footprint_)\)")
OFF = (
    "is_stamped_",
    "params_.use_local_topics",
    "class ",
    'source_type == "p',
    'source_type == "r',
    'source_type == "c',
    "not (data_type ==",
    "enable_path_lookahead_",
    # move_group --debug (planning_pipeline.cpp).
    "publish_received_requests_",
    "subscribe_to_stamped_footprint_",
    'command_out_type == "std_msgs/Float64MultiArr',
)
# moveit_servo/src/utils/common.cpp:509 gives its own name where the monitor has a default.
GIVEN = {("servo_node", "publishes", "monitored_planning_scene"): "~/publish_planning_scene"}


@cache
def facts(release: str) -> dict[str, list[Fact]]:
    found: dict[str, list[Fact]] = {}
    for fact in from_table(read_packed(FIXTURES / "interfaces" / f"{release}.tsv.xz")):
        if not any(it in DEFAULT.sub("", fact.condition) for it in OFF):
            name = GIVEN.get((fact.node, fact.role, fact.name), fact.name)
            type_ = ALIASES.get(fact.node, fact.type) if fact.type == "CmdType" else fact.type
            found.setdefault(fact.node, []).append(fact._replace(name=name, type=type_))
    for derived, base in DERIVED.items():
        found[derived] = found[base]
    return found


def names(fact: Fact, node: NodeFacts) -> list[str]:
    """Return the names of an endpoint, with the values that the node set gives parameters."""
    if "<" not in fact.name and not fact.parameter:
        return [fact.name]
    alike = [it for it in node.endpoints if is_same(fact._replace(name="<any>"), it)]
    given = [it.name for it in alike if "<" in fact.name or it.parameter == fact.parameter]
    same = [it.name for it in node.endpoints if is_same(fact, it)]
    return same or given or ([fact.name] if "<" not in fact.name else [])


# What pal_statistics, another repository, publishes below each topic that it gets
# (controller_manager.cpp INITIALIZE_ROS2_CONTROL_INTROSPECTION_REGISTRY).
REGISTRY = {"full": "Statistics", "names": "StatisticsNames", "values": "StatisticsValues"}


def endpoints(kind: str, node: NodeFacts, placed: Run, release: str) -> Iterator[End]:
    """Yield what a node has by its sources."""
    bound = bind(placed.name, placed.namespace, parsed(placed.rules))
    full = f"{placed.namespace.rstrip('/')}/{placed.name}"
    lifecycle = any(it.name == "~/get_state" for it in node.endpoints)
    declared = [
        (it.role, name, it.type, it.way)
        for it in facts(release)[kind]
        for name in names(it, node)
        if "<" not in name and "/" in it.type and it.way in ("", "helper", "private _")
    ]
    declared += [
        (
            "serves",
            f"~/{it}",
            "rcl_interfaces/srv/" + "".join(part.title() for part in it.split("_")),
            "",
        )
        for it in SERVICES
    ]
    if kind == "controller_manager" and release != "humble":
        declared += [
            ("publishes", f"~/{registry}/{it}", f"pal_statistics_msgs/msg/{t}", "")
            for registry in ("introspection_data", "statistics")
            for it, t in REGISTRY.items()
        ]
    if lifecycle:
        declared += [
            ("serves", f"~/{it}", f"lifecycle_msgs/srv/{t}", "") for it, t in STATES.items()
        ]
        declared += [("publishes", "~/transition_event", "lifecycle_msgs/msg/TransitionEvent", "")]
    for role, name, type_, way in declared:
        is_topic = role in ("publishes", "subscribes")
        sort = TOPIC if is_topic else ACTION if "/action/" in type_ else SERVICE
        owner = full
        if way == "helper":
            owner = f"{placed.namespace.rstrip('/')}/transform_listener_impl_55d0"
        elif way:
            owner = f"{full}_private_1407"
        resolved = resolve_bound(name, TOPIC if sort == ACTION else sort, bound)
        yield End(sort, role, resolved, type_, "", owner, None, "")
