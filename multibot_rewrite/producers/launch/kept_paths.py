# SPDX-License-Identifier: Apache-2.0
"""Paths that a launch file names, as they are when it has been read; what the files are made of that it
makes itself, such as RewrittenYaml.

Source: nav2_common jazzy, launch/rewritten_yaml.py and replace_string.py (``name`` is the file that
they read); launch_ros jazzy, parameter_descriptions.py (``allow_substs``).
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterable
from functools import wraps
from typing import Any

from multibot_rewrite.producers.launch.door import of_launch, of_launch_ros

LIMIT = 1 << 24


def is_made(path: str) -> bool:
    """Is it a file of the launch itself?"""
    return os.path.realpath(path).startswith(os.path.realpath(tempfile.gettempdir()) + os.sep)


def lasting(words: Iterable[str]) -> list[str]:
    """Words with paths that are there when the launch is over: the folder with links to sources is gone
    then. Of a file that the launch makes its text is kept (``-string``)."""
    kept = list(words)
    for at, word in enumerate(kept):
        if at and kept[at - 1] == "-file" and is_made(word) and os.path.isfile(word):
            kept[at - 1 : at + 1] = "-string", read_text(word)
        elif word.startswith(tempfile.gettempdir() + os.sep) and not is_made(word):
            kept[at] = os.path.realpath(word)
    return kept


def read_text(path: str) -> str:
    """The text of a file, up to a limit."""
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.read(LIMIT)


def kept_file(path: str) -> str:
    """The real path of a file that is there when the launch is over, else nothing."""
    return os.path.realpath(path) if os.path.isfile(path) and not is_made(path) else ""


def lasting_folders(text: str) -> str:
    """A list of folders, as they are when the launch is over: in the place of one with links to the
    sources of packages the folders of these, each once."""
    found: dict[str, None] = {}
    for it in lasting(text.split(os.pathsep)):
        links = [one.path for one in os.scandir(it)] if is_made(it) and os.path.isdir(it) else []
        found |= dict.fromkeys(os.path.dirname(os.path.realpath(one)) for one in links)
        found |= {} if links else {it: None}
    return os.pathsep.join(found)


_MAKERS = ("RewrittenYaml", "ReplaceString")
_MADE_OF = "multibot_made_of"


def keep_sources() -> None:
    """From now on it is known of what file a substitution or a parameter file makes another one."""
    substitution = of_launch("substitution").Substitution
    substitution.__init__ = _wrapping(substitution.__init__)
    files = of_launch_ros("parameter_descriptions").ParameterFile
    files.evaluate = _keeping(files.evaluate, lambda it: it._ParameterFile__param_file)


def source_of(path: str, context: Any) -> str:
    """The file that this one is made of; itself where a launch has not made it."""
    known = getattr(context, _MADE_OF, {})
    while known.get(path, path) != path:
        path = known[path]
    return path


def _wrapping(made: Callable[..., None]) -> Callable[..., None]:
    @wraps(made)
    def wrapping(self: Any, *words: Any, **options: Any) -> None:
        kind = type(self)
        if kind.__name__ in _MAKERS and not hasattr(kind.perform, "__wrapped__"):
            kind.perform = _keeping(kind.perform, lambda it: it.name)
        made(self, *words, **options)

    return wrapping


def _keeping(made: Callable[[Any, Any], Any], read: Callable[[Any], Any]) -> Callable[..., Any]:
    @wraps(made)
    def keeping(self: Any, context: Any) -> Any:
        path = made(self, context)
        if str(path) not in getattr(context, _MADE_OF, {}):
            # What is read may be made as well, and kept meanwhile.
            source = _text(read(self), context)
            setattr(context, _MADE_OF, getattr(context, _MADE_OF, {}) | {str(path): source})
        return path

    return keeping


def _text(path: Any, context: Any) -> str:
    if isinstance(path, str | os.PathLike):
        return str(path)
    return str(of_launch("utilities").perform_substitutions(context, path))
