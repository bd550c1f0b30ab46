"""Damaged real files: each is refused with a reason, or rewritten and proved."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
from lxml import etree
from robots import FIXTURES, ROBOT, graph_problems, spread

from multibot_rewrite import MultibotError, ProofError, rewrite, strip
from multibot_rewrite.naming import make_naming

Mutation = Callable[[random.Random, bytes], bytes]
OPTIONS: tuple[dict[str, str], ...] = (
    {},
    {"layout": "L1"},
    {"layout": "L2", "affix": "prefix"},
    {"affix": "prefix"},
)
SAMPLE = 60
LARGEST = 40_000
FEW, MANY = 500, 20_000
# So many of the mutants at least must get past the parser and be rewritten, or nothing is tested.
LEAST_REWRITTEN = 0.2
SNIPPETS = (
    b"&amp;", b"&#65;", b"&#x2f;", b"&nbsp;", b"&", b"<", b">", b'"', b"'", b"]]>", b"--", b"\0",
    b"<![CDATA[base_link]]>", b"<![CDATA[", b"<!-- <link name='x'/> -->", b"<!--", b"-->",
    b"<!-->-->", b"<?x y?>", b"<!DOCTYPE robot [<!ENTITY a 'b'>]>", b"\xff", b"\xef\xbb\xbf",
    b"\r\n", b"\r", b"\t", b"/", b"//", b"::", b":=", b"~", b"robot1", b"/robot1", b"_robot1",
    b"world", b" xmlns='urn:x'", b" xmlns:a='urn:a'", b"<a:b/>", b"<gazebo/>", b"<plugin/>",
    b"<link/>", b"<joint/>", b'<link name=""/>', b'<gazebo reference="world"/>', b"${x}", b"\xc3\xa9",
    b"<!-- multibot robot1 +1 (odom) -->", b"<!-- multibot -->", b"<ros/>", b"<link name='x'>y</link>",
)  # fmt: skip


def flip(chance: random.Random, data: bytes) -> bytes:
    """One bit the other way."""
    at = chance.randrange(len(data))
    return data[:at] + bytes([data[at] ^ 1 << chance.randrange(8)]) + data[at + 1 :]


def delete(chance: random.Random, data: bytes) -> bytes:
    """A short span gone."""
    start, end = span(chance, data)
    return data[:start] + data[end:]


def truncate(chance: random.Random, data: bytes) -> bytes:
    """The end gone; the root closed again every other time."""
    cut = data[: chance.randrange(1, len(data))]
    return cut + chance.choice((b"", b"</robot>"))


def insert(chance: random.Random, data: bytes) -> bytes:
    """A snippet that means something in XML or to a rewriter, anywhere."""
    at = chance.randrange(len(data))
    return data[:at] + chance.choice(SNIPPETS) + data[at:]


def insert_in_value(chance: random.Random, data: bytes) -> bytes:
    """The same at the edge of a value or text, where it hurts most."""
    places = [at for at, byte in enumerate(data) if byte in b"\"'>"]
    at = chance.choice(places or [0]) + chance.randrange(2)
    return data[:at] + chance.choice(SNIPPETS) + data[at:]


def duplicate(chance: random.Random, data: bytes) -> bytes:
    """A span twice."""
    start, end = span(chance, data)
    return data[:end] + data[start:]


def swap(chance: random.Random, data: bytes) -> bytes:
    """Two lines in each other's place."""
    lines = data.split(b"\n")
    one, two = chance.randrange(len(lines)), chance.randrange(len(lines))
    lines[one], lines[two] = lines[two], lines[one]
    return b"\n".join(lines)


def double_line(chance: random.Random, data: bytes) -> bytes:
    """A whole line twice: often a whole element."""
    lines = data.split(b"\n")
    at = chance.randrange(len(lines))
    return b"\n".join((*lines[:at], lines[at], *lines[at:]))


def change_case(chance: random.Random, data: bytes) -> bytes:
    """A span with its letters the other way."""
    start, end = span(chance, data)
    return data[:start] + data[start:end].swapcase() + data[end:]


def requote(chance: random.Random, data: bytes) -> bytes:
    """Other quotes, line ends or gaps, everywhere."""
    old, new = chance.choice(((b'"', b"'"), (b"\n", b"\r\n"), (b"=", b" = "), (b" ", b"\n\t")))
    return data.replace(old, new)


def span(chance: random.Random, data: bytes) -> tuple[int, int]:
    """A short piece somewhere."""
    start = chance.randrange(len(data))
    return start, min(len(data), start + chance.randrange(1, 30))


MUTATIONS: tuple[Mutation, ...] = (
    flip, delete, truncate, insert, insert_in_value, insert_in_value, duplicate, swap, double_line,
    change_case, requote,
)  # fmt: skip


def mutant(seed: int, sources: list[bytes]) -> bytes:
    """The mutant of a seed: one source, one to three mutations."""
    chance = random.Random(seed)
    data = chance.choice(sources)
    for _ in range(chance.randrange(1, 4)):
        data = chance.choice(MUTATIONS)(chance, data) or b"<"
    return data


def outcome(data: bytes, options: Mapping[str, str]) -> str:
    """``rewritten``, or the kind of error; AssertionError says what is wrong with a result."""
    try:
        result = rewrite(data, ROBOT, **options).data
    except ProofError:
        raise
    except MultibotError as error:
        assert str(error)
        return type(error).__name__
    etree.fromstring(result)
    assert graph_problems(data, result, options) == []
    naming = make_naming(**options)  # type: ignore[arg-type]
    assert strip(result, ROBOT, naming=naming) == data, "strip does not give the mutant back"
    return "rewritten"


def hunt(sources: list[bytes], seeds: range) -> Counter[str]:
    """What becomes of each mutant; fails with every seed that went wrong and why."""
    found: Counter[str] = Counter()
    wrong = []
    for seed in seeds:
        try:
            found[outcome(mutant(seed, sources), OPTIONS[seed % len(OPTIONS)])] += 1
        except Exception as error:
            wrong.append(f"seed {seed}: {type(error).__name__}: {str(error)[:200]}")
    assert not wrong, f"{len(wrong)} of {len(seeds)} mutants:\n" + "\n".join(wrong[:20])
    assert found["rewritten"] >= LEAST_REWRITTEN * len(seeds), found
    return found


def read_all(files: Mapping[str, Path]) -> list[bytes]:
    """The contents of the files that are not too large to try thousands of times."""
    return [data for data in (path.read_bytes() for path in files.values()) if len(data) < LARGEST]


def fixtures() -> list[bytes]:
    """The robots that come with the tests."""
    return read_all({path.name: path for path in sorted((FIXTURES / "robots").glob("*.urdf"))})


def test_mutants_of_fixtures() -> None:
    hunt(fixtures(), range(FEW))


def test_mutants_of_real_files(corpus: dict[str, Path]) -> None:
    hunt(read_all(spread(corpus, SAMPLE)), range(FEW, 2 * FEW))


@pytest.mark.parametrize("mutation", MUTATIONS, ids=lambda mutation: mutation.__name__)
def test_every_mutation_mutates(mutation: Mutation) -> None:
    data = fixtures()[0]
    assert sum(mutation(random.Random(seed), data) != data for seed in range(20)) >= 10


@pytest.mark.deep
@pytest.mark.parametrize("part", range(4))
def test_many_mutants(corpus: dict[str, Path], part: int) -> None:
    share = MANY // 4
    start = 10_000 + part * share
    hunt([*fixtures(), *read_all(spread(corpus, 4 * SAMPLE))], range(start, start + share))
