# SPDX-License-Identifier: Apache-2.0
"""How large the meshes of a description are, and where they end."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.outside import is_file
from multibot_rewrite.description.checks.mesh_box import COLLADA, mesh_box
from multibot_rewrite.description.checks.numbers import vector
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
