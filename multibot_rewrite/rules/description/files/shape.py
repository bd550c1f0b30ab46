# SPDX-License-Identifier: Apache-2.0
"""Elements, attributes and parameters that their readers do not expect, or miss."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import SRDF, URDF, rule
from multibot_rewrite.companions.kinds import MOVEIT, PARAMS
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.files.libraries import (
    misspelt_hardware,
    misspelt_libraries,
    plugins_without_library,
)
from multibot_rewrite.rules.description.references.gazebo import (
    sensors_elsewhere,
    sensors_of_joints,
)
from multibot_rewrite.rules.description.references.interfaces import misspelt_interfaces
from multibot_rewrite.rules.facts.certain import lacking
from multibot_rewrite.rules.facts.faults import faults
from multibot_rewrite.rules.subject import Subject


@rule("MB110", "misspelt", WARNING, formats=(URDF, SRDF, PARAMS, MOVEIT))
def misspelt(subject: Subject) -> Iterator[Problem]:
    """Elements, attributes, parameters; what a plugin or <hardware> loads; interfaces."""
    yield from faults("misspelt", subject)
    yield from misspelt_libraries(subject)
    yield from misspelt_hardware(subject)
    yield from misspelt_interfaces(subject)


not_read = rule("MB111", "not-read", NOTE, formats=(URDF, PARAMS))(partial(faults, "not-read"))


@rule("MB112", "misplaced", WARNING)
def misplaced(subject: Subject) -> Iterator[Problem]:
    """By what each reader looks for where, and sensors that no block of a link has."""
    yield from faults("misplaced", subject)
    yield from sensors_of_joints(subject)
    yield from sensors_elsewhere(subject)


@rule("MB115", "missing", ERROR, formats=(URDF, SRDF, PARAMS, MOVEIT))
def missing(subject: Subject) -> Iterator[Problem]:
    """By what each reader requires."""
    root = subject.document.root
    for it in faults("missing", subject):
        # What includes a part of a robot may have its name.
        yield from lacking(subject, [it]) if it.element is root else [it]
    yield from plugins_without_library(subject)


repeated_element = rule("MB116", "repeated-element", WARNING)(partial(faults, "repeated"))

of_another_release = rule("MB157", "of-another-release", NOTE, options={"distro": "humble"})(
    partial(faults, "later")
)

of_another_simulator = rule("MB163", "parameter-of-other-simulator", WARNING)(
    partial(faults, "simulator")
)
