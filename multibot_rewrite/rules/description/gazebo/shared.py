"""The faults of a description's ``<gazebo>`` blocks, plugins and hardware: found once for all rules."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from lxml.etree import _Element

from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.examples import block
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.facts.simulators import simulator_plugins
from multibot_rewrite.rules.subject import Subject

if TYPE_CHECKING:
    from multibot_rewrite.rules.schema.faults import Fault

ByKind = Mapping[str, Sequence["Fault"]]


def in_link(*inside: str) -> str:
    """A link with a block for Gazebo."""
    return '<link name="a"/>\n' + block('<gazebo reference="a">', *inside)


def a_sensor(type_: str, *inside: str) -> str:
    """The same with a sensor."""
    return in_link(block(f'<sensor name="s" type="{type_}">', *inside))


def a_system(library: str, class_: str, *inside: str) -> str:
    """A system of gz-sim."""
    opening = f'<plugin filename="gz-sim-{library}-system" name="gz::sim::systems::{class_}">'
    return block("<gazebo>", block(opening, *inside))


@memoized
def element_faults(subject: Subject) -> ByKind:
    """What is wrong below ``<gazebo>``, or in the models of an SDF file."""
    root, release = subject.document.root, subject.settings.distro
    blocks = subject.elements.tops("gazebo")
    if not blocks and root.tag != "sdf":
        return {}
    # Many descriptions have none, and a lint of them loads nothing of this.
    from multibot_rewrite.rules.schema.sdf import block_faults, model_faults

    if blocks:
        return _by_kind(block_faults(blocks, subject.robot, release))
    return _by_kind(model_faults(root, release))


@memoized
def parameter_faults(subject: Subject) -> ByKind:
    """What is wrong with the parameters of plugins and of hardware."""
    release, systems = subject.settings.distro, subject.elements.tops("ros2_control")
    plugins = simulator_plugins(subject)
    if not plugins and not systems:
        return {}
    from multibot_rewrite.rules.schema.plugins import hardware_faults, plugin_faults

    of_ros_1 = _of_ros_1(subject)
    found = [it for one in plugins for it in plugin_faults(one, release, one in of_ros_1)]
    for hardware in (it for system in systems for it in system.iterchildren("hardware")):
        found += hardware_faults(hardware, release)
    return _by_kind(found)


def _of_ros_1(subject: Subject) -> set[_Element]:
    """The plugins that are written as ROS 1's: their libraries have the same names in ROS 2."""
    return {element for element, section in subject.inventory.served if section.ros == "1"}


def _by_kind(faults: Iterable[Fault]) -> ByKind:
    found: dict[str, list[Fault]] = {}
    for it in faults:
        found.setdefault(it.kind, []).append(it)
    return found


def of_kind(faults: Callable[[Subject], ByKind], kind: str, subject: Subject) -> Iterator[Problem]:
    """The faults of one kind: what each rule of this group reports."""
    for it in faults(subject).get(kind, ()):
        yield Problem(it.element, it.message, it.attribute, it.hint)
