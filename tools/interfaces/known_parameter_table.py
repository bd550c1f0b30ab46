"""``python -m tools.interfaces.known_parameter_table TABLES``: the known parameters.

TABLES is the folder with ``parameters_RELEASE.tsv``. Of the packages of known nodes, each parameter:
package, path, type, bounds, releases (empty for all), how it was found, where it can be read last.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from multibot_rewrite.knowledge.parameters import built_in_nodes
from multibot_rewrite.releases import NEWEST_LTS, RELEASES
from multibot_rewrite.rules.files.parameter_owners import owners
from tools.interfaces.parameter_facts import ParameterFact, read_parameters

Row = tuple[str, ...]
_Key = tuple[str, str, str, str, str]


def linted_packages() -> frozenset[str]:
    """The packages whose classes declare parameters of known nodes."""
    nodes = built_in_nodes(NEWEST_LTS).nodes.values()
    also = (it for packages in owners().also.values() for it in packages)
    return frozenset((*(it.package for it in nodes if it.package), *also))


def rows(facts: Mapping[str, Iterable[ParameterFact]]) -> Iterator[Row]:
    """The rows of the facts of each release, sorted."""
    packages = linted_packages()
    found: dict[_Key, list[str]] = {}
    source: dict[_Key, str] = {}
    for release, its in facts.items():
        for it in its:
            key = (it.package, it.path, it.type, it.bounds, it.how)
            if it.package in packages and release not in found.setdefault(key, []):
                found[key].append(release)
            source[key] = (
                f"{it.place.repository}@{it.place.version} {it.place.path}:{it.place.line}"
            )
    for key in sorted(it for it in found if found[it]):
        package, path, type_, bounds, how = key
        releases = ", ".join(found[key]) if len(found[key]) < len(RELEASES) else ""
        yield package, path, type_, bounds, releases, how, source[key]


def table(folder: Path) -> str:
    """The table of a folder's facts."""
    facts = {
        release: read_parameters((folder / f"parameters_{release}.tsv").read_text())
        for release in RELEASES
    }
    return "".join("\t".join(row) + "\n" for row in rows(facts))


if __name__ == "__main__":
    sys.stdout.write(table(Path(sys.argv[1])))
