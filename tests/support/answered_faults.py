# SPDX-License-Identifier: Apache-2.0
"""Seeded faults that only messages and answers of nodes show: frames of headers, states."""

from __future__ import annotations

from fault_changes import Change, Fault, nav, shared_tf, simulation
from node_answers import told

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.system.parameters import Answer, with_answers
from multibot_rewrite.system.records import DEVICE, Address, Heard, Lookup

MANAGERS = "/robot1/controller_manager", "/robot1/gz/controller_manager"


def heard(topic: str, frame: str) -> Change:
    """Return the change by which a message on the topic names the frame."""
    return lambda graph: graph._replace(heard=(*graph.heard, Heard(topic, frame)))


def answered(*states: Answer) -> Change:
    return lambda graph: with_answers(graph, states)


def header_rows() -> tuple[Fault, ...]:
    return (
        Fault(
            "robot1's lidar has a bare frame_id", shared_tf, heard("/robot1/scan", "lidar_link"),
            "MG412", ("/robot1/lidar_driver", "to lidar_link/robot1"),
        ),
        Fault(
            "robot2's lidar has robot1's frame_id", shared_tf,
            heard("/robot2/scan", "lidar_link/robot1"),
            "MG411", ("/robot2/lidar_driver", "a frame of robot1"),
        ),
        Fault(
            "the robot's name in a frame_id, and not in tf", nav,
            heard("/robot1/scan", "robot1/lidar_link"),
            "MG412", ("/robot1/lidar_driver", "to lidar_link"),
        ),
        Fault(
            "a camera whose frame no node sends", nav, heard("/robot1/front/image_raw", "thermal"),
            "MG412", ("/robot1/camera_driver", "camera_optical_frame"), WARNING,
        ),
        Fault(
            "odometry in the other robot's odom", shared_tf, heard("/robot1/odom", "odom/robot2"),
            "MG411", ("/robot1/diff_drive", "a frame of robot2"),
        ),
    )  # fmt: skip


def state_rows() -> tuple[Fault, ...]:
    arm = "arm_controller", "active", ("joint1/position",)
    spare = "arm_controller", "inactive", ()
    return (
        Fault(
            "amcl was never activated", nav, answered(told("/robot1/amcl", "inactive")),
            "MG511", ("/robot1/lifecycle_manager_localization", "ros2 lifecycle get /robot1/amcl"),
        ),
        Fault(
            "a driver that no node activates", nav,
            answered(told("/robot1/lidar_driver", "unconfigured")),
            "MG511", ("/robot1/lidar_driver", "no node activates it"), WARNING,
        ),
        Fault(
            "one of robot2's nodes has use_sim_time false", simulation,
            answered(
                told("/robot2/amcl", sim_time=True),
                told("/robot2/planner_server", sim_time=True),
                told("/robot2/lidar_driver", sim_time=False),
            ),
            "MG514", ("/robot2/lidar_driver", "the same for all"), WARNING,
        ),
        Fault(
            "a controller manager of the driver and one of the simulator", nav,
            answered(*(told(it, controllers=(arm,)) for it in MANAGERS)),
            "MG512", (*MANAGERS, "stop one"),
        ),
        Fault(
            "controllers that no spawner activated", nav,
            answered(told(MANAGERS[0], controllers=(spare,))),
            "MG513", ("arm_controller (inactive)", "spawners"), WARNING,
        ),
    )  # fmt: skip


def file_rows() -> tuple[Fault, ...]:
    """Return what only files of the robots say."""
    arms = tuple(
        Address(DEVICE, "robot_ip", "10.0.0.2", f"/{it}/robot_state_publisher")
        for it in ("robot1", "robot2")
    )
    asked = Lookup("/robot1/bt_navigator", "base_link")
    return (
        Fault(
            "two arms at one address", nav, lambda it: it._replace(addresses=arms),
            "MB412", ("/robot2/robot_state_publisher", "one device has one driver"), WARNING,
        ),
        Fault(
            "bt_navigator asks for the bare base_link", shared_tf,
            lambda it: it._replace(lookups=(asked,)),
            "MG413", ("/robot1/bt_navigator", "use a frame that is sent"), WARNING,
        ),
    )  # fmt: skip
