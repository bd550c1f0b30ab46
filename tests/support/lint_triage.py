"""What the lint finds in public files, counted, and the judgements about it as a page.

python tests/support/lint_triage.py counts > fixtures/lint_triage_counts.tsv
python tests/support/lint_triage.py page > docs/lint-triage.md
"""

from __future__ import annotations

import sys
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from paths import CORPUS, FIXTURES
from real_robots import corpus_files, wheel_files

from multibot_rewrite.findings.finding import ERROR, Finding
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.lint.config.settings import Settings
from multibot_rewrite.lint.files.pairing import named_urdfs
from multibot_rewrite.lint.registry import RULES
from multibot_rewrite.lint.run import lint_files

COUNTS = FIXTURES / "lint_triage_counts.tsv"
# So many findings of a rule are judged, or all where there are fewer.
LEAST = 5
SHOWN = 5
_HEAD = """\
# Findings of urdf-lint in public robots

Made by `python tests/support/lint_triage.py page > docs/lint-triage.md`
from `fixtures/lint_triage_*.tsv`.

Every rule that finds an error in {corpus} public files or {wheels} of Python packages was
judged: at least five of its findings, or all, by reading the file or with check_urdf,
sdformat or MuJoCo. False errors were bugs of the rule and are fixed. Of warnings and notes a
sample was judged; rules with a few false findings are warnings for that reason. Each rule
shows some judgements here, the files have all of them. The counts are those of errors; a test
checks them.

| rule | public files | packages | judged | false |
|---|--:|--:|--:|--:|
"""


class Judged(NamedTuple):
    """A judgement: is a finding true, and why."""

    code: str
    file: str
    line: int
    true: bool
    reason: str


def judgements() -> list[Judged]:
    """All of them, by rule."""
    files = sorted(FIXTURES.glob("lint_triage_MB*.tsv"))
    lines = (line for path in files for line in path.read_text().splitlines()[1:] if line)
    return sorted(_judged(line) for line in lines)


def _judged(line: str) -> Judged:
    code, file, number, judgement, reason = line.split("\t")
    assert judgement in ("true", "false"), line
    return Judged(code, file.removeprefix("urdf/"), int(number), judgement == "true", reason)


def linted_corpus() -> dict[str, list[Finding]]:
    """The findings of the public files by their name there, each repository's SRDF files with its
    own URDF files."""
    files = corpus_files()
    found = _by_file(lint_files([str(it) for it in files.values()], Settings()), files)
    for repository, srdfs in _srdfs().items():
        urdfs = [str(path) for name, path in files.items() if name.startswith(f"{repository}/")]
        own = Settings(urdfs=named_urdfs([*urdfs, *map(str, srdfs.values())], frozenset()))
        found |= {name: lint_file(str(path), own) for name, path in srdfs.items()}
    return found


def _srdfs() -> dict[str, dict[str, Path]]:
    home = CORPUS / "srdf"
    found: dict[str, dict[str, Path]] = defaultdict(dict)
    for path in sorted(home.rglob("*.srdf")):
        name = path.relative_to(home)
        found[name.parts[0]][f"srdf/{name}"] = path
    return found


def linted_wheels() -> dict[str, list[Finding]]:
    """The findings of the description wheels by file, ``wheel:NAME/...``."""
    files = {f"wheel:{name}": path for name, path in wheel_files().items()}
    return _by_file(lint_files([str(it) for it in files.values()], Settings()), files)


def _by_file(found: Iterable[Finding], files: Mapping[str, Path]) -> dict[str, list[Finding]]:
    names = {str(path): name for name, path in files.items()}
    result: dict[str, list[Finding]] = {name: [] for name in files}
    for it in found:
        if it.file in names:
            result[names[it.file]].append(it)
    return result


def errors(found: Mapping[str, list[Finding]]) -> Counter[str]:
    """How many of each rule are errors."""
    return Counter(it.code for its in found.values() for it in its if it.level == ERROR)


def counts_table(corpus: Counter[str], wheels: Counter[str], files: tuple[int, int]) -> str:
    """The committed table: a line for each rule, the first for the number of files."""
    rows = [("code", "corpus", "wheels"), ("files", *map(str, files))]
    codes = sorted({*corpus, *wheels})
    rows += [(code, str(corpus[code]), str(wheels[code])) for code in codes]
    return "".join("\t".join(row) + "\n" for row in rows)


def committed() -> dict[str, tuple[int, int]]:
    """The committed counts."""
    rows = [line.split("\t") for line in COUNTS.read_text().splitlines()[1:]]
    return {code: (int(corpus), int(wheels)) for code, corpus, wheels in rows}


def page() -> str:
    """The page of judgements, Markdown."""
    counts = committed()
    by_rule: dict[str, list[Judged]] = defaultdict(list)
    for it in judgements():
        by_rule[it.code].append(it)
    corpus, wheels = counts.pop("files")
    parts = [_HEAD.format(corpus=f"{corpus:,}", wheels=wheels)]
    codes = [code for code in sorted({*counts, *by_rule}) if code in RULES]
    parts += [_row(code, *counts.get(code, (0, 0)), by_rule[code]) for code in codes]
    parts += [part for code in codes if by_rule[code] for part in _section(code, by_rule[code])]
    return "".join(parts)


def _row(code: str, corpus: int, wheels: int, judged: list[Judged]) -> str:
    rule = RULES[code]
    false = sum(not it.true for it in judged)
    level = "" if rule.level == ERROR else f" ({rule.level})"
    shown = (corpus, wheels) if rule.level == ERROR else ("", "")
    return f"| {code} {rule.name}{level} | {shown[0]} | {shown[1]} | {len(judged)} | {false} |\n"


def _section(code: str, judged: list[Judged]) -> Iterator[str]:
    yield f"\n## {code} {RULES[code].name}\n\n"
    # One of each reason first, then more of them.
    firsts = {(it.true, it.reason): it for it in reversed(judged)}
    order = sorted(judged, key=lambda it: firsts[it.true, it.reason] is not it)
    for it in sorted(order[:SHOWN]):
        verdict = "true" if it.true else "false"
        yield f"- `{it.file}:{it.line}` {verdict}: {it.reason}\n"


if __name__ == "__main__":
    if sys.argv[1:] == ["counts"]:
        corpus, wheels = linted_corpus(), linted_wheels()
        sizes = len(corpus), len(wheels)
        sys.stdout.write(counts_table(errors(corpus), errors(wheels), sizes))
    else:
        sys.stdout.write(page())
