# SPDX-License-Identifier: Apache-2.0
"""Commands that a page shows with what they print: read from it, and run as a reader would.

A block ``console`` has lines ``$ COMMAND``, each with some lines of what it prints, in order; ``...``
stands for a part of a line, ``[exit code 1]`` is of what does not end with 0.
"""

from __future__ import annotations

import io
import os
import re
import shlex
import subprocess
import sys
import threading
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import redirect_stderr, redirect_stdout
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

import live_commands
import live_fleet
import pytest
from paths import ROOT

MODULES = {
    "multibot": "multibot_rewrite.cli.multibot",
    "urdf-postfix": "multibot_rewrite.cli.urdf_postfix",
    "urdf-lint": "multibot_rewrite.cli.urdf_lint",
}
SAVED = re.compile(r"[Ss]ave it as `([\w.-]+)`:\n\n```\w+\n(.*?)^```$", re.S | re.M)
_STEP = re.compile(rf"{SAVED.pattern}|(^```console\n.*?^```$)", re.S | re.M)
_LEFT_OUT = "..."
_CODE = re.compile(r"\[exit code (\d+)\]")
_IN_SHELL = re.compile(r"[|&;<>$*?`\n]")
# Needs rclpy, and a domain of its own.
LIVE = "multibot rehearse"


class Shown(NamedTuple):
    """A command, what is shown of its output, its exit code."""

    command: str
    lines: tuple[str, ...]
    code: int


def sections(text: str) -> dict[str, list[Shown]]:
    """Return the commands of a page by the heading they are below."""
    found: dict[str, list[Shown]] = {}
    heading = ""
    # A heading, or a block, in which a line may begin as a heading does.
    for title, kind, block in re.findall(
        r"^(?:#+ ([^\n]*)$|```(\w*)\n(.*?)^```$)", text, re.MULTILINE | re.DOTALL
    ):
        heading = title or heading
        if kind == "console":
            found.setdefault(heading, []).extend(_commands(block))
    return found


def _commands(block: str) -> Iterator[Shown]:
    start, *parts = re.split(r"^\$ ", block, flags=re.MULTILINE)
    assert not start.strip(), f"a block starts without a command: {start}"
    for part in parts:
        command, *lines = part.rstrip("\n").split("\n")
        codes = [int(found[1]) for it in lines if (found := _CODE.fullmatch(it))]
        shown = [it for it in lines if not _CODE.fullmatch(it)]
        yield Shown(command, tuple(shown), codes[0] if codes else 0)


def is_live(commands: Sequence[Shown]) -> bool:
    """Do some of them start nodes?"""
    return any(it.command.startswith(LIVE) for it in commands)


def has_ros() -> bool:
    """Can nodes be started here?"""
    try:
        return find_spec("rclpy.impl") is not None
    except ImportError:
        return False


class Reader(NamedTuple):
    """Somebody who tries a page, in a folder with what the repository has."""

    folder: Path
    environ: Mapping[str, str]

    def run(self, command: str) -> subprocess.CompletedProcess[str]:
        """Return what the command does here: in this process where one of its own adds nothing."""
        program, *words = shlex.split(command)
        alone = threading.current_thread() is threading.main_thread()
        if alone and program in MODULES and not (_IN_SHELL.search(command) or LIVE in command):
            return self._run_here(program, words)
        return subprocess.run(
            ["bash", "-c", command],
            cwd=self.folder,
            env=self.environ,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
            timeout=200,
        )

    def _run_here(self, program: str, words: Sequence[str]) -> subprocess.CompletedProcess[str]:
        printed = io.TextIOWrapper(io.BytesIO(), encoding="utf-8", write_through=True)
        with (
            pytest.MonkeyPatch.context() as patch,
            redirect_stdout(printed),
            redirect_stderr(printed),
        ):
            patch.chdir(self.folder)
            for name in os.environ.keys() - self.environ.keys():
                patch.delenv(name)
            for name, value in self.environ.items():
                patch.setenv(name, value)
            try:
                code = import_module(MODULES[program]).main(words)
            except SystemExit as error:
                code = error.code
        text = printed.buffer.getvalue().decode()  # type: ignore[attr-defined]
        return subprocess.CompletedProcess([program, *words], code, text)


