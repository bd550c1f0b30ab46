# SPDX-License-Identifier: Apache-2.0
"""Finds the kind of a MoveIt file, by content or name, and where it holds names (moveit.yaml)."""

import os
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any, NamedTuple

import yaml

from multibot_rewrite.base.bounded import load_own_yaml
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.related_files.names.placeholders import without_robot
from multibot_rewrite.related_files.names.rename_map import KINDS, RelatedNames, is_declared
from multibot_rewrite.related_files.params.sections import PARAMETERS
from multibot_rewrite.related_files.sites import Site, site_at, slot_of
from multibot_rewrite.related_files.yaml_text import YamlText, is_text, pairs, refused

KEEP = "keep"
# The kind of name that a value is, or keys with the shape below each.
Shape = Any
Shapes = Mapping[str, Shape]
_MERGE = "<<"
# What OMPL projects on: joints(a, b).
_EVALUATOR = lazy_compile(r"\s*(?P<kind>joint|link)s?\s*\((?P<names>[^()]*)\)\s*")
_NAME = lazy_compile(r"[^\s,](?:[^,]*[^\s,])?")


class MoveitKind(NamedTuple):
    """A kind of file: keys that identify it, words in its file name, and the shape of its names."""

    name: str
    marks: tuple[str, ...]
    files: tuple[str, ...]
    names: Shapes


class _Walk(NamedTuple):
    names: RelatedNames
    found: list[Site]
    claimed: set[int]
    seen: set[tuple[int, int]]


# The names in a key, and the shape of what is below it.
_Match = tuple[tuple[tuple[int, str, str], ...], Shape]


@cache
def kinds() -> tuple[MoveitKind, ...]:
    """Return all kinds of files, in the order in which they are tried."""
    data = load_own_yaml(__file__, "moveit.yaml")
    return tuple(
        MoveitKind(name, tuple(it["marks"]), tuple(it["files"]), {**data["common"], **it["names"]})
        for name, it in data["kinds"].items()
    )


def find_names(
    root: yaml.Node | None, rules: Shapes, names: RelatedNames
) -> tuple[list[Site], list[Site], list[Site]]:
    """Return three lists: the names below ``root``, texts of unknown use, and repeated keys."""
    # An aliased value counts once for every shape that reaches it.
    walk = _Walk(names, [], set(), set())
    if root is not None:
        _claim_below(root, rules, walk)
    free = (it for it in _scalars(root) if id(it) not in walk.claimed and is_text(it))
    others = [site_at(it, "", str(it.value)) for it in free]
    twice = []
    for node in _nodes(root):
        seen: set[str] = set()
        for key, _ in pairs(node):
            if key.value in seen and not is_merge(key):
                twice.append(site_at(key, "", str(key.value)))
            seen.add(key.value)
    return walk.found, others, twice


def entries(node: yaml.Node | None) -> Iterator[tuple[yaml.ScalarNode, yaml.Node]]:
    """Yield (key, value) of a map's entries, merged ones included."""
    for key, value in pairs(node):
        if not is_merge(key):
            yield key, value
            continue
        for merged in value.value if isinstance(value, yaml.SequenceNode) else [value]:
            if merged is not node:
                yield from pairs(merged)


def is_merge(key: yaml.Node) -> bool:
    """Return whether a key is YAML's merge key ``<<``."""
    return isinstance(key, yaml.ScalarNode) and key.value == _MERGE and not key.style


def _claim_below(node: yaml.Node, rule: Shape, walk: _Walk) -> None:
    if (id(node), id(rule)) in walk.seen:
        return
    walk.seen.add((id(node), id(rule)))
    if rule == KEEP:
        walk.claimed.update(id(it) for it in _scalars(node))
    elif isinstance(node, yaml.SequenceNode):
        for item in node.value:
            _claim_below(item, rule, walk)
    elif isinstance(node, yaml.ScalarNode):
        if isinstance(rule, str) and is_text(node):
            walk.claimed.add(id(node))
            walk.found.extend(_names_in_value(node, rule))
    elif isinstance(rule, Mapping):
        for key, value in entries(node):
            match = _match_of_key(str(key.value), 0, value, rule, walk.names)
            if match is None:
                continue
            marks, below = match
            walk.claimed.add(id(key))
            slot = slot_of(key)
            walk.found.extend(
                Site(kind, without_robot(text), "", slot, at, len(text)) for at, text, kind in marks
            )
            _claim_below(value, below, walk)


