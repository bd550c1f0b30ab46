# SPDX-License-Identifier: Apache-2.0
"""Parameter files for nav2_bringup, which puts them below the robot's namespace with PyYAML.

What is done with the file is read in nav2_common: rewritten_yaml.py (``{root_key: data}``, written by
``yaml.dump``) and has_node_params.py (the key ``slam_toolbox`` at the top, the file as it is).
"""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml
from paths import FIXTURES, SUPPORT, fixture_text

from multibot_rewrite import InputError, UsageError, load_fleet
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.related_files.params.shared_defaults import below_namespace, for_bringup
from multibot_rewrite.related_files.yaml_text import read_yaml

ROVER = FIXTURES / "robots" / "rover.urdf"
CHILD = SUPPORT / "rcl_params_child.py"
PARAMS = fixture_text("bringup_style_params.yaml")
FLEET = fixture_text("bringup_style_fleet.yaml")


def built(
    folder: Path, layout: str = "both", namespace: str = "robot1", more: str = "", text: str = ""
) -> str:
    """Return the parameter file of robot1."""
    (folder / "rover.urdf").write_bytes(ROVER.read_bytes())
    (folder / "params.yaml").write_text(text or PARAMS)
    written = FLEET.format(layout=layout, namespace=namespace, more=more)
    (folder / "fleet.yaml").write_text(written)
    return load_fleet(folder / "fleet.yaml").robot("robot1").text("params.yaml")


def in_rcl(file: Path, nodes: list[tuple[str, str]]) -> list[dict[str, Any]]:
    asked = json.dumps({"file": str(file), "nodes": nodes})
    command = [sys.executable, str(CHILD)]
    done = subprocess.run(command, input=asked, capture_output=True, text=True, check=True)
    found = json.loads(done.stdout)
    assert found is not None, done.stderr
    return [{k: it for k, it in one.items() if "." not in k} for one in found]


@pytest.mark.slow
@pytest.mark.skipif(not importlib.util.find_spec("rclpy"), reason="no rclpy: rcl is the judge")
@pytest.mark.parametrize("namespace", ["robot1", "fleet_a/robot1"])
def test_rcl_finds_every_section_below_the_root_key(tmp_path: Path, namespace: str) -> None:
    text = built(tmp_path, namespace=namespace)
    below, bare = tmp_path / "below.yaml", tmp_path / "bare.yaml"
    below.write_text(yaml.dump({namespace: yaml.safe_load(text)}))
    bare.write_text(text)
    assert "slam_toolbox" in yaml.safe_load(text)
    own = f"/{namespace}"
    everyones = {"use_sim_time": False, "everyones": 1}
    amcl, costmap, other = in_rcl(
        below, [(own, "amcl"), (f"{own}/local_costmap", "local_costmap"), ("/robot2", "amcl")]
    )
    assert amcl == {**amcl, **everyones, "alpha1": 0.2, "base_frame_id": "robot1/base_link"}
    frames = {"global_frame": "robot1/odom", "robot_base_frame": "robot1/base_link"}
    assert costmap == {**costmap, **everyones, **frames}
    assert "alpha1" not in other
    (slam,) = in_rcl(bare, [(own, "slam_toolbox")])
    assert (slam["odom_frame"], slam["base_frame"]) == ("robot1/odom", "robot1/base_link")


@pytest.mark.parametrize(
    ("key", "namespace", "left"),
    [
        ("/robot1/amcl", "robot1", "amcl"),
        ("/robot1/local_costmap", "robot1", "local_costmap"),
        ("/a/robot1/amcl", "a/robot1", "amcl"),
        ("/robot1", "robot1", "**"),
        ("/**", "robot1", "**"),
        ("/**/amcl", "robot1", "**/amcl"),
        ("/*/amcl", "robot1", "amcl"),
        ("/*", "robot1", "**"),
        ("/*/amcl", "a/robot1", None),
        ("/robot10/amcl", "robot1", None),
        ("map_server", "robot1", None),
    ],
)
def test_what_is_left_of_a_key(key: str, namespace: str, left: str | None) -> None:
    assert below_namespace(key, namespace) == left


