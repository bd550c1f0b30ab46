# SPDX-License-Identifier: Apache-2.0
"""Colours of robots: as people write them, and a palette for robots without one."""

from __future__ import annotations

from colorsys import hls_to_rgb

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.nearest import did_you_mean_one_of
from multibot_rewrite.companions.rviz.read_config import rviz_data

Colour = tuple[int, int, int]
# Steps of the golden angle never repeat a hue.
_STEP = 0.618034


def read_colour(given: str | tuple[int, ...], robot: str = "") -> Colour:
    """A colour from a name, ``#rrggbb`` or three numbers; InputError for anything else."""
    if not isinstance(given, str):
        red, green, blue = given
        return red, green, blue
    known = rviz_data()["colours"]
    if given.lower() in known:
        red, green, blue = known[given.lower()]
        return red, green, blue
    digits = given[1:] if given.startswith("#") else ""
    try:
        if len(digits) == 6:
            red, green, blue = bytes.fromhex(digits)
            return red, green, blue
    except ValueError:
        pass
    hint = did_you_mean_one_of(given, known) or "write #rrggbb or [r, g, b]"
    place = f"robot {robot!r}: " if robot else ""
    raise InputError(f"{place}colour {given!r} is not known; {hint}")


def palette(at: int) -> Colour:
    """The colour of the robot at this place, different from all others."""
    first = rviz_data()["palette"]
    if at < len(first):
        red, green, blue = first[at]
        return red, green, blue
    turns = at - len(first)
    lightness = (0.45, 0.6, 0.75)[turns % 3]
    red, green, blue = hls_to_rgb(turns * _STEP % 1, lightness, 0.85)
    return round(red * 255), round(green * 255), round(blue * 255)
