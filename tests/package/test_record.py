"""A record is what ``typing.NamedTuple`` would have made of the same class."""

from __future__ import annotations

import inspect
import pickle
import typing

import pytest

from multibot_rewrite import record

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
    with pytest.raises(AttributeError):
        Ours(1.0).x = 2.0


def test_a_record_goes_to_another_process() -> None:
    assert pickle.loads(pickle.dumps(Ours(1.0, "a"))) == Ours(1.0, "a")
    assert type(pickle.loads(pickle.dumps(Ours(1.0)))) is Ours
