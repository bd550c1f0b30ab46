# SPDX-License-Identifier: Apache-2.0
"""Which files xacro files include: their content is linted where it is used; what they know."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from fnmatch import fnmatchcase

from multibot_rewrite.base.bounded import bytes_if_read
from multibot_rewrite.base.grouping import sets_by_key
from multibot_rewrite.base.lazy import lazy_compile, without_comments
from multibot_rewrite.base.outside import is_file, real_path
from multibot_rewrite.description.sources.known_arguments import known_arguments
from multibot_rewrite.description.sources.packages import package_folder, package_of
from multibot_rewrite.lint.files.named import descriptions_below
from multibot_rewrite.lint.files.pairing import named_urdfs
from multibot_rewrite.rules.settings import Settings

# No tag goes on behind a "<": every letter is looked at once.
_INCLUDE = lazy_compile(rb"<xacro:include\s[^<>]*?filename\s*=\s*[\"']([^<\"']+)[\"']")
# What xacro fills in, and a name that says something beside it.
_FILLED = lazy_compile(r"\$\([^()]*\)|\$\{[^{}]*\}")
_PACKAGE = lazy_compile(r"\$\(find\s+([^\s()]+)\s*\)")
_LITERAL = lazy_compile(r"^[^*.]{4}.*\*|\*[^*.]{4}|^[^*]*$")


def included(paths: Sequence[str]) -> frozenset[str]:
    """Return files that xacro files here or in their packages include, by the known end of a path."""
    files = {real_path(path): path for path in paths}
    read = filter(_is_xacro_file, dict.fromkeys((*files.values(), *_other_xacros(paths))))
    ends = sets_by_key((os.path.basename(it), it) for path in read for it in _include_ends(path))
    loose = [it for its in ends.values() for it in its if "*" in it]
    return frozenset(
        path
        for real, path in files.items()
        if (
            any(real.endswith(f"/{asked}") for asked in ends.get(os.path.basename(real), ()))
            or any(fnmatchcase(real, f"*/{asked}") for asked in loose)
        )
        and not _includes_itself(real)
    )


def _includes_itself(real: str) -> bool:
    """Return whether a file includes itself, directly or by others: no expansion of it ends."""
    found: set[str] = set()
    todo = [real]
    while todo and real not in found:
        new = set(_included_by(todo.pop())) - found
        found |= new
        todo += new
    return real in found


def _included_by(path: str) -> Iterator[str]:
    """Yield the files that a file includes, if only packages are to be filled in."""
    for name in _INCLUDE.findall(without_comments(bytes_if_read(path))):
        asked = name.decode("utf-8", "replace")
        text = _PACKAGE.sub(lambda it: package_folder(it[1], path, ()), asked)
        if "$" not in text:
            yield real_path(os.path.join(os.path.dirname(path), text))


def _other_xacros(paths: Sequence[str]) -> Iterator[str]:
    """Yield the other xacro files of the packages of xacro files."""
    owners = (package_of(path) for path in paths if path.endswith(".xacro"))
    for folder in dict.fromkeys(own[1] for own in owners if own):
        yield from descriptions_below(folder)


def _is_xacro_file(path: str) -> bool:
    # A pipe would never end.
    return path.endswith(".xacro") and is_file(path)


def _include_ends(path: str) -> Iterator[str]:
    """Yield the paths that a file includes, without what only xacro can fill in, and without itself."""
    own = real_path(path)
    for found in _INCLUDE.findall(bytes_if_read(path)):
        name = found.decode("utf-8", "replace")
        # What is before the last substitution of a path is not known; one within a file's name stands
        # for a part of it.
        folder, _, last = _FILLED.sub("*", _FILLED.sub("*", name)).rpartition("/")
        _, filled, above = folder.rpartition("*")
        # Nor is the name of the folder that the substitution is a part of.
        above = above.partition("/")[2] if filled else folder
        known = f"{above}/{last}" if _LITERAL.search(last) else last.rpartition("*")[2]
        asked = os.path.normpath(known).lstrip("./") if known.strip("/. ") else ""
        if asked and not fnmatchcase(own, f"*/{asked}"):
            yield asked


def set_among(paths: Sequence[str], settings: Settings) -> Settings:
    """Return the settings with included files, the URDFs of SRDFs, and the arguments of xacros."""
    settings = settings._replace(included=included(paths))
    if len(paths) == 1:
        return settings
    files = [it for it in paths if _is_xacro_file(it)] if settings.arguments else []
    known = known_arguments(map(bytes_if_read, files)) if len(files) > 1 else None
    return settings._replace(urdfs=named_urdfs(paths, settings.included), elsewhere=known)
