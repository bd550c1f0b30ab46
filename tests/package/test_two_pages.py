# SPDX-License-Identifier: Apache-2.0
"""The pages about a check without a plan, Nav2 and changes to a package print what they show."""

from __future__ import annotations

import page_commands
import pytest
from paths import ROOT

pytestmark = pytest.mark.slow

PAGES = {
    it: page_commands.sections((ROOT / "docs" / f"{it}.md").read_text())
    for it in ("check", "nav2", "package")
}


@pytest.fixture(scope="module")
def tried(tmp_path_factory: pytest.TempPathFactory) -> dict[str, page_commands.Tried]:
    return {
        page: page_commands.tried(parts, tmp_path_factory.mktemp(page), 80 + at, {})
        for at, (page, parts) in enumerate(PAGES.items())
    }


@pytest.mark.parametrize(("page", "name"), [(it, name) for it in PAGES for name in PAGES[it]])
def test_a_command_prints_what_is_shown(
    page: str, name: str, tried: dict[str, page_commands.Tried]
) -> None:
    page_commands.assert_as_shown(name, tried[page])
