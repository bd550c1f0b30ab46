# SPDX-License-Identifier: Apache-2.0
"""Where the programs begin. Until a command runs, Ctrl-C ends the process without a word: nothing is
written yet, and Python's traceback would tell of imports. ``guarded`` takes over."""

from __future__ import annotations

import gc
import signal
from importlib import import_module

_COMMANDS = "multibot_rewrite.cli"


def multibot() -> int:
    """The program ``multibot``."""
    return _run("multibot")


def urdf_postfix() -> int:
    """The program ``urdf-postfix``."""
    return _run("urdf_postfix")


def urdf_lint() -> int:
    """The program ``urdf-lint``."""
    return _run("urdf_lint")


def _run(name: str) -> int:
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    gc.disable()
    code: int = import_module(f"{_COMMANDS}.{name}").main()
    return code
