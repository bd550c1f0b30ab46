"""The parameters of a ``<plugin>`` and of ros2_control hardware against what their code reads.

Sources: ``plugins.schema``. A parameter counts as known where any release reads it: what only other
releases read is a fault of its own.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache
from math import radians

from lxml.etree import _Element

from multibot_rewrite.base.nearest import fold, nearest, slip_of
from multibot_rewrite.base.releases import has_release, releases_with
from multibot_rewrite.description.rewriters.text import text_at, text_of
from multibot_rewrite.description.rewriters.tree import plugin_keys
from multibot_rewrite.rules.schema.described import (
    PLUGINS,
    UNITS,
    Described,
    Row,
    chunks,
    described,
)
from multibot_rewrite.rules.schema.faults import Fault
from multibot_rewrite.rules.schema.sdf_values import TURN, misread, number_in
from multibot_rewrite.rules.schema.sections import is_own
from multibot_rewrite.rules.schema.values import shortened

GZ, GAZEBO_ROS, ROS_1 = "gz-sim-", "gazebo_ros_", "ros1 "
# How the libraries end that come with Gazebo Classic itself.
CLASSIC = "Plugin"
HARDWARE = "hardware "


def section_of_plugin(element: _Element, of_ros_1: bool = False) -> Described | None:
    """What is known of a plugin, by its library, else by its class."""
    known = chunks(PLUGINS)
    keys = (ROS_1 * of_ros_1 + it for it in plugin_keys(element))
    key = next((it for it in keys if it in known), "")
    return described(PLUGINS, key) if key else None


def section_of_library(library: str) -> Described | None:
    """What is known of a library alone."""
    return described(PLUGINS, library)


def hardware_classes() -> list[str]:
    """The ros2_control hardware whose code was read."""
    return [it.removeprefix(HARDWARE) for it in chunks(PLUGINS) if it.startswith(HARDWARE)]


def plugin_faults(element: _Element, release: str, of_ros_1: bool = False) -> Iterator[Fault]:
    """The faults of a plugin's parameters; none where the plugin is not known."""
    section = section_of_plugin(element, of_ros_1)
    if section is None:
        return
    yield from _children(element, "", section, release)
    yield from _missing(element, section, {str(it.tag) for it in element}, release)


def _children(element: _Element, above: str, section: Described, release: str) -> Iterator[Fault]:
    """The faults of what is in a plugin, or in the parameter ``above`` of it."""
    for child in element.iterchildren("*"):
        if not is_own(child.tag):
            continue
        path = f"{above}{child.tag}"
        yield from _parameter(child, path, text_of(child), section, release)
        if path in section.blocks:
            yield from _children(child, f"{path}/", section, release)


def hardware_faults(hardware: _Element, release: str) -> Iterator[Fault]:
    """The faults of the parameters in a ``<hardware>``."""
    section = described(PLUGINS, HARDWARE + text_at(hardware, "plugin"))
    if section is None:
        return
    given: dict[str, _Element] = {}
    for child in hardware.iterchildren("param"):
        name = child.get("name", "")
        given.setdefault(name, child)
        yield from _parameter(child, name, text_of(child), section, release)
    yield from _missing(hardware, section, given, release)


def _parameter(
    child: _Element, name: str, text: str, section: Described, release: str
) -> Iterator[Fault]:
    rows = section.rows.get(name)
    above, _, own = name.rpartition("/")
    if rows is None:
        if "open" not in section.about and f"{above}/*" not in section.rows:
            yield from _unread(child, above, own, section)
        return
    row = rows[0]
    if not has_release(row.releases, release):
        message = f"{title(section)} of {release} does not read {name!r}"
        hint = f"that of {', '.join(releases_with(row.releases))} does"
        yield Fault("later", child, None, message, hint)
    elif text and "$" not in text:
        yield from _value(child, row, text, section)


def _value(child: _Element, row: Row, text: str, section: Described) -> Iterator[Fault]:
    where = f"{row.name} {shortened(text)!r}"
    wrong = misread(row.type, text)
    unit = described(UNITS, section.names[0])
    if unit and row.name in unit.rows and not wrong:
        yield from _measure(child, unit.rows[row.name][0], text, where)
    if wrong:
        instead = f", and counts as {'false' if row.type == 'boolean' else 0}" * wrong.fails
        yield Fault("type", child, "", f"{where} {wrong.problem}{instead}")
    elif row.words and text not in row.words:
        near = nearest(text, row.words)
        if near:
            message = f"{where} is not a word that {title(section)} knows"
            yield Fault("word", child, "", message, f"did you mean {near!r}?")


