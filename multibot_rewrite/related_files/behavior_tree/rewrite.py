# SPDX-License-Identifier: Apache-2.0
"""Nav2 behavior trees for any number of robots: ports that hold services, topics and frames.

rcl remaps a name in a port like any other name of the BT navigator. ``{entry}`` is a blackboard
entry and stays; a value put into an entry is renamed like the ports of the subtrees that read it.
"""

from collections.abc import Iterator, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

from multibot_rewrite.base.bounded import load_own_yaml
from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.description.steps.document import Document, read_document, value_slot
from multibot_rewrite.related_files.context import Context
from multibot_rewrite.related_files.engine import with_slots
from multibot_rewrite.related_files.named_file import TREE, NamedFile, RelatedFile
from multibot_rewrite.related_files.names.by_kind import SPELLERS
from multibot_rewrite.related_files.names.placeholders import without_robot
from multibot_rewrite.related_files.sites import UNCLEAR, XML, Site, Slot
from multibot_rewrite.related_files.yaml_text import Splice

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

    by_id: "Mapping[str, _Element]"
    braces: bool


@cache
def port_data() -> Mapping[str, Any]:
    """Return the data of ``behavior_tree.yaml``."""
    return dict(load_own_yaml(__file__, "behavior_tree.yaml"))


def ports_of(document: Document) -> "Iterator[tuple[_Element, Site]]":
    """Yield (element, site) for every literal of known kind; models for editors are left out."""
    found = {str(it.get("ID", "")): it for it in document.root.iter("BehaviorTree")}
    trees = _Trees(found, str(document.root.get("BTCPP_format", "3")).startswith("4"))
    for element, start in zip(document.root.iter("*"), document.starts, strict=True):
        if is_model(element):
            yield from _model_default(document, element, start, trees)
            continue
        for attribute, value in element.items():
            if not _blackboard_entry(element, str(value), trees):
                kind = _kind_of_literal(element, str(attribute), trees)
                yield element, _site_of(document, start, str(attribute), str(value), kind)


def _site_of(document: Document, start: int, attribute: str, value: str, kind: str) -> Site:
    slot = value_slot(document.source, start, attribute, value)
    first, last = slot or (start, start)
    style = UNCLEAR if slot is None else XML
    place = locate(document.source, first)
    written = Slot(*place, character(document, first), character(document, last), value, style)
    text = without_robot(value, "/" if kind in GRAPH_KINDS else "") if kind else value
    return Site(GRAPH_KINDS.get(kind, kind), text, attribute, written, node=NAVIGATOR)


def character(document: Document, at: int) -> int:
    """Return the character of a byte offset: templates count characters, documents bytes."""
    source = document.source
    return at if source.isascii() else len(source[:at].decode())


def is_model(element: "_Element") -> bool:
    """Return whether an element is in the tree's declarations of nodes."""
    return element.tag == _MODEL or any(it.tag == _MODEL for it in element.iterancestors())


def _model_default(
    document: Document, element: "_Element", start: int, trees: _Trees
) -> "Iterator[tuple[_Element, Site]]":
    """Yield (element, site) of a subtree model's default, which BT.CPP reads; not of others."""
    above = element.getparent()
    if above is None or above.tag not in _SUBTREES or "default" not in element.attrib:
        return
    name, value = str(element.get("name", "")), str(element.get("default"))
    kind = _entry_kinds(trees, str(above.get("ID", "")), ()).get(name) or port_data()["ports"].get(
        name
    )
    yield element, _site_of(document, start, "default", value, kind or "")


def _kind_of_literal(element: "_Element", attribute: str, trees: _Trees) -> str:
    """Return the kind of name that a literal is; empty if that is not known."""
    if element.tag == "SetBlackboard" and attribute == "value":
        tree = next((it for it in element.iterancestors("BehaviorTree")), None)
        entries = _entry_kinds(trees, str(tree.get("ID", "")) if tree is not None else "", ())
        return entries.get(str(element.get("output_key", "")).strip("{}"), "")
    if attribute in port_data()["keep"]:
        return ""
    return _port_kind(element, attribute, trees, ())


