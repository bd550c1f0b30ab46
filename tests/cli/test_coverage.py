# SPDX-License-Identifier: Apache-2.0
"""No verdict is said of more than was seen: each has the nodes that are known, started as they are,
seen and silent, as text and as JSON, and a graph with something unknown is not simply as planned."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from xml.etree import ElementTree

import pytest
from graph_cases import as_planned

from multibot_rewrite.cli import live
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.planning.plan import read_plan
from multibot_rewrite.system.coverage import coverage
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.records import (
    MAY,
    PUBLISHES,
    TOPIC,
    End,
    Node,
    Parameter,
    Robot,
    System,
)

URDF = """\
<robot name="pole">
  <link name="base_link"/>
  <link name="top"/>
  <joint name="up" type="fixed"><parent link="base_link"/><child link="top"/></joint>
</robot>
"""
LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    state = Node(package="robot_state_publisher", executable="robot_state_publisher",
                 name="robot_state_publisher")
    return LaunchDescription([state, {}])
"""
OWN = 'Node(package="ours", executable="{0}", name="{0}")'
FLEET = """\
description: pole.urdf
distro: jazzy
layout: both
simulator: none
launch: one.launch.py
robots:
- {name: robot1}
- {name: robot2}
"""
# What the launch file starts: robot_state_publisher is known, the programs of `ours` are not.
UNKNOWN = "2 robots, 3 nodes each: 1 known, 2 started as they are"
KNOWN = "2 robots, 1 node each: all known"


class Built:
    """A fleet that was built, with its plan and the graph that the plan asks for."""

    def __init__(self, folder: Path, *more: str) -> None:
        for name, text in {
            "pole.urdf": URDF, "fleet.yaml": FLEET, "one.launch.py": LAUNCH.format(", ".join(more)),
        }.items():  # fmt: skip
            (folder / name).write_text(text)
        self.fleet, self.out = str(folder / "fleet.yaml"), folder / "out"
        self.plan, self.launch = str(self.out / "plan.yaml"), str(self.out / "fleet.launch.py")
        self.graph = folder / "graph.json"
        assert main(["build", self.fleet, "--trust", "-o", str(self.out)]) == 0
        self.planned = read_plan(Path(self.plan).read_bytes(), self.plan)
        self.see(as_planned(self.planned))

    def see(self, graph: System) -> None:
        self.seen = graph
        self.graph.write_bytes(to_json(graph))

    def check(self, *words: str) -> int:
        return main(["check", self.plan, "--from", str(self.graph), *words])


