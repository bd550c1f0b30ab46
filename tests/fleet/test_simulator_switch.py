# SPDX-License-Identifier: Apache-2.0
"""Arguments that may switch between the simulated and the real robot, and what each robot loads."""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree
from paths import fixture_text

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.file import simulator_switch as switch

GZ, IGN, CLASSIC = (
    "gz_ros2_control/GazeboSimSystem", "ign_ros2_control/IgnitionSystem",
    "gazebo_ros2_control/GazeboSystem",
)  # fmt: skip


@pytest.mark.parametrize(
    ("hardware", "maybe", "sure"),
    [
        (GZ, True, True), (IGN, True, True), (CLASSIC, True, True), ("acme/GazeboArm", True, False),
        ("acme/GzArm", True, False), ("acme/IgnArm", True, False), ("acme/SimArm", True, False),
        ("mujoco_ros2_control/MujocoSystem", True, False), ("acme/IsaacArm", True, False),
        ("acme/Driver", False, False),
    ],
)  # fmt: skip
def test_what_classes_of_simulators_are_called(hardware: str, maybe: bool, sure: bool) -> None:
    assert switch.may_be_simulated(hardware) is maybe
    assert switch.of_simulator(hardware) is sure


@pytest.mark.parametrize(
    ("file", "hardware", "simulated", "real"),
    [
        ("gz_ros2_control-system", GZ, True, False),
        ("gz_ros2_control-system", "acme/SimArm", True, True),
        ("gz_ros2_control-system", "acme/Driver", False, True), ("gz-sim-x", "acme/Driver", True, True),
        ("gz-sim-x", GZ, True, False), ("gz_ros2_control-system", "", True, True),
    ],
)  # fmt: skip
def test_what_each_of_them_can_load(file: str, hardware: str, simulated: bool, real: bool) -> None:
    """One class that it cannot load is enough; a block that is empty has none."""
    block = "<ros2_control><hardware><plugin> {} </plugin></hardware></ros2_control>"
    control = f"{block.format(hardware)}{block.format(' ')}"
    plugin = f'<plugin filename="{file}" name="p"/><plugin name="q"/>'
    urdf = f"<robot>{control}<gazebo>{plugin}</gazebo></robot>"
    sdf = f"<sdf><model>{control}{plugin}</model></sdf>"
    for text in (urdf, sdf):
        root = etree.fromstring(text)
        assert switch.suits_simulator(root) is simulated
        assert switch.suits_real(root) is real
    assert not switch.loads_hardware(etree.fromstring(f"<robot>{plugin}</robot>"))


@pytest.mark.parametrize(
    ("arguments", "more", "given", "found"),
    [
        ("use_sim=false", "", "", "use_sim=true"), ("use_gazebo=True", "", "", "use_gazebo=False"),
        ("ignition=1", "", "", "ignition=0"), ("SIM=0", "", "", "SIM=1"),
        ("use_sim=False", "", "", "use_sim=True"), ("gz=false ign=true", "", "", "gz=true ign=false"),
        ("my_gz_x=true", "", "", "my_gz_x=false"), ("gzip=true design=true", "", "", ""),
        ("sim_rate=50", "", "", ""), ("fast=true", "", "", ""),
        ("use_sim=false", "", "use_sim=true", "use_sim=false"), ("", "", "sim=true", "sim=false"),
        ("use_sim=false use_sim=true", "", "", "use_sim=true"),
        ("mode=real", "mode == 'fake' mode=='gazebo'", "", "mode=gazebo mode=fake"),
        ("mode=real", 'mode == "real" other == "x"', "", ""), ("mode=", "mode == 'x'", "", ""),
        ("mode=true", "mode == 'x'", "", ""),
        ("hw=acme/ArmSystem", "", "", f"hw={GZ} hw={IGN} hw={CLASSIC}"),
        ("hw=acme::ArmHardware", "gazebo_ros2_control", "", f"hw={CLASSIC} hw={GZ} hw={IGN}"),
        (f"hw={GZ}Interface", "ign_ros2_control", "", f"hw={GZ} hw={IGN} hw={CLASSIC}"),
        ("hw=acme/Arm", "", "", ""),
    ],
)  # fmt: skip
def test_arguments_that_may_switch(arguments: str, more: str, given: str, found: str) -> None:
    declared = "".join(
        '<xacro:arg name="{}" default="{}"/>'.format(*it.split("=")) for it in arguments.split()
    )
    head = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"'
    text = f"{head}>{declared}<!-- {more} --></robot>"
    values = dict(it.split("=") for it in given.split())
    made = [f"{name}={value}" for name, value in switch._switches({"r": text.encode()}, values)]
    assert made == found.split()


MANAGED = fixture_text("simulator_switch_managed.urdf")
CONTROLLERS = """\
controller_manager:
  ros__parameters:
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "default", "condition", "value"),
    [
        ("use_sim", "false", "$(arg use_sim)", "true"),
        ("sim_gazebo", "False", "$(arg sim_gazebo)", "True"),
        ("mode", "real", "${'$(arg mode)' == 'gazebo'}", "gazebo"),
        ("camera", "false", "$(arg camera)", ""),
    ],
)
def test_a_manager_that_an_argument_would_load_is_told_with_it(
    name: str, default: str, condition: str, value: str, tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    """A controller manager that nothing starts: what the hint says makes the description start it."""
    (tmp_path / "r.urdf.xacro").write_text(
        MANAGED.format(name=name, default=default, condition=condition)
    )
    (tmp_path / "c.yaml").write_text(CONTROLLERS)
    fleet = "distro: jazzy\nlayout: both\nsimulator: gazebo\nnode_sets: controllers\n"
    fleet += "description: r.urdf.xacro\nrobots: [{name: r1}, {name: r2, pose: {x: 1}}]\n"
    file = tmp_path / "fleet.yaml"
    file.write_text(fleet)
    command = ["build", str(file), "-o", str(tmp_path / "out")]
    assert main(command) == 1
    told = capsys.readouterr().err
    assert "MG723 nothing starts /r1/controller_manager" in told
    said = f"write arguments: {{{name}: '{value}'}}"
    assert (said in told) == bool(value)
    if value:
        file.write_text(
            f"{fleet}arguments: {{{name}: '{value}'}}\nrelated_files: {{params: c.yaml}}\n"
        )
        assert main(command) == 0
        assert "MG723" not in capsys.readouterr().err
