# SPDX-License-Identifier: Apache-2.0
"""What launch files take from nav2_common, by nav2_common's own code where it is there."""

from __future__ import annotations

import importlib
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
import yaml

from multibot_rewrite.producers.launch.stand_in import parameters as nav2
from multibot_rewrite.producers.launch.stand_in.values import LaunchContext

PARAMS = """\
amcl:
  ros__parameters:
    use_sim_time: false
    scan_topic: <robot_namespace>/scan
    z_hit: 0.5
global_costmap:
  global_costmap:
    ros__parameters:
      use_sim_time: false
      plugins: [static, obstacle]
      obstacle:
        enabled: true
plain: {key: 1}
"""
AMCL = yaml.safe_load(PARAMS)["amcl"]["ros__parameters"]


def ours() -> tuple[Any, Any]:
    return nav2, LaunchContext()


def theirs() -> tuple[Any, Any]:
    if not find_spec("nav2_common"):
        pytest.skip("nav2_common is the judge; put its sources and those of launch on PYTHONPATH")
    return importlib.import_module("nav2_common.launch"), importlib.import_module(
        "launch"
    ).LaunchContext()


@pytest.fixture(params=[ours, theirs])
def made(request: pytest.FixtureRequest) -> tuple[Any, Any]:
    """Return the module, and a context for it."""
    found: tuple[Any, Any] = request.param()
    return found


@pytest.fixture
def file(tmp_path: Path) -> str:
    (tmp_path / "params.yaml").write_text(PARAMS)
    return str(tmp_path / "params.yaml")


@pytest.mark.parametrize(
    ("rewrites", "options", "path", "value"),
    [
        ({"use_sim_time": "true"}, {}, "amcl.ros__parameters.use_sim_time", True),
        (
            {"use_sim_time": "True"},
            {},
            "global_costmap.global_costmap.ros__parameters.use_sim_time",
            True,
        ),
        ({"z_hit": "0.7"}, {}, "amcl.ros__parameters.z_hit", "0.7"),
        ({"z_hit": "0.7"}, {"convert_types": True}, "amcl.ros__parameters.z_hit", 0.7),
        ({"z_hit": "7"}, {"convert_types": True}, "amcl.ros__parameters.z_hit", 7),
        ({"amcl.ros__parameters.z_hit": "a"}, {}, "amcl.ros__parameters.z_hit", "a"),
        ({"amcl.ros__parameters.new": "a"}, {}, "amcl.ros__parameters.new", "a"),
        ({"plain.key": "a"}, {}, "plain.key", "a"),
        ({"plain.other": "a"}, {}, "plain", {"key": 1}),
        ({"z_hit": "x"}, {"convert_types": True}, "amcl.ros__parameters.z_hit", "x"),
        ({"z_hit": "TRUE"}, {"convert_types": True}, "amcl.ros__parameters.z_hit", True),
        ({"amcl.ros__parameters.new.deep": "a"}, {}, "amcl.ros__parameters.new", {"deep": "a"}),
        ({"plain.other.deep": "a"}, {}, "plain", {"key": 1}),
        ({"z_hit": ""}, {}, "amcl.ros__parameters.z_hit", ""),
        ({"not_there": "a"}, {}, "amcl.ros__parameters", AMCL),
        ({}, {"root_key": "robot1"}, "robot1.amcl.ros__parameters", AMCL),
        ({}, {"root_key": ""}, "amcl.ros__parameters", AMCL),
        ({}, {"key_rewrites": {"amcl": "loc"}}, "loc.ros__parameters", AMCL),
        (
            {"enabled": "false"},
            {},
            "global_costmap.global_costmap.ros__parameters.obstacle.enabled",
            False,
        ),
        (
            {"global_costmap.global_costmap.ros__parameters.plugins.1": "voxel"},
            {},
            "global_costmap.global_costmap.ros__parameters.plugins",
            ["static", "voxel"],
        ),
    ],
)
def test_a_parameter_file_with_other_values(
    rewrites: dict[str, str],
    options: dict[str, Any],
    path: str,
    value: object,
    file: str,
    made: tuple[Any, Any],
) -> None:
    module, context = made
    written = module.RewrittenYaml(source_file=file, param_rewrites=rewrites, **options)
    found = yaml.safe_load(Path(written.perform(context)).read_text())
    for word in path.split("."):
        found = found[word]
    assert found == value and type(found) is type(value)


