# SPDX-License-Identifier: Apache-2.0
"""``load_fleet``: what a launch script gets of a fleet file, in each layout, without launch."""

from __future__ import annotations

import json
import random
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from paths import FIXTURES, SUPPORT, fixture_text

from multibot_rewrite import InputError, RewriteRefused, UsageError, load_fleet
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.robots.loaded_robot import LoadedRobot
from multibot_rewrite.library.loaded_fleet import LoadedFleet
from multibot_rewrite.related_files.params.rcl_parameters import node_parameters
from multibot_rewrite.related_files.yaml_text import read_yaml

ROVER = FIXTURES / "robots" / "rover.urdf"
PARAMS = fixture_text("scripts_params.yaml")
FLEET = """\
layout: {layout}
affix: {affix}
node_sets: [nav2, robot_state]
robots:
  - {{name: robot1, description: rover.urdf, pose: {{x: 1.0, y: 0.5, yaw: 1.5}}}}
  - {{name: robot2, description: rover.urdf, model: second}}
related_files:
  params: [params.yaml]
"""
LAYOUTS = ("L1", "L2", "L3", "L4")
CHILD = SUPPORT / "rcl_params_child.py"


def fleet(folder: Path, layout: str = "L2", text: str = FLEET, params: str = PARAMS) -> LoadedFleet:
    """Return the fleet file of a folder, loaded."""
    (folder / "rover.urdf").write_bytes(ROVER.read_bytes())
    (folder / "params.yaml").write_text(params)
    affix = "postfix" if layout == "L4" else "prefix"
    (folder / "fleet.yaml").write_text(text.format(layout=layout, affix=affix))
    return load_fleet(folder / "fleet.yaml")


@pytest.fixture
def robot(tmp_path: Path) -> LoadedRobot:
    return fleet(tmp_path).robot("robot1")


TF = [("/tf", "tf"), ("/tf_static", "tf_static")]
TF_4 = [("/tf", "/tf/robot1"), ("/tf_static", "/tf_static/robot1")]


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("layout", "node", "frame", "joint", "topic", "tf"),
    [
        ("L1", "/robot1/amcl", "base_link", "lidar_joint", "/robot1/scan", TF),
        ("L2", "/robot1/amcl", "robot1/base_link", "robot1_lidar_joint", "/robot1/scan", []),
        ("L3", "/robot1/amcl", "robot1/base_link", "robot1_lidar_joint", "/robot1/scan", TF),
        ("L4", "/amcl_robot1", "base_link/robot1", "lidar_joint_robot1", "/scan/robot1", TF_4),
    ],
)
def test_names_of_a_robot(
    layout: str, node: str, frame: str, joint: str, topic: str, tf: object, tmp_path: Path
) -> None:
    its = fleet(tmp_path, layout).robot("robot1")
    assert its.namespace == ("/" if layout == "L4" else "/robot1")
    assert its.table.full_name("amcl") == node
    assert f"{its.table.namespace('amcl').rstrip('/')}/{its.table.name('amcl')}" == node
    assert (its.frame("base_link"), its.joint("lidar_joint")) == (frame, joint)
    assert (its.topic("/scan"), its.topic("scan")) == (topic, topic)
    assert (its.frame("map"), its.topic("/clock")) == ("map", "/clock")
    assert its.tf_remappings == tf
    assert f'<link name="{frame}">' in its.description


@pytest.mark.slow
@pytest.mark.parametrize("layout", LAYOUTS)
def test_rules_are_those_of_the_table(layout: str, tmp_path: Path) -> None:
    loaded = fleet(tmp_path, layout)
    for one in loaded.robots:
        for table in loaded.plan.fleet.table.runs:
            if table.robot == one.name:
                own = list(table.rules)
                found = one.table.for_node(table.node)
                assert found[len(found) - len(own) :] == own


