# SPDX-License-Identifier: Apache-2.0
"""Faults of values, each planted alone in a healthy robot with its files: which of them are told.

``fixtures/lint/defects`` has the robot, the faults by class, those that users asked about, and odd
things that are no fault.
"""

from __future__ import annotations

import re
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

import yaml
from paths import FIXTURES

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding
from multibot_rewrite.lint.run import lint_files
from multibot_rewrite.rules.settings import Settings

DEFECTS = FIXTURES / "lint" / "defects"
HEALTHY = DEFECTS / "healthy"
SILENT = "silent"
_SETTINGS = Settings(distro="jazzy")
_LEVELS = (ERROR, WARNING, NOTE)


class Fault(NamedTuple):
    """What is replaced in a file, and a pattern of what a user wants to hear."""

    name: str
    file: str
    old: str
    new: str
    hear: str
    source: str


def faults(name: str) -> list[Fault]:
    """Return the faults of a list."""
    entries: Mapping[str, list[str]] = yaml.load(
        (DEFECTS / f"{name}.yaml").read_bytes(), yaml.CSafeLoader
    )
    return [Fault(key, *map(str, entry)) for key, entry in entries.items()]


def found_for(fault: Fault) -> list[Finding]:
    """Return what the lint says of the robot with the fault that it does not say without."""
    return [it for it in _linted(fault) if _key(it) not in _healthy()]


def level_of(fault: Fault) -> str:
    """Return the highest level at which the fault is told, else ``SILENT``."""
    found = [
        it.level for it in found_for(fault) if re.search(fault.hear, f"{it.message} {it.hint}")
    ]
    return next((it for it in _LEVELS if it in found), SILENT)


def healthy_findings() -> list[Finding]:
    """Return what the lint says of the robot without a fault."""
    return _linted(None)


@cache
def _healthy() -> frozenset[tuple[str, str]]:
    return frozenset(_key(it) for it in _linted(None))


def _key(it: Finding) -> tuple[str, str]:
    return it.code, it.message


def _linted(fault: Fault | None) -> list[Finding]:
    with tempfile.TemporaryDirectory() as folder:
        for path in HEALTHY.iterdir():
            text = path.read_text("utf-8")
            if fault and fault.file == path.name:
                assert text.count(fault.old) >= 1, f"{fault.name}: not in {path.name}"
                text = text.replace(fault.old, fault.new, 1)
            (Path(folder) / path.name).write_text(text, "utf-8")
        return lint_files(sorted(map(str, Path(folder).iterdir())), _SETTINGS, jobs=1)


def _lines(names: list[str]) -> Iterator[str]:
    for name in names:
        levels = {fault: level_of(fault) for fault in faults(name)}
        for fault, level in levels.items():
            other = (
                ""
                if level != SILENT
                else "; ".join(sorted({f"{it.code} {it.message}" for it in found_for(fault)}))
            )
            yield f"{level:8} {fault.name}  {other}"
        yield f"{name}: {dict(Counter(levels.values()))}"


if __name__ == "__main__":
    for line in _lines(sys.argv[1:] or ["classes", "questions"]):
        print(line)
