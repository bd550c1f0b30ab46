# SPDX-License-Identifier: Apache-2.0
"""A world of the user's: without the robot that it has, with the names of the fleet's robots.

The shapes are those of osrf/vrx vrx_gz/worlds (``wind_obj`` of USVWind.cc, several are read; one
``vehicle`` of ScoringPlugin.cc) and of ArduPilot's iris_runway.sdf; a name leads to what gz-sim's
entitiesFromScopedName reads it.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree
from paths import fixture_text

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.outputs.world_file import world_topics

BOAT = """<sdf version="1.9"><model name="boat"><link name="hull"/>
<link name="mast"><sensor name="imu" type="imu"/></link></model></sdf>"""
WORLD = fixture_text("given_world_world.txt")


@pytest.fixture
def fleet(tmp_path: Path) -> Path:
    (tmp_path / "boat").mkdir()
    (tmp_path / "boat" / "model.sdf").write_text(BOAT)
    config = "<model><sdf version='1.9'>model.sdf</sdf></model>"
    (tmp_path / "boat" / "model.config").write_text(config)
    (tmp_path / "meshes").mkdir()
    (tmp_path / "lake.sdf").write_text(WORLD)
    (tmp_path / "fleet.yaml").write_text(
        "layout: both\ndistro: jazzy\nsimulator: gazebo\nsimulator_world: lake.sdf\n"
        "description: boat/model.sdf\nrobots:\n"
        "  - {name: r1, pose: {y: 0}}\n  - {name: r2, model: second, pose: {y: 5}}\n"
    )
    return tmp_path / "fleet.yaml"


def _built(fleet: Path) -> etree._Element:
    assert main(["build", str(fleet), "-o", str(fleet.parent / "out")]) == 0
    return etree.parse(str(fleet.parent / "out" / "world.sdf")).getroot()


def _texts(root: etree._Element, tag: str) -> list[str]:
    return [it.text or "" for it in root.iter(tag)]


@pytest.mark.more
def test_plugins_of_the_world_name_the_robots(fleet: Path) -> None:
    root = _built(fleet)
    named = [(it.findtext("name"), it.findtext("link_name")) for it in root.iter("wind_obj")]
    assert named == [("r1", "hull/r1"), ("second", "hull/r2"), ("buoy", "hull")]
    assert _texts(root, "vehicle") == ["r1"]
    assert _texts(root, "enable") == ["r1::hull/r1"]
    assert _texts(root, "topic") == ["/model/r1/pose"]
    assert _texts(root, "gain") == ["1", "1"] and _texts(root, "rate") == ["10"]


@pytest.mark.more
def test_the_robot_of_the_world_is_left_out_and_all_else_stays(fleet: Path) -> None:
    root = _built(fleet)
    (buoy,) = root.iter("include")
    assert buoy.findtext("name") == "buoy"
    # A path beside the world, which the copy no longer lies beside.
    assert buoy.findtext("uri") == f"file://{fleet.parent / 'meshes'}"
    assert [it.get("name") for it in root.iter("model")] == ["hull"]
    assert [it.getparent().get("name") for it in root.iter("link")] == ["hull"]


@pytest.mark.more
def test_the_sensors_of_the_robots_run_in_it(fleet: Path) -> None:
    """gz-sim: sensors of a world without their system send nothing; physics is there already."""
    files = [it.get("filename") for it in _built(fleet).iter("plugin")]
    assert files.count("gz-sim-imu-system") == 1 and files.count("gz-sim-physics-system") == 1


@pytest.mark.more
@pytest.mark.parametrize(
    ("named", "drive", "added"),
    [
        ("physics", False, ["user-commands"]),
        ("scene-broadcaster", False, ["user-commands"]),
        ("scene-broadcaster", True, ["user-commands", "physics"]),
        ("user-commands", False, []),
        ("", True, []),
    ],
)
def test_a_world_that_names_systems_spawns_and_moves_the_robots(
    named: str, drive: bool, added: list[str], fleet: Path
) -> None:
    """gz-sim ServerConfig.cc: only a world without any system gets those of server.config."""
    plugin = '<plugin filename="gz-sim-{}-system" name="gz::sim::systems::X"/>'
    world = plugin.format(named) if named else ""
    (fleet.parent / "lake.sdf").write_text(
        f'<sdf version="1.9"><world name="w">{world}</world></sdf>'
    )
    model = fleet.parent / "boat" / "model.sdf"
    text = model.read_text().replace(BOAT.partition("\n")[2], "")
    body = '<sdf version="1.9"><model name="boat"><link name="hull"/>{}</model></sdf>'
    wheels = '<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"/>'
    assert text
    model.write_text(body.format(wheels if drive else ""))
    files = [it.get("filename") for it in _built(fleet).iter("plugin")]
    assert [it for it in files if it != f"gz-sim-{named}-system"] == [
        f"gz-sim-{it}-system" for it in added
    ]


@pytest.mark.more
def test_what_stands_before_all_links_is_the_name_that_it_is_spawned_by(fleet: Path) -> None:
    """As in vrx_urdf's wamv_gazebo: wamv/base_link, wamv/gps_link; here with a part of a part."""
    model = fleet.parent / "boat" / "model.sdf"
    named = BOAT.replace('"hull"', '"wamv/hull"').replace('"mast"', '"wamv/mast/top"')
    model.write_text(named)
    world = fleet.parent / "lake.sdf"
    world.write_text(WORLD.replace("<vehicle>boat", "<vehicle>wamv"))
    assert _texts(_built(fleet), "vehicle") == ["r1"]
    # A link of another word in front: it is no name.
    model.write_text(named.replace("wamv/mast", "mast"))
    assert _texts(_built(fleet), "vehicle") == ["wamv"]


@pytest.mark.more
def test_what_is_said_of_it(fleet: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _built(fleet)
    said = capsys.readouterr().err
    assert "fleet.yaml:4:1: note: MF846 the world's 'boat' is left out" in said
    assert "MF846 Scoring of the world names one robot in <vehicle>: now r1 alone" in said
    assert "USVWind" not in said


@pytest.mark.parametrize(
    ("text", "wanted"),
    [(BOAT, "no <world>"), ("<sdf", "lake.sdf:1"), (None, "lake.sdf does not exist")],
)
def test_what_is_no_world(
    fleet: Path, text: str | None, wanted: str, capsys: pytest.CaptureFixture[str]
) -> None:
    world = fleet.parent / "lake.sdf"
    world.write_text(text) if text else world.unlink()
    assert main(["build", str(fleet), "-o", str(fleet.parent / "out")]) == 2
    assert wanted in capsys.readouterr().err
    assert not (fleet.parent / "out").exists()


def test_what_a_world_sends_is_known(tmp_path: Path) -> None:
    """SceneBroadcaster is not in this world, so its topics are not there; Gazebo's own has it."""
    file = tmp_path / "lake.sdf"
    file.write_text(WORLD)
    found = world_topics(str(file))
    assert found == {
        "/model/boat/pose": "",
        "/world/lake/clock": "gz.msgs.Clock",
        "/world/lake/stats": "gz.msgs.WorldStatistics",
    }
    file.write_text(WORLD.replace("gz-sim-physics-system", "gz-sim-scene-broadcaster-system"))
    assert world_topics(str(file))["/world/lake/pose/info"] == "gz.msgs.Pose_V"
    assert world_topics("")["/world/empty/dynamic_pose/info"] == "gz.msgs.Pose_V"
