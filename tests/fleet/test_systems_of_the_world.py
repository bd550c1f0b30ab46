# SPDX-License-Identifier: Apache-2.0
"""Systems of the whole world in a robot's description: loaded once, by the world.

Expected: gz-sim makes an object of each <plugin> (src/SystemManager.cc), so of each system there has to
be one in all that it reads: the world and every description that is spawned.
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
from lxml import etree

from multibot_rewrite.cli.multibot import main

LIDAR = (
    '<sensor name="eye" type="gpu_lidar"><topic>scan</topic><update_rate>5</update_rate></sensor>'
)
ROVER = """<robot name="rover"><link name="base_link"><inertial><mass value="1"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<gazebo reference="base_link">{sensor}</gazebo><gazebo>{plugins}</gazebo></robot>"""
SENSORS = (
    '<plugin name="gz::sim::systems::Sensors" filename="{}">'
    "<render_engine>{}</render_engine></plugin>"
)
OGRE = SENSORS.format("gz-sim-sensors-system", "ogre")
DRIVE = '<plugin name="gz::sim::systems::DiffDrive" filename="gz-sim-diff-drive-system"/>'
WORLD = '<sdf version="1.9"><world name="lake">{}</world></sdf>'
FLEET = (
    "layout: both\ndistro: {}\nsimulator: {}\n{}robots:\n"
    "  - {{name: r1, description: r1.urdf, pose: {{y: 0}}}}\n"
    "  - {{name: r2, description: r2.urdf, pose: {{y: 5}}}}\n"
)


def _built(
    folder: Path,
    *plugins: str,
    distro: str = "jazzy",
    simulator: str = "gazebo",
    world: str = "",
    sensor: str = LIDAR,
) -> Path:
    for number, own in enumerate(plugins, 1):
        (folder / f"r{number}.urdf").write_text(ROVER.format(sensor=sensor, plugins=own))
    more = "simulator_world: lake.sdf\n" if world else ""
    (folder / "lake.sdf").write_text(world)
    (folder / "fleet.yaml").write_text(FLEET.format(distro, simulator, more))
    assert main(["build", str(folder / "fleet.yaml"), "-o", str(folder / "out")]) == 0
    return folder / "out"


def _systems(out: Path) -> Counter[str]:
    """How often each library is loaded by the world and the robots."""
    roots = [etree.parse(it).getroot() for it in [*out.glob("*.sdf"), *out.glob("r?/*.urdf")]]
    return Counter(it.get("filename") or "" for root in roots for it in root.iter("plugin"))


def test_a_system_without_a_sensor_is_moved_too(tmp_path: Path) -> None:
    name = "gz::sim::systems::WindEffects"
    wind = f'<plugin name="{name}" filename="gz-sim-wind-effects-system"><x>1</x></plugin>'
    out = _built(tmp_path, wind, wind, sensor="")
    assert _systems(out)["gz-sim-wind-effects-system"] == 1
    assert etree.parse(out / "world.sdf").findtext("world/plugin/x") == "1"


def test_the_worlds_own_stays(tmp_path: Path) -> None:
    own = SENSORS.format("gz-sim-sensors-system", "ogre2")
    out = _built(tmp_path, OGRE, OGRE, world=WORLD.format(own))
    assert _systems(out)["gz-sim-sensors-system"] == 1
    assert etree.parse(out / "world.sdf").findtext("world/plugin/render_engine") == "ogre2"


def test_other_settings_of_the_second_robot_are_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = SENSORS.format("gz-sim-sensors-system", "ogre2")
    out = _built(tmp_path, OGRE, other)
    assert etree.parse(out / "world.sdf").findtext("world/plugin/render_engine") == "ogre"
    said = capsys.readouterr().err
    assert "fleet.yaml:6:1: warning: MF847 r2 has other settings of gz-sim-sensors-system" in said


def test_a_real_robot_is_not_blamed_for_them(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """No Gazebo loads the description of a real robot."""
    _built(tmp_path, OGRE, OGRE, simulator="none")
    said = capsys.readouterr().err
    assert "MB416" not in said and "not verified" not in said


def test_a_frame_that_nobody_chose_is_no_error(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without gz_frame_id Gazebo's frame ends with the sensor's name, also if a link has that name."""
    _built(tmp_path, OGRE, OGRE, sensor=LIDAR.replace('"eye"', '"base_link"'))
    text = (tmp_path / "fleet.yaml").read_text()
    (tmp_path / "fleet.yaml").write_text(text.replace("both", "tf-per-robot"))
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "shared")]) == 0
    assert "warning: MG412" in capsys.readouterr().err
