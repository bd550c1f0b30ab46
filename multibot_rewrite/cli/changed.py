# SPDX-License-Identifier: Apache-2.0
"""Files of a package that a command changes: all written or none, or shown as a patch."""

from __future__ import annotations

import argparse
import os
from collections.abc import Mapping

from multibot_rewrite.base.wording import plural
from multibot_rewrite.cli.files import write_all
from multibot_rewrite.cli.output import deliver, diff, note, prints_colour


def deliver_changed(
    options: argparse.Namespace,
    before: Mapping[str, bytes],
    after: Mapping[str, bytes],
    write: bool,
) -> None:
    """Write the files, or what ``git apply`` takes in this folder: to ``-o``, or printed."""
    if write:
        write_all(after.items())
        return
    colour = prints_colour(options)
    names = {path: os.path.relpath(path) for path in after}
    patches = (
        diff(before[path], data, f"a/{names[path]}", f"b/{names[path]}", colour)
        for path, data in after.items()
    )
    deliver(options, b"".join(patches))


def proof_words(unread: Mapping[str, str]) -> str:
    """Return the word for a change that is proved, with how many descriptions were not read for it."""
    return f"proved, {plural(len(unread), 'description')} not read" if unread else "proved"


def note_unread(options: argparse.Namespace, unread: Mapping[str, str]) -> None:
    """Name the descriptions that could not be read, each with the reason."""
    for path, why in unread.items():
        note(options, f"not looked at: {why or path}")
