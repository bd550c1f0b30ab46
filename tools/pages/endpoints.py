# SPDX-License-Identifier: Apache-2.0
"""The section of the page of interfaces about endpoints."""

from __future__ import annotations

from pathlib import Path

from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.knowledge.node_sets import built_in
from tools.interfaces.compare import differences, excepted, exceptions_of
from tools.interfaces.table import from_table, read_packed

TEXT = """\
## Endpoints

`python -m tools.interfaces FOLDER...` reads checkouts, C++ and Python, and prints what known nodes
declare: topics, services, actions, tf, whose node has them (its own, tf2's helper, a private one),
the parameter that sets the name and the condition. A *difference* is an endpoint that only the sources
or only `knowledge/nodes/` have, another node that has it, or one that exists with a plugin or mode
only. *Corrected* are those of the table before it was compared (`endpoints_corrected.tsv`), *excepted*
those with a reason in `fixtures/interfaces_exceptions.tsv`.

| release | nodes | endpoints | differences | corrected | excepted |
|---|--:|--:|--:|--:|--:|
"""


def section(fixtures: Path) -> str:
    """Return the section, from the tables of a folder."""
    return TEXT + "".join(_row(fixtures, release) for release in RELEASES)


def _row(fixtures: Path, release: str) -> str:
    tables = fixtures / "interfaces"
    facts = from_table(read_packed(tables / f"{release}.tsv.xz"))
    exceptions = exceptions_of((fixtures / "interfaces_exceptions.tsv").read_text("utf-8"))
    found = set(differences(facts, built_in(release)))
    left = sum(bool(excepted(it, exceptions)) for it in found)
    lines = (tables / "endpoints_corrected.tsv").read_text("utf-8").splitlines()[1:]
    corrected = sum(release in line.rpartition("\t")[2].split() for line in lines)
    nodes = len({it.node for it in facts})
    counts = (nodes, len(facts), len(found) + corrected, corrected, left)
    return f"| {release} | {' | '.join(map(str, counts))} |\n"
