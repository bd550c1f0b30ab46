# SPDX-License-Identifier: Apache-2.0
"""A reader tries the pages one after the other in one clone: no page is in the way of the next."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import live_commands
import page_commands
import pytest
from paths import ROOT

PAGES = (
    "README.md",
    "docs/tutorials/two-robots-gazebo.md",
    "docs/tutorials/nav2-three-robots.md",
    "docs/tutorials/two-arms-moveit.md",
    "docs/check.md",
    "docs/tutorials/lint-in-ci.md",
    "docs/tutorials/layouts.md",
    "docs/recipes.md",
    "docs/plan.md",
)
# What the first page writes without showing an answer is there for all pages after it.
INDENTED = re.compile(r"^    ((?:urdf-postfix|urdf-lint|multibot) .*)$", re.MULTILINE)


@pytest.mark.deep
@pytest.mark.live
def test_every_page_works_behind_those_before_it(tmp_path: Path, tf2: dict[str, str]) -> None:
    there = page_commands.reader(tmp_path, live_commands.domain(89), **tf2)
    for line in INDENTED.findall((ROOT / PAGES[0]).read_text()):
        if not line.startswith(page_commands.LIVE):
            ran = there.run(line)
            assert ran.returncode != 2, f"{line}\n{ran.stdout}"
    # The README works in a folder of its own.
    shutil.copy(ROOT / "examples/launch_tutorial/rover.urdf", tmp_path)
    for name in PAGES:
        done = list(page_commands.steps((ROOT / name).read_text(), there))
        assert done, name
        page_commands.assert_as_shown(name, {name: done})
