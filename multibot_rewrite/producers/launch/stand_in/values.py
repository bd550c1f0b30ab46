# SPDX-License-Identifier: Apache-2.0
"""Substitutions, conditions and the context of the stand-in for launch.

Source: launch jazzy, substitutions/, conditions/, launch_context.py, utilities/.
"""

from __future__ import annotations

import importlib
import math
import os
from collections.abc import Callable, Iterable, Mapping
from functools import lru_cache
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, TypeVar

from multibot_rewrite.base.bounded import A_VALUE, load_yaml

Text = Any
SomeEntitiesType = SomeSubstitutionsType = Any
# How the values of a loop are called among the locals of a context.
ITERATED = "ForEachVar__"
_TRUTHS: Mapping[str, bool] = {"true": True, "1": True, "false": False, "0": False}


class Kept:
    """Keeps what it is given by the words of ``names``; those of ``others`` mean nothing here."""

    names: tuple[str, ...] = ()
    others: tuple[str, ...] = ()
    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any: ...

    def __init__(self, *words: Any, **options: Any) -> None:
        given = {**dict(zip(self.names, words, strict=False)), **options}
        unknown = given.keys() - {*self.names, *self.others}
        if unknown or len(words) > len(self.names):
            what = f"an unexpected keyword argument {min(unknown)!r}" if unknown else "too many"
            raise TypeError(f"{type(self).__name__} got {what}")
        vars(self).update({**dict.fromkeys(self.names), **given})


Kind = TypeVar("Kind", bound=type[Kept])


def kept(base: Kind, name: str, names: str, others: str = "") -> Kind:
    """Return a class that keeps what it is given by the words of ``names``, as its ``base`` does."""
    more = {"others": (*base.others, *others.split())} if others else {}
    found: Kind = type(name, (base,), {"names": tuple(names.split()), **more})  # type: ignore[assignment]
    return found


class Substitution:
    """A value that is known when the launch runs."""

    def perform(self, context: LaunchContext) -> str:
        raise NotImplementedError


SomeSubstitutionsType_types_tuple = (str, Substitution, Iterable)


class SubstitutionFailure(RuntimeError):
    """A substitution has no value."""


class InvalidConditionExpressionError(Exception):
    """The text of a condition is neither true nor false."""


class LaunchContext:
    """What a launch knows while it runs."""

    def __init__(self, *, argv: Any = None, noninteractive: bool = False) -> None:
        self.launch_configurations: dict[str, Any] = {}
        # A copy: what a launch file sets is not for the program that reads it.
        self.environment: dict[str, str] = dict(os.environ)
        self.argv = [*(argv or ())]
        self.noninteractive = noninteractive
        self.handlers: list[Any] = []
        self._globals: dict[str, Any] = {}
        self._locals: list[dict[str, Any]] = [{}]
        self._kept: list[dict[str, Any]] = []
        self._environments: list[dict[str, str]] = []

    def extend_globals(self, extensions: dict[str, Any]) -> None:
        self._globals.update(extensions)

    def extend_locals(self, extensions: dict[str, Any]) -> None:
        self._locals[-1].update(extensions)

    def get_locals_as_dict(self) -> dict[str, Any]:
        return {key: it for kept in (self._globals, *self._locals) for key, it in kept.items()}

    @property
    def depth(self) -> int:
        """The number of launch files that include each other here."""
        return len(self._locals)

    @property
    def locals(self) -> Any:
        return SimpleNamespace(**self.get_locals_as_dict())

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

    def _push_environment(self) -> None:
        self._environments.append(dict(self.environment))

    def _pop_environment(self) -> None:
        self.environment = self._environments.pop()

    def _reset_environment(self) -> None:
        self.environment = dict(os.environ)


def normalize_to_list_of_substitutions(subs: Any) -> list[Any]:
    if isinstance(subs, str | Path):
        return [TextSubstitution(text=subs)]
    if hasattr(subs, "perform"):
        return [subs]
    for it in (subs := [*subs]):
        if not isinstance(it, str | Path) and not hasattr(it, "perform"):
            only = "when only 'str' or 'launch.Substitution' were expected"
            raise TypeError(f"Failed to normalize given item of type '{type(it)}', {only}.")
    return [it if hasattr(it, "perform") else TextSubstitution(text=it) for it in subs]


