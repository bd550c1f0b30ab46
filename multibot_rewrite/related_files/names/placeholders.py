# SPDX-License-Identifier: Apache-2.0
"""What stands for a robot in vendors' files until a launch file replaces it: one meaning everywhere.

At the start of a name it is taken out, since the name gets the robot's as any other does; alone it is
the robot's namespace. Any other placeholder stays.
"""

from __future__ import annotations

from multibot_rewrite.base.conventions import PREFIX_WORDS, ROBOT_WORDS
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.naming import NOT_PLAIN

_ROBOT = f"(?:{'|'.join(ROBOT_WORDS)})"
_STANDS = rf"(?:<{_ROBOT}>|\$\((?:var|arg)\s+{_ROBOT}\)|\$\{{{_ROBOT}\}})"
_PREFIX = f"(?:{'|'.join(PREFIX_WORDS)})"
_PREFIX_ALONE = lazy_compile(rf"<{_PREFIX}>|\$\((?:var|arg)\s+{_PREFIX}\)|\$\{{{_PREFIX}\}}")
_ALONE = lazy_compile(rf"/?{_STANDS}/?")
_FIRST = lazy_compile(rf"/?{_STANDS}(?P<between>[/_]?)(?P<name>[^/].*)")
_ANYWHERE = lazy_compile(_STANDS)


def is_robot(value: str) -> bool:
    """Return whether a value is only a placeholder for the robot."""
    return _ALONE.fullmatch(value) is not None


def without_robot(value: str, lead: str = "") -> str:
    """Return a name without the placeholder for the robot in front, with ``lead`` if below it."""
    # It stays if nothing else is in it, or if another placeholder is left.
    found = _FIRST.fullmatch(value)
    if found is None or "<" in found["name"] or not NOT_PLAIN.isdisjoint(found["name"]):
        return value
    return f"{lead}{found['name']}" if found["between"] == "/" else found["name"]


def of_one_robot(value: str) -> str:
    """Return a value of a parameter as it is for one robot without a prefix."""
    return "" if _PREFIX_ALONE.fullmatch(value) else without_robot(value)


def filled(value: str, robot: str) -> str:
    """Return a text with the robot in place of each placeholder for it."""
    return _ANYWHERE.sub(lambda _: robot, value)
