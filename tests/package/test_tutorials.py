# SPDX-License-Identifier: Apache-2.0
"""The tutorials: their files are saved and their commands run, in order, and print what is shown.

What needs a simulator or nodes of ROS is a block ``sh``: those lines are held against the files that
the commands before them wrote.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Mapping
from pathlib import Path
from subprocess import CompletedProcess
from typing import NamedTuple

import live_commands
import page_commands
import pytest
from page_commands import Reader, Shown
from paths import ROOT

FOLDER = ROOT / "docs" / "tutorials"
PAGES = {it.stem: it.read_text() for it in sorted(FOLDER.glob("*.md"))}
SHELL = re.compile(r"^```sh\n(.*?)^```$", re.S | re.M)
DECLARED = re.compile(r"DeclareLaunchArgument\(\s*['\"](\w+)")


class Followed(NamedTuple):
    """A tutorial that somebody went through: where, and what each command did."""

    there: Reader
    done: list[tuple[Shown, CompletedProcess[str]]]


def follow(name: str, folder: Path, domain: int, more: Mapping[str, str]) -> Followed:
    folder.mkdir()
    there = page_commands.reader(folder, domain, **more)
    return Followed(there, list(page_commands.steps(PAGES[name], there)))


@pytest.fixture(scope="module")
def followed(
    tmp_path_factory: pytest.TempPathFactory, tf2: dict[str, str]
) -> Mapping[str, Followed]:
    """All of them."""
    folder = tmp_path_factory.mktemp("tutorials")
    return {
        name: follow(name, folder / name, live_commands.domain(95 + at), tf2)
        for at, name in enumerate(PAGES)
    }


@pytest.mark.slow
@pytest.mark.live
@pytest.mark.parametrize("name", PAGES)
def test_commands_print_what_is_shown(name: str, followed: Mapping[str, Followed]) -> None:
    assert followed[name].done
    page_commands.assert_as_shown(name, {name: followed[name].done})


@pytest.mark.slow
@pytest.mark.live
@pytest.mark.parametrize("name", [it for it in PAGES if SHELL.search(PAGES[it])])
def test_commands_of_ros_fit_the_files_that_were_written(
    name: str, followed: Mapping[str, Followed]
) -> None:
    folder = followed[name].there.folder
    for line in "".join(SHELL.findall(PAGES[name])).splitlines():
        assert fits(line, folder), line


def fits(line: str, folder: Path) -> bool:
    """Return whether a line is a launch file with arguments, a line of commands.md, or a plan."""
    words = shlex.split(line)
    if words[:2] == ["ros2", "launch"]:
        given = {it.partition(":=")[0] for it in words[3:]}
        return given <= set(DECLARED.findall((folder / words[2]).read_text()))
    if words[:2] == ["ros2", "run"]:
        made = (folder / "out" / "commands.md").read_text().splitlines()
        return line in {it.partition("  #")[0] for it in made}
    return (
        words[0] == "multibot"
        and words[1] in ("check", "rehearse")
        and (folder / words[2]).is_file()
    )


def test_every_block_of_a_tutorial_is_run_saved_or_compared() -> None:
    for name, text in PAGES.items():
        saved = {it for _, it in page_commands.SAVED.findall(text)}
        kinds = re.findall(r"^```(\w+)\n(.*?)^```$", text, re.S | re.M)
        left = [it for kind, it in kinds if kind not in ("console", "sh") and it not in saved]
        assert left == [], name


def test_a_tutorial_shows_commands() -> None:
    assert len(PAGES) >= 5
    assert all(page_commands.sections(it) for it in PAGES.values())
