# SPDX-License-Identifier: Apache-2.0
"""Parameters of one node alone: the filter chains of laser_filters, the commands of joy_teleop.

Sources: ros/filters 2.1.1 filter_chain.hpp (``load_chain_config``: filter1, filter2 ... up to the
first number without name and type; one without the other, or a name twice, and the chain is not
configured); ros-teleop/teleop_tools 99d16d74c joy_teleop/joy_teleop/joy_teleop.py
(JoyTeleopCommand, JoyTeleopTopicCommand, ``get_interface_type``, ``get_parent_member``,
JoyTeleop.__init__)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, rule
from multibot_rewrite.base.grouping import dicts_by_key
from multibot_rewrite.related_files.named_file import PARAMS, NamedFile
from multibot_rewrite.rules.declaration import remark_at
from multibot_rewrite.rules.files.plugins import FILTER
from multibot_rewrite.rules.files.section_facts import Section, Setting, sections

# Type of a command -> the middle of its interface's type, what names it, and what starts it.
_TYPES = {
    "topic": ("msg", "topic_name", ("deadman_buttons", "deadman_axes", "deadman_axes_negative")),
    "service": ("srv", "service_name", ("buttons", "axes", "axes_negative")),
    "action": ("action", "action_name", ("buttons", "axes", "axes_negative")),
}
_MAPPINGS, _VALUE = "axis_mappings", "message_value"
# The first fields of messages that are driven with.
_FIELDS = {
    "geometry_msgs/msg/Twist": ("linear", "angular"),
    "geometry_msgs/msg/TwistStamped": ("header", "twist"),
}
_NAMES = (word for _, name, starts in _TYPES.values() for word in (name, *starts))
_WORDS = frozenset(("type", "interface_type", *_NAMES))
_Values = Mapping[str, Setting]


@rule("MB897", "joystick-command", ERROR, formats=(PARAMS,))
def broken_commands(file: NamedFile) -> Iterator[Finding]:
    """Report each faulty command of joy_teleop, at its first parameter."""
    for section in sections(file):
        if section.node is None or section.node.name != "joy_teleop":
            continue
        parts = ((it.name.partition("."), it) for it in section.given if "." in it.name)
        commands = dicts_by_key(
            (name, rest, it) for (name, _, rest), it in parts if name != "qos_overrides"
        )
        for name, values in commands.items():
            if values.keys().isdisjoint(_WORDS):
                continue  # another node may have that name: teleop_twist_joy has blocks, too
            first = next(iter(values.values()))
            for words, hint in _command_faults(values):
                yield remark_at(first.key, f"{section.title}: command {name!r} {words}", hint)


def _command_faults(values: _Values) -> Iterator[tuple[str, str]]:
    """Yield (what is wrong, what to do) for a command of joy_teleop."""
    type_ = _text_of(values, "type")
    if type_ not in _TYPES:
        said = f"is of type {type_!r}" if type_ else "has no type"
        yield said, f"write one of {', '.join(_TYPES)}"
        return
    middle, named, starts = _TYPES[type_]
    for word in (it for it in ("interface_type", named) if it not in values):
        yield f"has no {word}", f"add {word}"
    kind = _text_of(values, "interface_type")
    parts = kind.split("/")
    if kind and (len(parts) != 3 or parts[1] != middle):
        yield f"has the interface_type {kind!r}", f"write PACKAGE/{middle}/{parts[-1]}"
    if not any(it in values and values[it].value not in (None, []) for it in starts):
        yield "is started by nothing", f"add {starts[0]}, or {' or '.join(starts[1:])}"
    if type_ == "topic":
        yield from _topic_command_faults(values, kind)


def _topic_command_faults(values: _Values, kind: str) -> Iterator[tuple[str, str]]:
    """Yield (what is wrong, what to do) for a command that publishes on a topic."""
    mapped, fixed = (
        any(it.startswith(f"{name}.") for it in values) for name in (_MAPPINGS, _VALUE)
    )
    if mapped == fixed:
        both = f"both {_VALUE} and {_MAPPINGS}" if mapped else f"neither {_VALUE} nor {_MAPPINGS}"
        yield f"has {both}", "give it one of the two"
    below = [it.removeprefix(f"{_MAPPINGS}.") for it in values if it.startswith(f"{_MAPPINGS}.")]
    for field in dict.fromkeys(it.rpartition(".")[0] for it in below):
        there = {it.rpartition(".")[2] for it in below if it.rpartition(".")[0] == field}
        if there.isdisjoint(("axis", "button", "value")):
            yield f"has no axis, button or value for {field}", "add one of them"
        missing = [it for it in ("scale", "offset") if it not in there] if "axis" in there else []
        if missing:
            words = f"has no {' and no '.join(missing)} for {field}"
            yield words, "add scale and offset of the axis"
        known = _FIELDS.get(kind, ())
        if known and field.strip("-").partition("-")[0] not in known:
            yield f"sets {field} of a {kind}, which has {' and '.join(known)}", "use one of these"


def _text_of(values: _Values, name: str) -> str:
    value = values[name].value if name in values else None
    return value if isinstance(value, str) else ""


# The number of a filter, or none, with its parts.
_Filters = Mapping[str, Mapping[str, Setting]]


@rule("MB896", "filter-chain", WARNING, formats=(PARAMS,))
def broken_chains(file: NamedFile) -> Iterator[Finding]:
    """Report every chain of a node of laser_filters."""
    own = (it for it in sections(file) if it.node and it.node.package == "laser_filters")
    for section, filters in ((it, chain) for it in own for chain in _filters_by_chain(it).values()):
        last = next(at for at in range(1, len(filters) + 2) if str(at) not in filters) - 1
        for number, parts in filters.items():
            if not number or int(number) > last:
                there = f"there is no filter{last + 1}"
                message = f"{section.title}: filter{number} is not loaded: {there}"
                hint = "filters are called filter1, filter2 and so on, without a gap"
                yield remark_at(next(iter(parts.values())).key, message, hint)
        yield from _incomplete_filters(section, filters)


def _filters_by_chain(section: Section) -> Mapping[str, _Filters]:
    found: dict[str, dict[str, dict[str, Setting]]] = {}
    for it in section.whole.values():
        if part := FILTER.fullmatch(it.name):
            filters = found.setdefault(part["chain"], {})
            filters.setdefault(part["number"], {}).setdefault(part["word"], it)
    return found


def _incomplete_filters(section: Section, filters: _Filters) -> Iterator[Finding]:
    names: dict[str, str] = {}
    for number, parts in filters.items():
        first = next(iter(parts.values()))
        for word in (it for it in ("name", "type") if it not in parts):
            message = f"{section.title}: filter{number} has no {word}"
            yield remark_at(
                first.key, message, "add it: the chain is not configured without", ERROR
            )
        name = str(parts["name"].value) if "name" in parts else ""
        if name and name in names:
            message = f"{section.title}: filter{number} has the name {name!r}, as {names[name]} has"
            yield remark_at(parts["name"].node, message, "give it another name", ERROR)
        names.setdefault(name, f"filter{number}")
