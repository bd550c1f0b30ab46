# SPDX-License-Identifier: Apache-2.0
"""What the lint finds in public files, counted; ``tools/pages/lint_triage.py`` has the judgements.

python tests/support/lint_triage.py > fixtures/lint_triage_counts.tsv
"""

from __future__ import annotations

import sys
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from pathlib import Path

from paths import CORPUS
from real_robots import corpus_files, wheel_files

from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.lint.files.pairing import named_urdfs
from multibot_rewrite.lint.run import lint_files
from multibot_rewrite.rules.settings import Settings

# So many findings of a rule are judged, or all where there are fewer.
LEAST = 5


def linted_corpus() -> dict[str, list[Finding]]:
    """Return the findings of the public files by their name there, each repository's SRDF files
    with its own URDF files."""
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
    """Return the findings of the description wheels by file, ``wheel:NAME/...``."""
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
    """Return the committed table: a line for each rule, the first for the number of files."""
    rows = [("code", "corpus", "wheels"), ("files", *map(str, files))]
    codes = sorted({*corpus, *wheels})
    rows += [(code, str(corpus[code]), str(wheels[code])) for code in codes]
    return "".join("\t".join(row) + "\n" for row in rows)


if __name__ == "__main__":
    corpus, wheels = linted_corpus(), linted_wheels()
    sizes = len(corpus), len(wheels)
    sys.stdout.write(counts_table(errors(corpus), errors(wheels), sizes))
