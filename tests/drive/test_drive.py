# SPDX-License-Identifier: Apache-2.0
"""Built fleets would start, drive, see and plan; folders that were spoiled by hand would not.

Each example is built by the command and judged by ``verdict``, which imports nothing of the package.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable
from functools import cache
from pathlib import Path

import fleet
import pytest
import rcl_names
import verdict
from paths import ROOT
from planted import FAULTS, Spoiled

from multibot_rewrite.cli import multibot

pytestmark = [pytest.mark.live, rcl_names.needed()]
ALL = "starts, drives, sees, plans"
EXAMPLES = {
    "launch_tutorial": {"robot1": "starts, drives, sees", "robot2": "starts, drives, sees"},
    "mixed_fleet": {"base1": ALL, "base2": ALL, "arm": "starts, drives, sees"},
    "namespace_and_prefix": {"robot1": "starts, drives, sees", "robot2": "starts, drives, sees"},
    "two_arms_moveit": {"left": "starts, drives, sees", "right": "starts, drives, sees"},
    "two_robots_nav2": {"robot1": ALL, "robot2": ALL},
    "two_robots_postfix": {"robot1": "starts, drives, sees", "robot2": "starts, drives, sees"},
}


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """Return the folder that ``multibot build`` writes for an example."""
    folder = tmp_path_factory.mktemp("drive")

    @cache
    def of(name: str) -> Path:
        file = ROOT / "examples" / name / "fleet.yaml"
        assert multibot.main(["build", str(file), "-o", str(folder / name), "-q"]) == 0
        return folder / name

    return of


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", EXAMPLES)
def test_a_built_fleet_starts_and_drives(name: str, built: Callable[[str], Path]) -> None:
    found = fleet.read(built(name), "lyrical")
    assert verdict.judged(found) == ()
    assert {robot: verdict.said(it) for robot, it in verdict.done(found).items()} == EXAMPLES[name]
    assert found.unknown == ()


@pytest.mark.sample(6)
@pytest.mark.parametrize("it", FAULTS, ids=[f"{at} {it.why}" for at, it in enumerate(FAULTS)])
def test_a_spoiled_fleet_does_not(
    it: Spoiled, built: Callable[[str], Path], tmp_path: Path
) -> None:
    folder = tmp_path / "fleet"
    shutil.copytree(built(it.example), folder)
    text = (folder / it.file).read_text()
    assert it.old in text
    (folder / it.file).write_text(text.replace(it.old, it.new))
    found = verdict.judged(fleet.read(folder, "lyrical"))
    said = [each.why for each in found if (each.robot, each.what) == (it.robot, it.what)]
    assert any(it.why in why for why in said), found
