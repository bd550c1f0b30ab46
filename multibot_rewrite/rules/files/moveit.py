# SPDX-License-Identifier: Apache-2.0
"""Limits and groups of MoveIt's files against the descriptions and the SRDF of their package.

And groups and controller managers that the robots of a fleet do not have.

Source: moveit2 2.12.4 robot_model_loader.cpp (a limit of the file takes the place of the URDF's),
kinematics_plugin_loader.cpp and ompl_interface.cpp (both ask by the groups of the SRDF)."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence

from multibot_rewrite.base.findings.finding import WARNING, Finding, rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.naming import NAMESPACE
from multibot_rewrite.base.nearest import did_you_mean
from multibot_rewrite.description.checks.links_and_joints import BOUNDED, Joint
from multibot_rewrite.description.checks.numbers import value_of
from multibot_rewrite.description.sources.packages import entries, is_for_ros_1
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.related_files.moveit.rewrite import asks_below_root
from multibot_rewrite.related_files.named_file import MOVEIT, PARAMS, NamedFile
from multibot_rewrite.related_files.names.by_kind import is_plain
from multibot_rewrite.related_files.sites import slot_of
from multibot_rewrite.rules.declaration import remark, remark_at, robots_rule
from multibot_rewrite.rules.files.section_facts import Section, sections
from multibot_rewrite.rules.subject import Robots, Subject

_LIMIT = lazy_compile(
    r"robot_description_planning\.joint_limits\.(?P<joint>.+)\.(?P<what>max_velocity|m(?:ax|in)_position)"
)
# What a file says -> the attribute of the URDF's <limit>, and on which side of it is too far.
_OF_URDF = {
    "max_velocity": ("velocity", 1),
    "max_position": ("upper", 1),
    "min_position": ("lower", -1),
}
_ROUNDED = 1e-3
_JOINT = lazy_compile(r"robot_description_planning\.joint_limits\.(?P<joint>[^.]+)\.")
_ROBOT = lazy_compile(rb"<robot\s[^<>]*?name\s*=\s*[\"']([^\"'$<]*)[\"']")
_GROUP = lazy_compile(rb"<group\s[^<>]*?name\s*=\s*[\"']([^\"'<]*)[\"']")


@rule("MB898", "limits-beyond-the-joint", WARNING, formats=(MOVEIT,))
def limits_beyond_the_joint(file: NamedFile) -> Iterator[Finding]:
    """Yield MoveIt limits that no description of the package with this joint allows."""
    robots: Robots | None = file.memo.get(Robots)
    subjects = robots.subjects if robots and file.kind == MOVEIT else ()
    for section in sections(file) if robots else ():
        yield from (_unknown_joints(file, section, subjects) if robots and robots.is_whole else ())
        for it in section.given:
            found = _LIMIT.fullmatch(it.name)
            if found is None:
                continue
            # Positions count wherever they are, a velocity where it is switched on.
            name, what = found["joint"], found["what"]
            flag = section.whole.get(it.name.removesuffix(what) + "has_velocity_limits")
            if what == "max_velocity" and (flag is None or flag.value is not True):
                continue
            joints = (subject.robot.joint.get(name) for subject in subjects)
            limits = [
                _exceeded_limit(joint, what, it.value) for joint in joints if joint is not None
            ]
            if limits and all(limit is not None for limit in limits):
                message = f"{what} of {name} is {it.value:g}"
                hint = "write that: MoveIt plans beyond what the joint takes"
                yield remark_at(it.node, f"{message}, but the URDF has {limits[0]:g}", hint)


def _unknown_joints(
    file: NamedFile, section: Section, subjects: Sequence[Subject]
) -> Iterator[Finding]:
    """Report joints that a package's only robot lacks, as does the SRDF in the file's folder."""
    srdfs = _srdfs(file.file)
    names = {_ROBOT.search(data) for data in srdfs}
    robots = {subject.document.root.get("name", "").encode() for subject in subjects}
    if len(robots) != 1 or {it[1] if it else b"" for it in names} != robots:
        return
    there = {name for subject in subjects for name in subject.robot.joint}
    # Of a fleet also by what they are called before an argument makes them the robot's.
    there |= {*file.context.names.declared.get("joint", ())}
    told: set[str] = set()
    for it in section.given:
        found = _JOINT.match(it.name)
        joint = found["joint"] if found else ""
        is_known = joint in there | told or any(joint.encode() in it for it in srdfs)
        if is_known or not is_plain(joint):
            continue
        told.add(joint)
        message = f"joint {joint!r}, which has limits here, is not in the description"
        yield remark_at(it.key, message, did_you_mean(joint, there) or "correct the name")


def _exceeded_limit(joint: Joint, what: str, value: object) -> float | None:
    """Return the joint's limit that a value exceeds; None if it exceeds none."""
    attribute, side = _OF_URDF[what]
    limit = joint.parts.get("limit")
    own = value_of(limit, attribute) if limit is not None else None
    if own is None or isinstance(value, bool) or not isinstance(value, int | float):
        return None
    # 0 is what exporters write for a velocity that they do not know.
    free = own <= 0 if attribute == "velocity" else joint.type not in BOUNDED
    return own if not free and side * (value - own) > _ROUNDED * max(1.0, abs(own)) else None


