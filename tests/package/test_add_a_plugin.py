# SPDX-License-Identifier: Apache-2.0
"""The guide works as written: its files are written, its commands run, its output compared."""

from __future__ import annotations

import os
import re
from pathlib import Path

import guides
import pytest
from paths import ROOT

from multibot_rewrite.description.rewriters import plugin_definitions as definitions
from multibot_rewrite.description.rewriters.plugin_definitions import FORMS, KINDS, TYPES
from multibot_rewrite.description.rewriters.plugin_definitions.grammar import (
    OPTIONS,
    ROLES,
    SETTINGS,
)

pytestmark = pytest.mark.slow

# The page for users, then the one for those who contribute their section.
GUIDE = "\n".join(
    (ROOT / "docs" / it).read_text()
    for it in ("add-a-plugin.md", "contributing/plugin-definitions.md")
)
STEPS = guides.steps(GUIDE)


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    """Where pip installs offline, into a folder of its own."""
    site = tmp_path / "site"
    path = [str(site), str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])]
    pip = {"TARGET": str(site), "NO_INDEX": "1", "NO_DEPS": "1", "NO_BUILD_ISOLATION": "0"}
    return {
        **guides.environment(tmp_path / "bin"),
        **{f"PIP_{key}": value for key, value in pip.items()},
        "PIP_DISABLE_PIP_VERSION_CHECK": "1",
        "PYTHONPATH": os.pathsep.join(path),
    }


@pytest.mark.deep
def test_the_page_works_as_written(tmp_path: Path, environment: dict[str, str]) -> None:
    folder = tmp_path / "work"
    guides.copy_repository(folder / "multibot_rewrite")
    for step in STEPS:
        # What is installed by now must not stand in for what is contributed.
        own = environment if "cd " not in step.text else without_site(environment)
        guides.follow([step], folder, own)
    page = (folder / "pages" / "plugins" / "classic_both.md").read_text()
    assert "## plugin acme_winch\n" in page


def without_site(environment: dict[str, str]) -> dict[str, str]:
    """Return the environment of a clone, where nothing else is installed."""
    return {**environment, "PYTHONPATH": os.environ.get("PYTHONPATH", "")}


def test_every_block_is_a_file_or_a_script() -> None:
    assert GUIDE.count("```") == 2 * len(STEPS)
    assert [step.text for step in STEPS if not step.kind] == []
    assert len([step for step in STEPS if step.file]) >= 7


def test_the_page_and_the_grammar_name_every_word() -> None:
    words = {*ROLES, *KINDS, *FORMS, *SETTINGS}
    assert sorted(word for word in words if not re.search(rf"`{word}[` ]", GUIDE)) == []
    assert [option for option in OPTIONS if f"{option}=" not in GUIDE] == []
    grammar = Path(definitions.__file__).with_name("README.md").read_text()
    forms = [f"form={form}" for form in FORMS]
    wanted = [*forms, *(f"    {s}: " for s in SETTINGS), *(f"[{t} " for t in TYPES)]
    assert [word for word in (*wanted, *(f"{o}=" for o in OPTIONS)) if word not in grammar] == []
