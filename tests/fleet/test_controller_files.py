# SPDX-License-Identifier: Apache-2.0
"""A description of a built fleet loads the controllers' file that was built for its robot."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest
from lxml import etree

from multibot_rewrite.cli.multibot import main

ARM = """<robot name="arm">
  <link name="base_link">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  </link>
  <ros2_control name="arm" type="system">
    <hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
  </ros2_control>
  <gazebo>
    <plugin name="gz_ros2_control::GazeboSimROS2ControlPlugin" filename="gz_ros2_control-system">
      <parameters>{}</parameters>
    </plugin>
    <plugin name="other" filename="libother.so"><parameters>config/arm.yaml</parameters></plugin>
  </gazebo>
</robot>
"""
ARM_YAML = "controller_manager: {ros__parameters: {update_rate: 100}}\n"
FLEET = """layout: both
robots:
  - {name: robot1, description: urdf/arm.urdf}
  - {name: robot2, description: urdf/arm.urdf}
related_files: {params: [config/arm.yaml]}
"""


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """Return a package my_arm in a folder of another name."""
    folder = tmp_path / "src" / "arm_repo"
    (folder / "urdf").mkdir(parents=True)
    (folder / "config").mkdir()
    (folder / "package.xml").write_text("<package><name>my_arm</name></package>")
    (folder / "config" / "arm.yaml").write_text(ARM_YAML)
    (folder / "fleet.yaml").write_text(FLEET)
    return folder


def built(package: Path, path: str, *options: str, fleet: str = FLEET) -> Sequence[str]:
    """Return what the first plugin of each robot loads."""
    (package / "urdf" / "arm.urdf").write_text(ARM.format(path))
    (package / "fleet.yaml").write_text(fleet)
    out = package / "out"
    assert main(["build", str(package / "fleet.yaml"), "-o", str(out), *options]) == 0
    roots = [etree.parse(out / robot / "arm.urdf") for robot in ("robot1", "robot2")]
    # An unknown plugin may mean anything by <parameters>.
    assert {it.findall(".//parameters")[1].text for it in roots} == {"config/arm.yaml"}
    return [it.findtext(".//parameters") or "" for it in roots]


# As xacro leaves them, as an installed file, and what the build of a package finds.
@pytest.mark.slow
@pytest.mark.sample(3)
@pytest.mark.parametrize(
    "path",
    [
        "{package}/config/arm.yaml",
        "file://{package}/config/arm.yaml",
        "{package}/urdf/../config/arm.yaml",
        "/opt/ws/install/my_arm/share/my_arm/config/arm.yaml",
        "$(find my_arm)/config/arm.yaml",
        "$(find-pkg-share my_arm)/config/arm.yaml",
        "package://my_arm/config/arm.yaml",
        "../config/arm.yaml",
    ],
)
def test_each_robot_loads_its_own_file(
    package: Path, path: str, capsys: pytest.CaptureFixture[str]
) -> None:
    found = built(package, path.format(package=package))
    assert found == [f"{package}/out/{robot}/arm.yaml" for robot in ("robot1", "robot2")]
    for it in found:
        assert "/controller_manager" in Path(it).read_text()
    assert "MF708" not in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.parametrize(
    ("cmake", "path"),
    [
        ("install(DIRECTORY config DESTINATION share/my_arm/bringup)\n",
         "{package}/bringup/config/arm.yaml"),
        ("install(DIRECTORY config/ DESTINATION share/${{PROJECT_NAME}}/control)\n",
         "package://my_arm/control/arm.yaml"),
        ("install(FILES config/arm.yaml DESTINATION share/my_arm)\n", "$(find my_arm)/arm.yaml"),
        ("install(DIRECTORY config/ DESTINATION share/my_arm/control)\n",
         "/opt/ws/install/my_arm/share/my_arm/control/arm.yaml"),
    ],
)  # fmt: skip
def test_each_robot_loads_its_own_of_what_cmake_installs_elsewhere(
    package: Path, cmake: str, path: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (package / "CMakeLists.txt").write_text(cmake.format())
    found = built(package, path.format(package=package))
    assert found == [f"{package}/out/{robot}/arm.yaml" for robot in ("robot1", "robot2")]
    assert "MF708" not in capsys.readouterr().err


@pytest.mark.slow
def test_what_cmake_installs_elsewhere_is_found_without_being_listed(package: Path) -> None:
    text = "install(DIRECTORY config/ DESTINATION share/my_arm/control)\n"
    (package / "CMakeLists.txt").write_text(text)
    alone = FLEET.replace("related_files: {params: [config/arm.yaml]}\n", "")
    found = built(package, f"{package}/control/arm.yaml", fleet=alone)
    assert found == [f"{package}/out/{robot}/arm.yaml" for robot in ("robot1", "robot2")]


@pytest.mark.slow
def test_what_is_said_of_another_file_can_be_done(
    package: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """One that is there is named under params; one that is not is none to name."""
    built(package, "/nowhere/arm.yaml")
    assert "write the path of the one under params into <parameters>" in capsys.readouterr().err
    other = package / "other" / "arm.yaml"
    other.parent.mkdir()
    other.write_text((package / "config" / "arm.yaml").read_text())
    built(package, str(other))
    assert "name this very file under params" in capsys.readouterr().err
    found = built(package, str(other), fleet=FLEET.replace("config/arm.yaml", "other/arm.yaml"))
    assert found[0].endswith("out/robot1/arm.yaml")
    assert "MF708" not in capsys.readouterr().err


@pytest.mark.more
def test_a_linked_install_is_the_same_file(package: Path, tmp_path: Path) -> None:
    (tmp_path / "install").symlink_to(package)
    assert built(package, f"{tmp_path}/install/config/arm.yaml")[0].endswith("out/robot1/arm.yaml")


@pytest.mark.slow
@pytest.mark.parametrize(
    "path",
    [
        "/opt/ws/install/my_arm/share/my_arm/other/arm.yaml",
        "$(find your_arm)/config/arm.yaml",
        "/nowhere/arm.yaml",
        "arm.yaml",
    ],
)
def test_another_file_of_that_name_is_reported(
    package: Path, path: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert built(package, path) == [path, path]
    assert f"still loads '{path}'" in capsys.readouterr().err


@pytest.mark.more
def test_a_file_that_is_no_related_file_stays(
    package: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert built(package, "/nowhere/other.yaml") == ["/nowhere/other.yaml"] * 2
    assert "MF708" not in capsys.readouterr().err


@pytest.mark.more
def test_values_in_the_fleet_file_are_no_file_of_a_plugin(package: Path) -> None:
    values = "{manager: {rate: 5}}"
    fleet = FLEET.replace("[config/arm.yaml]", f"[{values}, config/arm.yaml]")
    assert built(package, f"{package}/config/arm.yaml", fleet=fleet)[0].endswith("robot1/arm.yaml")


@pytest.mark.more
def test_the_fleet_file_says_where_the_results_are_installed(package: Path) -> None:
    fleet = f"installed: /opt/ws/share/my_arm/fleet\n{FLEET}"
    found = built(package, "../config/arm.yaml", fleet=fleet)
    assert found[1] == "/opt/ws/share/my_arm/fleet/robot2/arm.yaml"


@pytest.mark.more
def test_a_path_is_escaped_and_the_rest_is_as_it_was(package: Path) -> None:
    path = "<!-- ours -->\n    ../config/arm.yaml <!-- theirs -->"
    (package / "urdf" / "arm.urdf").write_text(ARM.format(path))
    out = package / "a&b"
    assert main(["build", str(package / "fleet.yaml"), "-o", str(out)]) == 0
    text = (out / "robot1" / "arm.urdf").read_text()
    new = f"{package}/a&amp;b/robot1/arm.yaml"
    assert f"<parameters>{path.replace('../config/arm.yaml', new)}</parameters>" in text


@pytest.mark.more
def test_a_second_build_finds_nothing_to_do(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    built(package, "../config/arm.yaml")
    monkeypatch.chdir(package)
    assert main(["build", "fleet.yaml", "-o", "out", "--check"]) == 0
