# SPDX-License-Identifier: Apache-2.0
"""Which ROS 2 release a description or a launch file is for, where nobody said it: by the build that
wrote it, by the libraries that it loads, else by the CI and the packages of its repository. Which ROS
loads the plugins of a description: one for the whole document.

Sources: docs.github.com "Workflow syntax" (.github/workflows), docs.gitlab.com ".gitlab-ci.yml"; REP
149 (package.xml); for the packages REP 2000 and gazebosim.org/docs, "Installing Gazebo with ROS".

Gazebo Classic's plugins have the same libraries in ROS 1 and ROS 2, and read other parameters there.
Sources: gazebo_ros_pkgs branches noetic-devel (robotNamespace) and ros2 (gazebo_ros/src/node.cpp reads
<ros>); ros2_control component_parser.cpp; REP 149 (build_type in package.xml)."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import NamedTuple

from lxml.etree import Comment, _Element

from multibot_rewrite.base.bounded import bytes_if_read, load_json
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.outside import outside
from multibot_rewrite.base.releases import (
    ENDED,
    NEWEST_LTS,
    OF_OLD,
    RELEASES,
    ROS_1,
    ROS_2,
    evidence,
)
from multibot_rewrite.description.readback.xml import read_xml
from multibot_rewrite.description.rewriters.tree import Tree, library_key

# Folders above a description in which the top of its repository is looked for.
HIGHEST = 6
# What a build writes into its folder says for which release it did; a robot's files are one below.
MANIFEST, BUILD = "manifest.json", "multibot build 1"
_LINE = lazy_compile(rb"(?im)^[^\n]*?(?:ros|distro)[^\n]*")
_RELEASE = lazy_compile(rb"(?i)\b(?:" + "|".join((*RELEASES, *ENDED)).encode() + rb")\b")
_OLD_PACKAGE = r"(gazebo_(?:ros|plugins|ros_pkgs|ros2_control)|ign_ros2_control|ros_ign\w*)"
_STARTED = lazy_compile(_OLD_PACKAGE)
_PACKAGE = lazy_compile(rb"depend>\s*" + _OLD_PACKAGE.encode() + rb"\s*<")
_NEW_PACKAGE = lazy_compile(rb"depend>\s*(?:ros_gz\w*|gz_ros2_control|gz-\w+)\s*<")


class SaidRelease(NamedTuple):
    """A release, and what says so: empty where nothing does, and the newest LTS is taken."""

    release: str
    why: str = ""


def release_said(told: str, text: bytes, file: str, who: str = "it") -> SaidRelease:
    """Return the release that was ``told``, or that of a description's text, or of its repository;
    ``who`` has the text."""
    if told:
        return SaidRelease(told)
    if built := release_of_build(file):
        return SaidRelease(built, f"{MANIFEST} says so")
    if library := evidence(text):
        return SaidRelease(OF_OLD, f"{who} loads {library}")
    named, _, why = release_in_repository(file).partition(" ") if file else ("", "", "")
    return SaidRelease(named or NEWEST_LTS, why)


def release_of_launch(
    told: str, packages: Iterable[str], texts: Iterable[str], file: str
) -> SaidRelease:
    """Return the release of a launch file, also by its packages and its nodes' texts."""
    said = release_said(told, "\n".join(texts).encode(), file)
    old = next(filter(_STARTED.fullmatch, packages), "")
    if said.why or told or not old:
        return said
    return SaidRelease(OF_OLD, f"it starts {old}")


def release_of_all(told: str, files: Iterable[str]) -> SaidRelease:
    """Return the one release of several files, with the first reason."""
    if told:
        return SaidRelease(told)
    said: dict[str, SaidRelease] = {}
    for path in files:
        it = release_said("", bytes_if_read(path), path, os.path.basename(path))
        if it.why:
            said.setdefault(it.release, it)
    return said.popitem()[1] if len(said) == 1 else SaidRelease(NEWEST_LTS)


