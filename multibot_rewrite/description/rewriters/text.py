# SPDX-License-Identifier: Apache-2.0
"""The text of an element as its consumers read it.

TinyXML-2, which urdfdom, ros2_control and sdformat read with, takes the first text and skips comments
before it (``XMLElement::GetText``, since 8.1); white space alone is no text, and sdformat trims it
around a text (Param.cc).
"""

from __future__ import annotations

from lxml import etree


def text_of(element: etree._Element) -> str:
    """Return the first text of an element, also behind comments, stripped; empty without one."""
    text = (element.text or "").strip()
    if text or not len(element):
        return text
    for child in element:
        if not isinstance(child, etree._Comment):
            break
        if text := (child.tail or "").strip():
            return text
    return ""


def text_at(element: etree._Element, path: str) -> str:
    """Return the text of the first element at ``path``; empty without one."""
    # For a single tag this takes a third of the time of find, which reads its path anew.
    found = element.find(path) if "/" in path else next(element.iterchildren(path), None)
    return "" if found is None else text_of(found)


# Found quickly: few blocks have one.
_KEEPING = etree.XPath("gazebo[preserveFixedJoint or disableFixedJointLumping]")


def kept_joints(root: etree._Element) -> frozenset[str]:
    """Return the fixed joints that a block keeps from being merged (sdformat, parser_urdf.cc)."""
    blocks: list[etree._Element] = _KEEPING(root)  # type: ignore[assignment]
    return frozenset(
        block.get("reference", "")
        for block in blocks
        for tag in ("preserveFixedJoint", "disableFixedJointLumping")
        if text_at(block, tag).lower() in ("true", "yes", "1")
    )


def end_of(joint: etree._Element, tag: str) -> str:
    """Return the link at an end of a URDF's joint, its ``parent`` or ``child``; empty without one."""
    found = joint.find(tag)
    return "" if found is None else found.get("link", "")
