# SPDX-License-Identifier: Apache-2.0
"""What a rewrite for the named robots rejects or warns about."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import TYPE_CHECKING

from multibot_rewrite.base.findings.finding import ERROR, SRDF, URDF, WARNING, rule
from multibot_rewrite.base.naming import Naming, make_naming, overlap
from multibot_rewrite.companions.named_file import MOVEIT, PARAMS
from multibot_rewrite.description.checks import hazards
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.spelling import ROBOT_SLOT
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.rules.declaration import OF_TWO, TWO
from multibot_rewrite.rules.description.multirobot.topics import AS_WRITTEN, ONE_TF
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject

if TYPE_CHECKING:
    from multibot_rewrite.description.steps.renames import RenameMap

# A layout with namespaces, and a topic that is not of everybody by itself.
SHARED_SCAN = make_naming("tf-per-robot", shared_topics=["scan"])

Hazard = Callable[[Inventory, "RenameMap"], Iterable[Problem]]
ByNaming = Callable[[Inventory, Naming], Iterable[Problem]]


def _by_naming(hazard: ByNaming) -> Hazard:
    """Return a check of inventory and renames from one that needs only the naming."""
    return lambda inventory, renames: hazard(inventory, renames.naming)


def _if_robots(hazard: Hazard, subject: Subject) -> Iterator[Problem]:
    """Yield what a rewrite for the named robots warns about; nothing where none are named."""
    if subject.settings.robots:
        yield from hazard(subject.inventory, rename_map(subject))


joints_reordered = rule("MB405", "joints-reordered", WARNING, options=OF_TWO)(
    partial(_if_robots, hazards.reordered)
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
    partial(_if_robots, _by_naming(hazards.prefix_only))
)

off_the_shared_tf = rule(
    "MB423", "off-the-shared-tf", WARNING, options={"robots": TWO, "naming": ONE_TF}
)(partial(_if_robots, _by_naming(hazards.moved_tf)))

shared_below_namespace = rule(
    "MB430", "shared-below-namespace", WARNING, options={"robots": TWO, "naming": SHARED_SCAN}
)(partial(_if_robots, _by_naming(hazards.shared_below)))


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
            message = f"the number in {claim.value!r} would depend on how the robot's name sorts"
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
)(partial(_if_robots, hazards.outside_frames))

hard_wired_name = rule("MB428", "hard-wired-name", WARNING, options=OF_TWO)(
    partial(_if_robots, hazards.hardwired)
)


@memoized
def rename_map(subject: Subject) -> RenameMap:
    """Return the rename map of a subject, made once."""
    from multibot_rewrite.description.steps.renames import make_renames  # most lints name no robots

    return make_renames(subject.inventory, subject.settings.naming)
