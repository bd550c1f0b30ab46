# SPDX-License-Identifier: Apache-2.0
"""Parameter files that a launch file fills in: ``$(var prefix)`` before the names of the robot.

Source: launch_ros parameter_descriptions.py (``ParameterFile``: with ``allow_substs`` the text of the
file is a substitution). What else reads the file, as a plugin of Gazebo, would take it as it is, so one
launch file alone may name it.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress

from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.names.rename_map import KINDS
from multibot_rewrite.description.joining.part import PREFIXED
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.fleet.one_file import names_in_file


class Filled(NamedTuple):
    """A parameter file as it is, as it becomes, and what it is with the prefix that is tried."""

    path: str
    before: bytes
    after: bytes
    tried: bytes


def fillable(
    paths: Sequence[str],
    urdfs: Sequence[bytes],
    names: Collection[str],
    argument: str,
    tried: str,
) -> Mapping[str, Filled]:
    """The parameter files that have some of the names of the descriptions ``urdfs``, by their own
    names; those that two have are left out."""
    own = [os.path.basename(it) for it in paths]
    found: dict[str, Filled] = {}
    for path in paths:
        data, name = read_file(path), os.path.basename(path)
        # A file with substitutions is filled in already.
        if own.count(name) > 1 or b"$(" in data or not urdfs:
            continue
        with suppress(MultibotError):
            file = names_in_file(data, path, urdfs[0])
            starts = set(starts_of(file, names, PREFIXED))
            if starts:
                words = (f"$(var {argument})", tried)
                texts = (respelled(file, data, starts, 0, it) for it in words)
                found[name] = Filled(path, data, *texts)
    return found


def starts_of(file: NamedFile, names: Collection[str], kinds: Collection[str]) -> Iterator[int]:
    """Where in the text of a file names of these kinds begin."""
    for site in file.names:
        if site.text in names and not {site.kind, *KINDS.get(site.kind, ())}.isdisjoint(kinds):
            start = file.text.find(site.text, site.slot.start + site.at, site.slot.end)
            if start >= 0:
                yield start


def respelled(file: NamedFile, data: bytes, starts: Collection[int], size: int, word: str) -> bytes:
    """The bytes of a file with a word in place of so many characters from each start of its text."""
    text = file.text
    # A byte order mark is none of the text.
    mark = data[: len(data) - len(text.encode())]
    for at in sorted(starts, reverse=True):
        text = text[:at] + word + text[at + size :]
    return mark + text.encode()
