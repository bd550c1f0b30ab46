# SPDX-License-Identifier: Apache-2.0
"""How large the meshes of a description are, and where they end."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from math import isfinite
from struct import iter_unpack

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.outside import file_state, is_file, kept_bytes
from multibot_rewrite.description.checks.numbers import Vector, vector
from multibot_rewrite.description.checks.poses import minus
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.shapes import Extent
from multibot_rewrite.rules.description.meshes.lookup import MeshFile, lookups
from multibot_rewrite.rules.description.meshes.shared import used_files
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject

# Metres: the longest side, and the one after it; a long and thin mesh may be a rail.
LONG, WIDE = 50.0, 10.0
HINT = 'are these millimetres? add scale="0.001 0.001 0.001"'
HINT_OF_UNIT = 'correct <unit meter> in the file, or add scale="0.001 0.001 0.001"'


def box_of(subject: Subject, mesh: _Element, whole: bool = True) -> Extent | None:
    """The box around a ``<mesh>`` in its own frame, in metres; as ``mesh_box``."""
    path = _paths(subject).get((mesh.get("filename") or "").strip(), "")
    box = mesh_box(path, whole) if path else None
    if box is None or "scale" not in mesh.attrib:
        return box
    scale = vector(mesh.get("scale"))
    if scale is None:
        return None
    ends = [(a * s, b * s) for a, b, s in zip(box.low, box.high, scale, strict=True)]
    (a, d), (b, e), (c, f) = map(sorted, ends)
    return Extent((a, b, c), (d, e, f))


@memoized
def _paths(subject: Subject) -> Mapping[str, str]:
    """Where the meshes are on the disk, by the name in the description."""
    found = {it.used.name: _on_disk(it) for it in lookups(subject) if it.found}
    direct = (it for it in used_files(subject) if it.scheme == "file" and is_file(it.path))
    return found | {it.name: it.path for it in direct}


def _on_disk(it: MeshFile) -> str:
    paths = (os.path.join(folder, it.found) for folder in it.folders)
    return next(filter(is_file, paths), "")


@rule("MB714", "mesh-units", WARNING)
def mesh_units(subject: Subject) -> Iterator[Problem]:
    """Each mesh once; the beginning of a file is enough to tell that it is too large."""
    seen: set[tuple[str, str]] = set()
    for mesh in (it.element for it in used_files(subject) if it.element.tag == "mesh"):
        key = (mesh.get("filename", ""), mesh.get("scale", ""))
        box = None if key in seen else box_of(subject, mesh, whole=False)
        seen.add(key)
        sides = sorted(minus(box.high, box.low)) if box else (0.0,) * 3
        if sides[2] >= LONG and sides[1] >= WIDE:
            message = f"{key[0]!r} is {sides[2]:.3g} m long"
            of_unit = key[0].strip().lower().endswith(COLLADA)
            yield Problem(mesh, message, "filename", HINT_OF_UNIT if of_unit else HINT)


# A larger file is not read as a whole; its beginning tells at least how large it is.
MOST_BYTES, BEGINNING = 4 * 2**20, 64 * 2**10
# A binary STL: 80 bytes of anything, how many triangles, and 50 bytes for each.
_HEAD, _TRIANGLE = 84, 50
_CORNERS = "<12x9f2x"
_WORD = rb"[ \t]+([-+.\deE]+)"
COLLADA = ".dae"
_CORNER = {
    ".stl": lazy_compile(rb"\bvertex" + _WORD * 3),
    ".obj": lazy_compile(rb"(?m)^[ \t]*v" + _WORD * 3),
}


def mesh_box(path: str, whole: bool = True) -> Extent | None:
    """The box around a mesh; not ``whole``: around its beginning. None where it cannot be told."""
    state, kind = file_state(path), os.path.splitext(path)[1].lower()
    # The scene, which says what is shown and where, is at the end of a Collada file.
    whole = whole or kind == COLLADA
    known = state and (kind == COLLADA or kind in _CORNER)
    return _box(path, state, whole) if known else None


@lru_cache(maxsize=1024)
def _box(path: str, state: tuple[int, ...], whole: bool) -> Extent | None:
    size = state[1]
    if whole and size > MOST_BYTES:
        return None
    try:
        data = kept_bytes(path, MOST_BYTES if whole else BEGINNING)
    except OSError:
        return None
    if path.lower().endswith(COLLADA):
        from multibot_rewrite.description.checks.collada import (
            collada_box,
        )  # few descriptions are near such a file

        return collada_box(data)
    return _around(_corners(path, data, size))


def _corners(path: str, data: bytes, size: int) -> Iterable[Vector]:
    kind = os.path.splitext(path)[1].lower()
    count = int.from_bytes(data[_HEAD - 4 : _HEAD], "little")
    if kind == ".stl" and size == _HEAD + count * _TRIANGLE:
        whole = (len(data) - _HEAD) // _TRIANGLE * _TRIANGLE
        for it in iter_unpack(_CORNERS, data[_HEAD : _HEAD + whole]):
            yield from (it[:3], it[3:6], it[6:])
        return
    for found in _CORNER[kind].finditer(data):
        try:
            x, y, z = map(float, found.groups())
        except ValueError:
            return
        yield x, y, z


def _around(corners: Iterable[Vector]) -> Extent | None:
    columns = list(zip(*corners, strict=True))
    if not columns or not isfinite(sum(map(sum, columns))):
        return None
    (a, b, c), (d, e, f) = ([best(it) for it in columns] for best in (min, max))
    return Extent((a, b, c), (d, e, f))
