# SPDX-License-Identifier: Apache-2.0
"""The fleets of the pages of vendors' arms, in their layout and one other, with two arms and three.

What is true of them is on the page: its codes.
"""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest
import yaml
from fleet_folder import built_fleet
from paths import ROOT
from vendor_live import Told, look, said, told
from vendor_sources import install, packages_below

ARMS = {"ur": "UR5e", "franka": "FR3", "xarm": "xArm 6", "kinova": "Gen3"}
# Their sections of docs/contributing/arms.md.
TITLES = {
    "ur": "Two UR arms",
    "franka": "Two Franka FR3",
    "xarm": "Two xArm 6",
    "kinova": "Two Kinova Gen3",
}
OTHER_LAYOUT = "frames-per-robot"
# They say that each arm has an RViz of its own, or that its frame and view are others now.
EVERYWHERE = {"MF201", "MF203", "MF213"}
THIRD = "middle"
_CODE = re.compile(r"M[BFGR]\d{3}")
_PORT = re.compile(r"port")


def told_of_arms(sources: Path) -> dict[str, list[Told]]:
    """Return what is said of all arms, with their packages to be found as installed ones."""
    with tempfile.TemporaryDirectory() as name, pytest.MonkeyPatch.context() as patch:
        for key, value in install(packages_below(sources), Path(name) / "prefix", {}).items():
            patch.setenv(key, value)
        return {page: list(_told_of_arm(page, sources, Path(name))) for page in ARMS}


def _told_of_arm(page: str, sources: Path, work: Path) -> Iterator[Told]:
    codes, file = true_codes(page), work / "fleet.yaml"
    for fleet in fleets(page, sources):
        file.write_text(yaml.safe_dump(fleet))
        made = built_fleet(file)
        robots = [it["name"] for it in fleet["robots"]]
        looked = look(file, {it.path: it.data for it in made.files}, robots)
        yield told(
            fleet["layout"], said(made.findings, robots), looked, lambda it: it.code in codes
        )


def fleets(page: str, sources: Path) -> Iterator[Mapping[str, Any]]:
    """Yield the fleets of a page."""
    text = re.sub(r"\bsrc/", f"{sources}/", text_of(page))
    (fleet,) = re.findall(r"```yaml\n(.*?)```", text, re.DOTALL)
    data = yaml.safe_load(fleet)
    for layout in (data["layout"], OTHER_LAYOUT):
        for more in ([], [_third(data["robots"][-1])]):
            yield {**data, "layout": layout, "robots": [*data["robots"], *more]}


def true_codes(page: str) -> set[str]:
    """Return the codes that the page explains."""
    return set(_CODE.findall(text_of(page))) | EVERYWHERE


def _third(robot: Mapping[str, Any]) -> dict[str, Any]:
    """One more arm, elsewhere, with an address and ports of its own."""
    arguments = {name: _next(name, value) for name, value in robot.get("arguments", {}).items()}
    return {**robot, "name": THIRD, "pose": {"y": 5}, "arguments": arguments}


def _next(name: str, value: str) -> str:
    if _PORT.search(name):
        return str(int(value) + 10)
    head, dot, last = value.rpartition(".")
    return f"{head}.{int(last) + 1}" if dot and last.isdigit() else value


def text_of(page: str) -> str:
    """Return the section of docs/contributing/arms.md."""
    text = (ROOT / "docs" / "contributing" / "arms.md").read_text()
    return text.partition(f"\n## {TITLES[page]}\n")[2].partition("\n## ")[0]
