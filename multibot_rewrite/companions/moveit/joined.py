# SPDX-License-Identifier: Apache-2.0
"""MoveIt's files of parts that one move_group plans for, one of each kind.

Groups, joints, links and controllers of a part have its prefix. Servo moves one group: its files are
left out, and told.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import yaml

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import PREFIX
from multibot_rewrite.companions.moveit.file_kind import (
    ABOVE,
    NAMES,
    OF_SERVO,
    PLANNING,
    SIMPLE,
    entries,
    file_kind,
)
from multibot_rewrite.companions.named_file import MOVEIT
from multibot_rewrite.companions.names.rename_map import with_srdf
from multibot_rewrite.companions.params.joined import added, prefixed
from multibot_rewrite.companions.yaml_text import YamlText, joined_text, read_yaml
from multibot_rewrite.description.joining.part import PREFIXED, prefixing
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.steps.collect import Inventory

# What a kind is called in MoveIt's packages, where that is not the kind.
_CALLED = {"controllers": "moveit_controllers"}


class PartMoveit(NamedTuple):
    """A file of a part, as its prefix spells it."""

    file: str
    kind: str
    document: YamlText


class JoinedMoveit(NamedTuple):
    """The joined files by their names, and what a person should know: a file, and what of it."""

    files: Mapping[str, bytes]
    notes: tuple[tuple[str, str], ...]


def part_moveit(data: bytes, file: str, part: Inventory, said: Declared, prefix: str) -> PartMoveit:
    """A file with the prefix of its part, whose SRDF declares what is ``said``; raises InputError for
    one that is not MoveIt's, UsageError where a part without an SRDF has groups in it."""
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
    """One file of each kind, and of each pipeline."""
    every: dict[str, list[tuple[str, yaml.MappingNode]]] = {}
    notes: list[tuple[str, str]] = []
    for it in files:
        if it.kind == OF_SERVO:
            notes.append((it.file, "it is for one group of one servo_node, and left out"))
        elif isinstance(root := _body(it), yaml.MappingNode):
            every.setdefault(_name(it), []).append((it.file, root))
    made = {}
    for name, roots in every.items():
        _spell_alike([root for _, root in roots])
        (_, first), *others = roots
        notes += ((file, what) for file, root in others for what in added(first, root, ""))
        made[name] = joined_text((file for file, _ in roots), first)
    return JoinedMoveit(made, tuple(notes))


def _spell_alike(roots: Sequence[yaml.MappingNode]) -> None:
    """Controllers at the top of a file, which its launch file puts below their manager, are written
    there if those of another file are."""
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


def _body(it: PartMoveit) -> yaml.Node | None:
    """The parameters of a file without the one that some have above them."""
    root, above = it.document.root, ABOVE.get(it.kind)
    return next((value for key, value in entries(root) if key.value == above), root)


def _name(it: PartMoveit) -> str:
    # A pipeline is told by the name of its file.
    if it.kind == PLANNING:
        return os.path.basename(it.file)
    return f"{_CALLED.get(it.kind, it.kind)}.yaml"
