# SPDX-License-Identifier: Apache-2.0
"""``NamedTuple`` as that of ``typing``, whose classes are made in a tenth of the time.

That one compiles every annotation, and ``namedtuple`` a function a class. A command makes three hundred
records at its start.
"""

from __future__ import annotations

import collections
from collections.abc import Iterable
from functools import cache
from types import CodeType, FunctionType
from typing import TYPE_CHECKING, Any

__all__ = ["NamedTuple"]

if TYPE_CHECKING:
    from typing import NamedTuple
else:

    class _Maker(type):
        """Makes a class of named fields from the body of a class; a type checker has looked at it."""

        def __new__(cls, name: str, _bases: tuple[type, ...], body: dict[str, Any]) -> type:
            fields = tuple(body.get("__annotations__", ()))
            defaults = {field: body.pop(field) for field in fields if field in body}
            new = FunctionType(_code(len(fields)).replace(co_varnames=("_cls", *fields)), _SPACE)
            new.__name__, new.__qualname__ = "__new__", f"{name}.__new__"
            new.__defaults__ = tuple(defaults.values())
            each = ((it, collections._tuplegetter(at, "")) for at, it in enumerate(fields))
            said = {"_fields": fields, "__match_args__": fields, "_field_defaults": defaults}
            about = {"__slots__": (), "__doc__": f"{name}({', '.join(fields)})", "__new__": new}
            return type(name, (tuple,), {**about, **said, **_METHODS, **dict(each), **body})

    @cache
    def _code(size: int) -> CodeType:
        """Of what makes a record of so many fields; a class puts its names of them into it."""
        names = "".join(f"_{at}, " for at in range(size))
        return eval(f"lambda _cls, {names}: _new(_cls, ({names}))").__code__

    def _make(cls: type, iterable: Iterable[Any]) -> Any:
        made = tuple.__new__(cls, iterable)
        if len(made) != len(cls._fields):
            raise TypeError(f"Expected {len(cls._fields)} arguments, got {len(made)}")
        return made

    def _replace(self: Any, /, **values: Any) -> Any:
        made = tuple.__new__(self.__class__, map(values.pop, self._fields, self))
        if values:
            raise TypeError(f"Got unexpected field names: {list(values)!r}")
        return made

    def _text(self: Any) -> str:
        shown = (f"{key}={value!r}" for key, value in zip(self._fields, self, strict=True))
        return f"{self.__class__.__name__}({', '.join(shown)})"

    def _asdict(self: Any) -> dict[str, Any]:
        return dict(zip(self._fields, self, strict=True))

    def _plain(self: Any) -> tuple[Any, ...]:
        return tuple(self)

    _SPACE = {"_new": tuple.__new__, "__builtins__": {}}
    _METHODS = {
        "_make": classmethod(_make),
        "_replace": _replace,
        "__replace__": _replace,
        "_asdict": _asdict,
        "__repr__": _text,
        "__getnewargs__": _plain,
    }
    NamedTuple = type.__new__(_Maker, "NamedTuple", (), {})
