# SPDX-License-Identifier: Apache-2.0
"""Behavior trees: ports at any depth, through the blackboard, byte for byte."""

from __future__ import annotations

import pytest
from beside import findings_of
from hypothesis import given, strategies as st
from lxml import etree
from paths import fixture_text
from related_file_calls import (
    NEWEST_LTS,
    Context,
    built_in,
    fill_template,
    make_context,
    make_naming,
    nodes_of_set,
)

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError
from multibot_rewrite.related_files.behavior_tree.rewrite import rewrite_behavior_tree

LAYOUTS = ("L1", "L2", "L3", "L4")
DECLARED = {"link": {"base_link": None, "tool": None}, "joint": {"wheel": None}}
FACTS = nodes_of_set(built_in(NEWEST_LTS), "nav2")


def context(layout: str = "L2", distro: str = "jazzy", **more: str) -> Context:
    affix = more.pop("affix", "postfix" if layout == "L4" else "prefix")
    return make_context(DECLARED, make_naming(layout, affix, **more), FACTS, distro)  # type: ignore[arg-type]


def run(text: str | bytes, it: Context) -> tuple[str, tuple[Finding, ...]]:
    made = rewrite_behavior_tree(text if isinstance(text, bytes) else text.encode(), "t.xml", it)
    return fill_template(made.template, "amr", "sp"), findings_of(made)


def tree(body: str, form: str = ' BTCPP_format="4"') -> str:
    return f'<root{form}><BehaviorTree ID="Main">{body}</BehaviorTree></root>'


def one(body: str, layout: str = "L2", form: str = ' BTCPP_format="4"') -> str:
    """Return what a node becomes."""
    before, behind = tree("|", form).split("|")
    new = run(tree(body, form), context(layout))[0]
    assert new.startswith(before) and new.endswith(behind)
    return new[len(before) : -len(behind)]


def codes(text: str, it: Context) -> list[tuple[str, int]]:
    return [(found.code, found.line) for found in run(text, it)[1]]


