# SPDX-License-Identifier: Apache-2.0
"""``python -m tools.interfaces.versions ROSDISTRO CHECKOUT...``: ``knowledge/packages.schema``.

ROSDISTRO is a checkout of ros/rosdistro with its history, each CHECKOUT the git folder of a repository
that was read. Which commit was read for a release is in ``fixtures/interfaces/sources.tsv``; of
repositories that it lacks, it is the one that the entries of ``knowledge/nodes`` name.
"""

from __future__ import annotations

import csv
import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

import yaml

from multibot_rewrite.base.releases import CAME, RELEASES
from multibot_rewrite.knowledge.node_sets import every_release
from multibot_rewrite.knowledge.packages import COMMENT, NONE

SOURCES = Path("fixtures/interfaces/sources.tsv")
# What sources.tsv calls otherwise than rosdistro.
CALLED = {
    "Universal_Robots_ROS2_Driver": "ur_robot_driver",
    "realsense-ros": "realsense2_camera",
    "ros_foxglove_bridge": "foxglove-sdk",
}
# What was read besides, for all releases.
ALL = {
    "explore_lite": "926033f",
    "multirobot_map_merge": "926033f",
    "sllidar_ros2": "3430009",
    "xarm_api": "0417b0f",
    "xarm_controller": "0417b0f",
    "depthai-ros": "b39899f",
    "nmea_navsat_driver": "548c84a",
    "ublox": "577ef65",
    "apriltag_ros": "beffb4c",
    "domain_bridge": "c2523e1",
    "depthimage_to_laserscan": "79b60bf",
    "realsense2_camera": "775b167c",
}
HEAD = f"""\
{COMMENT} Versions of packages in each release, and which source was read for it. Made by
{COMMENT} python -m tools.interfaces.versions ROSDISTRO CHECKOUT... >
{COMMENT} multibot_rewrite/knowledge/packages.schema
{COMMENT}
{COMMENT}   [REPOSITORY] PACKAGE...
{COMMENT}   RELEASE FIRST NOW COMMIT VERSION DATE    the version that the release came with and the one
{COMMENT}                                            that it has, the commit that was read, its version
{COMMENT}                                            and its date; {NONE} for none, or what is not known
"""


class Read(NamedTuple):
    """A commit that was read: its version, the day of it."""

    commit: str = NONE
    version: str = NONE
    date: str = NONE


# Of these the changelog was read, since no checkout at hand is as new.
CHANGELOGS = {
    "teleop_twist_joy": Read("2.6.5", "2.6.5", "2025-07-16"),
    "teleop_twist_keyboard": Read("2.4.1", "2.4.1", "2025-09-26"),
    "twist_mux": Read("4.5.1", "4.5.1", "2026-03-04"),
}


class Release(NamedTuple):
    """A release on a day: the version of each package, and the packages of each repository."""

    versions: Mapping[str, str]
    packages: Mapping[str, Sequence[str]]


EMPTY = Release({}, {})


def main(arguments: Sequence[str]) -> None:
    """Print the table."""
    rosdistro, *checkouts = map(Path, arguments)
    now = {it: _release(rosdistro, "HEAD", it) for it in RELEASES}
    first = {it: _release(rosdistro, _before(rosdistro, day), it) for it, day in CAME.items()}
    day = _git(rosdistro, "log", "-1", "--format=%cs", "HEAD")
    sys.stdout.write(f"{HEAD}{COMMENT}\n{COMMENT} ros/rosdistro of {day}\n")
    read = _commits()
    for repository, packages in sorted(_packages(now, read).items()):
        sys.stdout.write(f"\n[{repository}] {' '.join(packages)}\n")
        commits = read.get(repository, {})
        # The likely ones first: each question takes git a moment.
        near = tuple(sorted(checkouts, key=lambda it: repository not in f"{it}"))
        for release in RELEASES:
            commit = ALL.get(repository, commits.get(release, commits.get("", "")))
            versions = [
                next((it.versions[name] for name in packages if name in it.versions), NONE)
                for it in (first.get(release, EMPTY), now[release])
            ]
            if versions != [NONE, NONE] or commit:
                found = CHANGELOGS.get(repository) or _read(commit, (*packages,), near)
                row = (release, *versions, *found)
                sys.stdout.write(f"{' '.join(row)}\n")


def _before(rosdistro: Path, day: str) -> str:
    """Return the last commit of the day."""
    return _git(rosdistro, "rev-list", "-1", f"--before={day}T23:59", "HEAD")


def _release(rosdistro: Path, commit: str, release: str) -> Release:
    text = _git(rosdistro, "show", f"{commit}:{release}/distribution.yaml")
    given = {
        name: it["release"]
        for name, it in yaml.load(text, yaml.CSafeLoader)["repositories"].items()
        if it.get("release", {}).get("version")
    }
    packages = {name: it.get("packages", [name]) for name, it in given.items()}
    versions = {name: it["version"].partition("-")[0] for name, it in given.items()}
    return Release({it: versions[name] for name in packages for it in packages[name]}, packages)


def _commits() -> dict[str, dict[str, str]]:
    """Return the commit of each repository that was read for each release, or for all (empty)."""
    found = defaultdict[str, dict[str, str]](dict)
    with SOURCES.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file, delimiter="\t"):
            found[CALLED.get(row["repository"], row["repository"])][row["release"]] = row["commit"]
    for node in every_release().nodes.values():
        for place in node.source:
            name, _, commit = place.partition(" ")[0].partition("/")[2].partition("@")
            if not {CALLED.get(name, name), node.package} & {*found}:
                found[f"of {node.package}"][""] = commit
    return found


def _packages(
    now: Mapping[str, Release], read: dict[str, dict[str, str]]
) -> Mapping[str, Sequence[str]]:
    """Return the packages of known nodes by repository; one of no release by that of its source."""
    owner = {
        package: repository
        for release in now.values()
        for repository, packages in release.packages.items()
        for package in packages
    }
    known: dict[str, str] = {}
    for node in every_release().nodes.values():
        named = (it.partition("@")[0].rpartition("/")[2] for it in node.source)
        if node.package:
            known[node.package] = next(filter(read.__contains__, named), node.package)
    found = defaultdict[str, list[str]](list)
    for package in sorted(known):
        repository = owner.get(package, known[package])
        found[repository].append(package)
        if f"of {package}" in read:
            read[repository].update(read[f"of {package}"])
    return found


@cache
def _read(commit: str, packages: tuple[str, ...], checkouts: tuple[Path, ...]) -> Read:
    """Return what a commit says of itself, by the checkout that has it."""
    if not commit:
        return Read()
    for checkout in checkouts:
        date = _git(checkout, "log", "-1", "--format=%cs", f"{commit}^{{commit}}")
        if date:
            return Read(commit[:9], _version(checkout, commit, packages), date)
    return Read(commit[:9])


def _version(checkout: Path, commit: str, packages: Iterable[str]) -> str:
    """Return the version of a package in its package.xml."""
    every = _git(checkout, "ls-tree", "-r", "--name-only", commit).splitlines()
    manifests = [it for it in every if it.rpartition("/")[2] == "package.xml"]
    own = [it for it in manifests if it.split("/")[-2:-1] == [] or it.split("/")[-2] in {*packages}]
    own += manifests
    text = _git(checkout, "show", f"{commit}:{own[0]}") if own else ""
    found = re.search(r"<version>\s*([0-9.]+)", text)
    return found[1] if found else NONE


def _git(folder: Path, *arguments: str) -> str:
    """Return what git says, empty where it fails."""
    command = ["git", "-C", str(folder), *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()


if __name__ == "__main__":
    main(sys.argv[1:])
