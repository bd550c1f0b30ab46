# SPDX-License-Identifier: Apache-2.0
"""A xacro's own arguments for a robot's names, filled where the fleet file has no value for them.

They are filled where the names that they reach become what the layout makes of them. What they make
is the robot's already, so the rewrite leaves it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import cache
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import NOTE, Finding, declare
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import NAMESPACE, POSTFIX, ROS_KINDS, SEPARATORS, Naming
from multibot_rewrite.base.releases import ROS_2
from multibot_rewrite.description.reports.xacro_arguments import (
    WHOLE,
    Argument,
    Use,
    find_arguments,
    names_robots,
)
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.sources.access import Reach
from multibot_rewrite.description.sources.own_names import ROBOT, filled, name_robot
from multibot_rewrite.description.sources.read import is_xacro
from multibot_rewrite.fleet.file.fleet_file import FleetFile
from multibot_rewrite.fleet.file.robot_spec import RobotSpec

# Kinds that other files and nodes know by the name that the layout makes.
_KNOWN = ("link", "joint", "frame")
OWN_ARGUMENT = declare("MF840", "own-argument", NOTE, formats=("fleet",))


class _Choice(NamedTuple):
    """What a robot's argument gets; if nothing, why, where it could."""

    name: str
    value: str = ""
    reason: str = ""


def with_own_arguments(
    file: FleetFile, naming: Naming, trust: bool
) -> tuple[FleetFile, Mapping[str, Sequence[Finding]]]:
    """Return the fleet with a value for each argument that names robots, if that fits the layout,
    and the findings about them, by robot. A file that cannot be expanded is left to whoever reads
    it."""

    @cache
    def found(path: str, given: frozenset[tuple[str, str]]) -> tuple[Argument, ...]:
        tree, reach = builtin_tree(file.vocabulary, file.distro, ROS_2), Reach(trust=trust)
        with suppress(InputError):
            return find_arguments(
                path, dict(given), tree, reach=reach, wanted=names_robots
            ).arguments
        return ()

    robots: list[RobotSpec] = []
    notes: dict[str, list[Finding]] = {}
    # What the first robot with these values finds holds for all: a name is as good as another.
    first: dict[tuple[tuple[str, str], ...], frozenset[tuple[str, str]]] = {}
    for it in file.robots:
        own = frozenset(filled(it.arguments, it.name).items())
        own = first.setdefault(tuple(it.arguments.items()), own)
        paths = [path for path in (it.description, it.simulated) if it.fills and path]
        every = (one for path in paths if is_xacro(path) for one in found(path, own))
        free = [one for one in every if one.name not in it.arguments]
        choices = [_choice(one, naming, it) for one in free]
        told = ((name, text) for name, text in it.arguments.items() if ROBOT not in text)
        if named := next((name for name, text in told if name_robot({name: text}, it.words)), ""):
            # A given value is the robot's name: a name would have it twice.
            reason = f"{named} names the robot already"
            choices = [_Choice(one.name, reason=reason) if one.value else one for one in choices]
        values = {one.name: one.value for one in choices if one.value}
        robots.append(it._replace(arguments={**it.arguments, **values}))
        notes[it.name] = said = []
        for one in (one for one in choices if one.value or one.reason):
            what = f"is filled, it is {one.value.replace(ROBOT, it.name)}"
            hint = "give another value under arguments, or '' for none"
            if one.reason:
                what = f"is not filled: {one.reason}"
                hint = "give its value under arguments, or set separators"
            message = f"robot {it.name!r}: the argument {one.name} of its xacro {what}"
            said.append(OWN_ARGUMENT.finding(message, hint, file=it.file, line=it.line))
    return file._replace(robots=tuple(robots)), notes


def _choice(it: Argument, naming: Naming, robot: RobotSpec) -> _Choice:
    uses = [use for use in it.uses if use.kind in ROS_KINDS or use.how != WHOLE]
    if not (it.word and (it.is_empty or it.is_space) and uses) or any(
        _makes_other_names(use, naming) for use in uses
    ):
        return _Choice(it.name)
    if it.missed:
        return _Choice(it.name, reason=f"something still names {it.missed}, which it renames")
    words = {robot.namespace if use.kind in ROS_KINDS else robot.tag for use in uses}
    if len(words) > 1 or "/" in min(words):
        return _Choice(it.name, reason="its namespace is not what its frames get")
    bare = any(use.separator or use.how == WHOLE for use in uses)
    known = {
        naming.separators[use.kind] for use in uses if use.kind in _KNOWN and not use.separator
    }
    between = known or {
        SEPARATORS[use.kind] for use in uses if use.how != WHOLE and not use.separator
    }
    if len(between) + bare > 1:
        both = " and ".join(f"{use.example} of a {use.kind}" for use in uses[:2])
        return _Choice(it.name, reason=f"it makes {both}, and these get different separators")
    word, separator = min(words), "".join(between)
    word = ROBOT if word == robot.name else word
    behind = any(use.how == POSTFIX for use in uses)
    return _Choice(it.name, f"{separator}{word}" if behind else f"{word}{separator}")


def _makes_other_names(use: Use, naming: Naming) -> bool:
    """Return whether names with the argument differ from the layout's."""
    if use.kind in ROS_KINDS:
        return naming.topics != NAMESPACE or use.how == POSTFIX
    if use.kind not in _KNOWN:
        return False
    separator = naming.separators.get(use.kind)
    return use.how != naming.affix or use.separator not in ("", separator) or separator is None
