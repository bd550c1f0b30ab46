# SPDX-License-Identifier: Apache-2.0
"""Policies of SROS2: what a robot needs is allowed, what crosses robots is not."""

from __future__ import annotations

import os
from fnmatch import fnmatchcase
from functools import cache
from pathlib import Path

import pytest
from graph_calls import read_plan
from lxml import etree
from paths import FIXTURES

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.system.records import System, surely

ROVER = str(FIXTURES / "robots" / "rover.urdf")
# Role -> beginning and end of the DDS topics, by sros2's permissions.xsl: written, read.
TOPICS = {"publish": (["rt{}"], []), "subscribe": ([], ["rt{}"])}
REQUEST, REPLY = "rq{}Request", "rr{}Reply"
SERVICES = {"reply": ([REPLY], [REQUEST]), "request": ([REQUEST], [REPLY])}
_GOALS = ("cancel_goal", "get_result", "send_goal")
ASKED = [f"rq{{}}/_action/{it}Request" for it in _GOALS]
ANSWERED = [
    *(f"rr{{}}/_action/{it}Reply" for it in _GOALS),
    *(f"rt{{}}/_action/{it}" for it in ("feedback", "status")),
]
ACTIONS = {"execute": (ANSWERED, ASKED), "call": (ASKED, ANSWERED)}
MEANING = {**TOPICS, **SERVICES, **ACTIONS}
OF_ROLE = {
    ("topic", "publishes"): "publish",
    ("topic", "subscribes"): "subscribe",
    ("service", "serves"): "reply",
    ("service", "calls"): "request",
    ("action", "serves"): "execute",
    ("action", "calls"): "call",
}
Patterns = tuple[frozenset[str], frozenset[str]]


def dds_topics(policy: str) -> dict[str, Patterns]:
    """By enclave: patterns of the DDS topics that it may write and read."""
    result = {}
    for enclave in etree.fromstring(policy.encode()).iter("enclave"):
        sides: tuple[set[str], set[str]] = (set(), set())
        for profile in enclave.iter("profile"):
            space = profile.get("ns", "").rstrip("/")
            for group in profile:
                (attribute,) = group.keys()
                for name in group:
                    own = f"{space}/{profile.get('node')}"
                    full = (name.text or "").replace("~", own, 1)
                    assert full.startswith("/"), full
                    for side, forms in zip(sides, MEANING[attribute], strict=True):
                        side.update(form.format(full) for form in forms)
        result[enclave.get("path", "")] = (frozenset(sides[0]), frozenset(sides[1]))
    return result


def allowed(topic: str, patterns: frozenset[str]) -> bool:
    return topic in patterns or any(fnmatchcase(topic, it) for it in patterns if "*" in it)


@cache
def fleet(layout: str) -> tuple[System, dict[str, Patterns], str]:
    folder = Path(os.environ["PYTEST_FOLDER"])
    plan, policy = folder / f"{layout}.yaml", folder / f"{layout}.xml"
    words = [ROVER, "robot1", "robot2", "--node-set", "nav2", "--layout", layout]
    assert main(["plan", *words, "-o", str(plan)]) == 0
    assert main(["plan", *words, "--output-kind", "sros2", "-o", str(policy)]) == 0
    text = policy.read_text()
    return read_plan(plan.read_bytes(), "plan"), dds_topics(text), text


