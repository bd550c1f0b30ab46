"""The contributor's pages work as written: each is followed in a copy of the repository."""

from __future__ import annotations

from pathlib import Path

import guides
import pytest
from paths import ROOT

pytestmark = pytest.mark.slow

PAGES = sorted((ROOT / "docs" / "contributing").glob("*.md"))


# The longest one: it asks the rules of the graph, too.
DEEP = pytest.mark.deep


@pytest.mark.parametrize(
    "page",
    [pytest.param(it, marks=[DEEP] * (it.stem == "graph-rule")) for it in PAGES],
    ids=lambda page: page.stem,
)
def test_a_page_works_as_written(page: Path, tmp_path: Path) -> None:
    text = page.read_text()
    steps = guides.steps(text)
    assert text.count("```") == 2 * len(steps)
    guides.copy_repository(tmp_path / "copy")
    guides.follow(steps, tmp_path / "copy", guides.environment(tmp_path / "bin"))


def test_every_page_is_named_in_the_guide() -> None:
    guide = (ROOT / "CONTRIBUTING.md").read_text()
    for page in (*PAGES, ROOT / "docs" / "add-a-plugin.md"):
        assert page.relative_to(ROOT).as_posix() in guide
