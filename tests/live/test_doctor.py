# SPDX-License-Identifier: Apache-2.0
"""The doctor: silent where nothing is wrong, each seeded fault found with its cause, no plan needed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from fault_changes import added, nav, shared_tf
from graph_calls import (
    GuessedRobot,
    check,
    diagnose,
    from_yaml,
    guess_robots,
    survey,
    to_json,
    with_answers,
)
from graph_cases import environment, qos
from graph_faults import FAULTS
from healthy_systems import (
    SCAN,
    SYSTEMS,
    TWIST,
    nav2_with_tools,
    plan,
    single,
    started,
    with_node,
)
from node_answers import told

from multibot_rewrite.cli import multibot
from multibot_rewrite.producers.bags.read import RECORDER
from multibot_rewrite.producers.ros.tf_subscriptions import Voices
from multibot_rewrite.system.records import (
    PUBLISHES,
    System,
)

EMPTY = System((), (), (), environment())


# ---------------------------------------------------------------- whose names


@pytest.mark.slow
@pytest.mark.parametrize(
    ("system", "names", "layout"),
    [
        (lambda: nav2_with_tools("L1"), ["robot1", "robot2"], "tf-per-robot"),
        (lambda: nav2_with_tools("L2"), ["robot1", "robot2"], "frames-per-robot"),
        (lambda: nav2_with_tools("L3"), ["robot1", "robot2"], "both"),
        (lambda: started(("nav2",), "L4"), ["robot1", "robot2"], "postfix"),
        (SYSTEMS["namespaces of two levels"], ["fleet_a/robot1", "fleet_b/robot1"], "tf-per-robot"),
        (SYSTEMS["a robot with two arms, no namespaces"], ["left", "right"], ""),
        (single, [], ""),
        (lambda: EMPTY, [], ""),
    ],
)
def test_the_robots_and_their_layout(
    system: Callable[[], System], names: list[str], layout: str
) -> None:
    seen = diagnose(system())
    assert [it.name for it in seen.robots] == names
    assert (seen.layout.name if seen.layout else "") == layout


@pytest.mark.more
def test_parts_of_a_robot_are_no_robots() -> None:
    """Cameras and costmaps have namespaces with topics like a robot's."""
    graph = single()
    for part in ("camera_left", "camera_right", "zed_front", "local_costmap"):
        ends = [(PUBLISHES, f"/{part}/{it}", TWIST) for it in ("odom", "joint_states")]
        graph = with_node(graph, f"/{part}/node", *ends)
    assert guess_robots(graph) == ()
    for arm in ("two_finger_arm1", "two_finger_arm2"):
        ends = [(PUBLISHES, f"/{arm}/{it}", TWIST) for it in ("robot_description", "joint_states")]
        graph = with_node(graph, f"/{arm}/node", *ends)
    assert [it.name for it in guess_robots(graph)] == ["two_finger_arm1", "two_finger_arm2"]


def test_names_to_which_nobody_listens_are_no_robot() -> None:
    ends = [(PUBLISHES, f"/robot_2/{it}", TWIST) for it in ("cmd_vel", "odom")]
    graph = with_node(nav2_with_tools(), "/fleet_manager", *ends)
    assert [it.name for it in guess_robots(graph)] == ["robot1", "robot2"]


# ---------------------------------------------------------------- close to a fault, and none


def second_lidar(graph: System) -> System:
    """Return a second lidar with another QoS: the reader gets the scans of one."""
    graph = added("/robot1/rear_lidar", (PUBLISHES, "/robot1/scan", SCAN))(graph)
    weak, strong = qos(reliability="BEST_EFFORT"), qos(reliability="RELIABLE")
    ends = (
        it._replace(qos=weak if it.node == "/robot1/rear_lidar" else strong)
        if it.name == "/robot1/scan"
        else it
        for it in graph.ends
    )
    return graph._replace(ends=tuple(reversed(tuple(ends))))


def test_a_reader_that_hears_one_of_two_publishers_is_warned() -> None:
    found = diagnose(second_lidar(nav2_with_tools())).findings
    assert {(it.code, it.level) for it in found} == {("MG307", "warning"), ("MG325", "warning")}
    refused = [it for it in found if it.code == "MG307"]
    assert all("no message of /robot1/rear_lidar ever arrives" in it.hint for it in refused)


NO_LAYOUT = "layout: none of those known: neither tf topics nor frames have the robot's name"
IN_FRAMES = "layout: frames have the robot's name, topics and nodes have not"


@pytest.mark.parametrize(
    ("robots", "told"),
    [
        ([GuessedRobot("a", "/a"), GuessedRobot("b", "")],
         ["2 robots by their namespaces: a, b", NO_LAYOUT]),
        ([GuessedRobot("a", "", before="a/"), GuessedRobot("b", "", behind="_b")],
         ["2 robots by what their frames have: a, b", IN_FRAMES]),
        ([GuessedRobot("a", "", behind="_a")],
         ["1 robot by the ends of names: a", IN_FRAMES]),
        ([], []),
    ],
)  # fmt: skip
def test_robots_are_told_with_where_their_names_are(
    robots: list[GuessedRobot], told: list[str]
) -> None:
    seen = diagnose(EMPTY)._replace(robots=tuple(robots), layout=None)
    assert survey(seen) == "; ".join(told)


def test_who_sends_on_a_tf_topic_is_told() -> None:
    seen = diagnose(nav2_with_tools("L2"))
    senders = ("/robot1/a", "/robot2/a", "/robot1/b", "/c")
    seen = seen._replace(tf=(("/tf", senders), ("/b/tf", (RECORDER,)), ("/a/tf", senders[:1])))
    assert survey(seen).split("; ") == [
        "2 robots by their namespaces: robot1, robot2",
        "layout: looks like frames-per-robot (L2: one /tf, frames per robot)",
        "tf on /b/tf",
        "tf on /tf: 4 nodes of robot1, robot2, no robot",
        "tf on /a/tf: 1 node of robot1",
    ]