@pytest.mark.slow
@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_node_in_another_ones_process_gets_its_rules_first(layout: str, tmp_path: Path) -> None:
    table = fleet(tmp_path, layout).robots[0].table
    rules = table.for_node("controller_server")
    costmap = table.for_node("local_costmap/local_costmap")
    name = table.name("local_costmap/local_costmap")
    assert costmap
    assert rules[: len(costmap)] == [(f"{name}:{source}", target) for source, target in costmap]


def controlled(folder: Path, release: str) -> LoadedRobot:
    text = f"distro: {release}\n" + FLEET.replace("[nav2, robot_state]", "ros2_control")
    return fleet(folder, "L1", text).robot("robot2")


@pytest.mark.parametrize(
    ("release", "rules"), [("humble", []), ("lyrical", ["--controller-ros-args", "-r /tf:=tf"])]
)
def test_a_controller_has_its_rules_from_its_spawner_or_its_manager(
    release: str, rules: list[str], tmp_path: Path
) -> None:
    its = controlled(tmp_path, release)
    made = its.spawner("diff_drive_controller", "one.yaml")
    assert (made["package"], made["executable"]) == ("controller_manager", "spawner")
    assert made["arguments"] == ["diff_drive_controller", *rules, "-p", "one.yaml"]
    of_manager = [("diff_drive_controller:/tf", "tf"), ("~/robot_description", "robot_description")]
    assert its.table.for_node("controller_manager") == (of_manager if release == "humble" else [])


def test_a_controller_is_no_node_to_start(tmp_path: Path) -> None:
    its = controlled(tmp_path, "lyrical")
    for asked in (its.node, its.table.for_node):
        with pytest.raises(
            UsageError, match=r"its spawner .* robot\.spawner\('diff_drive_controller'\)"
        ):
            asked("diff_drive_controller")
    with pytest.raises(UsageError, match="controller 'controller_manager' is not known"):
        its.spawner("controller_manager")
    with pytest.raises(UsageError, match="did you mean 'diff_drive_controller'"):
        its.spawner("dif_drive_controller")


@pytest.mark.more
def test_parameters_of_a_node(robot: LoadedRobot) -> None:
    found = robot.params("params.yaml", "amcl")
    assert found["base_frame_id"] == "robot1/base_footprint"
    assert found["odom_frame_id"] == "robot1/odom"
    assert found["use_sim_time"] is True
    assert (found["tolerance"], found["flag"], found["quoted"]) == (1e-9, False, "n")
    assert (found["initial_pose.x"], found["marker.y"]) == (0.5, 1)
    assert found["names"] == ["1", "2"]
    assert isinstance(found["marker.y"], int)


@pytest.mark.slow
@pytest.mark.parametrize("file", ["params.yaml", "./params.yaml", "config/params.yaml"])
def test_a_file_goes_by_its_name(file: str, robot: LoadedRobot) -> None:
    assert robot.params(file, "amcl") == robot.params("params.yaml", "amcl")


@pytest.mark.slow
def test_a_node_as_launch_ros_takes_it(robot: LoadedRobot) -> None:
    made = robot.node("amcl", "params.yaml")
    start = {"set_initial_pose": True, "initial_pose.x": 1.0, "initial_pose.y": 0.5}
    assert made["name"] == "amcl"
    assert made["namespace"] == "/robot1"
    assert made["remappings"] == robot.table.for_node("amcl")
    assert made["parameters"][0] == robot.params("params.yaml", "amcl")
    assert start.items() <= made["parameters"][1].items()
    assert robot.node("bt_navigator")["parameters"] == []


@pytest.mark.more
def test_a_robot_without_a_pose_has_no_start_parameters(tmp_path: Path) -> None:
    loaded = fleet(tmp_path)
    assert loaded.robot("robot2").node("amcl")["parameters"] == []
    assert loaded.robot("robot2").start_parameters("amcl") == {}
    assert loaded.robot("robot1").start_parameters("bt_navigator") == {}


