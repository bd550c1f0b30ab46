# SPDX-License-Identifier: Apache-2.0
"""The page about changes to a package: its commands print what is shown."""

from __future__ import annotations

import page_commands
import pytest
from paths import ROOT

PARTS = page_commands.sections((ROOT / "docs" / "package.md").read_text())


@pytest.fixture(scope="module")
def tried(tmp_path_factory: pytest.TempPathFactory) -> page_commands.Tried:
    return page_commands.tried(PARTS, tmp_path_factory.mktemp("package"), 81, {})


@pytest.mark.slow
@pytest.mark.parametrize("name", PARTS)
def test_a_command_prints_what_is_shown(name: str, tried: page_commands.Tried) -> None:
    page_commands.assert_as_shown(name, tried)
