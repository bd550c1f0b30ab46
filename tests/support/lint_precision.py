# SPDX-License-Identifier: Apache-2.0
"""How often the newest rules of the lint are right, and what they find of planted defects, as a page.

python tests/support/lint_precision.py --write
python tests/support/lint_precision.py counts: the column ``hits`` of fixtures/lint_precision.tsv anew
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterable
from functools import cache
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from types import ModuleType
from typing import NamedTuple

from lint_triage import linted_corpus, linted_wheels
from paths import CORPUS, FIXTURES, ROOT, fixture_text
from real_robots import corpus_files, wheel_files

from multibot_rewrite.lint.registry import RULES
from multibot_rewrite.lint.run import lint_files
from multibot_rewrite.rules.settings import Settings

PRECISION = FIXTURES / "lint_precision.tsv"
# ROS 2 these releases: the newest ones have nothing to find.
RELEASES = {"MB157": "humble", "MB172": "lyrical"}
# Found in checkouts of whole packages alone, which have launch files or descriptions next to the file.
IN_PACKAGES = ("MB145", "MB854", "MB856")
BESIDE = (".yaml", ".yml", ".rviz")
_HEAD = fixture_text("lint_precision_head.txt")
_NEVER_FOUND = """
No public file has what these rules find. Each rests on the source that `fixtures/lint_precision.tsv`
names, on its examples and on the defects planted in `tests/lint/`, which it finds alone: {codes}.
"""
_RULES = """
| rule | level | found | judged | true |
|---|---|--:|--:|--:|
"""
PLANTED = {
    "test_lint_gazebo": "below `<gazebo>`, parameters of plugins and hardware",
    "test_lint_systems": "ros2_control as a whole",
    "test_lint_geometry": "geometry of a rover and an arm",
    "test_lint_beside": "parameter, RViz, MoveIt and bridge files",
}


class Precision(NamedTuple):
    """How many findings of a rule there are in public files, were judged, are true, and by whom."""

    code: str
    hits: int
    judged: int
    true: int
    referee: str


class Planted(NamedTuple):
    """How many defects a file of tests has, of how many something is found without the rules of the
    table and with them, and how many healthy oddities."""

    defects: int
    before: int
    found: int
    healthy: int


def precisions() -> list[Precision]:
    """Return the table of precision."""
    rows = (line.split("\t") for line in PRECISION.read_text().splitlines()[1:])
    return [Precision(code, *map(int, numbers), referee) for code, *numbers, referee in rows]


def planted(module: str) -> Planted:
    """Return the counts of a file of tests: its ``defects()`` and ``oddities()``, linted."""
    tests = import_module(module)
    table = {it.code for it in precisions()}
    before = after = count = 0
    for defect, healthy, code in tests.defects():
        new = _linted(tests, defect) - _linted(tests, healthy)
        count, before, after = count + 1, before + bool(new - table), after + (code in new)
    return Planted(count, before, after, len(tests.HEALTHY))


@cache
def _linted(tests: ModuleType, case: object) -> frozenset[str]:
    """Return what all rules find, in a workspace of its own: what is next to a file counts."""
    with TemporaryDirectory() as folder:
        package = Path(folder) / "workspace/src/package"
        package.mkdir(parents=True)
        return frozenset(tests.linted(case, package))


def hits() -> Counter[str]:
    """How many findings of each rule there are in public files today."""
    counts = in_descriptions(linted_corpus().values()) + in_descriptions(linted_wheels().values())
    counts += in_models()
    beside = [str(it) for it in sorted(CORPUS.rglob("*")) if it.suffix in BESIDE]
    counts += Counter(it.code for it in lint_files(beside, Settings()))
    described = [*corpus_files().values(), *wheel_files().values(), *models()]
    for code, release in RELEASES.items():
        settings = Settings(distro=release, select=(code,))
        counts[code] = len(list(lint_files([str(it) for it in described], settings)))
    return counts


def in_descriptions(found: Iterable[list]) -> Counter[str]:  # type: ignore[type-arg]
    """Return the findings of each rule in files."""
    return Counter(it.code for its in found for it in its)


def models() -> list[Path]:
    """Return the SDF files of the corpus."""
    return sorted((CORPUS / "sdf").rglob("*.sdf"))


def in_models() -> Counter[str]:
    """Return the findings of each rule in them."""
    return Counter(it.code for it in lint_files([str(it) for it in models()], Settings()))


def precision_page() -> str:
    """Return the page, Markdown."""
    parts = [_HEAD.format(in_packages=", ".join(IN_PACKAGES))]
    for module, what in PLANTED.items():
        it = planted(module)
        counts = f"{it.defects} | {it.before} | {it.found} | {it.healthy}"
        parts.append(f"| {what} (`{module}.py`) | {counts} |\n")
    found = [it for it in precisions() if it.hits]
    never = ", ".join(it.code for it in precisions() if not it.hits)
    parts += [_NEVER_FOUND.format(codes=never), _RULES]
    parts += (
        f"| {it.code} {RULES[it.code].name} | {RULES[it.code].level} | {it.hits} | {it.judged} "
        f"| {it.true} |\n"
        for it in found
    )
    return "".join(parts)


def counted() -> str:
    """Return the table with today's hits."""
    now = hits()
    head = PRECISION.read_text().splitlines()[0]
    rows = (it if it.code in IN_PACKAGES else it._replace(hits=now[it.code]) for it in precisions())
    return "\n".join([head, *("\t".join(map(str, it)) for it in rows)]) + "\n"


if __name__ == "__main__":
    sys.path[:0] = [str(ROOT / "tests/lint"), str(ROOT)]
    if sys.argv[1:] == ["counts"]:
        PRECISION.write_text(counted())
    else:
        sys.stdout.write(precision_page())
    if sys.argv[1:] == ["--write"]:
        sys.path.append(str(ROOT / "benchmarks"))
        from one_page import write_section

        write_section(precision_page())
