# SPDX-License-Identifier: Apache-2.0
"""A record is what ``typing.NamedTuple`` would have made of the same class."""

from __future__ import annotations

import inspect
import pickle
import typing

import pytest
from parsed import PACKAGE

from multibot_rewrite.base import record

BODY = """
from __future__ import annotations

class Outer:
    class Point(NamedTuple):
        '''A place.'''

        x: float
        name: str | None = None
        tags: tuple[str, ...] = ()

        @property
        def twice(self) -> float:
            return 2 * self.x

        @classmethod
        def origin(cls) -> Point:
            return cls(0.0)

        def moved(self, by: float) -> Point:
            return self._replace(x=self.x + by)
"""


def made_with(base: object) -> typing.Any:
    names: dict[str, typing.Any] = {"NamedTuple": base, "__name__": __name__}
    exec(BODY, names)  # the same class from both
    return names["Outer"].Point


Ours = made_with(record.NamedTuple)
Outer = type("Outer", (), {"Point": Ours})
Typings = made_with(typing.NamedTuple)


@pytest.mark.parametrize(
    "look",
    [
        lambda it: (it._fields, it._field_defaults, it.__bases__, it.__match_args__),
        lambda it: (it.__doc__, it.__name__, it.__qualname__, it.__module__),
        lambda it: (list(it.__annotations__), list(inspect.signature(it).parameters)),
        typing.get_type_hints,
        lambda it: (it(1.0), it(1.0, "a", ("b",)), it(x=2.0, tags=("c",)), repr(it(1.0))),
        lambda it: (it(1.0).twice, it.origin(), it(1.0).moved(2.0), it(1.0)._asdict()),
        lambda it: (it(1.0).name, hash(it(1.0)), it(1.0) == (1.0, None, ()), it._make((1, 2, 3))),
        lambda it: hasattr(it(1.0), "__dict__"),
    ],
)
def test_a_record_is_like_that_of_typing(look: typing.Callable[[typing.Any], object]) -> None:
    assert look(Ours) == look(Typings)


def test_what_is_missing_or_too_much_is_refused() -> None:
    for wrong in ((), (1.0, "a", (), 4)):
        with pytest.raises(TypeError):
            Ours(*wrong)
    with pytest.raises(TypeError, match=r"Point.__new__\(\) missing 1 required .*'x'"):
        Ours(name="a")
    with pytest.raises(TypeError, match="Expected 3 arguments, got 2"):
        Ours._make((1.0, "a"))
    # A ValueError up to Python 3.12.
    with pytest.raises((TypeError, ValueError), match=r"unexpected field names: \['y'\]"):
        Ours(1.0)._replace(y=2.0)
    with pytest.raises(AttributeError):
        Ours(1.0).x = 2.0


def test_each_record_has_its_own_fields() -> None:
    names: dict[str, typing.Any] = {"NamedTuple": record.NamedTuple, "__name__": __name__}
    exec(
        "class A(NamedTuple):\n a: int\n b: int = 1\nclass B(NamedTuple):\n b: int\n a: int", names
    )
    a, b = names["A"](1), names["B"](a=1, b=2)
    assert (a, a.a, a.b, b, b.a, b.b) == ((1, 1), 1, 1, (2, 1), 1, 2)
    assert (repr(a), repr(b)) == ("A(a=1, b=1)", "B(b=2, a=1)")


def test_a_record_goes_to_another_process() -> None:
    assert pickle.loads(pickle.dumps(Ours(1.0, "a"))) == Ours(1.0, "a")
    assert type(pickle.loads(pickle.dumps(Ours(1.0)))) is Ours


def test_every_module_with_records_postpones_its_annotations() -> None:
    """Else a class body has no ``__annotations__`` from Python 3.14 on (PEP 749): no field."""
    later = "from __future__ import annotations"
    files = [it for it in PACKAGE.rglob("*.py") if "(NamedTuple)" in it.read_text()]
    assert files
    assert [it.name for it in files if later not in it.read_text()] == []
