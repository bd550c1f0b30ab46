# SPDX-License-Identifier: Apache-2.0
"""The arguments of the public calls: a wrong name or type becomes one line, before anything runs.

An argument is checked by its annotation: a new option needs no line here unless its type is new.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Mapping
from functools import wraps
from inspect import Parameter, Signature, signature
from typing import Any, ParamSpec, TypeVar

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.nearest import did_you_mean_one_of

P = ParamSpec("P")
R = TypeVar("R")
Reader = Callable[[str, Any], Any]


def checked(call: Callable[P, R]) -> Callable[P, R]:
    """Return ``call`` with its arguments checked first; names in any iterable reach it as a tuple.

    The result raises UsageError for a wrong argument: it names the call, the argument and what to
    write. An annotation that is not in ``READERS`` is a KeyError where ``checked`` is used."""
    takes, title = signature(call), f"{call.__qualname__}()"
    readers: dict[str, Reader] = {}
    for it in takes.parameters.values():
        if it.name == "self":
            readers[it.name] = lambda _, value: value
        else:
            read = READERS[it.annotation]
            several = it.kind is Parameter.VAR_POSITIONAL
            readers[it.name] = _reader_of_list(read) if several else read
    named = [it for it in takes.parameters.values() if it.kind is not Parameter.VAR_POSITIONAL]
    names = {it.name for it in named}
    needed = {it.name for it in named if it.default is Parameter.empty}
    in_order = [it.name for it in named if it.kind is not Parameter.KEYWORD_ONLY]

    by_name: Callable[..., R] = call

    @wraps(call)
    def run(*args: P.args, **kwargs: P.kwargs) -> R:
        values: dict[str, Any] = dict(zip(in_order, args, strict=False)) | kwargs
        # inspect takes longer to bind arguments than all readers do: most calls do not need it.
        if len(values) == len(args) + len(kwargs) and needed <= values.keys() <= names:
            read = {name: readers[name](f"{title}: {name}", it) for name, it in values.items()}
            return by_name(**read)
        given = _bound(takes, title, args, kwargs)
        for name, value in given.arguments.items():
            given.arguments[name] = readers[name](f"{title}: {name}", value)
        return call(*given.args, **given.kwargs)

    return run


def _bound(takes: Signature, title: str, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
    """Return the arguments bound to their names; raises UsageError where they do not fit."""
    known = [name for name in takes.parameters if name != "self"]
    for name in kwargs:
        if name not in known:
            hint = did_you_mean_one_of(name, known) or f"it takes {', '.join(known)}"
            raise UsageError(f"{title} has no argument {name!r}; {hint}")
    try:
        return takes.bind(*args, **kwargs)
    except TypeError as error:
        raise UsageError(f"{title}: {error}; it takes {', '.join(known)}") from None


def _reader_of_list(read: Reader) -> Reader:
    return lambda what, values: tuple(read(f"{what}[{at}]", it) for at, it in enumerate(values))


def _reader_or_none(read: Reader) -> Reader:
    return lambda what, value: None if value is None else read(what, value)


def _type_error(what: str, value: object, write: str) -> UsageError:
    type_ = type(value).__name__
    article = "an" if type_[:1] in "aeiouAEIOU" else "a"
    return UsageError(f"{what} is {value if value is None else f'{article} {type_}'}; {write}")


def _text(what: str, value: object) -> object:
    """Return the value; raises UsageError unless it is a str."""
    if isinstance(value, str):
        return value
    plain = isinstance(value, bool | int | float)
    raise _type_error(what, value, f"write {str(value).lower()!r}" if plain else "write a str")


def _names(what: str, value: object) -> object:
    """Return a tuple of texts; raises UsageError for one text, or what is no list of texts."""
    if isinstance(value, str):
        words = value.replace(",", " ").split()
        raise _type_error(what, value, f"write {words or [value]!r}")
    if not isinstance(value, Iterable) or isinstance(value, bytes | bytearray):
        raise _type_error(what, value, "write a list of str")
    return tuple(_text(f"{what}[{at}]", it) for at, it in enumerate(value))


def _records(what: str, value: object) -> object:
    """Return a tuple of the values; raises UsageError unless the value is a list."""
    if isinstance(value, Iterable) and not isinstance(value, str | bytes | bytearray | Mapping):
        return tuple(value)
    raise _type_error(what, value, "write a list")


def _texts_by_name(what: str, value: object) -> object:
    """Return a dict of texts by text; raises UsageError for any other value."""
    if not isinstance(value, Mapping):
        raise _type_error(what, value, "write a dict of str")
    for key in value:
        _text(f"a key of {what}", key)
    return {key: _text(f"{what}[{key!r}]", it) for key, it in value.items()}


def _bool(what: str, value: object) -> object:
    """Return the value; raises UsageError unless it is a bool."""
    if isinstance(value, bool):
        return value
    raise _type_error(what, value, "write True or False")


def _int(what: str, value: object) -> object:
    """Return the value; raises UsageError unless it is an int."""
    if isinstance(value, int) and not isinstance(value, bool):
        return value
    raise _type_error(what, value, "write an int")


def _path(what: str, value: object) -> object:
    """Return the value; raises UsageError unless it is a path, but not one of bytes."""
    # A path of bytes would fail where it is put into a message.
    if isinstance(value, str | os.PathLike) and isinstance(os.fspath(value), str):
        return value
    raise _type_error(what, value, "write a path")


def _path_or(other: type, write: str) -> Reader:
    """Return a reader of a path or a value of the type ``other``."""

    def read(what: str, value: object) -> object:
        if isinstance(value, other):
            return value
        try:
            return _path(what, value)
        except UsageError:
            raise _type_error(what, value, write) from None

    return read


def _source(what: str, value: object) -> object:
    """Return a path, text or bytes: of an open file its path or text, of a parsed element its text."""
    root = value.getroot() if hasattr(value, "getroot") else value
    if hasattr(value, "read"):
        name = getattr(value, "name", "")
        value = name if isinstance(name, str) and os.path.isfile(name) else value.read()
    elif hasattr(root, "iterfind"):  # of lxml and of Python, each with a function of this name
        value = sys.modules[type(root).__module__].tostring(root)
    # Empty text is no path; empty bytes are an empty file.
    if value == "":
        raise UsageError(f"{what} is empty; {_WRITE_SOURCE}")
    return _SOURCE(what, value)


_WRITE_SOURCE = "write a path, XML text or bytes"
_SOURCE = _path_or(bytes, _WRITE_SOURCE)
READERS: Mapping[str, Reader] = {
    "str | os.PathLike[str] | Mapping[str, Any]": _path_or(Mapping, "write a path, or a dict"),
    "str": _text,
    "str | None": _reader_or_none(_text),
    "bool": _bool,
    "int": _int,
    "Iterable[str]": _names,
    "Iterable[Part]": _records,
    "Mapping[str, str] | None": _reader_or_none(_texts_by_name),
    "str | os.PathLike[str]": _path,
    "Source": _source,
    "Source | None": _reader_or_none(_source),
}
