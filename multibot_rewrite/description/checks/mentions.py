# SPDX-License-Identifier: Apache-2.0
"""Names of links, joints and lights in values that no site claims: a rewrite leaves them so."""

import re
from collections import Counter
from collections.abc import Collection, Iterator
from functools import lru_cache
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.base.conventions import ROWS, USUAL_FRAMES
from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import SiteRow
from multibot_rewrite.base.naming import TF_TOPICS, Naming, spelled
from multibot_rewrite.base.releases import ROS_1, ROS_2
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.readback.active import is_loaded
from multibot_rewrite.description.rewriters.text import text_at, text_of
from multibot_rewrite.description.rewriters.tree import Tree, TreeNode, values_of_plugin
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.document import finding, value_slot

# Kinds whose names are looked for in values without a site.
MENTIONED = ("link", "joint", "light")
HARDWARE, PLUGIN = "hardware", "plugin"
# Of these urdfdom reads attributes and children.
NO_TEXT = frozenset({"link", "joint"})
# Frames that no description declares are common words: they count where the key says so.
_FRAME_KEY = lazy_compile(r"(?:^|_)(?:frame|frame_id|link)$")
# What is between names: of lists and paths, of structures, and of what has parts. A name may hold
# what is between others, so that each is a look of its own.
_BETWEEN = (
    lazy_compile(r":=|::|[\s,;/]+"),
    lazy_compile(r"[\s,;\[\](){}\"']+"),
    lazy_compile(r":=|::|[\s,;/\[\](){}\"'=|]+"),
    lazy_compile(r"[\s,;/\[\](){}\"'=|:.]+"),
)
_PARTED = lazy_compile(r"[\s,;/\[\](){}\"'=|:.]")
_SPACED = lazy_compile(r"[\s,;\[\](){}\"'=|]+")
# A file is found by its name, whatever the links are called.
_FILES = tuple(ending for endings, _ in ROWS["endings"] for ending in endings)
_NUMERIC = "-+0123456789.eE \t\n\r\v\f"


# What was found out for elements: a root may have thousands of children.
Nodes = dict[etree._Element, TreeNode | None]


class Mention(NamedTuple):
    """An unclaimed value that is ``name`` or holds it; ``attribute`` is empty for text."""

    element: etree._Element
    start: int
    attribute: str
    value: str
    name: str


def find_mentions(
    inventory: Inventory,
    values: list[str],
    names: Collection[str],
    tree: Tree,
    usual: Collection[str] = (),
) -> list[Finding]:
    """Return a warning for each of ``unclaimed_mentions``, at the value itself."""
    document = inventory.document
    found = []
    for it in unclaimed_mentions(inventory, values, names, tree, usual):
        slot = value_slot(document.source, it.start, it.attribute, it.value)
        problem = as_problem(it)
        at = slot[0] if slot else it.start
        found.append(finding(document, at, problem.code, WARNING, problem.message, problem.hint))
    return found


def unclaimed_mentions(
    inventory: Inventory,
    values: list[str],
    names: Collection[str],
    tree: Tree,
    usual: Collection[str] = (),
) -> list[Mention]:
    """Return each unclaimed value that is or holds one of ``names``, or is a ``usual`` one.

    A name is held as a list item, path segment, scope or side of a remap rule. ``values`` are
    all of ``slot_values``. Those with a ``keep`` site, and those that a plugin does not read,
    are no mention."""
    if not (names or usual):
        return []
    telling = _values_with_names(values, frozenset(names)) | {
        it: it for it in {*usual}.intersection(values)
    }
    count = Counter(filter(telling.__contains__, values))
    claimed = Counter([claim.value for claim in inventory.claims])
    suspects = {value for value in telling if count[value] > claimed[value]}
    if not suspects:
        return []
    nodes: Nodes = {}
    return [
        Mention(*slot, telling[slot[3]])
        for slot in _unclaimed(inventory, suspects)
        if not kept(slot[0], slot[2], tree, nodes)
        and not _is_unread(slot[0], slot[2], tree, nodes)
        and (telling[slot[3]] in names or _is_meant(slot[0], slot[2], slot[3]))
    ]


def _is_unread(element: etree._Element, attribute: str, tree: Tree, nodes: Nodes) -> bool:
    """Return whether no consumer reads a value."""
    # That is text that urdfdom skips (model.cpp, link.cpp, joint.cpp), a parameter that no release
    # of a plugin or hardware reads, and the call of a macro that xacro has left.
    if any(map(is_macro_call, (element, *element.iterancestors()))):
        return True
    parent = element.getparent()
    if not attribute and element.tag in NO_TEXT and parent is not None and parent.tag == "robot":
        return True
    path = ""
    for parent in element.iterancestors():
        path = f"{element.tag}/{path}"
        if parent.tag == HARDWARE:
            name = element.get("name", "")
            every = [tree.definitions.values(text_at(parent, PLUGIN))]
        elif parent.tag == PLUGIN:
            node = node_of(parent, tree, nodes)
            loader = node.section.ros if node and node.section else ""
            flavours = [it == ROS_1 for it in (ROS_2, ROS_1) if loader in ("", it)]
            every = [values_of_plugin(parent, tree.definitions, it) for it in flavours]
            # A node's own element has a known content.
            name = path[:-1] if path.startswith("ros/") else str(element.tag)
        else:
            element = parent
            continue
        known = list(filter(None, every))
        return bool(known) and not any(it.is_open or {name, "/*"} & {*it.rows} for it in known)
    return False