@pytest.fixture(autouse=True)
def folder(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTEST_FOLDER", str(tmp_path_factory.getbasetemp()))


LAYOUTS = ("frames-per-robot", "tf-per-robot", "postfix")


@pytest.mark.slow
@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_robot_may_do_all_that_is_planned(layout: str) -> None:
    plan, topics, _ = fleet(layout)
    assert set(topics) == {"/robot1", "/robot2", "/tools"}
    robot_of = {it.name: it.robot for it in plan.nodes if it.robot}
    assert len(plan.ends) > 300
    for end in plan.ends:
        sides = topics[f"/{robot_of[end.node]}"]
        for side, forms in zip(sides, MEANING[OF_ROLE[end.kind, end.role]], strict=True):
            for form in forms:
                assert allowed(form.format(end.name), side), (end, form)


@pytest.mark.slow
@pytest.mark.parametrize("layout", LAYOUTS)
def test_what_is_one_robots_no_other_may_write_or_read(layout: str) -> None:
    plan, topics, _ = fleet(layout)
    shared = {*plan.shared_topics, "/tf", "/tf_static", "/map"}
    own = {end.name for end in plan.ends if "robot1" in end.name} - shared
    assert len(own) > 100
    written, read = topics["/robot2"]
    for name in own:
        for forms in MEANING.values():
            for form in (*forms[0], *forms[1]):
                assert not allowed(form.format(name), written), name
                assert not allowed(form.format(name), read), name


@pytest.mark.more
def test_the_case_that_hurts() -> None:
    _, topics, _ = fleet("frames-per-robot")
    command = "rt/robot1/cmd_vel"
    assert allowed(command, topics["/robot1"][0])
    assert not allowed(command, topics["/robot2"][0])
    assert not allowed(command, topics["/tools"][0])
    # What RViz sends, and no node of the robot does.
    assert allowed("rt/robot1/initialpose", topics["/tools"][0])
    assert allowed("rq/robot1/navigate_to_pose/_action/send_goalRequest", topics["/tools"][0])
    assert allowed("rt/anything/at/all", topics["/tools"][1])
    assert not allowed("rt/anything/at/all", topics["/robot1"][1])


@pytest.mark.more
def test_what_every_node_needs_is_allowed() -> None:
    _, topics, _ = fleet("frames-per-robot")
    for enclave, node in (("/robot1", "/robot1/amcl"), ("/tools", "/rviz2")):
        written, read = topics[enclave]
        assert {"rt/rosout", "rt/parameter_events"} <= written
        assert allowed("rt/clock", read) and allowed("rt/parameter_events", read)
        assert allowed(f"rr{node}/set_parametersReply", written)
        assert allowed(f"rq{node}/get_type_descriptionRequest", read)


@pytest.mark.more
def test_an_endpoint_by_parameter_is_allowed_although_it_only_may_be_there(tmp_path: Path) -> None:
    nodes, plan, policy = (tmp_path / it for it in ("nodes.yaml", "plan.yaml", "policy.xml"))
    nodes.write_text(
        "nodes:\n  driver:\n    package: own\n    publishes:\n      odom: nav_msgs/msg/Odometry\n"
        "      debug: {type: std_msgs/msg/String, when: debug}\n"
        "node_sets:\n  own: {about: x, nodes: [{node: driver}]}\n"
    )
    words = [ROVER, "robot1", "--nodes", str(nodes), "--node-set", "own", "--layout", "both"]
    assert main(["plan", *words, "-o", str(plan)]) == 0
    assert main(["plan", *words, "--output-kind", "sros2", "-o", str(policy)]) == 0
    planned = {it.name for it in surely(read_plan(plan.read_bytes(), "plan")).ends}
    assert "/robot1/odom" in planned and "/robot1/debug" not in planned
    assert {"rt/robot1/odom", "rt/robot1/debug"} <= dds_topics(policy.read_text())["/robot1"][0]


@pytest.mark.skipif("MULTIBOT_SOURCES" not in os.environ, reason="MULTIBOT_SOURCES is not set")
@pytest.mark.parametrize("layout", LAYOUTS)
def test_sros2_takes_it_and_means_the_same(layout: str) -> None:
    """With a checkout of ros2/sros2 in the folder that MULTIBOT_SOURCES names."""
    (found,) = Path(os.environ["MULTIBOT_SOURCES"]).glob("**/sros2/policy")
    policy = etree.fromstring(fleet(layout)[2].encode())
    text = (found / "schemas/policy.xsd").read_text()
    schema = etree.XMLSchema(etree.fromstring(_without_import(text).encode()))
    schema.assertValid(policy)
    made = etree.XSLT(etree.parse(str(found / "templates/dds/permissions.xsl")))(policy)
    ours = fleet(layout)[1]
    grants = {grant.get("name"): grant for grant in made.getroot().iter("grant")}
    assert grants.keys() == ours.keys()
    for path, grant in grants.items():
        for kind, side in zip(("publish", "subscribe"), ours[path], strict=True):
            assert {it.text for it in grant.iterfind(f"allow_rule/{kind}//topic")} == side


def _without_import(schema: str) -> str:
    """Without xml:base, whose schema would be loaded from the network."""
    before, _, rest = schema.partition("<xs:import")
    kept = before + rest.partition("/>")[2]
    return kept.replace('<xs:attribute ref="xml:base" />', "")
