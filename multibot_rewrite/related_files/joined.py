# SPDX-License-Identifier: Apache-2.0
"""Joins related files of parts: parameters, MoveIt's files for one move_group, an RViz config.

A controller of a part has the part's prefix, as its joints, links and groups have; one
controller manager and one broadcaster of all joint states serve all parts. Values stay as they
are written: what looks like a number to rcl and not to PyYAML (``1e-3``) is one still. Servo
moves one group: its files are left out, with a note. The first RViz config stays; of each
further one the displays that it does not show yet follow as a group with the part's name.
Source: joint_state_broadcaster.cpp: without ``joints`` and ``interfaces`` it takes all joints."""

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

import yaml

from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.naming import PREFIX, Naming
from multibot_rewrite.description.joining.part import PREFIXED, prefixing
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.model_namespaces import words_of
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.related_files.context import make_context
from multibot_rewrite.related_files.formats import rewrite_alone
from multibot_rewrite.related_files.moveit.file_kind import (
    ABOVE,
    NAMES,
    OF_SERVO,
    PLANNING,
    SIMPLE,
    entries,
    file_kind,
)
from multibot_rewrite.related_files.named_file import MOVEIT, PARAMS
from multibot_rewrite.related_files.names.rename_map import NO_OWN, related_file_names, with_srdf
from multibot_rewrite.related_files.params.sections import (
    MANAGER,
    PARAMETERS,
    RawSection,
    controller_types,
    raw_sections,
)
from multibot_rewrite.related_files.rviz.display_groups import group_text, item_splices, leaves
from multibot_rewrite.related_files.rviz.read_config import (
    GRAPH_NAMESPACE,
    TOPIC,
    RvizConfig,
    RvizItem,
    RvizRobot,
    fixed_frame,
    read_config,
    targets,
    value,
)
from multibot_rewrite.related_files.rviz.rewrite import frame_splices
from multibot_rewrite.related_files.yaml_text import (
    YamlText,
    cut_out,
    inserted,
    joined_text,
    moved,
    pairs,
    read_yaml,
    spliced,
)

_OF_ALL = "joint_state_broadcaster/JointStateBroadcaster"
_SOME = frozenset(("joints", "interfaces"))


class PartFile(NamedTuple):
    """A part's parameter file with the prefix: its sections, and nodes that serve all parts."""

    file: str
    sections: tuple[RawSection, ...]
    shared: frozenset[str]


class JoinedFile(NamedTuple):
    """The one file, and notes for the user."""

    data: bytes
    notes: tuple[str, ...]


def part_file(data: bytes, file: str, part: Inventory, prefix: str) -> PartFile:
    """Return a file with its part's prefix; ``part`` is described without it. Raises InputError."""
    before = raw_sections(read_yaml(data, file))
    shared = frozenset(_shared_names(before))
    if not prefix:
        return PartFile(file, tuple(before), shared)
    naming = prefixing((*PREFIXED, "node"), PREFIX)
    naming = naming._replace(own={("node", it): None for it in shared})
    made = raw_sections(prefixed(PARAMS, data, file, part, part.declared, naming, prefix))
    # What a rewrite adds for a node of each robot has no place in one that serves all.
    there = {it.path: {key.value for key, _ in pairs(it.body)} for it in before}
    for it in made:
        if _node_name(it) in shared - {MANAGER}:
            known = there.get(it.path, ())
            it.body.value = [pair for pair in pairs(it.body) if pair[0].value in known]
    kept = (it for it in made if there.get(it.path) or _node_name(it) not in shared)
    return PartFile(file, tuple(kept), shared)


def prefixed(
    kind: str,
    data: bytes,
    file: str,
    part: Inventory,
    declared: Declared,
    naming: Naming,
    prefix: str,
) -> YamlText:
    """Return a file of a part with its prefix; ``declared`` are the names without it."""
    names = related_file_names(declared, naming, "", NO_OWN)
    words = words_of(part.claims)
    context = make_context(names.declared, naming, (), part.release, names.own, words)
    return read_yaml(rewrite_alone(kind, data, file, context, prefix, 0).text.encode(), file)


def _node_name(section: RawSection) -> str:
    return section.path.rpartition("/")[2]


