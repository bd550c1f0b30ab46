# SPDX-License-Identifier: Apache-2.0
"""Parameters that a helper class of a plugin reads, named by a prefix that the plugin gives it.

``SensorModel3 accel;`` and ``accel.Load(_sdf, "accel")`` read ``accelOffset`` where the header of the
class has ``prefix + "Offset"``. Without a prefix they are called by the default that the header has,
else ``offset``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from tools.interfaces.plugin_parameters import ANY, Parameter, declared_types, type_of

_CLASS = re.compile(r"^\s*class\s+(\w+)", re.MULTILINE)
_READS = re.compile(r"\b_?prefix\s*\+\s*\"(\w+)\"")
_FILLS = re.compile(r"\b_?prefix\s*\+\s*\"(\w+)\"\)->GetValue\(\)->Get\((\w+)\)")
_DEFAULT = re.compile(r"\b_?prefix\s*=\s*\"(\w+)\"")
_OTHER_NAME = re.compile(r"\btypedef\s+(\w+)<\s*([\w:]+)\s*>\s+(\w+)\s*;")
_MEMBER = re.compile(r"^\s*(\w+)\s+(\w+)\s*;", re.MULTILINE)
_LOADS = re.compile(r"\b(\w+)\.Load\((?:\s*\w+\s*,)*\s*_?sdf\b\s*(?:,\s*\"(\w+)\"\s*)?\)")


class _Helper(NamedTuple):
    """A class: the prefix that it has by default, where it reads each
    suffix, the types of some, the type of all others."""

    path: str
    default: str
    suffixes: Mapping[str, int]
    types: Mapping[str, str]
    type: str = ANY


def by_prefix(
    code: Mapping[str, str], headers: Mapping[str, str]
) -> tuple[list[Parameter], set[str]]:
    """Return what the files of a plugin have helpers read, and the prefixes, which are no
    parameters; all files are given as path and text."""
    helpers = _helpers(headers)
    members = {
        name: class_
        for text in (*headers.values(), *code.values())
        for class_, name in _MEMBER.findall(text)
        if class_ in helpers
    }
    loads = [it for text in code.values() for it in _LOADS.findall(text) if it[0] in members]
    found = [it for name, prefix in loads for it in _parameters(helpers[members[name]], prefix)]
    return found, {prefix for _, prefix in loads}


def _parameters(helper: _Helper, prefix: str) -> Iterator[Parameter]:
    start = prefix or helper.default
    for suffix, line in helper.suffixes.items():
        name = start + suffix if start else suffix[0].lower() + suffix[1:]
        yield Parameter(name, helper.types.get(suffix, helper.type), helper.path, line)


def _helpers(headers: Mapping[str, str]) -> dict[str, _Helper]:
    """Return the classes that read by a prefix, by each of their names."""
    found: dict[str, _Helper] = {}
    for path, text in headers.items():
        suffixes: dict[str, int] = {}
        for it in _READS.finditer(text):
            suffixes.setdefault(it[1], text.count("\n", 0, it.start()) + 1)
        class_, default = _CLASS.search(text), _DEFAULT.search(text)
        if not suffixes or not class_:
            continue
        types = declared_types(text)
        typed = {suffix: types[it] for suffix, it in _FILLS.findall(text) if it in types}
        helper = _Helper(path, default[1] if default else "", suffixes, typed)
        found[class_[1]] = helper
        for template, type_, name in _OTHER_NAME.findall(text):
            if template == class_[1]:
                found.setdefault(name, helper._replace(type=type_of(type_)))
    return found
