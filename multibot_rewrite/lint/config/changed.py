# SPDX-License-Identifier: Apache-2.0
"""Which files changed since a revision, and which xacro files include one that did."""

import os
import re
import subprocess
from collections.abc import Collection, Iterable, Iterator, Sequence
from fnmatch import fnmatchcase
from typing import NamedTuple

from multibot_rewrite.base.bounded import read_bytes
from multibot_rewrite.base.child import git
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import UsageError

_INCLUDE = re.compile(
    rb"<xacro:include\s(?:[^<>\"']|\"[^<\"]*\"|'[^<']*')*?filename\s*=\s*(\"[^<\"]*\"|'[^<']*')"
)
# PATH_MAX of Linux: no file has a longer name.
_LONGEST = 4096
# The mode of a submodule in the list of an index.
_SUBMODULE = b"160000 "
# Only xacro knows these values: it may be any name.
_UNKNOWN = re.compile(rb"\$.*[)}]|\$.*|&#?\w+;", re.DOTALL)
# Text in a file, or the end of its name -> files that it reads without naming them.
_YAML = (b"load_yaml", ("*.yaml", "*.yml"))
_BESIDE = ((".srdf", ".srdf.xacro"), ("*.urdf", "*.xacro"))


class Changes(NamedTuple):
    """Of the repository at ``top``: the paths that changed, those that git has, the others."""

    top: str
    changed: frozenset[str]
    tracked: frozenset[str]
    untracked: frozenset[str]


def changed_since(rev: str, paths: Sequence[str]) -> list[str]:
    """Return those of ``paths`` that changed since HEAD and ``rev`` had a commit in common.

    That is in a commit since then or in the working tree, not in git, or a xacro that includes such a
    file. The repository is that of the working directory; what is outside of it, or ignored, counts as
    changed. Raises UsageError if git fails."""
    if not rev or rev.startswith("-") or "\0" in rev:
        raise UsageError(f"{rev!r} is not a revision; name a branch, a tag or a commit")
    top = os.fsdecode(_git(".", "rev-parse", "--show-toplevel").removesuffix(b"\n"))
    changed, others = _differing(top, _common_commit(rev))
    changes = Changes(top, changed | others, _listed_names(_git(top, "ls-files", "-z")), others)
    touched = _changed_by_path(paths, changes)
    return [it for it in paths if touched[it]]


def _differing(top: str, base: str) -> tuple[frozenset[str], frozenset[str]]:
    """Return what differs from a commit, in submodules too, and the files that git does not have."""
    diff = [
        "diff",
        "--name-only",
        "-z",
        "--no-renames",
        "--no-ext-diff",
        "--ignore-submodules=dirty",
    ]
    changed = _listed_names(_git(top, *diff, base, "--"))
    others = _listed_names(_git(top, "ls-files", "-z", "--others", "--exclude-standard"))
    inner = {it for it in _submodules(top) if any(_differing(os.path.join(top, it), "HEAD"))}
    return changed | inner, others


def _submodules(top: str) -> Iterator[str]:
    """Yield the submodules that are checked out."""
    for entry in _git(top, "ls-files", "-z", "--stage").split(b"\0"):
        name = os.fsdecode(entry.partition(b"\t")[2])
        if entry.startswith(_SUBMODULE) and os.path.exists(os.path.join(top, name, ".git")):
            yield name


def _common_commit(rev: str) -> str:
    """Return the last commit that HEAD and the revision have in common."""
    try:
        _git(".", "rev-parse", "--verify", "--quiet", f"{rev}^{{commit}}")
    except UsageError:
        raise UsageError(
            f"git does not know the revision {rev!r}; fetch it, or use another one"
        ) from None
    try:
        return _git(".", "merge-base", rev, "HEAD").decode().strip()
    except UsageError:
        hint = "fetch the whole history (fetch-depth: 0)"
        raise UsageError(f"{rev!r} and HEAD have no commit in common; {hint}") from None