def test_comments_and_placeholders_stay() -> None:
    text = "/robot1/amcl:  # mine\n  ros__parameters: {a: $(var a)}\n"
    text += "<ns>/x:\n  ros__parameters: {b: 1}\n"
    made, findings = for_bringup(read_yaml(text.encode(), "p.yaml"), "robot1")
    assert made == text.replace("/robot1/amcl", "amcl")
    assert findings == ()


WANTED = "# nav2_bringup wants this key, and gives slam_toolbox the file without a namespace.\n"
MAP_NAME = "# /map by default, and nothing would move /map_metadata\n"


@pytest.mark.parametrize("indent", ["", "  "])
@pytest.mark.parametrize("named", [True, False])
def test_the_key_for_slam_toolbox_is_there_and_its_map_is_in_the_namespace(
    named: bool, indent: str
) -> None:
    """slam_toolbox_common.cpp: map_metadata is beside map_name, which is /map where nobody says it."""
    mine = f"{indent}    map_name: mine\n" * named
    text = f"{indent}/robot1/slam_toolbox:\n{indent}  ros__parameters:\n{mine}{indent}    odom: o\n"
    made, findings = for_bringup(read_yaml(text.encode(), "p.yaml"), "robot1")
    there = mine or f"{indent}    {MAP_NAME}{indent}    map_name: map\n"
    keys = f'{WANTED}{indent}slam_toolbox: {{}}\n{indent}"**/slam_toolbox":\n'
    assert made == f"{indent}{keys}{indent}  ros__parameters:\n{there}{indent}    odom: o\n"
    assert findings == ()


def test_a_node_outside_of_the_namespace_is_told_and_more_values_follow() -> None:
    text = "/robot1/amcl:\n  ros__parameters: {a: 1}\n/rviz2:\n  ros__parameters: {b: 1}\n"
    more = {"amcl": {"set_initial_pose": True}, "slam_toolbox": {"x": 1}}
    made, (found,) = for_bringup(read_yaml(text.encode(), "p.yaml"), "robot1", more)
    assert made.startswith(text.replace("/robot1/amcl", "amcl"))
    added = yaml.safe_load(made.removeprefix(text.replace("/robot1/amcl", "amcl")))
    assert added == {"**/amcl": {"ros__parameters": {"set_initial_pose": True}}}
    assert (found.code, found.level, found.file, found.line, found.column) == (
        "MF132", "error", "p.yaml", 3, 1,
    )  # fmt: skip
    assert found.message == "section /rviz2 is for a node that is not in the namespace /robot1"
    assert found.hint == (
        "nav2_bringup puts all sections there; put this one into a file of its own"
    )


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize("layout", ["frames-per-robot", "postfix"])
def test_a_layout_that_nav2_bringup_cannot_start_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], layout: str
) -> None:
    with pytest.raises(UsageError, match=f"cannot start layout {layout}.*remaps /tf to tf"):
        built(tmp_path, layout)
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "out")]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_node_that_bringup_starts_cannot_be_shared(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="nav2_bringup starts map_server for each robot"):
        built(tmp_path, more="shared_nodes: [map_server]")


@pytest.mark.more
def test_an_unknown_style_is_refused_with_its_line(tmp_path: Path) -> None:
    text = built(tmp_path)
    assert text
    fleet = (tmp_path / "fleet.yaml").read_text().replace(": bringup", ": bring_up")
    (tmp_path / "fleet.yaml").write_text(fleet)
    with pytest.raises(InputError, match=r"fleet\.yaml:5.*bringup"):
        load_fleet(tmp_path / "fleet.yaml")


@pytest.mark.slow
def test_nodes_that_are_started_here_get_full_names_all_the_same(tmp_path: Path) -> None:
    built(tmp_path)
    robot = load_fleet(tmp_path / "fleet.yaml").robot("robot1")
    assert robot.params("params.yaml", "amcl")["base_frame_id"] == "robot1/base_link"
    assert "/robot1/amcl:" in robot.node_text("params.yaml")