def is_macro_call(element: etree._Element) -> bool:
    """Return whether an element is a macro call without ``xacro:`` that xacro has left."""
    # No parser of a URDF reads an attribute ``parent`` there.
    above = element.getparent()
    is_top = above is not None and above.tag == "robot"
    return is_top and "parent" in element.attrib and element.find("origin") is not None


def _is_meant(element: etree._Element, attribute: str, value: str) -> bool:
    """Return whether a value is a tf topic, or a usual frame at a key for frames."""
    return value.startswith("/") or _FRAME_KEY.search(attribute or str(element.tag)) is not None


def usual_names(naming: Naming) -> frozenset[str]:
    """Return the frames and topics of tf that no description declares and that a rewrite renames."""
    topics = (f"/{it}" for it in TF_TOPICS if naming.layout.tf_per_robot)
    frames = (it for it in USUAL_FRAMES if spelled(naming, "robot", "frame", it) != it)
    return frozenset((*topics, *frames))


def _values_with_names(values: list[str], names: frozenset[str]) -> dict[str, str]:
    """Return the values that are or hold one of the names, each with that name."""
    different = set(values)
    telling = {value: value for value in names & different}
    others = [value for value in different - names if value.strip(_NUMERIC)]
    # One look at all of them, then one without files: mostly none holds a name.
    if _name_in(" ".join(others), names) and _name_in(" ".join(map(_without_files, others)), names):
        telling |= {value: name for value in others if (name := mentioned(value, names))}
    return telling


def mentioned(value: str, names: frozenset[str]) -> str:
    """Return the name that a value is or holds; empty if it has none."""
    if value in names:
        return value
    return _name_in(_without_files(value), names) if value.strip(_NUMERIC) else ""


def _name_in(text: str, names: frozenset[str]) -> str:
    """Return a name that a text holds; empty if it has none."""
    for it in _splitters(names):
        words = it.split(text)
        if not names.isdisjoint(words):
            return next(word for word in words if word in names)
    return ""


@lru_cache(maxsize=4)
def _splitters(names: frozenset[str]) -> tuple[re.Pattern[str], ...]:
    """Return the patterns that split a text into words without cutting one of the names."""
    return _BETWEEN if any(map(_PARTED.search, names)) else _BETWEEN[-1:]


def _without_files(value: str) -> str:
    """Return a value without the words that are names of files or addresses."""
    if "." not in value and "://" not in value:
        return value
    words = _SPACED.split(value)
    files = {it for it in words if "://" in it or it.lower().endswith(_FILES)}
    return " ".join(it for it in words if it not in files) if files else value


def _unclaimed(
    inventory: Inventory, suspects: set[str]
) -> Iterator[tuple[etree._Element, int, str, str]]:
    """Yield (element, start, attribute or "", value) of suspect slots without a site, in order."""
    claimed = {(claim.start, claim.attribute) for claim in inventory.claims}
    document = inventory.document
    for element, start in zip(document.elements, document.starts, strict=True):
        if not _has_one(element, suspects):
            continue
        slots = [(str(key), str(value)) for key, value in element.items()]
        slots.append(("", text := text_of(element)))
        slots = [slot for slot in slots if (start, slot[0]) not in claimed]
        # Text behind a child, or more of it behind a comment, is never what a site claims.
        tails = [(child.tail or "").strip() for child in element]
        if text and not (element.text or "").strip():
            tails.remove(text)
        slots += [("", tail) for tail in tails]
        for attribute, value in slots:
            if value in suspects:
                yield element, start, attribute, value


def _has_one(element: etree._Element, suspects: set[str]) -> bool:
    """Return whether one of an element's values or texts is suspect, for a quick test."""
    if not suspects.isdisjoint(element.values()):
        return True
    texts = [element.text, *[it.tail for it in element]] if len(element) else [element.text]
    return any(it.strip() in suspects for it in texts if it)


def kept(element: etree._Element, attribute: str, tree: Tree, known: Nodes) -> SiteRow | None:
    """Return the ``keep`` site for a value, if there is one; ``known`` serves the next call."""
    node = node_of(element, tree, known)
    return node.keeps.get(attribute) if node else None


def node_of(element: etree._Element, tree: Tree, known: Nodes) -> TreeNode | None:
    """Return the node of the tree that serves an element."""
    if element not in known:
        parent = element.getparent()
        above = None if parent is None else node_of(parent, tree, known)
        node = above.children.get(str(element.tag)) if above else None
        if parent is None:
            node = tree.formats.get(tree.format_of(element))
        elif node is not None and node.select is not None:
            node = node.select(element)
        known[element] = node
    return known[element]


def as_problem(mention: Mention) -> Problem:
    """Return the problem of a mention."""
    element, _, attribute, value, name = mention
    where = f"{element.tag}@{attribute}" if attribute else f"<{element.tag}>"
    text = f"{where} holds {value!r}" if value == name else f"{where} holds {name!r} in {value!r}"
    message = f"{text}, but its use here is not known: it is not renamed"
    hint = "add a line to a file of plugin definitions: uses or declares for a name, or keep"
    if any(it.tag == PLUGIN and not is_loaded(it) for it in element.iterancestors()):
        message = f"{text}, in a <plugin> that nothing loads here: it is not renamed"
        hint = "move the <plugin> into a <gazebo>"
    return Problem(element, message, attribute, hint, (), "MB901")
