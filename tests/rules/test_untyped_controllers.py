# SPDX-License-Identifier: Apache-2.0
"""Controllers that spawners load: their type is a parameter of their manager.

Expected: ros2_control controller_manager.cpp reads ``NAME.type`` of the manager's own node, whatever
that is called, so ``/**`` is for it, too; spawner.py sets it from ``--param-file`` and, in Humble,
from ``--controller-type``.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import fixture_text

from multibot_rewrite.cli.multibot import main

LAUNCH = fixture_text("untyped_controllers_launch.txt")
MANAGER = (
    'Node(package="controller_manager", executable="ros2_control_node", name="{}",'
    ' namespace="{}", parameters=[{}]),'
)
TYPE = "joint_state_broadcaster/JointStateBroadcaster"
JSB = 'arguments=["jsb", "-c", "{}"{}]'
FILE = 'str(HERE / "c.yaml")'


def _codes(folder: Path, capsys: pytest.CaptureFixture[str], *words: str) -> list[str]:
    main(["check-launch", str(folder / "a.launch.py"), *words])
    return [it.split()[2] for it in capsys.readouterr().out.splitlines() if " MG7" in it]


@pytest.mark.more
@pytest.mark.parametrize(
    ("name", "space", "given", "file", "more", "found"),
    [
        ("controller_manager", "", "", "", "", ["MG728"]),
        ("cm", "/r", "", "", "", ["MG728"]),
        ("cm", "", f'{{"jsb.type": "{TYPE}"}}', "", "", []),
        ("cm", "/r", f'{{"jsb": {{"type": "{TYPE}"}}}}', "", "", []),
        # Another controller's.
        ("cm", "", f'{{"jsb2.type": "{TYPE}"}}', "", "", ["MG728"]),
        ("cm", "", FILE, f"/**: {{ros__parameters: {{jsb: {{type: {TYPE}}}}}}}", "", []),
        ("cm", "/r", FILE, f"/r/cm: {{ros__parameters: {{jsb: {{type: {TYPE}}}}}}}", "", []),
        # rclcpp parameter_map.cpp: ** stands for any number of namespaces, * for one.
        ("cm", "/r", FILE, f"/**/cm: {{ros__parameters: {{jsb: {{type: {TYPE}}}}}}}", "", []),
        ("cm", "", FILE, f"/*/cm: {{ros__parameters: {{jsb: {{type: {TYPE}}}}}}}", "", ["MG728"]),
        # Of another robot's manager: rcl hands on nothing of it.
        ("cm", "/r", FILE, f"/q/cm: {{ros__parameters: {{jsb: {{type: {TYPE}}}}}}}", "", ["MG728"]),
        (
            "controller_manager", "", "", f"jsb: {{ros__parameters: {{type: {TYPE}}}}}",
            f', "--param-file", {FILE}', [],
        ),
        ("cm", "", "", "", f', "--controller-type", "{TYPE}"', []),
        # What is not known may have it.
        ("cm", "", 'LaunchConfiguration("file")', "", "", []),
    ],
)  # fmt: skip
def test_its_type_is_a_parameter_of_its_manager(
    name: str,
    space: str,
    given: str,
    file: str,
    more: str,
    found: list[str],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    (tmp_path / "c.yaml").write_text(file)
    manager = MANAGER.format(name, space, given)
    text = LAUNCH.format(manager=manager, space=space, spawner=JSB.format(name, more))
    if "LaunchConfiguration" in given:
        text = "from launch.substitutions import LaunchConfiguration\n" + text
    (tmp_path / "a.launch.py").write_text(text)
    assert _codes(tmp_path, capsys) == found
