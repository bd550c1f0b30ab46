"""Launch files -> values for arguments that a xacro needs and nobody gave."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import lru_cache

from multibot_rewrite.base.bounded import read_bytes
from multibot_rewrite.base.record import NamedTuple

MOST_BYTES = 1_000_000
# What gives each robot its own names.
_PREFIX, _NAME = ("prefix", "tf_prefix"), ("name", "robot_name", "namespace", "ns")
# A declaration in Python or XML: its default, or the first of its choices.
_PYTHON = (
    r"""["']%s["']\s*,(?:(?!Declare|LaunchConfiguration)[^\0]){0,400}?"""
    r"""\b%s\s*=\s*\[?\s*["']([^"']+)"""
)
_XML = r"""<arg\b[^>]*\bname=["']%s["'][^>]*\bdefault=["']([^"'$]+)["']"""
_DEFAULT, _CHOICES = "default(?:_value)?", "choices"
_ARGUMENT = re.compile(r"""<xacro:arg\b[^>]*\bname=["'](\w+)["']""")


class NeededValues(NamedTuple):
    """Values that ``launch`` files give to the arguments of xacros."""

    launch: Sequence[str]

    def of(self, name: str) -> str:
        """The value of an argument: the robot's name where it is called so, else what a launch file
        declares; empty where none does. Raises nothing."""
        if name in _PREFIX:
            return "{robot}_"
        if name in _NAME:
            return "{robot}"
        word = re.escape(name)
        patterns = (_PYTHON % (word, _DEFAULT), _XML % word, _PYTHON % (word, _CHOICES))
        return next(self._found(patterns), "")

    def of_mandatory(self, path: str) -> dict[str, str]:
        """The arguments of a xacro that every launch has to choose a value for, with the first of them:
        the xacro's own default may be no value at all. Raises nothing."""
        names = dict.fromkeys(_ARGUMENT.findall(_text(path)))
        return {name: value for name in names if (value := self._choice(name))}

    def _choice(self, name: str) -> str:
        word = re.escape(name)
        with_default = any(self._found((_PYTHON % (word, _DEFAULT),)))
        return "" if with_default else next(self._found((_PYTHON % (word, _CHOICES),)), "")

    def _found(self, patterns: Sequence[str]) -> Iterator[str]:
        for pattern in patterns:
            for path in self.launch:
                found = re.search(pattern, _text(path))
                if found:
                    yield found[1]


@lru_cache(maxsize=256)
def _text(path: str) -> str:
    try:
        return read_bytes(path, MOST_BYTES).decode("utf-8", "replace")
    except OSError:
        return ""
