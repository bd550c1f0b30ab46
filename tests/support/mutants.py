# SPDX-License-Identifier: Apache-2.0
"""Damaged robot files: mutations, and the mutant of a seed."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from pathlib import Path

from paths import FIXTURES

Mutation = Callable[[random.Random, bytes], bytes]
SAMPLE = 60
LARGEST = 40_000
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
    """Return the text without a short span."""
    start, end = span(chance, data)
    return data[:start] + data[end:]


def truncate(chance: random.Random, data: bytes) -> bytes:
    """Return the text without its end; the root is closed again every other time."""
    cut = data[: chance.randrange(1, len(data))]
    return cut + chance.choice((b"", b"</robot>"))


def insert(chance: random.Random, data: bytes) -> bytes:
    """Return a snippet that means something in XML or to a rewriter, anywhere."""
    at = chance.randrange(len(data))
    return data[:at] + chance.choice(SNIPPETS) + data[at:]


def insert_in_value(chance: random.Random, data: bytes) -> bytes:
    """Return the same at the edge of a value or text, where it hurts most."""
    places = [at for at, byte in enumerate(data) if byte in b"\"'>"]
    at = chance.choice(places or [0]) + chance.randrange(2)
    return data[:at] + chance.choice(SNIPPETS) + data[at:]


def duplicate(chance: random.Random, data: bytes) -> bytes:
    """Return the text with a span twice."""
    start, end = span(chance, data)
    return data[:end] + data[start:]


def swap(chance: random.Random, data: bytes) -> bytes:
    """Two lines in each other's place."""
    lines = data.split(b"\n")
    one, two = chance.randrange(len(lines)), chance.randrange(len(lines))
    lines[one], lines[two] = lines[two], lines[one]
    return b"\n".join(lines)


def double_line(chance: random.Random, data: bytes) -> bytes:
    """Return the text with a whole line twice: often a whole element."""
    lines = data.split(b"\n")
    at = chance.randrange(len(lines))
    return b"\n".join((*lines[:at], lines[at], *lines[at:]))


def change_case(chance: random.Random, data: bytes) -> bytes:
    """Return the text with the letters of a span in the other case."""
    start, end = span(chance, data)
    return data[:start] + data[start:end].swapcase() + data[end:]


def requote(chance: random.Random, data: bytes) -> bytes:
    """Other quotes, line ends or gaps, everywhere."""
    old, new = chance.choice(((b'"', b"'"), (b"\n", b"\r\n"), (b"=", b" = "), (b" ", b"\n\t")))
    return data.replace(old, new)


def span(chance: random.Random, data: bytes) -> tuple[int, int]:
    """Return a short piece somewhere."""
    start = chance.randrange(len(data))
    return start, min(len(data), start + chance.randrange(1, 30))


MUTATIONS: tuple[Mutation, ...] = (
    flip, delete, truncate, insert, insert_in_value, insert_in_value, duplicate, swap, double_line,
    change_case, requote,
)  # fmt: skip


def mutant(seed: int, sources: list[bytes]) -> bytes:
    """Return the mutant of a seed: one source, one to three mutations."""
    chance = random.Random(seed)
    data = chance.choice(sources)
    for _ in range(chance.randrange(1, 4)):
        data = chance.choice(MUTATIONS)(chance, data) or b"<"
    return data


def read_all(files: Mapping[str, Path]) -> list[bytes]:
    """Return the contents of the files that are not too large to try thousands of times."""
    return [data for data in (path.read_bytes() for path in files.values()) if len(data) < LARGEST]


def fixtures() -> list[bytes]:
    """Return the robots that come with the tests."""
    return read_all({path.name: path for path in sorted((FIXTURES / "robots").glob("*.urdf"))})