# A node for one robot, and what it becomes by layout; one that is not there leaves it as it is.
NODES = {
    "a relative service": {
        "one": '<ClearEntireCostmap service_name="local_costmap/clear_it"/>',
        "L4": '<ClearEntireCostmap service_name="local_costmap/clear_it/amr"/>',
    },
    "an absolute service": {
        "one": '<Action ID="ClearEntireCostmap" service_name="/local_costmap/clear_it"/>',
        "L1": '<Action ID="ClearEntireCostmap" service_name="/amr/local_costmap/clear_it"/>',
        "L2": '<Action ID="ClearEntireCostmap" service_name="/amr/local_costmap/clear_it"/>',
        "L4": '<Action ID="ClearEntireCostmap" service_name="/local_costmap/clear_it/amr"/>',
    },
    "an action": {"one": "<Spin server_name='spin'/>", "L4": "<Spin server_name='spin/amr'/>"},
    "a private service of a node": {
        "one": '<Call service_name="amcl/get_state"/>',
        "L4": '<Call service_name="amcl_amr/get_state"/>',
    },
    "a node": {"one": '<Ask node_name="amcl"/>', "L4": '<Ask node_name="amcl_amr"/>'},
    "topics": {
        "one": '<PlannerSelector topic_name="planner_selector"/>'
        '<IsBatteryLow battery_topic="/battery"/>',
        "L1": '<PlannerSelector topic_name="planner_selector"/>'
        '<IsBatteryLow battery_topic="/amr/battery"/>',
        "L2": '<PlannerSelector topic_name="planner_selector"/>'
        '<IsBatteryLow battery_topic="/amr/battery"/>',
        "L4": '<PlannerSelector topic_name="planner_selector/amr"/>'
        '<IsBatteryLow battery_topic="/battery/amr"/>',
    },
    "frames": {
        "one": '<GoalReached global_frame="map" robot_base_frame="base_link"/>'
        '<DistanceTraveled global_frame="odom"/>',
        "L2": '<GoalReached global_frame="map" robot_base_frame="sp/base_link"/>'
        '<DistanceTraveled global_frame="sp/odom"/>',
        "L4": '<GoalReached global_frame="map" robot_base_frame="base_link/sp"/>'
        '<DistanceTraveled global_frame="odom/sp"/>',
    },
    "ports that only one node means so": {
        "one": '<TransformAvailable parent="map" child="base_link"/><Other parent="map" child="x"/>',
        "L2": '<TransformAvailable parent="map" child="sp/base_link"/>'
        '<Other parent="map" child="x"/>',
        "L4": '<TransformAvailable parent="map" child="base_link/sp"/>'
        '<Other parent="map" child="x"/>',
    },
    "the blackboard": {"one": '<Spin server_name="{spin}" goal="{goal}" spin_dist="1.57"/>'},
    "nothing": {"one": '<Spin server_name="" name="base_link" ID="odom"/>'},
    "placeholders": {"one": '<Spin server_name="$(var x)/spin" robot_base_frame="${frame}"/>'},
    "what stands for the robot": {
        "one": '<Spin server_name="${namespace}/spin" robot_base_frame="${namespace}/odom"/>',
        "L1": '<Spin server_name="/amr/spin" robot_base_frame="odom"/>',
        "L2": '<Spin server_name="/amr/spin" robot_base_frame="sp/odom"/>',
        "L4": '<Spin server_name="/spin/amr" robot_base_frame="odom/sp"/>',
    },
    "escapes": {
        "one": "<A robot_base_frame=\"base&#95;link\" global_frame='odom&quot;'/>",
        "L2": "<A robot_base_frame=\"sp/base_link\" global_frame='sp/odom&quot;'/>",
        "L4": "<A robot_base_frame=\"base_link/sp\" global_frame='odom&quot;/sp'/>",
    },
    "a default that is every robot's": {
        "one": '<TruncatePathLocal distance="1"/><Action ID="TruncatePathLocal" pose="{pose}"/>',
        "L2": '<TruncatePathLocal robot_frame="sp/base_link" distance="1"/>'
        '<Action ID="TruncatePathLocal" pose="{pose}"/>',
        "L4": '<TruncatePathLocal robot_frame="base_link/sp" distance="1"/>'
        '<Action ID="TruncatePathLocal" pose="{pose}"/>',
    },
}


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("name", NODES)
def test_a_node_for_a_robot(name: str, layout: str) -> None:
    text = NODES[name]["one"]
    assert one(text, layout) == NODES[name].get("L2" if layout == "L3" else layout, text)


def test_a_port_that_is_set_is_not_inserted() -> None:
    body = '<TruncatePathLocal robot_frame="tool"/>'
    assert one(body) == '<TruncatePathLocal robot_frame="sp/tool"/>'
    text = tree("<TruncatePathLocal/>")
    assert run(text, context(distro="lyrical"))[0] == text


SUBTREES = fixture_text("behavior_tree_subtrees.xml")


@pytest.mark.parametrize(
    ("shares", "followed"),
    [
        ('_autoremap="true"', True), ('_autoremap="1"', True), ('__autoremap="true"', True),
        ('__shared_blackboard="true"', True), ('_autoremap="false"', False), ("", False),
    ],
)  # fmt: skip
def test_subtrees_that_share_the_blackboard(shares: str, followed: bool) -> None:
    text = SUBTREES.replace('where="{spot}"', shares).replace("{where}", "{spot}")
    assert ('spot="sp/base_link"' in run(text, context())[0]) is followed


@pytest.mark.parametrize(("port", "renamed"), [("where", True), ("name", False)])
def test_what_a_subtree_is_called_is_no_port(port: str, renamed: bool) -> None:
    body = '<SetBlackboard value="/clear" output_key="x"/><SubTree ID="In" '
    inner = f'<BehaviorTree ID="In"><Spin server_name="{{{port}}}"/></BehaviorTree>'
    text = tree(f'{body}{port}="{{x}}"/>').replace("</root>", f"{inner}</root>")
    assert ('value="/amr/clear"' in run(text, context())[0]) is renamed


