# SPDX-License-Identifier: Apache-2.0
"""What launch authors write, in the real launch: events, timers, groups, parameters, components."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest
import yaml
from launched_programs import launched
from paths import FIXTURES, fixture_text

from multibot_rewrite import launch, load_fleet

pytestmark = pytest.mark.skipif(
    bool(launch.missing()),
    reason=f"not tried in the real launch, which is not here: {launch.missing()}",
)
FLEET = """\
distro: lyrical
layout: tf-per-robot
node_sets: [ros2_control, robot_state]
use_sim_time: true
robots:
  - {name: robot1, description: rover.urdf, pose: {x: 1.0}}
  - {name: robot2, description: rover.urdf, pose: {x: 3.0}}
"""
PROGRAMS = {
    **{"spawner": "controller_manager", "driver": "my_driver", "plain": "my_driver"},
    **{"late": "my_driver", "off": "my_driver"},
}
EVENTS = fixture_text("idioms_events.txt")


@pytest.fixture
def fleet(tmp_path: Path) -> Path:
    text = (FIXTURES / "robots" / "rover.urdf").read_text()
    # launch_ros would read a text with ": " and " #" as YAML.
    text = text.replace('<robot name="rover">', '<robot name="rover"><!-- wheel: left # 1 -->')
    (tmp_path / "rover.urdf").write_text(text)
    (tmp_path / "fleet.yaml").write_text(FLEET)
    return tmp_path / "fleet.yaml"


def programs(told: list[dict[str, Any]], name: str) -> list[dict[str, Any]]:
    return sorted(
        (it for it in told if Path(it["words"][0]).name == name), key=lambda it: str(it["words"])
    )


def parameters(it: dict[str, Any], node: str) -> dict[str, Any]:
    """Return what rcl would make of the parameter files and words of a program; the last one wins."""
    found: dict[str, Any] = {}
    for flag, word in zip(it["words"], it["words"][1:], strict=False):
        if flag == "--params-file":
            for section, data in yaml.safe_load(it["files"][word]).items():
                found |= data["ros__parameters"] if section in ("/**", node) else {}
        if flag == "-p" and ":=" in word:
            key, _, value = word.partition(":=")
            found[key] = yaml.safe_load(value)
    return found


def started(fleet: Path, file: str, text: str, more: dict[str, str]) -> list[dict[str, Any]]:
    path = fleet.with_name(file)
    path.write_text(text)
    told: list[dict[str, Any]]
    told, said = launched(path, fleet.parent, f"fleet:={fleet}", programs=more)
    assert "ERROR" not in said and "Caught exception" not in said, said
    return told


def test_a_spawner_then_controllers_and_all_options(fleet: Path, monkeypatch: Any) -> None:
    monkeypatch.chdir(fleet.parent)
    text = EVENTS.replace("COMMAND", f"{sys.executable} -m multibot_rewrite.cli.urdf_postfix")
    told = started(fleet, "events.launch.py", text, PROGRAMS)
    robots = load_fleet(fleet).robots
    states = programs(told, "robot_state_publisher")
    plains = programs(told, "plain")
    for robot, state, plain in zip(robots, states, plains, strict=True):
        held = parameters(state, f"{robot.namespace}/robot_state_publisher")
        assert held == {"robot_description": robot.description, "use_sim_time": True}
        # A node that is not of this package has the clock of its group, and the text of Command.
        its = parameters(plain, f"{robot.namespace}/plain")
        assert its["use_sim_time"] is True
        assert f'name="{robot.name}"' in its["text"] or f"_{robot.name}" in its["text"]
        (model,) = (
            it for it in programs(told, "create") if set(robot.spawn_arguments) <= {*it["words"]}
        )
        assert parameters(model, "")["mine"] == 7
        mine = [it for it in programs(told, "spawner") if f"__ns:={robot.namespace}" in it["words"]]
        loaded = [next(w for w in it["words"][1:] if not w.startswith("-")) for it in mine]
        assert sorted(loaded) == ["diff_drive_controller", "joint_state_broadcaster"]
        (place,) = (
            it
            for it in programs(told, "static_transform_publisher")
            if f"__ns:={robot.namespace}" in it["words"]
        )
        assert set(robot.transform_arguments) <= {*place["words"]}
        (manager,) = (
            it for it in programs(told, "driver") if f"__ns:={robot.namespace}" in it["words"]
        )
        assert parameters(manager, f"{robot.namespace}/controller_manager")["use_sim_time"] is False
    # The last of the chain started for both, and what has a false condition for none.
    assert (len(programs(told, "late")), programs(told, "off")) == (2, [])


XML = """\
<launch>
  <arg name="fleet"/>
  <multibot_robots fleet="$(var fleet)">
    <multibot_node node="robot_state_publisher" pkg="robot_state_publisher"
                   exec="robot_state_publisher">
      <param name="robot_description" value="$(multibot description)"/>
      <param name="rate" value="$(multibot pose x)"/>
    </multibot_node>
    <multibot_lifecycle_node node="controller_manager" pkg="my_driver" exec="driver"
                             use_sim_time="false"/>
  </multibot_robots>
