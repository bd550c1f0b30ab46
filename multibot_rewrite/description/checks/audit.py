# SPDX-License-Identifier: Apache-2.0
"""All checks of a description before it is rewritten."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator
from itertools import chain
from typing import TYPE_CHECKING

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, locate
from multibot_rewrite.base.lazy import lazy_compile, without_comments
from multibot_rewrite.base.loose_xml import DASHES, DEFAULT, LATE, slips
from multibot_rewrite.base.naming import Naming
from multibot_rewrite.base.releases import releases_with
from multibot_rewrite.description.checks import references
from multibot_rewrite.description.checks.hazards import hazards, ignored_namespaces, used_namespaces
from multibot_rewrite.description.checks.problem import Problem, to_findings
from multibot_rewrite.description.checks.twice import rewritten_before
from multibot_rewrite.description.checks.unknown import ANOTHER_RELEASE, not_here, unknown_parts
from multibot_rewrite.description.readback.xml import elements_at
from multibot_rewrite.description.rewriters.plugin_definitions.grammar import split_path
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.document import Document, tag_end

if TYPE_CHECKING:
    from multibot_rewrite.description.steps.renames import RenameMap


def audit(inventory: Inventory, renames: RenameMap, tree: Tree) -> list[Finding]:
    """Return all findings that do not depend on the robot's name, in source order."""
    document = inventory.document
    errors = chain(leftover_xacro(inventory), worlds(inventory), references.duplicates(inventory))
    warnings = chain(
        loosely_written(document),
        undeclared(inventory, renames.naming),
        references.ambiguous(inventory),
        unknown_parts(inventory, tree),
        rewritten_before(inventory),
        ignored_namespaces(inventory, tree),
        used_namespaces(inventory, tree),
        hazards(inventory, renames),
    )
    notes = chain(other_ros(inventory, tree), other_releases(inventory, tree))
    found = [
        *to_findings(document, errors, ERROR),
        *to_findings(document, warnings, WARNING),
        *to_findings(document, notes, NOTE),
    ]
    return sorted(found, key=lambda item: (item.line, item.column, item.code))


def leftover_xacro(inventory: Inventory) -> Iterator[Problem]:
    """Yield the first element or substitution that only xacro understands."""
    document = inventory.document
    hint = "expand it first: name the file ….xacro, or run xacro"
    elements = document.elements if uses_xacro(document) else ()
    element = next((it for it in elements if "/xacro}" in str(it.tag)), None)
    if element is not None:
        message = f"xacro element <{str(element.tag).rpartition('}')[2]}>"
        yield Problem(element, message, None, hint, (), "MB105")
        return
    # A cheap look before the search: in many files comments alone hold a substitution.
    source = document.source
    rest = without_comments(source) if b"${" in source or b"$(arg" in source else b""
    if b"${" not in rest and b"$(arg" not in rest:
        return
    # Claimed or not; comments do not count.
    for it in document.elements:
        values = (*it.values(), it.text or "", *(child.tail or "" for child in it))
        found = next((value for value in values if _SUBSTITUTION.search(str(value))), None)
        if found is not None:
            message = f"xacro substitution {' '.join(str(found).split())!r}"
            yield Problem(it, message, None, hint, (), "MB105")
            return


# An expression or an argument of xacro; ``${}`` has none.
_SUBSTITUTION = lazy_compile(r"\$\{\s*[^\s{}]|\$\(arg\s+[^\s()]")


def uses_xacro(document: Document) -> bool:
    """Return whether a prefix is bound to xacro and used; comments do not count."""
    spaces = document.root.nsmap.items()
    prefixes = {f"<{prefix}:" for prefix, uri in spaces if prefix and "/xacro" in uri}
    seen = any(prefix.encode() in document.source for prefix in prefixes | {"<xacro:"})
    return seen and any("xacro" in str(tag) for tag in {it.tag for it in document.elements})


