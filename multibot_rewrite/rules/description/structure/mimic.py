# SPDX-License-Identifier: Apache-2.0
"""Joints that mimic others, and positions against limits: followed ones, and those to start at."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.wording import SHOWN, shorten
from multibot_rewrite.description.checks.links_and_joints import (
    BOUNDED,
    ONE_AXIS,
    TYPES,
    Joint,
    Robot,
    joints_with,
)
from multibot_rewrite.description.checks.numbers import number, value_of
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.rules.facts.memo import since_jazzy
from multibot_rewrite.rules.subject import Subject


@rule("MB526", "mimic-loop", ERROR)
def mimic_loop(subject: Subject) -> Iterator[Problem]:
    """Report each loop, at its first mimic, and each mimic of the joint it is in."""
    for joint, mimic in joints_with(subject.robot, "mimic"):
        if mimic.get("joint") == joint.name and joint.name:
            yield Problem(mimic, f"joint {joint.name!r} mimics itself", "joint")
    for loop in _loops(_leaders(subject.robot)):
        if len(loop) > 1:
            mimic = subject.robot.joint[loop[0]].parts["mimic"]
            names = shorten(map(repr, loop), SHOWN)
            yield Problem(mimic, f"joints mimic each other in a loop: {names}", "joint")


@rule("MB528", "mimic-chain", NOTE)
def mimic_chain(subject: Subject) -> Iterator[Problem]:
    """Report mimics of mimics; a loop is MB526."""
    leader = _leaders(subject.robot)
    chained = {name: follows for name, follows in leader.items() if follows in leader}
    round_ = {name for loop in _loops(chained) for name in loop}
    for name, follows in chained.items():
        if name not in round_:
            late = "; robot_state_publisher sends no transform for it" if name < follows else ""
            message = f"joint {name!r} mimics {follows!r}, which mimics {leader[follows]!r}{late}"
            yield Problem(subject.robot.joint[name].parts["mimic"], message, "joint")


@rule("MB529", "mimic-of-fixed", ERROR)
def mimic_of_fixed(subject: Subject) -> Iterator[Problem]:
    """Report mimics of joints without one position; the mimic of a fixed joint does not matter."""
    others = {*TYPES} - {*ONE_AXIS}
    for joint, mimic in joints_with(subject.robot, "mimic"):
        leader = subject.robot.joint.get(mimic.get("joint", ""))
        if leader and leader.type in others and joint.type in ONE_AXIS:
            message = f"joint {joint.name!r} mimics {leader.name!r}, which is {leader.type}"
            yield Problem(mimic, message, "joint")


@rule("MB530", "mimic-multiplier-zero", WARNING)
def mimic_multiplier_zero(subject: Subject) -> Iterator[Problem]:
    """Report mimics whose joint never moves."""
    for joint, mimic in joints_with(subject.robot, "mimic"):
        if value_of(mimic, "multiplier", 1.0) == 0 and joint.type in ONE_AXIS:
            message = f"joint {joint.name!r} never moves: the multiplier of its mimic is 0"
            yield Problem(mimic, message, "multiplier")


def _leaders(robot: Robot) -> dict[str, str]:
    """Return by mimicking joint the joint that it follows."""
    return {
        joint.name: mimic.get("joint", "")
        for joint, mimic in joints_with(robot, "mimic")
        if robot.joint[joint.name] is joint
    }


def _loops(leader: Mapping[str, str]) -> list[list[str]]:
    """Return the loops of joints that follow each other."""
    done: set[str] = set()
    found = []
    for start in leader:
        way: dict[str, None] = {}
        name = start
        while name in leader and name not in done:
            done.add(name)
            way[name] = None
            name = leader[name]
        if name in way:
            found.append(list(way)[list(way).index(name) :])
    return found


Bounds = tuple[float, float]
# Of a joint's range; and in radians or metres.
PART, ROUNDING = 0.05, 0.01
CONTROLLER = "gz-sim-joint-position-controller-system"


@rule("MB536", "mimic-beyond-limits", WARNING)
def mimic_beyond_limits(subject: Subject) -> Iterator[Problem]:
    """Report joints with limits that follow a joint with limits."""
    for joint, mimic in joints_with(subject.robot, "mimic"):
        leader = subject.robot.joint.get(mimic.get("joint", ""))
        own, its = _bounds(joint), None if leader is None else _bounds(leader)
        ratio, shift = value_of(mimic, "multiplier", 1.0), value_of(mimic, "offset", 0.0)
        if leader is None or own is None or its is None or ratio is None or shift is None:
            continue
        low, high = sorted(it * ratio + shift for it in its)
        if _is_outside(low, own) or _is_outside(high, own):
            message = (
                f"joint {joint.name!r} goes from {low:.4g} to {high:.4g} with {leader.name!r}, its "
                f"limits are {own[0]:.4g} to {own[1]:.4g}"
            )
            yield Problem(mimic, message, None, f'lower="{low:.4g}" upper="{high:.4g}" would do')


def _bounds(joint: Joint) -> Bounds | None:
    """Return the limits of a joint that has a range; None for any other."""
    limit = joint.parts.get("limit") if joint.type in BOUNDED else None
    if limit is None:
        return None
    lower, upper = value_of(limit, "lower", 0.0), value_of(limit, "upper", 0.0)
    return None if lower is None or upper is None or lower >= upper else (lower, upper)


def _is_outside(value: float, bounds: Bounds) -> bool:
    slack = max(PART * (bounds[1] - bounds[0]), ROUNDING if bounds[1] - bounds[0] > 0.5 else 0.0)
    return not bounds[0] - slack <= value <= bounds[1] + slack


@rule("MB537", "start-beyond-limits", WARNING)
def start_beyond_limits(subject: Subject) -> Iterator[Problem]:
    """Report values that are numbers, of joints with a range."""
    for element, name in _start_values(subject):
        joint, value = subject.robot.joint.get(name), number(text_of(element))
        bounds = None if joint is None else _bounds(joint)
        if value is None or bounds is None or bounds[0] - 1e-3 <= value <= bounds[1] + 1e-3:
            continue
        limits = f"{bounds[0]:g} to {bounds[1]:g}"
        message = f"joint {name!r} starts at {value:g}, its limits are {limits}"
        yield Problem(element, message, "")


def _start_values(subject: Subject) -> Iterator[tuple[_Element, str]]:
    """Yield (element, joint) for each value that a joint starts at."""
    for system in subject.elements.tops("ros2_control"):
        for joint in system.iterchildren("joint"):
            for state in joint.iterchildren("state_interface"):
                for param in state.iterchildren("param") if state.get("name") == "position" else ():
                    if param.get("name") == "initial_value":
                        yield param, joint.get("name", "")
    for plugin, section in subject.inventory.served:
        if CONTROLLER in section.names:
            names = [text_of(it) for it in plugin.iterchildren("joint_name")]
            starts = [*plugin.iterchildren("initial_position")]
            yield from zip(starts, names[:1] * len(starts), strict=True)


_COMMAND, _STATE = "command_interface", "state_interface"
# <param> of an interface that code reads as a number.
_NUMBERS = frozenset(("min", "max", "initial_value"))
# Of a limit; numbers are rounded.
_SLACK = 1.02
# Attribute -> how it is read (component_parser.cpp, lexical_casts.cpp, hardware_info.hpp).
_READ_AS = {
    "rw_rate": (lazy_compile("[0-9]+"), "a whole number of hertz"),
    "thread_priority": (lazy_compile("[0-9]+"), "a whole number"),
    **dict.fromkeys(("is_async", "mimic"), (lazy_compile("(?i:true|false)"), "true or false")),
    "data_type": (
        lazy_compile("double|bool|float32|u?int(8|16|32)"),
        "double, bool, float32, int32 or uint8",
    ),
}


def unreadable_numbers(subject: Subject) -> Iterator[Problem]:
    """Report attributes and limits of <ros2_control> that its parser cannot read."""
    for system in subject.elements.tops("ros2_control"):
        parts = [*system.iterchildren("joint", "gpio", "sensor")]
        interfaces = [it for part in parts for it in part.iterchildren(_COMMAND, _STATE)]
        for it in (system, *parts, *interfaces):
            for name, (pattern, words) in _READ_AS.items():
                text = it.get(name, "$")
                if "$" not in text and not pattern.fullmatch(text.strip()):
                    message = f"{name} is {text!r}, not {words}"
                    level = NOTE if since_jazzy(subject) else ""
                    yield Problem(it, message, name, f"write {words}", level=level)
        for it in (param for one in interfaces for param in one.iterchildren("param")):
            text = text_of(it)
            if it.get("name") in _NUMBERS and "$" not in text and number(text) is None:
                hint = "use a decimal point" if "," in text else "write a number"
                message = f"{it.get('name')} is {text!r}, which is no number"
                yield Problem(it, message, "", hint, level=_level(subject, it, text))


def _level(subject: Subject, param: _Element, text: str) -> str:
    """Return the level of a value of <ros2_control> that is no number.

    Humble keeps min and max and reads neither (component_parser.cpp:261), later releases go on
    without them (``retrieve_min_max_interface_values``); an empty value is none."""
    if param.get("name") == "initial_value":
        return "" if text else WARNING
    return NOTE if since_jazzy(subject) else WARNING


def mimic_of_none(subject: Subject) -> Iterator[Problem]:
    """Report joints of <ros2_control> that are to mimic and have no <mimic> in the robot."""
    for it, joint in controlled_joints(subject):
        is_to = it.get("mimic", "").strip().lower() in ("true", "1")
        if is_to and "mimic" not in joint.parts:
            message = f"joint {joint.name!r} is to mimic, and its <joint> has no <mimic>"
            yield Problem(it, message, "mimic", "add <mimic>, or leave the attribute out")


def controlled_joints(subject: Subject) -> Iterator[tuple[_Element, Joint]]:
    """Yield the joints in <ros2_control> that the robot has, and what they are there."""
    for system in subject.elements.tops("ros2_control"):
        for it in system.iterchildren("joint"):
            if joint := subject.robot.joint.get(it.get("name", "")):
                yield it, joint


@rule("MB538", "command-beyond-limits", WARNING)
def command_beyond_limits(subject: Subject) -> Iterator[Problem]:
    """Report a min or max of a command interface outside of the joint's limit, or min above max."""
    for system in subject.elements.tops("ros2_control"):
        for it in system.iterchildren("joint"):
            joint = subject.robot.joint.get(it.get("name", ""))
            for interface in it.iterchildren(_COMMAND):
                yield from _inverted_bounds(interface)
                bounds = _bounds_of(joint, interface.get("name", "")) if joint else None
                if joint and bounds:
                    yield from _beyond_limits(joint, interface, *bounds)


