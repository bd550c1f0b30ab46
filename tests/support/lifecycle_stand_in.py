# SPDX-License-Identifier: Apache-2.0
"""Stands for a program with a life cycle: writes each state change that it is asked for into the folder
TOLD, and ends when it is active and idle, or when nobody asks for anything.

Names and services are those of rclcpp_lifecycle (lifecycle_node_interface_impl.hpp), the transitions
those of rcl_lifecycle default_state_machine.c.
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

import rclpy
from lifecycle_msgs.msg import State, TransitionEvent
from lifecycle_msgs.srv import ChangeState, GetState
from rclpy.node import Node

# Transition -> state before it, state while it runs, state after it.
TRANSITIONS = {
    1: ("unconfigured", "configuring", "inactive"),
    3: ("inactive", "activating", "active"),
}
IDS = {"unconfigured": 1, "inactive": 2, "active": 3, "configuring": 10, "activating": 13}
IDLE = float(os.environ.get("STAND_IN_IDLE", "2.0"))
ALONE = float(os.environ.get("STAND_IN_ALONE", "15.0"))


class StandIn(Node):
    """A node that changes its state as it is asked to."""

    def __init__(self) -> None:
        super().__init__("slam_toolbox")
        self.state, self.asked = "unconfigured", []
        self.events = self.create_publisher(TransitionEvent, "~/transition_event", 10)
        self.create_service(ChangeState, "~/change_state", self.change)
        self.create_service(GetState, "~/get_state", self.tell)

    def change(self, request: ChangeState.Request, response: ChangeState.Response) -> object:
        before, while_, after = TRANSITIONS.get(request.transition.id, ("", "", ""))
        self.asked.append(request.transition.id)
        response.success = self.state == before
        if response.success:
            for start, goal in ((before, while_), (while_, after)):
                states = (State(id=IDS[it], label=it) for it in (start, goal))
                event = TransitionEvent()
                event.start_state, event.goal_state = states
                self.events.publish(event)
            self.state = after
        return response

    def tell(self, _: GetState.Request, response: GetState.Response) -> object:
        response.current_state = State(id=IDS[self.state], label=self.state)
        return response


def main() -> None:
    rclpy.init(args=sys.argv)
    node = StandIn()
    asked, quiet = 0, 0.0
    while quiet < (IDLE if node.state == "active" else ALONE):
        rclpy.spin_once(node, timeout_sec=0.1)
        quiet = quiet + 0.1 if len(node.asked) == asked else 0.0
        asked = len(node.asked)
    told = {"words": sys.argv, "state": node.state, "asked": node.asked}
    Path(os.environ["TOLD"], str(os.getpid())).write_text(json.dumps(told))


if __name__ == "__main__":
    main()
