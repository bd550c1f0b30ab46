"""Which robot a name of the graph belongs to."""

from __future__ import annotations

from multibot_rewrite.system.ownership import NameOwnership


def test_a_name_below_a_node_is_of_the_robot_of_the_node() -> None:
    """However deep, and though no robot's name is in it."""
    owner = NameOwnership({}, {"/gripper": "left"}, {}, frozenset(), False)
    assert owner.robot("/gripper/state") == "left"
    assert owner.robot("/gripper/jaw/state") == "left"
    assert owner.robot("/grip/state") == ""
