"""The guide works as written: its files are written, its commands run, its output compared."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest
from paths import ROOT

from multibot_rewrite.rewriters import vocabulary
from multibot_rewrite.rewriters.vocabulary import FORMS, KINDS, TYPES
from multibot_rewrite.rewriters.vocabulary.grammar import OPTIONS, ROLES, SETTINGS

GUIDE = (ROOT / "docs" / "add-a-plugin.md").read_text()
# What stands before a block, the language of the block, its text.
_BLOCK = re.compile(r"([^\n]*)\n\n```(\w*)\n(.*?)```\n", re.DOTALL)
_NAMED = re.compile(r"`([\w./-]+)`[^`]*:$")
COMMANDS = {
    "urdf-postfix": "-m multibot_rewrite.cli.urdf_postfix",
    "multibot": "-m multibot_rewrite.cli.multibot",
    "pip": "-m pip",
    "python": "",
}


class Block(NamedTuple):
    """A block of code on the page; ``file`` is the file it is the content of, if any."""

    file: str
    language: str
    text: str


def blocks() -> list[Block]:
    """The blocks of the page in their order."""
    found = []
    for before, language, text in _BLOCK.findall(GUIDE):
        named = _NAMED.search(before) if language not in ("sh", "console") else None
        found.append(Block(named[1] if named else "", language, text))
    return found


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    """Where the page's commands are those of this interpreter, and pip installs offline."""
    bin_ = tmp_path / "bin"
    bin_.mkdir()
    for name, words in COMMANDS.items():
        (bin_ / name).write_text(f'#!/bin/sh\nexec "{sys.executable}" {words} "$@"\n')
        (bin_ / name).chmod(0o755)
    site = tmp_path / "site"
    path = [str(site), str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])]
    pip = {"TARGET": str(site), "NO_INDEX": "1", "NO_DEPS": "1", "NO_BUILD_ISOLATION": "0"}
    return {
        **os.environ,
        **{f"PIP_{key}": value for key, value in pip.items()},
        "PIP_DISABLE_PIP_VERSION_CHECK": "1",
        "PATH": f"{bin_}{os.pathsep}{os.environ['PATH']}",
        "PYTHONPATH": os.pathsep.join(path),
    }


def clone(folder: Path) -> None:
    """What the last step needs of this project, as if cloned into ``folder``."""
    folder.mkdir()
    shutil.copy(ROOT / "pyproject.toml", folder)
    (folder / "docs").mkdir()
    for name in ("multibot_rewrite", "tests", "fixtures"):
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))


def run(text: str, folder: Path, environment: dict[str, str]) -> str:
    """Run a script of the page; returns both streams as a terminal would show them."""
    done = subprocess.run(
        ["sh", "-ec", text],
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    assert done.returncode == 0, f"{text}\n{done.stdout}"
    return done.stdout


def check_console(text: str, folder: Path, environment: dict[str, str]) -> None:
    """Each ``$ command`` prints the lines below it, no more and no less."""
    for entry in re.split(r"^\$ ", text, flags=re.MULTILINE)[1:]:
        command, _, expected = entry.partition("\n")
        assert run(command, folder, environment) == expected, command


def test_the_page_works_as_written(tmp_path: Path, environment: dict[str, str]) -> None:
    folder = tmp_path / "work"
    folder.mkdir()
    clone(folder / "multibot_rewrite")
    for block in blocks():
        if block.language == "console":
            check_console(block.text, folder, environment)
        elif block.language == "sh":
            # What is installed by now must not stand in for what is contributed.
            own = environment if "cd " not in block.text else without_site(environment)
            run(block.text, folder, own)
        else:
            (folder / block.file).parent.mkdir(exist_ok=True)
            (folder / block.file).write_text(block.text)
    page = (folder / "multibot_rewrite" / "docs" / "plugins.md").read_text()
    assert "### plugin acme_winch\n" in page


def without_site(environment: dict[str, str]) -> dict[str, str]:
    """The environment of a clone, where nothing else is installed."""
    return {**environment, "PYTHONPATH": os.environ.get("PYTHONPATH", "")}


def test_every_block_is_a_file_or_a_script() -> None:
    assert GUIDE.count("```") == 2 * len(blocks())
    assert [b.text for b in blocks() if not b.file and b.language not in ("sh", "console")] == []
    assert len([b for b in blocks() if b.file]) >= 6


def test_the_page_and_the_grammar_name_every_word() -> None:
    words = {*ROLES, *KINDS, *FORMS, *SETTINGS}
    assert sorted(word for word in words if not re.search(rf"`{word}[` ]", GUIDE)) == []
    assert [option for option in OPTIONS if f"{option}=" not in GUIDE] == []
    grammar = vocabulary.__doc__ or ""
    forms = [f"form={form}" for form in FORMS]
    wanted = [*forms, *(f"    {s}: " for s in SETTINGS), *(f"[{t} " for t in TYPES)]
    assert [word for word in (*wanted, *(f"{o}=" for o in OPTIONS)) if word not in grammar] == []
