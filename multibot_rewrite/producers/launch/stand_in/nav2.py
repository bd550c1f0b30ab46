# SPDX-License-Identifier: Apache-2.0
"""What launch files take from nav2_common: parameter files that are made of others.

Source: nav2_common humble to main, launch/rewritten_yaml.py, replace_string.py, has_node_params.py,
parse_multirobot_pose.py, launch_config_as_bool.py.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any

import yaml

from multibot_rewrite.base.bounded import A_VALUE, load_yaml
from multibot_rewrite.producers.launch.stand_in.values import (
    Kept,
    LaunchConfiguration,
    LaunchContext,
    Substitution,
    Text,
    normalize_to_list_of_substitutions,
    text_of,
)


class _OfFile(Kept, Substitution):
    """Something that is made of a file; ``name`` is that file, as there."""

    def __init__(self, *words: Any, **options: Any) -> None:
        super().__init__(*words, **options)
        # Of what a file is made is noted when a substitution is made (made_files.py).
        Substitution.__init__(self)

    @property
    def name(self) -> list[Any]:
        return normalize_to_list_of_substitutions(self.source_file)

    def path(self, context: LaunchContext) -> str:
        return text_of(context, self.source_file)


class RewrittenYaml(_OfFile):
    """A parameter file with other values: by the last word of their name or by all of them."""

    names = ("source_file", "param_rewrites", "root_key", "key_rewrites", "convert_types")
    others = ("value_rewrites", "out_dir")

    def perform(self, context: LaunchContext) -> str:
        found = _read(self.path(context))
        values = {k: self._value(it) for k, it in _texts(context, self.param_rewrites).items()}
        _replace(found, values)
        for path, value in values.items():
            _set(found, path.split("."), value)
        found = _renamed(found, _texts(context, self.key_rewrites or {}))
        above = "" if self.root_key is None else text_of(context, self.root_key)
        return _written(yaml.safe_dump({above: found} if above else found))

    def _value(self, text: str) -> Any:
        kinds: list[Callable[[str], Any]] = [int, float] if self.convert_types else []
        for kind in kinds:
            with suppress(ValueError):
                return kind(text)
        return {"true": True, "false": False}.get(text.lower(), text)


class ReplaceString(_OfFile):
    """A file with other words in it."""

    names = ("source_file", "replacements", "condition")

    def perform(self, context: LaunchContext) -> str:
        path = self.path(context)
        if self.condition is not None and not self.condition.evaluate(context):
            return path
        with open(path, encoding="utf-8") as file:
            text = file.read()
        for old, new in _texts(context, self.replacements).items():
            text = text.replace(old, new)
        return _written(text)


class HasNodeParams(_OfFile):
    """Has a parameter file a section of this name?"""

    names = ("source_file", "node_name")

    def perform(self, context: LaunchContext) -> str:
        return str(self.node_name in _read(self.path(context)))


class LaunchConfigAsBool(Kept, Substitution):
    """A launch configuration as ``True`` or ``False``."""

    names = ("name",)

    def perform(self, context: LaunchContext) -> str:
        word = text_of(context, LaunchConfiguration(self.name)).strip().lower()
        return str(word in ("1", "true", "yes", "on"))


class ParseMultiRobotPose:
    """The robots of the command line: ``robots:="robot1={x: 1.0}; robot2={y: 2.0}"``."""

    def __init__(self, target_argument: str) -> None:
        mark = f"{target_argument}:="
        words = (it.removeprefix(mark) for it in sys.argv[4:] if it.startswith(mark))
        self._text = next(words, "")

    def value(self) -> dict[str, dict[str, float]]:
        pairs = (it.split("=") for it in self._text.split(";"))
        none = dict.fromkeys(("x", "y", "z", "roll", "pitch", "yaw"), 0.0)
        return {it[0].strip(): none | load_yaml(it[1], A_VALUE) for it in pairs if len(it) == 2}


def _read(path: str) -> Any:
    with open(path, encoding="utf-8") as file:
        return load_yaml(file.read(), path) or {}


def _written(text: str) -> str:
    with tempfile.NamedTemporaryFile("w", encoding="utf-8", delete=False) as file:
        file.write(text)
    return file.name


def _texts(context: LaunchContext, given: Mapping[str, Text]) -> dict[str, str]:
    return {key: text_of(context, it) for key, it in given.items()}


def _replace(found: Any, values: Mapping[str, Any]) -> None:
    """Replace every value of a key of this name, at any depth."""
    if isinstance(found, dict):
        for key, below in found.items():
            _replace(below, values)
            found[key] = values.get(key, below)


def _set(found: Any, path: list[str], value: Any) -> None:
    """Set the value of a whole path: one that exists, or is to be in the parameters of a node."""
    *above, last = path
    if not above:
        return
    for word in above:
        if isinstance(found, list) and word.isdigit() and int(word) < len(found):
            found = found[int(word)]
        elif isinstance(found, dict) and (word in found or "ros__parameters" in path):
            found = found.setdefault(word, {})
        else:
            return
    if isinstance(found, list) and last.isdigit() and int(last) < len(found):
        found[int(last)] = value
    elif isinstance(found, dict) and (last in found or "ros__parameters" in path):
        found[last] = value


def _renamed(found: Any, names: Mapping[str, str]) -> Any:
    if not isinstance(found, dict):
        return found
    return {names.get(key, key): _renamed(below, names) for key, below in found.items()}
