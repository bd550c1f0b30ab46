# SPDX-License-Identifier: Apache-2.0
"""What a description is linted with: the settings of a command, a configuration file or a test."""

import os
from collections.abc import Mapping
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, NamedTuple

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.selection import NO_LEVELS, matched
from multibot_rewrite.base.naming import Naming, make_naming
from multibot_rewrite.base.releases import NEWEST_LTS

if TYPE_CHECKING:
    from multibot_rewrite.description.sources.known_arguments import KnownArguments

ALL = ("M",)
TARGETS = ("mjcf",)
EVERY_FILE = "*"
# A system that Gazebo does not find, and links and joints that sdformat leaves out: in a simulator
# these do not run, whatever the level of the lint.
LEFT_OUT = ("MB172", "MB603", "MB610")
# What every comment for the lint begins with.
MARK = b"urdf-lint"


class ArgumentSet(NamedTuple):
    """xacro arguments for the files that ``pattern`` matches."""

    pattern: str
    arguments: tuple[tuple[str, str], ...]

    def __str__(self) -> str:
        return " ".join(f"{name}:={value}" for name, value in self.arguments)


class Settings(NamedTuple):
    """``select`` and ``ignore`` are codes or their beginnings; the longer one wins.

    ``levels`` maps them to levels or ``OFF``. ``per_file`` are (pattern, codes): rules that are
    off in files that the pattern ``matches``. Each of ``arguments`` is one more expansion of a
    xacro file, in addition to the default one. ``robots`` will share a system, renamed by
    ``naming``; without robots the rules that depend on them find nothing. ``targets`` are other
    formats that the description is converted to (``TARGETS``). ``roots`` are folders in which
    ``package://NAME`` is looked up. ``urdf`` is the description that SRDF files belong to, where it
    is not the one with the same robot name; ``urdfs`` are the names and paths of robots that are
    linted together with them. ``included`` are xacro files that are linted through those which
    include them. ``seconds`` is the time limit for one file. ``trust`` lets xacro
    files do anything; ``readable`` are those of the roots that they may read in and ``$(find NAME)``
    looks in: a configuration gives them no folder outside of its own. ``elsewhere`` are the xacro
    arguments that any of several files knows that are linted together, None for one file alone.
    ``distro`` is the ROS 2 release that the robots run, ``ros`` the ROS that loads their
    plugins, where somebody said it. ``simulated`` says that the robot runs
    in Gazebo.
    """

    select: tuple[str, ...] = ALL
    ignore: tuple[str, ...] = ()
    levels: Mapping[str, str] = NO_LEVELS
    per_file: tuple[tuple[str, tuple[str, ...]], ...] = ()
    arguments: tuple[ArgumentSet, ...] = ()
    robots: tuple[str, ...] = ()
    naming: Naming = make_naming()
    definitions: tuple[str, ...] = ()
    targets: tuple[str, ...] = ()
    roots: tuple[str, ...] = ()
    urdf: str = ""
    urdfs: tuple[tuple[str, str], ...] = ()
    included: frozenset[str] = frozenset()
    seconds: float = 60.0
    trust: bool = False
    readable: tuple[str, ...] = ()
    elsewhere: "KnownArguments | None" = None
    distro: str = NEWEST_LTS
    ros: str = ""
    simulated: bool = False


def matches(path: str, pattern: str) -> bool:
    """Return whether an ``fnmatch`` pattern matches a path, as given or absolute."""
    return fnmatchcase(path, pattern) or fnmatchcase(os.path.abspath(path), pattern)


def is_silent(settings: Settings, file: str, code: str) -> bool:
    """Return whether the settings switch a rule off in that one file."""
    return any(
        matched(codes, code) >= 0 and matches(file, pattern) for pattern, codes in settings.per_file
    )


def file_of(finding: Finding) -> str:
    """Return the file that a finding is about, whether it was expanded or not."""
    return finding.file.removesuffix(" (expanded)")
