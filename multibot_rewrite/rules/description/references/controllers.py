# SPDX-License-Identifier: Apache-2.0
"""The interfaces that controllers claim in a description's files, and the joints of MuJoCo models."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import suppress
from typing import TYPE_CHECKING

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, URDF, rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.outside import is_file
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.readback.reading import read_tree
from multibot_rewrite.description.readback.xml import read_xml
from multibot_rewrite.description.rewriters.text import text_at, text_of
from multibot_rewrite.description.sources.packages import entries, find_in, package_folder
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.rules import declaration
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.facts.source_values import is_fixed, starts_of
from multibot_rewrite.rules.subject import COMMAND, STATE, Subject, name_of

if TYPE_CHECKING:
    from multibot_rewrite.rules.system.states import Missing
    from multibot_rewrite.system.records import Interface

_IN_PACKAGE = lazy_compile(r"(?:\$\(find(?:-pkg-share)?\s+([^)\s]+)\)|package://([^/]+))/(.+)")
_YAML = (".yaml", ".yml")


def _not_exported(subject: Subject) -> Iterator[Problem]:
    """Yield a problem for each interface that controllers claim and the description does not export."""
    for element, known in _claimed(subject):
        # Few descriptions need them.
        from multibot_rewrite.rules.system.states import missing_message

        for it in missing_in(subject, known):
            # Lines of an expanded xacro are in no file.
            message, hint = missing_message(it, None if subject.origins else "line {0.line}".format)
            yield Problem(
                element,
                f"{_place_of(it.claims[0])}: {message}",
                _place_in(element),
                hint,
            )


def missing_in(subject: Subject, known: tuple[Interface, ...]) -> Iterator[Missing]:
    """Yield what controllers claim and the description does not export."""
    from multibot_rewrite.rules.system.states import missing
    from multibot_rewrite.system.records import EXPORTS

    chosen = _chosen(subject) if any(missing(known)) else ()
    said = "{0.kind} interface {0.name}".format
    yield from missing(
        [it for it in known if it.role == EXPORTS or not said(it).startswith(chosen)]
    )


def _claimed_twice(subject: Subject) -> Iterator[Problem]:
    """Yield a problem for each interface that a controller claims by two parameters."""
    for element, known in _claimed(subject):
        from multibot_rewrite.rules.system.states import claimed_twice

        for other, twice in claimed_twice(known):
            message = f"{_place_of(twice)}: {twice.node} claims {twice.name} by two parameters"
            hint = f"name another joint there, or in {_place_of(other)}"
            yield Problem(element, message, _place_in(element), hint)


def _place_in(element: _Element) -> str | None:
    """Return where in an element a file is named: its text, or nowhere."""
    return "" if element.tag == "parameters" else None


interface_not_exported = declaration.NOT_EXPORTED._replace(
    check=_not_exported, formats=(URDF,), options={}, examples="MB229-urdf"
)
interface_claimed_twice = declaration.CLAIMED_TWICE._replace(
    check=_claimed_twice, formats=(URDF,), options={}, examples="MB240-urdf"
)


def _of_no_node(subject: Subject) -> Iterator[Problem]:
    """Yield a problem for a section that names another node than the manager of its plugin."""
    systems = subject.elements.tops("ros2_control")
    files = [
        it
        for it in (_controller_files(subject, systems[0]) if systems else ())
        if _place_in(it[0]) == ""
    ]
    if not files:
        return
    from multibot_rewrite.related_files.params.sections import meant_for, raw_sections
    from multibot_rewrite.related_files.yaml_text import read_yaml

    plugins = list(subject.document.root.iter("plugin"))
    nodes = read_tree(subject.document.root, subject.tree.definitions).nodes
    managers = {plugins[it.number]: it.manager for it in nodes if it.manager}
    for element, path, _ in files:
        plugin = element.getparent()
        manager = "" if plugin is None else managers.get(plugin, "")
        with suppress(InputError):
            sections = raw_sections(read_yaml(read_file(path), path)) if manager else ()
            if section := meant_for(sections, manager, ()):
                message, hint = declaration.section_message(section.path, [manager])
                yield Problem(element, f"{os.path.basename(path)}: {message}", "", hint)


section_of_no_node = declaration.OF_NO_NODE._replace(
    check=_of_no_node, formats=(URDF,), options={}, examples="MB244-urdf"
)


_MUJOCO = "mujoco_ros2_control/MujocoSystemInterface"
_BODIES = ("body", "frame", "replicate")


@rule("MB245", "mujoco-joint-without-name", ERROR)
def mujoco_joint_without_name(subject: Subject) -> Iterator[Problem]:
    """Report joints without a name in the MuJoCo model that the hardware names, and its includes."""
    for system in subject.elements.tops("ros2_control"):
        param = system.find("hardware/param[@name='mujoco_model']")
        if param is None or text_at(system, "hardware/plugin") != _MUJOCO:
            continue
        path = _resolved_path(subject, text_of(param))
        bare = [it for it in _joints_of(path, {path}) if not it[0].get("name")]
        moved = [it for it in bare if it[0].tag == "joint" and it[0].get("type") != "free"]
        what = f"{len(moved)} joints have" if moved else "its free joint has"
        for joint, file in (moved or bare)[:1]:
            message = f"{os.path.basename(file)}:{joint.sourceline}: {what} no name"
            hint = "name each joint" if moved else "name it, which versions before 0.0.3 ask for"
            yield Problem(param, message, None, hint, level="" if moved else NOTE)


def _joints_of(path: str, seen: set[str]) -> Iterator[tuple[_Element, str]]:
    """Yield (joint, file) for the bodies of a MuJoCo model and its includes."""
    with suppress(InputError):
        root = read_xml(read_file(path), path)
        yield from ((it, path) for above in _BODIES for it in root.iterfind(f".//{above}/joint"))
        yield from ((it, path) for it in root.iter("freejoint"))
        for it in root.iter("include"):
            file = os.path.join(os.path.dirname(path), it.get("file", ""))
            if file not in seen:
                seen.add(file)
                yield from _joints_of(file, seen)


@memoized
def _claimed(subject: Subject) -> list[tuple[_Element, tuple[Interface, ...]]]:
    """Return (element that names it, interfaces exported and claimed) for each controllers' file."""
    systems = subject.elements.tops("ros2_control")
    files = _controller_files(subject, systems[0]) if systems else ()
    found = ((element, _interfaces(subject, path, is_sure)) for element, path, is_sure in files)
    return [it for it in found if it[1]]


