# SPDX-License-Identifier: Apache-2.0
"""``python -m tools.interfaces.declared_table TABLES``: ``knowledge/declared.schema``.

TABLES is the folder with ``parameters_RELEASE.tsv.xz``. Of the packages of known nodes, and of each
plugin of ``plugin_owners.yaml``, each parameter: those of a plugin by their path below its name.
"""

from __future__ import annotations

import os
import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.base.releases import RELEASES as EVERY
from multibot_rewrite.knowledge.declared import ANY, CHECKS, DECLARED, RELEASES, YAML, checks_in
from multibot_rewrite.knowledge.node_sets import every_release
from multibot_rewrite.producers.sources.records import Place
from multibot_rewrite.rules.files.parameter_files import NO_DEFAULT, beyond
from tools.interfaces.parameter_facts import ParameterFact, read_parameters
from tools.interfaces.table import read_packed

ID = "<id>."
HEAD = """\
# Parameters that the classes of packages and the plugins of Nav2 declare. Made by
# python -m tools.interfaces.declared_table fixtures/interfaces >
# multibot_rewrite/knowledge/declared.schema
#
#   [OWNER] REPOSITORY TAG [FOLDER]     a package, or the class of a plugin
#   PATH TYPE FILE:LINE [TAG] [releases=WORDS] [yaml | read] [! CHECK...]
#                                       any: of no type that is known; TAG where it is another one than
#                                       the section's; yaml: by generate_parameter_library;
#                                       read: not declared there
"""


class PluginOwners(NamedTuple):
    """What ``plugin_owners.yaml`` says: ``owners`` are package and class -> its plugins, ``below`` what
    stands before the names of a package's parameters."""

    inner: frozenset[str]
    within: Mapping[str, str]
    owners: Mapping[tuple[str, str], tuple[str, ...]]
    packages: Mapping[str, str]
    below: Mapping[str, str]


class Row(NamedTuple):
    """A parameter of an owner, without where it can be read."""

    owner: str
    path: str
    type: str
    bounds: str
    how: str


@lru_cache
def plugin_owners() -> PluginOwners:
    """Return the data of the folder."""
    found = load_yaml(
        files(__package__).joinpath("plugin_owners.yaml").read_text("utf-8"), "plugin_owners.yaml"
    )
    owners: dict[tuple[str, str], list[str]] = {}
    packages: dict[str, str] = {}
    for package, plugins in found["plugins"].items():
        for plugin, others in plugins.items():
            packages[plugin] = package
            for it in (plugin.rpartition("::")[2], *others):
                other, _, name = it.rpartition("/")
                owners.setdefault((other or package, name), []).append(plugin)
    by_owner = {owner: tuple(plugins) for owner, plugins in owners.items()}
    inner = frozenset(found["inner"])
    return PluginOwners(inner, found["within"], by_owner, packages, found["below"])


def linted_packages() -> frozenset[str]:
    """Return the packages whose classes declare parameters of known nodes."""
    nodes = every_release().parameters.values()
    return frozenset(it for node in nodes for it in (node.package, *node.declared_in) if it)


def rows(fact: ParameterFact, alone: bool = False) -> Iterator[Row]:
    """Yield the rows of a fact: of its package, and of plugins. ``alone``: it has one class."""
    known = plugin_owners()
    if fact.package in linted_packages():
        above = known.below.get(fact.package, "")
        path = f"{above}.{fact.path}" if above else fact.path
        bounds = f"{fact.bounds} required()".lstrip() if alone and _is_needed(fact) else fact.bounds
        yield Row(fact.package, path, fact.type, bounds, fact.how)
    for plugin in known.owners.get((fact.package, fact.owner), ()):
        path = _below(fact, plugin, known)
        if path:
            yield Row(plugin, path, fact.type, "", fact.how)


def _is_needed(fact: ParameterFact) -> bool:
    """Return whether generate_parameter_library refuses the parameter if nobody sets it."""
    if fact.how != YAML or fact.type == "none" or "<" in fact.path:
        return False
    value = load_yaml(fact.default, fact.path)
    said = (beyond(*check, value) for check in checks_in(fact.bounds))
    return fact.default == NO_DEFAULT or any(said)


def _below(fact: ParameterFact, plugin: str, known: PluginOwners) -> str:
    """Return the path below the plugin's name; empty for a parameter of another one or the node."""
    above = ID * (2 if known.packages[plugin] in known.inner else 1)
    path = fact.path.removeprefix(above)
    if path == fact.path:
        return ""
    within = known.within.get(fact.owner, "")
    return f"{within}.{path}" if within else path


def table(folder: Path) -> str:
    """Return the table of a folder's facts."""
    found: dict[Row, dict[str, Place]] = {}
    for release in EVERY:
        facts = read_parameters(read_packed(folder / f"parameters_{release}.tsv.xz"))
        owners = Counter(package for package, _ in {(it.package, it.owner) for it in facts})
        for fact in facts:
            for row in rows(fact, owners[fact.package] == 1):
                found.setdefault(row, {})[release] = fact.place
    sections: dict[str, list[Row]] = {}
    for row in sorted(found):
        sections.setdefault(row.owner, []).append(row)
    return HEAD + "".join(_section(owner, its, found) for owner, its in sections.items())


def _section(owner: str, its: Iterable[Row], found: Mapping[Row, Mapping[str, Place]]) -> str:
    last = {row: list(found[row].values())[-1] for row in its}
    repository, tag = Counter((it.repository, it.version) for it in last.values()).most_common(1)[
        0
    ][0]
    folder = os.path.commonpath([os.path.dirname(it.path) for it in last.values()])
    lines = "".join(_line(row, it, tag, folder, found[row]) for row, it in last.items())
    head = " ".join(filter(None, (repository, tag, folder)))
    return f"\n[{owner}] {head}\n{lines}"


def _line(row: Row, place: Place, tag: str, folder: str, there: Iterable[str]) -> str:
    words = [
        row.path,
        row.type or ANY,
        f"{os.path.relpath(place.path, folder or '.')}:{place.line}",
    ]
    words += [place.version] * (place.version != tag)
    releases = ",".join(there)
    words += [f"{RELEASES}{releases}"] * (releases != ",".join(EVERY))
    words += [row.how] * (row.how != DECLARED)
    checks = f"{CHECKS}{row.bounds}" if row.bounds else ""
    return f"{' '.join(words)}{checks}\n"


if __name__ == "__main__":
    sys.stdout.write(table(Path(sys.argv[1])))
