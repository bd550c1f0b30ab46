# SPDX-License-Identifier: Apache-2.0
"""Materials of visuals."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from lxml import etree

from multibot_rewrite.base.findings.finding import WARNING, rule
from multibot_rewrite.base.nearest import Guesses
from multibot_rewrite.description.checks.numbers import numbers
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.facts.faults import urdf_faults
from multibot_rewrite.rules.facts.memo import lacking, memoized
from multibot_rewrite.rules.subject import Elements, Subject

Look = tuple[tuple[float, ...] | str, str]


@rule("MB131", "undefined-material", WARNING)
def undefined_material(subject: Subject) -> Iterator[Problem]:
    """Report materials without a definition, by urdfdom's order: the robot's own first."""
    tops = _robot_materials(subject.elements)
    bare = [it for it in tops if not _defines(it)]
    # Elements that another rule reports, for themselves or for a child.
    elements = [it.element for it in urdf_faults(subject)] if bare else []
    misspelled = {*elements, *(it.getparent() for it in elements)}
    for material in bare:
        if material not in misspelled:
            name = material.get("name", "")
            yield Problem(material, f"material {name!r} has neither colour nor texture", "name")
    defined = dict.fromkeys(it.get("name", "") for it in tops)
    guesses = Guesses()
    for look in _visual_materials(subject):
        name = look.get("name", "")
        if name in defined or not name:
            continue
        if len(look) and _defines(look):
            defined[name] = None
            continue
        hint = guesses.hint(name, filter(None, defined))
        message = f"material {name!r} is not defined"
        yield from lacking(subject, [Problem(look, message, "name", hint, level=WARNING)])


def _robot_materials(elements: Elements) -> Sequence[etree._Element]:
    return elements.tops("material") if elements.root.tag == "robot" else ()


@memoized
def _visual_materials(subject: Subject) -> list[etree._Element]:
    """Return the named materials of visuals."""
    root = subject.document.root
    links = set(subject.elements.tops("link")) if root.tag == "robot" else set()
    visuals = {it for it in subject.elements.every("visual") if it.getparent() in links}
    materials = subject.elements.every("material")
    return [it for it in materials if it.getparent() in visuals and it.get("name") is not None]


def _defines(material: etree._Element) -> bool:
    """Return whether a material has a colour or a texture."""
    return any(it.get("rgba") or it.get("filename") for it in material.iterchildren("*"))


@rule("MB132", "material-differs", WARNING)
def material_differs(subject: Subject) -> Iterator[Problem]:
    """Report each visual whose own definition is ignored."""
    looks = [it for it in _visual_materials(subject) if len(it) and it.get("name") and _defines(it)]
    tops = _robot_materials(subject.elements) if looks else []
    first = {it.get("name", ""): _colour_and_texture(it) for it in reversed(tops)}
    for material in looks:
        name, look = material.get("name", ""), _colour_and_texture(material)
        if first.setdefault(name, look) != look:
            hint = "rename it: the first definition of a name is used"
            message = f"material {name!r} has another colour or texture than its first definition"
            yield Problem(material, message, "name", hint)


def _colour_and_texture(material: etree._Element) -> Look:
    """Return the colour and the texture of a material."""
    parts = {it.tag: it for it in reversed(material)}
    color, texture = parts.get("color"), parts.get("texture")
    rgba = "" if color is None else color.get("rgba", "")
    colour = numbers(rgba)
    image = "" if texture is None else texture.get("filename", "")
    return rgba if colour is None else colour, image
