# SPDX-License-Identifier: Apache-2.0
"""Names that two robots have: which count, which may be shared."""

from __future__ import annotations

import pytest
from description_calls import RuntimeName, make_naming, meetings, same_for_all

LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")


def having(*names: tuple[str, str]) -> list[RuntimeName]:
    return [RuntimeName(*it, "plugin", 0, "x") for it in names]


# Does the name meet, in the order of LAYOUTS?
@pytest.mark.parametrize(
    ("kind", "name", "meets"),
    [
        ("topic", "/scan", (1, 1, 1, 1)),
        ("service", "/reset", (1, 1, 1, 1)),
        ("node", "/drive", (1, 1, 1, 1)),
        ("sensor", "imu", (1, 1, 1, 1)),
        # One tf topic for all is what frames-per-robot is.
        ("topic", "/tf", (1, 0, 1, 1)),
        ("topic", "/tf_static", (1, 0, 1, 1)),
        # Bare frames on a tf topic of their own do not meet.
        ("frame", "odom", (0, 1, 1, 1)),
        ("frame", "world", (0, 0, 0, 0)),
        ("frame", "map", (0, 0, 0, 0)),
        ("topic", "/clock", (0, 0, 0, 0)),
        # The simulator makes this one from the model's name.
        ("topic", "/__default_topic__", (0, 0, 0, 0)),
        ("frame", "__odom__", (0, 1, 1, 1)),
        # A node may be called like a shared topic or frame.
        ("node", "/clock", (1, 1, 1, 1)),
    ],
)
def test_what_meets(kind: str, name: str, meets: tuple[int, ...]) -> None:
    one = having((kind, name))
    for layout, wanted in zip(LAYOUTS, meets, strict=True):
        naming = make_naming(layout)
        assert len(list(same_for_all(one, "robot1", naming))) == wanted, layout
        assert len(list(meetings({"a": one, "b": one}, naming))) == wanted, layout
