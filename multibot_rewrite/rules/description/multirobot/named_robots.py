# SPDX-License-Identifier: Apache-2.0
"""What a rewrite for the named robots refuses or warns about, and devices that exist only once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import TYPE_CHECKING

from multibot_rewrite.base.findings.finding import ERROR, NOTE, SRDF, URDF, WARNING, rule
from multibot_rewrite.base.naming import Naming, make_naming, overlap
from multibot_rewrite.description.checks import hazards
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.renaming import ROBOT_SLOT
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.related_files.named_file import MOVEIT, PARAMS
from multibot_rewrite.rules import declaration
from multibot_rewrite.rules.declaration import OF_TWO, TWO
from multibot_rewrite.rules.description.multirobot.topics import (
    AS_WRITTEN,
    ONE_TF,
    process_wide_plugins,
)
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.facts.source_values import claim_is_fixed, is_fixed, starts_of
from multibot_rewrite.rules.subject import Subject

if TYPE_CHECKING:
    from multibot_rewrite.description.steps.renames import RenameMap

# A layout with namespaces, and a topic that is not of everybody by itself.
SHARED_SCAN = make_naming("tf-per-robot", shared_topics=["scan"])

Hazard = Callable[[Inventory, "RenameMap"], Iterable[Problem]]
ByNaming = Callable[[Inventory, Naming], Iterable[Problem]]


def _hazard_by_naming(hazard: ByNaming) -> Hazard:
    """Return a check of inventory and renames that asks one of inventory and naming."""
    return lambda inventory, renames: hazard(inventory, renames.naming)


def _hazards_of_robots(hazard: Hazard, subject: Subject) -> Iterator[Problem]:
    """Yield what a rewrite for the named robots warns about; nothing where none are named."""
    if subject.settings.robots:
        yield from hazard(subject.inventory, rename_map(subject))


joints_reordered = rule("MB405", "joints-reordered", WARNING, options=OF_TWO)(
    partial(_hazards_of_robots, hazards.reordered)
)


@rule("MB420", "name-taken", ERROR, options=OF_TWO)
def name_taken(subject: Subject) -> Iterator[Problem]:
    """Yield the problems for which a rewrite for the robots is refused with MB420."""
    if names := subject.settings.robots:
        from multibot_rewrite.description.checks import robots  # most lints name none

        yield from robots.taken_names(subject.inventory, rename_map(subject), names)


@rule(
    "MB421",
    "robots-share-a-name",
    ERROR,
    options={"robots": ("left_b", "b"), "naming": make_naming("both", separators={"link": "_"})},
)
def robots_share_a_name(subject: Subject) -> Iterator[Problem]:
    """Yield the problems for which a rewrite for the robots is refused with MB421."""
    naming, names = subject.settings.naming, subject.settings.robots
    pairs = overlap(naming, names) if len(names) > 1 else []
    if pairs:
        from multibot_rewrite.description.checks import robots

        yield from robots.meeting(subject.inventory, rename_map(subject), pairs)


prefix_only = rule("MB422", "prefix-only", WARNING, formats=(URDF, PARAMS, MOVEIT), options=OF_TWO)(
    partial(_hazards_of_robots, _hazard_by_naming(hazards.prefix_only))
)

off_the_shared_tf = rule(
    "MB423", "off-the-shared-tf", WARNING, options={"robots": TWO, "naming": ONE_TF}
)(partial(_hazards_of_robots, _hazard_by_naming(hazards.moved_tf)))

shared_below_namespace = rule(
    "MB430", "shared-below-namespace", WARNING, options={"robots": TWO, "naming": SHARED_SCAN}
)(partial(_hazards_of_robots, _hazard_by_naming(hazards.shared_below)))


@rule("MB424", "collision-number-unstable", ERROR, options=OF_TWO)
def collision_number_unstable(subject: Subject) -> Iterator[Problem]:
    """Report contacts that a rewrite rejects as MB424."""
    if not subject.settings.robots or subject.document.root.find(".//contact") is None:
        return
    from multibot_rewrite.description.rewriters.contact import respell_collisions
    from multibot_rewrite.description.steps.plan import LAST
    from multibot_rewrite.description.steps.renames import respeller

    document, claims, _, declared, *_ = subject.inventory
    renames = rename_map(subject)
    first, last = (
        respell_collisions(document.root, claims, declared, respeller(renames, name))
        for name in (ROBOT_SLOT, LAST)
    )
    for (claim, text), (_, other) in zip(first, last, strict=False):
        if text != other.replace(LAST, ROBOT_SLOT):
            message = f"the number in {claim.value!r} would depend on the robot's name"
            yield Problem(claim.element, message, claim.attribute, "use affix prefix")


@rule("MB426", "process-wide-rule", WARNING, options={"distro": "humble"})
def process_wide_rule(subject: Subject) -> Iterator[Problem]:
    """Report rules that apply to other robots' nodes; without named robots absolute targets."""
    settings = subject.settings
    naming = settings.naming if settings.robots else AS_WRITTEN
    yield from hazards.process_wide(subject.inventory, naming)


