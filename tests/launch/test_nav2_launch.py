# SPDX-License-Identifier: Apache-2.0
"""nav2.launch.py and nav2_bringup's own launch files, in the real launch.

What is started is told by ``launch_recorder.py``. Names are those of the layout, rules those of
nav2_bringup's launch files, parameters by the keys of rcl.
"""

from __future__ import annotations

import importlib.util
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from launched_programs import launched
from nav2_fleet import FILE, written
from paths import FIXTURES, SUPPORT
from vendor_sources import VARIABLE, sources_folder

from multibot_rewrite import launch
from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.knowledge.node_sets import load_nodes
from multibot_rewrite.knowledge.programs import LIFECYCLE_MANAGER, NAV2, known_program
from multibot_rewrite.live.rehearsal import isolated_environment
from tools.interfaces.table import read_packed

REASON = f"not tried in the real launch, which is not here: {launch.missing()}"
in_launch = pytest.mark.skipif(bool(launch.missing()), reason=REASON)
STAND_IN = SUPPORT / "lifecycle_stand_in.py"
Rows = list[dict[str, Any]]


def run(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(SUPPORT / "launch_recorder.py"), str(FILE)]
    command += ["fleet:=fleet.yaml", *words]
    environ = {**os.environ, "RECORDER_QUIET": "2.0"}
    return subprocess.run(
        command, cwd=folder, env=environ, capture_output=True, text=True, timeout=60, check=False
    )


def started(folder: Path, *words: str) -> dict[str, dict[str, Any]]:
    """Return what is started, by full name; windows of RViz by their config."""
    done = run(folder, *words)
    assert done.returncode == 0 and "Caught" not in done.stderr, done.stderr
    rows: Rows = json.loads("[" + f"\n{done.stdout}".rpartition("\n[")[2])
    return {full(it): it for it in rows}


def full(row: dict[str, Any]) -> str:
    """Return the full name of a node; that of its file for RViz."""
    name = row["name"] or "/".join(row["own"][-1:])
    return f"/{row['namespace'].strip('/')}/{name}".replace("//", "/")


def values(row: dict[str, Any], node: str) -> dict[str, Any]:
    """Return the parameters that files of a process have for a node by its full name."""
    found: dict[str, Any] = {}
    for text in row["params"].values():
        # What launch_ros makes of lists; rcl does not look at it.
        data = yaml.safe_load(text.replace("!!python/tuple", ""))
        for key in ("/**", node):
            found |= data.get(key, {}).get("ros__parameters", {})
    return found


@in_launch
def test_components_in_a_layout_without_namespaces(tmp_path: Path) -> None:
    folder = written(tmp_path, node_set="nav2_slam_composed", more="relayed: true")
    found = started(folder, "rviz:=one", "robot_state_publisher:=true", "use_sim_time:=true")
    box = found["/nav2_container_robot2"]
    assert box["executable"] == "component_container_isolated"
    assert "map_server" not in " ".join(found) and "amcl" not in " ".join(found)
    server = found["/robot2/controller_server"]
    assert server["container"] == "/nav2_container_robot2"
    assert ["cmd_vel", "/cmd_vel_nav/robot2"] in server["rules"]
    # Its costmap has the rules and the files of the container.
    assert ["local_costmap:/tf", "/tf/robot2"] in box["rules"]
    costmap = yaml.safe_load(next(iter(box["params"].values())))["/robot2/local_costmap"]
    assert costmap["local_costmap"]["ros__parameters"]["global_frame"] == "odom/robot2"
    manager = dict(found["/lifecycle_manager_navigation_robot2"]["parameters"])
    # The name that a node has without its namespace: the bond's id.
    assert manager["node_names"][:2] == ["controller_server", "smoother_server_robot2"]
    assert manager["autostart"] is True and manager["use_sim_time"] is True
    relay = values(found["/tf_relay_robot1"], "/tf_relay_robot1")
    assert (relay["input_topic"], relay["output_topic"]) == ("/tf/robot1", "/tf")
    assert [it["executable"] for it in found.values()].count("rviz2") == 1
    assert "/robot_state_publisher_robot1" in found and "/slam_toolbox_robot1" in found


