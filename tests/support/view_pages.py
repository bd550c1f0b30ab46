# SPDX-License-Identifier: Apache-2.0
"""Pages of ``multibot view``."""

from __future__ import annotations

import json
import re
from math import cos, sin
from pathlib import Path
from typing import Any

import pytest

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.system.records import System


def page(folder: Path, *words: object, code: int = 0) -> dict[str, Any]:
    """Return the data of the page for these words."""
    pytest.importorskip("trimesh", reason="no trimesh: pip install '.[view]'")
    out = folder / "view.html"
    assert main(["view", *map(str, words), "-o", str(out), "-q"]) == code
    text = out.read_text()
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.DOTALL)
    assert found
    made = json.loads(found[1])
    assert isinstance(made, dict)
    return made


def with_places(graph: System) -> System:
    """Of the rover: all as in its file, but robot2's lidar 3 cm lower and its left wheel turned."""
    fixed = {
        "base_link": (0, 0, 0.05), "lidar_link": (0.1, 0, 0.12), "camera_link": (0.2, 0, 0.08),
        "imu_link": (0, 0, 0.02), "left_wheel": (0, 0.17, 0), "right_wheel": (0, -0.17, 0),
        "base_footprint": (1, 0, 0),
    }  # fmt: skip
    frames = []
    for it in graph.edges:
        name, _, robot = it.child.partition("/")
        at, turn = fixed.get(name, (0, 0, 0)), (0, 0, 0, 1)
        if name == "camera_optical_frame":
            turn = (-0.5, 0.5, -0.5, 0.5)
        if (name, robot) == ("lidar_link", "robot2"):
            at = (0.1, 0, 0.09)
        if (name, robot) == ("left_wheel", "robot2"):
            turn = (0, sin(0.35), 0, cos(0.35))
        frames.append(it._replace(transform=tuple(map(float, (*at, *turn)))))
    return graph._replace(edges=tuple(frames))
