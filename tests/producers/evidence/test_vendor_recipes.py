# SPDX-License-Identifier: Apache-2.0
"""Vendors' robots are built from their own files, and equal what the vendors make of two, or better it.

With MULTIBOT_SOURCES=FOLDER and with launch, as ``test_vendor_systems.py``; skipped without. With rclpy
each is rehearsed, too. The rest are tests of the judge.
"""

from __future__ import annotations

import re
from importlib.util import find_spec

import pytest
from vendor_live import Looked, Said, said, told
from vendor_recipes import false_findings, is_true, outcome, read_recipes
from vendor_rows import (
    bridge_argument,
    bridge_rows,
    description_rows,
    parameter_rows,
    rviz_rows,
    static_edge,
)
from vendor_sources import VARIABLE, WITHOUT, sources_folder
from vendor_systems import missing, read_vendors

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.rosnames import bind, parse_remap
from multibot_rewrite.launch import missing as without_launch

RECIPES = read_recipes()


@pytest.mark.deep
@pytest.mark.parametrize("name", RECIPES)
def test_a_vendors_robot_is_built_as_it_ships(name: str) -> None:
    vendors, recipe, folder = read_vendors(), RECIPES[name], sources_folder()
    if folder is None or without_launch():
        pytest.skip(without_launch() or WITHOUT)
    lacking = missing(vendors.systems[recipe.system], folder)
    if lacking:
        pytest.skip(f"{VARIABLE} lacks {', '.join(lacking)}")
    found = outcome(recipe, vendors, folder, live=find_spec("rclpy") is not None)
    assert [it.refused for it in found.built] == [""] * 4
    wrong = [it for it in found.compared.differences if not it.reason]
    assert len(wrong) == recipe.wrong, wrong
    false = [false_findings(recipe, it) for it in found.built]
    assert [len(it) for it in false] == list(recipe.false), false
    told = [it for looked in found.looked for part in looked for it in part]
    assert [it for it in told if not is_true(recipe, it)] == []
    reasons = {it.reason for it in found.compared.differences}
    assert [it["where"] for it in recipe.better if it["reason"] not in reasons] == []
    assert found.compared.equal > 100


def test_the_reasons_of_a_recipe_are_patterns_for_robots_of_any_number() -> None:
    for recipe in RECIPES.values():
        for rule in recipe.better:
            assert re.compile(rule["where"])
            assert "robot1" not in rule["where"]


def test_a_key_that_comes_twice_has_both_sections() -> None:
    text = "/**:\n  a: {ros__parameters: {x: 1}}\n/**:\n  b: {ros__parameters: {y: {z: [1, 2]}}}\n"
    assert parameter_rows([text], "/robot1/a") == {"x": "1"}
    assert parameter_rows([text], "/robot1/b") == {"y.z": "[1, 2]"}
    more = "robot1:\n  a:\n    ros__parameters: {x: 2}\n/*/a: {ros__parameters: {w: 3}}\n"
    assert parameter_rows([text, more], "/robot1/a") == {"x": "2", "w": "3"}
    assert parameter_rows([more], "/robot2/a") == {"w": "3"}


def test_a_description_is_data_under_names_without_the_robot() -> None:
    text = """\
<robot name="r"><link name="base"/>
<joint name="robot1_j" type="fixed"><origin xyz="0.10 0 0"/>
<parent link="base"/><child link="x"/></joint>
<gazebo><plugin name="p" filename="f"><ros><namespace> /a
</namespace><remapping>b:=c</remapping><remapping>a:=c</remapping></ros></plugin></gazebo></robot>"""
    found = description_rows(text, "robot1", "robot1/")
    assert found == {
        "robot@name": "r",
        "robot/link[base]@name": "robot1/base",
        "robot/joint[j]@name": "robot1_j",
        "robot/joint[j]@type": "fixed",
        "robot/joint[j]/origin@xyz": "0.1 0 0",
        "robot/joint[j]/parent@link": "robot1/base",
        "robot/joint[j]/child@link": "robot1/x",
        "robot/gazebo/plugin[p]@name": "p",
        "robot/gazebo/plugin[p]@filename": "f",
        "robot/gazebo/plugin[p]/ros/namespace": "/a",
        "robot/gazebo/plugin[p]/ros/remapping": "a:=c | b:=c",
    }


def test_what_bridges_and_static_transforms_say() -> None:
    row = "- {ros_topic_name: a, gz_topic_name: /b, ros_type_name: R, gz_type_name: G}\n"
    assert list(bridge_rows(row)) == [("a", "/b R G BIDIRECTIONAL")]
    assert bridge_argument("/b@R[G") == ("/b", "/b R G GZ_TO_ROS")
    assert bridge_argument("--ros-args") is None
    assert static_edge(["0", "0", "0", "0", "0", "0", "odom", "base"]) == "odom -> base"
    assert static_edge(["--frame-id", "a", "--x", "1", "--child-frame-id", "b"]) == "a -> b"


WINDOW = """\
Visualization Manager:
  Displays:
    - {Class: rviz_common/Group, Name: Robot, Displays: [{Class: TF, Name: tf}]}
    - {Class: rviz_common/Group, Name: robot1, Displays: [
        {Class: rviz_common/Group, Name: Robot, Displays: [
          {Class: Path, Name: plan, Topic: {Value: /robot1/plan, Depth: 5}}]}]}
    - {Class: rviz_common/Group, Name: robot2, Displays: [{Class: Path, Name: other, Topic: /x}]}
  Tools:
    - {Class: SetGoal, Topic: {Value: /robot1/goal_pose}}
    - {Class: SetGoal, Topic: {Value: /robot2/goal_pose}}
    - {Class: Measure}
  Global Options: {Fixed Frame: map}
"""


def test_a_window_for_all_robots_shows_one_as_a_window_of_its_own() -> None:
    own = """\
Visualization Manager:
  Displays:
    - {Class: rviz_common/Group, Name: Robot, Displays: [
        {Class: TF, Name: tf}, {Class: Path, Name: plan, Topic: {Value: plan, Depth: 5}}]}
  Tools: [{Class: Measure}, {Class: SetGoal, Topic: {Value: /goal_pose}}]
  Global Options: {Fixed Frame: map}
"""
    rules = [it for it in [parse_remap("/goal_pose:=goal_pose")] if it]
    all_ = rviz_rows(WINDOW, bind("rviz2", "/", []), "robot1")
    one = rviz_rows(own, bind("rviz2", "/robot1", rules), "robot1")
    assert all_ == one
    assert "/robot1/plan" in one.values()
    assert "/robot1/goal_pose" in one.values()
    assert all_ != rviz_rows(own, bind("rviz2", "/robot1", []), "robot1")
    assert all_ != rviz_rows(own.replace("map", "odom"), bind("rviz2", "/robot1", rules), "robot1")


def test_what_is_said_counts_once_for_all_robots() -> None:
    rows = [("MF1", "error", "a of robot1"), ("MF1", "error", "a of robot2"), ("MF2", "note", "b")]
    found = said((Finding(*it) for it in rows), ("robot1", "robot2"))
    assert found == (Said("MF1", "a of robot"),)
    counted = told("both", found, Looked((), (Said("MG1", "c"),)), lambda it: it.code == "MF1")
    assert counted == ("both", (1, 0, 1), 1)