def test_arguments_of_programs(tmp_path: Path) -> None:
    text = FLEET.replace("[nav2, robot_state]", "robot_state")
    # Without localisation: neither the node set nor the parameters have a node for it.
    own = "my_node:\n  ros__parameters: {frame: odom}\n"
    first, second = fleet(tmp_path, "L2", text, own).robots
    assert first.spawn_arguments[:4] == ["-name", "robot1", "-topic", "/robot1/robot_description"]
    assert second.spawn_arguments[:2] == ["-name", "second"]
    assert first.classic_arguments[:2] == ["-entity", "robot1"]
    assert first.classic_arguments[4:6] == ["-x", "1.0"]
    assert first.teleop_arguments == ["--ros-args", "-r", "cmd_vel:=/robot1/cmd_vel"]
    assert "robot1/odom" in first.transform_arguments
    assert second.transform_arguments == []
    assert first.table.full_name("start_pose") == "/robot1/start_pose"


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("ask", "parts"),
    [
        (lambda it: it.table.for_node("amlc"), ("robot 'robot1'", "'amlc'", "did you mean 'amcl'")),
        (lambda it: it.node("amlc"), ("did you mean 'amcl'", "node_sets: in the fleet file")),
        (lambda it: it.params("params.yaml", "amlc"), ("params.yaml", "did you mean 'amcl'")),
        (lambda it: it.params("params.yaml", "my_nod"), ("did you mean 'my_node'",)),
        (lambda it: it.params("parms.yaml", "amcl"), ("did you mean 'robot1/params.yaml'",)),
        (lambda it: it.text("parms.yaml"), ("under related_files",)),
        (lambda it: it._fleet.robot("robt1"), ("did you mean 'robot1'", "robot2")),
        (lambda it: it._fleet.table.name("amcl"), ("all robots",)),
    ],
)
def test_an_unknown_name_is_reported_with_the_nearest(
    ask: Callable[[LoadedRobot], object], parts: Sequence[str], robot: LoadedRobot
) -> None:
    with pytest.raises(UsageError) as caught:
        ask(robot)
    assert all(part in str(caught.value) for part in parts), caught.value
    assert "\n" not in str(caught.value)


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("params", "part"),
    [
        # Of the file as it is read: what is written has other lines.
        ("amcl:\n  ros__parameters:\n    a:\n", "params.yaml:3: the value is missing"),
        (
            "amcl:\n  ros__parameters:\n    a: [1, 2.0]\n",
            "params.yaml:3:8: error: MB120 rcl rejects the file: the list mixes types",
        ),
        (
            "amcl:\n  ros__parameters:\n    a: [[1], [2]]\n",
            "rcl rejects the file: a list holds a list",
        ),
    ],
)
def test_what_rcl_refuses_is_refused_with_its_line(params: str, part: str, tmp_path: Path) -> None:
    with pytest.raises((InputError, RewriteRefused)) as caught:
        loaded = fleet(tmp_path, params=params)
        loaded.robots[0].params("params.yaml", "amcl")
    assert part in str(caught.value)


