# SPDX-License-Identifier: Apache-2.0
"""The paths that a launch file names, as they are afterwards; and what its own files are made of.

Source: nav2_common jazzy, launch/rewritten_yaml.py and replace_string.py (``name`` is the file that
they read); launch_ros jazzy, parameter_descriptions.py (``allow_substs``)."""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Callable, Iterable
from functools import wraps
from typing import Any

from multibot_rewrite.producers.launch.door import of_launch, of_launch_ros
from multibot_rewrite.producers.launch.source_packages import NOT_INSTALLED, SOURCES

LIMIT = 1 << 24
# Below these is what a machine has: devices, and what its kernel says of it; but for what all have.
_OF_MACHINE = ("/dev/", "/proc/", "/run/", "/sys/")
_EVERYWHERE = frozenset(("/dev/null", "/dev/random", "/dev/urandom", "/dev/zero"))
# What the folder is called in which launch files are read.
FOLDER = "multibot_launch_"
# The folder of what is gone when the launch is over.
GONE = "/made_by_the_launch"
NOT_KNOWN = "comes from a package that is not installed, or from the launch itself; it is left out"
_REST = r"[^\s'\"<>:;,|)]*"


def is_of_machine(path: str) -> bool:
    """Return whether a path is that of a device, or of another thing that one machine alone has."""
    place = os.path.abspath(path)
    return f"{place}/".startswith(_OF_MACHINE) and place not in _EVERYWHERE


def is_made(path: str) -> bool:
    """Return whether a path is a file of the launch itself; a text of several lines is no path."""
    if "\n" in path or is_of_machine(path):
        return False
    return os.path.realpath(path).startswith(os.path.realpath(_top()) + os.sep)


def _top() -> str:
    """Return the folder in which each launch file has a folder for what it makes."""
    own = tempfile.gettempdir()
    above = os.path.dirname(own)
    return above if os.path.basename(above).startswith(FOLDER) else own


def lasting(words: Iterable[str]) -> list[str]:
    """Return words of a program; a file that the launch makes becomes its text (``-string``)."""
    kept: list[str] = []
    for word in words:
        flag, _, path = word.partition("=") if word.startswith("-") else ("", "", word)
        flag = flag or (kept[-1] if kept else "")
        if flag.lstrip("-") == "file" and is_made(path) and os.path.isfile(path):
            kept[len(kept) - (path == word) :] = "-string", read_text(path)
        else:
            kept.append(word)
    return kept


def known_words(words: Iterable[str]) -> tuple[tuple[str, ...], list[str]]:
    """Return a program's arguments without those that are gone, each with its flag; and these flags."""
    kept: list[str] = []
    lost: list[str] = []
    for word in words:
        if GONE not in word:
            kept.append(word)
            continue
        lost.append(kept.pop() if kept and kept[-1].startswith("-") else "")
    return tuple(kept), lost


def read_text(path: str) -> str:
    """Return the text of a file, up to a limit."""
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.read(LIMIT)


def kept_file(path: str) -> str:
    """Return the real path of a file that remains after the launch; empty otherwise."""
    if is_of_machine(path) or is_made(path) or not os.path.isfile(path):
        return ""
    return os.path.realpath(path)


def with_real_paths(it: Any) -> Any:
    """Return a value with ``real_paths`` of each of its texts, at any depth."""
    if isinstance(it, str):
        return real_paths(it)
    if isinstance(it, dict):
        return {with_real_paths(key): with_real_paths(one) for key, one in it.items()}
    if hasattr(it, "_fields"):
        return type(it)(*map(with_real_paths, it))
    return type(it)(map(with_real_paths, it)) if isinstance(it, list | tuple) else it


def real_paths(text: str) -> str:
    """Return a text with the launch's temporary paths replaced by those that are there afterwards."""
    top = _top()
    if not top or top not in text:
        return text
    return re.sub(rf"{re.escape(top)}(?:/\d+)?({_REST})", lambda it: _real_path(it[0], it[1]), text)


def _real_path(path: str, below: str) -> str:
    """Return what a path ``below`` a launch file's folder is afterwards: a source, or GONE."""
    # An installed package is no link: above its share folder is that of all packages.
    path, below = map(os.path.normpath, (path, below.strip("/")))
    first, *inside = below.split("/")
    if first in (NOT_INSTALLED, SOURCES) and inside[:1] == ["lib"] and len(inside) > 1:
        return "/".join((f"$(find-pkg-prefix {inside[1]})", *inside))
    if first == NOT_INSTALLED and len(inside) > 1:
        return "/".join((f"$(find-pkg-share {inside[1]})", *inside[2:]))
    if first != SOURCES or inside[:1] != ["share"]:
        return "/".join((GONE, first, *inside))
    if len(inside) == 1:
        every = (_source_of_link(it.path) for it in os.scandir(path))
        return os.pathsep.join(dict.fromkeys(os.path.dirname(it) for it in every if it))
    real = os.path.realpath(path)
    return real if not is_made(real) else _source_of_link(path) or GONE


def _source_of_link(folder: str) -> str:
    """Return the sources of what is a link, or a folder of links; empty for another one."""
    if os.path.islink(folder):
        real = os.path.realpath(folder)
        return "" if is_made(real) else real
    manifest = os.path.join(folder, "package.xml")
    names = [manifest] if os.path.exists(manifest) else []
    names += [it.path for it in os.scandir(folder)] if os.path.isdir(folder) else []
    return next((os.path.dirname(it) for it in map(_source_of_link, names) if it), "")


_MAKERS = ("RewrittenYaml", "ReplaceString")
_MADE_OF = "multibot_made_of"


def keep_sources() -> None:
    """Note from now on from which file a substitution or a parameter file makes another one."""
    substitution = of_launch("substitution").Substitution
    substitution.__init__ = _noting_constructor(substitution.__init__)
    files = of_launch_ros("parameter_descriptions").ParameterFile
    files.evaluate = _note_source(files.evaluate, lambda it: it._ParameterFile__param_file)


def source_of(path: str, context: Any) -> str:
    """Return the file that this one is made from; itself if a launch has not made it."""
    known = getattr(context, _MADE_OF, {})
    while known.get(path, path) != path:
        path = known[path]
    return path


def _noting_constructor(made: Callable[..., None]) -> Callable[..., None]:
    """Return a constructor of substitutions that note which file they make another one of."""

    @wraps(made)
    def wrapping(self: Any, *words: Any, **options: Any) -> None:
        kind = type(self)
        if kind.__name__ in _MAKERS and not hasattr(kind.perform, "__wrapped__"):
            kind.perform = _note_source(kind.perform, lambda it: it.name)
        made(self, *words, **options)

    return wrapping


def _note_source(made: Callable[[Any, Any], Any], read: Callable[[Any], Any]) -> Callable[..., Any]:
    """Return a method that also notes which file it makes another one of."""

    @wraps(made)
    def keeping(self: Any, context: Any) -> Any:
        """Return the path that is made, after noting its source."""
        path = made(self, context)
        if str(path) not in getattr(context, _MADE_OF, {}):
            # What is read may be made as well, and kept meanwhile.
            source = read(self)
            if not isinstance(source, str | os.PathLike):
                source = of_launch("utilities").perform_substitutions(context, source)
            setattr(context, _MADE_OF, getattr(context, _MADE_OF, {}) | {str(path): str(source)})
        return path

    return keeping
