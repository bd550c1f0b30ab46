# SPDX-License-Identifier: Apache-2.0
"""Files that a launch makes of others, such as nav2_common's RewrittenYaml -> what they are made of.

Source: nav2_common jazzy, launch/rewritten_yaml.py and replace_string.py (``name`` is the file that
they read); launch_ros jazzy, parameter_descriptions.py (``allow_substs``).
"""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import wraps
from typing import Any

from multibot_rewrite.producers.launch.door import of_launch, of_launch_ros

_MAKERS = ("RewrittenYaml", "ReplaceString")
_KEPT = "multibot_made_of"


def keep_sources() -> None:
    """From now on it is known of what file a substitution or a parameter file makes another one."""
    substitution = of_launch("substitution").Substitution
    substitution.__init__ = _wrapping(substitution.__init__)
    files = of_launch_ros("parameter_descriptions").ParameterFile
    files.evaluate = _keeping(files.evaluate, lambda it: it._ParameterFile__param_file)


def source_of(path: str, context: Any) -> str:
    """The file that this one is made of; itself where a launch has not made it."""
    known = getattr(context, _KEPT, {})
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
        if str(path) not in getattr(context, _KEPT, {}):
            # What is read may be made as well, and kept meanwhile.
            source = _text(read(self), context)
            setattr(context, _KEPT, getattr(context, _KEPT, {}) | {str(path): source})
        return path

    return keeping


def _text(path: Any, context: Any) -> str:
    if isinstance(path, str | os.PathLike):
        return str(path)
    return str(of_launch("utilities").perform_substitutions(context, path))
