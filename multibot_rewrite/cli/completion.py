# SPDX-License-Identifier: Apache-2.0
"""``multibot completion``: what ``share/`` has for a shell, of all programs."""

from __future__ import annotations

import argparse
import os

from multibot_rewrite.base.bounded import read_bytes
from multibot_rewrite.base.config import folders_above
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.cli.declared.commands import PROGRAMS
from multibot_rewrite.cli.output import deliver
from multibot_rewrite.cli.process import DONE, PROGRAM

# Where each shell looks, as pyproject.toml has it installed.
_FILES = {
    "bash": "share/bash-completion/completions/{}",
    "zsh": "share/zsh/site-functions/_{}",
    "fish": "share/fish/vendor_completions.d/{}.fish",
}


def run(options: argparse.Namespace) -> int:
    """Print the files of a shell; returns the exit code."""
    names = [_FILES[options.shell].format(it) for it in (PROGRAM, *PROGRAMS)]
    # pip (also with --user or --target), colcon and a checkout have share/ in a folder above.
    for folder in folders_above(os.path.dirname(__file__)):
        paths = [os.path.join(folder, it) for it in names]
        if all(map(os.path.isfile, paths)):
            deliver(options, b"".join(map(read_bytes, paths)))
            return DONE
    raise UsageError(f"{names[0]} is in no folder above this package; install it by pip or colcon")