@rule("MB899", "group-not-in-srdf", WARNING, formats=(MOVEIT, PARAMS))
def groups_not_in_srdf(file: NamedFile) -> Iterator[Finding]:
    """Report groups that the SRDF lacks, unless it makes names of its groups when it is expanded."""
    sites = [it for it in file.names if it.kind == "group" and it.is_sure]
    # A build that has the SRDF knows its groups, and says it as of any name.
    told = file.is_certain and bool(file.declared.get("group"))
    asked = bool(sites) and not told and not is_for_ros_1(file.file)
    groups = _groups_in_srdfs(file.file) if asked else frozenset()
    for it in sites if groups else ():
        if it.text and it.text not in groups and it.text.isidentifier():
            message = f"no SRDF of its package has a group {it.text!r}"
            yield remark(it, message, did_you_mean(it.text, groups) or f"there is {min(groups)}")


def _groups_in_srdfs(file: str) -> frozenset[str]:
    found: set[str] = set()
    for data in _srdfs(file):
        names = {it[1].decode("utf-8", "replace") for it in _GROUP.finditer(data)}
        # A group that a macro makes may have any name.
        if any("$" in it for it in names) or b"xacro:" in data.partition(b">")[2]:
            return frozenset()
        found |= names
    return frozenset(found)


def _srdfs(file: str) -> list[bytes]:
    """Return the contents of the SRDF files in the folder of a file."""
    folder = os.path.dirname(os.path.abspath(file))
    names = sorted(it for it in entries(folder) if ".srdf" in it)
    return [read_file(os.path.join(folder, name)) for name in names]


@rule(
    "MB892",
    "moveit-groups-without-srdf",
    WARNING,
    formats=(MOVEIT,),
    options={"build": True, "groups": "rename"},
)
def groups_without_srdf(file: NamedFile) -> Iterator[Finding]:
    """Report each group, at its first place."""
    names = file.context.names
    asked = "group" in names.naming.separators and not names.declared.get("group")
    groups = {it.text: it for it in reversed(file.names) if it.kind == "group"}
    for text, site in groups.items() if asked and file.is_certain else ():
        message = f"groups are renamed, but no SRDF is given, so {text!r} stays unchanged"
        yield remark(site, message, "name the SRDF under srdf:")


@robots_rule(
    "MB893",
    "moveit-one-controller-manager",
    WARNING,
    MOVEIT,
    options={"build": True, "layout": "postfix"},
)
def one_controller_manager(file: NamedFile) -> Iterator[Finding]:
    """Report places that select a controller manager which no robot has."""
    if file.document is None or file.context.names.naming.topics == NAMESPACE:
        return
    key = asks_below_root(file.document)
    slots = [slot_of(key)] if key else []
    for slot in (*slots, *(it.slot for it in file.names if it.kind == "namespace")):
        message = "MoveIt looks for /controller_manager, but each robot's has a different name"
        hint = "use moveit_simple_controller_manager or a layout with namespaces"
        yield remark(slot, message, hint)
