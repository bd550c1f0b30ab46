# SPDX-License-Identifier: Apache-2.0
"""Folders and files that are no sources: what a build made, what colcon, ament or git ignores."""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Iterable
from functools import cache
from glob import escape, iglob

# What colcon, npm and Python make; colcon writes the first marker into its own three.
MADE = frozenset(("build", "install", "log", "node_modules", "__pycache__"))
MARKERS = ("COLCON_IGNORE", "AMENT_IGNORE")
# Exit code of git check-ignore where no path is ignored.
_NONE = 1


def is_hidden(name: str) -> bool:
    """Return whether a folder is hidden, as .git is."""
    return name.startswith(".")


def is_left_out(folder: str) -> bool:
    """Return whether a folder has a name that builds give theirs, or is marked to be ignored."""
    return os.path.basename(folder) in MADE or any(
        os.path.exists(os.path.join(folder, marker)) for marker in MARKERS
    )


def marked_folders(above: str) -> list[str]:
    """Return the folders in ``above`` that colcon or ament are told to ignore."""
    found = (it for marker in MARKERS for it in iglob(os.path.join(escape(above), "*", marker)))
    return sorted({os.path.dirname(it) for it in found})


def source_folders(above: str, names: Iterable[str]) -> list[str]:
    """Return the folders in ``above`` that may hold sources, in the order of their names."""
    return sorted(
        it for it in names if not is_hidden(it) and not is_left_out(os.path.join(above, it))
    )


def ignored_by_git(paths: Iterable[str]) -> set[str]:
    """Return the paths that git ignores in their work trees; none without git or outside of one."""
    trees: dict[str, list[str]] = defaultdict(list)
    for path in paths:
        if tree := _work_tree(os.path.dirname(os.path.abspath(path))):
            trees[tree].append(path)
    return {path for tree, those in trees.items() for path in _ignored_by_git(tree, those)}


def _ignored_by_git(tree: str, paths: list[str]) -> list[str]:
    import subprocess  # a command that looks into no folder needs no git

    from multibot_rewrite.base.child import git

    # The real folder: git refuses a path that a link leads out of the tree by its text.
    halves = ((path, os.path.split(os.path.abspath(path))) for path in paths)
    named = {os.path.join(os.path.realpath(above), name): path for path, (above, name) in halves}
    try:
        asked = b"\0".join(map(os.fsencode, named))
        found = git(tree, "check-ignore", "-z", "--stdin", given=asked)
    except OSError:
        return []
    except subprocess.CalledProcessError as error:
        if error.returncode != _NONE:
            return []
        found = error.stdout
    return [named[it] for it in map(os.fsdecode, found.split(b"\0")) if it in named]


@cache
def _work_tree(folder: str) -> str:
    """Return the nearest folder above with a repository of git; "" for none."""
    real = os.path.realpath(folder)
    while not os.path.exists(os.path.join(real, ".git")):
        above = os.path.dirname(real)
        if above == real:
            return ""
        real = above
    return real
