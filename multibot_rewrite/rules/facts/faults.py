# SPDX-License-Identifier: Apache-2.0
"""What is wrong with the structure of a document and the values in it: found once for all rules."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.base.findings.finding import SRDF, URDF
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.facts.simulators import simulator_plugins
from multibot_rewrite.rules.schema.faults import read_faults
from multibot_rewrite.rules.subject import Subject


def faults(kind: str, subject: Subject) -> Iterator[Problem]:
    """Yield the faults of one kind, which a rule reports."""
    yield from _faults_by_kind(subject).get(kind, ())


@memoized
def urdf_faults(subject: Subject) -> tuple[Problem, ...]:
    """Return the faults of a URDF; empty for the source of a xacro file."""
    return read_faults(subject.document) if subject.format == URDF else ()


@memoized
def _faults_by_kind(subject: Subject) -> Mapping[str, list[Problem]]:
    readers = (urdf_faults, _srdf_faults, _block_faults, _parameter_faults)
    return lists_by_key((it.code, it) for faults_of in readers for it in faults_of(subject))


def _srdf_faults(subject: Subject) -> Iterable[Problem]:
    if subject.format != SRDF:
        return ()
    from multibot_rewrite.rules.schema.srdf import srdf_faults  # a URDF needs none of it

    return srdf_faults(subject.document.root, subject.beside)


def _block_faults(subject: Subject) -> Iterable[Problem]:
    """Return the faults below ``<gazebo>``, or in the models of an SDF file."""
    root, release = subject.document.root, subject.settings.distro
    blocks = subject.elements.tops("gazebo")
    if not blocks and root.tag != "sdf":
        return ()
    # Many descriptions have none, and a lint of them loads nothing of this.
    from multibot_rewrite.rules.schema.sdf import block_faults, model_faults

    return block_faults(blocks, subject.robot, release) if blocks else model_faults(root, release)


def _parameter_faults(subject: Subject) -> Iterator[Problem]:
    """Yield the faults in the parameters of plugins and of hardware."""
    definitions, systems = subject.tree.definitions, subject.elements.tops("ros2_control")
    plugins = simulator_plugins(subject)
    if not plugins and not systems:
        return
    from multibot_rewrite.rules.schema.plugins import hardware_faults, plugin_faults

    of_ros_1 = {element for element, section in subject.inventory.served if section.ros == "1"}
    for one in plugins:
        yield from plugin_faults(one, definitions, one in of_ros_1)
    for hardware in (it for system in systems for it in system.iterchildren("hardware")):
        yield from hardware_faults(hardware, definitions)
