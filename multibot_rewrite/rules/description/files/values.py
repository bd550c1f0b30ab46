# SPDX-License-Identifier: Apache-2.0
"""Elements, attributes, values and loaded classes that their readers do not expect, miss or misread."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import partial

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, SRDF, URDF, WARNING, rule
from multibot_rewrite.base.nearest import nearest, slip_of
from multibot_rewrite.description.checks.numbers import number
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.unknown import ANOTHER_RELEASE, is_unknown, not_here
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.description.rewriters.tree import library_key
from multibot_rewrite.description.sources import packages
from multibot_rewrite.related_files.named_file import MOVEIT, PARAMS
from multibot_rewrite.rules.description.references import duplicates
from multibot_rewrite.rules.description.references.control import misspelt_interfaces
from multibot_rewrite.rules.description.structure import joints
from multibot_rewrite.rules.description.structure.mimic import unreadable_numbers
from multibot_rewrite.rules.facts.faults import faults
from multibot_rewrite.rules.facts.memo import CAMERAS, LIDARS, lacking, number_at
from multibot_rewrite.rules.facts.simulators import library_of, simulator_plugins
from multibot_rewrite.rules.subject import Subject


@rule("MB110", "misspelt", WARNING, formats=(URDF, SRDF, PARAMS, MOVEIT))
def misspelt(subject: Subject) -> Iterator[Problem]:
    """Report misspelt elements, attributes and parameters, loaded classes, and interfaces."""
    yield from faults("misspelt", subject)
    yield from misspelt_libraries(subject)
    yield from misspelt_hardware(subject)
    yield from misspelt_interfaces(subject)


not_read = rule("MB111", "not-read", NOTE, formats=(URDF, PARAMS))(partial(faults, "not-read"))


@rule("MB112", "misplaced", WARNING)
def misplaced(subject: Subject) -> Iterator[Problem]:
    """Report elements where no reader looks for them, and sensors that no block of a link has."""
    yield from faults("misplaced", subject)
    yield from duplicates.sensors_of_joints(subject)
    yield from duplicates.sensors_elsewhere(subject)


@rule("MB115", "missing", ERROR, formats=(URDF, SRDF, PARAMS, MOVEIT))
def missing(subject: Subject) -> Iterator[Problem]:
    """Report what a reader requires and the file lacks."""
    root = subject.document.root
    for it in faults("missing", subject):
        # What includes a part of a robot may have its name.
        yield from lacking(subject, [it]) if it.element is root else [it]
    for system in subject.elements.tops("ros2_control"):
        for empty in (it for it in system.iterfind("hardware/plugin") if not text_of(it)):
            yield Problem(empty, "<plugin> of the hardware is empty", None, "write its class")
    named = subject.settings.distro in NAMED
    for plugin in simulator_plugins(subject):
        if not plugin.get("filename", "").strip():
            hint = "name the library that it loads"
            yield Problem(plugin, "<plugin> has no 'filename'", None, hint)
        elif named and "name" not in plugin.attrib:
            yield Problem(plugin, "<plugin> has no 'name'", None, "SDF requires one before 1.10")


repeated_element = rule("MB116", "repeated-element", WARNING)(partial(faults, "repeated"))

of_another_release = rule("MB157", "of-another-release", NOTE, options={"distro": "humble"})(
    partial(faults, "later")
)

of_another_simulator = rule("MB163", "parameter-of-other-simulator", WARNING)(
    partial(faults, "simulator")
)


@rule("MB120", "unreadable-value", ERROR, formats=(URDF, SRDF, PARAMS, MOVEIT))
def unreadable_value(subject: Subject) -> Iterator[Problem]:
    """Report all but values with a substitution: MB105 reports them."""
    yield from (it for it in faults("value", subject) if "$" not in it.message)
    yield from unreadable_numbers(subject)


@rule("MB124", "unknown-word", ERROR, formats=(URDF, SRDF, PARAMS, MOVEIT))
def unknown_word(subject: Subject) -> Iterator[Problem]:
    """Report values that are none of the allowed ones; sensor types of other releases are warnings."""
    definitions = subject.tree.definitions
    for it in faults("word", subject):
        type_ = it.element.get("type", "") if it.element.tag == "sensor" else ""
        others = definitions.releases_elsewhere("sensor", type_) if type_ else ()
        message = f"sensor@type {type_!r} {not_here(definitions, others)}"
        level = ERROR if subject.settings.simulated else WARNING
        later = it._replace(message=message, hint=ANOTHER_RELEASE, level=level)
        yield later if others else it


@rule("MB125", "out-of-range", ERROR, formats=(URDF, PARAMS, MOVEIT))
def out_of_range(subject: Subject) -> Iterator[Problem]:
    """Report values that readers refuse or that blind a sensor; MB120 reports misread ones."""
    misread = {it.element for it in faults("value", subject)}
    yield from faults("range", subject)
    yield from (it for it in unusable_numbers(subject) if it.element not in misread)
    yield from (it for it in sees_nothing(subject) if it.element not in misread)


@rule("MB170", "angle-in-degrees", WARNING)
def angle_in_degrees(subject: Subject) -> Iterator[Problem]:
    """Report angles below <gazebo> and of plugins, and limits, that are in degrees."""
    yield from faults("degrees", subject)
    yield from joints.origins_in_degrees(subject)
    yield from joints.limits_in_degrees(subject)


# No lidar sees as far, in metres, and none is blind for as long.
FAR, BLIND = 2000.0, 20.0
_ABOVE_0 = {
    "camera": ("image/width", "image/height", "clip/near", "horizontal_fov"),
    "lidar": ("scan/horizontal/samples", "range/max"),
}
_NOT_BELOW_0 = ("update_rate", "noise/stddev", "range/resolution")
# What is above another parameter counts as that one (gz-sim LinearBatteryPlugin.cc:252).
_LIMITED = {"initial_charge": "capacity"}


def sees_nothing(subject: Subject) -> Iterator[Problem]:
    """Report pictures without a pixel, scans without a ray, negative rates, ranges in millimetres."""
    for sensor in subject.elements.every("sensor"):
        type_ = sensor.get("type", "")
        yield from _not_positive(sensor)
        for inner in sensor.iterchildren("camera") if type_ in CAMERAS else ():
            yield from _not_positive(inner, _ABOVE_0["camera"])
        for inner in sensor.iterchildren("lidar", "ray") if type_ in LIDARS else ():
            # One that a camera draws (gz-sensors GpuLidarSensor.cc, SetNearClipPlane).
            drawn = ("range/min",) * type_.startswith("gpu_")
            yield from _not_positive(inner, (*_ABOVE_0["lidar"], *drawn))
            near, far = number_at(inner, "range/min"), number_at(inner, "range/max")
            if near is not None and far is not None and near >= BLIND and far >= FAR:
                hint = "divide by 1000: are these millimetres?"
                yield _number_problem(inner, "range/max", "is a length in metres", hint)


def unusable_numbers(subject: Subject) -> Iterator[Problem]:
    """Yield steps of no time, reductions of 0, and minima of a plugin above their maxima."""
    every = subject.elements.every
    for physics in every("physics"):
        above = physics.getparent()
        if above is not None and above.tag == "world":
            yield from _not_positive(physics, ("max_step_size",))
    for element in every("mechanicalReduction", "mechanical_reduction"):
        if number(text_of(element)) == 0:
            yield Problem(element, f"{element.tag} is 0, by which is divided", level=WARNING)
    for plugin in every("plugin"):
        for least in plugin.iterchildren("*"):
            tag = str(least.tag)
            most = "_".join("max" if it == "min" else it for it in tag.split("_"))
            most = _LIMITED.get(tag, most)
            low = number(text_of(least)) if most != tag else None
            high = number_at(plugin, most) if low is not None else None
            # Of a command or an integral -1 is no limit (gz-math PID.cc).
            free = high == -1 and most.endswith("max")
            if low is not None and high is not None and low > high and not free:
                message = f"{tag} is {low:g}, above {most} ({high:g})"
                yield Problem(least, message, "", "swap the two, or correct one", level=WARNING)


def _not_positive(inner: _Element, paths: tuple[str, ...] = ()) -> Iterator[Problem]:
    """Yield a problem for each number at these paths that is not above 0, and for negative ones."""
    for path in (*paths, *_NOT_BELOW_0):
        value = number_at(inner, path)
        if value is not None and (value < 0 or (value == 0 and path in paths)):
            yield _number_problem(
                inner, path, "has to be above 0" if path in paths else "is below 0"
            )


def _number_problem(above: _Element, path: str, words: str, hint: str = "") -> Problem:
    element = above.find(path)
    assert element is not None
    message = f"{element.tag} is {(element.text or '').strip()}, which {words}"
    return Problem(element, message, "", hint, level=WARNING)


# gz-sim10_10.4.0 src/SystemLoader.cc no longer takes ignition-gazebo for gz-sim; 9_9.5.0:125 does.
WITHOUT_IGNITION = ("lyrical", "rolling")
# Where SDF requires the name: before 1.10 (plugin.sdf).
NAMED = ("humble",)
# How the libraries of a family begin and end.
FAMILIES = (("gz-sim-", "-system"), ("gazebo_ros_", ""))


@rule("MB160", "class-not-in-library", ERROR)
def class_not_in_library(subject: Subject) -> Iterator[Problem]:
    """Report classes that the libraries of Gazebo's own systems do not have in any release."""
    for it in simulator_plugins(subject):
        library = library_of(it)
        if "::" in it.get("filename", ""):
            message = f"filename {it.get('filename')!r} is a class, not a library"
            yield Problem(it, message, "filename", "swap name and filename")
            continue
        name = it.get("name", "").strip().replace("ignition::gazebo::", "gz::sim::")
        yield from _misspelt_library(subject, it, library, name)
        if not name or "$" in name or not library.startswith(FAMILIES[0][0]):
            continue
        section = subject.tree.definitions.values(library)
        classes = [known for known in section.names if "::" in known] if section else []
        if classes and name not in classes:
            message = f"{it.get('name', '').strip()!r} is no class of {library}"
            hint = f"did you mean {nearest(name, classes, 0) or classes[0]!r}?"
            yield Problem(it, message, "name", hint)


