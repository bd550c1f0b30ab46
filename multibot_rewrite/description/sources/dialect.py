# SPDX-License-Identifier: Apache-2.0
"""Which ROS loads the plugins of a description: one for the whole document.

Gazebo Classic's plugins have the same libraries in ROS 1 and ROS 2, and read other parameters there.
Sources: gazebo_ros_pkgs branches noetic-devel (robotNamespace) and ros2 (gazebo_ros/src/node.cpp reads
<ros>); ros2_control component_parser.cpp; REP 149 (build_type in package.xml).
"""

from __future__ import annotations

import os

from lxml.etree import _Comment, _Element

from multibot_rewrite.base.bounded import bytes_if_read
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.outside import outside
from multibot_rewrite.base.releases import ROS_1, ROS_2
from multibot_rewrite.description.readback.xml import read_xml
from multibot_rewrite.description.rewriters.tree import (
    Tree,
    builtin_tree,
    library_key,
    plugin_keys,
)
from multibot_rewrite.description.rewriters.vocabulary import VocabularySection
from multibot_rewrite.description.sources.release_said import HIGHEST, release_of_build

_BOTH = 2
_LIBRARY = lazy_compile(rb"filename\s*=\s*[\"']([^\"'<]*)")
_BUILT = lazy_compile(rb"<build_type>\s*ament_|<(?:build|buildtool)_depend>\s*ament_")
_BUILT_BY_CATKIN = lazy_compile(rb"<(?:build|buildtool)_depend>\s*catkin\s*<")


def tree_of(
    root: _Element, vocabulary: tuple[str, ...], release: str, ros: str, file: str = ""
) -> Tree:
    """Return the rewriters for a document: for the ROS that is given, else for the one that it or its
    package shows."""
    found = ros or _shown(root, builtin_tree(vocabulary, release), file)
    return builtin_tree(vocabulary, release, found)


def ros_shown(data: bytes, file: str, tree: Tree) -> str:
    """Return the ROS that a document or its package shows, empty where none does or no plugin depends
    on it."""
    names = {it.decode(errors="replace").strip() for it in _LIBRARY.findall(data)}
    keys = {library_key(it.rpartition("/")[2]) for it in names}
    # Few have a plugin that ROS 1 and ROS 2 both have.
    if all(len(tree.vocabulary.find("plugin", it)) < _BOTH for it in keys):
        return ""
    try:
        return _shown(read_xml(data, file), tree, file)
    except InputError:
        return ""


def _shown(root: _Element, tree: Tree, file: str) -> str:
    plugins = [it for it in root.iter("plugin") if "filename" in it.attrib]
    known = [it for it in (_sections(one, tree) for one in plugins) if it]
    if all(len(it) < _BOTH for it in known):
        return ""
    alone = {it[0].ros for it in known if len({one.ros for one in it}) == 1}
    if ROS_2 in alone or root.find("ros2_control") is not None or _has_ros(root):
        return ROS_2
    return ros_of_package(file) or (ROS_1 if ROS_1 in alone else "")


def _sections(plugin: _Element, tree: Tree) -> tuple[VocabularySection, ...]:
    library = plugin_keys(plugin)[0]
    return tree.vocabulary.find("plugin", library)


def _has_ros(root: _Element) -> bool:
    """Has a plugin a ``<ros>`` that no rewrite put there?"""
    return any(not _is_inserted(it) for it in root.iterfind(".//plugin/ros"))


def _is_inserted(element: _Element) -> bool:
    """Is it one of the elements that a rewrite counts in the comment before them?"""
    place = 1
    for before in element.itersiblings(preceding=True):
        if not isinstance(before, _Comment):
            place += 1
            continue
        words = (before.text or "").split(None, 3)
        if words[:1] == ["multibot"] and words[2:3] and words[2][:1] == "+":
            return words[2][1:].isdecimal() and place <= int(words[2][1:])
    return False


@outside
def ros_of_package(file: str) -> str:
    """Return the ROS that builds the package of a file, ROS 2 for what `multibot build` wrote; empty
    for a file of no package."""
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
