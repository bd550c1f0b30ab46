# SPDX-License-Identifier: Apache-2.0
"""The planning groups of an SRDF on its URDF, as srdfdom and MoveIt make them."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from lxml.etree import _Element

from multibot_rewrite.description.checks.links_and_joints import Joint, Robot

Groups = Mapping[str, _Element]
# What Pinocchio (parsers/srdf.hxx) and HPP read of an SRDF and MoveIt does not: the first is how the
# free flyer of a model is called.
FREE_FLYER = "root_joint"


def text_of(element: _Element, attribute: str = "name") -> str:
    """Return the value of an attribute as srdfdom takes it: without white space around it."""
    return element.get(attribute, "").strip()


def is_pinocchios(root: _Element) -> bool:
    """Return whether an SRDF is for Pinocchio, which takes no group and no robot's name from it."""
    states = list(root.iterchildren("group_state"))
    return (
        any(True for _ in root.iterchildren("rotor_params", "gripper", "handle", "specificities"))
        or (any(map(len, states)) and not any("group" in it.attrib for it in states))
        or any(text_of(it) == FREE_FLYER for state in states for it in state.iterchildren("joint"))
    )


def groups_of(root: _Element) -> Groups:
    """Return the groups by name; of two with one name MoveIt takes the first."""
    found: dict[str, _Element] = {}
    for group in root.iterchildren("group"):
        found.setdefault(text_of(group), group)
    return found


def way_up(robot: Robot, link: str) -> Iterator[Joint]:
    """Yield the joints from a link to the root; a circle ends where it began."""
    seen = {link}
    while robot.above.get(link):
        joint = robot.above[link][0]
        yield joint
        link = joint.parent
        if link in seen:
            return
        seen.add(link)


def chain(robot: Robot, base: str, tip: str) -> list[str] | None:
    """Return the joints between two links; None if they are not connected."""
    down = list(way_up(robot, tip))
    links = [tip, *(joint.parent for joint in down)]
    # How many joints each link is above the tip.
    at = {link: number for number, link in reversed(list(enumerate(links)))}
    up: list[str] = []
    if base not in at:
        for joint in way_up(robot, base):
            up.append(joint.name)
            base = joint.parent
            if base in at:
                break
    if base not in at:
        return None
    return [*(joint.name for joint in down[: at[base]]), *up]


def joints_of(name: str, groups: Groups, robot: Robot) -> Collection[str]:
    """Return the joints of a group and of its subgroups; a group may hold itself."""
    members = (it for group in _within(name, groups) for it in _members_of_group(groups, group))
    return {joint for member in members for joint in _joints_of_member(member, robot)}


def is_whole(name: str, groups: Groups) -> bool:
    """Return whether a group and all of its subgroups are declared."""
    return all(it in groups for it in _within(name, groups))


def _within(name: str, groups: Groups) -> list[str]:
    """Return the names of a group and its subgroups, declared or not."""
    found = [name]
    for group in found:  # grows
        inner = (text_of(it) for it in _members_of_group(groups, group) if it.tag == "group")
        found += (it for it in dict.fromkeys(inner) if it not in found)
    return found


def _members_of_group(groups: Groups, name: str) -> Iterator[_Element]:
    group = groups.get(name)
    return iter(()) if group is None else group.iterchildren("*")


def _joints_of_member(member: _Element, robot: Robot) -> Collection[str]:
    if member.tag == "joint":
        return (text_of(member),)
    if member.tag == "link":
        link = text_of(member)
        # The joint above the root link is a virtual one.
        virtual = member.getroottree().getroot().iterchildren("virtual_joint")
        return [joint.name for joint in robot.above.get(link, ())] or [
            text_of(it) for it in virtual if text_of(it, "child_link") == link
        ]
    if member.tag == "chain":
        return chain(robot, text_of(member, "base_link"), text_of(member, "tip_link")) or ()
    return ()


def links_of(name: str, groups: Groups, robot: Robot) -> Collection[str]:
    """Return the links of a group: those that its joints move, and those it names itself."""
    joints = joints_of(name, groups, robot)
    moved = {robot.joint[it].child for it in joints if it in robot.joint}
    return moved.union(text_of(it) for it in _members_of_group(groups, name) if it.tag == "link")
