"""What ``Command`` substitutions would print, where that is known without starting their programs.

A xacro file is expanded behind the boundary that all xacro files have, and ``urdf-postfix`` is this
package's own. Other programs are not started: their output is empty. Source: launch jazzy,
substitutions/command.py (the line is split as a shell does), find_executable.py.
"""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from types import MappingProxyType
from typing import Any

from multibot_rewrite.launch.door import of_launch
from multibot_rewrite.model import MultibotError
from multibot_rewrite.sources.access import SECONDS
from multibot_rewrite.sources.expand import expand
from multibot_rewrite.sources.read import read_file

_POSTFIX = (sys.executable, "-m", "multibot_rewrite.cli.urdf_postfix")
# Its options that write no other file; each has a value.
_OPTIONS = frozenset(
    ("--layout", "--affix", "--separator", "--topics", "--shared-frames", "--distro")
)


def read_commands() -> None:
    """From now on ``Command`` gives what is known of its output, and no program has to be there."""
    known = of_launch("substitutions")
    known.Command.perform = lambda self, context: output_of(_text(self.command, context))
    known.FindExecutable.perform = lambda self, context: _text(self.name, context)


@lru_cache
def output_of(line: str) -> str:
    """What a program prints; empty where that is not known."""
    try:
        program, *words = shlex.split(line)
        read = _READERS.get(os.path.basename(program))
        return read(words) if read else ""
    except (ValueError, MultibotError, subprocess.SubprocessError):
        # A launch fails here, or cannot be tried: what it says is not known.
        return ""


def _xacro(words: Sequence[str]) -> str:
    files = [it for it in words if ":=" not in it and not it.startswith("-")]
    arguments = dict(it.split(":=", 1) for it in words if ":=" in it)
    return expand(files[0], arguments).decode() if len(files) == 1 else ""


def _cat(words: Sequence[str]) -> str:
    return "".join(read_file(it).decode("utf-8", "replace") for it in words)


def _postfix(words: Sequence[str]) -> str:
    if any(it.startswith("-") and it.partition("=")[0] not in _OPTIONS for it in words):
        return ""
    line = [*_POSTFIX, *words]
    done = subprocess.run(line, capture_output=True, text=True, timeout=SECONDS, check=False)
    return done.stdout if done.returncode == 0 else ""


_READERS: Mapping[str, Callable[[Sequence[str]], str]] = MappingProxyType(
    {"xacro": _xacro, "cat": _cat, "urdf-postfix": _postfix}
)


def _text(value: Any, context: Any) -> str:
    return str(of_launch("utilities").perform_substitutions(context, value))