@in_launch
def test_processes_in_namespaces_with_a_map_for_all(tmp_path: Path) -> None:
    more = "shared_nodes: [map_server]\nshared_topics: [/map, /clock, /rosout, /parameter_events]"
    folder = written(tmp_path, layout="both", more=more, distro="lyrical")
    found = started(folder, "map:=/maps/hall.yaml", "rviz:=each")
    assert "/robot1/map_server" not in found
    assert values(found["/map_server"], "/map_server")["yaml_filename"] == "/maps/hall.yaml"
    told = values(found["/lifecycle_manager_shared"], "/lifecycle_manager_shared")
    assert told["node_names"] == ["map_server"]
    own = "/robot1/lifecycle_manager_localization"
    assert values(found[own], own)["node_names"] == ["amcl"]
    amcl = values(found["/robot1/amcl"], "/robot1/amcl")
    assert (amcl["odom_frame_id"], amcl["initial_pose.x"]) == ("odom/robot1", 1.0)
    assert found["/robot1/following_server"]["package"] == "opennav_following"
    assert [it["executable"] for it in found.values()].count("rviz2") == 2


@in_launch
@pytest.mark.parametrize(
    ("words", "node_set", "said"),
    [
        (("rviz:=one",), "nav2", "these robots need 2 windows; say relayed: true"),
        (("rviz:=all",), "nav2", "rviz:=all: way 'all' is not known"),
        ((), "teleop", "robot 'robot1' has no node of Nav2; add nav2"),
        (("robots:=robot3",), "nav2", "robot 'robot3' is not known"),
        (("use_sim_time:=maybe",), "nav2", "use_sim_time is 'maybe'; write true or false"),
    ],
)
@pytest.mark.slow
def test_bad_words_are_said(
    tmp_path: Path, words: tuple[str, ...], node_set: str, said: str
) -> None:
    done = run(written(tmp_path, node_set=node_set), *words)
    assert said in done.stderr + done.stdout


@in_launch
@pytest.mark.live
@pytest.mark.skipif(not importlib.util.find_spec("rclpy"), reason="no rclpy: pip install '.[ros]'")
def test_slam_toolbox_is_configured_and_activated_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It has a life cycle from Jazzy on (slam_toolbox_common.hpp), and nobody else knows it: with
    ``use_lifecycle_manager`` false, its default, it makes no bond (slam_toolbox_common.cpp)."""
    fleet = written(tmp_path, node_set="nav2_slam", layout="tf-per-robot") / "fleet.yaml"
    fleet.write_text(fleet.read_text().replace("  - {name: robot2", "#"))
    for name, value in isolated_environment(None).items():
        monkeypatch.setenv(name, value)
    nav2 = [known_program(it, "jazzy") for it in NAV2 if it in load_nodes("jazzy")]
    programs = {it.executable: it.package for it in nav2}
    real = {known_program("slam_toolbox", "jazzy").executable: STAND_IN}
    told, _ = launched(FILE, tmp_path, f"fleet:={fleet}", programs=programs, real=real)
    (slam,) = (it for it in told if "state" in it)
    assert "__ns:=/robot1" in slam["words"]
    # lifecycle_msgs Transition: configure is 1, activate 3.
    assert (slam["state"], slam["asked"]) == ("active", [1, 3])


def launched_by(release: str) -> Iterator[tuple[str, str, str]]:
    """Kind, package and program or class of all that launch files of Nav2 start."""
    text = read_packed(FIXTURES / "interfaces" / f"launch_{release}.tsv.xz")
    for line in text.splitlines():
        yield tuple(line.split("\t")[1:4])  # type: ignore[misc]


def test_programs_are_those_of_launch_files_of_some_release() -> None:
    known = {row for release in RELEASES for row in launched_by(release)}
    for name in NAV2:
        it = known_program(name, "rolling")
        words = {("node", it.package, it.executable), ("lifecycle_node", it.package, it.executable)}
        assert words & known, name
        assert not it.plugin or ("component", it.package, it.plugin) in known, name
    assert NAV2[-1] == LIFECYCLE_MANAGER


WITHOUT = launch.missing() or ("" if sources_folder() else f"set {VARIABLE}")


@pytest.mark.deep
@pytest.mark.live
@pytest.mark.skipif(
    bool(WITHOUT), reason=f"not tried in the real launch, which is not here: {WITHOUT}"
)
@pytest.mark.skipif(not importlib.util.find_spec("rclpy"), reason="no rclpy")
@pytest.mark.parametrize("number", range(67))
def test_nav2_comes_up_as_planned(number: int) -> None:
    """Every row of the table in docs/contributing/nav2.md."""
    from nav2_cells import cells, outcome

    sources = sources_folder()
    assert sources is not None
    with tempfile.TemporaryDirectory() as folder:
        made = outcome(list(cells())[number], Path(folder), sources)
    assert made.findings == ()
    assert made.parameters == made.planned > 400
