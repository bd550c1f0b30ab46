# SPDX-License-Identifier: Apache-2.0
"""Makes the inventory of a document: claimed values, names in them, declarations, plugins."""

from collections.abc import Iterator
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.base import naming
from multibot_rewrite.base.file_kinds import DESCRIPTIONS, refuse_others
from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.model import FOR_OLD_GAZEBO, Claim, InputError, SiteRow
from multibot_rewrite.description.rewriters import renaming
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.model_namespaces import (
    below_models,
    names_in_topics,
    own_namespaces,
)
from multibot_rewrite.description.rewriters.plugin_definitions import PluginDefinition
from multibot_rewrite.description.rewriters.plugin_definitions.grammar import MODEL, SENT
from multibot_rewrite.description.rewriters.remap_rules import names_in_rules
from multibot_rewrite.description.rewriters.text import text_at, text_of
from multibot_rewrite.description.rewriters.tree import Tree, TreeNode
from multibot_rewrite.description.steps.document import Document, read_document

NOTHING: Declared = {}
SRDF = "srdf.robot"
# As the file has its names: no namespace is a word that a layout renames.
USUAL_LAYOUT = naming.find_layout(naming.DEFAULT_LAYOUT)._replace(namespaced=True)


class Host(NamedTuple):
    """An element whose section was chosen by what it loads: a plugin or a ros2_control system."""

    element: etree._Element
    start: int
    node: TreeNode


class Inventory(NamedTuple):
    """Everything a plan needs; ``names`` are in the order of ``claims``, ``format`` is the root's.

    ``declared`` has the declarations by kind and name, those of an SRDF's URDF included."""

    document: Document
    claims: list[Claim]
    hosts: list[Host]
    declared: dict[str, dict[str, Claim]]
    format: str
    names: list[tuple[renaming.ResolvedName, ...]]
    release: str

    @property
    def served(self) -> list[tuple[etree._Element, PluginDefinition]]:
        """The hosts that have a section, as (element, section)."""
        return [(it.element, it.node.section) for it in self.hosts if it.node.section is not None]

    @property
    def model(self) -> str:
        """Return the name of the model: that of <robot>, in SDF of the first <model>."""
        root = self.document.root
        return str(next(root.iter("robot", "model"), root).get("name", ""))

    @property
    def topics_in_full(self) -> frozenset[str]:
        """The topics that no ROS namespace reaches, as those of a simulated sensor."""
        pairs = zip(self.claims, self.names, strict=True)
        found = (name for claim, names in pairs if not claim.site.namespaced for name in names)
        return frozenset(name.text for name in found if name.kind == "topic")


def collect(
    document: Document,
    tree: Tree,
    urdf_declarations: Declared = NOTHING,
    layout: naming.Layout = USUAL_LAYOUT,
) -> Inventory:
    """Return the inventory of a document, read in order along the tree of rewriters.

    ``urdf_declarations`` is what the URDF of an SRDF declares. In a ``layout`` that names frames at
    run time these are not renamed as links are, and in one that keeps the names of models no topic
    is."""
    format_ = _root_format(document, tree, SRDF if urdf_declarations else "")
    claims, hosts = _walk(document, tree, format_)
    release = tree.definitions.release
    claims = _of_the_robot(below_models(claims, document.source, release))
    # No word of ROS is one that topics of Gazebo are made of.
    of_gz = claims
    if not layout.namespaced:
        served = ((it.element, it.node.section) for it in hosts if it.node.section is not None)
        claims = own_namespaces(claims, served)
    declared = _names_by_kind(claims, urdf_declarations)
    inventory = Inventory(document, claims, hosts, declared, format_, [], release)
    rules = names_in_rules(claims, inventory.served)
    rules = {**rules, **names_in_topics(of_gz, declared, layout.renames_models)}
    apart = layout.at_run_time
    return inventory._replace(names=renaming.resolved_names(claims, declared, apart, rules))


