# SPDX-License-Identifier: Apache-2.0
"""The contributor's journeys work as written: each is followed in a copy of the repository."""

from __future__ import annotations

import re
from pathlib import Path

import guides
import pytest
from paths import ROOT

pytestmark = pytest.mark.slow

PAGE = (ROOT / "docs" / "contributing" / "extending.md").read_text()
JOURNEYS = dict(re.findall(r"^## (Add .*)\n((?:(?!## ).*\n)*)", PAGE, re.MULTILINE))


@pytest.mark.deep
@pytest.mark.parametrize("name", JOURNEYS)
def test_a_journey_works_as_written(name: str, tmp_path: Path) -> None:
    """Each costs a copy of the repository and its tests."""
    text = JOURNEYS[name]
    steps = guides.steps(text)
    assert text.count("```") == 2 * len(steps) + sum(it.text.count("```") for it in steps)
    guides.copy_repository(tmp_path / "copy")
    guides.follow(steps, tmp_path / "copy", guides.environment(tmp_path / "bin"))


def test_every_journey_is_named_in_the_guide() -> None:
    guide = (ROOT / "CONTRIBUTING.md").read_text()
    assert len(JOURNEYS) == 4
    assert [it for it in (*JOURNEYS, "Add a plugin") if f"[{it}](docs/" not in guide] == []
