# SPDX-License-Identifier: Apache-2.0
"""Parameters with the types of launch_ros; nav2_common's parameter files that are made of others.

Source: launch_ros jazzy, utilities/evaluate_parameters.py, parameter_descriptions.py; nav2_common
humble to main, launch/rewritten_yaml.py, replace_string.py, has_node_params.py,
parse_multirobot_pose.py, launch_config_as_bool.py."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import yaml

from multibot_rewrite.base.bounded import A_VALUE, load_yaml
from multibot_rewrite.base.model import InputError
from multibot_rewrite.producers.launch.stand_in.frontend import parse_substitution
from multibot_rewrite.producers.launch.stand_in.values import (
    Kept,
    LaunchConfiguration,
    LaunchContext,
    Substitution,
    Text,
    normalize_to_list_of_substitutions,
    perform_substitutions,
    str_of,
    text_of,
    typed_truth,
)

_ITEMS = (bool, int, float, str)


_PLAIN = (*_ITEMS, bytes)


_UNIFORM = (
    "Expected a non-empty sequence, with items of uniform type. "
    "Allowed sequence item types are bool, int, float, str."
)


_KINDS = (
    "Allowed value types are bytes, bool, int, float, str, Sequence[bool], Sequence[int], "
    "Sequence[float], Sequence[str]."
)


class ParameterValue:
    """A value with its type."""

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.value, self.value_type = value, value_type

    def evaluate(self, context: LaunchContext) -> Any:
        if isinstance(self.value, list | tuple) and not _is_substituted(self.value):
            return [text_of(context, it) if _is_substituted(it) else it for it in self.value]
        if not _is_substituted(self.value):
            return self.value
        text = text_of(context, self.value)
        if self.value_type in (str, int, float):
            return self.value_type(text)
        if self.value_type is bool:
            return typed_truth(text)
        return load_yaml(text, A_VALUE) if text else text


class Parameter:
    """A parameter with its value."""

    def __init__(self, name: Text, value: Any, *, value_type: Any = None) -> None:
        self.name, self.value = name, ParameterValue(value, value_type=value_type)

    def evaluate(self, context: LaunchContext) -> tuple[str, Any]:
        return text_of(context, self.name), self.value.evaluate(context)


class ParameterFile:
    """A parameter file."""

    def __init__(self, param_file: Any, *, allow_substs: Any = False) -> None:
        is_path = isinstance(param_file, os.PathLike) and not hasattr(param_file, "perform")
        text = [os.fspath(param_file)] if is_path else param_file
        self.__param_file = normalize_to_list_of_substitutions(text)
        self.allow_substs = allow_substs

    def path(self, context: LaunchContext) -> str:
        """Return the path, before its substitutions are replaced."""
        return perform_substitutions(context, self.__param_file)

    def evaluate(self, context: LaunchContext) -> Path:
        path = Path(self.path(context))
        if not typed_truth(text_of(context, str_of(self.allow_substs))):
            return path
        with tempfile.NamedTemporaryFile("w", prefix="launch_params_", delete=False) as out:
            out.write(text_of(context, parse_substitution(path.read_text(encoding="utf-8"))))
        return Path(out.name)


def evaluate_parameters(context: LaunchContext, parameters: Iterable[Any]) -> tuple[Any, ...]:
    """Return files as paths, values by name; raises TypeError for a value that is neither."""
    return tuple(_evaluate_one(context, it) for it in parameters)


def _evaluate_one(context: LaunchContext, given: Any) -> Any:
    if isinstance(given, Mapping):
        named = flat(given).items()
        return {text_of(context, key): value_of(context, it, key) for key, it in named}
    if isinstance(given, Parameter):
        return given
    return (given if isinstance(given, ParameterFile) else ParameterFile(given)).evaluate(context)


def flat(given: Any) -> Any:
    """Return parameters with dotted names; files and unknown values stay as they are."""
    return dict(_flat_items(given, ())) if isinstance(given, Mapping) else given


def _flat_items(
    given: Mapping[Any, Any], above: tuple[Any, ...]
) -> Iterator[tuple[tuple[Any, ...], Any]]:
    for key, value in given.items():
        name = (*above, *([key] if isinstance(key, str) or hasattr(key, "perform") else key))
        if isinstance(value, Mapping):
            yield from _flat_items(value, (*name, "."))
        elif isinstance(value, (*_PLAIN, list, tuple)) or any(
            hasattr(value, it) for it in ("perform", "evaluate")
        ):
            yield name, value
        else:
            raise _no_value(value)


def _no_value(value: Any) -> TypeError:
    return TypeError(f"Unexpected type for parameter value {value!r}")


def value_of(context: LaunchContext, value: Any, name: Text) -> Any:
    if _is_substituted(value):
        return _read(text_of(context, value), text_of(context, name))
    if hasattr(value, "evaluate"):
        return value.evaluate(context)
    if isinstance(value, list | tuple):
        # Values of one type; those that have none in common are texts.
        kinds = {type(it) for it in value}
        if kinds == {int, float}:
            return [float(it) for it in value]
        texts = [
            it if isinstance(it, _PLAIN) else load_yaml(text_of(context, it), A_VALUE)
            for it in value
        ]
        if not _are_alike(texts):
            raise TypeError(f'{_UNIFORM} Got inconsistent input for "{text_of(context, name)}"')
        return texts
    if not isinstance(value, _PLAIN):
        raise _no_value(value)
    return value


def _are_alike(values: list[Any]) -> bool:
    return bool(values) and len({type(it) for it in values}) == 1 and isinstance(values[0], _ITEMS)


def _is_substituted(value: Any) -> bool:
    """Return whether a value is a substitution, or texts with one."""
    several = value if isinstance(value, list | tuple) else ()
    texts = all(isinstance(it, str) or hasattr(it, "perform") for it in several)
    return hasattr(value, "perform") or (texts and any(hasattr(it, "perform") for it in several))


def _read(text: str, name: str) -> Any:
    """Return the text of a substitution as YAML has it."""
    wrapped = "try wrapping it in launch_ros.parameter_descriptions.ParameterValue"
    hint = f"If the parameter is meant to be a string, {wrapped}(value, value_type=str)"
    try:
        found = load_yaml(text, A_VALUE) if text else ""
    except InputError:
        what = f"Unable to parse the value of parameter {name} as yaml."
        raise TypeError(f"{what} {hint}") from None
    if isinstance(found, list):
        if not _are_alike(found):
            raise TypeError(f'{_UNIFORM} Got inconsistent input for "{name}"')
    elif not isinstance(found, _PLAIN):
        raise TypeError(f'{_KINDS} Got {type(found)} for "{name}". {hint}')
    return found


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
        found = _read_file(self.path(context))
        values = {k: self._value(it) for k, it in _as_texts(context, self.param_rewrites).items()}
        _replace(found, values)
        for path, value in values.items():
            _set(found, path.split("."), value)
        found = _renamed(found, _as_texts(context, self.key_rewrites or {}))
        above = "" if self.root_key is None else text_of(context, self.root_key)
        return _temporary_file(yaml.safe_dump({above: found} if above else found))

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
        for old, new in _as_texts(context, self.replacements).items():
            text = text.replace(old, new)
        return _temporary_file(text)


class HasNodeParams(_OfFile):
    """Whether a parameter file has a section of this name."""

    names = ("source_file", "node_name")

    def perform(self, context: LaunchContext) -> str:
        return str(self.node_name in _read_file(self.path(context)))


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


def _read_file(path: str) -> Any:
    with open(path, encoding="utf-8") as file:
        return load_yaml(file.read(), path) or {}


def _temporary_file(text: str) -> str:
    with tempfile.NamedTemporaryFile("w", encoding="utf-8", delete=False) as file:
        file.write(text)
    return file.name


def _as_texts(context: LaunchContext, given: Mapping[str, Text]) -> dict[str, str]:
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
