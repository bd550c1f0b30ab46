# SPDX-License-Identifier: Apache-2.0
"""The version of URDF that a description declares, read as urdfdom reads it.

Source: urdfdom 6.0.0, class ``URDFVersion`` in urdf_parser.h; without an attribute it is 1.0.
"""

from __future__ import annotations

from functools import lru_cache

from lxml.etree import _Element

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.record import NamedTuple

# What strtol reads whole.
_NUMBER = lazy_compile(r"[ \t\r\n\v\f]*([-+]?)([0-9]{1,9})")


class Version(NamedTuple):
    """A version of URDF; a later one is greater."""

    major: int
    minor: int

    def __str__(self) -> str:
        return f"{self.major}.{self.minor}"


KNOWN = (Version(1, 0), Version(1, 1), Version(1, 2))
OLDEST = KNOWN[0]


@lru_cache(maxsize=64)  # a dozen rules ask
def read_version(text: str) -> Version | None:
    """The version that a text names; None where urdfdom takes it for none."""
    pieces = text.split(".")
    if len(pieces) == 3 and not pieces[2]:
        del pieces[2]
    found = [it for it in map(_NUMBER.fullmatch, pieces) if it and (it[1] != "-" or not int(it[2]))]
    if len(pieces) != 2 or len(found) != 2:
        return None
    return Version(int(found[0][2]), int(found[1][2]))


def is_known(text: str) -> bool:
    """Does the newest urdfdom read a file that declares this?"""
    return read_version(text) in KNOWN


def version_of(root: _Element) -> Version:
    """The version that a robot is read as: 1.0 where it declares none, or one that is not read."""
    declared = read_version(root.get("version", str(OLDEST)))
    return declared if declared in KNOWN else OLDEST
