# SPDX-License-Identifier: Apache-2.0
"""What is read from sources: classes, what they call; which calls declare ends, by ``calls.txt``.

A text that is only known at run time has its unknown parts in <>: ``<layer>_raw``. A part that is the
value of a parameter starts with @: ``<@odom_topic>``, ``<@{plugin}.topic>``; a node that is made has a
colon: ``<Node:name>``.
"""

from collections.abc import Mapping
from functools import cache
from typing import NamedTuple

from multibot_rewrite.base.bounded import own_text
from multibot_rewrite.base.grouping import lists_by_key

# A text of which nothing is known, and a condition that is not.
ANY, OTHERWISE = "<?>", "?"
ARGUMENT = "ARGUMENT"
HELPER, OWN = "helper", "own"


def braced(text: str) -> str:
    """Return a text with <> as {}, to be part of another name in <>."""
    return text.replace("<", "{").replace(">", "}")


def negated(condition: str) -> str:
    """Return the opposite of a condition, as ``Call`` has it."""
    if condition == OTHERWISE:
        return OTHERWISE
    return condition[1:] if condition[:1] == "!" else f"!{condition}"


def parameter_in(text: str) -> str:
    """Return the parameter of which a text is the value alone; empty for another text."""
    is_one = text.startswith("<@") and text.endswith(">") and text.count("<") == 1
    return text[2:-1] if is_one else ""


class Place(NamedTuple):
    """Where something was read: a repository, its tag or commit, a path in it, a line, a package."""

    repository: str
    version: str
    path: str
    line: int = 0
    package: str = ""


class Call(NamedTuple):
    """A call, or an object that is made.

    ``owner`` is the class that does it, empty in a free function; ``on`` the object that is asked,
    empty for none or ``this``. ``types`` are its template arguments, ``given`` its arguments.
    ``condition`` is the text of the ``if`` around it. ``asked`` are all conditions before it, joined
    by ``&``, as texts: ``<@debug>``, ``!<@debug>``, ``?`` for another one. ``named`` are arguments with
    a name.
    """

    owner: str
    function: str
    name: str
    types: tuple[str, ...]
    given: tuple[str, ...]
    on: str
    condition: str
    place: Place
    asked: str = ""
    named: tuple[tuple[str, str], ...] = ()


class Class(NamedTuple):
    """A class: its bases as written, template parameters, types of its members."""

    name: str
    bases: tuple[str, ...]
    parameters: tuple[str, ...]
    members: Mapping[str, str]
    place: Place


class Value(NamedTuple):
    """What a variable of a class is set to; ``variable`` starts with @ for a parameter's default."""

    owner: str
    function: str
    variable: str
    text: str
    place: Place


class Alias(NamedTuple):
    """Another name of a type."""

    owner: str
    name: str
    type: str


class Constructor(NamedTuple):
    """The names of what a constructor, method or function is given, and their defaults."""

    owner: str
    function: str
    names: tuple[str, ...]
    defaults: tuple[tuple[str, str], ...] = ()
    path: str = ""


class Plugin(NamedTuple):
    """A class that is loaded by name, and what it is loaded as."""

    name: str
    base: str


class Source(NamedTuple):
    """What one file says, or all files together."""

    classes: tuple[Class, ...] = ()
    calls: tuple[Call, ...] = ()
    values: tuple[Value, ...] = ()
    aliases: tuple[Alias, ...] = ()
    constructors: tuple[Constructor, ...] = ()
    plugins: tuple[Plugin, ...] = ()
    imports: tuple[str, ...] = ()
    faults: tuple[tuple[Place, str], ...] = ()


def joined(sources: list[Source]) -> Source:
    """Return several sources as one."""
    columns = zip(*sources, strict=True)
    return Source(*(tuple(item for part in column for item in part) for column in columns))


class Api(NamedTuple):
    """A call that declares an endpoint; see the head of ``calls.txt``."""

    function: str
    role: str
    name: str
    type: str
    node: str = ""


@cache
def apis() -> Mapping[str, tuple[Api, ...]]:
    """Return the calls that declare endpoints, by function."""
    lines = own_text(__file__, "calls.txt").splitlines()
    every = (Api(*line.split()) for line in lines if line and not line.startswith("#"))
    found = lists_by_key((it.function, it) for it in every)
    return {name: tuple(rows) for name, rows in found.items()}


@cache
def harmless() -> frozenset[str]:
    """Return the functions that use nothing of a node that others see."""
    return frozenset(own_text(__file__, "harmless.txt").partition("\n")[2].split())
