"""Conditions on a node's parameters, as entries of nodes write them: ``publish_tf != false``.

A condition is a parameter (it is true), or ``PARAMETER = VALUE``, ``!= VALUE``, ``has VALUE`` (a list
that holds it); ``VALUE | VALUE`` are alternatives, ``and`` joins conditions. ``$other`` stands for the
value of another parameter. The class of a plugin may be written without its namespace.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from multibot_rewrite.lazy import lazy_compile
from multibot_rewrite.model import UsageError
from multibot_rewrite.record import NamedTuple

Values = Callable[[str], object]
_CONDITION = lazy_compile(r"(?P<parameter>[^\s=!]+)(?:\s*(?P<how>!=|=|\bhas\b)\s*(?P<value>.+?))?")
AND, OR = " and ", "|"


class Condition(NamedTuple):
    """One comparison; ``how`` is ``=``, ``!=`` or ``has``."""

    parameter: str
    how: str
    values: tuple[str, ...]


def parse_condition(text: str) -> tuple[Condition, ...]:
    """The comparisons that must all hold; raises UsageError for a text that is none."""
    return tuple(_one(it) for it in text.split(AND)) if text else ()


def _one(text: str) -> Condition:
    found = _CONDITION.fullmatch(text.strip())
    if found is None:
        raise UsageError(f"{text!r} is no condition; write PARAMETER = VALUE")
    values = tuple(it.strip() for it in (found["value"] or "true").split(OR))
    return Condition(found["parameter"], found["how"] or "=", values)


def holds(text: str, value_of: Values) -> bool:
    """Is it true of these parameters? ``value_of`` gives None for one that is not set."""
    return all(_is_true(it, value_of) for it in parse_condition(text))


def _is_true(it: Condition, value_of: Values) -> bool:
    given = value_of(it.parameter)
    wanted = {word for value in it.values for word in _wanted(value, value_of)}
    if it.how == "has":
        return isinstance(given, list) and any(wanted & _spellings(one) for one in given)
    return bool(wanted & _spellings(given)) == (it.how == "=")


def _wanted(value: str, value_of: Values) -> Iterator[str]:
    if not value.startswith("$"):
        yield value
        return
    other = value_of(value[1:])
    if other is not None:
        yield _word(other)


def _spellings(given: object) -> set[str]:
    """The words a value may be written with; none for a parameter that is not set."""
    if given is None:
        return set()
    word = _word(given)
    return {word, word.rpartition("::")[2], word.rpartition("/")[2]}


def _word(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
