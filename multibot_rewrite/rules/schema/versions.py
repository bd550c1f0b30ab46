# SPDX-License-Identifier: Apache-2.0
"""The version of URDF that a description declares, and who reads it in a release.

Source: urdfdom 6.0.0, class ``URDFVersion`` in urdf_parser.h; without an attribute it is 1.0. The
readers are in ``readers.schema``."""

from functools import lru_cache
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.releases import OF_OLD
from multibot_rewrite.rules.schema.described import table_text

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
    """Return the version that a text names; None where urdfdom reads none."""
    pieces = text.split(".")
    if len(pieces) == 3 and not pieces[2]:
        del pieces[2]
    found = [it for it in map(_NUMBER.fullmatch, pieces) if it and (it[1] != "-" or not int(it[2]))]
    if len(pieces) != 2 or len(found) != 2:
        return None
    return Version(int(found[0][2]), int(found[1][2]))


def is_known(text: str) -> bool:
    """Return whether the newest urdfdom reads a file that declares this version."""
    return read_version(text) in KNOWN


def version_of(root: _Element) -> Version:
    """Return the version that a robot is read as: 1.0 without one that is known."""
    declared = read_version(root.get("version", str(OLDEST)))
    return declared if declared in KNOWN else OLDEST


# The newest SDF that Gazebo Classic wrote; what names a system of its successor.
_NEWEST = (1, 7)
_SYSTEMS = ("ignition-gazebo", "gz-sim", "ign_ros2_control", "gz_ros2_control")


def may_be_classics(root: _Element, release: str) -> bool:
    """Return whether Gazebo Classic may read it: it is more lenient (libsdformat 9 src/Param.cc)."""
    version = read_version(root.get("version", "")) if root.tag == "sdf" else None
    if release != OF_OLD and not (version and version <= _NEWEST):
        return False
    files = [it.get("filename", "") for it in root.iter("plugin")]
    return not any(name in it for it in files for name in _SYSTEMS)


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
    """Return all rows of the table."""
    lines = table_text("readers.schema").splitlines()
    rows = [line.split() for line in lines if line and not line.startswith("#")]
    return tuple(Reader(*row) for row in rows)


def reader_of(release: str, name: str) -> Reader:
    """Return a program as a release has it."""
    return next(it for it in readers() if (it.release, it.name) == (release, name))


def highest_version(release: str) -> Version:
    """Return the highest version of URDF that the urdfdom of a release reads."""
    return read_version(reader_of(release, URDFDOM).reads) or OLDEST