def worlds(inventory: Inventory) -> Iterator[Problem]:
    """Yield a problem for each world: it holds several models, and the robot's is not known."""
    root = inventory.document.root
    for element in root.iter("world") if root.tag == "sdf" else ():
        message = f"world {element.get('name', '')!r} cannot be rewritten for one robot"
        hint = "give the model.sdf of the robot, and <include> the results in the world"
        yield Problem(element, message, None, hint, (), "MB109")


def undeclared(inventory: Inventory, naming: Naming) -> Iterator[Problem]:
    """Yield uses of a link or joint that nothing declares, so that they are not renamed."""
    loose = references.loose_ends(
        references.doubtful(inventory), inventory.declared, naming.shared_frames
    )
    for it in references.undeclared_names(loose, inventory.declared):
        yield it._replace(message=f"{it.message}: it is not renamed")


def other_releases(inventory: Inventory, tree: Tree) -> Iterator[Problem]:
    """Yield values that hold names in other releases only: nothing in them is renamed."""
    for host in inventory.hosts:
        section = host.node.section
        if section is None:
            continue
        for site in tree.definitions.rows_elsewhere(section.type, section.names[0]):
            if site.path in {it.path for it in section.sites} or site.role == "keep":
                continue
            where = not_here(tree.definitions, releases_with(site.releases))
            steps, attribute = split_path(site.path)
            for element in elements_at(host.element, steps):
                if attribute and element.get(attribute) is None:
                    continue
                message = f"{site.path} of {section.name} {where}: nothing in it is renamed"
                hint = f"delete it, or {ANOTHER_RELEASE}"
                yield Problem(element, message, None, hint, (), "MB905")


def other_ros(inventory: Inventory, tree: Tree) -> Iterator[Problem]:
    """Yield parameters that only the ROS 1 plugin reads, in a plugin of that name for ROS 2."""
    for host in inventory.hosts:
        section = host.node.section
        if section is None or section.type != "plugin" or section.ros != "2":
            continue
        flavours = tree.definitions.of_every_ros("plugin", section.names[0])
        theirs = {tag for other in flavours if other.ros == "1" for tag in other.tags}
        known = section.tags | host.node.children.keys()
        left = sorted({str(child.tag) for child in host.element} & (theirs - known))
        if left:
            tags = ", ".join(f"<{tag}>" for tag in left)
            message = f"{section.names[0]} does not read {tags} in ROS 2: nothing in it is renamed"
            hint = "delete what ROS 1 needed, or say it with <ros> and the names of ROS 2"
            yield Problem(host.element, message, None, hint, (), "MB904")


CODE = "MB146"
_READERS = "urdfdom and sdformat read it, but Python's XML parsers and xacro do not"
_MENDS = {
    DASHES: "write == for --",
    LATE: "delete what is before <?xml",
    DEFAULT: "delete xmlns=, or give it a prefix",
}


def loosely_written(document: Document) -> Iterator[Problem]:
    """Yield the first XML fault of each kind, at the next element, and each undeclared prefix."""
    if not document.is_mended:
        return
    source, starts = document.source, document.starts
    seen = set()
    for offset, what in slips(source):
        if what not in seen:
            seen.add(what)
            element = document.elements[min(bisect_left(starts, offset), len(starts) - 1)]
            line, _ = locate(source, offset)
            hint = f"{_MENDS[what]}; {_READERS}"
            yield Problem(element, f"{what} in line {line}", None, hint, (), CODE)
    # The prefixes that reading added to the root, with what they stand for.
    start = document.starts[0]
    written = document.source[start : tag_end(document.source, start)]
    for prefix, uri in document.root.nsmap.items():
        if prefix and b"xmlns:" + prefix.encode() not in written:
            space = f"{{{uri}}}"
            using = (
                it
                for it in document.elements
                if any(str(name).startswith(space) for name in (it.tag, *it.attrib))
            )
            found = next(using, document.root)
            message = f"the prefix {prefix!r} is not declared"
            hint = f'declare it on the root element: xmlns:{prefix}="{uri}"; {_READERS}'
            yield Problem(found, message, None, hint, (), CODE)
