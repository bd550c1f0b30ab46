# SPDX-License-Identifier: Apache-2.0
"""``python -m tools.interfaces.parameter_tables TABLES RELEASE FOLDER...``: read sources.

Each FOLDER is a checkout of a tag or commit and is called REPOSITORY@VERSION, with + for a slash in
REPOSITORY. ``parameters_RELEASE.tsv.xz`` and ``launch_RELEASE.tsv.xz`` are written to TABLES.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Iterator
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.knowledge.declared import READ, YAML
from multibot_rewrite.producers.sources.cpp import read_cpp
from multibot_rewrite.producers.sources.records import Place
from multibot_rewrite.rules.files.parameter_files import file_parameters
from tools.interfaces.declared_parameters import (
    cpp_parameters,
    python_parameters,
    shared_constants,
)
from tools.interfaces.launch_files import LaunchedNode, launched_nodes
from tools.interfaces.parameter_facts import PLACE_COLUMNS, ParameterFact, parameter_lines
from tools.interfaces.table import write_packed

_CPP = (".cpp", ".cc", ".hpp", ".h")
_LAUNCH = (".py", ".xml", ".yaml", ".yml", ".launch")
# Folders whose nodes nobody starts on a robot.
_NOT_FOR_ROBOTS = ("test", "tests", "examples", "benchmarks", "tutorials", "doc")


class LaunchFact(NamedTuple):
    """A node that a package's launch file starts."""

    package: str
    node: LaunchedNode
    place: Place


class Checkout(NamedTuple):
    """A repository's folder; ``origin`` is a place with its name and version alone."""

    folder: Path
    origin: Place


def checkout_of(folder: Path) -> Checkout:
    """Return a folder by its name; raises UsageError for what is no checkout."""
    name, _, version = folder.name.partition("@")
    if not folder.is_dir() or not version:
        raise UsageError(f"{folder}: not a folder called REPOSITORY@VERSION")
    return Checkout(folder, Place(name.replace("+", "/"), version, "", 0))


def parameters_of(checkout: Checkout) -> Iterator[ParameterFact]:
    """Return the parameters of a repository; what is read is left out where it is declared, too."""
    paths = tuple(_files(checkout.folder))
    facts = [fact for path in paths for fact in _of_data(checkout, path)]
    facts += _of_cpp(checkout, [it for it in paths if it.suffix in _CPP])
    declared = {(it.package, it.path) for it in facts if it.how != READ}
    return (it for it in facts if it.how != READ or (it.package, it.path) not in declared)


def launches_of(checkout: Checkout) -> Iterator[LaunchFact]:
    """Yield the nodes that a repository's launch files start."""
    for path in _files(checkout.folder):
        if "launch" in path.name and path.suffix in _LAUNCH:
            place = _place(checkout, path)
            for node in launched_nodes(path.name, _text(path)):
                at = place._replace(line=node.line)
                yield LaunchFact(_package(checkout.folder, path), node, at)


def launch_lines(facts: Iterable[LaunchFact]) -> Iterator[str]:
    """Yield a line for each fact, with tabs between, sorted, each once."""
    for fact in sorted(set(facts)):
        yield "\t".join((fact.package, *fact.node[:-1], *map(str, fact.place[:PLACE_COLUMNS])))


def read_launches(text: str) -> tuple[LaunchFact, ...]:
    """Return the facts of such lines."""
    return tuple(_launch(line.split("\t")) for line in text.splitlines())


def _launch(cells: list[str]) -> LaunchFact:
    package, kind, of, executable, name, namespace, remaps, repository, version, path, line = cells
    node = LaunchedNode(kind, of, executable, name, namespace, remaps, int(line))
    return LaunchFact(package, node, Place(repository, version, path, int(line)))


def _of_cpp(checkout: Checkout, paths: Iterable[Path]) -> Iterator[ParameterFact]:
    """Yield the parameters of C++ files, package by package, since its files share constants."""
    for package, group in groupby(paths, lambda it: _package(checkout.folder, it)):
        texts = ((path, _text(path)) for path in group)
        sources = [
            read_cpp(text, _place(checkout, path))
            for path, text in texts
            if "param" in text.lower()
        ]
        shared = shared_constants(value for it in sources for value in it.values)
        for source in sources:
            yield from cpp_parameters(source, package, shared)


def _of_data(checkout: Checkout, path: Path) -> Iterator[ParameterFact]:
    """Yield the parameters of a Python or YAML file."""
    package, place = _package(checkout.folder, path), _place(checkout, path)
    if path.suffix == ".py" and "launch" not in path.name:
        yield from python_parameters(_text(path), place, package)
    if path.suffix in (".yaml", ".yml"):
        for it in file_parameters(_text(path)):
            at = place._replace(line=it.line)
            yield ParameterFact(
                package, it.owner, it.path, it.type, it.default, it.bounds, it.read_only, YAML, at
            )


def _files(folder: Path) -> Iterator[Path]:
    for path in sorted(folder.rglob("*")):
        parts = path.relative_to(folder).parts
        if path.is_file() and not any(_is_apart(it) for it in parts):
            yield path


def _is_apart(part: str) -> bool:
    word = part.lower().partition(".")[0]
    return word in _NOT_FOR_ROBOTS or word.startswith("test_") or word.endswith("_test")


def _place(checkout: Checkout, path: Path) -> Place:
    return checkout.origin._replace(path=path.relative_to(checkout.folder).as_posix())


def _package(folder: Path, path: Path) -> str:
    """Return the package that a file belongs to: the nearest folder with a package.xml."""
    for above in path.parents:
        if (above / "package.xml").exists():
            return _named(above / "package.xml")
        if above == folder:
            return ""
    return ""


def _named(manifest: Path) -> str:
    """Return the name that a package.xml gives."""
    return _text(manifest).partition("<name>")[2].partition("</name>")[0].strip()


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8", errors="replace")


def main(arguments: list[str]) -> int:
    """Write the two tables; 2 for wrong arguments."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("tables", type=Path, metavar="TABLES")
    parser.add_argument("release", choices=RELEASES, metavar="RELEASE")
    parser.add_argument("folders", nargs="+", type=Path, metavar="FOLDER")
    given = parser.parse_args(arguments)
    try:
        found = [checkout_of(folder) for folder in sorted(given.folders)]
    except UsageError as error:
        print(f"parameter_tables: {error}", file=sys.stderr)
        return 2
    parameters = [fact for it in found for fact in parameters_of(it)]
    launches = [fact for it in found for fact in launches_of(it)]
    _write(given.tables / f"parameters_{given.release}.tsv.xz", parameter_lines(parameters))
    _write(given.tables / f"launch_{given.release}.tsv.xz", launch_lines(launches))
    return 0


def _write(path: Path, lines: Iterable[str]) -> None:
    write_packed(path, "".join(f"{line}\n" for line in lines))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
