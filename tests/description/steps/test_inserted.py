# SPDX-License-Identifier: Apache-2.0
"""The marker comment in front of inserted elements."""

from __future__ import annotations

import pytest
from lxml import etree

from multibot_rewrite import InputError, rewrite, strip

ROVER = """<robot name="a"><link name="l"/><gazebo>
{}<plugin filename="libgazebo_ros_diff_drive.so" name="drive"></plugin></gazebo></robot>"""


@pytest.mark.parametrize("words", [" multibot notes ", " multibot ", " multibot r1 is here "])
def test_a_comment_of_a_person_is_no_marker(words: str) -> None:
    source = ROVER.format(f"<!--{words}-->")
    made = rewrite(source, "r1").data
    assert f"<!--{words}-->".encode() in made
    assert strip(made, "r1") == source.encode()


@pytest.mark.parametrize(("old", "new"), [("+3", "+two"), ("+3", "+7"), ("r1 +3", "r1 +3 twice")])
def test_a_marker_that_was_edited_is_refused(old: str, new: str) -> None:
    made = rewrite(ROVER.format(""), "r1").data.replace(f" {old}".encode(), f" {new}".encode())
    with pytest.raises(InputError, match="edited by hand"):
        strip(made, "r1")


EMPTY = """<robot name="a"><link name="l"/><gazebo>
<plugin filename="libgazebo_ros_imu_sensor.so" name="imu"><ros>{}</ros></plugin></gazebo></robot>"""
# As gazebo_ros node.cpp reads them: no text in force, so "/" is all of the namespace.
EMPTY_NAMESPACES = [
    "<namespace/>",
    "<namespace />",
    "<namespace></namespace>",
    "<namespace></namespace >",
    "<namespace></namespace\n>",
    "<namespace a='>'></namespace>",
    "<namespace> </namespace>",
    "<namespace>\r\n  </namespace>",
    "<namespace><!-- none --></namespace>",
    "<namespace> <!-- a --> <!-- b --> </namespace>",
    "<namespace><x>y</x></namespace>",
]


@pytest.mark.sample(1)
@pytest.mark.parametrize("element", EMPTY_NAMESPACES)
@pytest.mark.parametrize("layout", ["L1", "L2", "L3"])
def test_an_empty_namespace_is_filled_and_emptied_again(element: str, layout: str) -> None:
    source = EMPTY.format(element)
    made = rewrite(source, "r1", layout=layout).data
    (namespace,) = etree.fromstring(made).iter("namespace")
    assert (namespace.text or "").strip() == "/r1"
    assert b"+0 filled namespace (or all robots would share the root namespace)" in made
    assert strip(made, "r1", layout=layout) == source.encode()


@pytest.mark.parametrize("element", EMPTY_NAMESPACES)
def test_without_namespaces_an_empty_one_stays(element: str) -> None:
    made = rewrite(EMPTY.format(element), "r1").text
    assert element in made
    assert "filled" not in made


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("filled namespace", "filled"),
        ("filled namespace", "filled topic"),
        ("filled namespace", "filled ..'"),
        ("filled namespace", "full namespace"),
        (">/r1<", "><"),
        ("<namespace>/r1</namespace>", ""),
    ],
)
def test_a_filled_element_that_was_edited_is_refused(old: str, new: str) -> None:
    made = rewrite(EMPTY.format("<namespace/>"), "r1", layout="L1").text.replace(old, new)
    with pytest.raises(InputError, match="edited by hand"):
        strip(made, "r1", layout="L1")


def test_a_marker_that_counts_an_element_of_the_user_is_refused_in_one_line() -> None:
    source = ROVER.format("").replace("></plugin>", "><update_rate>5</update_rate ></plugin>")
    made = rewrite(source, "r1").data
    assert strip(made, "r1") == source.encode()
    with pytest.raises(InputError, match="edited by hand"):
        strip(made.replace(b"r1 +3", b"r1 +4"), "r1")


def test_gz_ros2_control_reads_no_settings_beside_ros() -> None:
    """gz_ros2_control_plugin.cpp: only what is in <ros> counts."""
    source = """<robot name="a"><link name="l"/><gazebo>
<plugin filename="gz_ros2_control-system" name="c"><namespace/></plugin></gazebo></robot>"""
    made = etree.fromstring(rewrite(source, "r1", layout="L1").data)
    assert made.findtext(".//ros/namespace") == "/r1"
    assert made.findtext(".//plugin/namespace") == ""