fixed_to_own_frame = rule(
    "MB427",
    "fixed-to-own-frame",
    WARNING,
    formats=(SRDF,),
    options={"robots": TWO, "urdf": "r.urdf"},
)(partial(_hazards_of_robots, hazards.outside_frames))

hard_wired_name = rule("MB428", "hard-wired-name", WARNING, options=OF_TWO)(
    partial(_hazards_of_robots, hazards.hardwired)
)


@memoized
def rename_map(subject: Subject) -> RenameMap:
    """Return the rename map of a subject, made once."""
    from multibot_rewrite.description.steps.renames import make_renames  # most lints name no robots

    return make_renames(subject.inventory, subject.settings.naming)


@rule("MB411", "one-controller-file", NOTE)
def one_controller_file(subject: Subject) -> Iterator[Problem]:
    """Report literal ``<parameters>`` of plugins that load a controller manager."""
    plugins = process_wide_plugins(subject)
    found = [it for plugin in plugins for it in plugin.iterchildren("parameters")]
    starts = starts_of(subject, found)
    for element in found:
        text = (element.text or "").strip()
        if text and is_fixed(subject, starts[element], ""):
            message = f"every robot's controllers read {text.rpartition('/')[2]!r}"
            yield Problem(element, message, "", "give each robot its own file")


def _one_device(subject: Subject) -> Iterator[Problem]:
    """Yield what unknown hardware opens and every robot shares: a device or an address."""
    root = subject.document.root
    if root.find("ros2_control") is None:
        return
    params = [*root.iterfind("ros2_control/hardware/param")]
    from multibot_rewrite.producers.addresses import of_hardware  # most descriptions have none
    from multibot_rewrite.system.records import NOWHERE

    starts = starts_of(subject, params)
    held = {(it.get("name", ""), (it.text or "").strip()): it for it in params}
    for it in of_hardware(root, "", NOWHERE, subject.tree.definitions, of_networks=True):
        element = held.get((it.name, it.value))
        if element is None:
            message = f"{it.name} is not given: it is {it.value!r} for every robot"
            system = next(root.iter("ros2_control"), root)
            yield Problem(system, message, "", "make it a xacro argument")
        elif is_fixed(subject, starts[element], ""):
            message = f"parameter {it.name!r} is {it.value!r} for every robot"
            yield Problem(element, message, "", "make it a xacro argument")


one_device = declaration.ONE_DEVICE._replace(
    level=NOTE, check=_one_device, formats=(URDF,), options={}, examples="MB412-urdf"
)


@rule("MB415", "sensor-found-by-bare-name", NOTE)
def sensor_found_by_bare_name(subject: Subject) -> Iterator[Problem]:
    """Report sensors that are found by their name alone, if no robots are named: then it is MB425."""
    sensors = subject.inventory.declared["sensor"].values()
    if subject.settings.robots or not any(claim_is_fixed(subject, it) for it in sensors):
        return
    for it in hazards.bare_lookups(subject.inventory, AS_WRITTEN):
        yield it._replace(hint="give sensors a prefix for each robot")


@rule("MB416", "world-system-in-robot", WARNING)
def world_system_in_robot(subject: Subject) -> Iterator[Problem]:
    """Report plugins whose library is one of the world's systems."""
    for it in hazards.world_systems(subject.inventory):
        yield it._replace(
            hint="write its <plugin> into the <world>, once, and take it out of the robot"
        )
