# SPDX-License-Identifier: Apache-2.0
"""rosgraph_msgs/Graph as a snapshot: as ``ros2 topic echo`` prints it, and back."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import pytest
import yaml
from nav2_graphs import environment, healthy, nav2
from paths import FIXTURES

from multibot_rewrite.base.model import InputError
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.producers.rosgraph.reading import NO_FRAMES, from_yaml
from multibot_rewrite.producers.rosgraph.writing import to_yaml
from multibot_rewrite.producers.snapshot_file import read_snapshot
from multibot_rewrite.system.records import End, Node, Qos, System

HEALTHY = str(FIXTURES / "graphs" / "healthy.json")
INF = math.inf
HASH = "RIHS01_" + "0a" * 32
# By hand after the .msg files: what a monitor says of one node with a topic, a service and an action.
QOS = """{depth: 7, deadline: {sec: 1, nanosec: 500000000}, lifespan: {sec: 0, nanosec: 0}, history: 1,
      reliability: 2, durability: 1, liveliness: 3,
      liveliness_lease_duration: {sec: 2147483647, nanosec: 0}}"""
UNSEEN = """{depth: 0, deadline: {sec: 0, nanosec: 0}, lifespan: {sec: 0, nanosec: 0}, history: 3,
      reliability: 3, durability: 3, liveliness: 4, liveliness_lease_duration: {sec: 0, nanosec: 0}}"""


def of_type(name: str, byte: int = 0) -> str:
    return f"{{name: {name}, hash: {{version: 1, value: {[byte] * 32}}}}}"


def topic(name: str, type_: str, qos: str = UNSEEN, byte: int = 0) -> str:
    return f"{{name: {name}, type: {of_type(type_, byte)}, qos: {qos}}}"


def service(name: str, type_: str) -> str:
    types = f"request_type: {of_type(type_)}, response_type: {of_type(type_)}"
    return f"{{name: {name}, {types}, request_qos: {UNSEEN}, response_qos: {UNSEEN}}}"


MESSAGE = f"""\
nodes:
- name: /robot1/arm
  parameters:
  - name: rate
    type: 2
  parameter_values: []
  publishers:
  - {topic("/robot1/state", "a/msg/B", QOS, 10)}
  subscriptions: []
  service_clients: []
  service_servers:
  - {service("/robot1/arm/stop", "std_srvs/srv/Trigger")}
  action_clients:
  - name: /robot1/go
    send_goal: {service("/robot1/go/_action/send_goal", "a/action/Go_SendGoal")}
    get_result: {service("/robot1/go/_action/get_result", "a/action/Go_GetResult")}
    cancel_goal: {service("/robot1/go/_action/cancel_goal", "action_msgs/srv/CancelGoal")}
    feedback: {topic("/robot1/go/_action/feedback", "a/action/Go_FeedbackMessage")}
    status: {topic("/robot1/go/_action/status", "action_msgs/msg/GoalStatusArray")}
  action_servers: []
