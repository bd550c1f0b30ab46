# SPDX-License-Identifier: Apache-2.0
"""What a file is, by its text, and what each command says of another one than it takes."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import pytest

from multibot_rewrite.base.file_kinds import KINDS, recognised
from multibot_rewrite.base.model import InputError
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.lint.check import lint_data
from multibot_rewrite.proposal.searching import search
from multibot_rewrite.rules.settings import Settings
from multibot_rewrite.system.json import from_json

TEXTS = {
    "urdf": '<robot name="r"><link name="a"/></robot>',
    "xacro": '<?xml version="1.0"?>\n<robot xmlns:xacro="http://www.ros.org/wiki/xacro"/>',
    "sdf": '<sdf version="1.9"><model name="m"/></sdf>',
    "world": '<sdf version="1.9">\n  <world name="w"/></sdf>',
    "srdf": '<robot name="r"><group name="arm"><joint name="j"/></group></robot>',
    "launch": "from launch import LaunchDescription\ndef generate_launch_description():\n  pass\n",
    "params": "amcl:\n  ros__parameters:\n    alpha1: 0.1\n",
    "rviz": "Panels: []\nVisualization Manager:\n  Displays: []\n",
    "bridge": "- ros_topic_name: scan\n  gz_topic_name: scan\n",
    "moveit": "arm:\n  kinematics_solver: kdl_kinematics_plugin/KDLKinematicsPlugin\n",
    "tree": '<root BTCPP_format="4"><BehaviorTree ID="M"/></root>',
    "lua": 'options = {\n  map_frame = "map",\n}\n',
    "fleet": "layout: postfix\nrobots:\n  # two\n  - {name: robot1, description: a.urdf}\n",
    "plan": "schema: 3\nlayout: postfix\nrobots:\n- name: robot1\n",
    "built": '{\n "format": "multibot build 1",\n "robots": {"robot1": "robot1"}}',
    "rules": "layout: postfix\ndistro: jazzy\nrobots:\n  robot1:\n    amcl: []\n",
    "snapshot": '{"schema": 2, "nodes": []}',
    "bag": "rosbag2_bagfile_information:\n  version: 5\n",
    "session": '{"mode": "client", "connect": {"endpoints": ["tcp/a:1"]}}',
    "stage": 'include "robots.inc"\n# the hall\nfloorplan\n(\n  name "hall"\n)\n',
    "webots": "#VRML_SIM R2023b utf8\nWorldInfo {\n}\n",
    "mujoco": '<?xml version="1.0"?><!-- <a> -->\n<mujoco model="r"><worldbody/></mujoco>',
    "usd": "#usda 1.0\n(\n)\n",
    "mesh": "solid hull\nendsolid hull\n",
    "manifest": '<?xml version="1.0"?>\n<package format="3"><name>r</name></package>',
    "config": "<model><name>r</name><sdf version='1.9'>model.sdf</sdf></model>",
    "map": "image: hall.pgm\nmode: trinary\nresolution: 0.05\n",
}


@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_is_known_by_its_text(kind: str) -> None:
    assert recognised(TEXTS[kind].encode()) == kind
    assert recognised(b"\xef\xbb\xbf" + TEXTS[kind].encode()) == kind


@pytest.mark.parametrize("kind", [it for it in KINDS if it != "fleet"])
def test_a_fleet_file_that_is_another_file(kind: str, tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    path.write_text(TEXTS[kind])
    with pytest.raises(InputError) as caught:
        read_fleet(str(path), "jazzy", {})
    assert KINDS[kind].words in str(caught.value)
    assert KINDS[kind].use in str(caught.value)


@pytest.mark.parametrize("kind", [it for it in KINDS if it not in ("plan", "snapshot")])
def test_a_snapshot_that_is_another_file(kind: str) -> None:
    with pytest.raises(InputError, match=KINDS[kind].words):
        from_json(TEXTS[kind].encode(), "x")


@pytest.mark.parametrize(
    ("kind", "name"),
    [
        *product(["fleet", "plan", "launch", "map", "bag"], ["x.yaml", "x.urdf"]),
        *product(["stage", "webots", "usd", "mesh", "mujoco", "manifest", "config"], ["x.urdf"]),
        ("stage", "x.world"),
    ],
)
def test_a_file_that_the_lint_does_not_take(kind: str, name: str) -> None:
    (it,) = lint_data(name, TEXTS[kind].encode(), Settings())
    assert (it.code, it.message, it.hint) == ("MB101", KINDS[kind].words, KINDS[kind].use)


@pytest.mark.parametrize("kind", [it for it in KINDS if it not in ("urdf", "xacro", "sdf")])
@pytest.mark.parametrize("name", ["x.yaml", "x.xml"])
def test_a_description_for_init_that_is_another_file(kind: str, name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_text(TEXTS[kind])
    with pytest.raises(InputError, match=KINDS[kind].words):
        search([str(path)])


def test_all_faults_of_a_fleet_file_at_once(tmp_path: Path) -> None:
    path = tmp_path / "fleet.yaml"
    path.write_text(
        "layot: postfix\nrobots:\n  - {name: robot1, descripton: a.urdf}\naffix: middle\n"
    )
    with pytest.raises(InputError) as caught:
        read_fleet(str(path), "jazzy", {})
    told = str(caught.value)
    assert told.startswith(f"{path}:1: unknown key 'layot'; did you mean 'layout'?")
    assert "line 3: robots[0]: unknown key 'descripton'" in told
    assert "line 4: affix: 'middle' is not known" in told


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ('<!-- <launch> --><robot name="r"/>', "urdf"),
        ('<robot name="r"><!-- <group name="arm"/> <sdf> --><link name="a"/></robot>', "urdf"),
        ('<!-- <mujoco> --><sdf version="1.9"><model name="m"/></sdf>', "sdf"),
        ('<sdf version="1.9"><!-- a --><!-- b -->\n<world name="w"/></sdf>', "world"),
        ('<!-- <robot> --><!-- - --><mujoco model="r"/>', "mujoco"),
        ('<!DOCTYPE robot [<!ENTITY a "b">]>\n<robot name="r"/>', "urdf"),
        ('<?xml version="1.0"?><?pi ?><!DOCTYPE robot><robot name="r"/>', "urdf"),
        ("<!-- <robot> " * 9, ""),
        ("<" * 9_000, ""),
    ],
)
def test_what_is_in_a_comment_is_no_root(text: str, kind: str) -> None:
    assert recognised(text.encode()) == kind
