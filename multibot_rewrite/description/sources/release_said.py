# SPDX-License-Identifier: Apache-2.0
"""Finds the ROS 2 release that a description or a launch file is for, if no one gave it.

It is that of the build that wrote it, of the libraries that it loads, else of the CI and the
packages of its repository. Sources: docs.github.com "Workflow syntax" (.github/workflows),
docs.gitlab.com ".gitlab-ci.yml"; REP 149 (package.xml); for the packages REP 2000 and
gazebosim.org/docs, "Installing Gazebo with ROS"."""

import os
from collections.abc import Iterable
from typing import NamedTuple

from multibot_rewrite.base.bounded import bytes_if_read, load_json
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.outside import outside
from multibot_rewrite.base.releases import ENDED, NEWEST_LTS, OF_OLD, RELEASES, evidence

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
    """A release and the reason for it; without a reason it is the newest LTS."""

    release: str
    why: str = ""


def release_said(told: str, text: bytes, file: str, who: str = "it") -> SaidRelease:
    """Return the release that was given, else that of a description's text or repository."""
    if told:
        return SaidRelease(told)
    file = file.removesuffix(" (expanded)")
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
            found = _build_manifest(path)
            said = found.get("distro") if found.get("format") == BUILD else ""
            return said if isinstance(said, str) and said in RELEASES else ""
    return ""


def _build_manifest(path: str) -> dict[str, object]:
    try:
        found = load_json(bytes_if_read(path))
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}


@outside
def release_in_repository(file: str) -> str:
    """Return the one release in a file's CI or package, a blank, and the reason; or empty."""
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
