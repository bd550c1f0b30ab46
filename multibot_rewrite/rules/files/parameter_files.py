# SPDX-License-Identifier: Apache-2.0
"""The parameters that nodes declare: by the sources of their packages where those are there, which
generate_parameter_library reads as YAML files, else by installed NoDL documents and by what is
known.

Source: https://github.com/PickNikRobotics/generate_parameter_library (README, "YAML Syntax").
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import yaml

from multibot_rewrite.base.bounded import compose_yaml
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.outside import outside
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.companions.yaml_text import pairs
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

# The types of parameters; an array may have a length behind it: double_array_fixed_6.
_TYPES = ("bool", "double", "int", "string", "none")
_MAP = "__map_"
NO_DEFAULT = ""
EMPTY = '""'


class FileParameter(NamedTuple):
    """A parameter of such a file; ``owner`` is the file's top key."""

    owner: str
    path: str
    type: str
    default: str
    bounds: str
    read_only: str
    line: int


def file_parameters(text: str) -> tuple[FileParameter, ...]:
    """Return the parameters of a file; empty if it is another kind of YAML."""
    try:
        root = compose_yaml(text, "")
    except InputError:
        return ()
    found = (it for owner, below in pairs(root) for it in _parameters(owner.value, below, ()))
    return tuple(it for it in found if it.path)


def _parameters(owner: str, node: yaml.Node, path: tuple[str, ...]) -> Iterator[FileParameter]:
    keys = {key.value: value for key, value in pairs(node)}
    type_ = keys.get("type")
    if isinstance(type_, yaml.ScalarNode) and type_.value.partition("_")[0] in _TYPES:
        made = yaml.SafeLoader("").construct_object
        given = {key: made(value, deep=True) for key, value in keys.items()}
        yield FileParameter(
            owner,
            ".".join(path),
            str(given["type"]),
            text_of(given.get("default_value")),
            _bounds(given.get("validation")),
            "read_only" if given.get("read_only") is True else "",
            node.start_mark.line + 1,
        )
        return
    for key, below in pairs(node):
        word = key.value
        # ``__map_joints`` stands for each of the names in the parameter ``joints``.
        step = f"<{word.removeprefix(_MAP)}>" if word.startswith(_MAP) else word
        yield from _parameters(owner, below, (*path, step))


def _bounds(validation: object) -> str:
    """Return ``gt_eq(0.0) size_lt([5])``: each check with its arguments."""
    if not isinstance(validation, dict):
        return ""
    words = (f"{str(name).removesuffix('<>')}({text_of(it)})" for name, it in validation.items())
    return " ".join(sorted(words))


def text_of(value: object) -> str:
    """Return a default as it is written in tables."""
    if value is None:
        return NO_DEFAULT
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list | tuple):
        return f"[{', '.join(text_of(it) for it in value)}]"
    return " ".join(str(value).split()) or EMPTY


NODL = "nodl"
# Folders of a package that have files of generate_parameter_library, and what those are called.
_FOLDERS = ("src", "param", "params", "parameters", "config", "include", "")
_CALLED = lazy_compile(r".*param(?!.*?param)\w*\.ya?ml")


def facts_of_node(
    node: NodeParameters | None, type_: str, file: str, roots: tuple[str, ...]
) -> tuple[Declared, ...]:
    """Return what the packages of a node declare, from its own sources if they are there. ``type_``
    is that of a controller."""
    named = type_.partition("/")[0] if "/" in type_ else ""
    package = node.package if node else named
    own = _in_sources(package, file, roots) if package else ()
    if own or node is None:
        return own
    # What one class of a package, or one of its nodes, demands beside the others.
    one = (type_,) if named else (f"{node.package}/{node.name}",)
    others = {it.partition("/")[0] for it in node.types} - {node.package, named}
    shared = (it for it in node.declared_in if not named or it not in others)
    owners = (node.package, *shared, *one)
    known = (it for owner in owners for it in declared_by(owner))
    # What the installed NoDL document of the node declares.
    given = nodl_parameters(node.package, node.name)
    source = f"NoDL of {node.package}/{node.name}"
    said = (Declared(*it, "", "", NODL, source) for it in given if says_something(it[0]))
    return (*said, *known)


@outside
def nodl_parameters(package: str, node: str) -> tuple[tuple[str, str], ...]:
    """Return names and types of the parameters in the installed NoDL document of a node; none
    without one, or if it cannot be read, which ``multibot plan`` reports."""
    try:
        installed = find_interfaces(())
        file = file_of(installed, Identity(package, node))
        found = load(file, installed).parameters if file else ()
    except (UsageError, OSError):
        return ()
    return tuple((it.name, it.type) for it in found)


def _in_sources(package: str, file: str, roots: tuple[str, ...]) -> tuple[Declared, ...]:
    """Return the parameters in generate_parameter_library files of a package's sources, if found."""
    folder = package_folder(package, file, roots)
    found: list[Declared] = []
    places = [os.path.join(folder, it) for it in _FOLDERS] if folder else []
    paths = (os.path.join(it, name) for it in places for name in sorted(entries(it)))
    for path in (it for it in paths if _CALLED.fullmatch(os.path.basename(it))):
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


def of_release(facts: Sequence[Declared], release: str) -> list[Declared]:
    """Return those that the release has."""
    return [it for it in facts if has_release(it.releases, release)]


def of_parameter(facts: Sequence[Declared], release: str) -> list[Declared]:
    """Return the facts about one parameter in a release; demands count only where it is declared."""
    found = of_release(facts, release)
    elsewhere = any(it.how != DEMANDED for it in facts)
    return [] if elsewhere and all(it.how == DEMANDED for it in found) else found