def _shared_names(sections: Sequence[RawSection]) -> Iterator[str]:
    """Yield the controller manager, and each broadcaster of all joints."""
    yield MANAGER
    set_for = {_node_name(it): {key.value for key, _ in pairs(it.body)} for it in sections}
    for name, type_ in controller_types(sections).items():
        if type_ == _OF_ALL and not _SOME & set_for.get(name, set()):
            yield name


def joined_files(files: Sequence[PartFile]) -> JoinedFile:
    """Return all files as one; raises InputError for a controller that two of them have."""
    sections: dict[str, RawSection] = {}
    notes: list[str] = []
    known: dict[str, str] = {}
    for it in files:
        for name in controller_types(it.sections):
            if name in known and name not in it.shared:
                what = f"controller {name!r} is in {known[name]}, too"
                raise InputError(f"{it.file}: {what}; give the part a prefix of its own")
            known[name] = it.file
        for one in it.sections:
            key = MANAGER if _node_name(one) == MANAGER else one.path
            if key not in sections:
                sections[key] = one
                continue
            first = sections[key]
            for what in added(first.body, one.body, f"{first.path}."):
                notes.append(f"{it.file}: {what}")
    rows = []
    for one in sections.values():
        key = one.keys[0].value if len(one.keys) == 1 else f"/{one.path}"
        below = yaml.ScalarNode("tag:yaml.org,2002:str", PARAMETERS)
        body = yaml.MappingNode("tag:yaml.org,2002:map", [(below, one.body)])
        rows.append((yaml.ScalarNode("tag:yaml.org,2002:str", key), body))
    root = yaml.MappingNode("tag:yaml.org,2002:map", rows)
    return JoinedFile(joined_text((it.file for it in files), root), tuple(notes))


def added(into: yaml.MappingNode, more: yaml.MappingNode, at: str) -> Iterator[str]:
    """Add parameters, lists behind each other; yields a text for each that has two values."""
    known: Mapping[str, yaml.Node] = {key.value: it for key, it in pairs(into)}
    for key, further in pairs(more):
        first = known.get(key.value)
        name = f"{at}{key.value}"
        if first is None:
            into.value.append((key, further))
        elif isinstance(first, yaml.MappingNode) and isinstance(further, yaml.MappingNode):
            yield from added(first, further, f"{name}.")
        elif isinstance(first, yaml.SequenceNode) and isinstance(further, yaml.SequenceNode):
            there = {_plain_text(it) for it in first.value}
            first.value += [it for it in further.value if _plain_text(it) not in there]
        elif _plain_text(first) != _plain_text(further):
            yield f"{name} is {_plain_text(further)}, before it {_plain_text(first)}, which is taken"


def _plain_text(node: yaml.Node) -> str:
    return node.value if isinstance(node, yaml.ScalarNode) else yaml.serialize(node).strip()


# What a kind is called in MoveIt's packages, where that is not the kind.
_CALLED = {"controllers": "moveit_controllers"}


class PartMoveit(NamedTuple):
    """A MoveIt file of a part, with the part's prefix."""

    file: str
    kind: str
    document: YamlText


class JoinedMoveit(NamedTuple):
    """The joined files by their names, and notes for the user: a file, and what of it."""

    files: Mapping[str, bytes]
    notes: tuple[tuple[str, str], ...]


def part_moveit(data: bytes, file: str, part: Inventory, said: Declared, prefix: str) -> PartMoveit:
    """Return a file with the prefix of its part, whose SRDF declares ``said``."""
    # Raises InputError for one that is not MoveIt's, UsageError if it has groups and the part has
    # no SRDF.
    document = read_yaml(data, file)
    kind = file_kind(document)
    if prefix and kind == "kinematics" and not said.get("group"):
        raise UsageError(f"{file}: groups of the part get its prefix; name its SRDF, too")
    if prefix:
        naming = prefixing((*PREFIXED, "node", "group"), PREFIX)
        declared = with_srdf(part.declared, said)
        document = prefixed(MOVEIT, data, file, part, declared, naming, prefix)
    return PartMoveit(file, kind, document)


