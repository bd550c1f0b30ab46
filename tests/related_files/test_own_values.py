# SPDX-License-Identifier: Apache-2.0
"""What one node has for itself: ports and files that it writes, as build gives them to each robot.

rosbridge_suite rosbridge_websocket.py binds ``port``, robot_localization ros_filter.cpp writes
``debug_out_file``, nav2_waypoint_follower photo_at_waypoint.cpp makes ``save_dir``: two nodes of one
computer must differ in each, and keep what does not name the place.
"""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from paths import fixture_text

from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.checks.judged_plan import plan_fleet
from multibot_rewrite.fleet.file.fleet_file import read_fleet

URDF = '<robot name="rover"><link name="base_link"/></robot>'
PARAMS = fixture_text("own_values_params.yaml")


def _built(
    folder: Path, robots: str, port: str = "9090", own: str = "own_nodes: [rosbridge_websocket]\n"
) -> tuple[dict[str, str], list[Finding]]:
    (folder / "rover.urdf").write_text(URDF)
    (folder / "params.yaml").write_text(PARAMS.format(port=port))
    (folder / "fleet.yaml").write_text(
        f"layout: both\ndistro: jazzy\ndescription: rover.urdf\nrobots:\n{robots}"
        f"related_files: {{params: params.yaml}}\n{own}"
    )
    made = make_outputs(plan_fleet(read_fleet(str(folder / "fleet.yaml"), "", {})), str(folder))
    return {it.path: it.text for it in made.files}, list(made.findings)


def _of(text: str, node: str) -> dict[str, object]:
    (found,) = (
        body["ros__parameters"] for name, body in yaml.safe_load(text).items() if node in name
    )
    return dict(found)


THREE = "".join(f"  - {{name: robot{at}}}\n" for at in (1, 2, 3))


@pytest.mark.parametrize("port", ["9090", "'9090'"])
def test_each_robot_has_a_port_and_files_of_its_own(tmp_path: Path, port: str) -> None:
    texts, said = _built(tmp_path, THREE, port)
    each = [texts[f"robot{at}/params.yaml"] for at in (1, 2, 3)]
    kind = type(yaml.safe_load(port))
    numbers = [_of(it, "rosbridge")["port"] for it in each]
    assert numbers == [kind(it) for it in (9090, 9100, 9110)]
    folders = {_of(it, "waypoint")["photo"]["save_dir"] for it in each}  # type: ignore[index]
    assert folders == {f"/tmp/photos_robot{at}" for at in (1, 2, 3)}
    files = {_of(it, "ekf")["debug_out_file"] for it in each}
    assert files == {f"~/logs/ekf.debug_robot{at}.txt" for at in (1, 2, 3)}
    (note,) = (it for it in said if it.code == "MF845")
    assert (note.line, note.level) == (3, NOTE)
    assert "robot1 9090, robot2 9100, robot3 9110" in note.message


def test_a_node_that_runs_once_keeps_its_section(tmp_path: Path) -> None:
    """foxglove_bridge and rosbridge serve all robots where the fleet file does not say otherwise."""
    texts, said = _built(tmp_path, THREE, own="")
    assert all("\nrosbridge_websocket:" in f"\n{texts[f'robot{at}/params.yaml']}" for at in (1, 3))
    assert [_of(texts[f"robot{at}/params.yaml"], "rosbridge")["port"] for at in (1, 3)] == [
        9090
    ] * 2
    assert "MF845" not in {it.code for it in said}


def test_what_a_strange_node_opens_stays_and_is_said(tmp_path: Path) -> None:
    texts, said = _built(tmp_path, THREE)
    own = yaml.safe_load(PARAMS.format(port=1))["camera"]["ros__parameters"]
    assert all(_of(texts[f"robot{at}/params.yaml"], "camera") == own for at in (1, 2, 3))
    told = {(it.message.split()[0], it.level) for it in said if it.code == "MB412"}
    assert told == {("device", NOTE), ("save_path", NOTE), ("stream_port", NOTE)}


