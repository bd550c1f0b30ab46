"""Files of a package that a command changes: all written or none, or shown as a patch."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Mapping

from multibot_rewrite.cli.files import write_all
from multibot_rewrite.cli.output import diff, is_coloured, print_bytes


def deliver_changed(
    options: argparse.Namespace,
    before: Mapping[str, bytes],
    after: Mapping[str, bytes],
    write: bool,
) -> None:
    """Write the files, or print what ``git apply`` takes in this folder."""
    if write:
        write_all(after.items())
        return
    colour = is_coloured(options.color, sys.stdout)
    for path, data in after.items():
        name = os.path.relpath(path)
        print_bytes(diff(before[path], data, f"a/{name}", f"b/{name}", colour))
