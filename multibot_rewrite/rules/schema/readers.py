# SPDX-License-Identifier: Apache-2.0
"""Who reads a description in a release, and which version of URDF (``readers.schema``)."""

from __future__ import annotations

from functools import lru_cache

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.rules.schema.described import table_text
from multibot_rewrite.rules.schema.versions import OLDEST, Version, read_version

_FILE = "readers.schema"
URDFDOM, RVIZ, SDFORMAT, CAPSULE = "urdfdom", "RViz", "sdformat", "capsule"


class Reader(NamedTuple):
    """A program in a release; ``reads`` is a version of URDF or SDF, or an element."""

    release: str
    name: str
    version: str
    reads: str

    def __str__(self) -> str:
        return f"{self.name} {self.version} of {self.release}"


@lru_cache
def readers() -> tuple[Reader, ...]:
    """All rows of the table."""
    lines = table_text(_FILE).splitlines()
    rows = [line.split() for line in lines if line and not line.startswith("#")]
    return tuple(Reader(*row) for row in rows)


def reader_of(release: str, name: str) -> Reader:
    """A program as a release has it."""
    return next(it for it in readers() if (it.release, it.name) == (release, name))


def highest_version(release: str) -> Version:
    """The highest version of URDF that the urdfdom of a release reads."""
    return read_version(reader_of(release, URDFDOM).reads) or OLDEST
