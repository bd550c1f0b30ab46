# SPDX-License-Identifier: Apache-2.0
"""Pages that are followed step by step: their files are written, their commands run and compared.

A block of code is a step, and the end of the paragraph before it says which:

    `FILE`:                 the block is the whole file (words may stand around the name)
    `FILE` in `FOLDER`:     so it is, for a file that is in no repository yet
    At the end of `FILE`:   it is added there, behind a blank line or, in Python, two
    In `FILE`, below        it is there once already, and the next block is added below it
    (``sh``)                a script that has to succeed
    (``console``)           ``$ COMMAND`` and all that it prints; ``...`` is any part of a line, or
                            alone any number of lines; ``[exit code 1]`` ends one that fails
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

from paths import ROOT

PROGRAMS = {
    "urdf-postfix": "-m multibot_rewrite.cli.urdf_postfix",
    "urdf-lint": "-m multibot_rewrite.cli.urdf_lint",
    "multibot": "-m multibot_rewrite.cli.multibot",
    "pip": "-m pip",
    "python": "",
}
_BLOCK = re.compile(r"^((?:[^\n]+\n)*)\n(`{3,})(\w*)\n(.*?)^\2$", re.DOTALL | re.MULTILINE)
_KINDS = (
    ("append", re.compile(r"At the end of `([\w./-]+)`:$")),
    ("anchor", re.compile(r"In `([\w./-]+)`, below$")),
    ("insert", re.compile(r"()add$")),
    ("write", re.compile(r"`([\w.-]+)` in `([\w./-]+)`:$")),
    ("write", re.compile(r"`([\w./-]+)`[^`]*:$")),
)
_CODE = re.compile(r"\[exit code (\d+)\]\n")


class Step(NamedTuple):
    """``kind`` is append, anchor, insert, write, sh, console or, where nothing says so, empty."""

    kind: str
    file: str
    text: str


def steps(page: str) -> list[Step]:
    """Return the blocks of a page in their order."""
    return [_step(before, language, text) for before, _, language, text in _BLOCK.findall(page)]


def _step(before: str, language: str, text: str) -> Step:
    if language in ("sh", "console"):
        return Step(language, "", text)
    words = " ".join(before.split())
    found = ((kind, it) for kind, pattern in _KINDS if (it := pattern.search(words)))
    kind, file = next(((kind, "/".join(it.groups()[::-1])) for kind, it in found), ("", ""))
    return Step(kind, file, text)


def follow(page: Iterable[Step], folder: Path, environ: Mapping[str, str]) -> None:
    """Do what the steps say, in ``folder``; AssertionError where one does not do as shown."""
    anchor = Step("", "", "")
    for step in page:
        if step.kind == "console":
            check_console(step.text, folder, environ)
        elif step.kind == "sh":
            done = run(step.text, folder, environ)
            assert done.returncode == 0, f"{step.text}\n{done.stdout}"
        elif step.kind == "anchor":
            anchor = step
        else:
            _edit(folder / (step.file or anchor.file), step, anchor.text)


def _edit(file: Path, step: Step, anchor: str) -> None:
    assert step.kind, f"nothing says what this block is for:\n{step.text}"
    if step.kind == "write":
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(step.text)
        return
    old = file.read_text()
    if step.kind == "append":
        file.write_text(old + "\n" * (2 if file.suffix == ".py" else 1) + step.text)
        return
    assert old.count(anchor) == 1, f"{file}: {old.count(anchor)} times\n{anchor}"
    file.write_text(old.replace(anchor, anchor + step.text))


def check_console(text: str, folder: Path, environ: Mapping[str, str]) -> None:
    """Each ``$ command`` prints the lines below it, no more and no less, and ends as shown."""
    start, *entries = re.split(r"^\$ ", text, flags=re.MULTILINE)
    assert not start, f"a block starts without a command: {start}"
    for entry in entries:
        command, _, shown = entry.partition("\n")
        code = _CODE.search(shown)
        done = run(command, folder, environ)
        assert done.returncode == (int(code[1]) if code else 0), f"{command}\n{done.stdout}"
        printed = re.fullmatch(_pattern(_CODE.sub("", shown)), done.stdout)
        assert printed, f"{command}\nshown:\n{shown}\nprinted:\n{done.stdout}"


def _pattern(shown: str) -> str:
    rows = (
        "(?:.*\n)*" if row == "..." else ".*".join(map(re.escape, row.split("..."))) + "\n"
        for row in shown.splitlines()
    )
    return "".join(rows)


def run(script: str, folder: Path, environ: Mapping[str, str]) -> subprocess.CompletedProcess[str]:
    """Run a script; both streams come as a terminal would show them."""
    return subprocess.run(
        ["sh", "-ec", script],
        cwd=folder,
        env=environ,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )


def environment(folder: Path) -> dict[str, str]:
    """Where the commands of a page are those of this interpreter; they are put into ``folder``.

    A command run in a copy of the repository runs that copy.
    """
    folder.mkdir()
    for name, words in PROGRAMS.items():
        (folder / name).write_text(f'#!/bin/sh\nexec "{sys.executable}" {words} "$@"\n')
        (folder / name).chmod(0o755)
    path = f"{folder}{os.pathsep}{os.environ['PATH']}"
    return {**os.environ, "PATH": path, "COLUMNS": "100", "LC_ALL": "C.UTF-8"}


def copy_repository(folder: Path) -> None:
    """Copy what git knows of, or would take, as if cloned into ``folder``."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for name in filter(None, listed.split("\0")):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, folder / name)
