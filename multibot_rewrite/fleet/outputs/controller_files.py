# SPDX-License-Identifier: Apache-2.0
"""Gives each robot's description the controller file that was made for that robot.

gz_ros2_control and gazebo_ros2_control hand ``<parameters>`` on as ``--params-file``
(gz_ros2_control_plugin.cpp), and rcl opens it as it is: there is no ``package://`` and no
``$(find ...)``, and a relative path is one from where Gazebo was started."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding, declare
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.loose_xml import ESCAPES
from multibot_rewrite.base.model import Edit
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.description.sources.packages import in_sources, package_folder, package_of
from multibot_rewrite.description.steps.apply import cut
from multibot_rewrite.description.steps.document import text_slot
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.outputs.output_file import path_for
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot

PARAMETERS = "parameters"
# A package and the path in it, as xacro, a resource or an installed file names them.
IN_PACKAGE = lazy_compile(
    r"(?:\$\(find(?:-pkg-share)?\s+([^)\s]+)\)|package://([^/]+)|.*/share/([^/]+))/(.+)", re.DOTALL
)

OTHER_CONTROLLER_FILE = declare(
    "MF708", "controller-file-of-all-robots", WARNING, formats=("fleet",)
)


def with_own_controllers(robot: RewrittenRobot, folder: str) -> tuple[bytes, tuple[Finding, ...]]:
    """Return what the simulator gets, with the paths of this robot's files in ``folder``."""
    # It is unchanged without ``folder``, and for a real robot.
    if robot.spec.simulator == REAL:
        return robot.description, ()
    source = robot.member.inventory.document.source
    file = robot.spec.simulated or robot.spec.description
    params = robot.spec.related_files.get("params", ())
    edits: list[Edit] = []
    findings: list[Finding] = []
    for path, slot in loaded_files(robot) if params else ():
        same = [it for it in params if is_same(path, it, file)]
        if same and folder:
            made = os.path.join(folder, path_for(robot, same[0])).translate(ESCAPES)
            edits.append(Edit(*slot, made.encode(), None))
        elif not same and any(named_alike(path, it) for it in params):
            own = path_for(robot, path)
            message = (
                f"robot {robot.spec.name!r} has {own}, and its description still loads {path!r}"
            )
            hint = "name this very file under params"
            if not os.path.isfile(os.path.join(os.path.dirname(robot.spec.description), path)):
                hint = "that file is not there: write the path of the one under params into"
                hint = f"{hint} <{PARAMETERS}>"
            findings.append(at_robot(OTHER_CONTROLLER_FILE, robot, message, hint))
    return b"".join(cut(source, sorted(edits))), tuple(findings)


def loaded_files(robot: RewrittenRobot) -> Iterator[tuple[str, tuple[int, int]]]:
    """Yield (file, span of its path) for files that a plugin with a controller manager loads."""
    inventory = robot.member.inventory
    document = inventory.document
    starts = dict(zip(document.elements, document.starts, strict=True))
    for host in inventory.hosts:
        if host.node.section is None or not host.node.section.process_wide:
            continue
        for element in host.element.iterchildren(PARAMETERS):
            path = text_of(element)
            slot = text_slot(document.source, starts[element], path) if path else None
            if slot is not None:
                yield path, slot


def is_same(path: str, file: str, description: str) -> bool:
    """Return whether ``path``, as ``description`` names it, is this ``file`` or an installed copy."""
    plain = path.removeprefix("file://")
    for it in (plain, os.path.join(os.path.dirname(description), plain)):
        # What stands in the fleet file itself is no file.
        if os.path.isfile(it) and os.path.isfile(file) and os.path.samefile(it, file):
            return True
    source = next(_in_sources(plain, description), "")
    if source and os.path.isfile(file):
        return os.path.samefile(source, file)
    found = IN_PACKAGE.fullmatch(plain)
    if found is None:
        return False
    *names, rest = found.groups()
    package = next(filter(None, names), "")
    own = package_of(file)
    whole = os.path.abspath(file)
    if own is not None and own[0] == package:
        return os.path.relpath(whole, own[1]) == rest
    return whole.endswith(f"/{package}/{rest}")


def _in_sources(path: str, description: str) -> Iterator[str]:
    """Yield the source file that a build installs as a path that does not exist."""
    match = IN_PACKAGE.fullmatch(path)
    if match:
        *names, rest = match.groups()
        folder = package_folder(next(filter(None, names), ""), description, ())
        path = os.path.join(folder, rest) if folder else path
    if os.path.isabs(path) and not os.path.isfile(path) and (found := in_sources(path)):
        yield found


def named_alike(path: str, file: str) -> bool:
    """Return whether ``path`` has the file name of this ``file``."""
    return os.path.basename(path) == os.path.basename(file)


PARAMS = "params"
NOT_FOLLOWED = declare("MF834", "loaded-file-not-found", NOTE, formats=("fleet",))


def with_loaded_files(robot: RewrittenRobot) -> RewrittenRobot:
    """Return the robot with files that its description loads among its parameter files."""
    # One with the name of a listed file is left out: ``OTHER_CONTROLLER_FILE`` reports it.
    spec = robot.spec
    file, params = spec.simulated or spec.description, spec.related_files.get(PARAMS, ())
    more: list[str] = []
    findings: list[Finding] = []
    for path, _ in loaded_files(robot):
        if any(is_same(path, it, file) or named_alike(path, it) for it in params):
            continue
        found = next(_existing_files(path, file), "")
        if not found:
            message = f"robot {spec.name!r}: its description loads {path!r}, which is not there"
            hint = "list the file under params, or source the workspace that has it"
            findings.append(at_robot(NOT_FOLLOWED, robot, message, hint))
        elif not any(named_alike(found, it) for it in more):
            more.append(found)
    related_files = {**spec.related_files, PARAMS: (*params, *more)} if more else spec.related_files
    said = (*robot.findings, *findings)
    return robot._replace(spec=spec._replace(related_files=related_files), findings=said)


def _existing_files(path: str, description: str) -> Iterator[str]:
    """Yield the existing files that a path in a description may name."""
    plain = path.removeprefix("file://")
    match = IN_PACKAGE.fullmatch(plain)
    if match:
        *names, rest = match.groups()
        folder = package_folder(next(filter(None, names), ""), description, ())
        if folder and os.path.isfile(os.path.join(folder, rest)):
            yield os.path.join(folder, rest)
    for it in (plain, os.path.join(os.path.dirname(description), plain)):
        if os.path.isfile(it):
            yield it
    yield from _in_sources(plain, description)
