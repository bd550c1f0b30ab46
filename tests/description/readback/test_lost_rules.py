# SPDX-License-Identifier: Apache-2.0
"""The second reading sees a rule that matched a name and matches none after a rewrite."""

from __future__ import annotations

import pytest
from description_calls import NEWEST_LTS, LostRule, builtin_tree, lost_rules, read

from multibot_rewrite import rewrite

PLUGIN = (
    '<robot name="r"><link name="a"/><gazebo><plugin name="{}" filename="libgazebo_ros_{}.so">'
    "<ros>{}</ros></plugin></gazebo></robot>"
)


def force(*rules: str, namespace: str = "") -> bytes:
    texts = "".join(f"<remapping>{it}</remapping>" for it in rules)
    given = f"<namespace>{namespace}</namespace>" if namespace else ""
    return PLUGIN.format("f", "force", given + texts).encode()


def lost(before: bytes, after: bytes) -> list[LostRule]:
    definitions = builtin_tree((), NEWEST_LTS).definitions
    return list(lost_rules(*(read(it, "r.urdf", definitions) for it in (before, after))))


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (force("/gazebo_ros_force:=a"), force("/gazebo_ros_force:=a", namespace="robot1")),
        (force("f/x:=y", "gazebo_ros_force:=a"), force("f/x:=y", "gazebo_ros_force2:=a")),
        # An inserted rule stands in front and wins.
        (force("/gazebo_ros_force:=a"), force("gazebo_ros_force:=b", "/gazebo_ros_force:=a")),
    ],
)
def test_a_rule_that_matches_no_more_is_named(before: bytes, after: bytes) -> None:
    (found,) = lost(before, after)
    assert found.number == 0
    assert found.name == "/gazebo_ros_force"
    assert found.rule.endswith(":=a")


def test_a_topic_that_the_layout_shares_may_lose_its_rule() -> None:
    source = PLUGIN.format("d", "planar_move", "<remapping>tf:=my_tf</remapping>")
    made = rewrite(source, "robot1", layout="frames-per-robot")
    assert "MB436" not in [it.code for it in made.findings]
