# SPDX-License-Identifier: Apache-2.0
"""How large a mesh is: the box around the corners of an STL, OBJ or Collada file."""

from __future__ import annotations

import os
from collections.abc import Iterable
from functools import lru_cache
from math import isfinite
from struct import iter_unpack

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.outside import file_state, kept_bytes
from multibot_rewrite.description.checks.numbers import Vector
from multibot_rewrite.description.checks.shapes import Extent

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