def _misspelt_library(
    subject: Subject, plugin: _Element, library: str, name: str
) -> Iterator[Problem]:
    """Report an unknown library whose class is known in a library with nearly this name."""
    definitions = subject.tree.definitions
    if "::" not in name or definitions.values(library) or definitions.find("plugin", library):
        return
    section = definitions.values(name)
    near = nearest(library, [it for it in section.names if "::" not in it] if section else [])
    if near and near != library:
        message = f"no library of Gazebo is called {library!r}; {name} is in another one"
        level = "" if library.startswith(FAMILIES[0][0]) else NOTE
        yield Problem(plugin, message, "filename", f"did you mean {near!r}?", level=level)


def misspelt_libraries(subject: Subject) -> Iterator[Problem]:
    """Yield the libraries without a plugin definition."""
    for host in subject.inventory.hosts:
        section, name = host.node.section, host.element.get("filename", "").strip()
        if host.element.tag != "plugin" or not section or not is_unknown(section) or not name:
            continue
        key = library_key(name.rpartition("/")[2])
        if near := _meant_library(key, subject.tree.definitions.names("plugin")):
            message = f"no known plugin is called {name!r}"
            level = "" if key.startswith(tuple(start for start, _ in FAMILIES)) else NOTE
            yield Problem(host.element, message, "filename", f"did you mean {near!r}?", level=level)


