# SPDX-License-Identifier: Apache-2.0
"""What a joined description refers to in files: meshes and textures by paths from its own folder, and
the one file of all controllers.

Source: gz_ros2_control_plugin.cpp (``<parameters>`` is a path)."""

from __future__ import annotations

import os
from bisect import bisect_right
from collections.abc import Sequence
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.model import Edit
from multibot_rewrite.description.joining import kept
from multibot_rewrite.description.steps.apply import cut
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.description.steps.spans import Spans

_FILES = "parameters"


class References(NamedTuple):
    """Where a part's file is, that of the joined description, and its files of controllers with the one
    that they become; all empty where nobody says where the description goes."""

    file: str = ""
    output: str = ""
    old: Sequence[str] = ()
    new: str = ""

    def renewed(self, tag: str, value: str) -> str:
        """Return what a reference becomes."""
        if tag == _FILES:
            names = map(os.path.basename, self.old)
            return self.new if os.path.basename(value) in names else value
        is_relative = value and "://" not in value and not os.path.isabs(value)
        if not self.output or not is_relative or self.file.startswith("<"):
            return value
        path = os.path.join(os.path.dirname(self.file), value)
        return os.path.relpath(path, os.path.dirname(self.output) or os.curdir)

    def apply(self, root: _Element) -> None:
        """Renew all references in a tree."""
        for it in root.iter(*kept.REFERRING):
            new = self.renewed(str(it.tag), kept.path_in(it).strip())
            if name := kept.REFERRING[str(it.tag)]:
                it.set(name, new)
            else:
                it.text = new


def referring(data: bytes, parts: Sequence[References], file: str, before: int) -> bytes:
    """Return a joined text with the references of all parts renewed; the first part has ``before``
    joined ones itself."""
    spans = Spans(read_document(data, file))
    starts = kept.part_starts(data)[before:]
    edits: list[Edit] = []
    seen: set[tuple[object, str]] = set()
    for it in spans.document.root.iter(*kept.REFERRING):
        own = parts[bisect_right(starts, spans.start_of(it))]
        # A part's file may be in the plugin of an earlier one.
        every = (own, *parts) if it.tag == _FILES else (own,)
        path = kept.path_in(it).strip()
        news = (one.renewed(str(it.tag), path) for one in every)
        new = next((one for one in news if one != path), path)
        key = it.getparent(), new
        if it.tag == _FILES and key in seen:
            edits.append(kept.left_out(spans, it))
        else:
            edits += kept.moved_path(spans, it, path, new) if new != path else ()
        seen.add(key)
    return b"".join(cut(data, sorted(edits, key=lambda it: it.start)))
