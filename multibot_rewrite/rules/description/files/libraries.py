# SPDX-License-Identifier: Apache-2.0
"""What a ``<plugin>`` or ``<hardware>`` loads: a library without a name, a class that it does not
have."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.nearest import nearest, slip_of
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.unknown import is_unknown
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.description.rewriters.tree import library_key
from multibot_rewrite.description.sources.packages import (
    package_folder,
    packages_below,
    sources_around,
)
from multibot_rewrite.rules.facts.simulators import library_of, simulator_plugins
from multibot_rewrite.rules.subject import Subject

# gz-sim10_10.4.0 src/SystemLoader.cc no longer takes ignition-gazebo for gz-sim; 9_9.5.0:125 does.
WITHOUT_IGNITION = ("lyrical", "rolling")
_IGNITION = "ignition-gazebo"
# Where SDF requires the name: before 1.10 (plugin.sdf).
NAMED = ("humble",)
# How the libraries of a family begin and end.
FAMILIES = (("gz-sim-", "-system"), ("gazebo_ros_", ""))


def plugins_without_library(subject: Subject) -> Iterator[Problem]:
    """Plugins below ``<gazebo>`` or in an SDF; the attribute that SDF requires in this release;
    hardware without a class, for which ros2_control throws."""
    for system in subject.elements.tops("ros2_control"):
        for empty in (it for it in system.iterfind("hardware/plugin") if not text_of(it)):
            yield Problem(empty, "<plugin> of the hardware is empty", None, "write its class")
    named = subject.settings.distro in NAMED
    for it in simulator_plugins(subject):
        if not it.get("filename", "").strip():
            yield Problem(it, "<plugin> has no 'filename'", None, "name the library that it loads")
        elif named and "name" not in it.attrib:
            yield Problem(it, "<plugin> has no 'name'", None, "SDF requires one before 1.10")


@rule("MB160", "class-not-in-library", ERROR)
def class_not_in_library(subject: Subject) -> Iterator[Problem]:
    """Systems that come with Gazebo: their libraries have no other classes, in any release."""
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
        section = subject.tree.vocabulary.values(library)
        classes = [known for known in section.names if "::" in known] if section else []
        if classes and name not in classes:
            message = f"{it.get('name', '').strip()!r} is no class of {library}"
            yield Problem(
                it, message, "name", f"did you mean {nearest(name, classes, 0) or classes[0]!r}?"
            )


def _misspelt_library(
    subject: Subject, plugin: _Element, library: str, name: str
) -> Iterator[Problem]:
    """Yield a library that is not known, of a class that is: that of another one, nearly spelt so. A
    library that is not called as those of Gazebo may be anybody's."""
    vocabulary = subject.tree.vocabulary
    if "::" not in name or vocabulary.values(library) or vocabulary.find("plugin", library):
        return
    section = vocabulary.values(name)
    near = nearest(library, [it for it in section.names if "::" not in it] if section else [])
    if near and near != library:
        message = f"no library of Gazebo is called {library!r}; {name} is in another one"
        level = "" if library.startswith(FAMILIES[0][0]) else NOTE
        yield Problem(plugin, message, "filename", f"did you mean {near!r}?", level=level)


def misspelt_libraries(subject: Subject) -> Iterator[Problem]:
    """Libraries in no vocabulary."""
    for host in subject.inventory.hosts:
        section, name = host.node.section, host.element.get("filename", "").strip()
        if host.element.tag != "plugin" or not section or not is_unknown(section) or not name:
            continue
        key = library_key(name.rpartition("/")[2])
        near = _slip_of_library(key, subject.tree.vocabulary.names("plugin"))
        if near:
            message = f"no known plugin is called {name!r}"
            level = "" if key.startswith(tuple(start for start, _ in FAMILIES)) else NOTE
            yield Problem(host.element, message, "filename", f"did you mean {near!r}?", level=level)


def misspelt_hardware(subject: Subject) -> Iterator[Problem]:
    """Yield the classes that are in no vocabulary and in none of the sources; another package may have
    what the known ones do not."""
    for system in subject.elements.tops("ros2_control"):
        for it in system.iterfind("hardware/plugin"):
            name = text_of(it)
            known = [*subject.tree.vocabulary.names("hardware")]
            near = "" if name in known or "$" in name else _slip(name, known)
            package = name.partition("/")[0]
            level = "" if any(it.startswith(f"{package}/") for it in known) else NOTE
            if near and not (level and _is_in_sources(subject, package)):
                message = f"no known hardware is called {name!r}"
                yield Problem(it, message, "", f"did you mean {near!r}?", level=level)


def _is_in_sources(subject: Subject, package: str) -> bool:
    file = subject.document.file
    around = packages_below((sources_around(file), *subject.settings.roots))
    return package in around or bool(package_folder(package, file, subject.settings.roots))


@rule("MB172", "library-of-ignition", WARNING)
def library_of_ignition(subject: Subject) -> Iterator[Problem]:
    """Libraries by their old names, in releases that no longer know them."""
    release = subject.settings.distro
    if release not in WITHOUT_IGNITION:
        return
    found = [it for it in simulator_plugins(subject) if _IGNITION in it.get("filename", "")]
    if found:
        first = library_of(found[0])
        more = f" and {len(found) - 1} more" if len(found) > 1 else ""
        message = f"Gazebo of {release} finds no {found[0].get('filename', '')!r}{more}"
        hint = f"write {first}, or name the release that the description is for with --distro"
        level = ERROR if subject.settings.simulated else ""
        yield Problem(found[0], message, "filename", hint, level=level)


def _slip_of_library(name: str, known: Iterable[str]) -> str:
    """The same for a library: what all of a family have in common does not make two alike."""
    start, end = next((it for it in FAMILIES if name.startswith(it[0])), ("", ""))
    stems = {
        it.removeprefix(start).removesuffix(end): it
        for it in known
        if it.startswith(start) and "::" not in it
    }
    return stems.get(_slip(name.removeprefix(start).removesuffix(end), stems), "")


def _slip(name: str, known: Iterable[str]) -> str:
    """The known name that was meant; one that is a part of the other is a name of its own."""
    near = slip_of(name, known)
    part = near in name or name in near
    own = _has_own_word(name, near) or (part and near.casefold() != name.casefold())
    return "" if own else near


def _has_own_word(name: str, other: str) -> bool:
    """Is a word in place of another one without a letter of it, as ``my`` of ``uuv``?"""
    words, others = name.casefold().split("_"), other.casefold().split("_")
    pairs = zip(words, others, strict=False) if len(words) == len(others) else ()
    return any(one and two and not set(one) & set(two) for one, two in pairs)