def _measure(child: _Element, unit: Row, text: str, where: str) -> Iterator[Fault]:
    """A number outside of what makes sense, or an angle of more than a turn."""
    value = number_in(text)
    if value is None:
        return
    if unit.low is not None and (value < unit.low or (unit.is_open and value == unit.low)):
        limit = f"has to be {'above' if unit.is_open else 'at least'} {unit.low:g}"
        yield Fault("range", child, "", f"{where} {limit} ({unit.place})")
    elif unit.high is not None and value > unit.high:
        yield Fault("range", child, "", f"{where} may be {unit.high:g} at most ({unit.place})")
    elif unit.type == "rad" and abs(value) > TURN:
        hint = f"{value:g} degrees are {radians(value):.4g}"
        yield Fault("degrees", child, "", f"{where} is more than a turn: it is in radians", hint)


def _unread(child: _Element, above: str, name: str, section: Described) -> Iterator[Fault]:
    """What is not read where it is. Code may ask for it through a function that is given an element,
    so what is read anywhere counts as read, unless the block that it belongs to is there."""
    blocks = section.blocks_of.get(name)
    if blocks is None:
        yield from _unknown(child, above, name, section)
        return
    parent = child.getparent()
    there = (it for it in blocks if it and parent is not None and parent.find(it) is not None)
    beside = next(there, "")
    if beside:
        message = f"{title(section)} reads {name!r} in <{beside}>, not beside it"
        yield Fault("outside", child, None, message, f"move it into <{beside}>")


def _unknown(child: _Element, above: str, name: str, section: Described) -> Iterator[Fault]:
    inside = f" in <{above}>" if above else ""
    message = f"{title(section)} does not read {name!r}{inside}"
    parent, near = child.getparent(), slip_of(name, section.blocks[above])
    if parent is not None and near and parent.find(near) is not None:
        near = ""  # that one is there already
    other = "" if above else _of_another(name, section.kind, section.names[0])
    if other:
        hint = f"{other} does; did you mean {near!r}?" if near else f"{other} does"
        yield Fault("simulator", child, None, message, hint)
    elif near:
        yield Fault("misspelt", child, None, message, f"did you mean {near!r}?")
    elif child.tag != "param":
        # Hardware may have the names of its parameters where nobody looked: in constants, in libraries.
        yield Fault("unread", child, None, message)


@lru_cache(maxsize=512)
def _of_another(name: str, kind: str, library: str) -> str:
    """The plugin of the other ROS or simulator that does the same and has this parameter."""
    for other in _counterparts(kind, library):
        section = described(PLUGINS, other)
        # A block is no parameter that was taken from there: <imu> is an element of SDF as well.
        if section and name in section.rows and name not in section.blocks:
            return title(section)
    return ""


@lru_cache
def _counterparts(kind: str, library: str) -> tuple[str, ...]:
    """Those of the same name or subject: in the other ROS, in Gazebo for one of Classic, and the
    reverse."""
    own = _subject(library)
    of_gz = library.startswith(GZ)
    starts = (GAZEBO_ROS, ROS_1 + GAZEBO_ROS) if of_gz else (GZ,)
    found = [
        it
        for it in chunks(PLUGINS)
        if (it.startswith(starts) or (of_gz and it.endswith(CLASSIC))) and "::" not in it
    ]
    same = sorted(it for it in found if own and _subject(it.removeprefix(ROS_1)) == own)
    return (library if kind else ROS_1 + library, *same)


def _subject(library: str) -> str:
    """What a plugin is about by the words of its library."""
    bare = fold(library.removeprefix(GZ).removeprefix(GAZEBO_ROS).removesuffix("-system"))
    return bare.removesuffix(CLASSIC.casefold()).removesuffix("_sensor").replace("_", "")


def _missing(
    element: _Element, section: Described, given: Iterable[str], release: str
) -> Iterator[Fault]:
    for name in section.needed:
        row = section.rows[name][0]
        if name not in given and has_release(row.releases, release):
            message = f"{title(section)} needs {name!r}"
            yield Fault(
                "missing", element, None, message, f"without it, it is not loaded ({row.place})"
            )


def title(section: Described) -> str:
    """What a section is about, as a message has it."""
    return section.names[0] + " of ROS 1" * (section.kind == ROS_1.strip())
