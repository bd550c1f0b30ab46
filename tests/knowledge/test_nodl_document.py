# SPDX-License-Identifier: Apache-2.0
"""A NoDL document: what is read of it, and the one line that a wrong one gets."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from typing import Any

import pytest
import yaml
from nodl_schema_file import nodl_validator
from paths import fixture_text

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.knowledge.nodl.document import parse
from multibot_rewrite.system.records import ACTION, SERVES, SERVICE, SUBSCRIBES, TOPIC

# Written by hand after the schema of ros-tooling/nodl: each key of it once.
WHOLE = fixture_text("nodl_document_whole.yaml")
ENDPOINT = "nodl_version: 2\npublishers:\n  - "
QOS = "qos: {history: KEEP_ALL, reliability: RELIABLE}"
LAST = "qos: {history: KEEP_LAST, reliability: RELIABLE"
# Text -> line of the error and a word of it.
WRONG = {
    "": (1, "nodl_version: 2"),
    "<interface version='1'/>": (1, "NoDL 1"),
    "- a\n": (1, "not a NoDL document"),
    "name: [\n": (2, "not valid YAML"),
    "description: no version\n": (1, "nodl_version is missing"),
    "nodl_version: 3\n": (1, "'3' is not read"),
    "nodl_version: true\n": (1, "True is not read"),
    "nodl_version: 2\npublisher: []\n": (2, "did you mean 'publishers'"),
    "nodl_version: 2\nnodl_version: 2\n": (2, "repeated"),
    "nodl_version: 2\npublishers: chatter\n": (2, "write a list"),
    "nodl_version: 2\npublishers: {a: b}\n": (2, "write a list"),
    f"{ENDPOINT}chatter\n": (3, "write keys and values"),
    f"{ENDPOINT}\n": (3, "is empty"),
    f"{ENDPOINT}{{name: x, type: std_msgs/msg/String}}\n": (3, "has no qos"),
    f"{ENDPOINT}{{type: std_msgs/msg/String, {QOS}}}\n": (3, "has no name"),
    f"{ENDPOINT}{{name: x, {QOS}}}\n": (3, "has no type"),
    f"{ENDPOINT}{{name: x/, type: std_msgs/msg/String, {QOS}}}\n": (3, "'x/' is not a name"),
    f"{ENDPOINT}{{name: a//b, type: std_msgs/msg/String, {QOS}}}\n": (3, "'a//b'"),
    f"{ENDPOINT}{{name: 'a b', type: std_msgs/msg/String, {QOS}}}\n": (3, "'a b' is not a name"),
    f"{ENDPOINT}{{name: x, type: String, {QOS}}}\n": (3, "'String' is not a ROS type"),
    f"{ENDPOINT}{{name: x, type: std_srvs/srv/Trigger, {QOS}}}\n": (3, "not the type of topic"),
    f"{ENDPOINT}{{name: x, type: std_msgs/msg/String, {QOS}, hz: 5}}\n": (3, "'hz' is not known"),
    f"{ENDPOINT}{{name: x, type: std_msgs/msg/String, qos: 10}}\n": (3, "qos is the text '10'"),
    f"{ENDPOINT}{{name: x, type: std_msgs/msg/String, qos: {{history: KEEP_ALL}}}}\n": (
        3,
        "no reliability",
    ),
    f"{ENDPOINT}{{name: x, type: a/B, qos: {{history: KEEP_LAST, reliability: RELIABLE}}}}\n": (
        3,
        "no depth",
    ),
    f"{ENDPOINT}{{name: x, type: a/B, {LAST}, depth: 0}}}}\n": (3, "depth is 0"),
    f"{ENDPOINT}{{name: x, type: a/B, qos: {{history: KEEP_ALL, reliability: reliable}}}}\n": (
        3,
        "'reliable' is not one of",
    ),
    f"{ENDPOINT}{{name: x, type: a/B, {QOS[:-1]}, deadline_ns: -1}}}}\n": (
        3,
        "'-1' is not a whole number",
    ),
    "nodl_version: 2\naction_servers:\n  - {name: go, type: a/action/B, qos: {}}\n": (3, "'qos'"),
    "nodl_version: 2\nparameters:\n  a: {default_value: 1}\n": (3, "has no type"),
    "nodl_version: 2\nparameters:\n  a: {type: float}\n": (
        3,
        "'float' is no type; write one like string",
    ),
    "nodl_version: 2\nparameters:\n  a: {type: int, default: 1}\n": (3, "'default' is not known"),
    "nodl_version: 2\ninclude: [{ref: /etc/passwd}]\n": (2, "'/etc/passwd'"),
    "nodl_version: 2\ninclude: [{ref: 'local:///etc/passwd'}]\n": (2, "local:///etc/passwd"),
    "nodl_version: 2\ncodegen: {cpp: x}\n": (2, "codegen cpp is the text 'x'"),
    "nodl_version: 2\ndescription: [a]\n": (2, "description is a list"),
    "a: &a [b]\nb: " + "[" * 200: (2, "not valid YAML"),
    "nodl_version: 2\n---\nnodl_version: 2\n": (2, "not valid YAML"),
    "nodl_version: 2\n? [a]\n: b\n": (2, "use a name as key"),
}


def test_the_endpoints_are_those_of_the_document() -> None:
    document = parse(WHOLE, "gripper.nodl.yaml")
    found = {(end.kind, end.role, end.name): end.type for end in document.endpoints}
    assert found == {
        (TOPIC, "publishes", "joint_states"): "sensor_msgs/msg/JointState",
        (TOPIC, "publishes", "/diagnostics"): "diagnostic_msgs/msg/DiagnosticArray",
        (TOPIC, SUBSCRIBES, "~/target"): "std_msgs/msg/Float64",
        (SERVICE, SERVES, "~/close"): "std_srvs/srv/Trigger",
        (SERVICE, "calls", "lamp/set"): "std_srvs/srv/SetBool",
        (ACTION, SERVES, "grip"): "control_msgs/action/GripperCommand",
        (ACTION, "calls", "/arm/move"): "control_msgs/action/FollowJointTrajectory",
    }
    assert document.endpoints[0].source == ("gripper.nodl.yaml:10",)
    assert [(it.name, it.type, it.default) for it in document.parameters] == [
        ("tool_frame", "string", "tool0"),
        ("force", "double", "2.5"),
        ("fingers", "string_array_fixed_3", ""),
    ]


def test_two_publishers_of_a_name_are_one_endpoint_with_both_types() -> None:
    text = f"{ENDPOINT}{{name: x, type: a/B, {QOS}}}\n  - {{name: x, type: a/C, {QOS}}}\n"
    (end,) = parse(text, "f").endpoints
    assert (end.type, end.also) == ("a/msg/B", ("a/msg/C",))


@pytest.mark.parametrize("text", WRONG)
def test_what_is_wrong_is_one_line_with_file_and_line(text: str) -> None:
    line, word = WRONG[text]
    with pytest.raises(UsageError) as caught:
        parse(text, "my.nodl.yaml")
    message = str(caught.value)
    assert message.startswith(f"my.nodl.yaml:{line}:")
    assert word in message
    assert "\n" not in message


# ---------------------------------------------------------------- the schema of ros-tooling/nodl


def damaged(value: Any) -> Iterator[Any]:
    """Yield the document with one value after the other replaced, or left out."""
    for path in list(_paths(value)):
        for new in (None, 7, "x", [], {}, "2", "a b", ...):
            result = copy.deepcopy(value)
            place = result
            for key in path[:-1]:
                place = place[key]
            if new is ...:
                del place[path[-1]]
            else:
                place[path[-1]] = new
            yield path, result


def _paths(value: Any, above: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    inside = value.items() if isinstance(value, dict) else enumerate(value)
    for key, item in inside:
        yield (*above, key)
        if isinstance(item, dict | list):
            yield from _paths(item, (*above, key))


def reads(value: Any) -> bool:
    try:
        parse(yaml.safe_dump(value, sort_keys=False), "f")
    except UsageError:
        return False
    return True


def test_what_the_schema_allows_is_read_and_what_it_forbids_is_refused() -> None:
    validator = nodl_validator()
    whole = yaml.safe_load(WHOLE)
    assert validator.is_valid(whole)
    wrong = [
        (path, item)
        for path, item in damaged(whole)
        if validator.is_valid(item) != reads(item) and not _is_laxer(path)
    ]
    assert wrong == []


def _is_laxer(path: tuple[Any, ...]) -> bool:
    """Return whether we accept more there: texts as numbers, and values that are not used."""
    free = ("description", "depth", "deadline_ns", "lifespan_ns", "liveliness_lease_duration_ns")
    return path[0] in ("parameters", "codegen", "nodl_version") or path[-1] in free
