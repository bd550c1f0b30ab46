"""What a person should know about a description before it is rewritten: one function a question."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator

from lxml.etree import _Element

from multibot_rewrite.model import ERROR, WARNING, Claim, Finding, Site
from multibot_rewrite.naming import (
    CLOSED_KINDS,
    FRAME_KINDS,
    NAMESPACE,
    POSTFIX,
    PREFIX,
    TF_TOPICS,
    Naming,
    affix,
    is_keyword,
)
from multibot_rewrite.rewriters.spelling import kind_of, must_be_declared, names_in, spell
from multibot_rewrite.rewriters.tree import ANY_WITH_ROS, Tree, library_key
from multibot_rewrite.rewriting.collect import Inventory
from multibot_rewrite.rewriting.document import Document, finding
from multibot_rewrite.rosnames import parse_remap
from multibot_rewrite.vocabulary import Rewriter


def audit(inventory: Inventory, naming: Naming, tree: Tree) -> list[Finding]:
    """All findings that do not depend on the robot's name, in source order."""
    found = [
        *leftover_xacro(inventory),
        *worlds(inventory),
        *duplicates(inventory),
        *dangling(inventory, naming),
        *ambiguous(inventory),
        *prefix_only(inventory, naming),
        *leading_slashes(inventory, naming),
        *moved_tf(inventory, naming),
        *bare_lookups(inventory, naming),
        *process_wide(inventory, naming),
        *outside_frames(inventory, naming),
        *unknown_plugins(inventory, tree),
        *reordered(inventory, naming),
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
            yield finding(document, start, "MB206", ERROR, message, hint)


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
    where = (
        f"{claim.element.tag}@{claim.attribute}" if claim.attribute else f"<{claim.element.tag}>"
    )
    return finding(
        inventory.document,
        claim.start,
        "MB202",
        WARNING,
        f"{where} names the {words} {name!r}, which is not declared: it stays as it is",
        f"did you mean {near!r}?" if near else "",
    )


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


def prefix_only(inventory: Inventory, naming: Naming) -> Iterator[Finding]:
    """Parameters that the consumer puts in front of names: they cannot hold a postfix."""
    if naming.affix == PREFIX or "sensor" not in naming.separators:
        return
    for claim in inventory.claims:
        if claim.site.form == "prefix":
            message = (
                f"{claim.site.path} {claim.value!r} stands in front of names that code makes, a "
                "postfix cannot reach them"
            )
            yield finding(
                inventory.document, claim.start, "MB304", WARNING, message, "use --affix prefix"
            )


def leading_slashes(inventory: Inventory, naming: Naming) -> Iterator[Finding]:
    """Frames written with a leading slash: kept, but tf2 look-ups reject them (buffer_core.cpp)."""
    for claim in inventory.claims:
        kinds = claim.site.kinds
        if claim.site.form != "whole" or kinds[0] not in FRAME_KINDS:
            continue
        if claim.value[:1] == "/" and claim.value[1:] not in naming.shared_frames:
            message = f"frame {claim.value!r} starts with a slash, tf2 look-ups reject it"
            yield finding(
                inventory.document, claim.start, "MB301", WARNING, message, "drop the slash"
            )


def moved_tf(inventory: Inventory, naming: Naming) -> Iterator[Finding]:
    """A rule of the file that takes a plugin off the one /tf which the layout wants."""
    for claim in inventory.claims if not naming.layout.tf_per_robot else ():
        rule = parse_remap(claim.value) if claim.site.form == "remap" else None
        if rule and rule.source.strip("/") in TF_TOPICS and rule.target != rule.source:
            message = f"{claim.value!r} takes this plugin off the one {rule.source} of the layout"
            hint = "drop the rule, or use --layout both"
            yield finding(inventory.document, claim.start, "MB305", WARNING, message, hint)


def bare_lookups(inventory: Inventory, naming: Naming) -> Iterator[Finding]:
    """Consumers that find things by bare name in the whole world, where those names stay bare."""
    declared = {claim.site.kinds[0] for claim in inventory.claims if claim.site.role == "declares"}
    for rewriter, start in _known_hosts(inventory):
        kind = rewriter.unique
        if kind in declared and kind not in naming.separators:
            message = (
                f"{rewriter.names[0]} looks {kind}s up by bare name in the whole world: "
                "it may find another robot's"
            )
            hint = f"--layout both spells {kind}s per robot"
            yield finding(inventory.document, start, "MB307", WARNING, message, hint)


def process_wide(inventory: Inventory, naming: Naming) -> Iterator[Finding]:
    """Remap rules that hold for every node of the process keep robots apart only by namespaces
    (gazebo_ros2_control_plugin.cpp and gz_ros2_control_plugin.cpp set the global arguments)."""
    if naming.topics != NAMESPACE:
        for rewriter, start in _known_hosts(inventory):
            if not rewriter.process_wide:
                continue
            message = (
                f"remap rules of {rewriter.names[0]} hold for the whole process, other robots' too"
            )
            hint = "with several robots in one Gazebo use --topics namespace"
            yield finding(inventory.document, start, "MB308", WARNING, message, hint)
        return
    inside = {host.element for host in inventory.hosts if _holds_for_all(host.node.rewriter)}
    for claim in inventory.claims if inside else ():
        rule = parse_remap(claim.value) if claim.site.form in ("remap", "argument") else None
        if rule is None or inside.isdisjoint(claim.element.iterancestors()):
            continue
        if rule.target.startswith("/"):
            message = f"{claim.value!r} holds for the whole process, other robots' nodes too"
            hint = "a relative target ends in each robot's own namespace"
            yield finding(inventory.document, claim.start, "MB308", WARNING, message, hint)


def _holds_for_all(rewriter: Rewriter | None) -> bool:
    return rewriter is not None and rewriter.process_wide


def _known_hosts(inventory: Inventory) -> Iterator[tuple[Rewriter, int]]:
    for host in inventory.hosts:
        if host.node.rewriter is not None:
            yield host.node.rewriter, host.start


def outside_frames(inventory: Inventory, naming: Naming) -> Iterator[Finding]:
    """A frame that an SRDF fixes its robot to, and that is spelled as if the robot had it."""
    for claim in inventory.claims:
        if claim.site.path != "virtual_joint@parent_frame" or claim.element.get("type") != "fixed":
            continue
        for kind, there in spell(claim, inventory.declared, naming):
            if kind == "frame":
                new = there.spell(claim.value, "ROBOT")
                message = (
                    f"the robot is fixed to {claim.value!r}, which becomes {new!r} for each ROBOT"
                )
                hint = f"--shared-frames world,map,{claim.value} keeps it"
                yield finding(inventory.document, claim.start, "MB309", WARNING, message, hint)


def is_unknown(rewriter: Rewriter) -> bool:
    """No section knows the plugin: the element's own stands in, or the one for any ROS node."""
    return rewriter.select == "plugin" or rewriter.names[0] == ANY_WITH_ROS


def unknown_plugins(inventory: Inventory, tree: Tree) -> Iterator[Finding]:
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
        yield finding(
            inventory.document,
            host.start,
            "MB902",
            WARNING,
            f"plugin {name!r} is not in the vocabulary: its own parameters stay as they are",
            f"the nearest known one is {near!r}" if near else "",
        )


def reordered(inventory: Inventory, naming: Naming) -> Iterator[Finding]:
    """urdfdom sorts sibling joints by name; a postfix can change that order, and with it the order
    of pinocchio's configuration vector."""
    if naming.affix != POSTFIX or "joint" not in naming.separators:
        return
    siblings: dict[str, list[str]] = defaultdict(list)
    declared = inventory.declared["joint"]
    for claim in inventory.claims:
        parent = claim.element.find("parent") if declared.get(claim.value) is claim else None
        if parent is not None:
            siblings[parent.get("link", "")].append(claim.value)
    for link, names in siblings.items():
        old = sorted(names)
        # The order may hang on the robot's name: a first and a last one show it.
        orders = [sorted(names, key=lambda name: _ordered(naming, name, r)) for r in "\0~"]
        new = next((order for order in orders if order != old), None)
        if new is not None:
            yield finding(
                inventory.document,
                inventory.declared["joint"][new[0]].start,
                "MB405",
                WARNING,
                f"the joints below link {link!r} change their order: {', '.join(new)}",
                "urdfdom sorts them by name, a prefix would not: --affix prefix",
            )


def _ordered(naming: Naming, name: str, robot: str) -> str:
    there = affix(naming, "joint", name)
    return there.spell(name, robot) if there else name
