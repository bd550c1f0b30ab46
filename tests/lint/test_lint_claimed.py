# SPDX-License-Identifier: Apache-2.0
"""MB229, MB240 and MB230: what a description and the file of its controllers say of each other."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.rules.settings import Settings

JOINT = '<joint name="j" type="revolute"><parent link="a"/><child link="b"/></joint>'
SYSTEM = """
<ros2_control name="s" type="system">
<joint name="j">
<command_interface name="position"/>
<state_interface name="position"/>
</joint>
</ros2_control>"""
LOADS = """
<gazebo><plugin name="p" filename="gz_ros2_control-system">
<parameters>{}</parameters>
</plugin></gazebo>"""
CONTROLLERS = """\
controller_manager:
  ros__parameters:
    arm: {type: joint_trajectory_controller/JointTrajectoryController}
arm:
  ros__parameters:
    joints: [JOINT]
    command_interfaces: [COMMAND]
    state_interfaces: [position]
"""


def lint(
    folder: Path, body: str, controllers: str = "controllers.yaml", **words: str
) -> list[Finding]:
    text = CONTROLLERS
    for name, word in {"JOINT": "j", "COMMAND": "position", **words}.items():
        text = text.replace(name, word)
    (folder / controllers).parent.mkdir(parents=True, exist_ok=True)
    (folder / controllers).write_text(text)
    file = folder / "arm.urdf"
    file.write_text(f'<robot name="r"><link name="a"/><link name="b"/>{JOINT}{body}\n</robot>')
    return lint_file(str(file), Settings(select=("MB229", "MB230"), roots=(str(folder),)))


NAMED = [
    ("controllers.yaml", "controllers.yaml"),
    ("file://config/arm.yaml", "config/arm.yaml"),
    ("$(find arm_bringup)/config/arm.yaml", "arm_bringup/config/arm.yaml"),
]


@pytest.mark.parametrize(("named", "file"), NAMED)
def test_the_file_that_the_description_names(named: str, file: str, tmp_path: Path) -> None:
    body = SYSTEM + LOADS.format(named)
    assert lint(tmp_path, body, file) == []
    (it,) = lint(tmp_path, body, file, COMMAND="velocity")
    assert (it.code, it.line) == ("MB229", 9)
    assert it.message.startswith(f"{Path(file).name}:6: /arm claims command interface j/velocity")


CHOSEN = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="way" default="position"/>
<xacro:macro name="driven" params="way"><ros2_control name="s" type="system"><joint name="j">
<command_interface name="%s"/><state_interface name="position"/></joint></ros2_control></xacro:macro>
<link name="a"/><link name="b"/>{}<xacro:driven way="%s"/>{}</robot>""".format(
    JOINT, LOADS.format("controllers.yaml")
)


@pytest.mark.parametrize(
    ("interface", "given", "state", "found"),
    [
        ("${way}", "$(arg way)", "position", []),
        ("$(arg way)", "", "position", []),
        ("${way}", "position", "position", ["MB229"]),
        ("position", "$(arg way)", "position", ["MB229"]),
        ("${way}", "$(arg way)", "velocity", ["MB229"]),
    ],
)
def test_an_interface_that_an_argument_chooses_may_be_another_one(
    interface: str, given: str, state: str, found: list[str], tmp_path: Path
) -> None:
    text = CONTROLLERS.replace("JOINT", "j").replace("COMMAND", "velocity")
    text = text.replace("state_interfaces: [position]", f"state_interfaces: [{state}]")
    (tmp_path / "controllers.yaml").write_text(text)
    file = tmp_path / "arm.urdf.xacro"
    file.write_text(CHOSEN % (interface, given))
    settings = Settings(select=("MB229",), roots=(str(tmp_path),))
    assert [it.code for it in lint_file(str(file), settings)] == found


FILED = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="file" default="controllers.yaml"/>
<link name="a"/><link name="b"/>{}{}{}</robot>""".format(
    JOINT.replace('"j"', '"R_j"'), SYSTEM.replace('"j"', '"R_j"'), LOADS
)


@pytest.mark.parametrize(("file", "found"), [("$(arg file)", []), ("controllers.yaml", ["MB229"])])
def test_a_file_that_an_argument_names_may_be_of_another_robot(
    file: str, found: list[str], tmp_path: Path
) -> None:
    text = CONTROLLERS.replace("JOINT", "j").replace("COMMAND", "position")
    (tmp_path / "controllers.yaml").write_text(text)
    path = tmp_path / "arm.urdf.xacro"
    path.write_text(FILED.format(file))
    settings = Settings(select=("MB229",), roots=(str(tmp_path),))
    assert [it.code for it in lint_file(str(path), settings)] == found


@pytest.mark.parametrize(
    ("command", "named", "found"),
    # Of a robot that is not named nothing is certain.
    [("effort", True, [("MB229", 6)]), ("position", True, []), ("effort", False, [])],
)
def test_a_file_of_controllers_of_the_robot_that_is_named(
    command: str, named: bool, found: list[tuple[str, int]], tmp_path: Path
) -> None:
    lint(tmp_path, SYSTEM, "more/own.yaml", COMMAND=command)
    urdf = str(tmp_path / "arm.urdf") if named else ""
    settings = Settings(select=("MB229",), urdf=urdf)
    found_in = lint_file(str(tmp_path / "more/own.yaml"), settings)
    assert [(it.code, it.line) for it in found_in] == found


@pytest.mark.slow
def test_without_ros2_control_nothing_is_read(tmp_path: Path) -> None:
    assert lint(tmp_path, LOADS.format("controllers.yaml"), JOINT="other") == []
    code = (
        "import sys; from multibot_rewrite.lint.check import lint_file;"
        "from multibot_rewrite.rules.settings import Settings;"
        "lint_file(sys.argv[1], Settings());"
        "print([it for it in sys.modules if '.evidence' in it or 'rules.system.states' in it])"
    )
    run = [sys.executable, "-c", code, str(tmp_path / "arm.urdf")]
    assert subprocess.run(run, capture_output=True, text=True, check=True).stdout == "[]\n"


DRIVE = """
<gazebo><plugin name="p" filename="{}"><ros/>
<publish_odom_tf>{}</publish_odom_tf><robot_base_frame>{}</robot_base_frame>
<frame_id>odom</frame_id><child_frame_id>{}</child_frame_id>
</plugin></gazebo>"""
CLASSIC, GZ = "libgazebo_ros_diff_drive.so", "gz-sim-diff-drive-system"


@pytest.mark.parametrize(
    ("plugin", "switch", "base", "found"),
    [
        (CLASSIC, "true", "b", ["MB230"]),
        (CLASSIC, "true", "a", []),
        (CLASSIC, "false", "b", []),
        (GZ, "true", "b", ["MB230"]),
        (GZ, "true", "a", []),
    ],
)
def test_frames_of_plugins(
    plugin: str, switch: str, base: str, found: list[str], tmp_path: Path
) -> None:
    assert [it.code for it in lint(tmp_path, DRIVE.format(plugin, switch, base, base))] == found
