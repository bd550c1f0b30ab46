# SPDX-License-Identifier: Apache-2.0
"""Learned nodes as NoDL: what is written, and that a plan made of it fits the graph it came from."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
import yaml
from nav2_graphs import ROVER, environment, healthy, moved, nav2
from nodl_schema_file import nodl_validator
from paths import FIXTURES

from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.knowledge.nodl.writing import NodlFile
from multibot_rewrite.live.learning.learn import learn
from multibot_rewrite.live.learning.nodes_file import to_nodl
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.records import End, Node, Qos, System

HEALTHY = str(FIXTURES / "graphs" / "healthy.json")
INF = math.inf
TF, CLOCK = "tf2_msgs/msg/TFMessage", "rosgraph_msgs/msg/Clock"
# Seen by rclpy under Fast DDS: history and depth of other processes are not announced.
FAST_DDS = Qos("UNKNOWN", 0, "RELIABLE", "TRANSIENT_LOCAL", INF, INF, "AUTOMATIC", INF)
WHOLE = Qos("KEEP_LAST", 5, "BEST_EFFORT", "UNKNOWN", 0.1, INF, "MANUAL_BY_TOPIC", 2.5)


def end(kind: str, role: str, name: str, type_: str, qos: Qos | None = None) -> End:
    return End(kind, role, name, type_, "", "/robot1/arm", qos, "1")


def document(*ends: End) -> NodlFile:
    graph = System((Node("/robot1/arm", "1"),), ends, (), environment())
    (node,) = learn(graph, ["/robot1/arm"], "/robot1", built_in(NEWEST_LTS))
    return to_nodl(node, graph, "/robot1", built_in(NEWEST_LTS))


def section(name: str, *ends: End) -> list[dict[str, object]]:
    found: list[dict[str, object]] = yaml.safe_load(document(*ends).text).get(name, [])
    return found


def test_names_are_those_of_the_code_and_qos_is_as_seen() -> None:
    found = section(
        "publishers",
        end("topic", "publishes", "/robot1/state", "a/msg/B", WHOLE),
        end("topic", "publishes", "/robot1/arm/own", "a/msg/B", FAST_DDS),
        end("topic", "publishes", "/robot1/tf", TF),
        end("topic", "publishes", "/rosout", "rcl_interfaces/msg/Log"),
    )
    assert sorted(found, key=lambda it: str(it["name"])) == [
        {
            "name": "/tf",
            "type": TF,
            "qos": {"history": "SYSTEM_DEFAULT", "reliability": "SYSTEM_DEFAULT"},
        },
        {
            "name": "state",
            "type": "a/msg/B",
            "qos": {
                "history": "KEEP_LAST",
                "depth": 5,
                "reliability": "BEST_EFFORT",
                "liveliness": "MANUAL_BY_TOPIC",
                "deadline_ns": 100_000_000,
                "liveliness_lease_duration_ns": 2_500_000_000,
            },
        },
        {
            "name": "~/own",
            "type": "a/msg/B",
            "qos": {
                "history": "SYSTEM_DEFAULT",
                "reliability": "RELIABLE",
                "durability": "TRANSIENT_LOCAL",
                "liveliness": "AUTOMATIC",
            },
        },
    ]


def test_an_action_is_one_entry_and_an_image_has_its_transports() -> None:
    action = "/robot1/go/_action"
    ends = (
        end("action", "serves", "/robot1/go", "a/action/Go"),
        end("service", "serves", f"{action}/send_goal", "a/action/Go_SendGoal"),
        end("service", "serves", f"{action}/get_result", "a/action/Go_GetResult"),
        end("service", "serves", f"{action}/cancel_goal", "action_msgs/srv/CancelGoal"),
        end("topic", "publishes", f"{action}/feedback", "a/action/Go_FeedbackMessage"),
        end("topic", "publishes", f"{action}/status", "action_msgs/msg/GoalStatusArray"),
        end("topic", "publishes", "/robot1/image", "sensor_msgs/msg/Image"),
        end("topic", "publishes", "/robot1/image/compressed", "sensor_msgs/msg/CompressedImage"),
    )
    assert section("action_servers", *ends) == [{"name": "go", "type": "a/action/Go"}]
    assert section("service_servers", *ends) == []
    images = {it["name"]: it["type"] for it in section("publishers", *ends)}
    assert images == {
        "image": "sensor_msgs/msg/Image",
        "image/compressed": "sensor_msgs/msg/CompressedImage",
    }


def test_what_nodl_has_no_form_for_is_named() -> None:
    feedback = "/robot1/go/_action/feedback"
    found = document(
        end("topic", "subscribes", feedback, "a/action/Go_FeedbackMessage"),
        end("service", "calls", "/robot1/odd", ""),
        end("topic", "subscribes", "/robot1/x", "a/msg/B"),
    )
    assert found.left_out == ("subscribes go/_action/feedback", "calls odd")
    assert "feedback" not in found.text


# ---------------------------------------------------------------- the command


@pytest.mark.more
def test_a_folder_has_a_file_for_each_node_and_a_plan_of_them_fits_the_graph(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, plan = str(tmp_path / "nodl"), str(tmp_path / "plan.yaml")
    learned = ("--from", HEALTHY, "--namespace", "/robot1", "--output-kind", "nodl")
    assert main(["snapshot", *learned, "-o", folder]) == 0
    assert (tmp_path / "nodl/local_costmap/local_costmap.nodl.yaml").is_file()
    node_sets = "pilot,local_costmap/local_costmap"
    made = ("--layout", "frames-per-robot", "--nodes", folder, "--node-set", node_sets, "-o", plan)
    rover = str(FIXTURES / "robots" / "rover.urdf")
    assert main(["plan", rover, "robot1", "robot2", *made]) == 0
    assert f"pilot as in {folder}/pilot.nodl.yaml (NoDL)" in capsys.readouterr().err
    assert main(["check", plan, "--from", HEALTHY]) == 0
    assert "0 findings" in capsys.readouterr().err


@pytest.mark.slow
def test_nav2_from_its_own_graph_is_as_planned_and_a_leak_is_found(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    graph = healthy(nav2("L1"))
    seen, folder, plan = (str(tmp_path / it) for it in ("graph.json", "nodl", "plan.yaml"))
    Path(seen).write_bytes(to_json(graph))
    given = ("--from", seen, "--namespace", "/robot1", "--output-kind", "nodl", "-o", folder)
    assert main(["snapshot", *given]) == 0
    robots = ("robot1", "robot2", "--layout", "L1", "--node-set", "nav2", "--distro", NEWEST_LTS)
    assert main(["plan", str(ROVER), *robots, "--nodes", folder, "-o", plan]) == 0
    capsys.readouterr()
    assert main(["check", plan, "--from", seen]) == 0, capsys.readouterr().out
    leak = moved(graph, "/robot1/cmd_vel", "/cmd_vel", "collision_monitor")
    Path(seen).write_bytes(to_json(leak))
    assert main(["check", plan, "--from", seen]) == 1
    assert "/cmd_vel" in capsys.readouterr().out


def test_what_is_learned_of_nav2_is_valid_by_the_published_schema() -> None:
    validator = nodl_validator()
    graph = healthy(nav2("L1"))
    names = [it.name for it in graph.nodes if it.name.startswith("/robot1/")]
    for node in learn(graph, names, "/robot1", built_in(NEWEST_LTS)):
        text = to_nodl(node, graph, "/robot1", built_in(NEWEST_LTS)).text
        assert [it.message for it in validator.iter_errors(yaml.safe_load(text))] == []


PILOT = ("snapshot", "--from", HEALTHY, "--namespace", "/robot1", "--node", "/robot1/pilot")


def test_the_ending_of_the_file_tells_the_form(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    in_yaml, in_json = tmp_path / "pilot.nodl.yaml", tmp_path / "pilot.nodl.json"
    assert main([*PILOT, "-o", str(in_yaml)]) == main([*PILOT, "-o", str(in_json)]) == 0
    assert yaml.safe_load(in_yaml.read_text()) == json.loads(in_json.read_text())
    capsys.readouterr()
    assert main([*PILOT, "--output-kind", "nodl"]) == 0
    assert capsys.readouterr().out == in_yaml.read_text()


def test_a_file_is_for_one_node(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    many = ("snapshot", "--from", HEALTHY, "--namespace", "/robot1")
    assert main([*many, "-o", str(tmp_path / "all.nodl.yaml")]) == 2
    assert "a NoDL file is for one node, here are 8" in capsys.readouterr().err
    assert main([*PILOT, "--output-kind", "nodes", "-o", str(tmp_path / "a.nodl.yaml")]) == 2
    assert "leave out --output-kind nodes" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
