# SPDX-License-Identifier: Apache-2.0
"""The parameters of a ``<plugin>`` and of ros2_control hardware against what their code reads.

What it reads is in the rows of the plugin definitions. A parameter counts as known where any
release reads it: what only other releases read is a fault of its own."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache
from math import radians

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.nearest import fold, nearest, slip_of
from multibot_rewrite.base.releases import has_release, releases_with
from multibot_rewrite.description.checks.problem import Problem, fault
from multibot_rewrite.description.rewriters.plugin_definitions import Definitions, Value, Values
from multibot_rewrite.description.rewriters.text import text_at, text_of
from multibot_rewrite.description.rewriters.tree import values_of_plugin
from multibot_rewrite.rules.schema.sdf_values import TURN, misread, number_in
from multibot_rewrite.rules.schema.sections import is_own, shortened

GZ, GAZEBO_ROS = "gz-sim-", "gazebo_ros_"
# How the libraries end that come with Gazebo Classic itself.
CLASSIC = "Plugin"


def plugin_faults(
    element: _Element, definitions: Definitions, of_ros_1: bool = False
) -> Iterator[Problem]:
    """Yield the faults of a plugin's parameters; nothing for an unknown plugin."""
    section = values_of_plugin(element, definitions, of_ros_1)
    if section is None:
        return
    yield from _child_faults(element, "", section, definitions)
    given = {str(it.tag) for it in element}
    yield from _missing_values(element, section, given, definitions.release)


def _child_faults(
    element: _Element, above: str, section: Values, definitions: Definitions
) -> Iterator[Problem]:
    """Yield the faults of what is in a plugin, or in its parameter ``above``."""
    for child in element.iterchildren("*"):
        if not is_own(child.tag):
            continue
        path = f"{above}{child.tag}"
        yield from _parameter_faults(child, path, text_of(child), section, definitions)
        if path in section.blocks:
            yield from _child_faults(child, f"{path}/", section, definitions)


def hardware_faults(hardware: _Element, definitions: Definitions) -> Iterator[Problem]:
    """Yield the faults of the parameters in a ``<hardware>``."""
    section = definitions.values(text_at(hardware, "plugin"))
    if section is None:
        return
    given: dict[str, _Element] = {}
    for child in hardware.iterchildren("param"):
        name = child.get("name", "")
        given.setdefault(name, child)
        yield from _parameter_faults(child, name, text_of(child), section, definitions)
    yield from _missing_values(hardware, section, given, definitions.release)


def _parameter_faults(
    child: _Element, name: str, text: str, section: Values, definitions: Definitions
) -> Iterator[Problem]:
    row, release = section.rows.get(name), definitions.release
    above, _, own = name.rpartition("/")
    if row is None:
        if not section.is_open and f"{above}/*" not in section.rows:
            yield from _place_faults(child, above, own, section, definitions)
    elif not has_release(row.releases, release):
        message = f"{title(section)} of {release} does not read {name!r}"
        hint = f"delete it; that of {', '.join(releases_with(row.releases))} reads it"
        yield fault("later", child, None, message, hint)
    elif text and "$" not in text:
        where = f"{row.name} {shortened(text)!r}"
        wrong = misread(row.type, text)
        if not wrong:
            yield from _number_faults(child, row, text, where)
        if wrong:
            instead = f", and counts as {'false' if row.type == 'boolean' else 0}" * wrong.fails
            yield fault("value", child, "", f"{where} {wrong.problem}{instead}", "", WARNING)
        elif row.words and text not in row.words:
            near = nearest(text, row.words)
            hint = f"did you mean {near!r}?" if near else f"write {' or '.join(row.words)}"
            message = f"{where} is not a word that {title(section)} knows"
            yield fault("word", child, "", message, hint, WARNING)


