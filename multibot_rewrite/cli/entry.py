# SPDX-License-Identifier: Apache-2.0
"""Where the programs begin; until a command runs Ctrl-C ends the process with one line.

Python's traceback would tell of imports. ``guarded`` takes over. What is imported here is built
into Python. Before that run its own start and the script that pip writes, which imports re: there
Ctrl-C ends with a traceback of Python's, as in every Python program."""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]  # of which signal makes enumerations: 5 ms
import gc
import os

_COMMANDS = "multibot_rewrite.cli"


def multibot() -> int:
    """Run the program ``multibot``; returns the exit code."""
    return _run("multibot")


def urdf_postfix() -> int:
    """Run the program ``urdf-postfix``; returns the exit code."""
    return _run("urdf_postfix")


def urdf_lint() -> int:
    """Run the program ``urdf-lint``; returns the exit code."""
    return _run("urdf_lint")


def _run(name: str) -> int:
    """Run the ``main`` of a module of commands; return the exit code."""

    def interrupted(*_: object) -> None:
        program = name.replace("_", "-")
        try:
            os.write(2, f"{program}: interrupted; no half-written file is left\n".encode())
        finally:
            os._exit(130)

    if _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler:
        _signal.signal(_signal.SIGINT, interrupted)
    gc.disable()
    from importlib import import_module

    code: int = import_module(f"{_COMMANDS}.{name}").main()
    return code
