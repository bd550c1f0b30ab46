# SPDX-License-Identifier: Apache-2.0
"""Links, joints and other names that are used and not declared."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from functools import partial

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.model import Claim
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.checks.audit import uses_xacro
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.references import (
    JOINT,
    Loose,
    doubtful,
    loose_ends,
    undeclared_names,
    where,
)
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.rules.facts.certain import lacking, level_of_absence, since_jazzy
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject

# Its joints are those of the simulated PROTO, not of the URDF.
WEBOTS = "webots_ros2_control::"


class References(NamedTuple):
    """The uses that are not simply a declared link or joint, and by rule the undeclared names."""

    doubtful: list[Claim]
    loose: Mapping[str, list[Problem]]


@memoized
def references(subject: Subject) -> References:
    """The references of a document, for all rules of this group.

    In a part of a description a name may be declared elsewhere; in what xacro has not expanded it
    may not be made yet.
    """
    inventory = subject.inventory
    claims = doubtful(inventory)
    by_code = defaultdict(list)
    if not uses_xacro(inventory.document):
        ends = loose_ends(claims, inventory.declared, subject.settings.naming.shared_frames)
        loose = [it for it in ends if not _elsewhere(it, inventory)]
        for problem in undeclared_names(loose, inventory.declared):
            by_code[problem.code].append(problem)
    return References(claims, by_code)


def _is_part(inventory: Inventory) -> bool:
    """Is it only a part of a description: no link, or a robot without a name?"""
    root = inventory.document.root
    return not inventory.declared["link"] or (root.tag == "robot" and "name" not in root.attrib)


def _elsewhere(loose: Loose, inventory: Inventory) -> bool:
    """Is it declared after all: in another file, with the robot's name as its scope (as in Gazebo
    Classic), or in the PROTO of a Webots robot?"""
    claim, part = loose
    if _is_part(inventory) and part.kinds[0] != "group":
        return True
    scope, _, name = part.text.rpartition("::")
    if scope and scope == inventory.document.root.get("name"):
        return any(name in inventory.declared.get(kind, ()) for kind in part.kinds)
    if inventory.document.root.tag == "sdf" and _is_of_included(claim.element):
        return True
    if claim.site.section != "element ros2_control":
        return False
    system = next(claim.element.iterancestors("ros2_control"), None)
    return system is not None and text_at(system, "hardware/plugin").startswith(WEBOTS)


def _is_of_included(element: _Element) -> bool:
    """Is it in an <include>, or in a model that another one is merged into?"""
    if next(element.iterancestors("include"), None) is not None:
        return True
    return any(it.find("include[@merge]") is not None for it in element.iterancestors("model"))


def undeclared(code: str, subject: Subject) -> Iterator[Problem]:
    """The undeclared names of one rule: ``checks.references`` gives each place the code of its rule."""
    for it in lacking(subject, references(subject).loose.get(code, ())):
        inside = {one.tag for one in it.element.iterancestors("ros2_control", "plugin")}
        level = it.level
        if "ros2_control" in inside:
            level = level or since_jazzy(subject)
        elif inside and code == JOINT and _in_simulator(subject):
            level = ERROR
        yield it._replace(level=level)


def _in_simulator(subject: Subject) -> bool:
    """Do its plugins run for certain, and find no joint that is not there?"""
    return subject.settings.simulated and level_of_absence(subject) == ERROR


undeclared_link = rule("MB202", "undeclared-link", ERROR)(partial(undeclared, "MB202"))

undeclared_joint = rule("MB211", "undeclared-joint", ERROR)(partial(undeclared, "MB211"))

undeclared_sdf_name = rule("MB219", "undeclared-sdf-name", WARNING)(partial(undeclared, "MB219"))


@rule("MB221", "padded-reference", ERROR)
def padded_reference(subject: Subject) -> Iterator[Problem]:
    """Attributes that are the name of a link or joint."""
    declared = subject.inventory.declared
    for claim in references(subject).doubtful:
        name = claim.value.strip()
        if not claim.attribute or name == claim.value or claim.site.form != "whole":
            continue
        found = [declared[kind][name] for kind in claim.site.kinds if name in declared[kind]]
        if found and all(it.value != claim.value for it in found):
            message = f"{where(claim)} is {claim.value!r}, the {claim.site.kinds[0]} is {name!r}"
            yield Problem(claim.element, message, claim.attribute, "delete the white space")
