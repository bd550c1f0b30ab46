# SPDX-License-Identifier: Apache-2.0
"""What a part refers to, as the folder of the joined description needs it: a path from the part's
folder gets that folder in front, and its files of controllers are the one file of all.

Source: gz_ros2_control_plugin.cpp (``<parameters>`` is a path)."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator
from typing import NamedTuple

from multibot_rewrite.base.loose_xml import ESCAPES
from multibot_rewrite.base.model import Edit
from multibot_rewrite.description.steps.apply import cut
from multibot_rewrite.description.steps.document import read_document, value_slot

_FILES = "parameters"


class Output(NamedTuple):
    """The file that a joined description goes to, and that of all controllers; empty if unknown."""

    path: str = ""
    controllers: str = ""

    def folder_of(self, file: str) -> str:
        """Return how the folder of a part's file is called from that of the output."""
        if not self.path or file.startswith("<"):
            return ""
        above = os.path.dirname(os.path.abspath(self.path))
        path = os.path.relpath(os.path.dirname(os.path.abspath(file)), above)
        return "" if path == os.curdir else f"{path}/"


NOWHERE = Output()


class Referring(NamedTuple):
    """A text, the folder before its relative paths, and what each of its ``<parameters>`` was; these
    are empty where nothing changed."""

    text: bytes
    folder: str = ""
    files: tuple[str, ...] = ()


def referring(text: bytes, file: str, own: Collection[str], output: Output) -> Referring:
    """Return a part's text for another folder; ``own`` are its files of controllers."""
    folder, names = output.folder_of(file), {os.path.basename(it) for it in own}
    edits: list[Edit] = []
    files: list[str] = []
    moved = ""
    for tag, start, end, value in _references(text, file):
        if tag != _FILES:
            if folder and value and "://" not in value and not os.path.isabs(value):
                edits.append(_edit(start, start, moved := folder))
            continue
        is_own = bool(output.controllers) and os.path.basename(value) in names
        files.append(text[start:end].decode() if is_own else "")
        edits += [_edit(start, end, output.controllers)] * is_own
    made = b"".join(cut(text, edits))
    return Referring(made, moved, tuple(files) if any(files) else ())


def before_referring(it: Referring, file: str) -> bytes:
    """Return the text as it was in its own folder."""
    edits: list[Edit] = []
    files = iter(it.files)
    for tag, start, end, value in _references(it.text, file) if it[1:] != ("", ()) else ():
        if tag != _FILES:
            size = len(it.folder.translate(ESCAPES).encode()) * value.startswith(it.folder)
            edits.append(Edit(start, start + size, b"", None))
        elif old := next(files, ""):
            edits.append(Edit(start, end, old.encode(), None))
    return b"".join(cut(it.text, edits))


def _edit(start: int, end: int, path: str) -> Edit:
    return Edit(start, end, path.translate(ESCAPES).encode(), None)


def _references(text: bytes, file: str) -> Iterator[tuple[str, int, int, str]]:
    """Yield what refers to a file: its tag, where the path is, and the path."""
    document = read_document(text, file)
    for element, start in zip(document.elements, document.starts, strict=True):
        if element.tag in ("mesh", "texture", _FILES):
            name = "" if element.tag == _FILES else "filename"
            value = ((element.get(name) if name else element.text) or "").strip()
            slot = value_slot(text, start, name, value)
            if slot is not None:
                yield str(element.tag), *slot, value
