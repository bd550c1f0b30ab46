"""SDF looks a name up in the model it is in, where a link and a joint cannot share it.

The plan knows names by kind only. Where two models of a file use one name for two kinds, the model
that the reference leads to decides.
"""

from __future__ import annotations

from lxml import etree

from multibot_rewrite.description.rewriters.forms import Declared, NamePart


def scope_of(element: etree._Element) -> etree._Element | None:
    """The model (or robot) whose names a value of ``element`` is looked up among.

    A model's own pose is looked up among its siblings.
    """
    if element.tag == "pose" and _is_model(element.getparent()):
        element = element.getparent()  # type: ignore[assignment]
        return next(element.iterancestors("model", "robot"), None)
    return element if _is_model(element) else next(element.iterancestors("model", "robot"), None)


def _is_model(element: etree._Element | None) -> bool:
    return element is not None and element.tag == "model"


def in_scope(
    element: etree._Element, parts: tuple[NamePart, ...], declared: Declared
) -> tuple[NamePart, ...]:
    """``parts`` of a scoped name, the last one's kind decided where the file has it as several."""
    if not parts:
        return parts
    last = parts[-1]
    kinds = [kind for kind in last.kinds if last.text in declared.get(kind, ())]
    if len(kinds) < 2:
        return parts
    scope = scope_of(element)
    for part in parts[:-1]:
        scope = _child(scope, "model", part.text)
    here = [kind for kind in kinds if _child(scope, kind, last.text) is not None]
    return (*parts[:-1], last._replace(matched=tuple(here[:1])))


def _child(scope: etree._Element | None, tag: str, name: str) -> etree._Element | None:
    found = scope.iterchildren(tag) if scope is not None else iter(())
    return next((child for child in found if child.get("name") == name), None)
