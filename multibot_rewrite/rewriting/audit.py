"""What a person should know about a description before it is rewritten: one function a question."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from lxml.etree import _Element

from multibot_rewrite.model import ERROR, WARNING, Claim, Finding, Site
from multibot_rewrite.naming import (
    CLOSED_KINDS,
    Naming,
    is_keyword,
)
from multibot_rewrite.rewriters.spelling import kind_of, must_be_declared, names_in
from multibot_rewrite.rewriters.tree import ANY_WITH_ROS, Tree, library_key
from multibot_rewrite.rewriting.collect import Inventory
from multibot_rewrite.rewriting.document import Document, finding
from multibot_rewrite.rewriting.hazards import hazards
from multibot_rewrite.rewriting.remarks import Remark, told
from multibot_rewrite.vocabulary import Rewriter


def audit(inventory: Inventory, naming: Naming, tree: Tree) -> list[Finding]:
    """All findings that do not depend on the robot's name, in source order."""
    found = [
        *leftover_xacro(inventory),
        *worlds(inventory),
        *duplicates(inventory),
        *dangling(inventory, naming),
        *ambiguous(inventory),
        *told(inventory.document, unknown_plugins(inventory, tree), WARNING),
        *told(inventory.document, unknown_hardware(inventory, tree), WARNING),
        *hazards(inventory, naming),
    ]
    return sorted(found, key=lambda item: (item.line, item.column, item.code))


def leftover_xacro(inventory: Inventory) -> Iterator[Finding]:
    """Elements and substitutions that only xacro understands."""
    document = inventory.document
    source = document.source
    hint = "expand it first: give the file the name ….xacro, or run xacro"
    elements = document.root.iter("*") if _uses_xacro(document) else iter(())
    tags = ((str(e.tag), start) for e, start in zip(elements, document.starts, strict=False))
    tag, start = next(((tag, start) for tag, start in tags if "/xacro}" in tag), ("", 0))
    if tag:
        message = f"xacro element <{tag.rpartition('}')[2]}>"
        yield finding(document, start, "MB105", ERROR, message, hint)
    elif b"${" in source or b"$(arg" in source:
        value, start = next(_substitutions(document), ("", 0))
        if value:
            message = f"xacro substitution {value!r}"
            yield finding(document, start, "MB105", ERROR, message, hint)


def _substitutions(document: Document) -> Iterator[tuple[str, int]]:
    """Values that hold one, claimed or not, and their elements; comments do not count."""
    for element, start in zip(document.root.iter("*"), document.starts, strict=True):
        values = (*element.values(), element.text or "", *(c.tail or "" for c in element))
        for value in values:
            if "${" in value or "$(arg" in value:
                yield " ".join(str(value).split()), start


def _uses_xacro(document: Document) -> bool:
    """A cheap look before the search: is a prefix bound to xacro, and is it used?"""
    spaces = document.root.nsmap.items()
    prefixes = {f"<{prefix}:" for prefix, uri in spaces if prefix and "/xacro" in uri}
    return any(prefix.encode() in document.source for prefix in prefixes | {"<xacro:"})


def duplicates(inventory: Inventory) -> Iterator[Finding]:
    """Two declarations of one name in one model; a <gazebo> block may repeat a URDF joint (PR2)."""
    seen: dict[tuple[Site, _Element | None, str], Claim] = {}
    for claim in inventory.claims:
        kind = claim.site.kinds[0]
        if claim.site.role != "declares" or kind not in CLOSED_KINDS:
            continue
        key = claim.site, _scope(claim.element), claim.value.strip()
        first = seen.setdefault(key, claim)
        if first is not claim:
            line = finding(inventory.document, first.start, "", "", "").line
            message = f"{kind} {claim.value!r} is declared twice, first at line {line}"
            yield finding(inventory.document, claim.start, "MB201", ERROR, message, "rename one")


def _scope(element: _Element) -> _Element | None:
    """The model that a declaration stands in: names of nested SDF models are their own."""
    return next(element.iterancestors("model", "robot"), None)


