# SPDX-License-Identifier: Apache-2.0
"""Descriptions that are large in one thing."""

from __future__ import annotations

from collections.abc import Callable


def _each(count: int, text: str) -> str:
    """Return the text for 0, 1, 2 ..., the number in place of ``#``."""
    return "".join(f"{text}\n".replace("#", str(at)) for at in range(count))


def _links(count: int) -> str:
    return _each(count, '<link name="l#"/>')


def _chain(count: int) -> str:
    joints = (
        f'<joint name="j{at}" type="fixed"><parent link="l{at}"/><child link="l{at + 1}"/></joint>\n'
        for at in range(count - 1)
    )
    return _links(count) + "".join(joints)


_ONE = '<link name="base"/>\n'
_MESH = '<link name="l#"><visual><geometry><box size="1 1 1"/></geometry><material name="m#"/>'

GROWING: dict[str, Callable[[int], str]] = {
    "links": _links,
    "links in a chain": _chain,
    "mentions": lambda count: _links(count) + _each(count, "<gazebo><own>l#</own></gazebo>"),
    "mentions in one line": lambda count: GROWING["mentions"](count).replace("\n", " "),
    "plugins with insertions": lambda count: (
        _ONE
        + _each(
            count, '<gazebo><plugin name="p#" filename="libgazebo_ros_diff_drive.so"/></gazebo>'
        )
    ),
    "unknown plugins": lambda count: (
        _ONE + _each(count, '<gazebo><plugin name="p#" filename="libown_plugin_#.so"/></gazebo>')
    ),
    "unknown hardware": lambda count: (
        _ONE
        + _each(
            count,
            '<ros2_control name="s#" type="system"><hardware><plugin>own/Hardware#</plugin>'
            '<param name="a">b</param></hardware></ros2_control>',
        )
    ),
    "undeclared references": lambda count: _ONE + _each(count, '<gazebo reference="nobody#"/>'),
    "undeclared links of joints": lambda count: (
        _ONE
        + _each(
            count, '<joint name="j#" type="fixed"><parent link="a#"/><child link="b#"/></joint>'
        )
    ),
    "names declared twice": lambda count: _each(count, '<link name="base"/>'),
    "patterns for joints": lambda count: (
        _chain(2)
        + '<gazebo><plugin name="x" filename="libJointControlPlugin.so">'
        + _each(count, '<controller type="force"><joint>(j|k)0?#?</joint></controller>')
        + "</plugin></gazebo>"
    ),
    "materials": lambda count: (
        _each(count, '<material name="n#"><color rgba="1 1 1 1"/></material>')
        + _each(count, f"{_MESH}</visual></link>")
    ),
    "comments": lambda count: _ONE + _each(count, "<!-- part # of <many> -->"),
    "comments in one line": lambda count: GROWING["comments"](count).replace("\n", " "),
    "comments for the lint": lambda count: (
        _each(count, "<!-- urdf-lint: ignore MB401 - part # -->") + _ONE
    ),
    "blocks of CDATA": lambda count: (
        f"{_ONE}<gazebo><own>{_each(count, '<![CDATA[a < b]]>')}</own></gazebo>"
    ),
    "remap rules": lambda count: (
        _ONE
        + '<gazebo><plugin name="x" filename="libgazebo_ros_diff_drive.so"><ros>'
        + _each(count, "<remapping>a#:=b#</remapping>")
        + "</ros></plugin></gazebo>"
    ),
}


def description(what: str, count: int) -> bytes:
    """Return a URDF with so many of them."""
    return f'<robot name="r">\n{GROWING[what](count)}</robot>\n'.encode()
