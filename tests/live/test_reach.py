# SPDX-License-Identifier: Apache-2.0
"""A robot that is not seen: missing, or hidden by the network; and what is said of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from graph_cases import environment
from live_commands import write_plan
from looks import ONE, TWO, end, look, node

from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, Finding
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.live.watching import Verdict, judge
from multibot_rewrite.rules.check import check
from multibot_rewrite.spelling.plan_file import read_plan
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.reach import machines
from multibot_rewrite.system.records import Caveat, End, System

# A second process of the machine of robot1.
BESIDE = ONE[:8] + "cccccccccccccccc"


def seen(*robots: tuple[str, str], **around: Any) -> System:
    """These robots as planned, each in its process."""
    ends = tuple(
        End(it.kind, it.role, it.name, it.type, "", f"/{robot}/drive", None, process)
        for robot, process in robots
        for it in (
            end(robot, f"/{robot}/odom"),
            end(robot, f"/{robot}/cmd_vel", role="subscribes"),
            end(
                robot, f"/{robot}/reset", kind="service", role="serves", type="std_srvs/srv/Trigger"
            ),
        )
    )
    return look(*(node(robot, process) for robot, process in robots), ends=ends, **around)


def absent(tmp_path: Path, graph: System) -> Finding:
    """The one finding about robot2."""
    path = write_plan(tmp_path / "plan.yaml", ("robot1", "robot2"))
    (found,) = check(read_plan(path.read_bytes(), str(path)), graph)
    assert (found.code, found.robot) == ("MG109", "robot2")
    return found


def test_all_that_is_seen_runs_on_one_machine(tmp_path: Path) -> None:
    """Under SUBNET robot2 may be behind a network that drops multicast, or on LOCALHOST there."""
    graph = seen(("robot1", ONE), range="SUBNET")
    found = absent(tmp_path, graph)
    assert found.level == INCONCLUSIVE
    assert "all that is seen runs on one machine (/robot1/drive)" in found.hint
    assert "ROS_STATIC_PEERS" in found.hint and "--from" in found.hint
    assert judge([found], graph) == Verdict.INCONCLUSIVE


def test_peers_were_asked_for(tmp_path: Path) -> None:
    graph = seen(("robot1", ONE), static_peers=("10.0.0.2",))
    assert absent(tmp_path, graph).level == INCONCLUSIVE


def test_only_this_machine_was_asked_for(tmp_path: Path) -> None:
    found = absent(tmp_path, seen(("robot1", ONE), range="LOCALHOST"))
    assert found.level == ERROR
    assert "Only this machine is looked at: range LOCALHOST" in found.hint


def test_other_machines_are_seen(tmp_path: Path) -> None:
    """A third robot's machine is seen, so discovery works; this one is missing."""
    graph = seen(("robot1", ONE), range="SUBNET")
    rviz = end("x", "/rviz", TWO)._replace(node="/rviz2")
    graph = graph._replace(
        nodes=(*graph.nodes, node("robot1")._replace(name="/rviz2", process=TWO)),
        ends=(*graph.ends, rviz),
    )
    found = absent(tmp_path, graph)
    assert found.level == ERROR
    assert "2 machines are seen" in found.hint


def test_several_looks_have_missed_it(tmp_path: Path) -> None:
    joined = Caveat("looks-merged", False, "made of 2 looks: a.json, b.json")
    graph = seen(("robot1", ONE), range="SUBNET", caveats=(joined,))
    assert absent(tmp_path, graph).level == ERROR


@pytest.mark.parametrize(
    ("around", "said"),
    [
        ({"discovery_server": "10.0.0.9:11811"}, "use the discovery server 10.0.0.9:11811"),
        (
            {"rmw": "rmw_zenoh_cpp", "discovery_server": "tcp/10.0.0.9:7447", "range": ""},
            "connected to the router at tcp/10.0.0.9:7447",
        ),
    ],
)
def test_who_knows_all_robots_does_not_know_it(
    tmp_path: Path, around: dict[str, Any], said: str
) -> None:
    found = absent(tmp_path, seen(("robot1", ONE), **{"range": "SUBNET", **around}))
    assert found.level == ERROR
    assert said in found.hint


def test_a_node_under_another_name_is_no_robot_elsewhere(tmp_path: Path) -> None:
    """robot2's node runs without its namespace on this machine: an error, and that is the cause."""
    graph = seen(("robot1", ONE), range="SUBNET")
    wrong = node("robot2")._replace(name="/drive", process=BESIDE)
    ends = tuple(
        it._replace(node="/drive", process=BESIDE, name=it.name.replace("/robot2", ""))
        for it in seen(("robot2", BESIDE)).ends
    )
    graph = graph._replace(nodes=(*graph.nodes, wrong), ends=(*graph.ends, *ends))
    path = write_plan(tmp_path / "plan.yaml", ("robot1", "robot2"))
    found = check(read_plan(path.read_bytes(), str(path)), graph)
    assert [it.level for it in found if it.code == "MG109"] == [ERROR]


def test_machines_are_told_apart_where_they_are_known() -> None:
    graph = seen(("robot1", ONE), ("robot2", BESIDE), ("robot3", TWO))
    assert sorted(map(sorted, machines(graph).values())) == [
        ["/robot1/drive", "/robot2/drive"],
        ["/robot3/drive"],
    ]
    assert machines(graph._replace(environment=environment()._replace(rmw="rmw_zenoh_cpp"))) == {}


def test_the_command_ends_inconclusive(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plan = write_plan(tmp_path / "plan.yaml", ("robot1", "robot2"))
    graph = tmp_path / "graph.json"
    graph.write_bytes(to_json(seen(("robot1", ONE), range="SUBNET")))
    assert main(["check", str(plan), "--from", str(graph)]) == 3
    shown = capsys.readouterr()
    assert "robot2: inconclusive: MG109" in shown.out
    assert "inconclusive, the view may be incomplete" in shown.err
    assert main(["check", str(plan), "--from", str(graph), "--ignore", "MG109"]) == 0
