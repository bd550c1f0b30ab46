# SPDX-License-Identifier: Apache-2.0
"""Names that are another one but for a slip: expectations are what a person would call a slip."""

from __future__ import annotations

import pytest

from multibot_rewrite.rules.system.causes import Spelled, alike


@pytest.mark.parametrize(
    ("name", "known", "found"),
    [
        ("/r/Scan", ["/r/odom", "/r/scan"], "/r/scan"),
        ("/r/cmd-vel", ["/r/cmd_vel"], "/r/cmd_vel"),
        ("/r/odmo", ["/r/scan", "/r/odom"], "/r/odom"),
        # It is no slip of itself, and what it is there beside.
        ("/r/scan", ["/r/scan"], ""),
        ("/r/scan", ["/r/scan", "/r/Scan"], "/r/Scan"),
        # Two things: numbers, sides, another word.
        ("/r/scan1", ["/r/scan2"], ""),
        ("/r/lidar_l", ["/r/lidar_r"], ""),
        ("/r/odom", ["/r/map"], ""),
    ],
)
def test_a_slip_is_the_known_name(name: str, known: list[str], found: str) -> None:
    assert alike(name, Spelled(known), "acme/msg/A") == found
