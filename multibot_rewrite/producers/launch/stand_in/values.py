"""Substitutions, conditions and the context of the stand-in for launch.

Source: launch jazzy, substitutions/, conditions/, launch_context.py, utilities/.
"""

from __future__ import annotations

import importlib
import os
import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any

Text = Any
_TRUTHS: Mapping[str, bool] = {"true": True, "1": True, "false": False, "0": False}


class Kept:
    """Keeps what it is given by the words of ``names``; those of ``others`` mean nothing here."""

    names: tuple[str, ...] = ()
    others: tuple[str, ...] = ()

    def __init__(self, *words: Any, **options: Any) -> None:
        given = {**dict(zip(self.names, words, strict=False)), **options}
        unknown = given.keys() - {*self.names, *self.others}
        if unknown or len(words) > len(self.names):
            what = f"an unexpected keyword argument {min(unknown)!r}" if unknown else "too many"
            raise TypeError(f"{type(self).__name__} got {what}")
        vars(self).update({**dict.fromkeys(self.names), **given})


class Substitution:
    """A value that is known when the launch runs."""

    def perform(self, context: LaunchContext) -> str:
        raise NotImplementedError


class SubstitutionFailure(Exception):
    """A substitution has no value."""


class LaunchContext:
    """What a launch knows while it runs."""

    def __init__(self, *, argv: Any = None, noninteractive: bool = False) -> None:
        self.launch_configurations: dict[str, Any] = {}
        self.handlers: list[Any] = []
        self._globals: dict[str, Any] = {}
        self._locals: list[dict[str, Any]] = [{}]
        self._kept: list[dict[str, Any]] = []

    def extend_globals(self, extensions: dict[str, Any]) -> None:
        self._globals.update(extensions)

    def extend_locals(self, extensions: dict[str, Any]) -> None:
        self._locals[-1].update(extensions)

    def get_locals_as_dict(self) -> dict[str, Any]:
        return {key: it for kept in (self._globals, *self._locals) for key, it in kept.items()}

    def register_event_handler(self, event_handler: Any, append: bool = False) -> None:
        self.handlers.append(event_handler)

    def perform_substitution(self, substitution: Substitution) -> str:
        return substitution.perform(self)

    def _push_locals(self) -> None:
        self._locals.append({})

    def _pop_locals(self) -> None:
        self._locals.pop()

    def _push_launch_configurations(self) -> None:
        self._kept.append(dict(self.launch_configurations))

    def _pop_launch_configurations(self) -> None:
        self.launch_configurations = self._kept.pop()


def normalize_to_list_of_substitutions(subs: Any) -> list[Any]:
    if isinstance(subs, str | os.PathLike):
        return [TextSubstitution(text=str(subs))]
    if hasattr(subs, "perform"):
        return [subs]
    return [it if hasattr(it, "perform") else TextSubstitution(text=str(it)) for it in subs]


def perform_substitutions(context: LaunchContext, subs: list[Any]) -> str:
    return "".join(context.perform_substitution(it) for it in subs)


def text_of(context: LaunchContext, value: Text) -> str:
    """The value of a text, a substitution, or several of both."""
    return perform_substitutions(context, normalize_to_list_of_substitutions(value))


def _substitution(
    perform: Callable[[Any, LaunchContext], str], *names: str, others: tuple[str, ...] = ()
) -> Any:
    """A substitution with these arguments."""
    made = {"names": names, "others": others, "perform": perform}
    return type("Made", (Kept, Substitution), made)


def _configuration(it: Any, context: LaunchContext) -> str:
    name = text_of(context, it.variable_name)
    return _found(context, context.launch_configurations, name, it.default, "launch configuration")


def _variable(it: Any, context: LaunchContext) -> str:
    name = text_of(context, it.name)
    return _found(context, os.environ, name, it.default_value, "environment variable")


def _found(
    context: LaunchContext, known: Mapping[str, str], name: str, usual: Text, what: str
) -> str:
    if name not in known and usual is None:
        raise SubstitutionFailure(f"{what} '{name}' does not exist")
    return known[name] if name in known else text_of(context, usual)


def _expression(it: Any, context: LaunchContext) -> str:
    given = "math" if it.python_modules is None else it.python_modules
    names = [text_of(context, one) for one in ([given] if isinstance(given, str) else given)]
    modules = {name: importlib.import_module(name) for name in names}
    known = {**vars(modules["math"]), **modules} if "math" in modules else modules
    # The file is a program in Python, too.
    return str(eval(text_of(context, it.expression), {}, known))


def _path(it: Any, context: LaunchContext) -> str:
    return os.path.join(*(text_of(context, one) for one in it.substitutions))


def _file(context: LaunchContext) -> str:
    return str(context.get_locals_as_dict()["current_launch_file_path"])


def _is(value: bool) -> str:
    return str(value).lower()


TextSubstitution = _substitution(lambda it, context: str(it.text), "text")
LaunchConfiguration = _substitution(_configuration, "variable_name", "default")
EnvironmentVariable = _substitution(_variable, "name", "default_value")
PathJoinSubstitution = _substitution(_path, "substitutions")
PythonExpression = _substitution(_expression, "expression", "python_modules")
ThisLaunchFile = _substitution(lambda it, context: _file(context))
ThisLaunchFileDir = _substitution(lambda it, context: os.path.dirname(_file(context)))
EqualsSubstitution = _substitution(
    lambda it, context: _is(text_of(context, it.left) == text_of(context, it.right)),
    *("left", "right"),
)
NotSubstitution = _substitution(lambda it, context: _is(not truth_of(context, it.value)), "value")
# What they print is known to ``commands``.
Command = _substitution(Substitution.perform, "command", others=("on_stderr",))
FindExecutable = _substitution(Substitution.perform, "name")


class IfCondition(Kept):
    """A condition that is true for ``true`` and ``1``."""

    names = ("predicate_expression",)
    wanted = True

    def evaluate(self, context: LaunchContext) -> bool:
        return truth_of(context, vars(self)["predicate_expression"]) == self.wanted


class UnlessCondition(IfCondition):
    """The opposite."""

    wanted = False


def truth_of(context: LaunchContext, value: Text) -> bool:
    """The truth of a text; raises ValueError for one that is none."""
    word = text_of(context, value).strip().lower()
    if word not in _TRUTHS:
        raise ValueError(f"{word!r} is no condition; write true or false")
    return _TRUTHS[word]


_PLACED = re.compile(r"\$\(([\w-]+) ?([^()]*)\)")
_WORDS = {"var": LaunchConfiguration, "env": EnvironmentVariable}


def parse_substitution(value: str) -> list[Any]:
    """The parts of a text with ``$(var NAME)`` and ``$(env NAME)``; raises ValueError for others."""
    return list(_parsed(value))


def _parsed(text: str) -> Iterator[Any]:
    at = 0
    for found in _PLACED.finditer(text):
        if found[1] not in _WORDS:
            raise ValueError(f"{found[0]} needs launch itself; source ROS 2")
        yield TextSubstitution(text=text[at : found.start()])
        yield _WORDS[found[1]](found[2])
        at = found.end()
    yield TextSubstitution(text=text[at:])
