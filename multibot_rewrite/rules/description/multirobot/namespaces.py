# SPDX-License-Identifier: Apache-2.0
"""Namespaces of plugins and of Gazebo itself, and the robot description that plugins read."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.model import Claim
from multibot_rewrite.description.checks import hazards
from multibot_rewrite.description.checks.model_namespaces import ignored_namespaces, used_namespaces
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.insert import lacks_namespace
from multibot_rewrite.rules.description.multirobot.shared import (
    APART,
    AS_WRITTEN,
    claims_of,
    is_plain,
)
from multibot_rewrite.rules.facts.source_values import claim_is_fixed, is_fixed, starts_of
from multibot_rewrite.rules.subject import Subject


@rule("MB403", "hard-coded-namespace", NOTE)
def hard_coded_namespace(subject: Subject) -> Iterator[Problem]:
    """Each literal namespace, at its first place."""
    found: dict[str, list[Claim]] = {}
    for claim in claims_of(subject, ("namespace",)):
        if is_plain(claim.value) and claim_is_fixed(subject, claim):
            found.setdefault(claim.value, []).append(claim)
    for value, claims in found.items():
        where = f" in {len(claims)} plugins" if len(claims) > 1 else ""
        message = f"the namespace {value!r}{where} is the same for every copy of the robot"
        yield Problem(claims[0].element, message, claims[0].attribute, "make it a xacro argument")


@rule("MB409", "no-namespace", NOTE)
def no_namespace(subject: Subject) -> Iterator[Problem]:
    """The first plugin without a namespace, and how many there are."""
    inventory = subject.inventory
    bare = [
        element
        for element, section in inventory.served
        if lacks_namespace(element, section, inventory.declared, APART)
    ]
    if bare:
        have = f"and {len(bare) - 1} more have" if len(bare) > 1 else "has"
        message = f"plugin {bare[0].get('name', '')!r} {have} no namespace"
        yield Problem(bare[0], message, None, "give each robot its own")


@rule("MB410", "one-robot-description", NOTE)
def one_robot_description(subject: Subject) -> Iterator[Problem]:
    """Absolute names of descriptions and of the nodes that hold them."""
    found = [*hazards.one_description(subject.inventory, AS_WRITTEN)]
    starts = starts_of(subject, [it.element for it in found])
    yield from (it for it in found if is_fixed(subject, starts[it.element], ""))


@rule("MB419", "ignored-model-namespace", WARNING)
def ignored_model_namespace(subject: Subject) -> Iterator[Problem]:
    """Each of them."""
    return ignored_namespaces(subject.inventory, subject.tree)


@rule("MB429", "model-namespace-in-use", WARNING, options={"distro": "rolling"})
def model_namespace_in_use(subject: Subject) -> Iterator[Problem]:
    """Each of them."""
    return used_namespaces(subject.inventory, subject.tree)
