# SPDX-License-Identifier: Apache-2.0
"""Run a module in a process that finds modules where its parent did, and not in the current folder.

``python .../module.py MODULE``: ``python -m`` would put the current folder first, and a
``rclpy.py`` next to somebody's robot would be run. (``-P`` came with Python 3.11, Humble has 3.10.)
"""

from __future__ import annotations

import gc
import os
import runpy
import sys

_ROOT = os.path.dirname(
    os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
)


def safe_path(paths: list[str], here: str) -> list[str]:
    """Return the folders of a search path without the current one, with that of this package."""
    whole = [os.path.abspath(os.path.join(here, it)) for it in paths]
    left = [it for it in whole if it not in (here, os.path.dirname(os.path.abspath(__file__)))]
    return left if _ROOT in left else [_ROOT, *left]


if __name__ == "__main__":
    gc.disable()
    sys.path[:] = safe_path(sys.path, os.getcwd())
    del sys.argv[0]
    runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)