def perform_substitutions(context: LaunchContext, subs: list[Any]) -> str:
    return "".join(context.perform_substitution(it) for it in subs)


def text_of(context: LaunchContext, value: Text) -> str:
    """Return the value of a text, a substitution, or several of both."""
    return perform_substitutions(context, normalize_to_list_of_substitutions(value))


def str_of(value: Any) -> Text:
    """Return any value as a text, or a list as several of them."""
    if isinstance(value, list | tuple):
        return [str_of(it) for it in value]
    return value if hasattr(value, "perform") else str(value)


def _substitution(
    perform: Callable[[Any, LaunchContext], str], *names: str, others: tuple[str, ...] = ()
) -> Any:
    """Return a class of substitutions with these arguments."""
    made = {"names": names, "others": others, "perform": perform}
    return type("Made", (Kept, Substitution), made)


def _configuration(it: Any, context: LaunchContext) -> str:
    name = text_of(context, it.variable_name)
    return _look_up(
        context, context.launch_configurations, name, it.default, "launch configuration"
    )


def _environment_variable(it: Any, context: LaunchContext) -> str:
    name = text_of(context, it.name)
    if name not in context.environment:
        os.environ.get(name)  # raises for one that is set and hidden
    return _look_up(context, context.environment, name, it.default_value, "environment variable")


def _look_up(
    context: LaunchContext, known: Mapping[str, str], name: str, usual: Text, what: str
) -> str:
    """Return the value of a name, or the usual one; raises SubstitutionFailure without either."""
    if name not in known and usual is None:
        raise SubstitutionFailure(f"{what} '{name}' does not exist")
    return known[name] if name in known else text_of(context, str_of(usual))


def _python_value(it: Any, context: LaunchContext) -> str:
    given = "math" if it.python_modules is None else it.python_modules
    names = [text_of(context, one) for one in ([given] if isinstance(given, str) else given)]
    modules = {name: importlib.import_module(name) for name in names}
    known = {**vars(modules["math"]), **modules} if "math" in modules else modules
    # The file is a program in Python, too.
    return str(eval(text_of(context, it.expression), {}, known))


def _loop_value(it: Any, context: LaunchContext) -> str:
    known = context.get_locals_as_dict()
    own = {key.removeprefix(ITERATED): known[key] for key in known if key.startswith(ITERATED)}
    return _look_up(context, own, text_of(context, it.name), it.default_value, "value of a loop")


def _word(value: bool) -> str:
    return str(value).lower()


def _compared(value: Any) -> Any:
    """Return a side of EqualsSubstitution as text; it may be any value."""
    texts = value if isinstance(value, list | tuple) else [value]
    if any(hasattr(it, "perform") for it in texts):
        return value
    return "" if value is None else _word(value) if isinstance(value, bool) else str(value)


def _equal(it: Any, context: LaunchContext) -> bool:
    left, right = (text_of(context, _compared(side)) for side in (it.left, it.right))
    if {left.lower(), right.lower()} <= _TRUTHS.keys():
        return _TRUTHS[left.lower()] == _TRUTHS[right.lower()]
    try:
        return math.isclose(float(left), float(right))
    except ValueError:
        return left == right


def _truths(it: Any, context: LaunchContext) -> list[bool]:
    """Return whether the left and the right side of a substitution are true."""
    return [_performed_truth(context, side) for side in (it.left, it.right)]


def _performed_truth(context: LaunchContext, value: Text) -> bool:
    try:
        return typed_truth(text_of(context, value))
    except ValueError as error:
        raise SubstitutionFailure(error) from None


def _if_else_value(it: Any, context: LaunchContext) -> str:
    chosen = it.if_value if _performed_truth(context, it.condition) else it.else_value
    return text_of(context, "" if chosen is None else chosen)


def _anonymous(it: Any, context: LaunchContext) -> str:
    """Return one name for the same text, where launch takes a random one."""
    name = text_of(context, it.name)
    return str(context.launch_configurations.setdefault(f"anon{name}", f"{name}_anonymous"))


