"""Commands that a page shows with what they print: read from it, and run as a reader would.

A block ``console`` has lines ``$ COMMAND``, each with lines of what it prints, in order; ``...``
stands for lines left out, in a line for a part of it; ``[exit code 1]`` is of what does not end with 0.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

import live_fleet

ROOT = Path(__file__).parent.parent
MODULES = {
    "multibot": "multibot_rewrite.cli.multibot",
    "urdf-postfix": "multibot_rewrite.cli.urdf_postfix",
    "urdf-lint": "multibot_rewrite.cli.urdf_lint",
}
_LEFT_OUT = "..."
_CODE = re.compile(r"\[exit code (\d+)\]")
# Needs rclpy, and a domain of its own.
LIVE = "multibot rehearse"


class Shown(NamedTuple):
    """A command, what is shown of its output, its exit code."""

    command: str
    lines: tuple[str, ...]
    code: int


def sections(text: str) -> dict[str, list[Shown]]:
    """The commands of a page by the heading they are below."""
    found: dict[str, list[Shown]] = {}
    for part in re.split(r"^#+ (?=.*\n)", "\n" + text, flags=re.MULTILINE)[1:]:
        heading, _, body = part.partition("\n")
        blocks = re.findall(r"^```console\n(.*?)^```", body, re.MULTILINE | re.DOTALL)
        commands = [it for block in blocks for it in _commands(block)]
        if commands:
            found.setdefault(heading, []).extend(commands)
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
    return find_spec("rclpy") is not None


class Reader(NamedTuple):
    """Somebody who tries a page, in a folder with what the repository has."""

    folder: Path
    environ: Mapping[str, str]

    def run(self, command: str) -> subprocess.CompletedProcess[str]:
        """What the command does here."""
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


def reader(folder: Path, domain: int = 1, **more: str) -> Reader:
    """A reader in ``folder``, whose nodes meet in ``domain`` only."""
    for name in ("examples", "fixtures", "README.md"):
        (folder / name).symlink_to(ROOT / name)
    programs = folder / ".bin"
    programs.mkdir()
    for name, module in MODULES.items():
        file = programs / name
        own = f" --domain {domain}" if name == "multibot" else ""
        rest = f'if [ "$1" = rehearse ]; then set -- "$@"{own}; fi\n' if own else ""
        file.write_text(f'#!/bin/bash\n{rest}exec "{sys.executable}" -m {module} "$@"\n')
        file.chmod(0o755)
    environ = {**live_fleet.environ(domain), **more}
    path = os.pathsep.join([str(programs), environ.get("PATH", "")])
    return Reader(folder, {**environ, "PATH": path, "COLUMNS": "200", "LC_ALL": "C.UTF-8"})


def assert_as_shown(it: Shown, there: Reader) -> None:
    """The command ends as shown, and prints the shown lines in their order."""
    done = there.run(it.command)
    printed = done.stdout
    assert done.returncode == it.code, f"{it.command}\n{printed}"
    rest = [line.rstrip() for line in printed.splitlines()]
    after = -1
    for line in filter(lambda one: one.strip() != _LEFT_OUT, it.lines):
        places = (at for at in range(after + 1, len(rest)) if _like(line.rstrip(), rest[at]))
        after = next(places, -1)
        assert after >= 0, f"{it.command}\nshown: {line}\nprinted:\n{printed}"


def _like(shown: str, printed: str) -> bool:
    parts = shown.split(_LEFT_OUT)
    return re.fullmatch(".*".join(map(re.escape, parts)), printed) is not None
