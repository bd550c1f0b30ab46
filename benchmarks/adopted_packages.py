# SPDX-License-Identifier: Apache-2.0
"""Packages that got a prefix by hand, as they were before, under ``multibot adopt``, beside the commit.

``python benchmarks/adopted_packages.py MIRRORS`` prints the figures of one section of
docs/contributing/measurements.md; commits behind it are those that are looked at.
MIRRORS has clones, ``OWNER+NAME/repo``.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory

from lxml import etree

from multibot_rewrite import adopt
from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.description.readback.xml import plain
from multibot_rewrite.description.reports.xacro_arguments import find_arguments, names_robots
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.sources.job import read_whole
from multibot_rewrite.proposal.searching import search

# The repository, the commit that gave it a prefix, its packages if not all, and arguments.
COMMITS: list[tuple[str, str, str, dict[str, str]]] = [
    ("ycheng517+ar4_ros_driver", "c4db251", "", {"ar_model": "mk3"}),
    ("YOGYUI+ros2_robot_ur5e", "055ae5c", "", {}),
    ("NovoG93+sjtu_drone", "161d99f", "", {}),
    ("iRobotEducation+create3_sim", "e027fe3", "", {}),
    ("roccosalazar+Multi-Robot-Nav", "7ba566c", "", {}),
    ("lbr-stack+lbr_fri_ros2_stack", "88945b6", "", {}),
    ("vortexntnu+vortex-auv", "f02f9512", "", {}),
    ("husarion+husarion_ugv_ros", "7f3c1c29", "", {}),
    ("husarion+rosbot_ros", "5762b53", "", {}),
    ("PickNikRobotics+ros2_robotiq_gripper", "df38fbf", "", {}),
    ("kroshu+kuka_robot_descriptions", "3ea1eb1", "", {}),
    ("RoboAlQuds2027+temp_ros2_issue_spawn_two_robot", "ede9146", "", {}),
    ("Kinovarobotics+ros2_kortex", "2f2ba44", "", {}),
    ("harshilbhatt2001+ros2_swarm_ws", "6077ddd", "", {}),
    ("Kinovarobotics+ros_kortex", "65c2dc5", "", {}),
    ("blackcoffeerobotics+EZGripper_ros2", "10022e4", "", {}),
]
_DATA = ("xacro", "urdf", "srdf", "sdf", "world", "xml", "yaml", "yml", "rviz", "launch", "txt")
_CODE = ("py", "cpp", "cc", "c", "hpp", "hh", "h", "lua")
_PARTS = ("link", "joint", "ros2_control")


def git(repo: Path, *words: str, given: bytes = b"") -> bytes:
    """Return what git prints; nothing is fetched."""
    words = ("git", "-c", "remote.origin.promisor=false", f"--git-dir={repo}", *words)
    return subprocess.run(words, input=given, capture_output=True, check=True).stdout


def checkout(repo: Path, commit: str, folder: Path) -> Path:
    """Return the text files of a commit; a mirror lacks the largest."""
    names = git(repo, "ls-tree", "-r", "-z", "--name-only", commit).decode().split("\0")
    texts = [it for it in names if it.rpartition(".")[2] in (*_DATA, *_CODE)]
    asked = "".join(f"{commit}:{it}\n" for it in texts).encode()
    stream = BytesIO(git(repo, "cat-file", "--batch", given=asked))
    for name in texts:
        head = stream.readline().split()
        if head[-1] == b"missing":
            continue
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(stream.read(int(head[-1])))
        stream.read(1)
    (folder / ".git").mkdir()
    return folder


def packages(repo: Path, commit: str, before: Path, only: str) -> Iterator[Path]:
    """Yield the packages whose xacros the commit changes."""
    names = git(repo, "diff", "--name-only", f"{commit}^", commit, "--", "*.xacro").decode().split()
    found: dict[Path, None] = {}
    for name in names:
        above = (before / name).parents
        home = next((it for it in above if (it / "package.xml").exists()), None)
        if home is not None and only in home.name:
            found.setdefault(home)
    yield from found


def elements(path: Path, arguments: dict[str, str]) -> list[object]:
    """Return a description as its readers see it."""
    root = etree.fromstring(read_whole(str(path), arguments).data)
    return [dict(root.attrib), *map(plain, root.iterchildren("*"))]


def theirs(before: Path, after: Path, given: dict[str, str]) -> str:
    """Return what the maintainer's commit made of a description."""
    if not after.exists():
        return "moved"
    try:
        kept = elements(before, given) == elements(after, given)
        found = find_arguments(str(after), given, builtin_tree((), "jazzy"), wanted=names_robots)
        own = next(
            (it.name for it in found.arguments if any(u.kind == "link" for u in it.uses)), ""
        )
        told = "same without" if kept else "NOT the same without"
        if not own:
            return f"{told}, no argument found in links"
        root = etree.fromstring(read_whole(str(after), {**given, own: "robot1_"}).data)
        bare = [
            f"{tag} {it.get('name')}"
            for tag in _PARTS
            for it in root.iterchildren(tag)
            if "robot1_" not in it.get("name", "") and it.get("name") != "world"
        ]
        return f"{told}; {own}; bare: {len(bare)} {', '.join(bare[:4])}"
    except MultibotError as error:
        return f"cannot be expanded: {error}"


def ours(folder: Path, given: dict[str, str]) -> str:
    """Return what adopt makes of a package."""
    try:
        made = adopt(str(folder), xacro_args=given)
    except MultibotError as error:
        return f"refused: {str(error)[:200]}"
    if not made.argument:
        return f"has {sorted(set(made.already.values()))} already"
    names = ", ".join(os.path.basename(it) for it in made.verified[:4])
    return (
        f"{made.argument}, {made.namespace or '-'}: {len(made.verified)} proved ({names}),"
        f" {len(made.after)} files,"
        f" {len(made.left)} left, {len(made.unread)} unread, {len(made.already)} already"
    )


def every(mirrors: Path) -> Iterator[tuple[str, ...]]:
    """Yield a row a package: repository, commit, package, ours, theirs of its first descriptions."""
    for name, commit, only, given in COMMITS:
        repo = mirrors / name / "repo"
        with TemporaryDirectory() as one, TemporaryDirectory() as other:
            before = checkout(repo, f"{commit}^", Path(one))
            after = checkout(repo, commit, Path(other))
            for folder in packages(repo, commit, before, only):
                made = ours(folder, given)
                described = [Path(it) for it in search([str(folder)]).descriptions][:4]
                told = [
                    f"{it.name}: {theirs(it, after / it.relative_to(before), given)}"
                    for it in described
                ]
                yield name, commit, folder.name, made, " | ".join(told)


if __name__ == "__main__":
    wanted = sys.argv[2:]
    COMMITS[:] = [it for it in COMMITS if not wanted or it[1] in wanted]
    for row in every(Path(sys.argv[1])):
        print("\n  ".join(row), flush=True)