def _number_faults(child: _Element, row: Value, text: str, where: str) -> Iterator[Problem]:
    """Yield a fault for a number outside its sensible range, or an angle of more than a turn."""
    value = number_in(text)
    if value is None:
        return
    if row.unit == "nonzero" and not any(map(number_in, text.split())):
        message = f"{where} has to be other than 0{_bracketed(row.checked)}"
        yield fault("range", child, "", message, "", WARNING)
    elif row.low is not None and (value < row.low or (row.is_open and value == row.low)):
        limit = f"has to be {'above' if row.is_open else 'at least'} {row.low:g}"
        yield fault("range", child, "", f"{where} {limit}{_bracketed(row.checked)}", "", WARNING)
    elif row.high is not None and value > row.high:
        message = f"{where} may be {row.high:g} at most{_bracketed(row.checked)}"
        yield fault("range", child, "", message, "", WARNING)
    elif row.unit == "rad" and abs(value) > TURN:
        hint = f"{value:g} degrees are {radians(value):.4g}"
        yield fault("degrees", child, "", f"{where} is more than a turn: it is in radians", hint)


def _place_faults(
    child: _Element, above: str, name: str, section: Values, definitions: Definitions
) -> Iterator[Problem]:
    """Yield a fault for a parameter that is read nowhere, or only inside a block that is there."""
    blocks = section.blocks_of.get(name)
    if blocks is None:
        yield from _unknown_parameter(child, above, name, section, definitions)
        return
    parent = child.getparent()
    there = (it for it in blocks if it and parent is not None and parent.find(it) is not None)
    if beside := next(there, ""):
        message = f"{title(section)} reads {name!r} in <{beside}>, not outside of it"
        yield fault("misplaced", child, None, message, f"move it into <{beside}>")


def _unknown_parameter(
    child: _Element, above: str, name: str, section: Values, definitions: Definitions
) -> Iterator[Problem]:
    inside = f" in <{above}>" if above else ""
    message = f"{title(section)} does not read {name!r}{inside}"
    parent, near = child.getparent(), slip_of(name, section.blocks[above])
    if parent is not None and near and parent.find(near) is not None:
        near = ""  # that one is there already
    other = "" if above else _of_another(name, section, definitions)
    if other:
        hint = f"{other} does; did you mean {near!r}?" if near else f"{other} does"
        yield fault("simulator", child, None, message, hint)
    elif near:
        yield fault("misspelt", child, None, message, f"did you mean {near!r}?")
    elif child.tag != "param":
        # Hardware may have the names of its parameters where nobody looked: in constants, in libraries.
        yield fault("not-read", child, None, message)


def _of_another(name: str, section: Values, definitions: Definitions) -> str:
    """Return the counterpart for the other ROS or simulator that has this parameter, or empty."""
    for other, of_ros_1 in _counterparts(section.names[0], section.of_ros_1, definitions):
        found = definitions.values(other, of_ros_1)
        # A block is no parameter that was taken from there: <imu> is an element of SDF as well.
        if found and name in found.rows and name not in found.blocks:
            return title(found)
    return ""


@lru_cache
def _counterparts(
    library: str, of_ros_1: bool, definitions: Definitions
) -> tuple[tuple[str, bool], ...]:
    """Return (name, is it for ROS 1) of plugins alike: in the other ROS, or the other Gazebo."""
    own = _topic_of_library(library)
    of_gz = library.startswith(GZ)
    start = GAZEBO_ROS if of_gz else GZ
    found = [
        (of, it)
        for it, of in definitions.valued()
        if (it.startswith(start) or (of_gz and it.endswith(CLASSIC))) and "::" not in it
    ]
    same = sorted((of, it) for of, it in found if own and _topic_of_library(it) == own)
    return ((library, not of_ros_1), *((it, of) for of, it in same))


def _topic_of_library(library: str) -> str:
    """Return what a plugin is about, from the words of its library."""
    bare = fold(library.removeprefix(GZ).removeprefix(GAZEBO_ROS).removesuffix("-system"))
    return bare.removesuffix(CLASSIC.casefold()).removesuffix("_sensor").replace("_", "")


def _missing_values(
    element: _Element, section: Values, given: Iterable[str], release: str
) -> Iterator[Problem]:
    for name, row in section.rows.items():
        if row.required and name not in given and has_release(row.releases, release):
            message = f"{title(section)} needs {name!r}"
            hint = f"add it: it is not loaded without{_bracketed(row.place)}"
            yield fault("missing", element, None, message, hint)


def _bracketed(place: str) -> str:
    return f" ({place})" if place else ""


def title(section: Values) -> str:
    """Return the plugin of a section, as a message names it."""
    return section.names[0] + " of ROS 1" * section.of_ros_1