---
"""


def test_a_message_is_read_as_its_fields_say() -> None:
    found = from_yaml(MESSAGE, "graph.yaml")
    node = "/robot1/arm"
    qos = Qos("KEEP_LAST", 7, "BEST_EFFORT", "TRANSIENT_LOCAL", 1.5, INF, "MANUAL_BY_TOPIC", INF)
    hidden = "/robot1/go/_action"

    def end(kind: str, role: str, name: str, type_: str) -> End:
        return End(kind, role, name, type_, "", node, None, "")

    assert found.nodes == (Node(node, ""),)
    assert found.ends == (
        End("topic", "publishes", "/robot1/state", "a/msg/B", HASH, node, qos, ""),
        end("service", "serves", "/robot1/arm/stop", "std_srvs/srv/Trigger"),
        end("action", "calls", "/robot1/go", "a/action/Go"),
        end("service", "calls", f"{hidden}/send_goal", "a/action/Go_SendGoal"),
        end("service", "calls", f"{hidden}/get_result", "a/action/Go_GetResult"),
        end("service", "calls", f"{hidden}/cancel_goal", "action_msgs/srv/CancelGoal"),
        end("topic", "subscribes", f"{hidden}/feedback", "a/action/Go_FeedbackMessage"),
        end("topic", "subscribes", f"{hidden}/status", "action_msgs/msg/GoalStatusArray"),
    )
    assert found.environment.caveats == (NO_FRAMES,)


# rmw types.h; the numbers of QoSProfile.msg.
WORDS = {
    "history": ("SYSTEM_DEFAULT", "KEEP_LAST", "KEEP_ALL", "UNKNOWN"),
    "reliability": ("SYSTEM_DEFAULT", "RELIABLE", "BEST_EFFORT", "UNKNOWN", "BEST_AVAILABLE"),
    "durability": ("SYSTEM_DEFAULT", "TRANSIENT_LOCAL", "VOLATILE", "UNKNOWN", "BEST_AVAILABLE"),
    "liveliness": (
        *("SYSTEM_DEFAULT", "AUTOMATIC", "MANUAL_BY_NODE", "MANUAL_BY_TOPIC", "UNKNOWN"),
        "BEST_AVAILABLE",
    ),
}


@pytest.mark.parametrize("field", WORDS)
def test_the_policies_of_a_profile_are_those_of_rmw_by_number(field: str) -> None:
    for number, word in enumerate(WORDS[field]):
        message = re.sub(rf"({field}): \d", rf"\1: {number}", MESSAGE)
        seen = next(it.qos for it in from_yaml(message, "g").ends if it.name == "/robot1/state")
        assert seen is not None and getattr(seen, field) == word
        graph = from_yaml(MESSAGE, "g")
        ends = [
            it._replace(qos=it.qos._replace(**{field: word})) if it.qos else it for it in graph.ends
        ]
        written = next(yaml.safe_load_all(to_yaml(graph._replace(ends=tuple(ends)))))
        (own,) = written["nodes"][0]["publishers"]
        assert own["qos"][field] == number
    beyond = re.sub(rf"({field}): \d", rf"\1: {len(WORDS[field])}", MESSAGE)
    with pytest.raises(InputError, match=f"no policy {len(WORDS[field])}"):
        from_yaml(beyond, "g")


@pytest.mark.sample(2)
@pytest.mark.slow
@pytest.mark.parametrize("layout", ["L1", "L4"])
def test_the_graph_of_nav2_keeps_its_endpoints(layout: str) -> None:
    graph = healthy(nav2(layout))
    again = from_yaml(to_yaml(graph).decode(), "graph.yaml")
    plain = {it._replace(process="") for it in graph.ends}
    assert plain <= set(again.ends)
    # The parts of an action are told even where the snapshot has the action alone.
    assert all("/_action/" in it.name for it in set(again.ends) - plain)
    assert [it.name for it in again.nodes] == [it.name for it in graph.nodes]


def test_topics_of_an_action_without_the_action_stay_topics() -> None:
    name = "/go/_action/feedback"
    end = End("topic", "subscribes", name, "a/action/Go_FeedbackMessage", "", "/a", None, "")
    graph = System((Node("/a", ""),), (end,), (), environment())
    assert from_yaml(to_yaml(graph).decode(), "f").ends == (end,)


# ---------------------------------------------------------------- the commands


@pytest.mark.slow
def test_check_and_learn_take_a_message_in_yaml_and_in_json(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    message = to_yaml(read_snapshot(HEALTHY))
    in_yaml, in_json = tmp_path / "graph.yaml", tmp_path / "graph.json"
    in_yaml.write_bytes(b"# of a robot\n---\n" + message)
    in_json.write_text(json.dumps(yaml.safe_load(message.removesuffix(b"---\n"))))
    assert read_snapshot(str(in_yaml)) == read_snapshot(str(in_json))
    words = ("--namespace", "/robot1", "--node", "/robot1/pilot")
    texts = []
    for path in (HEALTHY, str(in_yaml), str(in_json)):
        assert main(["snapshot", "--output-kind", "nodes", "--from", path, *words]) == 0
        texts.append(capsys.readouterr().out)
    assert texts[0] == texts[1] == texts[2] != ""
    plan = tmp_path / "plan.yaml"
    rover = str(FIXTURES / "robots" / "rover.urdf")
    made = ("robot1", "--layout", "frames-per-robot", "-o", str(plan))
    assert main(["plan", rover, *made]) == 0
    assert main(["check", str(plan), "--from", str(in_yaml)]) in (0, 1)
    assert "MG2" not in capsys.readouterr().out, "frames are not part of a message"


# JSON is YAML too, and read in no time.
WHOLE = json.dumps(yaml.load(MESSAGE.removesuffix("---\n"), yaml.CSafeLoader))


def changed(key: str, new: object) -> str:
    """Return the message with one field of its first topic set."""
    value: Any = json.loads(WHOLE)
    place = value["nodes"][0]["publishers"][0]
    *above, last = key.split(".")
    for name in above:
        place = place[name]
    place[last] = new
    return json.dumps(value)


@pytest.mark.parametrize(
    ("text", "word"),
    [
        (changed("name", "state"), "'state' is not a full name"),
        (changed("name", 7), "nodes[0].publishers[0].name: expected text, not 7"),
        (changed("qos.reliability", 9), "no policy 9"),
        (changed("qos.history", -1), "there is no policy -1"),
        (changed("qos.deadline.sec", "soon"), "qos.deadline.sec: expected a whole number"),
        (changed("type.hash.value", [300]), "not 0 to 255; record the graph again"),
        (changed("type", "a/msg/B"), "type: expected an object"),
        (changed("colour", 1), "unknown key"),
        (MESSAGE + "- '...'\n", "--full-length"),
        ("nodes: 7\n", "nodes: expected a list"),
        ("nodes:\n- 7\n", "nodes[0]: expected an object"),
        ("nodes:\n- name: /a\n", "missing"),
        ("nodes: [\n", "not valid YAML"),
        ("nodes: " + "[" * 200, "not valid YAML"),
        ("nodes: []\nedges: []\n", "unknown key"),
        ("nodes: []\nendpoints: []\n", "not a rosgraph_msgs/Graph"),
    ],
)
def test_a_wrong_message_is_one_line(text: str, word: str, tmp_path: Path) -> None:
    path = tmp_path / "graph.yaml"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        read_snapshot(str(path))
    message = str(caught.value)
    assert message.startswith(f"{path}:")
    assert word in message
    assert "\n" not in message
