# SPDX-License-Identifier: Apache-2.0
"""A matcher of regular expressions that backtracks as Python's does and counts its steps.

A pattern becomes a program: read a character, go two ways, note a place, look ahead or behind. A step
is one instruction, so that a count is the same on every machine.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import Any, NamedTuple, TypeAlias

try:  # from Python 3.11 on
    from re import _parser as sre_parse
except ImportError:
    import sre_parse  # type: ignore[no-redef]

READ, SPLIT, JUMP, MARK, MOVED, AT, LOOK, ONCE, SAME, MATCH = range(10)
# What is repeated more often than this counts as repeated without end, or as often as this.
COUNTED = 6
Test = Callable[[str], bool]


class TooManyStepsError(Exception):
    """A match that was given up."""


class Program(NamedTuple):
    """The instructions of a pattern: what each does, and with what."""

    code: list[tuple[int, Any, Any]]
    places: int


def program_of(pattern: str | bytes, flags: int = 0) -> Program:
    """Return the program of a pattern."""
    tree = sre_parse.parse(pattern, flags)  # type: ignore[arg-type]
    maker = _Maker(tree.state.flags, isinstance(pattern, bytes))
    maker.sequence(tree)
    maker.put(MATCH)
    return Program(maker.code, maker.places)


class _Maker:
    def __init__(self, flags: int, of_bytes: bool) -> None:
        self.code: list[tuple[int, Any, Any]] = []
        self.flags = flags
        self.ascii = of_bytes or bool(flags & re.ASCII)
        # Two for each group, and one for each loop that may stand still.
        self.places = 200

    def put(self, what: int, first: Any = None, second: Any = None) -> int:
        self.code.append((what, first, second))
        return len(self.code) - 1

    def sequence(self, nodes: Any) -> None:
        for op, value in nodes:
            getattr(self, "of_" + op.name.lower())(value)

    def read(self, test: Test) -> None:
        self.put(READ, test, {})

    def of_literal(self, value: int) -> None:
        self.read(self._folded(lambda it, value=value: ord(it) == value))

    def of_not_literal(self, value: int) -> None:
        test = self._folded(lambda it, value=value: ord(it) == value)
        self.read(lambda it: not test(it))

    def of_any(self, _: None) -> None:
        every = self.flags & re.DOTALL
        self.read(lambda it: bool(every) or it != "\n")

    def of_in(self, items: Sequence[tuple[Any, Any]]) -> None:
        negated = items[0][0].name == "NEGATE"
        tests = [self._item(*it) for it in items[negated:]]
        test = self._folded(lambda it: any(one(it) for one in tests))
        self.read(lambda it: test(it) != negated)

    def _folded(self, test: Test) -> Test:
        if not self.flags & re.IGNORECASE:
            return test
        return lambda it: test(it.lower()) or test(it.upper())

    def _item(self, op: Any, value: Any) -> Test:
        if op.name == "LITERAL":
            return lambda it: ord(it) == value
        if op.name == "RANGE":
            return lambda it: value[0] <= ord(it) <= value[1]
        return self._category(value.name)

    def _category(self, name: str) -> Test:
        letter = {"DIGIT": "d", "SPACE": "s", "WORD": "w"}[name.rpartition("_")[2]]
        letter = letter.upper() if "_NOT_" in name else letter
        found = re.compile("\\" + letter, re.ASCII if self.ascii else 0)
        return lambda it: found.match(it) is not None

    def of_branch(self, value: tuple[None, Sequence[Any]]) -> None:
        *before, last = value[1]
        ends = []
        for branch in before:
            split = self.put(SPLIT)
            self.sequence(branch)
            ends.append(self.put(JUMP))
            self.code[split] = SPLIT, split + 1, len(self.code)
        self.sequence(last)
        for it in ends:
            self.code[it] = JUMP, len(self.code), None

    def of_subpattern(self, value: tuple[int | None, int, int, Any]) -> None:
        group, more, less, body = value
        if group is not None:
            self.put(MARK, 2 * group)
        before, self.flags = self.flags, (self.flags | more) & ~less
        self.sequence(body)
        self.flags = before
        if group is not None:
            self.put(MARK, 2 * group + 1)

    def of_max_repeat(self, value: tuple[int, int, Any]) -> None:
        self._repeat(*value, greedy=True)

    def of_min_repeat(self, value: tuple[int, int, Any]) -> None:
        self._repeat(*value, greedy=False)

    def _repeat(self, least: int, most: int, body: Any, greedy: bool) -> None:
        for _ in range(min(least, COUNTED)):
            self.sequence(body)
        if most > max(COUNTED, least):
            self._endless(body, greedy)
            return
        splits = []
        for _ in range(min(most, COUNTED) - min(least, COUNTED)):
            splits.append(self.put(SPLIT))
            self.sequence(body)
        for it in splits:
            self._ways(it, greedy)

    def _endless(self, body: Any, greedy: bool) -> None:
        place, self.places = self.places, self.places + 1
        split = self.put(SPLIT)
        still = body.getwidth()[0] == 0
        if still:
            self.put(MARK, place)
        self.sequence(body)
        if still:
            self.put(MOVED, place)
        self.put(JUMP, split)
        self._ways(split, greedy)

    def _ways(self, split: int, greedy: bool) -> None:
        on, out = split + 1, len(self.code)
        self.code[split] = (SPLIT, on, out) if greedy else (SPLIT, out, on)

    def of_at(self, value: Any) -> None:
        self.put(AT, (value.name, bool(self.flags & re.MULTILINE), self._category("CATEGORY_WORD")))

    def of_assert(self, value: tuple[int, Any]) -> None:
        self._look(*value, wanted=True)

    def of_assert_not(self, value: tuple[int, Any]) -> None:
        self._look(*value, wanted=False)

    def _look(self, direction: int, body: Any, wanted: bool) -> None:
        inner = _Maker(self.flags, self.ascii)
        inner.sequence(body)
        inner.put(MATCH)
        back = body.getwidth()[0] if direction < 0 else 0
        self.put(LOOK, (Program(inner.code, inner.places), back), wanted)

    def of_atomic_group(self, body: Any) -> None:
        inner = _Maker(self.flags, self.ascii)
        inner.sequence(body)
        inner.put(MATCH)
        self.put(ONCE, (Program(inner.code, inner.places), 0), True)

    def of_possessive_repeat(self, value: tuple[int, int, Any]) -> None:
        inner = _Maker(self.flags, self.ascii)
        inner.of_max_repeat(value)
        inner.put(MATCH)
        self.put(ONCE, (Program(inner.code, inner.places), 0), True)

    def of_groupref(self, group: int) -> None:
        self.put(SAME, group)

    def of_failure(self, _: object) -> None:
        self.read(lambda _: False)


# The next instruction, the next character, and the places that are noted.
_Here: TypeAlias = "tuple[int, int, dict[int, int]]"
NOWHERE = -1, -1


class Matcher:
    """Matches texts and counts the steps of all together; raises TooManyStepsError over ``limit``."""

    def __init__(self, program: Program, limit: int) -> None:
        self.program, self.steps, self.limit = program, 0, limit

    def every(self, text: str) -> Iterator[tuple[int, int]]:
        """Yield the matches, as ``finditer`` finds them."""
        at = 0
        while at <= len(text):
            end = self.match(text, at)
            if end is None or end == at:
                if end is not None:
                    yield at, end
                at += 1
                continue
            yield at, end
            at = end

    def match(self, text: str, at: int = 0, whole: bool = False) -> int | None:
        """Return the end of a match that begins here; None without one."""
        found = self._run(self.program, text, (0, at, {}), whole)
        return found[1] if found else None

    def _run(self, program: Program, text: str, here: _Here, whole: bool = False) -> _Here | None:
        """Return the end of the first way through the program; what is left to try is a stack."""
        left, code, size = [here], program.code, len(text)
        while left:
            line, at, places = left.pop()
            while line >= 0:
                self.steps += 1
                if self.steps > self.limit:
                    raise TooManyStepsError
                what, first, second = code[line]
                if what == READ:
                    fits = at < size and _holds(first, second, text[at])
                    line, at = (line + 1, at + 1) if fits else NOWHERE
                elif what == SPLIT:
                    left.append((second, at, places))
                    line = first
                elif what != MATCH:
                    line, at, places = self._after(what, first, second, text, (line, at, places))
                elif not whole or at == size:
                    return line, at, places
                else:
                    line = -1
        return None

    def _after(self, what: int, first: Any, second: Any, text: str, here: _Here) -> _Here:
        """Behind an instruction that notes or asks; nowhere where it does not fit."""
        line, at, places = here
        if what == JUMP:
            return first, at, places
        if what == MARK:
            return line + 1, at, {**places, first: at}
        end: int | None = at
        if what == MOVED:
            end = None if places[first] == at else at
        elif what == AT:
            end = at if _is_at(first, text, at) else None
        elif what == SAME:
            end = self._same(first, text, here)
        else:
            inner, back = first
            found = self._run(inner, text, (0, at - back, places)) if at >= back else None
            end = at if what == LOOK else found and found[1]
            if (found is not None) != second:
                end = None
            elif found is not None:
                places = found[2]
        return (*NOWHERE, places) if end is None else (line + 1, end, places)

    def _same(self, group: int, text: str, here: _Here) -> int | None:
        """Behind a text that is as a group's; each character of it is compared."""
        _, at, places = here
        start, end = (places.get(2 * group + it) for it in (0, 1))
        if start is None or end is None or not text.startswith(text[start:end], at):
            return None
        self.steps += end - start
        return at + end - start


