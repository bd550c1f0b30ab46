# SPDX-License-Identifier: Apache-2.0
"""What a rule finds in a file, before it is a finding."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import wraps
from typing import Protocol

import yaml

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.named_file import NamedFile


class Placed(Protocol):
    """What has a place in a text; lines and columns count from 1."""

    @property
    def line(self) -> int: ...
    @property
    def column(self) -> int: ...


class Remark(NamedTuple):
    """What is wrong at a place; ``level`` is empty for that of the rule."""

    line: int
    column: int
    message: str
    hint: str = ""
    level: str = ""


def remark(at: Placed, message: str, hint: str = "", level: str = "") -> Remark:
    """A remark at the place of a name."""
    return Remark(at.line, at.column, message, hint, level)


def remark_at(node: yaml.Node, message: str, hint: str = "", level: str = "") -> Remark:
    """A remark at a node of YAML."""
    mark = node.start_mark
    return Remark(mark.line + 1, mark.column + 1, message, hint, level)


def of_robots(
    find: Callable[[NamedFile], Iterator[Remark]],
) -> Callable[[NamedFile], Iterator[Remark]]:
    """A rule about what several robots get: asked of a file that is for a certain robot, and of one
    alone where robots are named."""

    @wraps(find)
    def found(file: NamedFile) -> Iterator[Remark]:
        if file.is_certain or file.robots:
            yield from find(file)

    return found
