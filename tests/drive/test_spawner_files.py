# SPDX-License-Identifier: Apache-2.0
"""The type of a controller, where ros2_control 2.43 and later look for it (spawner.py,
controller_manager_services.py): in the manager's parameters, else in the controller's own section of a
file that the spawner gets."""

from __future__ import annotations

from pathlib import Path

import controllers
import pytest

TYPE = "ros__parameters: {type: my_controllers/Own}"


@pytest.mark.parametrize(
    ("text", "comes"),
    [
        (f"/robot1/arm: {{{TYPE}}}", True),
        (f"/**/arm: {{{TYPE}}}", True),
        (f"/robot2/arm: {{{TYPE}}}", False),
        ("/robot1/arm: {ros__parameters: {joints: [a]}}", False),
    ],
)
def test_the_type_in_a_file_of_the_spawner(text: str, comes: bool, tmp_path: Path) -> None:
    file = tmp_path / "arm.yaml"
    file.write_text(text)
    files = controllers.files_of(["arm", "--param-file", str(file)])
    manager = controllers.Manager("robot1", "/robot1", "controller_manager", [], (), True)
    found = controllers.Found([], [])
    told = controllers.with_files(manager, "arm", files)
    controllers.controller(found, "robot1", told, "arm", set(), "jazzy")
    assert [it.name for it in found.nodes] == (["arm"] if comes else [])
    assert bool(found.faults) is not comes