def values_with_own_model(inventory: Inventory) -> Iterator[Claim]:
    """Yield the values that use the name of the description's own model."""
    model = inventory.model
    for claim, names in zip(inventory.claims, inventory.names, strict=True):
        used = names if claim.site.role == "uses" else ()
        if any(it.kind == naming.MODEL and it.text == model for it in used):
            yield claim


def _walk(document: Document, tree: Tree, format_: str) -> tuple[list[Claim], list[Host]]:
    """Return the claims and hosts along the tree of one format."""
    claims: list[Claim] = []
    hosts: list[Host] = []
    nothing: dict[str, TreeNode] = {}
    below: dict[etree._Element | None, dict[str, TreeNode]]
    below = {None: {str(document.root.tag): tree.formats[format_]}}
    known = tree.tags
    for element, start in zip(document.elements, document.starts, strict=True):
        tag = element.tag
        # Most elements hold numbers: one look decides that nothing anywhere asks for them.
        if tag not in known:
            continue
        found = below.get(element.getparent(), nothing).get(tag)
        if found is None:
            continue
        select, active, attributes, text = found.visit
        if select is not None:
            found = select(element)
            if found.section is not None:
                hosts.append(Host(element, start, found))
            _, active, attributes, text = found.visit
        if active:
            below[element] = active
        for attribute, site in attributes:
            value = element.get(attribute)
            if value is not None:
                claims.append(Claim(site, element, start, attribute, value))
        if text is not None:
            value = text_of(element)
            if (value or renaming.takes_empty(text)) and _site_applies(text, element):
                claims.append(Claim(text, element, start, "", value))
    return claims, hosts


def _root_format(document: Document, tree: Tree, likely: str) -> str:
    """Return the section of the root element; raises InputError for no known one."""
    found = tree.format_of(document.root, likely)
    if not found:
        known = " or ".join(f"<{name}>" for name in sorted(tree.formats) if "." not in name)
        line, column = locate(document.source, document.starts[0])
        refuse_others(document.source, f"{document.file}:{line}:{column}", *DESCRIPTIONS)
        tag = etree.QName(document.root)
        where = f" in the namespace {tag.namespace!r}" if tag.namespace else ""
        hint = "take out its xmlns" if where else "give a robot description"
        raise InputError(
            f"{document.file}:{line}:{column}: the root element is <{tag.localname}>{where}, "
            f"expected {known}; {hint}",
            FOR_OLD_GAZEBO if tag.localname == "gazebo" else "",
        )
    return found


def _of_the_robot(claims: list[Claim]) -> list[Claim]:
    """Return the claims without the world's topics that nothing else in the document has."""
    if not any(it.site.when == SENT for it in claims):
        return claims
    others = (it for it in claims if it.site.when != SENT)
    sent = {it.value.strip("/ ") for it in others if it.site.kinds[0] in naming.TOPIC_KINDS}
    return [it for it in claims if it.site.when != SENT or it.value.strip("/ ") in sent]


def _site_applies(site: SiteRow, element: etree._Element) -> bool:
    """Return whether the sibling that a site depends on has one of the wanted texts."""
    if site.when in ("", SENT):
        return True
    sibling, _, texts = site.when.partition("=")
    parent = element.getparent()
    given = "" if parent is None else text_at(parent, sibling)
    if given and MODEL in texts.split("|"):
        models = element.getroottree().getroot().iter("robot", "model")
        return given in texts.split("|") or any(it.get("name") == given for it in models)
    return given in texts.split("|")


def _names_by_kind(claims: list[Claim], urdf_declarations: Declared) -> dict[str, dict[str, Claim]]:
    declared = {kind: dict(urdf_declarations.get(kind, {})) for kind in naming.DECLARED_KINDS}
    for claim in claims:
        site = claim.site
        if site.role != "declares" or site.kinds[0] not in declared:
            continue
        if name := claim.value.strip():
            declared[site.kinds[0]].setdefault(name, claim)
    return declared


def declarations(source: bytes, file: str, tree: Tree) -> Declared:
    """Return the names that a description declares, by kind and name."""
    return collect(read_document(source, file), tree).declared