def test_a_file_of_one_robot_keeps_its_port(tmp_path: Path) -> None:
    (tmp_path / "other.yaml").write_text(PARAMS.format(port="9191"))
    other = "  - {name: robot1}\n  - {name: robot2, related_files: {params: other.yaml}}\n"
    texts, said = _built(tmp_path, other)
    ports = [
        _of(texts[it], "rosbridge")["port"] for it in ("robot1/params.yaml", "robot2/other.yaml")
    ]
    assert ports == [9090, 9191]
    assert not [it for it in said if it.code == "MF845"]
    # What both files have is told at the second one, but for the port.
    told = " ".join(it.message for it in said if it.code == "MB412")
    same = ("/tmp/photos", "ekf.debug.txt", "/dev/video0", "/tmp/pictures", "8554")
    assert [word for word in (*same, "9090", "9191") if word in told] == list(same)


ARM = fixture_text("own_values_arm.urdf")
DRIVERS = """\
lidar:
  ros__parameters: {device_ip: 192.168.1.201, host_ip: 192.168.1.100}
camera:
  ros__parameters: {serial_no: "'819612'", ip: 127.0.0.1, hostname: camera}
"""


def _arms(folder: Path, plugin: str, robots: str) -> list[Finding]:
    (folder / "arm.urdf.xacro").write_text(ARM.format(plugin=plugin))
    (folder / "drivers.yaml").write_text(DRIVERS)
    (folder / "own.yaml").write_text(DRIVERS)
    (folder / "fleet.yaml").write_text(
        "layout: both\ndistro: jazzy\nsimulator: none\ndescription: arm.urdf.xacro\n"
        f"robots:\n{robots}"
    )
    plan = plan_fleet(read_fleet(str(folder / "fleet.yaml"), "", {}))
    said = (*plan.fleet.table.problems, *make_outputs(plan, str(folder)).findings)
    return [it for it in said if it.code == "MB412"]


# One whose address the plugin definitions knows, and one that nobody has read.
@pytest.mark.parametrize("plugin", ["ur_robot_driver/URPositionHardwareInterface", "my/Arm"])
def test_the_argument_of_an_address_is_named(tmp_path: Path, plugin: str) -> None:
    """It is called otherwise than the parameter; what has no argument is told with its line."""
    said = _arms(tmp_path, plugin, "  - {name: robot1}\n  - {name: robot2}\n")
    (address,) = (it for it in said if "10.0.0.2" in it.message)
    assert "arguments: {ip: ...}" in address.hint
    (bus,) = (it for it in said if "can0" in it.message)
    assert "arm.urdf.xacro:8" in bus.hint
    own = "".join(f"  - {{name: robot{at}, arguments: {{ip: 10.0.0.{at}}}}}\n" for at in (1, 2))
    (bus,) = _arms(tmp_path, plugin, own)
    assert "can0" in bus.message
    assert "arguments" not in bus.hint


@pytest.mark.parametrize("files", ["drivers.yaml drivers.yaml", "drivers.yaml own.yaml"])
def test_two_robots_with_one_device_in_a_network(tmp_path: Path, files: str) -> None:
    """In one file for both, also where their descriptions differ, and in a file of each."""
    robots = "".join(
        f"  - {{name: robot{at}, arguments: {{ip: 10.0.0.{at}}}, related_files: {{params: {file}}}}}\n"
        for at, file in enumerate(files.split(), 1)
    )
    said = [it for it in _arms(tmp_path, "my/Arm", robots) if "can0" not in it.message]
    told = " ".join(it.message for it in said)
    assert "device_ip 192.168.1.201" in told
    assert "serial_no '819612'" in told
    assert {it.level for it in said} == {WARNING}
    assert not [word for word in ("host_ip", "127.0.0.1", "hostname") if word in told]
