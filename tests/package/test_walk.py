# SPDX-License-Identifier: Apache-2.0
"""tests/support/walk.md: the walk of a new user is what the commands print today."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
import walk
from paths import ROOT
from vendor_sources import WITHOUT, sources_folder

from multibot_rewrite import launch

PAGE = (ROOT / "tests" / "support" / "walk.md").read_text()


@pytest.mark.slow
def test_the_help_on_the_page_is_current(tmp_path: Path) -> None:
    for title, command, lines in walk.HELP:
        assert walk.section(walk.shell(title, command, tmp_path, lines)) in PAGE


@pytest.mark.live
@pytest.mark.skipif(bool(launch.missing()), reason=f"no real launch: {launch.missing()}")
def test_the_walk_is_current_in_its_words() -> None:
    """As planned at its end, too: the page says so."""
    pytest.importorskip("rclpy", reason="no rclpy: pip install '.[ros]'")
    folder = sources_folder()
    found = sorted(folder.glob(f"*{walk.REPOSITORY}*")) if folder else []
    if not found:
        pytest.skip(WITHOUT)
    assert walk.in_words(walk.page(Path(os.path.realpath(found[0])))) == walk.in_words(PAGE)
    assert "0 findings: as planned" in PAGE
