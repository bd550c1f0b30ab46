# SPDX-License-Identifier: Apache-2.0
"""MB9: what a rewrite for several robots leaves as it is, because its meaning is not known."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from multibot_rewrite.base.findings.finding import NOTE, SRDF, URDF, WARNING, rule
from multibot_rewrite.description.checks.audit import other_releases, other_ros
from multibot_rewrite.description.checks.mentions import (
    MENTIONED,
    as_problem,
    unclaimed_mentions,
    usual_names,
)
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.unknown import unknown_parts
from multibot_rewrite.description.steps.document import slot_values
from multibot_rewrite.related_files.named_file import EVERY
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject


@rule("MB901", "name-of-unknown-use", WARNING, formats=(URDF, SRDF, *EVERY))
def unclaimed_mention(subject: Subject) -> Iterator[Problem]:
    """Report values that no site claims and that hold a declared name."""
    inventory = subject.inventory
    names = {name for kind in MENTIONED for name in inventory.declared[kind]}
    values, usual = slot_values(subject.document.root), usual_names(subject.settings.naming)
    mentions = unclaimed_mentions(inventory, values, names, subject.tree, usual)
    yield from map(as_problem, mentions)


@memoized
def _unknown_parts(subject: Subject) -> tuple[Problem, ...]:
    return tuple(unknown_parts(subject.inventory, subject.tree))


def _unknown_of_code(code: str, subject: Subject) -> Iterator[Problem]:
    """Yield the unknown plugins and hardware of a document that have this code."""
    return (it for it in _unknown_parts(subject) if it.code == code)


unknown_plugin = rule("MB902", "unknown-plugin", NOTE)(partial(_unknown_of_code, "MB902"))

unknown_hardware_class = rule("MB903", "unknown-hardware", NOTE)(partial(_unknown_of_code, "MB903"))

parameter_of_ros_1 = rule("MB904", "parameter-of-ros-1", NOTE)(
    lambda subject: other_ros(subject.inventory, subject.tree)
)

row_of_another_release = rule(
    "MB905",
    "row-of-another-release",
    NOTE,
    options={"definitions": ["my.vocab"], "distro": "lyrical"},
)(lambda subject: other_releases(subject.inventory, subject.tree))

included_model = rule("MB906", "included-model", NOTE)(partial(_unknown_of_code, "MB906"))