def misspelt_hardware(subject: Subject) -> Iterator[Problem]:
    """Yield classes that nothing defines and that are nearly a known one's name."""
    for system in subject.elements.tops("ros2_control"):
        for it in system.iterfind("hardware/plugin"):
            name = text_of(it)
            known = [*subject.tree.definitions.names("hardware")]
            near = "" if name in known or "$" in name else _meant_name(name, known)
            package = name.partition("/")[0]
            level = "" if any(it.startswith(f"{package}/") for it in known) else NOTE
            if near and not (level and _is_in_sources(subject, package)):
                message = f"no known hardware is called {name!r}"
                yield Problem(it, message, "", f"did you mean {near!r}?", level=level)


def _is_in_sources(subject: Subject, package: str) -> bool:
    file = subject.document.file
    around = packages.packages_below((packages.sources_around(file), *subject.settings.roots))
    return package in around or bool(packages.package_folder(package, file, subject.settings.roots))


@rule("MB172", "library-of-ignition", WARNING)
def library_of_ignition(subject: Subject) -> Iterator[Problem]:
    """Report libraries by their old names, in releases that no longer know them."""
    release = subject.settings.distro
    if release not in WITHOUT_IGNITION:
        return
    found = [it for it in simulator_plugins(subject) if "ignition-gazebo" in it.get("filename", "")]
    if found:
        first = library_of(found[0])
        more = f" and {len(found) - 1} more" if len(found) > 1 else ""
        message = f"Gazebo of {release} finds no {found[0].get('filename', '')!r}{more}"
        hint = f"write {first}, or name the release that the description is for with --distro"
        level = ERROR if subject.settings.simulated else ""
        yield Problem(found[0], message, "filename", hint, level=level)


def _meant_library(name: str, known: Iterable[str]) -> str:
    """Return the known library that was meant; what all of a family share does not make two alike."""
    start, end = next((it for it in FAMILIES if name.startswith(it[0])), ("", ""))
    stems = {
        it.removeprefix(start).removesuffix(end): it
        for it in known
        if it.startswith(start) and "::" not in it
    }
    return stems.get(_meant_name(name.removeprefix(start).removesuffix(end), stems), "")


def _meant_name(name: str, known: Iterable[str]) -> str:
    """Return the known name that was meant; empty if one is part of the other, or another word."""
    near = slip_of(name, known)
    part = near in name or name in near
    # Is a word in place of another one without a letter of it, as ``my`` of ``uuv``?
    words, others = name.casefold().split("_"), near.casefold().split("_")
    pairs = zip(words, others, strict=False) if len(words) == len(others) else ()
    other = any(one and two and not set(one) & set(two) for one, two in pairs)
    return "" if other or (part and near.casefold() != name.casefold()) else near
