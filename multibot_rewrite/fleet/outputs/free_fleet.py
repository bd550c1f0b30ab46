# SPDX-License-Identifier: Apache-2.0
"""What free_fleet needs of a plan: the Zenoh bridge of each robot, and the robots of its fleet adapter.

Source: open-rmf/free_fleet 002505f. The adapter reads ``ROBOT/tf`` and ``ROBOT/battery_state``, calls
``ROBOT/navigate_to_pose`` (nav2_robot_adapter.py), looks up map -> ``robot_frame`` with what is on that
tf topic alone, and wants ``navigation_stack`` and ``initial_map`` of each robot (fleet_adapter.py). Its
bridges are of zenoh-bridge-ros2dds, where a name is a regular expression of the whole name
(DEFAULT_CONFIG.json5 at 0b277b7).
"""

from __future__ import annotations

import json
from collections.abc import Iterator

from multibot_rewrite.base.conventions import BODY_FRAMES
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import TF_TOPICS
from multibot_rewrite.fleet.file.domains import FREE_FLEET, FreeFleet
from multibot_rewrite.system.domains import domain_of
from multibot_rewrite.system.ownership import Whose, whose_by_plan
from multibot_rewrite.system.records import ACTION, SERVES, Robot, System

ROBOTS_FILE = "robots.yaml"
_BATTERY, _NAVIGATE = "battery_state", "navigate_to_pose"
_MAP = "map"


def configurations(plan: System, setup: FreeFleet) -> Iterator[tuple[str, bytes]]:
    """Yield each file by its path; raises UsageError for names that the adapter does not look for."""
    numbers, whose = domain_of(plan), whose_by_plan(plan)
    for robot in plan.robots:
        # Why the adapter would find nothing of the robot.
        tf, served = f"/{robot.name}/{TF_TOPICS[0]}", f"/{robot.name}/{_NAVIGATE}"
        if robot.tf_topic != tf:
            wanted = f"its adapter reads {tf}, and {robot.name} has {robot.tf_topic}"
            raise UsageError(f"{FREE_FLEET}: {wanted}; take layout tf-per-robot or both")
        if not any((it.kind, it.role, it.name) == (ACTION, SERVES, served) for it in plan.ends):
            what = f"no node of {robot.name} serves {served}"
            raise UsageError(f"{FREE_FLEET}: {what}; name the node set that does, as nav2")
        yield f"{FREE_FLEET}/{robot.name}.json5", _bridge(robot, numbers[robot.name], setup)
    rows = [
        "# The robots of the fleet adapter: put them below rmf_fleet of its configuration.",
        "rmf_fleet:",
        "  robots:",
    ]
    for it in plan.robots:
        own_map = (one for one in it.other_frames if whose.plain_frame(one) == _MAP)
        told = {
            "charger": setup.charger.replace("{robot}", it.name),
            "navigation_stack": 2,
            "initial_map": setup.map,
            "map_frame": _MAP if _MAP in plan.shared_frames else next(own_map, _MAP),
            "robot_frame": _robot_frame(plan, it, whose),
        }
        rows.append(f"    {it.name}:")
        rows += [f"      {key}: {json.dumps(value)}" for key, value in told.items()]
    yield f"{FREE_FLEET}/{ROBOTS_FILE}", "\n".join((*rows, "")).encode()


def _bridge(robot: Robot, domain: int, setup: FreeFleet) -> bytes:
    battery = f"/{robot.name}/{_BATTERY}"
    config = {
        "plugins": {
            "ros2dds": {
                "domain": domain,
                "allow": {
                    "publishers": [robot.tf_topic, battery],
                    "subscribers": [],
                    "service_servers": [],
                    "service_clients": [],
                    "action_servers": [f"/{robot.name}/{_NAVIGATE}"],
                    "action_clients": [],
                },
                "pub_max_frequencies": [f"{battery}=1"],
            }
        },
        "mode": "client",
        "connect": {"endpoints": [setup.router]},
        "listen": {"endpoints": []},
    }
    about = f"On {robot.name}: zenoh-bridge-ros2dds -c {robot.name}.json5"
    return f"// {about}\n{json.dumps(config, indent=2)}\n".encode()


def _robot_frame(plan: System, robot: Robot, whose: Whose) -> str:
    """Return the frame that odometry moves; fixed ones are on tf_static, not read by the adapter."""
    nodes = {it.name for it in plan.nodes if it.robot == robot.name}
    moved = (
        it.child
        for it in plan.edges
        if not nodes.isdisjoint(it.publishers) and whose.plain_frame(it.parent) == "odom"
    )
    plain = {whose.plain_frame(it): it for it in robot.frames}
    base = next((plain[it] for it in BODY_FRAMES if it in plain), BODY_FRAMES[0])
    return next(moved, base)