def _git(where: str, *words: str) -> bytes:
    """Return what git prints in a folder; raises UsageError if it fails."""
    try:
        return git(where, *words)
    except OSError as error:
        raise UsageError(f"git cannot be run: {error.strerror}; install it") from None
    except subprocess.CalledProcessError as error:
        lines = error.stderr.decode("utf-8", "replace").strip().splitlines() or ["it failed"]
        raise UsageError(f"git reports: {lines[0].removeprefix('fatal: ')}") from None


def _listed_names(listed: bytes) -> frozenset[str]:
    """Return the names in a list with zeros between them; a nested repository ends in a slash."""
    return frozenset(os.fsdecode(it).rstrip("/") for it in listed.split(b"\0") if it)


def _changed_by_path(paths: Iterable[str], changes: Changes) -> dict[str, bool]:
    """Return which files changed, or read one that did; included files are checked, too."""
    reads = _names_read(paths, changes)
    changed_by_path = {path: _is_changed(path, changes) for path in reads}
    names = {os.path.basename(path) for path, it in changed_by_path.items() if it}
    for path in changes.changed:  # a nested repository changed as a whole
        names.add(os.path.basename(path))
        names.update(*(files for _, _, files in os.walk(os.path.join(changes.top, path))))
    left = {path: patterns for path, patterns in reads.items() if not changed_by_path[path]}
    while more := [
        path for path, patterns in left.items() if any(_matching(it, names) for it in patterns)
    ]:
        changed_by_path.update(dict.fromkeys(more, True))
        names.update(os.path.basename(path) for path in more)
        left = {path: patterns for path, patterns in left.items() if not changed_by_path[path]}
    return changed_by_path


def _is_changed(path: str, changes: Changes) -> bool:
    """Return whether the file itself changed, or the one that a link leads to."""
    folder, name = os.path.split(path)
    places = {os.path.realpath(path), os.path.join(os.path.realpath(folder), name)}
    for it in places:
        # A nested repository is listed as its folder.
        parts = os.path.relpath(it, changes.top).split(os.sep)
        names = {os.sep.join(parts[:end]) for end in range(1, len(parts) + 1)}
        if not names.isdisjoint(changes.changed) or names.isdisjoint(changes.tracked):
            return True
    return False


def _names_read(paths: Iterable[str], changes: Changes) -> dict[str, tuple[str, ...]]:
    """Return patterns for the names of what each file reads, also for all that they include."""
    every = changes.tracked | changes.untracked
    there = lists_by_key((os.path.basename(it), os.path.join(changes.top, it)) for it in every)
    found: dict[str, tuple[str, ...]] = {}
    todo = list(paths)
    while todo:
        path = todo.pop()
        if path not in found:
            asked = list(_include_patterns(path))
            found[path] = tuple(os.path.basename(it) for it in asked)
            todo += _files_called(path, asked, there)
    return found


def _include_patterns(path: str) -> Iterator[str]:
    """Yield patterns for the files that a file reads, as far as its text shows it."""
    if path.endswith(_BESIDE[0]):
        yield from _BESIDE[1]
    if path.endswith(".urdf"):
        return
    try:
        data = read_bytes(path)
    except (OSError, ValueError):  # reported when it is linted
        return
    if _YAML[0] in data:
        yield from _YAML[1]
    for name in _INCLUDE.findall(data):
        if len(name) < _LONGEST:
            yield os.fsdecode(_UNKNOWN.sub(b"*", name[1:-1]))


def _files_called(path: str, asked: Iterable[str], there: dict[str, list[str]]) -> Iterator[str]:
    """Yield files of these names, wherever they are; git may not have the one next to the file."""
    for it in asked:
        name = os.path.basename(it)
        beside = os.path.join(os.path.dirname(path), it)
        if os.path.isfile(beside):
            yield beside
        # A name that is all wildcard matches every change anyway.
        if name.strip("*"):
            yield from (file for known in _matching(name, there) for file in there[known])


def _matching(pattern: str, names: Collection[str]) -> list[str]:
    found = [pattern] if pattern in names else []
    if not any(it in pattern for it in "*?["):
        return found
    return found + [it for it in names if it != pattern and fnmatchcase(it, pattern)]
