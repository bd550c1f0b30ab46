# SPDX-License-Identifier: Apache-2.0
"""Values in <ros2_control> that its parser or the hardware refuses, or that leave the joint's limits.

Sources: ros2_control hardware_interface/src/component_parser.cpp (``parse_rw_rate_attribute``,
``parse_interfaces_from_xml``, 'has no mimic information in the URDF'), joint_limits of the URDF in
``retrieve_position_limits``; gz_ros2_control/src/gz_system.cpp (stod of ``initial_value``).
"""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.description.checks.links_and_joints import BOUNDED, Joint
from multibot_rewrite.description.checks.numbers import number, value_of
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.rules.facts.memo import since_jazzy
from multibot_rewrite.rules.subject import Subject

_COMMAND, _STATE = "command_interface", "state_interface"
# <param> of an interface that code reads as a number.
_NUMBERS = frozenset(("min", "max", "initial_value"))
# Of a limit; numbers are rounded.
_SLACK = 1.02
_WHOLE = {"rw_rate": "a whole number of hertz", "thread_priority": "a whole number"}


def unreadable_numbers(subject: Subject) -> Iterator[Problem]:
    """Rates and limits of <ros2_control> that are no numbers."""
    for system in subject.elements.tops("ros2_control"):
        for name, words in _WHOLE.items():
            text = system.get(name, "0")
            if not text.isdigit() and "$" not in text:
                message = f"{name} is {text!r}, not {words}"
                yield Problem(system, message, name, level=NOTE if since_jazzy(subject) else "")
        for it in _params(system):
            text = text_of(it)
            if it.get("name") in _NUMBERS and "$" not in text and number(text) is None:
                hint = "use a decimal point" if "," in text else "write a number"
                message = f"{it.get('name')} is {text!r}, which is no number"
                yield Problem(it, message, "", hint, level=_level(subject, it, text))


def _level(subject: Subject, param: _Element, text: str) -> str:
    """Humble keeps min and max and reads neither (component_parser.cpp:261), later releases go on
    without them (``retrieve_min_max_interface_values``); an empty value is none."""
    if param.get("name") == "initial_value":
        return "" if text else WARNING
    return NOTE if since_jazzy(subject) else WARNING


def _params(system: _Element) -> Iterator[_Element]:
    for part in system.iterchildren("joint", "gpio", "sensor"):
        for interface in part.iterchildren(_COMMAND, _STATE):
            yield from interface.iterchildren("param")


def mimic_of_none(subject: Subject) -> Iterator[Problem]:
    """Joints of <ros2_control> that are to mimic and have no <mimic> in the robot."""
    for system in subject.elements.tops("ros2_control"):
        for it in system.iterchildren("joint"):
            joint = subject.robot.joint.get(it.get("name", ""))
            if joint is None or it.get("mimic", "").strip().lower() not in ("true", "1"):
                continue
            if "mimic" not in joint.parts:
                message = f"joint {joint.name!r} is to mimic, and its <joint> has no <mimic>"
                yield Problem(it, message, "mimic", "add <mimic>, or leave the attribute out")


@rule("MB538", "command-beyond-limits", WARNING)
def command_beyond_limits(subject: Subject) -> Iterator[Problem]:
    """Positions against lower and upper, velocities and efforts against theirs."""
    for system in subject.elements.tops("ros2_control"):
        for it in system.iterchildren("joint"):
            joint = subject.robot.joint.get(it.get("name", ""))
            for interface in it.iterchildren(_COMMAND):
                yield from _inverted(interface)
                bounds = _bounds(joint, interface.get("name", "")) if joint else None
                if joint and bounds:
                    yield from _beyond(joint, interface, *bounds)


def _inverted(interface: _Element) -> Iterator[Problem]:
    params = {it.get("name"): it for it in interface.iterchildren("param")}
    found = {name: number(text_of(params[name])) for name in ("min", "max") if name in params}
    low, high = found.get("min"), found.get("max")
    if low is not None and high is not None and low > high:
        message = f"min of {interface.get('name')} is {low:g}, above its max ({high:g})"
        yield Problem(params["min"], message, "", "swap the two")


def _beyond(joint: Joint, interface: _Element, low: float, high: float) -> Iterator[Problem]:
    for param in interface.iterchildren("param"):
        value = number(text_of(param))
        if value is None or param.get("name") not in ("min", "max"):
            continue
        if not low * _SLACK - 0.01 <= value <= high * _SLACK + 0.01:
            name = interface.get("name")
            message = f"{param.get('name')} of {name} of joint {joint.name!r} is {value:g}"
            hint = f"its <limit> is {low:g} to {high:g}"
            yield Problem(param, message, "", hint, level="" if name == "position" else NOTE)


def _bounds(joint: Joint, interface: str) -> tuple[float, float] | None:
    limit = joint.parts.get("limit")
    if limit is None:
        return None
    if interface == "position":
        low, high = value_of(limit, "lower"), value_of(limit, "upper")
        known = joint.type in BOUNDED and low is not None and high is not None and low < high
        return (low, high) if known and low is not None and high is not None else None
    most = value_of(limit, interface) if interface in ("velocity", "effort") else None
    return (-most, most) if most else None
