# SPDX-License-Identifier: Apache-2.0
"""What runs in a description and nobody knows what it opens: of these a rewrite is not verified."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.nearest import SLIP, Guesses
from multibot_rewrite.base.releases import CLASSIC, ROS_1, ROS_2, lacks_classic
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.readback.active import (
    HARDWARE,
    INCLUDE,
    PLUGIN,
    ActivePart,
    active_parts,
    plugin_name,
    why_not_loaded,
)
from multibot_rewrite.description.rewriters.plugin_definitions import Definitions, PluginDefinition
from multibot_rewrite.description.rewriters.tree import ANY_WITH_ROS, Tree, library_key
from multibot_rewrite.description.steps.collect import SRDF, Inventory

ANOTHER_RELEASE = (
    "name the release that the description is for with --distro, or distro: in a fleet file"
)
SAY_IT = "define it in a file of plugin definitions, with its topics and services or opens: nothing"
NOT_LOADED = "MB112"
CODES = {PLUGIN: "MB902", HARDWARE: "MB903", INCLUDE: "MB906"}


def unknown_parts(inventory: Inventory, tree: Tree) -> Iterator[Problem]:
    """Yield parts of which it is unknown what they open, and a Gazebo that the release lacks."""
    guesses, release, root = Guesses(), tree.definitions.release, inventory.document.root
    # An SRDF starts nothing.
    parts = [] if inventory.format == SRDF else [*active_parts(root, tree.definitions)]
    # Once: so are the others.
    known = (it for it in parts if it.kind == PLUGIN and it.is_known)
    old = next((it for it in known if it.name.startswith(CLASSIC)), None)
    old = old if old and lacks_classic(release, inventory.document.source) else None
    for plugin in root.iter(PLUGIN):
        if hint := why_not_loaded(plugin, tree.definitions):
            message = f"nothing loads the <plugin> {plugin_name(plugin)!r} here"
            yield Problem(plugin, message, None, hint, (), NOT_LOADED)
    # Plugins that both ROS have, by the one whose definition is used.
    both = (it for it in parts if len(tree.definitions.find(PLUGIN, library_key(it.name))) > 1)
    by_ros = lists_by_key((it.section.ros, it) for it in both if it.section)
    for part in parts:
        if not part.is_known:
            message, hint = _message_and_hint(part, tree.definitions, guesses)
            yield Problem(part.element, message, None, hint, (), CODES.get(part.kind, "MB902"))
        elif part is old:
            message = f"plugin {part.name!r} is of Gazebo Classic, which is not in {release}"
            yield Problem(part.element, message, None, ANOTHER_RELEASE, (), CODES[PLUGIN])
        elif ROS_2 in by_ros and part in by_ros.get(ROS_1, ()):
            message = (
                f"plugin {part.name!r} is written for ROS 1, {by_ros[ROS_2][0].name!r} is not: "
                "which ROS loads them is not known"
            )
            hint = "name the ROS 2 release with --distro, or write it for ROS 2, with <ros>"
            yield Problem(part.element, message, None, hint, (), CODES[PLUGIN])


def is_unknown(section: PluginDefinition) -> bool:
    """Return whether a plugin has no definition of its own."""
    return section.select == "plugin" or section.names[0] == ANY_WITH_ROS


def _message_and_hint(
    part: ActivePart, definitions: Definitions, guesses: Guesses
) -> tuple[str, str]:
    if part.kind == INCLUDE:
        return (
            f"the included {part.name!r} is not read: its topics and frames stay as they are",
            "put its folder next to the model's, or name the one above it in GZ_SIM_RESOURCE_PATH; "
            "copy a model of SDF 1.6 or older, of a world or of a <gazebo> into this file",
        )
    who = f"{part.kind} {part.name!r}"
    if part.section is not None:
        return f"{who} is known by its parameters alone: what it opens is not known", SAY_IT
    kind = "hardware" if part.kind == HARDWARE else "plugin" if part.kind == PLUGIN else "sensor"
    name = library_key(part.name) if part.kind == PLUGIN else part.name
    if others := definitions.releases_elsewhere(kind, name):
        where = not_here(definitions, others)
        return f"{who} {where}: its own parameters are not renamed", ANOTHER_RELEASE
    near = guesses.hint(name, definitions.names(kind), SLIP)
    message = f"{who} has no plugin definition: its own parameters are not renamed"
    return message, near or SAY_IT


def not_here(definitions: Definitions, releases: Iterable[str]) -> str:
    """Return the message that something is in other releases only."""
    return f"is not in {definitions.release}, only in {', '.join(releases)}"
