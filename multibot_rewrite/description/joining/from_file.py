# SPDX-License-Identifier: Apache-2.0
"""``robot.urdf.join``: joined parts, as YAML; whatever reads a description reads it.

    join:
      - {description: base.urdf}
      - {description: arm.urdf.xacro, arguments: {type: ur5e}, prefix: left_, at: {parent: plate}}

Paths are relative to the file.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.releases import release_here
from multibot_rewrite.description.checks.numbers import number
from multibot_rewrite.description.joining.join import GivenPart, JoinedText, Output, join_texts
from multibot_rewrite.description.joining.kept import without_marks
from multibot_rewrite.description.joining.part import MISSED, Part
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.sources.read import (
    BESIDE,
    JOIN,
    SourceText,
    read_alone,
    read_file,
)
from multibot_rewrite.knowledge.yaml_with_lines import (
    YamlItem,
    entries_of,
    flag_of,
    read_yaml_with_lines,
    table,
    table_of,
    word,
    word_of,
    words_of,
    wrong,
)

SAMPLES = "samples"
_KEYS = ("description", "arguments", "prefix", "name", "at", "srdf", "rviz", "one_system", *BESIDE)
_POSE = ("x", "y", "z", "roll", "pitch", "yaw")
_EXAMPLE = "join: [{description: arm.urdf}, {description: hand.urdf, at: {parent: tool0}}]"


def parts_of(path: str) -> tuple[Part, ...]:
    """Return the parts that a file lists; raises InputError with its line."""
    return listed_in(path)[0]


def listed_in(path: str) -> tuple[tuple[Part, ...], int]:
    """Return the parts, and the number of random poses to try; raises as ``parts_of``."""
    try:
        text = read_file(path).decode()
        keys = table(read_yaml_with_lines(text, path), "the file", ("join", SAMPLES))
        items = entries_of(keys, "join")
        if not items:
            raise UsageError(f"{path}: there are no parts; write {_EXAMPLE}")
        parts = tuple(_part_of_item(it, os.path.dirname(path)) for it in items)
        samples = word_of(keys, SAMPLES, "0")
        if not samples.isdecimal():
            wrong(keys[SAMPLES], f"samples is {samples}; write a number such as 10000")
        if int(samples) and not any(it.srdf for it in parts):
            wrong(keys[SAMPLES], "samples is for an SRDF: give a part its srdf, too")
        return parts, int(samples)
    except (UsageError, UnicodeDecodeError) as error:
        raise InputError(str(error)) from None


def read_joined(path: str, trust: bool) -> SourceText:
    """Return the joined description of a file, without comments; raises as ``join_texts``."""
    given, read = plain_texts(parts_of(path), trust)
    try:
        made = join_texts(given, builtin_tree((), release_here()), Output(path))
    except UsageError as error:
        raise InputError(f"{path}: {error}") from None
    return SourceText(plain_text(made, path), f"{path} (expanded)", (path, *read))


def plain_texts(parts: Sequence[Part], trust: bool) -> tuple[list[GivenPart], tuple[str, ...]]:
    """Return the texts of parts for a description that others read, and the files that were read."""
    texts = [read_alone(it.description, it.xacro_args, trust) for it in parts]
    both = zip(parts, texts, strict=True)
    given = [GivenPart(it, _without_banner(text), text.file) for it, text in both]
    return given, tuple(file for text in texts for file in text.read)


def plain_text(made: JoinedText, place: str) -> bytes:
    """Return the joined text without comments; raises InputError for a name without prefix."""
    if missed := next((it for it in made.findings if it.code in MISSED), None):
        what = f"{place}: a name has no prefix: {missed.file}:{missed.line}: {missed.message}"
        raise InputError(f"{what}; make the description with multibot join, and correct it")
    return without_marks(made.data)


def _without_banner(text: SourceText) -> bytes:
    """Return the text without xacro's comment, whose path depends on the working directory."""
    at = text.data.find(b"<robot") if text.known is not None else 0
    return b'<?xml version="1.0"?>\n' + text.data[at:] if at > 0 else text.data


def _part_of_item(item: YamlItem, folder: str) -> Part:
    keys = table(item, "a part", _KEYS)
    at = table_of(keys, "at")
    for key, value in at.items():
        if key not in ("parent", "pose"):
            wrong(value, f"at has {key!r}; it takes parent and pose")
    if not word_of(keys, "description"):
        wrong(item, "a part has no description; name a URDF or xacro")
    for key, it in table_of(at, "pose").items():
        if key not in _POSE or number(word(it, key)) is None:
            wrong(it, f"pose has {key}: {it.value}; write numbers for {', '.join(_POSE)}")
    pose = {key: number(word(it, key)) for key, it in table_of(at, "pose").items()}
    given: dict[str, Any] = {key: word_of(keys, key) for key in ("prefix", "name")}
    given |= {
        key: _path_below(word_of(keys, key), folder) for key in ("description", "srdf", "rviz")
    }
    given |= {key: [_path_below(it, folder) for it in words_of(keys, key)] for key in BESIDE}
    given["one_system"] = flag_of(keys, "one_system")
    given["at"] = {"parent": word_of(at, "parent"), "pose": pose}
    given["arguments"] = {
        name: it.value if isinstance(it.value, bool) else word(it, name)
        for name, it in table_of(keys, "arguments").items()
    }
    try:
        return part_of(given)
    except UsageError as error:
        wrong(item, str(error))


def part_of(keys: Mapping[str, Any]) -> Part:
    """Return a part from checked keys; raises UsageError if it is a list of parts itself."""
    described, at = keys["description"], keys.get("at", {})
    if described.endswith(JOIN):
        raise UsageError(f"{described} is a list of parts; name a URDF or xacro")
    pose = at.get("pose", {})
    arguments = keys.get("arguments", {}).items()
    return Part(
        described,
        at.get("parent", ""),
        tuple(float(pose.get(axis, 0)) for axis in _POSE),
        keys.get("prefix", ""),
        keys.get("name", ""),
        # YAML's true is xacro's true.
        {name: str(it).lower() if isinstance(it, bool) else str(it) for name, it in arguments},
        keys.get("srdf") or None,
        controllers=tuple(_as_list(keys.get("controllers", ()))),
        one_system=keys.get("one_system", False),
        moveit=tuple(_as_list(keys.get("moveit", ()))),
        rviz=keys.get("rviz", ""),
    )


def _as_list(value: str | Sequence[str]) -> Sequence[str]:
    return [value] if isinstance(value, str) else value


def _path_below(path: str, folder: str) -> str:
    return os.path.normpath(os.path.join(folder, path)) if path else ""