def _holds(test: Test, known: dict[str, bool], character: str) -> bool:
    if character not in known:
        known[character] = test(character)
    return known[character]


def _is_at(what: tuple[str, bool, Test], text: str, at: int) -> bool:
    name, lines, is_word = what
    if name == "AT_BEGINNING_STRING" or (name == "AT_BEGINNING" and not lines):
        return at == 0
    if name == "AT_BEGINNING":
        return at == 0 or text[at - 1] == "\n"
    if name == "AT_END_STRING":
        return at == len(text)
    if name == "AT_END":
        return at == len(text) or (text[at] == "\n" and (lines or at == len(text) - 1))
    before, after = at > 0 and is_word(text[at - 1]), at < len(text) and is_word(text[at])
    return (before != after) == (name == "AT_BOUNDARY")


class _Examples:
    """Short texts that a pattern takes, and what it repeats."""

    def __init__(self, flags: int) -> None:
        self.flags = flags
        self.groups: dict[int, str] = {}
        self.characters: dict[str, None] = {}

    def texts(self, nodes: Any) -> list[str]:
        """Return some texts for a sequence: each alternative of each node with the first of all
        others."""
        each = [self.node(op.name, value) for op, value in nodes]
        first = "".join(it[0] for it in each)
        made = {first: None}
        for at, others in enumerate(each):
            before = "".join(it[0] for it in each[:at])
            after = "".join(it[0] for it in each[at + 1 :])
            made.update(dict.fromkeys(before + it + after for it in others[1:]))
        return list(made)[:12]

    def node(self, op: str, value: Any) -> list[str]:
        made = getattr(self, f"of_{op.lower()}", None)
        return made(value) if made else [""]

    def of_literal(self, value: int) -> list[str]:
        self.characters[chr(value)] = None
        return [chr(value)]

    def of_in(self, value: Any) -> list[str]:
        literals = [chr(it) for kind, it in value if kind.name == "LITERAL"]
        ranges = [chr(it[0]) for kind, it in value if kind.name == "RANGE"]
        self.characters.update(dict.fromkeys([*literals[:6], *ranges[:3]]))
        return self.some_of("in", value)

    def of_any(self, value: None) -> list[str]:
        return self.some_of("any", value)

    def of_not_literal(self, value: int) -> list[str]:
        return self.some_of("not_literal", value)

    def of_branch(self, value: Any) -> list[str]:
        return list(dict.fromkeys(it for one in value[1] for it in self.texts(one)))

    def of_subpattern(self, value: Any) -> list[str]:
        found = self.texts(value[3])
        if value[0] is not None:
            self.groups[value[0]] = found[0]
        return found

    def of_atomic_group(self, value: Any) -> list[str]:
        return self.texts(value)

    def of_max_repeat(self, value: tuple[int, int, Any]) -> list[str]:
        least, most, body = value
        found = [it * max(least, min(most, 1)) for it in self.texts(body)]
        return found if least else [*found, ""]

    of_min_repeat = of_possessive_repeat = of_max_repeat

    def of_groupref(self, value: int) -> list[str]:
        return [self.groups.get(value, "")]

    def some_of(self, op: str, value: Any) -> list[str]:
        maker = _Maker(self.flags, False)
        getattr(maker, f"of_{op}")(value)
        test = maker.code[0][1]
        taken = [it for it in [*self.characters, *"a0 \n_-x</>\"'.A"] if test(it)]
        return list(dict.fromkeys(taken))[:3] or [
            next(it for it in map(chr, range(0x110000)) if test(it))
        ]


