# SPDX-License-Identifier: Apache-2.0
"""Which nodes a lifecycle manager calls (nav2_lifecycle_manager and nav2_util of Humble and Jazzy)."""

from __future__ import annotations

import lifecycles
import pytest
from nodes import Node

OWN = ("planner_server/change_state", "/robot1/planner_server/change_state")
OTHER = ("planner_server/change_state", "/robot2/planner_server/change_state")


@pytest.mark.parametrize(
    ("namespace", "rules", "called"),
    [
        ("/robot1", (), "/robot1/planner_server"),
        ("/", (), "/planner_server"),
        ("/", (OWN,), "/robot1/planner_server"),
        ("/", (OTHER, OWN), "/robot2/planner_server"),
        ("/", (("planner_server/get_state", "/x/get_state"),), "/planner_server"),
    ],
)
def test_what_a_manager_calls(
    namespace: str, rules: tuple[tuple[str, str], ...], called: str
) -> None:
    values = {"node_names": ["planner_server", "/map_server"], "autostart": True}
    node = Node("robot1", "lifecycle_manager", "manager", namespace, rules, values, ())
    assert lifecycles.managed(node) == [called, "/map_server"]
