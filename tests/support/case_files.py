# SPDX-License-Identifier: Apache-2.0
"""Case files: one input, what is to become of it, and why. The format is in ``read_case``."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

from paths import FIXTURES, ROBOTS

HOME = FIXTURES / "cases"
RULE = b"----\n"
HEADERS = ("about", "rewriter", "options", "expect", "finds")
REQUIRED = ("about", "rewriter", "expect")
LISTS = ("shared_topics", "shared_frames")
SWITCHES = ("again",)


class CaseError(Exception):
    """A case file is not what it must be; the message names the file."""


class Case(NamedTuple):
    """One case. ``refusal`` is the code of the error where ``expect`` is ``refused``."""

    name: str
    about: str
    rewriter: str
    options: Mapping[str, object]
    expect: str
    refusal: str
    finds: tuple[str, ...]
    source: bytes
    output: bytes


def load_cases(home: Path = HOME) -> list[Case]:
    """Every case below ``home``; raises CaseError for an empty folder or a name used twice."""
    cases: dict[str, Case] = {}
    for folder in sorted(path for path in home.iterdir() if path.is_dir()):
        files = sorted(folder.glob("*.case"))
        if not files or len(files) != len(list(folder.iterdir())):
            raise CaseError(f"{folder}: holds no case, or something else than cases")
        for file in files:
            if file.stem in cases:
                raise CaseError(f"{file}: there is a case {cases[file.stem].name} already")
            cases[file.stem] = read_case(f"{folder.name}/{file.stem}", file.read_bytes())
    return list(cases.values())


@cache
def all_cases() -> list[Case]:
    """Those of this repository, read once."""
    return load_cases()


def read_case(name: str, data: bytes) -> Case:
    """Headers, a line of four dashes, the input and, for ``changed``, the rule and the output.

    Headers are ``about``, ``rewriter``, ``expect`` (``changed``, ``same`` or ``refused CODE``) and
    optionally ``options`` (words of ``rewrite_all``; ``urdf`` is a file of ``ROBOTS``) and ``finds``
    (``CODE@line``, all of them).
    """
    parts = data.split(b"\n" + RULE)
    headers = _headers(name, parts[0].decode())
    expect, _, refusal = headers["expect"].partition(" ")
    _check_expect(name, expect, refusal, parts)
    source = parts[1] + (b"\n" if len(parts) == 3 else b"")
    output = parts[2] if len(parts) == 3 else source
    if (source == output) == (expect == "changed"):
        raise CaseError(f"{name}: expect is {expect}, but the output equals the input")
    options = _options(name, headers.get("options", ""))
    finds = tuple(headers.get("finds", "").split())
    about, rewriter = headers["about"], headers["rewriter"]
    return Case(name, about, rewriter, options, expect, refusal, finds, source, output)


def _headers(name: str, text: str) -> dict[str, str]:
    headers: dict[str, str] = {}
    for row in text.split("\n"):
        key, colon, value = row.partition(": ")
        if not colon or key not in HEADERS or key in headers or not value.strip():
            raise CaseError(f"{name}: header {row!r} is unknown, empty or there twice")
        headers[key] = value.strip()
    missing = [key for key in REQUIRED if key not in headers]
    if missing:
        raise CaseError(f"{name}: header {missing[0]} is missing")
    return headers


def _check_expect(name: str, expect: str, refusal: str, parts: list[bytes]) -> None:
    if expect not in ("changed", "same", "refused") or (expect == "refused") != bool(refusal):
        raise CaseError(f"{name}: expect is changed, same or refused CODE")
    if len(parts) != (3 if expect == "changed" else 2) or not all(parts):
        raise CaseError(f"{name}: {expect} needs headers, input{', output' * (len(parts) < 3)}")


def _options(name: str, text: str) -> dict[str, object]:
    options: dict[str, object] = {}
    for word in text.split():
        key, equals, value = word.partition("=")
        if not value and key not in SWITCHES:
            raise CaseError(f"{name}: option {word!r} is not key=value")
        options[key] = _value(key, value) if equals else True
    if not (ROBOTS / str(options.get("urdf", ""))).exists():
        raise CaseError(f"{name}: there is no {options['urdf']} in {ROBOTS}")
    return options


def _value(key: str, value: str) -> object:
    if key == "urdf":
        return ROBOTS / value
    if key in LISTS:
        return value.split(",")
    if key == "separators":
        return dict(item.split(":", 1) for item in value.split(","))
    return value
