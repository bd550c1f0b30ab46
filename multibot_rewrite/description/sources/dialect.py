# SPDX-License-Identifier: Apache-2.0
"""Which ROS loads the plugins of a description: one for the whole document.

Gazebo Classic's plugins have the same libraries in ROS 1 and ROS 2, and read other parameters there.
Sources: gazebo_ros_pkgs branches noetic-devel (robotNamespace) and ros2 (gazebo_ros/src/node.cpp reads
<ros>); ros2_control component_parser.cpp; REP 149 (build_type in package.xml).
"""

from __future__ import annotations

import os

from lxml.etree import Comment, _Element

from multibot_rewrite.base.bounded import bytes_if_read
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.outside import outside
from multibot_rewrite.base.releases import ROS_1, ROS_2
from multibot_rewrite.description.readback.xml import read_xml
from multibot_rewrite.description.rewriters.tree import Tree, library_key
from multibot_rewrite.description.sources.release_said import HIGHEST, release_of_build

_LIBRARY = lazy_compile(rb"filename\s*=\s*[\"']([^\"'<]*)")
_MARK = lazy_compile(r" multibot \S+ \+(\d+)")
_BUILT = lazy_compile(rb"<build_type>\s*ament_|<(?:build|buildtool)_depend>\s*ament_")
_BUILT_BY_CATKIN = lazy_compile(rb"<(?:build|buildtool)_depend>\s*catkin\s*<")


def ros_shown(data: bytes, file: str, tree: Tree) -> str:
    """Return the ROS that a document or its package shows; empty if none, or if no plugin needs it."""
    names = {it.decode(errors="replace").strip() for it in _LIBRARY.findall(data)}
    keys = {library_key(it.rpartition("/")[2]) for it in names}
    found = [{one.ros for one in tree.definitions.find("plugin", it)} for it in keys]
    # Beside a system of the new Gazebo a plugin of ROS 1 is left over.
    of_gz = any(it.startswith("gz-") for it in keys)
    if all(len(it) < 2 and (of_gz or ROS_1 not in it) for it in found):
        return ""
    try:
        root = read_xml(data, file)
    except InputError:
        return ""
    has_ros = any(not _is_inserted(it) for it in root.iterfind(".//plugin/ros"))
    if has_ros or {ROS_2} in found or root.find("ros2_control") is not None:
        return ROS_2
    return ros_of_package(file.removesuffix(" (expanded)")) or (ROS_1 if {ROS_1} in found else "")


def _is_inserted(element: _Element) -> bool:
    """Return whether a rewrite inserted the element, by the comment before it."""
    marks = (_MARK.match(it.text or "") for it in element.itersiblings(Comment, preceding=True))
    number = next((int(it[1]) for it in marks if it), 0)
    return sum(1 for _ in element.itersiblings("*", preceding=True)) < number


@outside
def ros_of_package(file: str) -> str:
    """Return the ROS that builds the package of a file, or wrote it; empty without a package."""
    if release_of_build(file):
        return ROS_2
    folder = os.path.dirname(os.path.abspath(file)) if os.path.isfile(file) else ""
    for _ in range(HIGHEST if folder else 0):
        text = bytes_if_read(os.path.join(folder, "package.xml"))
        if text:
            by_catkin = _BUILT_BY_CATKIN.search(text) and not _BUILT.search(text)
            return ROS_1 if by_catkin else ROS_2 if _BUILT.search(text) else ""
        folder = os.path.dirname(folder)
    return ""
