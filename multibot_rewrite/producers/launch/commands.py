# SPDX-License-Identifier: Apache-2.0
"""What ``Command`` substitutions would print, where that is known without starting their programs.

A xacro file is expanded behind the boundary that all xacro files have, and ``urdf-postfix`` is this
package's own. Other programs are not started: their output is empty. Source: launch jazzy,
substitutions/command.py (the line is split as a shell does), find_executable.py.
"""

from __future__ import annotations

import os
import shlex
import subprocess
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache, wraps
from shutil import which
from types import MappingProxyType
from typing import Any

from multibot_rewrite.base.child import python, variables
from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.sources.access import SECONDS
from multibot_rewrite.description.sources.expand import expand
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.producers.launch.describe import text
from multibot_rewrite.producers.launch.door import of_launch
from multibot_rewrite.producers.launch.source_packages import NOT_INSTALLED

_POSTFIX = "multibot_rewrite.cli.urdf_postfix"
_FAULTS = "multibot_command_faults"
# Its options that write no other file; each has a value.
_OPTIONS = frozenset(("--layout", "--affix", "--separator", "--topics", "--shared", "--distro"))


class Output(NamedTuple):
    """What a program prints, empty where that is not known; and why, where it ought to be known."""

    text: str
    fault: str = ""


def read_commands() -> list[str]:
    """From now on ``Command`` gives what is known of its output, and no program has to be there. So
    does ``subprocess.run``, where it is not there; what is not known of its output is in the list."""
    known = of_launch("substitutions")
    lost: list[str] = []
    known.Command.perform = _perform
    known.FindExecutable.perform = lambda self, context: text(self.name, context)
    subprocess.run = _run(subprocess.run, lost)
    return lost


def _run(run: Callable[..., Any], lost: list[str]) -> Callable[..., Any]:
    """``subprocess.run``, which ``check_output`` calls as well."""

    @wraps(run)
    def ran(line: Any, *words: Any, **options: Any) -> Any:
        program = str(line[0]) if isinstance(line, list | tuple) and line else ""
        if program not in _READERS or which(program):
            return run(line, *words, **options)
        found = output_of(shlex.join(map(str, line)))
        lost.extend({found.fault} - {"", *lost})
        as_text = any(options.get(it) for it in ("text", "universal_newlines", "encoding"))
        out = found.text if as_text else found.text.encode()
        return subprocess.CompletedProcess(line, 0, out, out[:0])

    return ran


def faults(context: Any) -> list[str]:
    """What went wrong in the outputs that a launch asked for."""
    return [*context.get_locals_as_dict().get(_FAULTS, ())]


def _perform(self: Any, context: Any) -> str:
    found = output_of(text(self.command, context))
    if found.fault and found.fault not in faults(context):
        context.extend_globals({_FAULTS: [*faults(context), found.fault]})
    return found.text


@lru_cache
def output_of(line: str) -> Output:
    """What a program prints."""
    try:
        program, *words = shlex.split(line)
        read = _READERS.get(os.path.basename(program))
        return Output(read(words) if read else "")
    except (ValueError, MultibotError, subprocess.SubprocessError) as error:
        # A launch fails here, unless it is the boundary, or a package that is told, that is in the way.
        if NOT_INSTALLED in line:
            return Output("")
        reason = " ".join(f"{error}".split())
        return Output("", f"the output of {line!r} is not known: {reason}")


def _xacro(words: Sequence[str]) -> str:
    files = [it for it in words if ":=" not in it and not it.startswith("-")]
    arguments = dict(it.split(":=", 1) for it in words if ":=" in it)
    return expand(files[0], arguments).decode() if len(files) == 1 else ""


def _cat(words: Sequence[str]) -> str:
    return "".join(read_file(it).decode("utf-8", "replace") for it in words)


def _postfix(words: Sequence[str]) -> str:
    if any(it.startswith("-") and it.partition("=")[0] not in _OPTIONS for it in words):
        return ""
    line = python(_POSTFIX, *words)
    done = subprocess.run(
        line, env=variables(), capture_output=True, text=True, timeout=SECONDS, check=False
    )
    if done.returncode:
        raise ValueError(done.stderr)
    return done.stdout


_READERS: Mapping[str, Callable[[Sequence[str]], str]] = MappingProxyType(
    {"xacro": _xacro, "cat": _cat, "urdf-postfix": _postfix}
)
