# SPDX-License-Identifier: Apache-2.0
"""Files that are damaged in any way: one clear line and exit code 2, or findings; what was there before
is there still."""

from __future__ import annotations

import random
import shutil
import stat
from collections.abc import Iterable
from pathlib import Path

import pytest
from damaged import PLACES, Place, damages, faults, run, whole_folder
from launched_here import read_here

pytestmark = pytest.mark.slow

READ = [(place, words) for place in PLACES for words in place.commands]
NAMES = [f"{place.file}-{'-'.join(words[:2])}" for place, words in READ]
# So many of the damages in the usual run; those that chance has a part in are made so many times.
FEW, MANY = 8, 4


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return whole_folder(tmp_path_factory.mktemp("whole"))


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where the commands run, which read launch files in this process."""
    read_here(monkeypatch, tmp_path)
    folder = tmp_path / "here"
    folder.mkdir()
    monkeypatch.chdir(folder)
    return folder


def renew(here: Path, whole: Path) -> None:
    for it in here.iterdir():
        shutil.rmtree(it) if it.is_dir() and not it.is_symlink() else it.unlink()
    shutil.copytree(whole, here, dirs_exist_ok=True)


def contents(folder: Path) -> dict[str, bytes]:
    files = (it for it in folder.iterdir() if stat.S_ISREG(it.lstat().st_mode))
    return {it.name: it.read_bytes() for it in files if it.name != "out"}


def wrong(
    place: Place, words: tuple[str, ...], here: Path, whole: Path, chosen: Iterable[object]
) -> list[str]:
    """Return what is wrong with how the command ends for the damages of these names."""
    found = []
    for name, damage in damages(place, MANY):
        if name not in chosen:
            continue
        renew(here, whole)
        damage(here / place.file)
        before = contents(here)
        try:
            said = faults(run(words), words, place.file, here)
        except (Exception, SystemExit) as error:
            said = [f"raises {type(error).__name__}: {error}"]
        said += [f"changed {it}" for it, data in before.items() if contents(here).get(it) != data]
        found += [f"{name}: {it}" for it in said]
    return found


@pytest.mark.parametrize(("place", "words"), READ, ids=NAMES)
def test_what_is_not_damaged_is_read(
    place: Place, words: tuple[str, ...], here: Path, whole: Path
) -> None:
    renew(here, whole)
    done = run(words)
    # A message of a graph may lack what its monitor does not report.
    assert done.code in (0, 1, 3), done.err


@pytest.mark.sample(6)
@pytest.mark.parametrize(("place", "words"), READ, ids=NAMES)
def test_a_damaged_file(place: Place, words: tuple[str, ...], here: Path, whole: Path) -> None:
    names = [name for name, _ in damages(place, MANY)]
    chosen = random.Random(" ".join((place.file, *words))).sample(names, FEW)
    assert wrong(place, words, here, whole, chosen) == []


@pytest.mark.deep
@pytest.mark.parametrize(("place", "words"), READ, ids=NAMES)
def test_a_file_with_any_damage(
    place: Place, words: tuple[str, ...], here: Path, whole: Path
) -> None:
    names = [name for name, _ in damages(place, MANY)]
    assert wrong(place, words, here, whole, names) == []
