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
