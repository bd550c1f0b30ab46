# SPDX-License-Identifier: Apache-2.0
"""A rewritten parameter file -> the parameters of one node, with the types that rcl gives them.

Sources: rcl_yaml_param_parser ``parse.c`` (``get_value``); rclcpp and rclpy for which sections match.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Any

import yaml

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.related_files.params.sections import is_for, raw_sections, settings
from multibot_rewrite.related_files.yaml_text import YamlText, refused
from multibot_rewrite.system.parameters import Scalar, Value

# rcl compares these words, in these capitalisations only.
_TRUE = frozenset(["Y", "y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON"])
_FALSE = frozenset(["N", "n", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF"])
_DOTTED = lazy_compile(r"[+-]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)")
# strtoll with base 0, and strtod: what they take whole.
_INTEGER = lazy_compile(r"([+-]?)(?:(0[xX][0-9a-fA-F]+)|(0[0-7]*)|([1-9][0-9]*))")
_FLOAT = lazy_compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_HEX_FLOAT = lazy_compile(
    r"[+-]?0[xX](?:[0-9a-fA-F]+(?:\.[0-9a-fA-F]*)?|\.[0-9a-fA-F]+)(?:[pP][+-]?[0-9]+)?"
)
_NO_NUMBER = lazy_compile(r"([+-]?(?:inf|infinity|nan))(?:\([A-Za-z0-9_]*\))?", re.IGNORECASE)
_STRING = "tag:yaml.org,2002:str"
_SMALLEST = 2.2250738585072014e-308
# Characters that JSON allows unescaped, but YAML does not.
_ESCAPED = {code: f"\\u{code:04x}" for code in (*range(0x7F, 0xA0), 0x2028, 0x2029, 0xFEFF)}


def parameters_text(nodes: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the parameter file of nodes, by full name or pattern, as JSON."""
    # rcl reads that as YAML, and never takes its strings for another type.
    data = {full: {"ros__parameters": dict(values)} for full, values in nodes.items()}
    return json.dumps(data, ensure_ascii=False).translate(_ESCAPED)


def node_parameters(document: YamlText, full: str) -> dict[str, Value]:
    """Return the parameters of the node with this full name, by their dotted names.

    Wildcard sections count as in rcl: in the order of their first appearance, a later one wins. Raises
    InputError for a value that rcl rejects.
    """
    sections: dict[str, dict[str, Value]] = {}
    for found in raw_sections(document):
        if is_for(found.path, full):
            sections.setdefault(found.path, {}).update(_flat_settings(document, found.body))
    return {name: value for section in sections.values() for name, value in section.items()}


def check_values(document: YamlText) -> None:
    """Read every value of a parameter file; InputError for one that rcl rejects."""
    for found in raw_sections(document):
        for _ in _flat_settings(document, found.body):
            pass


def exact_nodes(document: YamlText) -> list[str]:
    """Return the full names of the nodes that have a section of their own."""
    paths = dict.fromkeys(found.path for found in raw_sections(document))
    return [f"/{path}" for path in paths if "*" not in path]


def _flat_settings(document: YamlText, body: yaml.Node) -> Iterator[tuple[str, Value]]:
    return ((name, value_of(document, node)) for name, _, node in settings(body))


def value_of(document: YamlText, node: yaml.Node) -> Value:
    """Return the value that rcl reads from a YAML node."""
    if isinstance(node, yaml.ScalarNode):
        return _scalar_value(document, node)
    assert isinstance(node, yaml.SequenceNode)
    if not all(isinstance(item, yaml.ScalarNode) for item in node.value):
        what = "a list holds a list or a map; rcl takes single values only"
        raise refused(document, node, what)
    items = [_scalar_value(document, item) for item in node.value]
    if len({type(item) for item in items}) > 1:
        what = "the list mixes types, which rcl rejects; write all as floats, or quote all"
        raise refused(document, node, what)
    return items


def _scalar_value(document: YamlText, node: yaml.ScalarNode) -> Scalar:
    tagged = document.text.startswith("!", node.start_mark.index) and node.tag == _STRING
    if tagged or node.style in ("'", '"'):
        return str(node.value)
    if not node.value:
        raise refused(document, node, 'the value is missing; write "" for an empty string')
    return typed(node.value)


@lru_cache(maxsize=2**14)
def typed(text: str) -> Scalar:
    """Return the value that rcl reads from an unquoted scalar."""
    if text in _TRUE or text in _FALSE:
        return text in _TRUE
    whole = _INTEGER.fullmatch(text)
    if whole:
        _, hexadecimal, octal, _ = whole.groups()
        number = int(text, 16 if hexadecimal else 8 if octal else 10)
        if -(2**63) <= number < 2**63:
            return number
    if _DOTTED.fullmatch(text):
        return float(text.replace(".", "", 1))
    named = _NO_NUMBER.fullmatch(text)
    if named and (text[-1] != ")" or "n(" in text.lower()):
        return float(named[1])
    if _HEX_FLOAT.fullmatch(text):
        amount = float.fromhex(text)
    elif _FLOAT.fullmatch(text):
        amount = float(text)
    else:
        return text
    # strtod reports what does not fit into a double; rcl then takes the text.
    lost = math.isinf(amount) or 0 < abs(amount) < _SMALLEST
    lost = lost or (amount == 0 and any(it in "123456789" for it in text.lower().partition("e")[0]))
    return text if lost else amount
