# SPDX-License-Identifier: Apache-2.0
"""Names in a section of a node that is not known: all that its parameters hold change, or none.

What a parameter holds is told by its own name then. Where another one, whose name does not tell, holds
a name of the robot as well, the node would have names of both kinds: nothing of that kind is changed.
"""

from __future__ import annotations

import yaml

from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.names.rename_map import is_declared
from multibot_rewrite.companions.params.name_sites import SectionNames, name_in
from multibot_rewrite.companions.params.sections import ParamSection
from multibot_rewrite.companions.sites import Site

# Frames and links are one tree; the odometry's frame is in it, and in no description.
FRAMES = ("frame", "link")
ODOM = "odom"


def is_guessed(section: ParamSection) -> bool:
    """Is it for one node, of which nothing is known?"""
    return section.node is None and not section.wild


def in_doubt(
    context: Context, section: ParamSection, names: SectionNames
) -> dict[str, yaml.ScalarNode]:
    """The kinds of names that stay in a section, each with a value that may be one of them."""
    found: dict[str, yaml.ScalarNode] = {}
    if is_guessed(section) and names.sites:
        for scalar in names.unclaimed:
            for kind in _kinds_of(context, name_in(scalar), names):
                found.setdefault(kind, scalar)
    return found


def stays(site: Site, doubt: dict[str, yaml.ScalarNode]) -> bool:
    """Is nothing changed here? What is called as a parameter of a known node is a guess, too."""
    return site.kind in doubt


def _kinds_of(context: Context, text: str, names: SectionNames) -> tuple[str, ...]:
    bare = text.removeprefix("/")
    if is_declared(context.names, "frame", bare) or (bare == ODOM and _has_frame(names)):
        return FRAMES
    return ("joint",) if is_declared(context.names, "joint", text) else ()


def _has_frame(names: SectionNames) -> bool:
    """``odom`` alone may be a topic."""
    return any(it.kind in FRAMES for it in names.sites)