def joined_moveit(files: Iterable[PartMoveit]) -> JoinedMoveit:
    """Return one file of each kind, and of each pipeline."""
    every: dict[str, list[tuple[str, yaml.MappingNode]]] = {}
    notes: list[tuple[str, str]] = []
    for it in files:
        if it.kind == OF_SERVO:
            notes.append((it.file, "it is for one group of one servo_node, and left out"))
            continue
        whole, above = it.document.root, ABOVE.get(it.kind)
        root = next((value for key, value in entries(whole) if key.value == above), whole)
        # A pipeline is told by the name of its file.
        file = os.path.basename(it.file)
        name = file if it.kind == PLANNING else f"{_CALLED.get(it.kind, it.kind)}.yaml"
        if isinstance(root, yaml.MappingNode):
            every.setdefault(name, []).append((it.file, root))
    made = {}
    for name, roots in every.items():
        _spell_alike([root for _, root in roots])
        (_, first), *others = roots
        notes += ((file, what) for file, root in others for what in added(first, root, ""))
        made[name] = joined_text((file for file, _ in roots), first)
    return JoinedMoveit(made, tuple(notes))


def _spell_alike(roots: Sequence[yaml.MappingNode]) -> None:
    """Move controllers at the top of a file below their manager, if another file has them there."""
    if not any(key.value == SIMPLE for root in roots for key, _ in entries(root)):
        return
    for root in roots:
        names = next((it.value for key, it in entries(root) if key.value == NAMES), ())
        own = {NAMES, *(it.value for it in names)} if names else {}
        below = [it for it in root.value if it[0].value in own]
        if below:
            manager = yaml.ScalarNode("tag:yaml.org,2002:str", SIMPLE)
            root.value = [it for it in root.value if it not in below]
            root.value.append((manager, yaml.MappingNode("tag:yaml.org,2002:map", below)))


class PartRviz(NamedTuple):
    """The config of the part ``name``, with its prefix."""

    name: str
    file: str
    config: RvizConfig


def part_rviz(data: bytes, file: str, part: Inventory, name: str, prefix: str) -> PartRviz:
    """Return a config with the prefix of its part; raises InputError if it is not for RViz 2."""
    config = read_config(read_yaml(data, file))
    naming = prefixing((*PREFIXED, "group"), PREFIX)
    names = related_file_names(part.declared, naming, prefix, {})
    robot = RvizRobot(name, names, names)
    document = config.document
    shown = (*leaves(config.displays), *config.tools) if prefix else ()
    splices = [it for one in shown for it in item_splices(document, one, robot, None)]
    views = (fixed_frame(config), *targets(config)) if prefix else ()
    splices += [it for node in views for it in frame_splices(node, robot)]
    return PartRviz(name, file, read_config(read_yaml(spliced(document, splices).encode(), file)))


def joined_rviz(parts: Sequence[PartRviz]) -> JoinedFile:
    """Return all configs as one."""
    first, *others = parts
    config, document = first.config, first.config.document
    known = {_shows(it) for it in leaves(config.displays)}
    column = config.displays[0].block.column if config.displays else 0
    groups, notes = "", []
    for it in others:
        new = [one for one in leaves(it.config.displays) if _shows(one) not in known]
        known.update(map(_shows, new))
        if column and new:
            copies = (
                moved(cut_out(it.config.document, start, end), column - own)
                for start, end, own in (one.block for one in new)
            )
            groups += group_text(document, it.name, column, copies)
        what = f"its displays are in the group {it.name}" if column and new else "it shows no more"
        notes.append(f"{it.file}: {what}; tools, panels and views are those of {first.file}")
    end = config.displays[-1].block.end if config.displays else 0
    splices = [inserted(document, end, groups)] if groups else []
    return JoinedFile(spliced(document, splices).encode(), tuple(notes))


def _shows(one: RvizItem) -> tuple[str, ...]:
    """Return a key equal for alike items: class and topics of a display, or frame of a grid."""
    named = (it for it in one.places if it.kind in (TOPIC, GRAPH_NAMESPACE))
    frame = value(one.node, "Reference Frame")
    return (
        one.cls,
        *(f"{it.key}={it.text.strip('/')}" for it in named),
        str(frame.value if frame else ""),
    )