def _chosen(subject: Subject) -> tuple[str, ...]:
    """Return the beginnings of interface names that an argument of xacro chooses."""
    if not subject.origins:
        return ()
    interfaces = {
        it: owner
        for owner in subject.elements.owners()
        for it in owner.iterchildren(COMMAND, STATE)
    }
    return tuple(
        f"{str(it.tag).removesuffix('_interface')} interface {name_of(interfaces[it])}/"
        for it, start in starts_of(subject, interfaces).items()
        if not is_fixed(subject, start, "name")
    )


def _place_of(it: Interface) -> str:
    """Return where an interface is written: ``file.xacro:12``."""
    return f"{os.path.basename(it.place.file)}:{it.place.line}"


def _controller_files(subject: Subject, system: _Element) -> Iterator[tuple[_Element, str, bool]]:
    """Yield (element that names it, file, is it surely this robot's) of each controllers' file."""
    named = [
        element
        for host in subject.inventory.hosts
        if host.node.section and host.node.section.process_wide
        for element in host.element.iterchildren("parameters")
    ]
    starts = starts_of(subject, named) if subject.origins else {}
    for element in named:
        path = _resolved_path(subject, text_of(element))
        # What an argument of xacro names by default may be the file of another robot.
        own = element not in starts or is_fixed(subject, starts[element], "")
        if path.endswith(_YAML) and is_file(path):
            yield element, path, own
    if not named:
        folder = os.path.dirname(os.path.abspath(subject.document.file))
        beside = [it for it in entries(folder) if "controllers" in it and it.endswith(_YAML)]
        if len(beside) == 1:
            yield system, os.path.join(folder, beside[0]), False


def _resolved_path(subject: Subject, text: str) -> str:
    """Return the path of a named file; empty if its package is not found."""
    file = subject.document.file
    named = _IN_PACKAGE.fullmatch(text)
    if not named:
        return os.path.join(os.path.dirname(file), text.removeprefix("file://"))
    folder = package_folder(named[1] or named[2], file, subject.settings.roots)
    below = find_in(folder, named[3]) if folder else ""
    return os.path.join(folder, below) if below else ""


def _interfaces(subject: Subject, path: str, is_sure: bool) -> tuple[Interface, ...]:
    """Return the interfaces exported, and claimed by a file's controllers; none of another robot."""
    # Most descriptions have no such file, and a lint of them loads nothing of this.
    from multibot_rewrite.knowledge.node_sets import load_nodes
    from multibot_rewrite.knowledge.parameters import load_known_nodes
    from multibot_rewrite.producers.evidence.hardware import control_system, exported
    from multibot_rewrite.producers.evidence.parameter_files import given_nodes
    from multibot_rewrite.related_files.yaml_text import read_yaml
    from multibot_rewrite.rules.system.states import claims_any

    release, document = subject.settings.distro, subject.document
    try:
        given = given_nodes([read_yaml(read_file(path), path)], load_known_nodes("", release))
    except InputError:
        # It is said where the file itself is read.
        return ()
    exports = exported(document.root, document.file)
    known = control_system(given, load_nodes(release), exports).interfaces
    return known if is_sure or claims_any(known) else ()
