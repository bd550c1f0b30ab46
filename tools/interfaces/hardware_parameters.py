# SPDX-License-Identifier: Apache-2.0
"""C++ of ros2_control hardware -> the ``<param>``s that a class reads of its ``<hardware>``."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from lxml import etree

from multibot_rewrite.producers.sources.expressions import last, nodes_of, text_of
from tools.interfaces.plugin_demands import is_conditional
from tools.interfaces.plugin_parameters import ANY, Parameter

if TYPE_CHECKING:
    from multibot_rewrite.producers.sources.expressions import Node

_BASES = ("SystemInterface", "ActuatorInterface", "SensorInterface")
_KEY = re.compile(
    r"hardware_parameters\s*(?:\)\s*)?(?:(?:\.|->)\s*(?:at|find|count|contains)\s*\(|\[)\s*\"(\w+)\""
    r"|\bget_hardware_parameter\w*\s*(?:<\w+>)?\(\s*\"(\w+)\""
)
# The class itself may have a reader of its own, which takes the name.
_READER = re.compile(
    r"\b(?:get_?param\w*|get_?hardware_?param\w*|param_or|readParam\w*)\s*(?:<[\w:]+>)?"
    r"\s*\(\s*(?:\w+\s*,\s*)?\"(\w+)\"",
    re.IGNORECASE,
)
_TYPES = (
    (re.compile(r"\bsto[df]\s*\("), "number"),
    (re.compile(r"\b(?:stoi|stol|stoul|stoull)\s*\("), "integer"),
    (re.compile(r"parse_bool|== \"[Tt]rue\"|as_bool"), "boolean"),
)
_AT = re.compile(r"[\w.>-]*\bhardware_parameters\.at\(\"(\w+)\"\)")
_SKIPPED = {"test", "tests"}


def read_hardware(folder: Path) -> Iterator[tuple[str, str, tuple[Parameter, ...]]]:
    """Each hardware class of a checkout: its name, the folder of its package, its parameters."""
    for path in sorted(folder.rglob("*.xml")):
        if _SKIPPED & set(path.relative_to(folder).parts) or path.name == "package.xml":
            continue
        names = list(_classes(path))
        package = _package(path, folder)
        for name, type_ in names:
            where = package.relative_to(folder).as_posix()
            yield name, where, tuple(_parameters(package, folder, type_.rpartition("::")[2]))


def _classes(path: Path) -> Iterator[tuple[str, str]]:
    try:
        root = etree.parse(str(path)).getroot()
    except etree.XMLSyntaxError:
        return
    for it in root.iter("class"):
        if it.get("base_class_type", "").endswith(_BASES):
            yield it.get("name") or it.get("type", "").replace("::", "/"), it.get("type", "")


def _package(path: Path, folder: Path) -> Path:
    return next((it for it in path.parents if (it / "package.xml").exists()), folder)


def _parameters(package: Path, folder: Path, class_: str) -> Iterator[Parameter]:
    """Yield what the files of a package read: base classes and helpers count; what is required, only in
    those that mention the class."""
    found: dict[str, Parameter] = {}
    for path in sorted(package.rglob("*")):
        if path.suffix not in (".cpp", ".hpp", ".cc", ".h") or _SKIPPED & set(path.parts):
            continue
        text = path.read_text(encoding="utf-8", errors="replace")
        needed = set(_required(text)) if class_ in text else set()
        for it in (one for pattern in (_KEY, _READER) for one in pattern.finditer(text)):
            name = next(filter(None, it.groups()))
            place = path.relative_to(folder).as_posix(), text.count("\n", 0, it.start()) + 1
            type_ = _type(text, it.start(), it.end())
            if name not in found or found[name].type == ANY:
                found[name] = Parameter(name, type_, *place, required=name in needed)
    yield from (found[name] for name in sorted(found))


def _type(text: str, start: int, end: int) -> str:
    """Return the type by the statement that reads it."""
    before = max(text.rfind(sign, 0, start) for sign in ";{}")
    statement = text[before + 1 : text.find(";", end)]
    return next((type_ for pattern, type_ in _TYPES if pattern.search(statement)), ANY)


def _required(text: str) -> Iterator[str]:
    """Yield what ``on_init`` asks with ``at``, which throws, whatever else is given."""
    for call in nodes_of(text, ("call_expression",)):
        asked = _AT.fullmatch(text_of(call))
        if asked and _function_of(call) == "on_init" and not is_conditional(call):
            yield asked[1]


def _function_of(node: Node) -> str:
    """Return the name of the function that a node is in."""
    above = node.parent
    while above is not None and above.type != "function_definition":
        above = above.parent
    declarator = above.child_by_field_name("declarator") if above is not None else None
    return last(text_of(declarator).partition("(")[0])