def test_a_file_with_other_words(file: str, made: tuple[Any, Any]) -> None:
    module, context = made
    words = {"<robot_namespace>": ("/", "robot1")}
    text = Path(module.ReplaceString(file, words).perform(context)).read_text()
    assert text == PARAMS.replace("<robot_namespace>", "/robot1")


@pytest.mark.parametrize("wanted", ["true", "false"])
def test_a_file_with_other_words_on_a_condition(
    wanted: str, file: str, made: tuple[Any, Any]
) -> None:
    module, context = made
    conditions = importlib.import_module(
        "launch.conditions" if module is not nav2 else f"{nav2.__name__.rpartition('.')[0]}.values"
    )
    condition = conditions.IfCondition(wanted)
    path = module.ReplaceString(file, {"amcl": "a"}, condition=condition).perform(context)
    assert (path == file) is (wanted == "false")


@pytest.mark.parametrize(("name", "text"), [("amcl", "True"), ("ros__parameters", "False")])
def test_whether_a_node_has_parameters(
    name: str, text: str, file: str, made: tuple[Any, Any]
) -> None:
    module, context = made
    assert module.HasNodeParams(source_file=file, node_name=name).perform(context) == text


POSE = dict.fromkeys(("x", "y", "z", "roll", "pitch", "yaw"), 0.0)


@pytest.mark.parametrize(
    ("words", "robots"),
    [
        ([], {}),
        (["robots:="], {}),
        (["robots:=robot1={x: 1.0, yaw: 1.5}"], {"robot1": POSE | {"x": 1.0, "yaw": 1.5}}),
        (
            ["map:=a", "robots:=r1={x: 1.0}; r2={y: 2.0};"],
            {"r1": POSE | {"x": 1.0}, "r2": POSE | {"y": 2.0}},
        ),
        (["robots:=r1"], {}),
    ],
)
def test_the_robots_of_the_command_line(
    words: list[str], robots: dict[str, Any], made: tuple[Any, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    if not hasattr(made[0], "ParseMultiRobotPose"):
        pytest.skip("nav2_common of lyrical has it no longer")
    monkeypatch.setattr("sys.argv", ["ros2", "launch", "nav2_bringup", "cloned.py", *words])
    assert made[0].ParseMultiRobotPose("robots").value() == robots


@pytest.mark.parametrize("path", ["l.3", "l.3.a", "l.x", "l.-1", "l.0.ros.b", "k.a"])
def test_a_place_that_is_not_there_is_not_made(path: str, tmp_path: Path) -> None:
    file = tmp_path / "p.yaml"
    file.write_text("l: [{a: 1}, 2, 3]\nk: 1\n")
    written = nav2.RewrittenYaml(source_file=str(file), param_rewrites={path: "x"})
    found = yaml.safe_load(Path(written.perform(LaunchContext())).read_text())
    assert found == {"l": [{"a": 1}, 2, 3], "k": 1}
    inside = nav2.RewrittenYaml(source_file=str(file), param_rewrites={"l.0.a": "x", "l.2": "y"})
    found = yaml.safe_load(Path(inside.perform(LaunchContext())).read_text())
    assert found == {"l": [{"a": "x"}, 2, "y"], "k": 1}


def test_what_they_are_given_has_the_names_of_nav2_common(file: str) -> None:
    context = LaunchContext()
    context.launch_configurations["c"] = "yes"
    words = {"source_file": file, "replacements": {"scan": "x"}, "condition": None}
    assert "x_topic" in Path(nav2.ReplaceString(**words).perform(context)).read_text()
    assert nav2.HasNodeParams(source_file=file, node_name="amcl").perform(context) == "True"
    assert nav2.HasNodeParams(source_file=file, node_name="map").perform(context) == "False"
    assert nav2.LaunchConfigAsBool(name="c").perform(context) == "True"


@pytest.mark.parametrize(
    ("text", "truth"),
    [
        *((it, "True") for it in ("on", "1", "true", "yes", " True ", "YES")),
        *((it, "False") for it in ("no", "0", "false", "off", "", "x")),
    ],
)
def test_a_launch_configuration_as_a_truth(text: str, truth: str) -> None:
    context = LaunchContext()
    context.launch_configurations["composed"] = text
    assert nav2.LaunchConfigAsBool("composed").perform(context) == truth