def test_models_for_editors_stay_and_those_of_subtrees_do_not() -> None:
    text = """<root BTCPP_format="4">
  <TreeNodesModel>
    <Action ID="Spin"><input_port name="global_frame" default="odom" robot_base_frame="tool"/></Action>
    <SubTree ID="A"><input_port name="global_frame" default="odom"/><input_port name="b"/></SubTree>
    <Action ID="X"><TruncatePathLocal/></Action>
  </TreeNodesModel>
</root>
"""
    line = '<SubTree ID="A"><input_port name="global_frame" default="odom"/>'
    assert run(text, context()) == (text.replace(line, line.replace("odom", "sp/odom")), ())


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"", "t.xml:1: the file is empty; a behavior tree starts with <root>"),
        (b"<root><a></root>", "t.xml:1:"),
        (b"<robot/>", "t.xml:1: not a behavior tree: the root is <robot>"),
        (b"<!DOCTYPE root><root/>", "DOCTYPE and entities are not accepted"),
        ("<root a='ä'/>".encode("latin-1"), "UTF-8"),
        (b"<root a='multibotNamespaceSlot'/>", "reserved for this tool"),
    ],
)
def test_what_is_no_tree_is_one_line(data: bytes, said: str) -> None:
    with pytest.raises(InputError) as raised:
        run(data, context())
    assert said in str(raised.value) and "\n" not in str(raised.value)


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ('<A robot_base_frame="base_lnk"/><B robot_base_frame="base_lnk"/>', ["MB853"]),
        ('<A global_frame="odom"/><B global_frame="map"/>', []),
        ('<A target="base_link"/>', ["MB901"]),
        ('<A target="/scan"/>', ["MB901"]),
        ('<A target="a/base_link"/>', ["MB901"]),
        ('<A target="/tmp/a.yaml" planner_id="base_link" behavior_tree="/a/b"/>', []),
        ("<Script code=\" frame:='base_link' \"/>", ["MB901"]),
        ("<Script code=\"a := 'x'; b := 'y'; frame := 'base_link'\"/>", ["MB901"]),
        ("<Script code='a := \"base_link\"; b := 2'/>", ["MB901"]),
        ("<A _skipIf=\"frame == 'odom'\"/>", []),
        ('<A service_name="1/b"/>', ["MB312"]),
    ],
)
def test_findings(body: str, found: list[str]) -> None:
    assert [code for code, _ in codes(tree(body), context())] == found


VALUES = st.sampled_from(["base_link", "odom", "map", "/a/b", "{x}", "", "a'b", "1.5", "ä"])
PORTS = st.sampled_from(["server_name", "robot_frame", "value", "topic_name", "name", "dist"])
FRAMES, TOPICS = {"base_link", "odom"}, {"/a/b"}


@pytest.mark.slow
@given(st.lists(st.dictionaries(PORTS, VALUES), max_size=4), st.sampled_from(LAYOUTS))
def test_only_known_ports_change(nodes: list[dict[str, str]], layout: str) -> None:
    body = "".join(
        "<N " + " ".join(f'{key}="{value}"' for key, value in it.items()) + "/>" for it in nodes
    )
    old, new = (etree.fromstring(it) for it in (tree(body), run(tree(body), context(layout))[0]))
    for before, after in zip(old.iter(), new.iter(), strict=True):
        assert before.tag == after.tag and before.keys() == after.keys()
        for key, value in before.items():
            assert (after.get(key) != value) == changes(layout, key, value)


def changes(layout: str, key: str, value: str) -> bool:
    if key == "robot_frame":
        return layout != "L1" and value not in ("map", "{x}", "")
    if key not in ("server_name", "topic_name"):
        return False
    return value in TOPICS if layout != "L4" else value in {*TOPICS, *FRAMES, "map"}
