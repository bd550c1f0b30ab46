# SPDX-License-Identifier: Apache-2.0
"""Spawners that ask for a controller manager that nothing starts."""

from __future__ import annotations

import pytest
from launched_nodes import launched, started

MANAGER = started("controller_manager", "ros2_control_node", namespace="/robot1")


@pytest.mark.parametrize(
    ("words", "asked"),
    [
        # As Husarion's ROSbot has it: the namespace is there twice.
        (("-n", "robot1", "-c", "robot1/controller_manager"), "/robot1/robot1/controller_manager"),
        (("-n", "robot1", "-c", "controller_manager"), ""),
        (("-c", "/robot1/controller_manager"), ""),
        (("-c", "/robot1/manager"), "/robot1/manager"),
        ((), "/controller_manager"),
    ],
)
def test_a_spawner_asks_for_a_manager_that_runs(words: tuple[str, ...], asked: str) -> None:
    spawner = started("controller_manager", "spawner", arguments=("drive", "lift", *words))
    found = launched(MANAGER, spawner)
    said = [it.message for it in found.findings if it.code == "MG723"]
    text = f"the spawner of drive, lift asks for {asked}, which nothing starts"
    assert said == ([text] if asked else [])
    assert {it.manager for it in found.spawned.values()} == {"/robot1/controller_manager"}
    assert {"drive", "lift"} == set(found.spawned)
