# SPDX-License-Identifier: Apache-2.0
"""Runs ``urdf-postfix`` as a person does, and looks at what one run left behind."""

from __future__ import annotations

import contextlib
import os
import pty
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

COMMAND = (sys.executable, "-m", "multibot_rewrite.cli.urdf_postfix")
# For a busy machine.
PATIENCE = 120
TEN = tuple(f"r{number}" for number in range(1, 11))


class Result(NamedTuple):
    """What one run of the command left behind."""

    code: int
    out: bytes
    err: str


def run(
    folder: Path, *words: str, stdin: bytes = b"", env: Mapping[str, str] | None = None
) -> Result:
    """Run the command in ``folder``; ``env`` is added to the environment."""
    # A program that reads both through pipes would hear of failures alone.
    with tempfile.TemporaryFile() as messages:
        done = subprocess.run(
            [*COMMAND, *words],
            cwd=folder,
            input=stdin,
            stdout=subprocess.PIPE,
            stderr=messages,
            check=False,
            timeout=PATIENCE,
            env={**os.environ, **(env or {})},
        )
        messages.seek(0)
        return Result(done.returncode, done.stdout, messages.read().decode())


def run_on_terminal(folder: Path, *words: str, env: Mapping[str, str] | None = None) -> Result:
    """Run the command with its report on a terminal; standard output goes nowhere."""
    ours, theirs = pty.openpty()
    process = subprocess.Popen(
        [*COMMAND, *words],
        cwd=folder,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=theirs,
        env={**_plain_environment(), "TERM": "xterm-256color", **(env or {})},
    )
    os.close(theirs)
    heard = b""
    # The other side hangs up with an error.
    with contextlib.suppress(OSError):
        while chunk := os.read(ours, 65536):
            heard += chunk
    os.close(ours)
    return Result(process.wait(PATIENCE), b"", heard.decode())


def _plain_environment() -> dict[str, str]:
    return {key: value for key, value in os.environ.items() if key not in ("NO_COLOR", "CI")}


def temporaries(folder: Path) -> list[str]:
    """Whatever the command may have left behind, in any folder below."""
    return [str(path) for path in folder.rglob("*") if ".tmp" in path.name]


def contents(folder: Path) -> dict[str, bytes]:
    """Every regular file below ``folder``."""
    files = [path for path in sorted(folder.rglob("*")) if path.is_file()]
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}
