# SPDX-License-Identifier: Apache-2.0
"""Parameters as a launch file gives them to a node, with the types that launch_ros makes of them.

Source: launch_ros jazzy, utilities/evaluate_parameters.py, parameter_descriptions.py.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from multibot_rewrite.base.bounded import A_VALUE, load_yaml
from multibot_rewrite.base.model import InputError
from multibot_rewrite.producers.launch.stand_in.parse import parse_substitution
from multibot_rewrite.producers.launch.stand_in.values import (
    LaunchContext,
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
    return tuple(_evaluated(context, it) for it in parameters)


def _evaluated(context: LaunchContext, given: Any) -> Any:
    if isinstance(given, Mapping):
        named = flat(given).items()
        return {text_of(context, key): value_of(context, it, key) for key, it in named}
    if isinstance(given, Parameter):
        return given
    return (given if isinstance(given, ParameterFile) else ParameterFile(given)).evaluate(context)


def flat(given: Any) -> Any:
    """Return parameters with dotted names; files and unknown values stay as they are."""
    return dict(_flat(given, ())) if isinstance(given, Mapping) else given


def _flat(
    given: Mapping[Any, Any], above: tuple[Any, ...]
) -> Iterator[tuple[tuple[Any, ...], Any]]:
    for key, value in given.items():
        name = (*above, *([key] if isinstance(key, str) or hasattr(key, "perform") else key))
        if isinstance(value, Mapping):
            yield from _flat(value, (*name, "."))
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
    """Return whether it is a substitution, or texts with one."""
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
