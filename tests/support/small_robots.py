# SPDX-License-Identifier: Apache-2.0
"""Small robots and what ``multibot init`` makes of a folder of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from multibot_rewrite.cli.multibot import main

PACKAGE = "<package><name>{}</name></package>"


def robot(name: str, *joints: str, more: str = "") -> str:
    """A base with a wheel for each joint."""
    parts = "".join(
        f'<link name="{it}_wheel"/><joint name="{it}" type="continuous"><parent link="{name}_base"/>'
        f'<child link="{it}_wheel"/><axis xyz="0 1 0"/></joint>'
        for it in joints
    )
    return f'<robot name="{name}"><link name="{name}_base"/>{parts}{more}</robot>'


def init(folder: Path, *words: str) -> int:
    return main(["init", str(folder), *words, "-n", "2", "--yes", "-o", str(folder / "fleet.yaml")])


def taken(folder: Path, *words: str) -> Any:
    assert init(folder, *words) == 0
    return yaml.safe_load((folder / "fleet.yaml").read_text())