@pytest.mark.more
def test_robots_that_would_meet_are_refused(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text(
        "nodes:\n  talker:\n    package: mine\n"
        "    publishes: {x_left: std_msgs/msg/String, x: std_msgs/msg/String}\n"
        "node_sets:\n  mine: {about: x, nodes: [talker]}\n"
    )
    text = (
        "layout: postfix\nnode_sets: mine\nnodes: mine.yaml\nseparators: {{topic: _}}\nrobots:\n"
        "  - {{name: b, description: rover.urdf}}\n  - {{name: left_b, description: rover.urdf}}\n"
    )
    with pytest.raises(RewriteRefused) as caught:
        fleet(tmp_path, "L4", text)
    assert "MG320" in {it.code for it in caught.value.findings}


@pytest.mark.more
def test_a_related_file_that_cannot_be_rewritten_is_refused(tmp_path: Path) -> None:
    params = "robot1:\n  amcl:\n    ros__parameters: {a: 1}\n"
    loaded = fleet(tmp_path, params=params)
    with pytest.raises(RewriteRefused, match="MB883"):
        loaded.robots[0].params("params.yaml", "amcl")


@pytest.mark.sample(2)
@pytest.mark.slow
@pytest.mark.parametrize("layout", LAYOUTS)
def test_files_are_those_of_a_build(
    layout: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    loaded = fleet(tmp_path, layout)
    out = tmp_path / "out"
    assert main(["build", loaded.file, "-o", str(out), "--quiet"]) == 0
    assert loaded.files
    for path, made in loaded.files.items():
        assert (out / path).read_bytes() == made.data, path
    assert loaded.robots[0].text("params.yaml") == (out / "robot1" / "params.yaml").read_text()


@pytest.mark.slow
def test_nothing_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    empty = tmp_path / "tmp"
    empty.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(empty))
    loaded = fleet(tmp_path)
    before = sorted(tmp_path.rglob("*"))
    for one in loaded.robots:
        one.node("amcl", "params.yaml")
    assert sorted(tmp_path.rglob("*")) == before
    assert capsys.readouterr() == ("", "")


@pytest.mark.slow
def test_no_part_of_ros_is_needed() -> None:
    code = "import sys; from multibot_rewrite import load_fleet; load_fleet; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = {name.partition(".")[0] for name in done.stdout.split()}
    assert not loaded & {"launch", "launch_ros", "rclpy", "ament_index_python", "xacro"}


@pytest.mark.more
def test_a_representation_is_short(robot: LoadedRobot) -> None:
    assert repr(robot) == "LoadedRobot('robot1')"
    assert len(repr(robot._fleet)) < 300


WILD = """\
/**:
  ros__parameters: {a: 1, b: 1, c: 1}
{first}:
  ros__parameters: {a: 2, b: 2}
{second}:
  ros__parameters: {a: 3, d: {e: 4}}
/**:
  ros__parameters: {c: 5}
"""
KEYS = ("/**", "/*/amcl", "/**/amcl", "/r1/**", "/r1/*", "/r1/amcl", "amcl", "/r2/amcl", "/*")


def section_cases() -> list[str]:
    return [WILD.replace("{first}", a).replace("{second}", b) for a in KEYS for b in KEYS if a != b]


def scalar_cases() -> list[str]:
    drawn = random.Random(5)
    words = [
        "".join(drawn.choices("0123456789abefinxyNY+-._", k=drawn.randint(1, 6)))
        for _ in range(200)
    ]
    words += [
        "'5'",
        '"y"',
        "!!str 5",
        "!!str y",
        "!!str 1e-9",
        "a b",
        "[1, 2]",
        "[y, n]",
        "[1.0, 2.0]",
    ]
    return [f"r1/amcl:\n  ros__parameters:\n    p: {word}\n" for word in words]


def without_its_own(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return a node's parameters but those that every node declares."""
    own = ("use_sim_time", "start_type_description_service")
    return {name: value for name, value in values.items() if name not in own}


def same(ours: Mapping[str, Any] | None, theirs: Mapping[str, Any] | None) -> bool:
    # JSON has no order to keep here, and NaN is not itself.
    return repr(sorted((ours or {}).items())) == repr(sorted((theirs or {}).items()))


def ours(text: str) -> Mapping[str, Any] | None:
    try:
        return node_parameters(read_yaml(text.encode(), "x"), "/r1/amcl")
    except InputError:
        return None


@pytest.mark.live
@pytest.mark.skipif(
    not find_spec("rclpy"), reason="types are not compared with the real rcl: no rclpy here"
)
@pytest.mark.parametrize("cases", [section_cases, scalar_cases])
def test_parameters_are_those_of_the_real_rcl(
    cases: Callable[[], list[str]], tmp_path: Path
) -> None:
    texts, lines = cases(), []
    for at, text in enumerate(texts):
        (tmp_path / f"{at}.yaml").write_text(text)
        case = {"file": str(tmp_path / f"{at}.yaml"), "nodes": [["/r1", "amcl"]]}
        lines.append(json.dumps(case) + "\n")
    done = subprocess.run(
        [sys.executable, str(CHILD)],
        input="".join(lines),
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(answers) == len(texts), done.stderr[-2000:]
    told = [without_its_own(it[0]) if it else None for it in answers]
    pairs = zip(texts, told, strict=True)
    wrong = [(text, theirs) for text, theirs in pairs if not same(ours(text), theirs)]
    assert wrong == []
    assert sum(it is not None for it in told) > len(texts) / 2


COMPOSED = FLEET.replace("nav2, robot_state", "nav2_composed, robot_state")
HOSTED = """\
controller_server:
  ros__parameters: {odom_topic: odom}
local_costmap:
  local_costmap:
    ros__parameters: {global_frame: odom, robot_base_frame: base_link}
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "node"), [(FLEET, "controller_server"), (COMPOSED, "nav2_container")]
)
@pytest.mark.skipif(not find_spec("rclpy"), reason="no rclpy: rcl is the judge")
def test_a_costmap_gets_its_parameters_by_the_process_that_it_is_in(
    tmp_path: Path, text: str, node: str
) -> None:
    """Values in ``parameters`` are for one node: launch_ros writes them below its full name."""
    loaded = fleet(tmp_path, "L3", f"{text}use_sim_time: true\n", HOSTED)
    files = loaded.robot("robot1").node(node, "params.yaml")["parameters"]
    assert all(isinstance(it, str) for it in files)
    places = [("/robot1/local_costmap", "local_costmap"), ("/robot1", "controller_server")]
    asked = "".join(json.dumps({"file": it, "nodes": places}) + "\n" for it in files)
    done = subprocess.run(
        [sys.executable, str(CHILD)], input=asked, capture_output=True, text=True, check=True
    )
    costmap, server = {}, {}
    for line in done.stdout.splitlines():
        mine, its = json.loads(line)
        costmap |= mine
        server |= its
    assert costmap["global_frame"] == "robot1/odom"
    assert costmap["use_sim_time"] is True
    assert (server["odom_topic"], server["use_sim_time"]) == ("odom", True)


@pytest.mark.more
def test_which_nodes_are_in_a_process(tmp_path: Path) -> None:
    table = fleet(tmp_path, "L3", COMPOSED, HOSTED).robot("robot1").table
    assert table.inside("controller_server") == ["local_costmap/local_costmap"]
    assert table.inside("amcl") == []
    whole = set(table.inside("nav2_container"))
    assert {"amcl", "controller_server", "global_costmap/global_costmap"} <= whole
    assert whole.isdisjoint({"robot_state_publisher", "nav2_container"})


NODE_SET_ALONE = """\
layout: {layout}
affix: {affix}
node_sets: [nav2, robot_state]
robots:
  - {{name: robot1, description: rover.urdf}}
  - {{name: robot2, description: rover.urdf}}
"""


@pytest.mark.parametrize(
    ("layout", "more", "given"),
    [
        ("L2", "", "robot2/odom"),
        ("L1", "", ""),
        # nav2_bringup takes one file, with all that Nav2 needs.
        ("L3", "params_style: bringup\n", ""),
    ],
)
def test_a_robot_without_parameter_files_gets_the_frames_of_its_nodes(
    layout: str, more: str, given: str, tmp_path: Path
) -> None:
    loaded = fleet(tmp_path, layout, more + NODE_SET_ALONE)
    robot, name = loaded.robot("robot2"), "robot2/params.yaml"
    assert robot.params_files == (("params.yaml",) if given else ())
    assert (name in loaded.files) is bool(given)
    started = loaded.text("fleet.launch.py")
    assert ("params.yaml" in started) is bool(given)
    if given:
        assert robot.params("params.yaml", "amcl")["odom_frame_id"] == given
