# SPDX-License-Identifier: Apache-2.0
"""The known name that was probably meant where an unknown one is given: "did you mean"."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cache, lru_cache
from itertools import islice

from multibot_rewrite.base.bounded import load_own_yaml

# How much alike two words have to be, from 0 to 1 (difflib's ratio): one of a short list that a
# person can choose from, a name of a file, and a name where the finding itself rests on it.
CHOICE, ALIKE, MISTYPED = 0.6, 0.7, 0.8
# The same where many known names differ by a word.
SLIP = 0.85
# Looking costs: so many names of one report, each among so many.
HINTED, COMPARED = 20, 2000
# A shorter word begins too many others.
_BEGINNING = 3


def nearest(name: str, known: Iterable[str], alike: float = ALIKE) -> str:
    """Return the known name most like ``name``; one with other case or dashes comes first. Or ""."""
    return _cached_nearest(name, tuple(known), alike)


@lru_cache(maxsize=256)  # a mistake comes again, in one file and in others
def _cached_nearest(name: str, known: tuple[str, ...], alike: float) -> str:
    found = nearest_few(name, known, 1, alike)
    return found[0] if found else ""


def slip_of(name: str, known: Iterable[str]) -> str:
    """Return the known name that is ``name`` except for camel case or a letter or two; or ""."""
    names = list(known)
    letters = _letters(name)
    same = next((it for it in names if _letters(it) == letters), "")
    return same or nearest(name, names, SLIP)


_DIGITS = str.maketrans("", "", "0123456789")


def differ_in_numbers(name: str, other: str) -> bool:
    """Return whether two names differ in digits alone. Then they are two things: robot1, robot2."""
    return name.translate(_DIGITS) == other.translate(_DIGITS)


def _letters(name: str) -> str:
    """Return a name in lower case without dashes and underscores."""
    return name.replace("_", "").replace("-", "").casefold()


class Guesses:
    """The nearest known names for the unknown ones of one report, for the first of them alone."""

    def __init__(self) -> None:
        self._made: dict[str, str] = {}

    def nearest(self, name: str, known: Iterable[str], alike: float = ALIKE) -> str:
        """Return the ``nearest`` name, or "" once it was asked for ``HINTED`` other names."""
        if name not in self._made and len(self._made) < HINTED:
            self._made[name] = nearest(name, islice(known, COMPARED), alike)
        return self._made.get(name, "")

    def hint(self, name: str, known: Iterable[str], alike: float = ALIKE) -> str:
        """Return the text of ``did_you_mean``, with the same limit."""
        return _hint(self.nearest(name, known, alike))


def nearest_few(name: str, known: Iterable[str], most: int, alike: float = ALIKE) -> list[str]:
    """Return up to ``most`` known names that are like ``name``, the most similar first."""
    from difflib import get_close_matches  # only a message needs it

    names = list(dict.fromkeys(known))
    folded = fold(name)
    same = next((it for it in names if fold(it) == folded), None)
    if same is not None and most == 1:
        return [same]
    near = get_close_matches(name, names, most, alike)
    first = [same] if same is not None else []
    return list(dict.fromkeys([*first, *near]))[:most]


def fold(name: str) -> str:
    """Return a name without what is often written differently: case, scope, slash, dashes, spaces."""
    bare = name.rpartition("::")[2].strip().strip("/").casefold()
    return bare.replace("-", "_").replace(" ", "_")


def did_you_mean(name: str, known: Iterable[str], alike: float = ALIKE) -> str:
    """Return the hint ``did you mean 'x'?``; "" if no known name is like ``name``."""
    return _hint(nearest(name, known, alike))


def did_you_mean_one_of(word: str, choices: Iterable[str], alike: float = CHOICE) -> str:
    """Return the hint which of a few choices was meant: it may be less alike, or only begin so.

    Where the word is the first part of several (shared: shared_frames, shared_topics), it has all.
    """
    words = list(choices)
    whole = extensions(word, words)
    if len(whole) > 1:
        return f"did you mean one of {', '.join(whole)}?"
    begun = (it for it in words if len(word) >= _BEGINNING and it.startswith(word))
    return _hint(min(begun, key=len, default="") or nearest(word, words, alike))


def unknown(what: str, name: str, known: Iterable[str], more: Iterable[str] = ()) -> str:
    """Return the message that ``name`` is unknown, with the nearest and the list of ``known``."""
    known = sorted(known)
    near = did_you_mean_one_of(name, [*known, *more])
    return f"{what} {name!r} is not known; {near}{near and ' '}known: {', '.join(known) or 'none'}"


def extensions(word: str, choices: Iterable[str]) -> list[str]:
    """Return the choices that are the word with more parts behind it."""
    return [it for it in choices if word and it.startswith((f"{word}_", f"{word}-"))]


def _hint(near: str) -> str:
    """Return ``did you mean 'x'?`` for this name; empty without one."""
    return f"did you mean {near!r}?" if near else ""


def meant_name(name: str, known: Iterable[str]) -> str:
    """Return the known name that differs from ``name`` by one typing mistake in one word, or ""."""
    words = _name_parts(name)
    for it, _ in zip(known, range(COMPARED), strict=False):
        others = _name_parts(it)
        if len(words) == len(others) and (words == others or _one_typo(words, others)):
            return it
    return ""


@lru_cache(maxsize=4096)  # each unknown name is compared with the same known ones
def _name_parts(name: str) -> tuple[str, ...]:
    return tuple(fold(name).split("_"))


def _one_typo(words: Sequence[str], others: Sequence[str]) -> bool:
    """Return whether two names differ in one long word without digits, by one letter or two swapped."""
    pairs = [pair for pair in zip(words, others, strict=True) if pair[0] != pair[1]]
    if len(pairs) != 1:
        return False
    one, two = pairs[0]
    are_long = one.isalpha() and two.isalpha() and max(len(one), len(two)) >= 4
    return are_long and typing_mistakes(one, two, most=2) == 1


def typing_mistakes(one: str, other: str, most: int = 3) -> int:
    """Return how many letters are wrong, missing, too many or swapped with the next, up to ``most``."""
    before = last = list(range(len(other) + 1))
    if abs(len(one) - len(other)) >= most:
        return most
    for at, letter in enumerate(one, 1):
        row = [at]
        for to, wanted in enumerate(other, 1):
            swapped = at > 1 < to and one[at - 2 : at] == other[to - 2 : to][::-1]
            found = [last[to], row[-1], last[to - 1] - (letter == wanted)]
            row.append(1 + min(found + [before[to - 2]] * swapped))
        before, last = last, row
    return min(last[-1], most)


@cache
def other_words(what: str) -> Mapping[str, str]:
    """Return the table of ``commands``, ``options`` or ``keys``: a word of other tools, and ours."""
    words: Mapping[str, str] = load_own_yaml(__file__, "other_words.yaml")[what]
    return words
