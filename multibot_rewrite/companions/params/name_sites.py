"""Every parameter of a section -> the names in it: of what kind, in keys and in values."""

from __future__ import annotations

import re
from typing import NamedTuple

import yaml

from multibot_rewrite.companions.params.known_nodes import Branch, KnownNodes, Param, guess
from multibot_rewrite.companions.params.sections import ParamSection
from multibot_rewrite.companions.yaml_text import YamlText, items, line_of
from multibot_rewrite.model import InputError

STRING = "tag:yaml.org,2002:str"
NULL = "tag:yaml.org,2002:null"
# What rcl takes for a boolean, though PyYAML does not.
_BOOLEANS = frozenset("yYnN")
_NUMBER = re.compile(r"[-+.\d]")
_STEM = re.compile(r"(.*?)\d+")
# Words of a path that hold no name of the robot.
_IDS = frozenset({"id", "*"})
# Nothing at all is what stands before a name that has no prefix yet.
_TAKE_EMPTY = ("link_prefix", "joint_prefix")
_NO_NAMES = frozenset(f"tag:yaml.org,2002:{it}" for it in ("int", "float", "bool"))


class NameSite(NamedTuple):
    """A name: the scalar it stands in, the key of its parameter, its kind and what is known of it.

    ``param`` is None where the kind is a guess. ``at`` is the segment of a key, -1 for a value.
    ``layer`` is the mapping that the parameter stands in.
    """

    scalar: yaml.ScalarNode
    key: yaml.ScalarNode
    kind: str
    param: Param | None
    value: str
    at: int
    layer: yaml.MappingNode


class SectionNames(NamedTuple):
    """What a section holds: names, parameters by their known path, scalars that nothing is known
    of, keys without a value, keys that stand in one mapping twice, and keys that nothing is known of.
    """

    names: list[NameSite]
    known: set[str]
    unclaimed: list[yaml.ScalarNode]
    empty: list[yaml.ScalarNode]
    twice: list[yaml.ScalarNode]
    keys: list[yaml.ScalarNode]


# Where the path so far leads to, and the names in its keys: key, segment and what it is.
_Mark = tuple[yaml.ScalarNode, int, str]
_State = tuple[Branch, tuple[_Mark, ...]]


def find_names(document: YamlText, section: ParamSection, known: KnownNodes) -> SectionNames:
    """Look at every parameter of a section; InputError for keys that are no words."""
    uses = SectionNames([], set(), [], [], [], [])
    tree = section.node.tree if section.node else known.anywhere
    _walk(document, section.body, [(tree, ())], known, uses)
    return uses


def _walk(
    document: YamlText,
    body: yaml.MappingNode,
    states: list[_State],
    known: KnownNodes,
    uses: SectionNames,
) -> None:
    seen = set()
    for key, value in body.value:
        if not isinstance(key, yaml.ScalarNode):
            place = f"{document.file}:{line_of(key)}"
            raise InputError(f"{place}: a key is a mapping or a list; write a name")
        if key.value in seen:
            uses.twice.append(key)
        seen.add(key.value)
        below = _below(states, key.value, key) if states else states
        if not below:
            uses.keys.append(key)
        if isinstance(value, yaml.MappingNode):
            _walk(document, value, below, known, uses)
        # Most parameters are numbers that nothing is known of.
        elif below or value.tag not in _NO_NAMES:
            _claim(key, value, below, body, known, uses)


def _below(states: list[_State], word: str, key: yaml.ScalarNode, at: int = 0) -> list[_State]:
    if "." in word:
        for place, part in enumerate(word.split(".")):
            states = _below(states, part, key, place)
        return states
    found: list[_State] = []
    for branch, marks in states:
        child = branch.exact.get(word)
        if child:
            found.append((child, marks))
        if branch.numbered and (stem := _STEM.fullmatch(word)) and stem[1] in branch.numbered:
            found.append((branch.numbered[stem[1]], marks))
        for kind, child in branch.wild.items():
            found.append((child, marks if kind in _IDS else (*marks, (key, at, kind))))
    return found


def _claim(
    key: yaml.ScalarNode,
    value: yaml.Node,
    states: list[_State],
    layer: yaml.MappingNode,
    known: KnownNodes,
    uses: SectionNames,
) -> None:
    """What one parameter is: one that is known, one that its name tells, or an unclaimed one."""
    if value.tag == NULL and not value.value:
        uses.empty.append(key)
    param = None
    for branch, marks in states:
        if branch.params:
            param = branch.params[0]
            uses.known.add(param.path)
            for mark, at, kind in marks:
                word = mark.value.split(".")[at]
                uses.names.append(NameSite(mark, mark, kind, param, word, at, layer))
            break
    if param is None or param.kind != "keep":
        _values(key, items(value), param, layer, known, uses)


def _values(
    key: yaml.ScalarNode,
    scalars: list[yaml.Node],
    param: Param | None,
    layer: yaml.MappingNode,
    known: KnownNodes,
    uses: SectionNames,
) -> None:
    kind = param.kind if param else ""
    for scalar in scalars:
        if not isinstance(scalar, yaml.ScalarNode):
            continue
        # Theirs may be booleans and numbers.
        text = str(scalar.value) if kind in ("off", "exclusive") else name_in(scalar)
        if not text and not (scalar.style and kind in _TAKE_EMPTY):
            continue
        kind = kind or guess(known, key.value)
        if kind:
            uses.names.append(NameSite(scalar, key, kind, param, text, -1, layer))
        else:
            uses.unclaimed.append(scalar)


def name_in(scalar: yaml.ScalarNode) -> str:
    """The text of a scalar where rcl reads it as a string too; empty where it does not."""
    text = str(scalar.value)
    if scalar.tag != STRING or (text in _BOOLEANS and not scalar.style):
        return ""
    if scalar.style:
        return text
    return "" if _NUMBER.match(text) and _is_number(text) else text


def _is_number(text: str) -> bool:
    # 1e-9 is a string for PyYAML and a number for rcl.
    try:
        float(text)
    except ValueError:
        return False
    return True