def _port_kind(element: "_Element", attribute: str, trees: _Trees, above: tuple[str, ...]) -> str:
    if element.tag in _SUBTREES:
        inside = _entry_kinds(trees, str(element.get("ID", "")), above).get(attribute)
        return inside or port_data()["ports"].get(attribute, "")
    own = port_data()["nodes"].get(node_name(element), {})
    return str(own.get(attribute) or port_data()["ports"].get(attribute, ""))


def node_name(element: "_Element") -> str:
    """Return the name of the behavior tree node that an element is."""
    return str(element.get("ID", "")) if element.tag in _FORMS else str(element.tag)


def _blackboard_entry(element: "_Element", value: str, trees: _Trees) -> str:
    """Return the blackboard entry that a value refers to; empty for a literal."""
    if value.startswith("{") and value.endswith("}"):
        return value[1:-1]
    # A plain SubTree of BT.CPP 3 maps entries by their bare names.
    return value if element.tag == "SubTree" and not trees.braces else ""


def _entry_kinds(trees: _Trees, name: str, above: tuple[str, ...]) -> dict[str, str]:
    """Return the kind of name in each entry that a tree reads, by its use there and in subtrees."""
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


def rewrite_behavior_tree(data: bytes, file: str, context: Context) -> RelatedFile:
    """Return a behavior tree with slots for a robot; raises InputError for another file."""
    document = read_tree(data, file)
    # Written out even if a rule would do: rules do not reach the navigator's helper nodes.
    return with_slots(named_ports(document, context), {}, _default_splices(document, context))


def _default_splices(document: Document, context: Context) -> Iterator[Splice]:
    """Yield the ports to add that are left out and whose default all robots would share."""
    for element, start in zip(document.root.iter("*"), document.starts, strict=True):
        name = node_name(element)
        for it in port_data()["defaults"] if not is_model(element) else ():
            if it["node"] != name or it["port"] in element.attrib or it["unless"] in element.attrib:
                continue
            new = SPELLERS[it["kind"]](context, it["value"])
            if has_release(it["releases"], context.distro) and new != it["value"]:
                at = character(document, start + 1 + len(str(element.tag).encode()))
                yield Splice(at, at, f' {it["port"]}="{new}"')


def read_tree(data: bytes, file: str) -> Document:
    """Return the document; raises InputError for a file that is not a behavior tree."""
    if not data.strip():
        raise InputError(f"{file}:1: the file is empty; a behavior tree starts with <root>")
    document = read_document(data, file)
    if document.root.tag != "root":
        place = f"{file}:{document.root.sourceline or 1}"
        raise InputError(f"{place}: not a behavior tree: the root is <{document.root.tag}>")
    return document


def named_tree(data: bytes, file: str, context: Context) -> NamedFile:
    """Return the names of a tree; raises as ``read_tree``."""
    return named_ports(read_tree(data, file), context)


def named_ports(document: Document, context: Context) -> NamedFile:
    """Return the names in the ports of a tree."""
    every = list(ports_of(document))
    free = [it for element, it in every if element.tag != "include"]
    included = tuple(it for element, it in every if element.tag == "include")
    names = tuple(it for it in free if it.kind)
    known = port_data()
    others = []
    for site in (it for it in free if not it.kind and it.key not in known["keep"]):
        # The strings of a script, otherwise the whole value.
        inside = site.text.replace('"', "'").split("'")[1::2]
        texts = [it.strip() for it in inside] if site.key in known["scripts"] else [site.text]
        others += [site._replace(text=it) for it in texts]
    text = document.source.decode()
    return NamedFile(
        TREE, document.file, text, context, {}, names, tuple(others), included=included
    )