</launch>
"""
YAML = """\
launch:
- arg: {name: fleet}
- multibot_robots:
    fleet: $(var fleet)
    children:
    - multibot_node:
        node: robot_state_publisher
        pkg: robot_state_publisher
        exec: robot_state_publisher
        param:
        - {name: robot_description, value: $(multibot description)}
        - {name: rate, value: $(multibot pose x)}
    - multibot_lifecycle_node:
        {node: controller_manager, pkg: my_driver, exec: driver, use_sim_time: 'false'}
"""


@pytest.mark.parametrize(("name", "text"), [("a.launch.xml", XML), ("a.launch.yaml", YAML)])
def test_xml_and_yaml_need_no_type(name: str, text: str, fleet: Path) -> None:
    told = started(fleet, name, text, PROGRAMS)
    states, managers = programs(told, "robot_state_publisher"), programs(told, "driver")
    robots = load_fleet(fleet).robots
    for robot, x, state, manager in zip(robots, (1.0, 3.0), states, managers, strict=True):
        wanted = {"robot_description": robot.description, "rate": x, "use_sim_time": True}
        assert parameters(state, f"{robot.namespace}/robot_state_publisher") == wanted
        assert parameters(manager, f"{robot.namespace}/controller_manager")["use_sim_time"] is False


NAV2 = """\
distro: jazzy
layout: postfix
node_sets: nav2_composed
robots:
  - {name: robot1, description: rover.urdf}
  - {name: robot2, description: rover.urdf}
related_files: {params: params.yaml}
"""
PARAMS = """\
controller_server:
  ros__parameters: {odom_topic: odom}
local_costmap:
  local_costmap:
    ros__parameters: {robot_base_frame: base_link, width: 3}
"""
COMPOSED = """\
<launch>
  <arg name="fleet"/>
  <multibot_robots fleet="$(var fleet)" robots="robot1">
    <multibot_container node="nav2_container" pkg="rclcpp_components" exec="component_container"
                        files="params.yaml">
      <multibot_composable_node node="controller_server" pkg="nav2_controller" plugin="p"
                                files="params.yaml" if="false"/>
    </multibot_container>
  </multibot_robots>
</launch>
"""


@pytest.fixture
def composed(fleet: Path) -> Path:
    fleet.write_text(NAV2)
    fleet.with_name("params.yaml").write_text(PARAMS)
    return fleet


def test_a_component_has_its_own_and_its_container_what_its_costmap_needs(composed: Path) -> None:
    container = {"component_container": "rclcpp_components"}
    (box,) = programs(
        started(composed, "box.launch.xml", COMPOSED, container), "component_container"
    )
    rules = [
        word for flag, word in zip(box["words"], box["words"][1:], strict=False) if flag == "-r"
    ]
    # The costmap reads the rules and the files of the process (nav2_costmap_2d costmap_2d_ros.cpp:110).
    assert "local_costmap:/scan:=/scan/robot1" in rules
    (costmap,) = (
        section["local_costmap"]["ros__parameters"]
        for text in box["files"].values()
        if "ros__parameters" in text
        for name, section in yaml.safe_load(text).items()
        if name == "/robot1/local_costmap"
    )
    assert costmap == {"robot_base_frame": "base_link/robot1", "width": 3}


def test_a_component_is_asked_for_with_its_names(composed: Path) -> None:
    from launch import LaunchContext
    from launch_ros.actions.load_composable_nodes import get_composable_node_load_request

    made = launch.composable_node(
        "controller_server",
        robot="robot1",
        fleet=str(composed),
        files="params.yaml",
        package="nav2_controller",
        plugin="nav2_controller::ControllerServer",
        extra_arguments=[{"use_intra_process_comms": True}],
        use_sim_time=True,
    )
    asked = get_composable_node_load_request(made, LaunchContext())
    assert (asked.package_name, asked.node_name) == ("nav2_controller", "controller_server")
    # Its code makes the costmap below its namespace, so it keeps its name in every layout.
    assert asked.node_namespace == "/robot1"
    assert "odom:=/odom/robot1" in asked.remap_rules
    assert {it.name for it in asked.parameters} == {"odom_topic", "use_sim_time"}
    assert [it.name for it in asked.extra_arguments] == ["use_intra_process_comms"]
