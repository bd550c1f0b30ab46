# SPDX-License-Identifier: Apache-2.0
"""The parameters that nodes declare: by the sources of their packages where those are there, else by
installed NoDL documents and by what is known."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.outside import outside
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.description.sources.packages import entries, package_folder
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.knowledge.declared import (
    DEMANDED,
    YAML,
    Declared,
    declared_by,
    says_something,
)
from multibot_rewrite.knowledge.nodl.lookup import Identity, file_of, find_interfaces, load
from multibot_rewrite.knowledge.records import NodeParameters
from multibot_rewrite.rules.files.parameter_files import file_parameters

NODL = "nodl"
# Folders of a package that have files of generate_parameter_library, and what those are called.
_FOLDERS = ("src", "param", "params", "parameters", "config", "include", "")
_CALLED = lazy_compile(r".*param(?!.*?param)\w*\.ya?ml")


def facts_of_node(
    node: NodeParameters | None, type_: str, file: str, roots: tuple[str, ...]
) -> tuple[Declared, ...]:
    """What the packages of a node declare: its own sources if they are there; ``type_`` is a
    controller's."""
    named = type_.partition("/")[0] if "/" in type_ else ""
    package = node.package if node else named
    own = _in_sources(package, file, roots) if package else ()
    if own:
        return own
    if node is None:
        return ()
    # What one class of a package, or one of its nodes, demands beside the others.
    one = (type_,) if named else (f"{node.package}/{node.name}",)
    others = {it.partition("/")[0] for it in node.types} - {node.package, named}
    shared = (it for it in node.declared_in if not named or it not in others)
    owners = (node.package, *shared, *one)
    known = (it for owner in owners for it in declared_by(owner))
    return (*_in_nodl(node), *known)


def _in_nodl(node: NodeParameters) -> Iterator[Declared]:
    """What the installed NoDL document of a node declares."""
    for path, type_ in nodl_parameters(node.package, node.name):
        if says_something(path):
            yield Declared(path, type_, "", "", NODL, f"NoDL of {node.package}/{node.name}")


@outside
def nodl_parameters(package: str, node: str) -> tuple[tuple[str, str], ...]:
    """Names and types of the parameters in the installed NoDL document of a node; none without one, or
    where it cannot be read, which ``multibot plan`` tells."""
    try:
        installed = find_interfaces(())
        file = file_of(installed, Identity(package, node))
        found = load(file, installed).parameters if file else ()
    except (UsageError, OSError):
        return ()
    return tuple((it.name, it.type) for it in found)


def _in_sources(package: str, file: str, roots: tuple[str, ...]) -> tuple[Declared, ...]:
    """What the files of generate_parameter_library of a package declare, where its sources are."""
    folder = package_folder(package, file, roots)
    found: list[Declared] = []
    for path in _parameter_files(folder) if folder else ():
        try:
            text = read_file(path).decode()
        except (InputError, UnicodeDecodeError):
            continue
        known = "type:" in text and "ros__parameters" not in text
        found += (
            Declared(it.path, it.type, it.bounds, "", YAML, f"{path}:{it.line}")
            for it in (file_parameters(text) if known else ())
            if says_something(it.path)
        )
    return tuple(found)


def _parameter_files(folder: str) -> Iterator[str]:
    for place in _FOLDERS:
        inner = os.path.join(folder, place) if place else folder
        for name in sorted(entries(inner)):
            if _CALLED.fullmatch(name):
                yield os.path.join(inner, name)


def of_release(facts: Sequence[Declared], release: str) -> list[Declared]:
    """Those that the release has."""
    return [it for it in facts if has_release(it.releases, release)]


def of_parameter(facts: Sequence[Declared], release: str) -> list[Declared]:
    """The same of one parameter: what is demanded of it counts where the release declares it at all."""
    found = of_release(facts, release)
    elsewhere = any(it.how != DEMANDED for it in facts)
    return [] if elsewhere and all(it.how == DEMANDED for it in found) else found
