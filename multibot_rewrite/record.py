"""``NamedTuple`` as that of ``typing``, whose classes are made in a tenth of the time.

That one compiles every annotation, and a constructor for every class. A command makes a hundred records
at its start, which would be a tenth of its work.
"""

from __future__ import annotations

from functools import lru_cache
from types import CodeType, FunctionType
from typing import TYPE_CHECKING, Any

__all__ = ["NamedTuple"]

if TYPE_CHECKING:
    from typing import NamedTuple
else:
    from collections import _tuplegetter  # what namedtuple() reads fields with, in C

    class _Record:
        """What all have; each gets it itself, since they are tuples and nothing else."""

        def _make(cls, values):
            made = tuple.__new__(cls, values)
            if len(made) != len(cls._fields):
                raise TypeError(f"Expected {len(cls._fields)} arguments, got {len(made)}")
            return made

        def _replace(self, /, **values):
            made = self._make(map(values.pop, self._fields, self))
            if values:
                raise ValueError(f"Got unexpected field names: {list(values)!r}")
            return made

        def _asdict(self):
            return dict(zip(self._fields, self, strict=True))

        def __repr__(self):
            values = map("{}={!r}".format, self._fields, self)
            return f"{type(self).__name__}({', '.join(values)})"

        def __getnewargs__(self):
            return tuple(self)

    _ALL_HAVE = {
        "__slots__": (),
        "_make": classmethod(_Record._make),
        "_replace": _Record._replace,
        "__replace__": _Record._replace,  # copy.replace()
        "_asdict": _Record._asdict,
        "__repr__": _Record.__repr__,
        "__getnewargs__": _Record.__getnewargs__,
    }
    _NAMES = {"_new": tuple.__new__, "__builtins__": {}}

    class _Maker(type):
        """Makes a class of named fields from the body of a class; a type checker has looked at it."""

        def __new__(cls, name: str, _bases: tuple[type, ...], body: dict[str, Any]) -> type:
            fields = tuple(body.get("__annotations__", ()))
            defaults = {field: body.pop(field) for field in fields if field in body}
            code = _constructor(len(fields)).replace(co_varnames=("_cls", *fields))
            new = FunctionType(code, _NAMES, "__new__", tuple(defaults.values()))
            new.__qualname__ = f"{body['__qualname__']}.__new__"
            made = {field: _tuplegetter(at, None) for at, field in enumerate(fields)}
            made |= {"__doc__": f"{name}({', '.join(fields)})", "__new__": new}
            made |= {"_fields": fields, "__match_args__": fields, "_field_defaults": defaults}
            return type(name, (tuple,), _ALL_HAVE | made | body)

    @lru_cache(maxsize=64)
    def _constructor(count: int) -> CodeType:
        """The code of one with that many fields: how they are called does not change what it does."""
        words = "".join(f"_{at}, " for at in range(count))
        return eval(f"lambda _cls, {words}: _new(_cls, ({words}))").__code__

    NamedTuple = type.__new__(_Maker, "NamedTuple", (), {})
