"""Conditions of nodes.yaml, decided by values that are written here."""

from __future__ import annotations

import pytest

from multibot_rewrite.knowledge.conditions import holds, parse_condition
from multibot_rewrite.model import UsageError

VALUES: dict[str, object] = {
    "on": True,
    "off": False,
    "mode": "mapping",
    "layer.plugin": "nav2_costmap_2d::VoxelLayer",
    "type": "diff_drive_controller/DiffDriveController",
    "plugins": ["static_layer", "nav2_costmap_2d::VoxelLayer"],
    "period": 0.0,
    "world_frame": "map",
    "map_frame": "map",
}


@pytest.mark.parametrize(
    ("text", "true"),
    [
        ("", True),
        ("on", True),
        ("off", False),
        ("absent", False),
        ("off != false", False),
        ("absent != false", True),
        ("mode = mapping", True),
        ("mode = localization | mapping", True),
        ("mode = localization", False),
        ("layer.plugin = VoxelLayer", True),
        ("layer.plugin = ObstacleLayer | StaticLayer", False),
        ("type = DiffDriveController", True),
        ("plugins has VoxelLayer", True),
        ("plugins has static_layer", True),
        ("plugins has obstacle_layer", False),
        ("absent has anything", False),
        ("period != 0.0", False),
        ("world_frame = $map_frame", True),
        ("world_frame != $map_frame", False),
        ("world_frame = $absent", False),
        ("on and mode = mapping", True),
        ("on and off", False),
    ],
)
def test_a_condition_is_decided(text: str, true: bool) -> None:
    assert holds(text, VALUES.get) is true


@pytest.mark.parametrize("text", [" = x", "a b", "a and ", "!= x"])
def test_what_is_no_condition(text: str) -> None:
    with pytest.raises(UsageError, match="no condition"):
        parse_condition(text)
