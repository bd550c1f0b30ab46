# SPDX-License-Identifier: Apache-2.0
"""The marker comment in front of inserted elements."""

from __future__ import annotations

import pytest
import yaml
from lxml import etree

from multibot_rewrite import InputError, rewrite, strip

ROVER = """<robot name="a"><link name="l"/><gazebo>
{}<plugin filename="libgazebo_ros_diff_drive.so" name="drive"></plugin></gazebo></robot>"""


def comments(data: bytes) -> list[str]:
    return [str(it.text) for it in etree.fromstring(data).iter(etree.Comment)]


def test_the_marker_says_what_was_added_and_why() -> None:
    (marker,) = comments(rewrite(ROVER.format(""), "r1").data)
    assert marker == (
        " multibot r1 +3 (added, or all robots would share odom, base_footprint, /tf, cmd_vel) "
    )


def test_a_missing_namespace_is_named_as_what_robots_would_share() -> None:
    for layout in ("L1", "L2", "L3"):
        first, *_ = comments(rewrite(ROVER.format(""), "r1", layout=layout).data)
        assert "(added, or all robots would share" in first
        assert "the root namespace" in first


def test_a_launch_file_can_pass_the_description_on_as_a_yaml_string() -> None:
    text = rewrite(ROVER.format(""), "r1").text
    line = next(line for line in text.splitlines() if "multibot" in line).strip()
    assert yaml.safe_load(line) == line


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


def test_only_the_first_of_two_namespaces_counts() -> None:
    for element, filled in (("<namespace>/a</namespace><namespace/>", 0), ("<namespace/>" * 2, 1)):
        made = rewrite(EMPTY.format(element), "r1", layout="L1").text
        assert made.count("filled") == filled
        assert made.count("<namespace/>") == 1


def test_several_robots_get_their_own_text() -> None:
    texts = [rewrite(EMPTY.format("<namespace/>"), it, layout="L1").text for it in ("r1", "r2")]
    assert texts[0].replace("r1", "r2") == texts[1] != texts[0]


def test_a_robot_is_stripped_from_under_another() -> None:
    source = EMPTY.format("<namespace/>")
    first = rewrite(source, "r1", layout="L1").data
    both = rewrite(first, "r2", layout="L1", again=True).data
    assert b"<namespace>/r2/r1</namespace>" in both
    assert strip(strip(both, "r2", layout="L1"), "r1", layout="L1") == source.encode()


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


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_inserted_lines_end_and_start_as_the_lines_around_them(end: str) -> None:
    lines = ROVER.format("").replace("></plugin>", ">\n   <update_rate>5</update_rate>\n</plugin>")
    made = rewrite(lines.replace("\n", end), "r1").text
    assert f'name="drive_r1">{end}   <!-- multibot' in made
    assert f"-->{end}   <odometry_frame>" in made
    assert made.count("\n") == made.count(end)


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