def _ways(nodes: Any, before: str, make: _Examples) -> Iterator[tuple[str, list[str]]]:
    """Each thing that is repeated: what leads to it, and what it may be."""
    nodes = list(nodes)
    for at, (op, value) in enumerate(nodes):
        led = before + make.texts(nodes[:at])[0]
        inner: list[Any] = []
        if op.name.endswith("_REPEAT"):
            inner = [value[2]]
            if value[1] > 2:
                yield led, make.texts(value[2])
        elif op.name == "ATOMIC_GROUP":
            inner = [value]
        elif op.name == "BRANCH":
            inner = list(value[1])
        elif op.name == "SUBPATTERN":
            inner = [value[3]]
        elif op.name in ("ASSERT", "ASSERT_NOT"):
            inner = [value[1]]
        for one in inner:
            yield from _ways(one, led, make)


class Attack(NamedTuple):
    """A text of any length: a start, what is repeated, and an end on which the match may fail."""

    start: str
    repeated: str
    end: str

    def text(self, count: int) -> str:
        return self.start + self.repeated * count + self.end


def attacks(pattern: str | bytes, flags: int = 0) -> list[Attack]:
    """Return texts on which a pattern may take long: its repeats, what leads there, its characters."""
    tree = sre_parse.parse(pattern, flags)  # type: ignore[arg-type]
    make = _Examples(tree.state.flags)
    whole = make.texts(tree)
    ways = list(_ways(tree, "", make))
    starts = list(dict.fromkeys(["", *(led for led, _ in ways)]))[:10]
    bodies = [it for _, texts in ways for it in texts]
    led = [it + body for it, texts in ways for body in ("", texts[0])]
    cut = [it[:-1] for it in whole]
    pairs = [it + other for _, texts in ways for it, other in pairwise(texts)]
    repeated = [*make.characters, *bodies, *led, *pairs, *whole, *cut, " ", "a", "\n", "0"]
    pumps = [it for it in dict.fromkeys(repeated) if it][:48]
    return [Attack(*it) for it in _crossed(starts, pumps)]