@outside
def release_of_build(file: str) -> str:
    """Return the release for which a build wrote a file; empty for another file."""
    here = os.path.dirname(os.path.abspath(file))
    for path in (os.path.join(it, MANIFEST) for it in (here, os.path.dirname(here))):
        if os.path.isfile(path):
            found = _manifest(path)
            said = found.get("distro") if found.get("format") == BUILD else ""
            return said if isinstance(said, str) and said in RELEASES else ""
    return ""


def _manifest(path: str) -> dict[str, object]:
    try:
        found = load_json(bytes_if_read(path))
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}


@outside
def release_in_repository(file: str) -> str:
    """Return the one release in the CI of a file's repository, or in its package's dependencies, a
    blank, and the reason; empty for none or several."""
    if not os.path.isfile(file):
        return ""
    here = os.path.dirname(os.path.abspath(file))
    folders = [here]
    while len(folders) < HIGHEST and os.path.dirname(folders[-1]) != folders[-1]:
        folders.append(os.path.dirname(folders[-1]))
    top = next((it for it in folders if os.path.exists(os.path.join(it, ".git"))), "")
    named = {it: path for path in _ci_files(top) for it in _releases_in(path)} if top else {}
    if len(named) == 1:
        release, path = next(iter(named.items()))
        return f"{release} {os.path.relpath(path, top)} names it"
    package = next((it for it in folders if os.path.exists(os.path.join(it, "package.xml"))), "")
    text = bytes_if_read(os.path.join(package, "package.xml")) if package and not named else b""
    found = None if _NEW_PACKAGE.search(text) else _PACKAGE.search(text)
    return f"{OF_OLD} package.xml depends on {found[1].decode()}" if found else ""


@outside
def _ci_files(top: str) -> tuple[str, ...]:
    found: list[str] = []
    for place in (".github/workflows", ".gitlab-ci.yml"):
        path = os.path.join(top, place)
        names = sorted(os.listdir(path)) if os.path.isdir(path) else []
        found += [os.path.join(path, it) for it in names if it.endswith((".yml", ".yaml"))]
        if os.path.isfile(path):
            found.append(path)
    return tuple(found)


def _releases_in(path: str) -> set[str]:
    lines = _LINE.findall(bytes_if_read(path))
    found = {it.decode().lower() for line in lines for it in _RELEASE.findall(line)}
    return {ENDED.get(it, it) for it in found}


_LIBRARY = lazy_compile(rb"filename\s*=\s*[\"']([^\"'<]*)")
_MARK = lazy_compile(r" multibot \S+ \+(\d+)")
_BUILT = lazy_compile(rb"<build_type>\s*ament_|<(?:build|buildtool)_depend>\s*ament_")
_BUILT_BY_CATKIN = lazy_compile(rb"<(?:build|buildtool)_depend>\s*catkin\s*<")


def ros_shown(data: bytes, file: str, tree: Tree) -> str:
    """Return the ROS that a document or its package shows, empty where none does or no plugin depends
    on it."""
    names = {it.decode(errors="replace").strip() for it in _LIBRARY.findall(data)}
    keys = {library_key(it.rpartition("/")[2]) for it in names}
    found = [{one.ros for one in tree.definitions.find("plugin", it)} for it in keys]
    if all(len(it) < 2 for it in found):
        return ""
    try:
        root = read_xml(data, file)
    except InputError:
        return ""
    has_ros = any(not _is_inserted(it) for it in root.iterfind(".//plugin/ros"))
    if has_ros or {ROS_2} in found or root.find("ros2_control") is not None:
        return ROS_2
    return ros_of_package(file) or (ROS_1 if {ROS_1} in found else "")


def _is_inserted(element: _Element) -> bool:
    """Return whether it is one of the elements that a rewrite counts in the comment before them."""
    marks = (_MARK.match(it.text or "") for it in element.itersiblings(Comment, preceding=True))
    number = next((int(it[1]) for it in marks if it), 0)
    return sum(1 for _ in element.itersiblings("*", preceding=True)) < number


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
