"""The faults of a description's ``<gazebo>`` blocks, plugins and hardware: found once for all rules."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from lxml.etree import _Element

from multibot_rewrite.checks.problem import Problem
from multibot_rewrite.lint.facts.memo import memoized
from multibot_rewrite.lint.records import Subject
from multibot_rewrite.lint.rules.examples import block
from multibot_rewrite.lint.schema.faults import Fault
from multibot_rewrite.lint.schema.plugins import hardware_faults, plugin_faults
from multibot_rewrite.lint.schema.sdf import block_faults, model_faults

ByKind = Mapping[str, Sequence[Fault]]


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
    if root.tag == "sdf":
        return _by_kind(model_faults(root, release))
    blocks = subject.elements.tops("gazebo")
    return _by_kind(block_faults(blocks, subject.robot, release)) if blocks else {}


@memoized
def parameter_faults(subject: Subject) -> ByKind:
    """What is wrong with the parameters of plugins and of hardware."""
    release = subject.settings.distro
    found = [it for one in simulator_plugins(subject) for it in plugin_faults(one, release)]
    for system in subject.elements.tops("ros2_control"):
        for hardware in system.iterchildren("hardware"):
            found += hardware_faults(hardware, release)
    return _by_kind(found)


@memoized
def simulator_plugins(subject: Subject) -> tuple[_Element, ...]:
    """The plugins of Gazebo, those of ROS 1 aside: nobody described their parameters here."""
    plugins = subject.elements.every("plugin")
    if not plugins:
        return ()
    of_ros_1 = {element for element, section in subject.inventory.served if section.ros == "1"}
    return tuple(it for it in plugins if it not in of_ros_1 and _is_gazebos(it))


def _is_gazebos(plugin: _Element) -> bool:
    above = plugin.getparent()
    return above is not None and above.tag not in _OTHERS


# Plugins that are no plugins of Gazebo: hardware and transmissions of ros2_control, other simulators.
_OTHERS = frozenset({"hardware", "transmission", "webots", "mujoco", "extension", "robot"})


def _by_kind(faults: Iterable[Fault]) -> ByKind:
    found: dict[str, list[Fault]] = {}
    for it in faults:
        found.setdefault(it.kind, []).append(it)
    return found


def of_kind(faults: Callable[[Subject], ByKind], kind: str, subject: Subject) -> Iterator[Problem]:
    """The faults of one kind: what each rule of this group reports."""
    for it in faults(subject).get(kind, ()):
        yield Problem(it.element, it.message, it.attribute, it.hint)
