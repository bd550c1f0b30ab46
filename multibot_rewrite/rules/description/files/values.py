# SPDX-License-Identifier: Apache-2.0
"""Elements, attributes and parameters that their readers do not expect, or miss; values that they
reject, misread, or take for something else.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import SRDF, URDF, rule
from multibot_rewrite.companions.named_file import MOVEIT, PARAMS
from multibot_rewrite.description.checks.numbers import number
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.rules.description.files.libraries import (
    misspelt_hardware,
    misspelt_libraries,
    plugins_without_library,
)
from multibot_rewrite.rules.description.references.control import misspelt_interfaces
from multibot_rewrite.rules.description.references.gazebo import (
    sensors_elsewhere,
    sensors_of_joints,
)
from multibot_rewrite.rules.description.structure.control_values import unreadable_numbers
from multibot_rewrite.rules.description.structure.joints import (
    limits_in_degrees,
    origins_in_degrees,
)
from multibot_rewrite.rules.facts.faults import faults
from multibot_rewrite.rules.facts.memo import lacking
from multibot_rewrite.rules.facts.sensors import CAMERAS, LIDARS, number_at
from multibot_rewrite.rules.subject import Subject


@rule("MB110", "misspelt", WARNING, formats=(URDF, SRDF, PARAMS, MOVEIT))
def misspelt(subject: Subject) -> Iterator[Problem]:
    """Elements, attributes, parameters; what a plugin or <hardware> loads; interfaces."""
    yield from faults("misspelt", subject)
    yield from misspelt_libraries(subject)
    yield from misspelt_hardware(subject)
    yield from misspelt_interfaces(subject)


not_read = rule("MB111", "not-read", NOTE, formats=(URDF, PARAMS))(partial(faults, "not-read"))


@rule("MB112", "misplaced", WARNING)
def misplaced(subject: Subject) -> Iterator[Problem]:
    """By what each reader looks for where, and sensors that no block of a link has."""
    yield from faults("misplaced", subject)
    yield from sensors_of_joints(subject)
    yield from sensors_elsewhere(subject)


@rule("MB115", "missing", ERROR, formats=(URDF, SRDF, PARAMS, MOVEIT))
def missing(subject: Subject) -> Iterator[Problem]:
    """By what each reader requires."""
    root = subject.document.root
    for it in faults("missing", subject):
        # What includes a part of a robot may have its name.
        yield from lacking(subject, [it]) if it.element is root else [it]
    yield from plugins_without_library(subject)


repeated_element = rule("MB116", "repeated-element", WARNING)(partial(faults, "repeated"))

of_another_release = rule("MB157", "of-another-release", NOTE, options={"distro": "humble"})(
    partial(faults, "later")
)

of_another_simulator = rule("MB163", "parameter-of-other-simulator", WARNING)(
    partial(faults, "simulator")
)


@rule("MB120", "unreadable-value", ERROR, formats=(URDF, SRDF, PARAMS, MOVEIT))
def unreadable_value(subject: Subject) -> Iterator[Problem]:
    """All but those with a substitution: MB105 reports them."""
    yield from (it for it in faults("value", subject) if "$" not in it.message)
    yield from unreadable_numbers(subject)


unknown_word = rule("MB124", "unknown-word", ERROR, formats=(URDF, SRDF, PARAMS, MOVEIT))(
    partial(faults, "word")
)


@rule("MB125", "out-of-range", ERROR, formats=(URDF, PARAMS, MOVEIT))
def out_of_range(subject: Subject) -> Iterator[Problem]:
    """By what each reader takes, and what a sensor needs to see anything; MB120 has what is misread."""
    misread = {it.element for it in faults("value", subject)}
    yield from faults("range", subject)
    yield from (it for it in unusable_numbers(subject) if it.element not in misread)
    yield from (it for it in sees_nothing(subject) if it.element not in misread)


@rule("MB170", "angle-in-degrees", WARNING)
def angle_in_degrees(subject: Subject) -> Iterator[Problem]:
    """Values below <gazebo> and of plugins, and limits."""
    yield from faults("degrees", subject)
    yield from origins_in_degrees(subject)
    yield from limits_in_degrees(subject)


_LIDAR = ("lidar", "ray")
# No lidar sees as far, in metres, and none is blind for as long.
FAR, BLIND = 2000.0, 20.0
_ABOVE_0 = {
    "camera": ("image/width", "image/height", "clip/near", "horizontal_fov"),
    "lidar": ("scan/horizontal/samples", "range/max"),
}


def sees_nothing(subject: Subject) -> Iterator[Problem]:
    """Pictures without a pixel, scans without a ray, negative rates, ranges in millimetres."""
    for sensor in subject.elements.every("sensor"):
        type_ = sensor.get("type", "")
        rate = number_at(sensor, "update_rate")
        if rate is not None and rate < 0:
            yield _problem(sensor, "update_rate", "is below 0")
        for inner in sensor.iterchildren("camera") if type_ in CAMERAS else ():
            yield from _none_of(inner, _ABOVE_0["camera"])
        for inner in sensor.iterchildren(*_LIDAR) if type_ in LIDARS else ():
            yield from _none_of(inner, _ABOVE_0["lidar"])
            yield from _in_millimetres(inner)


def unusable_numbers(subject: Subject) -> Iterator[Problem]:
    """Steps of no time, reductions of 0, minima of a plugin above their maxima."""
    every = subject.elements.every
    for physics in every("physics"):
        above = physics.getparent()
        if above is not None and above.tag == "world":
            yield from _none_of(physics, ("max_step_size",))
    for element in (it for tag in _REDUCTIONS for it in every(tag)):
        if number(text_of(element)) == 0:
            yield Problem(element, f"{element.tag} is 0, by which is divided", level=WARNING)
    for plugin in every("plugin"):
        yield from _inverted(plugin)


_REDUCTIONS = ("mechanicalReduction", "mechanical_reduction")


def _inverted(plugin: _Element) -> Iterator[Problem]:
    for least in plugin.iterchildren("*"):
        tag = str(least.tag)
        low = number(text_of(least)) if tag.startswith("min_") else None
        high = number_at(plugin, f"max_{tag.removeprefix('min_')}") if low is not None else None
        if low is not None and high is not None and low > high:
            message = f"{tag} is {low:g}, above max_{tag.removeprefix('min_')} ({high:g})"
            yield Problem(least, message, "", "swap the two, or correct one", level=WARNING)


def _none_of(inner: _Element, paths: tuple[str, ...]) -> Iterator[Problem]:
    for path in paths:
        value = number_at(inner, path)
        if value is not None and value <= 0:
            yield _problem(inner, path, "has to be above 0")


def _in_millimetres(lidar: _Element) -> Iterator[Problem]:
    near, far = number_at(lidar, "range/min"), number_at(lidar, "range/max")
    if near is not None and far is not None and near >= BLIND and far >= FAR:
        yield _problem(
            lidar, "range/max", "is a length in metres", "divide by 1000: are these millimetres?"
        )


def _problem(above: _Element, path: str, words: str, hint: str = "") -> Problem:
    element = above.find(path)
    assert element is not None
    message = f"{element.tag} is {(element.text or '').strip()}, which {words}"
    return Problem(element, message, "", hint, level=WARNING)
