# SPDX-License-Identifier: Apache-2.0
"""Fleets of different robots: every name of every file that is made, looked at one by one."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest
import yaml
from fleet_folder import SMALL, fleet_folder, mixed, planned_fleet
from lxml import etree
from named_ends import named_ends
from plans import own

from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.fleet.fleet import expected
from multibot_rewrite.fleet.robots.robot_groups import split_per_robot
from multibot_rewrite.system.json import from_yaml

LAYOUTS = [("L1", "prefix"), ("L2", "prefix"), ("L3", "postfix"), ("L4", "postfix")]


def made(folder: Path, text: str, **files: str) -> dict[str, str]:
    plan = planned_fleet(fleet_folder(folder, text, **files))
    return {it.path: it.data.decode() for it in make_outputs(plan).files}


@pytest.fixture(scope="module", params=LAYOUTS, ids=lambda it: it[0])
def fleet(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[str, dict[str, str]]:
    layout, affix = request.param
    return layout, made(tmp_path_factory.mktemp(layout), mixed(layout, affix))


def test_a_section_in_the_namespace_of_its_robot_is_for_that_robot(tmp_path: Path) -> None:
    """Clearpath's generators write the sections of controllers below the robot's namespace."""
    section = "{ros__parameters: {base: {type: diff_drive_controller/DiffDriveController}}}"
    text = f"/r1:\n  controller_manager: {section}\n  base: {{ros__parameters: {{rate: 1}}}}\n"
    robot = "{name: r1, description: base.urdf, related_files: {params: own.yaml}}"
    folder = fleet_folder(
        tmp_path,
        f"layout: L1\nnode_sets: ros2_control\nrobots: [{robot}]\n",
        base__urdf="<robot name='r'><link name='base_link'/></robot>",
        own__yaml=text,
    )
    plan = expected(planned_fleet(folder).fleet)
    assert {"/r1/controller_manager", "/r1/base"} <= {*own(plan, plan.robots[0].name)}
    assert [it for it in own(plan, plan.robots[0].name) if it.startswith("/r1/r1")] == []


def spell(layout: str, name: str, word: str, separator: str = "/") -> str:
    """Return what these tests expect, computed without the package."""
    if layout == "L1":
        return name
    return f"{word}{separator}{name}" if layout == "L2" else f"{name}{separator}{word}"


def topic(layout: str, name: str, word: str) -> str:
    return f"/{name}/{word}" if layout == "L4" else f"/{word}/{name}"


def names(text: str, tag: str) -> list[str]:
    return [it.get("name", "") for it in etree.fromstring(text.encode()).iter(tag)]


def scalars(value: Any) -> Iterator[str]:
    if isinstance(value, Mapping):
        for key, below in value.items():
            yield str(key)
            yield from scalars(below)
    elif isinstance(value, list):
        for below in value:
            yield from scalars(below)
    else:
        yield str(value)


@pytest.mark.slow
def test_every_robot_has_its_files_and_no_other(fleet: tuple[str, dict[str, str]]) -> None:
    layout, files = fleet
    common = {"plan.yaml", ".system.schema.json", "remappings.yaml", "commands.md", "bridge.yaml"}
    common |= {"fleet.launch.py"}
    # One set of frames for each robot: a layout of Foxglove shows all.
    common |= {"foxglove.json"} if layout != "L1" else set()
    own = {
        "scout": {"rover.urdf", "params.yaml", "bridge.yaml", "one_robot.rviz", "start_pose.yaml"},
        "reach": {
            *("arm.urdf", "arm.srdf", "limits.yaml", "moveit_parameters.yaml", "one_robot.rviz")
        },
        "grip": {"arm.urdf", "arm.srdf", "one_robot.rviz"},
        "bare": {"rover.urdf", "one_robot.rviz"},
    }
    together = layout == "L2"
    wanted = {f"{robot}/{file}" for robot, its in own.items() for file in its}
    if together:
        wanted = {it for it in wanted if not it.endswith(".rviz")} | {"one_robot.rviz"}
    assert set(files) - common == wanted - common
    assert set(files) >= common - {"bridge.yaml"}


@pytest.mark.slow
def test_links_and_joints_of_each_description(fleet: tuple[str, dict[str, str]]) -> None:
    layout, files = fleet
    links = {
        "scout/rover.urdf": ("s1", ["base_link", "lidar_link"], ["lidar_joint"]),
        "bare/rover.urdf": ("bare", ["base_link", "lidar_link"], ["lidar_joint"]),
        "reach/arm.urdf": ("reach", ["foot", "gripper"], ["elbow"]),
        "grip/arm.urdf": ("grip", ["foot", "fork"], ["elbow"]),
    }
    for path, (word, bare, joints) in links.items():
        assert names(files[path], "link") == [spell(layout, it, word) for it in bare]
        assert names(files[path], "joint") == [spell(layout, it, word, "_") for it in joints]


@pytest.mark.slow
def test_the_srdf_names_what_its_description_declares(fleet: tuple[str, dict[str, str]]) -> None:
    layout, files = fleet
    assert names(files["reach/arm.srdf"], "joint") == [spell(layout, "elbow", "reach", "_")]
    assert names(files["reach/arm.srdf"], "group") == ["all"]


@pytest.mark.slow
def test_params_have_the_namespace_in_keys_and_the_prefix_in_frames(
    fleet: tuple[str, dict[str, str]],
) -> None:
    layout, files = fleet
    data = yaml.safe_load(files["scout/params.yaml"])
    node = "/amcl_fleet_scout" if layout == "L4" else "/fleet_scout/amcl"
    given = data[node]["ros__parameters"]
    assert given["base_frame_id"] == spell(layout, "base_link", "s1")
    assert given["odom_frame_id"] == spell(layout, "odom", "s1")
    assert "# its base" in files["scout/params.yaml"]


@pytest.mark.slow
def test_moveit_limits_have_the_joint(fleet: tuple[str, dict[str, str]]) -> None:
    layout, files = fleet
    data = yaml.safe_load(files["reach/limits.yaml"])
    assert list(data["joint_limits"]) == [spell(layout, "elbow", "reach", "_")]


@pytest.mark.slow
def test_a_bridge_has_namespace_and_model(fleet: tuple[str, dict[str, str]]) -> None:
    layout, files = fleet
    own = yaml.safe_load(files["scout/bridge.yaml"])[0]
    assert own["ros_topic_name"] == topic(layout, "scan", "fleet_scout")
    assert own["gz_topic_name"] == "/model/scout_model/scan"


@pytest.mark.slow
def test_rviz_shows_the_topics_of_all(fleet: tuple[str, dict[str, str]]) -> None:
    layout, files = fleet
    found = {it for path, text in files.items() if path.endswith(".rviz") for it in
             scalars(yaml.safe_load(text))}  # fmt: skip
    for word in ("fleet_scout", "reach", "grip", "bare"):
        assert topic(layout, "scan", word) in found


@pytest.mark.slow
def test_commands_spawn_the_model_with_its_own_topic(fleet: tuple[str, dict[str, str]]) -> None:
    layout, files = fleet
    lines = [shlex.split(it) for it in files["commands.md"].splitlines() if " create " in it]
    spawned = [(it[it.index("-name") + 1], it[it.index("-topic") + 1]) for it in lines]
    # The other two have neither mass nor anything for a simulator.
    words = {"scout_model": "fleet_scout", "bare": "bare"}
    assert spawned == [
        (model, topic(layout, "robot_description", word)) for model, word in words.items()
    ]


@pytest.mark.slow
def test_a_start_pose_is_for_the_node_that_runs(fleet: tuple[str, dict[str, str]]) -> None:
    layout, files = fleet
    node = "/amcl_fleet_scout" if layout == "L4" else "/fleet_scout/amcl"
    given = yaml.safe_load(files["scout/start_pose.yaml"])[node]["ros__parameters"]
    assert (given["set_initial_pose"], given["initial_pose.x"]) == (True, 1.0)


@pytest.mark.slow
def test_remappings_hold_every_node_of_the_plan(fleet: tuple[str, dict[str, str]]) -> None:
    _, files = fleet
    table = yaml.safe_load(files["remappings.yaml"])["robots"]
    plan = from_yaml(files["plan.yaml"].encode(), "plan.yaml")
    full = {
        f"{it['namespace'].rstrip('/')}/{it['name']}"
        for own in table.values()
        for it in own.values()
    }
    # What a node makes for itself is a pattern, and gets its rules from that node.
    own = {it.name for it in plan.nodes if it.robot and "*" not in it.name}
    assert own <= full


@pytest.mark.slow
def test_no_file_of_a_robot_has_a_word_of_another(fleet: tuple[str, dict[str, str]]) -> None:
    _, files = fleet
    words = {"scout": ("fleet_scout", "s1", "scout_model"), "reach": ("reach",), "grip": ("grip",)}
    for path, text in files.items():
        owner, slash, _ = path.partition("/")
        others = [it for name, its in words.items() if name != owner for it in its]
        found = [it for it in others if slash and re.search(rf"\b{it}\b", text)]
        assert found == [], path


# ---------------------------------------------------------------- what meets


@pytest.mark.more
def test_related_files_of_one_name_are_in_folders_of_their_own(tmp_path: Path) -> None:
    (tmp_path / "more").mkdir()
    own = tmp_path / "more" / "params.yaml"
    own.write_text("amcl:\n  ros__parameters: {alpha1: 0.1}\n")
    text = SMALL.replace("[params.yaml]", "[params.yaml, more/params.yaml]")
    files = made(tmp_path, text)
    assert "/robot1/amcl:" in files["robot1/more/params.yaml"]
    # What the folder of the fleet file is called makes no difference.
    assert "amcl" in files["robot1/params.yaml"]
    assert not any(tmp_path.name in it for it in files)
    assert "robot1/more/params.yaml" in files["fleet.launch.py"]
    # No node that is started has a section there.
    own.write_text("x:\n  ros__parameters: {a: 1}\n")
    files = made(tmp_path, text)
    assert "/robot1/x:" in files["robot1/more/params.yaml"]
    assert "robot1/more/params.yaml" not in files["fleet.launch.py"]


@pytest.mark.more
def test_folders_of_one_name_are_in_those_above_them(tmp_path: Path) -> None:
    for folder in ("a/more", "b/more"):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / "params.yaml").write_text("x:\n  ros__parameters: {a: 1}\n")
    text = SMALL.replace("[params.yaml]", "[a/more/params.yaml, b/more/params.yaml]")
    assert {"robot1/a/more/params.yaml", "robot1/b/more/params.yaml"} <= made(tmp_path, text).keys()


# ---------------------------------------------------------------- the fleet as one, and alone


def test_each_robot_alone_is_the_fleet_in_parts(tmp_path: Path) -> None:
    plan = planned_fleet(fleet_folder(tmp_path, mixed()))
    parts = list(split_per_robot(plan))
    assert [it.robots for it in parts] == [(it,) for it in plan.robots]
    own = [name for it in parts for name in named_ends(it.fleet.table)]
    assert sorted(own, key=str) == sorted(
        (it for it in named_ends(plan.fleet.table) if it.robot), key=str
    )
    assert {key for it in parts for key in it.fleet.edges} == set(plan.fleet.edges)
