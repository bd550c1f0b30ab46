"""``python -m tools.interfaces.plugin_table TABLES``: the parameters of Nav2's plugins.

TABLES is the folder with ``parameters_RELEASE.tsv``. Of each plugin of ``plugin_owners.yaml``, each
parameter: plugin, path below the plugin's name, type, releases (empty for all), how it was found, where
it can be read last.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Mapping
from importlib.resources import files
from pathlib import Path

from multibot_rewrite.bounded import load_yaml
from multibot_rewrite.record import NamedTuple
from multibot_rewrite.releases import RELEASES
from tools.interfaces.parameter_facts import ParameterFact, read_parameters

ID = "<id>."


class PluginOwners(NamedTuple):
    """What ``plugin_owners.yaml`` says: ``owners`` are package and class -> its plugins."""

    inner: frozenset[str]
    within: Mapping[str, str]
    owners: Mapping[tuple[str, str], tuple[str, ...]]
    packages: Mapping[str, str]


def plugin_owners() -> PluginOwners:
    """The data of the package."""
    text = files("tools.interfaces").joinpath("plugin_owners.yaml").read_text("utf-8")
    found = load_yaml(text)
    owners: dict[tuple[str, str], list[str]] = {}
    packages: dict[str, str] = {}
    for package, plugins in found["plugins"].items():
        for plugin, others in plugins.items():
            packages[plugin] = package
            for it in (plugin.rpartition("::")[2], *others):
                other, _, name = it.rpartition("/")
                owners.setdefault((other or package, name), []).append(plugin)
    by_owner = {owner: tuple(plugins) for owner, plugins in owners.items()}
    return PluginOwners(frozenset(found["inner"]), found["within"], by_owner, packages)


def rows(facts: Mapping[str, Iterable[ParameterFact]]) -> Iterator[tuple[str, ...]]:
    """The rows of the facts of each release, sorted."""
    known = plugin_owners()
    found: dict[tuple[str, ...], dict[str, str]] = {}
    for release, its in facts.items():
        for it in its:
            source = f"{it.place.repository}@{it.place.version} {it.place.path}:{it.place.line}"
            for plugin in known.owners.get((it.package, it.owner), ()):
                path = _below(it, plugin, known)
                if path:
                    found.setdefault((plugin, path, it.type, it.how), {})[release] = source
    for key, sources in sorted(found.items()):
        plugin, path, type_, how = key
        releases = ", ".join(sources) if len(sources) < len(RELEASES) else ""
        yield plugin, path, type_, releases, how, list(sources.values())[-1]


def _below(fact: ParameterFact, plugin: str, known: PluginOwners) -> str:
    """The path below the name of the plugin; empty for a parameter of another one, or of the node."""
    above = ID * (2 if known.packages[plugin] in known.inner else 1)
    path = fact.path.removeprefix(above)
    if path == fact.path:
        return ""
    within = known.within.get(fact.owner, "")
    return f"{within}.{path}" if within else path


def table(folder: Path) -> str:
    """The table of a folder's facts."""
    facts = {
        release: read_parameters((folder / f"parameters_{release}.tsv").read_text())
        for release in RELEASES
    }
    return "".join("\t".join(row) + "\n" for row in rows(facts))


if __name__ == "__main__":
    sys.stdout.write(table(Path(sys.argv[1])))
