"""What of a description needs links that Gazebo leaves out: sensors, plugins, ros2_control."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.rules.subject import Subject


def relied_on(subject: Subject, gone: frozenset[str]) -> tuple[str, ...]:
    """What goes with these links, in the words of a message."""
    joints = {it.name for it in subject.robot.joints if it.child in gone or it.parent in gone}
    found = [*_sensors(subject, gone | joints), *_driven(subject, joints)]
    return tuple(dict.fromkeys(found))


def _sensors(subject: Subject, gone: frozenset[str]) -> Iterator[str]:
    for block in subject.elements.tops("gazebo"):
        if block.get("reference") in gone:
            yield from (f"sensor {it.get('name')!r}" for it in block.iterchildren("sensor"))


def _driven(subject: Subject, joints: set[str]) -> Iterator[str]:
    """Joints of which a plugin of the model, or ros2_control, knows the name."""
    for block in subject.elements.tops("gazebo"):
        for plugin in () if block.get("reference") else block.iterchildren("plugin"):
            named = (text_of(it) for it in plugin.iterdescendants("*"))
            yield from (f"joint {it!r} of a plugin" for it in named if it in joints)
    for system in subject.elements.tops("ros2_control"):
        named = (it.get("name", "") for it in system.iterchildren("joint"))
        yield from (f"joint {it!r} of ros2_control" for it in named if it in joints)
