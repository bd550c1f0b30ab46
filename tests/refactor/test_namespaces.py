# SPDX-License-Identifier: Apache-2.0
"""The argument for a namespace is verified: what a description is with it, said where that is wrong."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.sources.access import BOUNDED
from multibot_rewrite.refactor.namespaces import namespaced, space_verified
from multibot_rewrite.refactor.package import Expanding, read_package, texts_of
from multibot_rewrite.refactor.source_edits import edited
from multibot_rewrite.refactor.xacro_sources import NAMES, SPACES, Sources

ROBOT = (
    '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="base"/><gazebo>'
    '<plugin name="p" filename="libgazebo_ros_control.so"><robotNamespace>/demo</robotNamespace>'
    "<legacyModeNS>true</legacyModeNS></plugin></gazebo>{}<link name='last'/></robot>"
)
Tamper = Callable[[bytes], bytes]


def verified(folder: Path, tamper: Tamper, more: str = "") -> tuple[tuple[str, ...], list[str]]:
    """Return the names of files that are verified with the edits, which somebody tampered with,
    and why others are not."""
    (folder / "r.urdf.xacro").write_text(ROBOT.format(more))
    tree, how = builtin_tree((), NEWEST_LTS), Expanding(BOUNDED, {})
    found = read_package(str(folder), tree, how).descriptions
    texts = texts_of(found)
    space = namespaced(found, texts, tree)
    assert (space.argument, space.left) == ("namespace", ())
    after = {path: tamper(data) for path, data in edited(texts, space.edits).items()}
    paths, wrong = space_verified(space, "prefix", "robot1_", after, how, tree)
    assert {it.place for it in wrong} <= {str(folder / "r.urdf.xacro")}
    return tuple(Path(it).name for it in paths), [it.why for it in wrong]


@pytest.mark.parametrize(
    "form",
    [
        '<xacro:arg name="{}" default=""/>',
        '<xacro:property name="{}" value=""/>',
        '<xacro:macro name="m" params="a {}:=1 b"/>',
        '<xacro:macro name="m" params="a {}=1 b"/>',
        '<xacro:macro name="m" params="{} c"/>',
    ],
)
def test_the_first_name_that_is_free_is_taken(form: str) -> None:
    """By an argument, a property or a parameter of a macro, with a default or without."""
    sources = Sources({"r": ROBOT.format(form.format("one")).encode(), "c.yaml": b"one: 1"})
    assert sources.free_name(("one", "two", "three"), sources.hiding) == "two"


def test_names_of_arguments_are_those_that_people_use() -> None:
    assert NAMES == ("prefix", "robot_prefix", "tf_prefix", "name_prefix")
    assert SPACES == ("namespace", "robot_namespace", "ros_namespace")


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            b"/${namespace and namespace + '/'}demo",
            b"/demo",
            "<robotNamespace>/demo</robotNamespace>",
        ),
        (b'<link name="base"/>', b'<link name="top" x="1"/>', '<link name="top" x="1"/>'),
        (b"<link name='last'/>", b"", "</robot>"),
        (b"<legacyModeNS>true", b"<legacyModeNS>no", "<legacyModeNS>no</legacyModeNS>"),
        # An element of another one, and one more.
        (b"</plugin></gazebo>", b"</plugin><x/></gazebo>", "<x/>"),
        (b"</gazebo>", b'</gazebo><link name="more"/>', '<link name="more"/>'),
        (b"</robot>", b"<link name='more'/></robot>", '<link name="more"/>'),
    ],
)
def test_what_is_otherwise_is_said(tmp_path: Path, old: bytes, new: bytes, said: str) -> None:
    def tamper(data: bytes) -> bytes:
        assert old in data
        return data.replace(old, new)

    why = f"its ROS names are not verified: with namespace:=ns1 it has {said}"
    assert verified(tmp_path, tamper) == ((), [why])


def test_what_does_not_expand_is_said(tmp_path: Path) -> None:
    paths, (why,) = verified(tmp_path, lambda it: it.replace(b"${namespace", b"${nowhere"))
    assert paths == () and why.startswith("its ROS names are not verified: ")
    assert "nowhere" in why


def test_it_is_tried_beside_a_prefix_too(tmp_path: Path) -> None:
    """What holds without a prefix need not hold with one."""
    declared = b'<xacro:arg name="prefix" default=""/>'
    test = b"${'$(arg prefix)' != '' and namespace != ''}"
    bad = b'<xacro:if value="%s"><link name="odd"/></xacro:if>' % test
    why = 'its ROS names are not verified: with namespace:=ns1 it has <link name="odd"/>'
    tampered = verified(
        tmp_path,
        lambda it: it.replace(b"<link name='last'/>", declared + bad + b"<link name='last'/>"),
    )
    assert tampered == ((), [why])
