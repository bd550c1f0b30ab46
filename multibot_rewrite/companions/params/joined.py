# SPDX-License-Identifier: Apache-2.0
"""Parameter files of parts that one controller manager runs, as one file.

A controller of a part has the part's prefix, as its joints have; one controller manager and one
broadcaster of all joint states serve all parts. Values stay as they are written: what looks like a
number to rcl and not to PyYAML (``1e-3``) is one still.

Source: joint_state_broadcaster.cpp: without ``joints`` and ``interfaces`` it takes all joints.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

import yaml

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import PREFIX, Naming
from multibot_rewrite.companions.context import make_context
from multibot_rewrite.companions.formats import rewrite_alone
from multibot_rewrite.companions.named_file import PARAMS
from multibot_rewrite.companions.names.rename_map import NO_OWN, companion_names
from multibot_rewrite.companions.params.sections import (
    MANAGER,
    PARAMETERS,
    RawSection,
    controller_types,
    raw_sections,
)
from multibot_rewrite.companions.yaml_text import YamlText, joined_text, pairs, read_yaml
from multibot_rewrite.description.joining.part import PREFIXED, prefixing
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.made_topics import words_of
from multibot_rewrite.description.steps.collect import Inventory

_OF_ALL = "joint_state_broadcaster/JointStateBroadcaster"
_SOME = frozenset(("joints", "interfaces"))


class PartFile(NamedTuple):
    """A parameter file of a part as its prefix spells it: its sections, and the nodes in it that serve
    all parts."""

    file: str
    sections: tuple[RawSection, ...]
    shared: frozenset[str]


class JoinedFiles(NamedTuple):
    """One parameter file, and what a person should know."""

    data: bytes
    notes: tuple[str, ...]


def part_file(data: bytes, file: str, part: Inventory, prefix: str) -> PartFile:
    """A file with the prefix of its part; ``part`` is its description without. Raises InputError."""
    before = raw_sections(read_yaml(data, file))
    shared = frozenset(_shared(before))
    if not prefix:
        return PartFile(file, tuple(before), shared)
    naming = prefixing((*PREFIXED, "node"), PREFIX)
    naming = naming._replace(own={("node", it): None for it in shared})
    made = raw_sections(prefixed(PARAMS, data, file, part, part.declared, naming, prefix))
    return PartFile(file, tuple(_kept(made, before, shared)), shared)


def _kept(
    made: Iterable[RawSection], before: Iterable[RawSection], shared: frozenset[str]
) -> Iterator[RawSection]:
    """What a rewrite adds for a node of each robot has no place in one that serves all."""
    there = {it.path: {key.value for key, _ in pairs(it.body)} for it in before}
    for it in made:
        known = there.get(it.path, ())
        if _node(it) in shared - {MANAGER}:
            it.body.value = [pair for pair in pairs(it.body) if pair[0].value in known]
        if known or _node(it) not in shared:
            yield it


def prefixed(
    kind: str,
    data: bytes,
    file: str,
    part: Inventory,
    declared: Declared,
    naming: Naming,
    prefix: str,
) -> YamlText:
    """Return a file of a part as its prefix spells it, by what is ``declared`` without."""
    names = companion_names(declared, naming, "", NO_OWN)
    words = words_of(part.claims)
    context = make_context(names.declared, naming, (), part.release, names.own, words)
    return read_yaml(rewrite_alone(kind, data, file, context, prefix, 0).text.encode(), file)


def _node(section: RawSection) -> str:
    return section.path.rpartition("/")[2]


def _shared(sections: Sequence[RawSection]) -> Iterator[str]:
    """The manager, and a broadcaster of all joints."""
    yield MANAGER
    set_for = {_node(it): {key.value for key, _ in pairs(it.body)} for it in sections}
    for name, type_ in controller_types(sections).items():
        if type_ == _OF_ALL and not _SOME & set_for.get(name, set()):
            yield name


def joined_files(files: Sequence[PartFile]) -> JoinedFiles:
    """All files as one; raises InputError for a controller that two of them have."""
    _check_meeting(files)
    sections: dict[str, RawSection] = {}
    notes: list[str] = []
    for it in files:
        for one in it.sections:
            key = MANAGER if _node(one) == MANAGER else one.path
            if key not in sections:
                sections[key] = one
                continue
            first = sections[key]
            for what in added(first.body, one.body, f"{first.path}."):
                notes.append(f"{it.file}: {what}")
    root = yaml.MappingNode("tag:yaml.org,2002:map", [_written(it) for it in sections.values()])
    return JoinedFiles(joined_text((it.file for it in files), root), tuple(notes))


def _check_meeting(files: Sequence[PartFile]) -> None:
    known: dict[str, str] = {}
    for it in files:
        for name in controller_types(it.sections):
            if name in known and name not in it.shared:
                what = f"controller {name!r} is in {known[name]}, too"
                raise InputError(f"{it.file}: {what}; give the part a prefix of its own")
            known[name] = it.file


def _written(it: RawSection) -> tuple[yaml.Node, yaml.Node]:
    first = it.keys[0].value
    key = first if len(it.keys) == 1 else f"/{it.path}"
    name = yaml.ScalarNode("tag:yaml.org,2002:str", PARAMETERS)
    body = yaml.MappingNode("tag:yaml.org,2002:map", [(name, it.body)])
    return yaml.ScalarNode("tag:yaml.org,2002:str", key), body


def added(into: yaml.MappingNode, more: yaml.MappingNode, at: str) -> Iterator[str]:
    """Add parameters, lists behind each other; tells those with two values."""
    known: Mapping[str, yaml.Node] = {key.value: value for key, value in pairs(into)}
    for key, value in pairs(more):
        first = known.get(key.value)
        name = f"{at}{key.value}"
        if first is None:
            into.value.append((key, value))
        elif isinstance(first, yaml.MappingNode) and isinstance(value, yaml.MappingNode):
            yield from added(first, value, f"{name}.")
        elif isinstance(first, yaml.SequenceNode) and isinstance(value, yaml.SequenceNode):
            there = {_plain(it) for it in first.value}
            first.value += [it for it in value.value if _plain(it) not in there]
        elif _plain(first) != _plain(value):
            yield f"{name} is {_plain(value)}, before it {_plain(first)}, which is taken"


def _plain(node: yaml.Node) -> str:
    return node.value if isinstance(node, yaml.ScalarNode) else yaml.serialize(node).strip()
