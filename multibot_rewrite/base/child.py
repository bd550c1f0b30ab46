# SPDX-License-Identifier: Apache-2.0
"""Child processes: how each is started, without modules of the current folder or git's hooks."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence

from multibot_rewrite.base.start import module as start

_START = os.path.abspath(start.__file__)
# A collection would write to every page that a fork shares with its parent.
_ISOLATED = (
    "import gc, json, sys; gc.disable(); sys.path[:] = json.loads(sys.argv[1]);"
    " from {} import main; main()"
)
_PATHS = "PYTHONPATH"
# What of a repository's configuration would start a program, and what that is set to.
_QUIET = {
    "core.fsmonitor": "false",
    "core.hooksPath": os.devnull,
    "core.pager": "cat",
    "core.sshCommand": "false",
    "diff.external": "",
}
# No object that is missing is fetched: the remote's address and the program behind it are the
# repository's own.
_ALONE = {
    "GIT_OPTIONAL_LOCKS": "0",
    "GIT_TERMINAL_PROMPT": "0",
    "GIT_NO_LAZY_FETCH": "1",
    "GIT_ALLOW_PROTOCOL": "",
}
_FILTERS = r"^filter\..*\.(clean|smudge|process|required)$"


def python(module: str, *words: str) -> list[str]:
    """Return the command that runs a module of this package in a process of its own."""
    return [sys.executable, _START, module, *words]


def isolated(module: str) -> list[str]:
    """Return the command that runs ``main`` of a module in a process without Python's variables."""
    paths = json.dumps(start.safe_path(sys.path, os.getcwd()))
    quiet = ["-B"] if sys.dont_write_bytecode else []
    prefix = sys.pycache_prefix
    compiled = ["-X", f"pycache_prefix={os.path.abspath(prefix)}"] if prefix else []
    command = [sys.executable, "-I", *quiet, *compiled, "-X", "utf8"]
    return [*command, "-c", _ISOLATED.format(module), paths]


def variables(given: Mapping[str, str] = os.environ) -> dict[str, str]:
    """Return the environment for a child of Python, without relative folders in PYTHONPATH."""
    found = dict(given)
    paths = [it for it in found.get(_PATHS, "").split(os.pathsep) if os.path.isabs(it)]
    if _PATHS in found:
        found[_PATHS] = os.pathsep.join(paths)
    return found


def git(where: str, *words: str, given: bytes = b"") -> bytes:
    """Return what git prints in a folder, with ``given`` as its input; runs nothing of the repository.

    Raises OSError, subprocess.CalledProcessError. Of a submodule this holds only where git is asked
    in its folder: its filters are its own."""
    try:
        listed = _git(where, {}, ("config", "--null", "--name-only", "--get-regexp", _FILTERS))
    except subprocess.CalledProcessError:  # it has none, or is no repository
        listed = b""
    names = filter(None, os.fsdecode(listed).split("\0"))
    # The filters are switched off: git would run them on each file that it compares.
    filters = {it: "false" if it.endswith(".required") else "" for it in names}
    return _git(where, filters, words, given)


def _git(where: str, more: Mapping[str, str], words: Sequence[str], given: bytes = b"") -> bytes:
    """Return what git prints, with ``more`` settings than those that switch hooks and the like off."""
    settings = [part for it in {**_QUIET, **more}.items() for part in ("-c", "=".join(it))]
    command = ["git", "-C", where, "--no-pager", *settings, *words]
    environ = {**os.environ, **_ALONE}
    return subprocess.run(command, input=given, capture_output=True, check=True, env=environ).stdout