def _names_in_value(node: yaml.ScalarNode, kind: str) -> Iterator[Site]:
    """Yield the names in a value: those in ``joints(a, b)``, otherwise its text."""
    slot = slot_of(node)
    found = _EVALUATOR.fullmatch(slot.value) if kind == "words" else None
    if found is None:
        yield Site(kind, without_robot(slot.value), "", slot)
        return
    for it in _NAME.finditer(slot.value, *found.span("names")):
        yield Site(found["kind"], without_robot(it[0]), "", slot, it.start(), len(it[0]))


def _match_of_key(
    word: str, at: int, value: yaml.Node, rules: Shapes, names: RelatedNames
) -> _Match | None:
    """Return the names in a key: nested maps and keys with dots are the same parameter."""
    found = _match_of_known(word, at, value, rules, names)
    if found:
        return found
    for dot in (at_ for at_, letter in enumerate(word) if letter == "."):
        head = _match_of_known(word[:dot], at, None, rules, names) or _match_of_any(
            word[:dot], at, None, rules
        )
        below = _match_of_rest(head, word[dot + 1 :], at + dot + 1, value, names) if head else None
        if below:
            return below
    return _match_of_any(word, at, value, rules)


def _match_of_rest(
    head: _Match, word: str, at: int, value: yaml.Node, names: RelatedNames
) -> _Match | None:
    """Return the match with names in the rest of a key; None if it has no place."""
    marks, rule = head
    if rule == KEEP:
        known = all(_has_name(names, kind, text) for _, text, kind in marks if kind in KINDS)
        return head if known else None
    below = _match_of_key(word, at, value, rule, names) if isinstance(rule, Mapping) else None
    return ((*marks, *below[0]), below[1]) if below else None


def _match_of_known(
    word: str, at: int, value: yaml.Node | None, rules: Shapes, names: RelatedNames
) -> _Match | None:
    """Return the match of a literal key, of a declared name, or of a name known by its contents."""
    if word in rules and word[:1] not in ("<", "*"):
        return (), rules[word]
    for kind, telling, rule in _open_keys(rules):
        if kind in KINDS and _has_name(names, kind, word):
            return ((at, word, kind),), rule
        if not telling or value is None:
            continue
        if "map" in telling:
            tells = isinstance(value, yaml.MappingNode) or value.tag == "tag:yaml.org,2002:null"
        else:
            tells = not {str(key.value) for key, _ in entries(value)}.isdisjoint(telling)
        if tells:
            return ((at, word, kind),), rule
    return None


def _has_name(names: RelatedNames, kind: str, word: str) -> bool:
    """Return whether the description declares a name, without a ``$(var prefix)``."""
    return is_declared(names, kind, without_robot(word))


def _match_of_any(word: str, at: int, value: yaml.Node | None, rules: Shapes) -> _Match | None:
    """Return the match of a key that may be any name."""
    for kind, telling, rule in _open_keys(rules):
        if not telling or (value is None and "declared" not in telling):
            return ((at, word, kind),), rule
    return ((), rules["*"]) if "*" in rules else None


def _open_keys(rules: Shapes) -> Iterator[tuple[str, tuple[str, ...], Shape]]:
    """Yield (kind, names that must be below, rule) of keys such as ``<joint>``."""
    for key, rule in rules.items():
        if key.startswith("<"):
            kind, _, telling = key[1:-1].partition(" if ")
            yield kind, tuple(telling.split()), rule


def _scalars(root: yaml.Node | None) -> Iterator[yaml.ScalarNode]:
    """Yield every scalar once, keys included."""
    for node in _nodes(root):
        if isinstance(node, yaml.ScalarNode) and not is_merge(node):
            yield node