def worlds(inventory: Inventory) -> Iterator[Finding]:
    """A world holds several models: which of them is the robot, nobody can tell."""
    document = inventory.document
    starts = zip(document.root.iter("*"), document.starts, strict=True)
    for element, start in starts if document.root.tag == "sdf" else ():
        if element.tag == "world":
            message = f"world {element.get('name', '')!r} cannot be rewritten for one robot"
            hint = "give the model.sdf of the robot, and <include> the results in the world"
            yield finding(document, start, "MB109", ERROR, message, hint)


def dangling(inventory: Inventory, naming: Naming) -> Iterator[Finding]:
    """Uses of a link or joint that nothing declares: they stay as they are."""
    declared = inventory.declared
    for claim in inventory.claims:
        site = claim.site
        if site.role != "uses" or not must_be_declared(site):
            continue
        if any(claim.value in declared.get(kind, ()) for kind in site.kinds):
            continue
        for part in names_in(claim, declared):
            if part.text in naming.shared_frames or is_keyword(part.text):
                continue
            if not kind_of(part, site.role, declared):
                yield _dangling(inventory, claim, part.text, part.kinds)


def _dangling(inventory: Inventory, claim: Claim, name: str, kinds: tuple[str, ...]) -> Finding:
    words = " or ".join(kinds)
    known = [known for kind in kinds for known in inventory.declared.get(kind, ())]
    near = nearest(name, known)
    return finding(
        inventory.document,
        claim.start,
        "MB202",
        WARNING,
        f"{_where(claim)} names the {words} {name!r}, which is not declared: it stays as it is",
        f"did you mean {near!r}?" if near else "",
    )


def _where(claim: Claim) -> str:
    """``<tag>`` or ``tag@attribute``; all parameters have one tag, so theirs has the name in it."""
    tag = str(claim.element.tag)
    if claim.attribute:
        return f"{tag}@{claim.attribute}"
    name = claim.element.get("name") if tag == "param" else None
    return f'<{tag} name="{name}">' if name else f"<{tag}>"


def nearest(name: str, known: Collection[str]) -> str:
    """The known name most like ``name``, or an empty string."""
    from difflib import get_close_matches  # only a message needs it

    return next(iter(get_close_matches(name, known, 1, 0.7)), "")


def ambiguous(inventory: Inventory) -> Iterator[Finding]:
    """A ``<gazebo reference>`` that is the name of a link and of a joint: the link is taken."""
    for claim in inventory.claims:
        if claim.site.kinds != ("link", "joint"):
            continue
        if all(claim.value in inventory.declared[kind] for kind in claim.site.kinds):
            message = f"{claim.value!r} is both a link and a joint; it is taken for the link"
            yield finding(
                inventory.document,
                claim.start,
                "MB203",
                WARNING,
                message,
                "SDF refuses such a pair",
            )


def is_unknown(rewriter: Rewriter) -> bool:
    """No section knows the plugin: the element's own stands in, or the one for any ROS node."""
    return rewriter.select == "plugin" or rewriter.names[0] == ANY_WITH_ROS


def unknown_plugins(inventory: Inventory, tree: Tree) -> Iterator[Remark]:
    """Plugins no section knows: what their parameters name can only be guessed."""
    known = {}
    for host in inventory.hosts:
        rewriter = host.node.rewriter
        if rewriter is None or not is_unknown(rewriter):
            continue
        name = host.element.get("filename") or host.element.get("name") or ""
        if name not in known:
            known[name] = nearest(library_key(name), tree.vocabulary.names("plugin"))
        near = known[name]
        yield Remark(
            host.element,
            host.start,
            None,
            "MB902",
            f"plugin {name!r} is not in the vocabulary: its own parameters stay as they are",
            f"the nearest known one is {near!r}" if near else "",
        )


def unknown_hardware(inventory: Inventory, tree: Tree) -> Iterator[Remark]:
    """Hardware classes no section knows that have parameters: one may be a name, or a prefix."""
    for host in inventory.hosts:
        rewriter = host.node.rewriter
        if rewriter is None or rewriter.select != "hardware":
            continue
        name = host.element.findtext("hardware/plugin", "").strip()
        if not name or host.element.find("hardware/param") is None:
            continue
        near = nearest(name, tree.vocabulary.names("hardware"))
        yield Remark(
            host.element,
            host.start,
            None,
            "MB903",
            f"hardware class {name!r} is not in the vocabulary: its own parameters stay as they are",
            f"the nearest known one is {near!r}" if near else "",
        )
