# SPDX-License-Identifier: Apache-2.0
"""The section of the page of interfaces about parameters and launch files."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path

from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.knowledge.node_sets import every_release
from tools.interfaces.declared_table import plugin_owners
from tools.interfaces.launch_comparison import (
    launch_differences,
    launch_files,
    nodes_of_sets,
)
from tools.interfaces.parameter_comparison import differences, our_parameters
from tools.interfaces.parameter_facts import ParameterFact, read_parameters
from tools.interfaces.parameter_tables import read_launches
from tools.interfaces.table import read_packed

START = "## Parameters and launch files\n"
_TEXT = """
Parameters come from the YAML files of generate_parameter_library and from what C++ and Python code
declares or asks for, launched nodes from launch files in Python, XML and YAML. `python -m
tools.interfaces.parameter_tables` reads both from checkouts; each fact has its repository, tag or
commit, file and line. A *difference* is a parameter of ours that a release lacks, another default,
or a text of the sources that looks like a name and is not in our table. *Corrected* are those that
our table no longer has, *excepted* those with a reason in `parameters_exceptions.tsv`.

| release | parameters | texts | bounded | differences | corrected | excepted |
|---|--:|--:|--:|--:|--:|--:|
"""
_LAUNCH = """
Our node sets against the launch files that start them (`launched_node_sets.yaml`).

| release | launched nodes | components | differences | corrected | excepted |
|---|--:|--:|--:|--:|--:|
"""
_SOURCES = """
| repository | humble | jazzy | kilted | lyrical | rolling |
|---|---|---|---|---|---|
"""


def section(tables: Path) -> str:
    """Return the section, from the tables of a folder."""
    facts = {
        it: read_parameters(read_packed(tables / f"parameters_{it}.tsv.xz")) for it in RELEASES
    }
    rows = "".join(_row(tables, release, facts[release]) for release in RELEASES)
    launches = "".join(_launches(tables, release) for release in RELEASES)
    return START + _TEXT + rows + _LAUNCH + launches + _SOURCES + "".join(_versions(facts))


def _row(tables: Path, release: str, facts: tuple[ParameterFact, ...]) -> str:
    ours = our_parameters(every_release().parameters.values())
    left = len({it.key for it in differences(ours, facts, release, plugin_owners().below)})
    corrected = _corrected(tables / "parameters_corrected.tsv", release)
    counts = (
        len({(it.package, it.owner, it.path) for it in facts}),
        len({(it.package, it.owner, it.path) for it in facts if it.type.startswith("string")}),
        sum(bool(it.bounds) for it in facts),
        left + corrected,
        corrected,
        left,
    )
    return f"| {release} | {' | '.join(map(str, counts))} |\n"


def _launches(tables: Path, release: str) -> str:
    """Return the row of a release about launch files."""
    facts = read_launches(read_packed(tables / f"launch_{release}.tsv.xz"))
    node_sets = files("multibot_rewrite.knowledge").joinpath("node_sets.yaml").read_text("utf-8")
    left = sum(
        1
        for node_set, paths in launch_files().items()
        for _ in launch_differences(
            node_set, nodes_of_sets(node_sets, node_set, release), facts, paths
        )
    )
    corrected = _corrected(tables / "launch_corrected.tsv", release)
    components = sum(it.node.kind == "component" for it in facts)
    counts = (len(facts), components, left + corrected, corrected, left)
    return f"| {release} | {' | '.join(map(str, counts))} |\n"


def _corrected(table: Path, release: str) -> int:
    """Return the differences that a table has for a release, in its last column."""
    return sum(release in it.rpartition("\t")[2].split() for it in _text(table).splitlines())


def _versions(facts: dict[str, tuple[ParameterFact, ...]]) -> Iterator[str]:
    versions = {
        (it.place.repository, release): it.place.version
        for release, found in facts.items()
        for it in found
    }
    for repository in sorted({repository for repository, _ in versions}):
        cells = (versions.get((repository, release), "") for release in RELEASES)
        yield f"| {repository} | {' | '.join(cells)} |\n"


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8")