@pytest.fixture
def unknown(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Built:
    return Built(tmp_path, OWN.format("blinker"), OWN.format("horn"))


@pytest.fixture
def known(tmp_path: Path) -> Built:
    return Built(tmp_path)


def last(capsys: pytest.CaptureFixture[str]) -> str:
    return capsys.readouterr().err.splitlines()[-1].removeprefix("multibot: ")


def numbers(capsys: pytest.CaptureFixture[str]) -> Mapping[str, object]:
    found: Mapping[str, object] = json.loads(capsys.readouterr().out)["coverage"]
    return found


def row(nodes: int, known: int | None, seen: int | None, silent: int | None) -> dict[str, object]:
    left = None if known is None else nodes - known
    told = {"known": known, "in_part": None if known is None else 0, "as_they_are": left}
    return {"nodes": nodes, **told, "seen": seen, "silent": silent}


def whole(text: str, total: dict[str, object], each: dict[str, object]) -> dict[str, object]:
    robots = [{"robot": it, **each} for it in ("robot1", "robot2")]
    return {**total, "incomplete": 0, "unread": 0, "processes": 0, "robots": robots, "text": text}


def test_a_build_and_its_plan_say_what_they_start_as_it_is(
    unknown: Built, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    capsys.readouterr()
    build = ["build", unknown.fleet, "--trust", "-o", str(unknown.out)]
    assert main(build) == 0
    assert f"multibot: {UNKNOWN}; " in capsys.readouterr().err
    assert main([*build, "--format", "json"]) == 0
    assert numbers(capsys) == whole(UNKNOWN, row(6, 2, None, None), row(3, 1, None, None))
    made = str(tmp_path / "plan.yaml")
    assert main(["plan", unknown.fleet, "--trust", "-o", made]) == 0
    assert last(capsys) == UNKNOWN


def test_what_does_not_answer_is_silent(known: Built, capsys: pytest.CaptureFixture[str]) -> None:
    answer = Parameter("/robot1/robot_state_publisher", "use_sim_time", "false")
    known.see(known.seen._replace(parameters=(answer,)))
    capsys.readouterr()
    assert known.check() == 0
    end = "all seen, 1 silent; 0 findings: as planned as far as known (ROS 2 jazzy)"
    assert last(capsys) == f"{KNOWN}, {end}"
    assert known.check("--format", "json") == 0
    found = numbers(capsys)
    assert (found["silent"], [it["silent"] for it in found["robots"]]) == (1, [0, 1])  # type: ignore[attr-defined]


def test_a_watch_and_its_lines_say_as_far_as_known(
    unknown: Built, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(live, "watched", lambda *_, **__: (it for it in ({0: unknown.seen},)))
    capsys.readouterr()
    assert main(["check", unknown.plan, "--watch", "--timeout", "1"]) == 0
    out, err = capsys.readouterr()
    verdict = f"{UNKNOWN}, all seen; 0 findings: as planned as far as known"
    assert out.endswith(f" s  {verdict}\n") and err.endswith(f": {verdict} (ROS 2 jazzy)\n")


def test_every_form_of_a_report_has_the_same_words(
    unknown: Built, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text, page = f"{UNKNOWN}, all seen", tmp_path / "report.html"
    capsys.readouterr()
    assert unknown.check("--format", "sarif", "--report", str(page)) == 0
    (run,) = json.loads(capsys.readouterr().out)["runs"]
    assert (run["properties"]["coverage"]["text"], run["properties"]["distro"]) == (text, "jazzy")
    assert f"<li>{text}</li>" in page.read_text()
    assert "<h1>as planned as far as known</h1>" in page.read_text()
    assert "<p>2 robots, as planned as far as known; 6 nodes running</p>" in page.read_text()
    assert unknown.check("--format", "junit") == 0
    suites = ElementTree.fromstring(capsys.readouterr().out.encode())
    assert [it.attrib for it in suites.iter("property")] == [{"name": "coverage", "value": text}]
    assert unknown.check("--format", "markdown") == 0
    assert f"({text})" in capsys.readouterr().out


@pytest.mark.live
def test_a_rehearsal_has_unknown_nodes_by_name_alone(
    unknown: Built, capsys: pytest.CaptureFixture[str]
) -> None:
    capsys.readouterr()
    assert main(["rehearse", unknown.fleet, "--trust"]) == 0
    assert f"{UNKNOWN}, all seen; " in (said := last(capsys))
    assert ": no error, see the notes" in said


def planned(robots: Iterable[tuple[str, int, int]]) -> System:
    """Return a plan with nodes of robots: something is known of so many, of the others the name."""
    nodes, ends, names = [], [], []
    for robot, known, unknown in robots:
        names += [Robot(robot)] if robot else []
        for at in range(known + unknown):
            nodes.append(Node(f"/{robot}/node{at}".replace("//", "/"), robot=robot))
            topic = f"/{robot}/topic{at}"
            if at < known:
                ends.append(End(TOPIC, PUBLISHES, topic, "", node=nodes[-1].name))
    return System(tuple(nodes), tuple(ends), robots=tuple(names), layout="both")


@pytest.mark.parametrize(
    ("robots", "text"),
    [
        ([("a", 12, 3), ("b", 12, 3)], "2 robots, 15 nodes each: 12 known, 3 started as they are"),
        ([("a", 1, 0)], "1 robot, 1 node: all known"),
        ([("a", 1, 1)], "1 robot, 2 nodes: 1 known, 1 started as it is"),
        (
            [(f"robot{it}", 12, 3) for it in range(100)],
            "100 robots, 15 nodes each: 12 known, 3 started as they are",
        ),
        (
            [("a", 2, 0), ("b", 5, 1), ("c", 4, 2)],
            "3 robots, 2 to 6 nodes each: 11 known, 3 started as they are (b 1, c 2)",
        ),
        (
            [("a", 2, 1), ("b", 2, 1), ("", 3, 0)],
            "2 robots, 3 nodes each, 3 for all: 7 known, 2 started as they are (a 1, b 1)",
        ),
        (
            [("a", 2, 0), ("b", 2, 0), ("", 0, 1)],
            "2 robots, 2 nodes each, 1 for all: 4 known, 1 started as it is (for all 1)",
        ),
        (
            [(f"r{it}", 1, it % 2) for it in range(20)],
            "20 robots, 1 to 2 nodes each: 20 known, 10 started as they are"
            " (r1 1, r3 1, r5 1, r7 1, r9 1 and 5 more)",
        ),
        ([("", 2, 1)], "3 nodes: 2 known, 1 started as it is"),
        ([("a", 0, 0)], "1 robot"),
    ],
)
def test_robots_that_differ_are_named(robots: list[tuple[str, int, int]], text: str) -> None:
    assert coverage(planned(robots)).in_words == text


def test_a_node_that_only_may_run_is_not_missed() -> None:
    """One that surely runs is; one that may run and is there is seen."""
    plan = planned([("a", 3, 0)])
    sure, absent, there = plan.nodes
    plan = plan._replace(nodes=(sure, absent._replace(sure=MAY), there._replace(sure=MAY)))
    assert coverage(plan).in_words == "1 robot, 3 nodes: all known"
    seen = System((Node(there.name),), ())
    assert coverage(plan, seen).in_words == "1 robot, 2 nodes: all known, 1 of 2 seen"


DEPTH_CAMERA = (
    '<robot name="cam"><link name="base_link"/><gazebo reference="base_link"><sensor name="front"'
    ' type="depth_camera"><topic>camera/image_raw</topic><camera/></sensor></gazebo></robot>'
)


def test_a_build_has_the_names_of_robots_and_the_keys_of_the_fleet_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Not their namespaces, and no options of urdf-postfix."""
    (tmp_path / "cam.urdf").write_text(DEPTH_CAMERA)
    rows = "robots: [{name: r1, namespace: alpha}, {name: r2, namespace: beta}]"
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(f"description: cam.urdf\nlayout: postfix\ndistro: jazzy\n{rows}\n")
    main(["build", str(fleet), "-o", str(tmp_path / "out"), "--format", "json"])
    told = json.loads(capsys.readouterr().out)
    assert [it["robot"] for it in told["coverage"]["robots"]] == ["r1", "r2"]
    hints = [it["hint"] for it in told["findings"] if "camera_info" in it["message"]]
    assert any("topics: namespace" in it for it in hints) and "--topics" not in str(hints)


CLASSIC_DRIVE = (
    '<robot name="cart"><link name="base_link"><inertial><mass value="1"/><inertia ixx="1" iyy="1"'
    ' izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link><gazebo><plugin name="drive"'
    ' filename="libgazebo_ros_planar_move.so"><ros><remapping>/tf:=tf</remapping></ros>'
    "</plugin></gazebo></robot>"
)


def test_a_build_of_one_robot_names_its_node_and_the_key_of_the_layout_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The plugin's rule moves its tf away from the one /tf of the layout."""
    (tmp_path / "cart.urdf").write_text(CLASSIC_DRIVE)
    fleet = tmp_path / "fleet.yaml"
    layout = "layout: frames-per-robot\ndistro: humble\n"
    fleet.write_text(f"description: cart.urdf\n{layout}robots: [{{name: r1}}]\n")
    main(["build", str(fleet), "-o", str(tmp_path / "out")])
    told = capsys.readouterr().err
    assert "use layout: both" in told and "--layout" not in told
    (line,) = (it for it in told.splitlines() if " MG405 " in it)
    assert line.count("/r1/robot_state_publisher") == 1