class AllSubstitution(Substitution):
    """Whether all of them are true."""

    def __init__(self, *args: Text) -> None:
        self.args = args

    def truths(self, context: LaunchContext) -> list[bool]:
        return [_performed_truth(context, it) for it in self.args]

    def perform(self, context: LaunchContext) -> str:
        return _word(all(self.truths(context)))


class AnySubstitution(AllSubstitution):
    """Whether one of them is true."""

    def perform(self, context: LaunchContext) -> str:
        return _word(any(self.truths(context)))


TextSubstitution = _substitution(lambda it, context: str(it.text), "text")
LaunchConfiguration = _substitution(_configuration, "variable_name", "default")
EnvironmentVariable = _substitution(_environment_variable, "name", "default_value")
PythonExpression = _substitution(_python_value, "expression", "python_modules")
_SIDES = ("left", "right")
EqualsSubstitution = _substitution(lambda it, context: _word(_equal(it, context)), *_SIDES)
NotEqualsSubstitution = _substitution(lambda it, context: _word(not _equal(it, context)), *_SIDES)
AndSubstitution = _substitution(lambda it, context: _word(all(_truths(it, context))), *_SIDES)
OrSubstitution = _substitution(lambda it, context: _word(any(_truths(it, context))), *_SIDES)
NotSubstitution = _substitution(
    lambda it, context: _word(not _performed_truth(context, it.value)), "value"
)
IfElseSubstitution = _substitution(_if_else_value, "condition", "if_value", "else_value")
# launch/substitutions/for_loop_var.py (rolling).
ForEachVar = _substitution(_loop_value, "name", "default_value")
ForLoopIndex = _substitution(_loop_value, "name", "default_value")
AnonName = _substitution(_anonymous, "name")
LocalSubstitution = _substitution(
    # The file is a program in Python, too.
    lambda it, context: eval(f"context.locals.{it.expression}", {}, {"context": context}),
    *("expression", "description"),
)
# What they print is known to ``commands``.
Command = _substitution(Substitution.perform, "command", others=("on_stderr",))
FindExecutable = _substitution(Substitution.perform, "name")


class Condition:
    """Decides whether an action is executed; ``predicate`` is a function of the context."""

    def __init__(self, *, predicate: Callable[[LaunchContext], bool] | None = None) -> None:
        self.predicate = predicate

    def evaluate(self, context: LaunchContext) -> bool:
        return self.predicate is None or self.predicate(context)


class IfCondition(Kept, Condition):
    """A condition that is true for ``true`` and ``1``."""

    names = ("predicate_expression",)
    wanted = True

    def evaluate(self, context: LaunchContext) -> bool:
        return truth_of(context, self.predicate_expression) == self.wanted


class UnlessCondition(IfCondition):
    """The opposite."""

    wanted = False


class LaunchConfigurationEquals(Kept, Condition):
    """A condition that is true for one value of a launch configuration; None is one that is not set."""

    names = ("launch_configuration_name", "expected_value")

    def evaluate(self, context: LaunchContext) -> bool:
        name, value = self.launch_configuration_name, self.expected_value
        wanted = None if value is None else text_of(context, value)
        return bool(context.launch_configurations.get(name) == wanted)


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """The opposite."""

    def evaluate(self, context: LaunchContext) -> bool:
        return not super().evaluate(context)


def evaluate_condition_expression(context: LaunchContext, expression: Text) -> bool:
    return truth_of(context, expression)


def truth_of(context: LaunchContext, value: Text) -> bool:
    """Return the truth of a text; raises InvalidConditionExpressionError for one that is none."""
    word = text_of(context, value).strip().lower()
    if word not in _TRUTHS:
        raise InvalidConditionExpressionError(f"{word!r} is no condition; write true or false")
    return _TRUTHS[word]


@lru_cache(maxsize=64)
def typed_truth(text: str) -> bool:
    """Return the truth of a text as YAML has it, or 1 and 0; raises ValueError for one that is none."""
    found = load_yaml({"1": "true", "0": "false"}.get(text, text), A_VALUE) if text else text
    if not isinstance(found, bool):
        raise ValueError(f"Cannot convert value '{text}' to '{bool}'")
    return found
