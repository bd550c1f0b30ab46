"""The parameters that nodes declare: by the sources of their packages where those are there, else by
installed NoDL documents and by what is known.

``parameters.tsv`` is made by ``python -m tools.interfaces.known_parameter_table``.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from importlib.resources import files

from multibot_rewrite.knowledge.nodl.lookup import Identity, file_of, find_interfaces, load
from multibot_rewrite.knowledge.parameters import KnownNode
from multibot_rewrite.model import InputError, UsageError
from multibot_rewrite.outside import outside
from multibot_rewrite.record import NamedTuple
from multibot_rewrite.releases import has_release
from multibot_rewrite.rules.files.parameter_files import READ, YAML, file_parameters
from multibot_rewrite.rules.files.parameter_owners import owners
from multibot_rewrite.sources.packages import entries, package_folder
from multibot_rewrite.sources.read import read_file

NODL = "nodl"
# Folders of a package that have files of generate_parameter_library, and what those are called.
_FOLDERS = ("src", "param", "params", "parameters", "config", "include", "")
_CALLED = re.compile(r".*param\w*\.ya?ml")
_WILD = re.compile(r"<[^>]*>")
# A name that is put together at run time says nothing.
_ANY = re.compile(r"(?:<[^>]*>\.?)*")
_CHECK = re.compile(r"([\w:]+?)\((.*?)\)(?=\s[\w:]+\(|$)")


class Fact(NamedTuple):
    """A parameter as its package declares it: ``pattern`` matches its names, ``type`` is empty where it
    is not known, ``bounds`` are checks of generate_parameter_library, which ``is_checked`` says has it;
    ``is_declared`` is false for one that is only read."""

    path: str
    pattern: re.Pattern[str]
    type: str
    bounds: tuple[tuple[str, str], ...]
    releases: str
    is_declared: bool
    is_checked: bool
    source: str


def facts_of_node(
    node: KnownNode | None, type_: str, file: str, roots: tuple[str, ...]
) -> tuple[Fact, ...]:
    """What the packages of a node declare: its own sources if they are there; ``type_`` is a
    controller's."""
    named = type_.partition("/")[0] if "/" in type_ else ""
    package = node.package if node else named
    own = _in_sources(package, file, roots) if package else ()
    if own:
        return own
    if node is None:
        return ()
    packages = (node.package, *owners().also.get(node.name, ()))
    known = (it for package in packages for it in known_facts().get(package, ()))
    return (*_in_nodl(node), *known)


def _in_nodl(node: KnownNode) -> Iterator[Fact]:
    """What the installed NoDL document of a node declares."""
    for path, type_ in nodl_parameters(node.package, node.name):
        yield from make_facts(path, type_, "", "", NODL, f"NoDL of {node.package}/{node.name}")


@outside
def nodl_parameters(package: str, node: str) -> tuple[tuple[str, str], ...]:
    """Names and types of the parameters in the installed NoDL document of a node; none without one, or
    where it cannot be read, which ``multibot remap`` tells."""
    try:
        installed = find_interfaces(())
        file = file_of(installed, Identity(package, node))
        found = load(file, installed).parameters if file else ()
    except (UsageError, OSError):
        return ()
    return tuple((it.name, it.type) for it in found)


@lru_cache
def known_facts() -> Mapping[str, tuple[Fact, ...]]:
    """The facts of ``parameters.tsv`` by package."""
    text = files("multibot_rewrite.rules.files").joinpath("parameters.tsv").read_text("utf-8")
    below, found = owners().below, dict[str, list[Fact]]()
    for line in text.splitlines():
        package, path, type_, bounds, releases, how, source = line.split("\t")
        whole = f"{below[package]}.{path}" if package in below else path
        its = found.setdefault(package, [])
        its += make_facts(whole, type_, bounds, releases, how, source)
    return {package: tuple(its) for package, its in found.items()}


def make_facts(
    path: str, type_: str, bounds: str, releases: str, how: str, source: str
) -> Iterator[Fact]:
    """The fact of a row; none for a name that says nothing."""
    if not _ANY.fullmatch(path):
        pattern = ".+".join(map(re.escape, _WILD.split(path)))
        checks = tuple((it[1], it[2]) for it in _CHECK.finditer(bounds))
        own = how == YAML
        yield Fact(
            path,
            re.compile(pattern),
            type_,
            checks if own else (),
            releases,
            how != READ,
            own,
            source,
        )


def _in_sources(package: str, file: str, roots: tuple[str, ...]) -> tuple[Fact, ...]:
    """What the files of generate_parameter_library of a package declare, where its sources are."""
    folder = package_folder(package, file, roots)
    found: list[Fact] = []
    for path in _parameter_files(folder) if folder else ():
        try:
            text = read_file(path).decode()
        except (InputError, UnicodeDecodeError):
            continue
        for it in (
            file_parameters(text) if "type:" in text and "ros__parameters" not in text else ()
        ):
            found += make_facts(it.path, it.type, it.bounds, "", YAML, f"{path}:{it.line}")
    return tuple(found)


def _parameter_files(folder: str) -> Iterator[str]:
    for place in _FOLDERS:
        inner = os.path.join(folder, place) if place else folder
        for name in sorted(entries(inner)):
            if _CALLED.fullmatch(name):
                yield os.path.join(inner, name)


def of_release(facts: Sequence[Fact], release: str) -> list[Fact]:
    """Those that the release has."""
    return [it for it in facts if has_release(it.releases, release)]
