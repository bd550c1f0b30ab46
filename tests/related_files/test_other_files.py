# SPDX-License-Identifier: Apache-2.0
"""What a file beside a description is not, or cannot hold, is said in one line."""

from __future__ import annotations

import pytest
from lxml import etree
from made_params import L2, made, section

from multibot_rewrite.base.model import InputError
from multibot_rewrite.related_files.behavior_tree.rewrite import node_name
from multibot_rewrite.related_files.context import NAMESPACE_SLOT, TAG_SLOT
from multibot_rewrite.related_files.engine import splices_of
from multibot_rewrite.related_files.params.sections import meant_for, raw_sections
from multibot_rewrite.related_files.params.shared_defaults import takes_sections
from multibot_rewrite.related_files.rviz.read_config import read_config
from multibot_rewrite.related_files.sites import UNCLEAR, Site, Slot
from multibot_rewrite.related_files.yaml_text import YamlText, read_yaml

TO_DO = "put each node's parameters below ros__parameters:"
ROS1 = "it has no ros__parameters key, so it is for ROS 1 or a node reads it directly; for ROS 2"
MOVEIT = "it holds MoveIt {}; list it under moveit"


def read(text: str, file: str = "p.yaml") -> YamlText:
    return read_yaml(text.encode(), file)


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("Visualization Manager: 1", "it is an RViz config; list it under rviz"),
        ("Panels: 1", "it is an RViz config; list it under rviz"),
        (
            "image: a.pgm",
            "it is a map file for map_server, which holds no robot's name; leave it out",
        ),
        ("joint_limits: 1", MOVEIT.format("joint limits")),
        ("controller_names: 1", MOVEIT.format("controllers")),
        ("moveit_simple_controller_manager: 1", MOVEIT.format("controllers")),
        ("planner_configs: 1", MOVEIT.format("planners")),
        ("arm: {kinematics_solver: x}", MOVEIT.format("kinematics")),
        ("initial_positions: 1", "it holds initial joint positions for xacro; leave it out"),
        ("robots: []", "it is a fleet file"),
        ("- {topic_name: a}", "it is a ros_gz_bridge file; list it under bridge"),
        ("- {ros_topic_name: a}", "it is a ros_gz_bridge file; list it under bridge"),
        ("- {gz_topic_name: a}", "it is a ros_gz_bridge file; list it under bridge"),
        ("- a", f"it is a list; {TO_DO}"),
        ("a", f"it holds a single value; {TO_DO}"),
        ("", f"it is empty; {TO_DO}"),
        ("other: 1", f"{ROS1} {TO_DO}"),
    ],
)
def test_a_file_that_is_none_of_parameters(text: str, what: str) -> None:
    with pytest.raises(InputError) as caught:
        raw_sections(read(text))
    assert str(caught.value) == f"p.yaml:1: not a ROS 2 parameter file: {what}"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "ros__parameters: {a: 1}",
            "ros__parameters has no node name above it; write /**: above it",
        ),
        ("a: {ros__parameters: 5}", "ros__parameters must hold names and values"),
        ("? [a]\n: {ros__parameters: {}}", "a key is a mapping or a list; use a name as key"),
        (
            "a: {ros__parameters: &x {}}",
            "rcl takes no anchors or aliases (&x); write the value out",
        ),
    ],
)
def test_a_section_that_rcl_rejects(text: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        raw_sections(read(text))
    assert str(caught.value) == f"p.yaml:1: {said}"


def test_keys_above_a_section_are_its_path() -> None:
    own = "ros__parameters"
    text = f"/: {{a: {{{own}: {{x: 1}}}}}}\n/b/: {{/c: {{{own}: {{}}}}}}\n/: {{{own}: {{}}}}\n"
    assert [it.path for it in raw_sections(read(text))] == ["a", "b/c", ""]
    assert [
        it.path for it in raw_sections(read("a: {ros__parameters: }\nb: {ros__parameters: {}}"))
    ] == ["b"]


@pytest.mark.parametrize(
    ("text", "can"),
    [
        ("a: 1\n", True), ("---\na: 1\n", True), ("a: 1\n...\n", False), ("a: 1\n---\n", False),
        ("{a: 1}\n", False), ("  a: 1\n", False), ("- a\n", False), ("", False), ("a\n", False),
    ],
)  # fmt: skip
def test_where_a_section_can_stand_behind_the_last_line(text: str, can: bool) -> None:
    try:
        document = read(text)
    except InputError:
        assert not can
        return
    assert takes_sections(document) is can


@pytest.mark.parametrize("word", ["true", "True", "yes", "YES", "on", "On", "y", "Y"])
def test_a_switch_for_a_prefix_is_off_where_frames_have_it(word: str) -> None:
    text, _ = made(
        section("diff_drive_controller", f"tf_frame_prefix_enable: {word}"), L2, "kilted"
    )
    assert "tf_frame_prefix_enable: false" in text
    kept, _ = made(section("diff_drive_controller", "tf_frame_prefix_enable: false"), L2, "kilted")
    assert "tf_frame_prefix_enable: false" in kept


# ---------------------------------------------------------------- RViz


@pytest.mark.parametrize(
    ("text", "line", "what"),
    [
        ("Visualization Manager:\n  Displays: [a]\n", 2, "displays"),
        ("Visualization Manager:\n  Tools: [a]\n", 2, "tools"),
        ("Panels: [a]\nVisualization Manager: {}\n", 1, "panels"),
    ],
)
def test_lists_in_brackets_cannot_be_copied(text: str, line: int, what: str) -> None:
    with pytest.raises(InputError) as caught:
        read_config(read(text, "a.rviz"))
    assert str(caught.value) == (
        f"a.rviz:{line}: {what} are in brackets, which cannot be copied; save the file with rviz2"
    )


@pytest.mark.parametrize("form", ["Action", "Condition", "Decorator", "Control"])
def test_a_node_of_a_tree_is_called_by_its_id(form: str) -> None:
    """BT.CPP: the explicit form has the name in ID, the compact one is the tag."""
    assert node_name(etree.fromstring(f'<{form} ID="Spin"/>')) == "Spin"
    assert node_name(etree.fromstring('<Spin ID="x"/>')) == "Spin"


# ---------------------------------------------------------------- texts in their places


def site(slot: Slot, text: str, at: int = 0, size: int = -1) -> Site:
    return Site("frame", text, "key", slot, at, size)


def test_what_cannot_be_edited_is_said() -> None:
    slot = Slot(7, 1, 0, 1, "a", UNCLEAR)
    with pytest.raises(InputError) as caught:
        [*splices_of("a", "f", [(site(slot, "a"), "b")])]
    assert str(caught.value) == "f:7: 'a' cannot be edited in place; write it on one line"


def test_one_text_cannot_be_two_names() -> None:
    slot = Slot(7, 1, 0, 1, "a")
    both = [(site(slot, "a"), f"{TAG_SLOT}/a"), (site(slot, "a"), f"/{NAMESPACE_SLOT}/a")]
    with pytest.raises(InputError) as caught:
        [*splices_of("a", "f", both)]
    assert str(caught.value) == (
        "f:7: an alias uses 'a' as two kinds of name, 'ROBOT/a' and '/ROBOT/a';"
        " write the value out in both places"
    )


# Sections that have the name of a node which reads the file, and another namespace.

NODES = ("/robot1/amcl", "/robot2/amcl", "/robot1/costmap/costmap")


@pytest.mark.parametrize(
    ("paths", "meant"),
    [
        (("amcl",), "amcl"),
        (("/other/amcl",), "/other/amcl"),
        (("amcl", "/**"), "amcl"),
        # rcl_yaml_param_parser: wildcards match any namespace.
        (("/**/amcl",), ""),
        (("/*/amcl",), ""),
        (("/**",), ""),
        (("robot1/amcl",), ""),
        (("/robot1/amcl", "/other/amcl"), ""),
        # That of the other robot is for a node that runs.
        (("/robot2/amcl",), ""),
        (("controller", "costmap/costmap"), ""),
    ],
)
def test_a_section_that_gives_its_node_nothing(paths: tuple[str, ...], meant: str) -> None:
    text = "".join(f"{it}:\n  ros__parameters: {{a: 1}}\n" for it in paths)
    found = meant_for(raw_sections(read_yaml(text.encode(), "f.yaml")), "/robot1/amcl", NODES)
    assert (found.path if found else "").strip("/") == meant.strip("/")
