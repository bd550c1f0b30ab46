# SPDX-License-Identifier: Apache-2.0
"""What describes a robot of a fleet file: a file, or the parts that it is joined of."""

from __future__ import annotations

import os

from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.description.joining.from_file import part_of, parts_of
from multibot_rewrite.description.joining.part import Part
from multibot_rewrite.description.sources.read import JOIN as LIST
from multibot_rewrite.fleet.file.fleet_data import JOIN, FleetData

DESCRIPTION = "description"
# What a robot is called where the fleet file lists its parts.
_MADE = "robot.urdf"


def described(read: FleetData, at: int) -> tuple[str, tuple[Part, ...]]:
    """The description of a robot, by its number, and the parts that it is joined of.

    That of a list in the fleet file is no file, and is called as if it were below. Raises InputError
    for a robot with both.
    """
    data, own = read.data, read.data["robots"][at]
    file, line = read.places["robots", at]
    if any(JOIN in it and DESCRIPTION in it for it in (own, data)):
        what = "join and description are both there: a robot has one of them; remove the other"
        raise InputError(f"{file}:{line}: {what}")
    given = own if JOIN in own or DESCRIPTION in own else data
    if JOIN not in given:
        path = given.get(DESCRIPTION, "")
        return path, parts_of(path) if path.endswith(LIST) else ()
    like = next(it["name"] for it in data["robots"] if it.get(JOIN) == own.get(JOIN))
    try:
        parts = tuple(map(part_of, given[JOIN]))
    except UsageError as error:
        raise InputError(f"{file}:{line}: {error}") from None
    return os.path.join(read.file, like if given is own else "", _MADE), parts
