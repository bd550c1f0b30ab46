# SPDX-License-Identifier: Apache-2.0
"""Nodes that hardware makes in the process of its controller manager, and devices that an argument of
the xacro gives: what is written for each robot, and what the remedy is where it cannot be."""

from __future__ import annotations

from pathlib import Path

import pytest
from fleet_folder import planned_fleet

from multibot_rewrite import load_fleet, rewrite
from multibot_rewrite.base.findings.finding import ERROR

ROBOT = """\
<robot name="k" xmlns:xacro="http://www.ros.org/wiki/xacro">
  {declared}
  <link name="base_link"/><link name="w"/>
  <joint name="wheel" type="continuous"><parent link="base_link"/><child link="w"/></joint>
  <ros2_control name="s" type="system">
    <hardware><plugin>{plugin}</plugin><param name="serial_port">{port}</param></hardware>
    <joint name="wheel"><command_interface name="velocity"/><state_interface name="velocity"/></joint>
  </ros2_control>
</robot>
"""
CONTROLLERS = """\
controller_manager:
  ros__parameters:
    wheels: {type: forward_command_controller/ForwardCommandController}
wheels:
  ros__parameters: {joints: [wheel], interface_name: velocity}
"""
STS = "sts_hardware_interface/STSHardwareInterface"
XARM = "uf_robot_hardware/UFRobotSystemHardware"


def fleet(
    folder: Path,
    plugin: str = STS,
    declared: str = "",
    port: str = "/dev/a",
    robots: str = "[{name: r1}, {name: r2}]",
) -> str:
    text = ROBOT.format(declared=declared, plugin=plugin, port=port)
    (folder / "k.urdf.xacro").write_text(text)
    (folder / "c.yaml").write_text(CONTROLLERS)
    file = folder / "fleet.yaml"
    file.write_text(
        "layout: frames-per-robot\naffix: prefix\ndistro: kilted\nsimulator: none\n"
        "node_sets: ros2_control\n"
        f"description: k.urdf.xacro\nrelated_files: {{params: c.yaml}}\nrobots: {robots}\n"
    )
    return str(file)


@pytest.mark.slow
@pytest.mark.parametrize(
    "node", ["sts_hardware_interface_node", "ufactory_driver", "ufactory_robot_hw"]
)
def test_a_node_of_hardware_is_none_that_the_launch_file_misses(node: str, tmp_path: Path) -> None:
    made = load_fleet(fleet(tmp_path, STS if node.startswith("sts") else XARM))
    assert f"/r1/{node}" in {it.full_name for it in made.plan.fleet.table.runs}
    assert [it for it in made.made.findings if it.level == ERROR] == []


def test_an_emergency_stop_of_all_robots_is_not_called_shared() -> None:
    """Of a description alone nothing has the rule: it is said which to give, and to whom."""
    text = ROBOT.format(declared="", plugin=STS, port="/dev/a")
    found = rewrite(text, "r1", distro="kilted").findings
    (hint,) = [it.hint for it in found if it.code == "MG305" and "emergency_stop" in it.message]
    assert "-r /emergency_stop:=emergency_stop" in hint and "controller manager" in hint
    assert "shared" not in hint


ARGUMENT = '<xacro:arg name="{}" default="{}"/>'
VIA = '<xacro:property name="port" default="/dev/a"/>'


OWN_YAML = """<xacro:property name="own" value="${xacro.load_yaml('own.yaml')}"/>
  <material name="m${own['a']}"/>"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("declared", "port", "argument"),
    [
        (ARGUMENT.format("serial_port", "/dev/a"), "$(arg serial_port)", "serial_port"),
        (VIA + ARGUMENT.format("serial_port", "${port}"), "$(arg serial_port)", "serial_port"),
        (VIA + ARGUMENT.format("other", "x") + ARGUMENT.format("usb", "${port}"), "$(arg usb)", "usb"),
        (ARGUMENT.format("dev", "/dev/a") + '<xacro:property name="at" value="$(arg dev)"/>', "${at}",
         "dev"),
        (ARGUMENT.format("n", "a"), "/dev/$(arg n)", "n"),
        (VIA + ARGUMENT.format("other", "x"), "${port}", ""),
        (VIA + ARGUMENT.format("usb", "${port}") + OWN_YAML, "$(arg usb)", "usb"),
    ],
)  # fmt: skip
def test_the_remedy_for_one_device_names_the_argument_and_helps(
    declared: str, port: str, argument: str, tmp_path: Path
) -> None:
    (tmp_path / "own.yaml").write_text("a: 1\n")
    made = load_fleet(fleet(tmp_path, declared=declared, port=port))
    (told,) = [it for it in made.made.findings if it.code == "MB412"]
    if not argument:
        assert "make an argument of the value in" in told.hint
        return
    assert f"in the fleet file: arguments: {{{argument}: ...}}" in told.hint
    assert "make an argument" not in told.hint
    own = (f"{{name: {it}, arguments: {{{argument}: /dev/{it}}}}}" for it in ("r1", "r2"))
    robots = f"[{', '.join(own)}]"
    mended = load_fleet(fleet(tmp_path, declared=declared, port=port, robots=robots))
    assert "MB412" not in {it.code for it in mended.made.findings}


@pytest.mark.parametrize(
    ("layout", "release", "node"),
    [
        # hardware_component_interface.cpp:124: the name in small letters, beside the manager.
        ("tf-per-robot", "lyrical", "/R1/arm_left"),
        ("frames-per-robot", "lyrical", "/R1/r1_arm_left"),
        ("postfix", "lyrical", "/r1_arm_left"),
        # Humble's ros2_control has none.
        ("tf-per-robot", "humble", ""),
    ],
)
def test_each_hardware_component_has_a_node(
    layout: str, release: str, node: str, tmp_path: Path
) -> None:
    path = Path(fleet(tmp_path, "mock_components/GenericSystem", robots="[{name: R1}, {name: r2}]"))
    source = tmp_path / "k.urdf.xacro"
    source.write_text(source.read_text().replace('name="s"', 'name="Arm/Left"'))
    text = path.read_text().replace("frames-per-robot", layout).replace("kilted", release)
    path.write_text(text)
    table = planned_fleet(path).fleet.table
    made = {it.full_name for it in table.runs if it.fact.of_hardware and it.robot == "R1"}
    assert made == ({node} if node else set())
