# SPDX-License-Identifier: Apache-2.0
"""Robot descriptions that real people wrote: what is made for measuring flatters who made it."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "support"))
from real_robots import corpus_files, spread, wheel_files  # the files of the tests

VARIABLE = "MULTIBOT_PUBLIC_FILES"
OPTION = "--files"
# So many of those beside the repository: all of them take minutes.
MOST = 150


class PublicFiles(NamedTuple):
    """The bytes of many URDFs, and where they are from."""

    source: str
    files: tuple[bytes, ...]

    def __str__(self) -> str:
        size = sum(map(len, self.files)) / 1e6
        return f"{len(self.files):,} public files, {size:.1f} MB"


def public_files(arguments: Sequence[str]) -> PublicFiles:
    """Those of the folder that ``--files`` or MULTIBOT_PUBLIC_FILES names, else those of the corpus
    beside the repository, else of the description wheels that the tests install."""
    folder = arguments[arguments.index(OPTION) + 1] if OPTION in arguments else ""
    folder = folder or os.environ.get(VARIABLE, "")
    if folder:
        return _read("a folder of one's own", sorted(Path(folder).rglob("*.urdf")))
    corpus = corpus_files()
    if corpus:
        return _read("the corpus beside the repository", list(spread(corpus, MOST).values()))
    return _read("the description wheels of the tests", list(wheel_files().values()))


def _read(source: str, paths: Sequence[Path]) -> PublicFiles:
    if not paths:
        sys.exit(f"no public files: name a folder of URDFs with {OPTION}, or pip install '.[test]'")
    return PublicFiles(source, tuple(path.read_bytes() for path in paths))