# ---------------------------------------------------------------- the command


def saved(folder: Path, graph: System) -> str:
    (folder / "graph.json").write_bytes(to_json(graph))
    return str(folder / "graph.json")


def faulty(code: str, level: str = "error") -> System:
    fault = next(it for it in FAULTS if (it.code, it.level) == (code, level))
    return fault.change(fault.system())


@pytest.mark.slow
@pytest.mark.parametrize(
    ("fault", "more", "code"),
    [
        (("MG402", "error"), [], 1),
        (("MG312", "error"), [], 1),
        (("MG308", "warning"), [], 0),
        (("MG308", "warning"), ["--fail-on", "warning"], 1),
        (("MG402", "error"), ["--ignore", "MG402"], 0),
        (("MG402", "error"), ["--select", "MG3"], 0),
    ],
)
def test_the_exit_code(fault: tuple[str, str], more: list[str], code: int, tmp_path: Path) -> None:
    graph = saved(tmp_path, faulty(*fault))
    assert multibot.main(["check", "--from", graph, *more]) == code


@pytest.mark.more
@pytest.mark.sample(4)
@pytest.mark.parametrize("name", SYSTEMS)
def test_what_is_suggested_is_taken(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    graph, folder = saved(tmp_path, SYSTEMS[name]()), tmp_path / "first"
    assert multibot.main(["check", "--from", graph, "--suggest", str(folder)]) == 0
    assert multibot.main(["check", str(folder / "plan.yaml"), "--from", graph]) == 0
    fleet, planned = str(folder / "fleet.yaml"), str(tmp_path / "plan.yaml")
    assert multibot.main(["plan", fleet, "-o", planned]) == 0, capsys.readouterr().err


@pytest.mark.slow
def test_what_separates_a_robots_word_from_frames_is_suggested(tmp_path: Path) -> None:
    """`robot1_base_link`, where a fleet file has `robot1/base_link` by itself."""

    def spelled(name: str) -> str:
        plain, _, robot = name.rpartition("/")
        return f"{robot}_{plain}" if plain else name

    graph = shared_tf()
    frames = (it._replace(child=spelled(it.child), parent=spelled(it.parent)) for it in graph.edges)
    graph, folder = graph._replace(edges=tuple(frames)), tmp_path / "first"
    given = ["check", "--from", saved(tmp_path, graph), "--suggest", str(folder)]
    assert multibot.main(given) == 0
    (made,) = {it.read_text().partition("\n")[0] for it in folder.rglob("*.urdf")}
    assert made == '<?xml version="1.0"?>'
    planned = str(tmp_path / "plan.yaml")
    assert multibot.main(["plan", str(folder / "fleet.yaml"), "-o", planned]) == 0
    robot, _ = from_yaml(Path(planned).read_bytes(), planned).robots
    assert "robot1_base_link" in robot.frames


@pytest.mark.more
def test_a_plan_of_the_same_fleet_is_not_needed() -> None:
    """What the doctor calls healthy is so by its plan, too: only tools are not planned."""
    found = check(plan(("nav2",), "L1"), nav())
    assert {it.code for it in found} <= {"MG108"}


# ---------------------------------------------------------------- states


def test_a_healthy_robot_by_its_states() -> None:
    """Inactive controllers beside an active one, the same ones in another robot, tools."""
    own = (("arm", "active", ("j1/position",)), ("spare", "inactive", ()))
    states = (
        told("/robot1/amcl", "active", True),
        told("/robot1/controller_manager", "", True, own),
        told("/robot2/controller_manager", "", True, own),
        told("/robot1/rviz2", "", False),
    )
    graph = nav()
    for state in states:
        graph = with_node(graph, state.node)
    assert diagnose(with_answers(graph, states)).findings == ()


def test_nobody_manages_it_so_it_may_be_meant() -> None:
    camera, amcl = (
        told("/robot1/camera", "unconfigured"),
        told("/robot1/amcl", "inactive"),
    )
    (found,) = diagnose(with_answers(with_node(nav(), camera.node), [camera])).findings
    assert (found.code, found.level) == ("MG511", "warning")
    (found,) = diagnose(with_answers(nav(), [amcl])).findings
    assert (found.code, found.level) == ("MG511", "error")
    assert "/robot1/lifecycle_manager_localization" in found.hint


@pytest.mark.parametrize("more", [["--from", "tcp/localhost:7447"], ["--from", "g"]])
def test_states_are_of_the_live_graph(more: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert multibot.main(["check", "--state", *more]) == 2
    assert "--state asks nodes of the live graph" in capsys.readouterr().err


# ---------------------------------------------------------------- several senders


@pytest.mark.parametrize(
    ("marks", "latched", "several"),
    [
        ([1, 2, 3, 7, 8], False, False),
        ([1500, 30, 1501, 31, 1502], False, True),
        ([5, 5, 6, 6], False, True),
        # Started anew, once.
        ([90, 91, 1, 2, 3], False, False),
        ([1, 1], True, True),
        ([1, 2], True, False),
        ([b"a", b"a", b"a"], False, False),
        ([b"a", b"b", b"a", b"b"], False, True),
        ([None, None, None], False, False),
    ],
)
def test_the_numbers_of_messages_tell_several_senders(
    marks: list[int | bytes | None], latched: bool, several: bool
) -> None:
    heard = Voices()
    for mark in marks:
        heard = heard.after(mark)
    assert heard.several(latched) is several