def _nodes(root: yaml.Node | None) -> Iterator[yaml.Node]:
    """Yield every node of a document once."""
    seen: set[int] = set()
    waiting = [root] if root is not None else []
    while waiting:
        node = waiting.pop()
        if id(node) in seen:
            continue
        seen.add(id(node))
        yield node
        if isinstance(node, yaml.MappingNode):
            waiting += [it for pair in node.value for it in pair]
        elif isinstance(node, yaml.SequenceNode):
            waiting += node.value


EMPTY = "empty"
OF_SERVO, PLANNING, SIMPLE = "servo", "planning", "moveit_simple_controller_manager"
# Its controllers.
NAMES = "controller_names"
# Below which parameter MoveItConfigsBuilder puts the content of a file; that of others is at the top.
ABOVE = {
    "kinematics": "robot_description_kinematics",
    "joint_limits": "robot_description_planning",
    OF_SERVO: "moveit_servo",
}
_PIPELINE = "_planning"
# What a file of one pipeline has at its top, whatever it is called.
_OF_PIPELINE = frozenset(("planning_plugin", "planning_plugins", "request_adapters"))
_DEPTH = 4


def file_kind(document: YamlText) -> str:
    """Return the kind of a MoveIt file, or ``empty``; raises InputError for another file."""
    kind = find_kind(document)
    return kind.name if kind else EMPTY


def find_kind(document: YamlText) -> MoveitKind | None:
    """Return the kind of a file, None if it is empty; raises InputError if it is not a MoveIt file."""
    root = document.root
    if root is None or root.tag == "tag:yaml.org,2002:null":
        return None
    if not isinstance(root, yaml.MappingNode):
        what = "not a MoveIt file: it is not a map of keys and values"
        raise refused(document, root, what)
    _refuse_params(document, root, _DEPTH)
    paths = set(_paths(root))
    known = (kind for kind in kinds() if not paths.isdisjoint(kind.marks))
    if kind := next(known, None):
        return kind
    # A file of numbers only holds joint positions.
    values = [value for _, value in entries(root)]
    if values and all(it.tag.endswith((":float", ":int", "!degrees", "!radians")) for it in values):
        return next(kind for kind in kinds() if kind.name == "initial_positions")
    name = os.path.basename(document.file).lower()
    if kind := next((kind for kind in kinds() if any(it in name for it in kind.files)), None):
        return kind
    words = ", ".join(str(key.value) for key, _ in list(entries(root))[:4])
    what = f"not a known kind of MoveIt file: it starts with {words or 'nothing'}; leave it out,"
    raise refused(document, root, f"{what} or list a parameter file under params")


def pipeline_of(path: str) -> str:
    """Return ``ompl`` for ``ompl_planning.yaml``; empty for a file of no pipeline."""
    stem = os.path.splitext(os.path.basename(path))[0]
    return stem.removesuffix(_PIPELINE) if stem.endswith(_PIPELINE) else ""


def parameter_above(kind: MoveitKind, document: YamlText) -> str:
    """Return the prefix of a file's parameters: ``ompl.``, or nothing."""
    keys = {str(key.value) for key, _ in entries(document.root)}
    above = ABOVE.get(kind.name, "")
    if kind.name == PLANNING:
        above = pipeline_of(document.file)
        above = above if above or keys.isdisjoint(_OF_PIPELINE) else "pipeline"
    if NAMES in keys:
        above = SIMPLE
    return f"{above}." if above and above not in keys else ""


def _refuse_params(document: YamlText, node: yaml.Node, depth: int) -> None:
    for key, value in entries(node) if depth else ():
        if key.value == PARAMETERS:
            what = f"{PARAMETERS} makes it a parameter file; list it under params"
            raise refused(document, key, what)
        _refuse_params(document, value, depth - 1)


def _paths(root: yaml.Node) -> Iterator[str]:
    """Yield the keys of the first two levels, the second also with ``*`` for the first."""
    for key, value in entries(root):
        first, _, rest = str(key.value).partition(".")
        yield from (str(key.value), first)
        for word in (rest.partition(".")[0], *(str(below.value) for below, _ in entries(value))):
            yield from (f"{first}.{word}", f"*.{word}")