def _inverted_bounds(interface: _Element) -> Iterator[Problem]:
    params = {it.get("name"): it for it in interface.iterchildren("param")}
    found = {name: number(text_of(params[name])) for name in ("min", "max") if name in params}
    low, high = found.get("min"), found.get("max")
    if low is not None and high is not None and low > high:
        message = f"min of {interface.get('name')} is {low:g}, above its max ({high:g})"
        yield Problem(params["min"], message, "", "swap the two")


def _beyond_limits(joint: Joint, interface: _Element, low: float, high: float) -> Iterator[Problem]:
    """Yield a problem for each bound of an interface outside of the joint's own limits."""
    for param in interface.iterchildren("param"):
        value = number(text_of(param))
        if value is None or param.get("name") not in ("min", "max"):
            continue
        if not low * _SLACK - 0.01 <= value <= high * _SLACK + 0.01:
            name = interface.get("name")
            message = f"{param.get('name')} of {name} of joint {joint.name!r} is {value:g}"
            hint = f"stay in its <limit>: {low:g} to {high:g}"
            yield Problem(param, message, "", hint, level="" if name == "position" else NOTE)


def _bounds_of(joint: Joint, interface: str) -> tuple[float, float] | None:
    """Return the joint's own limits for an interface; None without any."""
    limit = joint.parts.get("limit")
    if limit is None:
        return None
    if interface == "position":
        low, high = value_of(limit, "lower"), value_of(limit, "upper")
        known = joint.type in BOUNDED and low is not None and high is not None and low < high
        return (low, high) if known and low is not None and high is not None else None
    most = value_of(limit, interface) if interface in ("velocity", "effort") else None
    return (-most, most) if most else None
