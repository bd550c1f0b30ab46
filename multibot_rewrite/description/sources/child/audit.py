# SPDX-License-Identifier: Apache-2.0
"""The fence that needs no kernel: Python tells a hook what is about to be done, and it says no.

It is for good messages, and for systems without the fences of Linux. Alone it is no strong boundary:
whoever gets at the memory of the process gets around it. Source: docs.python.org, "Audit events table".
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from typing import NoReturn

# What remains of os: all else works on files, processes or descriptors, and some of it without event.
_KEPT = frozenset(
    ("environ", "environb", "error", "fsencode", "fsdecode", "fspath", "getcwd", "getenv", "path")
)


def enclose() -> bool:
    """Refuse everything but computing, for as long as the process lives."""
    for module in (os, sys.modules.get("posix")):
        for name, value in list(vars(module).items()) if module else ():
            if callable(value) and name not in _KEPT and not isinstance(value, type):
                setattr(module, name, _refusing(name))
    sys.addaudithook(_refuse)
    return True


def _refusing(name: str) -> Callable[..., NoReturn]:
    def refuse(*arguments: object, **_: object) -> NoReturn:
        raise PermissionError(f"refused: os.{name}{str(arguments)[:80]}")

    return refuse


def _refuse(event: str, arguments: tuple[object, ...]) -> None:
    # Constants of the code alone: there is nothing that a file could change.
    if event not in {"compile", "exec", "builtins.id", "object.__getattr__", "array.__new__"}:
        raise PermissionError(f"refused: {event} {str(arguments)[:80]}")
