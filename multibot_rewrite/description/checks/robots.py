# SPDX-License-Identifier: Apache-2.0
"""Checks that depend on the robots' names: names that become one, strip."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from multibot_rewrite.base.findings.finding import ERROR, Finding, declare
from multibot_rewrite.base.model import Claim
from multibot_rewrite.base.naming import FRAME_KINDS, NO_OWN_NAMES, TOPIC_KINDS, removal
from multibot_rewrite.description.checks.problem import Problem, about
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.renaming import is_reached, must_be_declared
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.document import finding
from multibot_rewrite.description.steps.renames import RenameMap

strip_other_robot = declare(
    "MB107", "strip-other-robot", ERROR, options={"strip": "robot1"}, formats=("rewrite",)
)

strip_other_options = declare(
    "MB108", "strip-other-options", ERROR, options={"strip": "robot1"}, formats=("rewrite",)
)


def taken_names(
    inventory: Inventory, renames: RenameMap, robots: Iterable[str]
) -> Iterator[Problem]:
    """Yield names that stay unchanged, or are shared, and that another name becomes for some robot."""
    yield from _shared_names(inventory, renames, robots)
    kept = list(_unchanged_names(inventory, renames))
    # Names that an argument of the xacro made are kept, and another name may become one of them.
    naming = renames.naming._replace(own=NO_OWN_NAMES)
    for robot in robots if kept else ():
        for kind, name, claim in kept:
            span = removal(naming, robot, kind, name)
            stem = name[: span[0]] + name[span[1] :] if span else ""
            is_own = (kind, stem) in renames.naming.own
            if stem in inventory.declared.get(kind, ()) and not is_own:
                message = (
                    f"another {kind} would become {name!r} for {robot}, which the file already uses"
                )
                yield about(claim, "MB420", message, "choose another separator")


def _shared_names(
    inventory: Inventory, renames: RenameMap, robots: Iterable[str]
) -> Iterator[Problem]:
    """Yield names that become a shared name: ``base``, if ``robot1/base`` is shared."""
    naming = renames.naming
    shared = dict.fromkeys(FRAME_KINDS, naming.shared_frames)
    shared |= dict.fromkeys(TOPIC_KINDS, naming.shared_topics)
    for robot in robots:
        if not any(robot in name for names in shared.values() for name in names):
            continue
        for key in sorted(renames.affixes):
            new = renames.spelled(robot, *key)
            if new.strip("/") in shared.get(key[0], ()):
                message = f"{key[0]} {key[1]!r} would become {new!r} for {robot}, which is shared"
                hint = "rename the robot or choose another separator"
                yield Problem(inventory.document.root, message, None, hint, (), "MB420")


def _unchanged_names(inventory: Inventory, renames: RenameMap) -> Iterator[tuple[str, str, Claim]]:
    """Yield (kind, name, claim) of names that stay as they are, and of undeclared ones."""
    for kind, declared in inventory.declared.items():
        same = (pair for pair in declared.items() if not renames.changes(kind, pair[0]))
        yield from ((kind, name, claim) for name, claim in same)
    for claim, names in zip(inventory.claims, inventory.names, strict=True):
        lost = [it for it in names if not it.kind]
        if lost and claim.site.role == "uses" and must_be_declared(claim.site):
            yield from ((kind, it.text, claim) for it in lost for kind in it.kinds)


def meeting(
    inventory: Inventory, renames: RenameMap, pairs: Collection[tuple[str, str, str]]
) -> Iterator[Problem]:
    """Yield names of two robots that become the same; ``pairs`` are from ``naming.overlap``."""
    for *pair, _ in pairs:
        both = ((robot, inventory, renames) for robot in pair)
        yield from meeting_descriptions(both, "rename a robot or choose another separator")


def meeting_descriptions(
    made: Iterable[tuple[str, Inventory, RenameMap]],
    hint: str = "rename a robot, or give its xacro another argument",
) -> Iterator[Problem]:
    """Yield names that two robots both have, each in a description of its own."""
    first: dict[tuple[str, str], str] = {}
    for robot, inventory, renames in made:
        names = {
            (it.kind, renames.spelled(robot, it.kind, it.text, it.namespaced))
            for value in renames.values
            for it in value
        }
        for kind, name in sorted(names | set(renames.naming.own)):
            other = first.setdefault((kind, name), robot)
            if other != robot:
                message = f"{other} and {robot} would both have the {kind} {name!r}"
                yield Problem(inventory.document.root, message, None, hint, (), "MB421")


def not_rewritten(inventory: Inventory, renames: RenameMap, robot: str) -> list[Finding]:
    """Return links and joints without the affix that ``--undo`` is to remove."""
    for claim, spelling in zip(inventory.claims, renames.values, strict=True):
        kind, name = claim.site.kinds[0], claim.value.strip()
        declares = claim.site.role == "declares" and name and kind in inventory.declared
        if declares and spelling and removal(renames.naming, robot, kind, name) is None:
            message = f"{kind} {name!r} does not have the name of {robot}"
            hint = "give --undo the robot and the options that the file was made with"
            if robot in name:
                hint += ", and --xacro if an argument of it made the name"
            return [_other_robot_finding(inventory, claim.start, message, hint)]
    return []


def other_urdf(
    inventory: Inventory, renames: RenameMap, robot: str, urdf: Declared
) -> list[Finding]:
    """Return a finding for a name of the URDF that the SRDF was not rewritten with."""
    naming = renames.naming
    for kind, names in urdf.items():
        for name, claim in names.items():
            changes = renames.changes(kind, name) and is_reached(claim, naming)
            if changes and removal(naming, robot, kind, name) is None:
                message = f"{kind} {name!r} of the URDF does not have the name of {robot}"
                hint = "give --urdf the URDF as it was rewritten with the same options"
                return [_other_robot_finding(inventory, 0, message, hint)]
    return []


def _other_robot_finding(inventory: Inventory, offset: int, message: str, hint: str) -> Finding:
    return finding(inventory.document, offset, strip_other_robot.code, ERROR, message, hint)


def other_options(inventory: Inventory, robot: str) -> Finding:
    """Return the finding that the stripped text, rewritten again, is not the file."""
    message = f"a rewrite for {robot} with these options does not give this file"
    hint = "give --undo the options the file was made with"
    return finding(inventory.document, 0, strip_other_options.code, ERROR, message, hint)