def _crossed(starts: Sequence[str], pumps: Sequence[str]) -> Iterator[tuple[str, str, str]]:
    for pump in pumps:
        for start in starts:
            for end in ("", "\x01"):
                yield start, pump, end
        # A new line ends most runs, and no line begins before it.
        yield starts[-1], pump, "\n"


# How often an attack repeats its text: twice as long is read in twice the steps, more or less.
SMALL, LARGE = 8, 24
GIVEN_UP = 60_000
MATCH_ALONE = ("match", "fullmatch")


def cost(program: Program, text: str, use: str) -> int:
    """Return the steps that a method of a pattern takes over a text; GIVEN_UP for more."""
    matcher = Matcher(program, GIVEN_UP)
    try:
        if use in MATCH_ALONE:
            matcher.match(text, whole=use == "fullmatch")
        else:
            for _ in matcher.every(text):
                pass
    except TooManyStepsError:
        return GIVEN_UP
    return matcher.steps


def worst(pattern: str | bytes, flags: int, use: str) -> tuple[float, Attack | None]:
    """Return how much faster than the text its steps grow at most, 1 for a linear pattern, and on
    which text."""
    program = program_of(pattern, flags)
    found: tuple[float, Attack | None] = 0.0, None
    for attack in attacks(pattern, flags):
        steps = [cost(program, attack.text(count), use) for count in (SMALL, LARGE)]
        ratio = steps[1] / steps[0] / (LARGE / SMALL)
        if ratio > found[0] or steps[1] == GIVEN_UP:
            found = (ratio if steps[1] < GIVEN_UP else float(GIVEN_UP)), attack
    return found
