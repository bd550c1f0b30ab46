# SPDX-License-Identifier: Apache-2.0
"""``robot.urdf.join``: joined parts, as YAML; whatever reads a description reads it.

    join:
      - {description: base.urdf}
      - {description: arm.urdf.xacro, arguments: {type: ur5e}, prefix: left_, at: {parent: plate}}

Paths are relative to the file.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.releases import release_here
from multibot_rewrite.description.checks.numbers import number
from multibot_rewrite.description.joining.join import Given, join_texts
from multibot_rewrite.description.joining.kept import without_marks
from multibot_rewrite.description.joining.part import MISSED, Part
from multibot_rewrite.description.rewriters.builtin import builtin_tree
from multibot_rewrite.description.sources.read import JOIN, SourceText, read_alone, read_file
from multibot_rewrite.knowledge.yaml_with_lines import (
    YamlItem,
    entries_of,
    read_yaml_with_lines,
    table,
    table_of,
    word,
    word_of,
    words_of,
    wrong,
)

_KEYS = ("description", "arguments", "prefix", "name", "at", "srdf", "controllers")
_POSE = ("x", "y", "z", "roll", "pitch", "yaw")
_AT = ("parent", "pose")
_EXAMPLE = "join: [{description: arm.urdf}, {description: hand.urdf, at: {parent: tool0}}]"


def parts_of(path: str) -> tuple[Part, ...]:
    """The parts that a file lists; raises InputError with its line."""
    try:
        text = read_file(path).decode()
        keys = table(read_yaml_with_lines(text, path), "the file", ("join",))
        items = entries_of(keys, "join")
        if not items:
            raise UsageError(f"{path}: there are no parts; write {_EXAMPLE}")
        return tuple(_part(it, os.path.dirname(path)) for it in items)
    except (UsageError, UnicodeDecodeError) as error:
        raise InputError(str(error)) from None


def read_joined(path: str, trust: bool) -> SourceText:
    """The joined description of a file, without comments of the join; raises as ``join_texts``."""
    parts = parts_of(path)
    texts = [read_alone(it.description, it.xacro_args, trust) for it in parts]
    given = [
        Given(it, _without_banner(text), text.file) for it, text in zip(parts, texts, strict=True)
    ]
    try:
        made = join_texts(given, builtin_tree((), release_here()))
    except UsageError as error:
        raise InputError(f"{path}: {error}") from None
    missed = next((it for it in made.findings if it.code in MISSED), None)
    if missed:
        what = f"{path}: a name has no prefix: {missed.file}:{missed.line}: {missed.message}"
        raise InputError(f"{what}; make the description with multibot join, and correct it")
    read = tuple(file for text in texts for file in text.read)
    return SourceText(without_marks(made.data), f"{path} (expanded)", (path, *read))


def _without_banner(text: SourceText) -> bytes:
    """The text without the comment of xacro that has the path of a file: it is not the same from every
    working directory."""
    at = text.data.find(b"<robot") if text.known is not None else 0
    return b'<?xml version="1.0"?>\n' + text.data[at:] if at > 0 else text.data


def _part(item: YamlItem, folder: str) -> Part:
    keys = table(item, "a part", _KEYS)
    at = table_of(keys, "at")
    for key, value in at.items():
        if key not in _AT:
            wrong(value, f"at has {key!r}; it takes parent and pose")
    described = word_of(keys, "description")
    if not described or described.endswith(JOIN):
        what = f"{described} is a list of parts" if described else "a part has no description"
        wrong(item, f"{what}; name a URDF or xacro")
    beside = tuple(_path(it, folder) for it in words_of(keys, "controllers"))
    return Part(
        _path(described, folder),
        word_of(at, "parent"),
        _pose(table_of(at, "pose")),
        word_of(keys, "prefix"),
        word_of(keys, "name"),
        dict(_arguments(table_of(keys, "arguments"))),
        _path(word_of(keys, "srdf"), folder) or None,
        beside,
    )


def _path(path: str, folder: str) -> str:
    return os.path.normpath(os.path.join(folder, path)) if path else ""


def _arguments(keys: Mapping[str, YamlItem]) -> Iterator[tuple[str, str]]:
    for name, it in keys.items():
        # YAML's true is xacro's true.
        yield name, str(it.value).lower() if isinstance(it.value, bool) else word(it, name)


def _pose(keys: Mapping[str, YamlItem]) -> Sequence[float]:
    for key, it in keys.items():
        if key not in _POSE or number(word(it, key)) is None:
            wrong(it, f"pose has {key}: {it.value}; write numbers for {', '.join(_POSE)}")
    return tuple(number(word_of(keys, key, "0")) or 0.0 for key in _POSE)
