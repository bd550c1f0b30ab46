# SPDX-License-Identifier: Apache-2.0
"""The ports of a behavior tree and the kinds of names in them: read from ``behavior_tree.yaml``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any

from multibot_rewrite.base.bounded import load_own_yaml
from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.names.placeholders import without_robot
from multibot_rewrite.companions.sites import UNCLEAR, XML, Site, Slot
from multibot_rewrite.description.steps.document import Document, value_slot

if TYPE_CHECKING:
    from lxml.etree import _Element

NAVIGATOR = "bt_navigator"
GRAPH_KINDS = {"service": "service", "topic": "topic", "action": "topic"}
# <Action ID="Spin"/> is <Spin/>.
_FORMS = frozenset({"Action", "Condition", "Decorator", "Control"})
_SUBTREES = frozenset({"SubTree", "SubTreePlus"})
_SHARED = ("_autoremap", "__autoremap", "__shared_blackboard")
_MODEL = "TreeNodesModel"


class _Trees(NamedTuple):
    """The trees of a file by id; ``braces`` is true if only ``{entry}`` is an entry (BT.CPP 4)."""

    by_id: Mapping[str, _Element]
    braces: bool


@cache
def port_data() -> Mapping[str, Any]:
    """The data of ``behavior_tree.yaml``."""
    return dict(load_own_yaml(__file__, "behavior_tree.yaml"))


def ports_of(document: Document) -> Iterator[tuple[_Element, Site]]:
    """Every literal with the kind of name it is; models for editors are left out."""
    trees = _trees(document.root)
    for element, start in zip(document.root.iter("*"), document.starts, strict=True):
        if is_model(element):
            yield from _model_default(document, element, start, trees)
            continue
        for attribute, value in element.items():
            if not _blackboard_entry(element, str(value), trees):
                kind = _kind(element, str(attribute), trees)
                yield element, _site(document, start, str(attribute), str(value), kind)


def _site(document: Document, start: int, attribute: str, value: str, kind: str) -> Site:
    slot = value_slot(document.source, start, attribute, value)
    first, last = slot or (start, start)
    style = UNCLEAR if slot is None else XML
    place = locate(document.source, first)
    written = Slot(*place, character(document, first), character(document, last), value, style)
    text = without_robot(value, "/" if kind in GRAPH_KINDS else "") if kind else value
    return Site(GRAPH_KINDS.get(kind, kind), text, attribute, written, node=NAVIGATOR)


def character(document: Document, at: int) -> int:
    """Templates count characters, documents bytes."""
    source = document.source
    return at if source.isascii() else len(source[:at].decode())


def _trees(root: _Element) -> _Trees:
    found = {str(it.get("ID", "")): it for it in root.iter("BehaviorTree")}
    return _Trees(found, str(root.get("BTCPP_format", "3")).startswith("4"))


def is_model(element: _Element) -> bool:
    return element.tag == _MODEL or any(it.tag == _MODEL for it in element.iterancestors())


def _model_default(
    document: Document, element: _Element, start: int, trees: _Trees
) -> Iterator[tuple[_Element, Site]]:
    """BT.CPP takes defaults from models of subtrees; other models are for editors."""
    above = element.getparent()
    if above is None or above.tag not in _SUBTREES or "default" not in element.attrib:
        return
    name, value = str(element.get("name", "")), str(element.get("default"))
    kind = _entry_kinds(trees, str(above.get("ID", "")), ()).get(name) or port_data()["ports"].get(
        name
    )
    yield element, _site(document, start, "default", value, kind or "")


def _kind(element: _Element, attribute: str, trees: _Trees) -> str:
    """The kind of name that a literal is; empty if that is not known."""
    if element.tag == "SetBlackboard" and attribute == "value":
        tree = next((it for it in element.iterancestors("BehaviorTree")), None)
        entries = _entry_kinds(trees, str(tree.get("ID", "")) if tree is not None else "", ())
        return entries.get(str(element.get("output_key", "")).strip("{}"), "")
    if attribute in port_data()["keep"]:
        return ""
    return _port_kind(element, attribute, trees, ())


def _port_kind(element: _Element, attribute: str, trees: _Trees, above: tuple[str, ...]) -> str:
    if element.tag in _SUBTREES:
        inside = _entry_kinds(trees, str(element.get("ID", "")), above).get(attribute)
        return inside or port_data()["ports"].get(attribute, "")
    own = port_data()["nodes"].get(node_name(element), {})
    return str(own.get(attribute) or port_data()["ports"].get(attribute, ""))


def node_name(element: _Element) -> str:
    return str(element.get("ID", "")) if element.tag in _FORMS else str(element.tag)


def _blackboard_entry(element: _Element, value: str, trees: _Trees) -> str:
    """The blackboard entry that a value stands for; empty for a literal."""
    if value.startswith("{") and value.endswith("}"):
        return value[1:-1]
    # A plain SubTree of BT.CPP 3 maps entries by their bare names.
    return value if element.tag == "SubTree" and not trees.braces else ""


def _entry_kinds(trees: _Trees, name: str, above: tuple[str, ...]) -> dict[str, str]:
    """The kind of name in each entry that a tree reads, by its use there and in subtrees."""
    tree = trees.by_id.get(name)
    if tree is None or name in above:
        return {}
    found: dict[str, str] = {}
    for element in tree.iter("*"):
        for attribute, value in element.items():
            entry = _blackboard_entry(element, str(value), trees)
            # What an element is called is no port.
            if not entry or attribute == "name":
                continue
            if kind := _port_kind(element, str(attribute), trees, (*above, name)):
                found.setdefault(entry, kind)
        if any(element.get(it) in ("true", "1") for it in _SHARED):
            found = {**_entry_kinds(trees, str(element.get("ID", "")), (*above, name)), **found}
    return found
