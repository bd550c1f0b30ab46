# SPDX-License-Identifier: Apache-2.0
"""Files, devices, sensors and systems of the world that exist only once."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import NOTE, URDF, WARNING, rule
from multibot_rewrite.description.checks import hazards
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules import declaration
from multibot_rewrite.rules.description.multirobot.topics import AS_WRITTEN, process_wide_plugins
from multibot_rewrite.rules.facts.source_values import claim_is_fixed, is_fixed, starts_of
from multibot_rewrite.rules.subject import Subject
from multibot_rewrite.system.records import NOWHERE


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
    """Yield what the hardware opens and every robot shares, for classes without a definition. The
    parameter's name or value shows that it is a device or address."""
    root = subject.document.root
    if root.find("ros2_control") is None:
        return
    params = [*root.iterfind("ros2_control/hardware/param")]
    from multibot_rewrite.producers.addresses import of_hardware  # most descriptions have none

    starts = starts_of(subject, params)
    held = {(it.get("name", ""), (it.text or "").strip()): it for it in params}
    for it in of_hardware(root, "", NOWHERE, subject.tree.vocabulary, of_networks=True):
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
    """Report such sensors only if no robots are named: otherwise MB425 knows if names differ."""
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