def reader(folder: Path, domain: int = 1, **more: str) -> Reader:
    """Return a reader in ``folder``, whose nodes meet in ``domain`` only."""
    for name in ("examples", "fixtures", "README.md"):
        (folder / name).symlink_to(ROOT / name)
    programs = folder / ".bin"
    programs.mkdir()
    for name, module in MODULES.items():
        file = programs / name
        own = (
            f" --domain {domain} {' '.join(live_commands.PATIENTLY)}" if name == "multibot" else ""
        )
        rest = f'if [ "$1" = rehearse ]; then set -- "$@"{own}; fi\n' if own else ""
        file.write_text(f'#!/bin/bash\n{rest}exec "{sys.executable}" -m {module} "$@"\n')
        file.chmod(0o755)
    environ = {**live_fleet.environ(domain), **more}
    path = os.pathsep.join([str(programs), environ.get("PATH", "")])
    return Reader(folder, {**environ, "PATH": path, "COLUMNS": "200", "LC_ALL": "C.UTF-8"})


def steps(text: str, there: Reader) -> Iterator[tuple[Shown, subprocess.CompletedProcess[str]]]:
    """Yield what the commands of a page do in turn; its files are saved where it says so."""
    for file, saved, block in _STEP.findall(text):
        if file:
            (there.folder / file).write_text(saved)
            continue
        for it in sections(block)[""]:
            if has_ros() or not is_live([it]):
                yield it, there.run(it.command)


Tried = Mapping[str, Sequence[tuple[Shown, subprocess.CompletedProcess[str]]]]


def tried(
    pages: Mapping[str, Sequence[Shown]], folder: Path, offset: int, more: Mapping[str, str]
) -> Tried:
    """Return what the commands of each part of a page do, each part in a folder and domain of its
    own.

    Rehearsals are tried side by side: most of one is waiting. Those that need rclpy are left out where
    there is none.
    """
    names = [it for it in pages if has_ros() or not is_live(pages[it])]
    readers = []
    for at, _ in enumerate(names):
        own = folder / str(at)
        own.mkdir()
        readers.append(reader(own, live_commands.domain(offset + at), **more))

    def one(name: str, there: Reader) -> list[tuple[Shown, subprocess.CompletedProcess[str]]]:
        return [(it, there.run(it.command)) for it in pages[name]]

    live = [it for it in zip(names, readers, strict=True) if is_live(pages[it[0]])]
    here = [it for it in zip(names, readers, strict=True) if it not in live]
    with ThreadPoolExecutor(6) as pool:
        found = list(pool.map(lambda it: one(*it), live))
    return {
        name: it
        for (name, _), it in zip([*here, *live], [*(one(*it) for it in here), *found], strict=True)
    }


def assert_as_shown(name: str, found: Tried) -> None:
    """Assert that the commands of a part end as shown, and print the shown lines in their order."""
    if name not in found:
        pytest.skip("no rclpy: pip install '.[ros]'")
    for it, done in found[name]:
        printed = done.stdout
        assert done.returncode == it.code, f"{it.command}\n{printed}"
        rest = [line.rstrip() for line in printed.splitlines()]
        after = -1
        for line in it.lines:
            places = (at for at in range(after + 1, len(rest)) if _like(line.rstrip(), rest[at]))
            after = next(places, -1)
            assert after >= 0, f"{it.command}\nshown: {line}\nprinted:\n{printed}"


def _like(shown: str, printed: str) -> bool:
    # A file that an earlier page has built as it is now is not written again.
    shown, printed = (re.sub(r"\d+ written", "N written", it) for it in (shown, printed))
    parts = shown.split(_LEFT_OUT)
    return re.fullmatch(".*".join(map(re.escape, parts)), printed) is not None
