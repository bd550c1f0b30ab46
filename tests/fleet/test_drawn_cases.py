# SPDX-License-Identifier: Apache-2.0
"""Small fleets that drawn ones have led to: nothing in them is wrong, and each builds."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from drawn_builds import judge, run
from drawn_fleets import KINDS, NAV_PARAMS, RVIZ, SRDF, Data, DrawnFleet
from fleet_folder import planned_fleet
from paths import ROBOTS

from multibot_rewrite.planning.plan import read_plan

GZ, CART, XACRO, ARM = "gz rover", "plain cart", "xacro rover", "arm"


def fleet(kinds: str, *robots: Data, **keys: object) -> DrawnFleet:
    """Return a fleet of robots of these kinds, three metres apart."""
    each = tuple(kinds.split(", "))
    texts = {it: KINDS[it].text.replace("ROBOT", "robot") for it in KINDS}
    files = {f"{it.replace(' ', '_')}{KINDS[it].ending}": text for it, text in texts.items()}
    paths = dict(zip(KINDS, files, strict=True))
    rows = [
        {"description": paths[kind], "pose": {"x": 3 * at}, **row}
        for at, (row, kind) in enumerate(zip(robots, each, strict=True))
    ]
    more = {"nav.yaml": NAV_PARAMS, "one.rviz": RVIZ, "arm/one.rviz": RVIZ}
    more["arm.srdf"] = SRDF.replace("ROBOT", "arm")
    data = {"distro": "jazzy", "affix": "prefix", **keys, "robots": rows}
    return DrawnFleet(data, {**files, **more}, each)


CASES = {
    # base_link and lidar_link are alike behind a long prefix, and no slip of each other.
    "a prefix that makes frames alike": fleet(
        f"{CART}, {GZ}", {"name": "burger", "prefix": "burger0"}, {"name": "left", "prefix": "left1"},
        layout="both", separators={"link": "_"}, node_sets="teleop",
        related_files={"params": ["nav.yaml"]},
    ),
    "a drive of the other robot": fleet(
        f"{CART}, {GZ}", {"name": "r1"}, {"name": "r2"}, layout="tf-per-robot", node_sets="nav2"
    ),
    "only one of them has a lidar": fleet(
        f"{CART}, {GZ}", {"name": "r1"}, {"name": "r2"}, layout="both", node_sets="localization"
    ),
    "a robot called as a topic": fleet(
        f"{GZ}, {GZ}", {"name": "gz", "namespace": "gz_x"}, {"name": "cmd_vel", "namespace": "c"},
        layout="postfix",
    ),
    "models with the names of each other": fleet(
        f"{GZ}, {GZ}", {"name": "a", "model": "b"}, {"name": "b", "model": "a"}, layout="both"
    ),
    "a robot called as a frame": fleet(
        f"{GZ}, {GZ}", {"name": "r1", "related_files": {"params": ["nav.yaml"]}}, {"name": "base_link"},
        layout="both",
    ),
    "a robot called as frames end": fleet(
        f"{GZ}, {CART}", {"name": "gz"}, {"name": "link"}, layout="tf-per-robot"
    ),
    "a robot called as joints end": fleet(
        f"{CART}, {CART}", {"name": "joint"}, {"name": "r2"}, layout="tf-per-robot"
    ),
    "prefixes that are no namespaces": fleet(
        f"{XACRO}, {GZ}", {"name": "r1", "namespace": "r2"}, {"name": "r2", "namespace": "r1"},
        layout="postfix",
    ),
    "configs of one name": fleet(
        f"{GZ}, {GZ}", {"name": "r1", "related_files": {"rviz": "one.rviz"}},
        {"name": "r2", "related_files": {"rviz": "arm/one.rviz"}}, layout="frames-per-robot",
    ),
    "costmaps without namespaces, behind a prefix": fleet(
        f"{CART}, {CART}", {"name": "r1"}, {"name": "r2"}, layout="postfix", node_sets="navigation"
    ),
    "a robot called as a node begins": fleet(
        f"{CART}, {CART}", {"name": "robot"}, {"name": "r2"}, layout="postfix", affix="postfix",
        node_sets="localization",
    ),
    "a robot called as frames of all end": fleet(
        f"{GZ}, {GZ}", {"name": "link"}, {"name": "r1"}, layout="L1", node_sets="localization",
    ),
    "arms of a cell send one topic of joint states": fleet(
        f"{ARM}, {ARM}", {"name": "left"}, {"name": "right"}, layout="frames-per-robot", cell={},
        node_sets=["ros2_control", "moveit"], srdf="arm.srdf", separators={"link": "_"},
    ),
    "an argument that is the robot's name": fleet(
        f"{XACRO}, {XACRO}", {"name": "low", "arguments": {"mast": "low"}}, {"name": "r2"},
        layout="both", separators={"link": "_"},
    ),
    # Its bridge, which no plan has, is ros_gz_bridge_map, and the other robot's scan is its driver's.
    "a robot called as the topic of a real one's node": fleet(
        f"{GZ}, {GZ}", {"name": "r1", "simulator": "none"}, {"name": "map"}, layout="postfix",
        distro="humble", node_sets="nav2",
    ),
    # The parameters of a manager with a name are not those of the nodes that its hardware makes.
    "hardware on the machine's time": fleet(
        f"{GZ}, {ARM}", {"name": "r1"}, {"name": "r2", "node_sets": "ros2_control"},
        layout="tf-per-robot", use_sim_time=True,
    ),
}  # fmt: skip


@pytest.mark.sample(4)
@pytest.mark.parametrize("case", CASES)
def test_a_fleet_without_a_fault_builds(case: str, tmp_path: Path) -> None:
    judge(CASES[case], tmp_path)


NAMESPACES = fleet(
    f"{GZ}, {GZ}", {"name": "r1", "namespace": "alpha"}, {"name": "r2", "namespace": "beta"},
    layout="frames-per-robot",
)  # fmt: skip
SWAPPED = fleet(
    f"{GZ}, {CART}", {"name": "r1", "namespace": "r2"}, {"name": "r2", "namespace": "r1"},
    layout="frames-per-robot",
)  # fmt: skip


@pytest.mark.parametrize("drawn", [NAMESPACES, SWAPPED])
def test_findings_name_robots_by_their_names(drawn: DrawnFleet, tmp_path: Path) -> None:
    judge(drawn, tmp_path)
    file = str(tmp_path / "fleet.yaml")
    code, said = run("build", file, "-o", str(tmp_path / "out"), "--format", "json")
    assert code == 0
    found = json.loads(said[said.index("{") : said.rindex("}") + 1])
    named = [it["robots"] for it in found["findings"] if it.get("robots")]
    assert named
    assert {robot for robots in named for robot in robots} <= {"r1", "r2"}
    assert "the same for r1" not in run("build", file, "-o", str(tmp_path / "other"))[1]


def test_the_words_of_a_robot_are_those_of_no_other(tmp_path: Path) -> None:
    judge(SWAPPED, tmp_path)
    plan = planned_fleet(tmp_path / "fleet.yaml")
    assert plan.words == {"r1": "r1", "r2": "r2"}
    judge(NAMESPACES, tmp_path / "more")
    plan = planned_fleet(tmp_path / "more" / "fleet.yaml")
    assert plan.words == {"r1": "r1", "r2": "r2", "alpha": "r1", "beta": "r2"}


def test_a_node_of_a_file_that_is_called_like_a_node_set_is_the_files(here: Path) -> None:
    """It was refused: no SRDF for a node that a node set starts."""
    Path("rover.urdf").write_bytes((ROBOTS / "rover_gz.urdf").read_bytes())
    Path("node set of mine.yaml").write_text("move_group:\n  ros__parameters: {a: b}\n")
    Path("fleet.yaml").write_text(
        "layout: both\ndistro: jazzy\ndescription: rover.urdf\nnode_sets: moveit\n"
        "related_files: {params: node set of mine.yaml}\n"
        "robots: [{name: r1}, {name: r2, pose: {x: 2}}]\n"
    )
    assert run("build", "fleet.yaml", "-o", "out")[0] == 0
    plan = read_plan(Path("out/plan.yaml").read_bytes(), "plan.yaml")
    (found,) = (it for it in plan.nodes if it.name == "/r1/move_group")
    assert (found.node_set, found.place.line) == ("", 1)


def test_configs_of_one_name_have_a_name_each(tmp_path: Path) -> None:
    judge(CASES["configs of one name"], tmp_path)
    names = {it.name for it in (tmp_path / "out").glob("*.rviz")}
    assert names == {"one.rviz", "arm_one.rviz"}


def test_an_empty_list_of_files_is_none(tmp_path: Path) -> None:
    """A robot with ``params: []`` has none of the fleet's files: its nodes get frames of its own, as if
    nobody had files."""
    own: Data = {"name": "r1", "related_files": {"params": []}}
    drawn = fleet(
        f"{CART}, {GZ}", own, {"name": "r2", "node_sets": []}, layout="both", node_sets="localization",
        related_files={"params": ["nav.yaml"]},
    )  # fmt: skip
    judge(drawn, tmp_path)
    assert "odom_frame_id: r1/odom" in (tmp_path / "out/r1/params.yaml").read_text()


def test_a_parameter_file_may_be_called_as_the_bridge_is(here: Path) -> None:
    """It was refused: two files would be written to ``r1/bridge.yaml``."""
    Path("rover.urdf").write_bytes((ROBOTS / "rover_gz.urdf").read_bytes())
    Path("bridge.yaml").write_text("amcl:\n  ros__parameters: {base_frame_id: base_link}\n")
    Path("fleet.yaml").write_text(
        "layout: tf-per-robot\ndistro: jazzy\nnode_sets: [nav2]\ndescription: rover.urdf\n"
        "related_files: {params: bridge.yaml}\n"
        "robots: [{name: r1, pose: {x: 0}}, {name: r2, pose: {x: 2}}]\n"
    )
    assert run("build", "fleet.yaml", "-o", "out")[0] == 0
    assert "amcl" in Path("out/r1/params_bridge.yaml").read_text()
    assert "ros_topic_name" in Path("out/r1/bridge.yaml").read_text()
    assert "params_bridge.yaml" in Path("out/fleet.launch.py").read_text()
