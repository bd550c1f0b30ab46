# SPDX-License-Identifier: Apache-2.0
"""Rows and sections of the plugin definitions that hold in some releases only."""

from __future__ import annotations

from pathlib import Path

import pytest
from description_calls import RELEASES, load_definitions
from paths import fixture_text

from multibot_rewrite.base.model import DefinitionsError

TEXT = fixture_text("definitions_by_release_text.txt")


@pytest.fixture
def path(tmp_path: Path) -> str:
    file = tmp_path / "v.vocab"
    file.write_text(TEXT)
    return str(file)


def rows(path: str, release: str, name: str = "beam") -> dict[str, str]:
    found = load_definitions((path,), release).find("plugin", name)
    return {it.path: " ".join(it.kinds) for section in found for it in section.sites}


@pytest.mark.parametrize(("release", "topics"), [("kilted", 1), ("lyrical", 2), ("rolling", 2)])
def test_a_section_given_again_adds_in_its_releases(path: str, release: str, topics: int) -> None:
    (beam,) = load_definitions((path,), release).find("plugin", "beam")
    assert beam.topics == ("beam", "beam_info")[:topics]


@pytest.mark.parametrize("release", RELEASES)
def test_a_plugin_is_unknown_where_its_release_lacks_it(path: str, release: str) -> None:
    assert bool(rows(path, release, "young")) == (release in ("kilted", "rolling"))


def test_all_releases_together_are_one_page(path: str) -> None:
    first, second = load_definitions((path,), "").find("plugin", "beam")
    assert [(it.path, it.releases) for it in first.sites if it.path == "rate"] == [
        ("rate", "humble"),
        ("rate", "rolling"),
    ]
    assert (first.topics, second.topics, second.releases) == (("beam",), ("beam_info",), "lyrical+")


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("row", "message"),
    [
        ("x uses link releases=iron", "2: x releases='iron' names no releases, write jazzy"),
        ("releases: jazzy kilted", "2: releases: 'jazzy kilted' names no releases"),
        (
            "x uses link releases=humble\nx uses joint releases=<=jazzy",
            "3: x is in line 2 already; remo",
        ),
        ("x uses link\nx uses joint releases=jazzy", "3: x is in line 2 already"),
    ],
)
def test_what_is_wrong_in_any_release_is_refused_in_all(
    row: str, message: str, tmp_path: Path
) -> None:
    (tmp_path / "w.vocab").write_text(f"[plugin wrong]\n{row}\n")
    for release in RELEASES:
        with pytest.raises(DefinitionsError, match=message):
            load_definitions((str(tmp_path / "w.vocab"),), release)


def test_two_files_may_say_something_of_a_path_in_different_releases(
    path: str, tmp_path: Path
) -> None:
    (tmp_path / "more.vocab").write_text("[plugin beam]\nold uses joint releases=kilted\n")
    more = str(tmp_path / "more.vocab")
    found = load_definitions((path, more), "kilted").find("plugin", "beam")
    assert {it.path for it in found[0].sites} == {"both", "old"}
