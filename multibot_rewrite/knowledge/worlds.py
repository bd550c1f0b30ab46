# SPDX-License-Identifier: Apache-2.0
"""Tables of gz-sim: systems that a world needs, plugins that drive joints, simulators of hardware.

Sources: gz_hardware_plugins.xml and gz_system.cpp:326 of gz_ros2_control (jazzy), the same of
ign_ros2_control (humble), gazebo_hardware_plugins.xml and gazebo_system.cpp of gazebo_ros2_control;
for the plugins the plugin definitions."""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from multibot_rewrite.base.bounded import own_rows

DEFAULTS = ("physics", "user-commands", "scene-broadcaster")
_SENDS, _DRIVES = "sends", "drives"
_ROWS = own_rows(__file__, "worlds.schema")


def _rows_of(kind: str) -> Iterator[tuple[str, list[str]]]:
    """Yield (library, words) of each row of a kind."""
    yield from ((library, words.split()) for library, what, words in _ROWS if what == kind)


_SENT = {name: dict(it.split("=") for it in words) for name, words in _rows_of(_SENDS)}
SENT_BY_ANY: Mapping[str, str] = _SENT.pop("*")
SENT_BY: Mapping[str, Mapping[str, str]] = _SENT
# Parameters that hold joints which a plugin commands, by its library.
DRIVES: Mapping[str, tuple[str, ...]] = {name: tuple(words) for name, words in _rows_of(_DRIVES)}
# The library and the class, by the type of a sensor.
SYSTEMS: Mapping[str, tuple[str, str]] = {
    type_: (library, class_)
    for library, class_, types in _ROWS
    for type_ in (types.split() if class_ not in (_SENDS, _DRIVES) else ())
}


class Simulator(NamedTuple):
    """A simulator: the hardware classes that its plugins load, and the plugins.

    ``takes`` are the interfaces of a joint that its hardware exports, the others it leaves out.
    """

    name: str
    hardware: tuple[str, ...]
    plugins: tuple[str, ...]
    takes: tuple[str, ...]


_TAKES = ("position", "velocity", "effort")
GAZEBO = Simulator(
    "Gazebo",
    ("gz_ros2_control/GazeboSimSystem", "ign_ros2_control/IgnitionSystem"),
    ("gz_ros2_control-system", "ign_ros2_control-system"),
    _TAKES,
)
CLASSIC = Simulator(
    "Gazebo Classic", ("gazebo_ros2_control/GazeboSystem",), ("gazebo_ros2_control",), _TAKES
)
SIMULATORS = (GAZEBO, CLASSIC)
