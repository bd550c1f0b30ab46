# SPDX-License-Identifier: Apache-2.0
"""The SRDFs of parts as one: groups, end effectors, states, passive joints and disabled collisions.

A virtual joint tells the place of a robot: that of the first part stays, a later part is on a link.
Links that meet at a joint between two parts are adjacent; of other pairs of links of two parts
random poses tell, where they are asked for.

Sources: moveit2 robot_model.cpp (``buildModel``: a virtual joint counts only where its child is the
root link), moveit_setup_assistant compute_default_collisions.cpp (``computeConnectionGraph``: links
without geometry between two others leave these adjacent).
"""

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import combinations, product
from typing import NamedTuple

from lxml import etree
from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.grouping import sets_by_key
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.wording import plural
from multibot_rewrite.description import pipeline
from multibot_rewrite.description.joining.part import PREFIXED, ReadPart, in_one_line, prefixing
from multibot_rewrite.description.joining.touching import ALWAYS, NEVER, Touching, touching
from multibot_rewrite.description.readback.xml import read_xml
from multibot_rewrite.description.rewriters.text import end_of
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.steps.collect import SRDF, collect, declarations
from multibot_rewrite.description.steps.document import read_document

_NAMED = ("group", "end_effector")
_USES = ("group", "group_state")
_PREFIX = "give the part a prefix of its own"


class PartSemantics(NamedTuple):
    """A part, its SRDF with its prefix or empty, and findings about names without prefix."""

    part: ReadPart
    data: bytes
    file: str
    findings: tuple[Finding, ...] = ()


class JoinedSemantics(NamedTuple):
    """One SRDF, and notes for the user."""

    data: bytes
    notes: tuple[str, ...]


def renamed_srdf(part: ReadPart, data: bytes, file: str, tree: Tree) -> PartSemantics:
    """Return the SRDF of a part with its prefix; raises InputError."""
    declared = declarations(part.data, part.file, tree)
    found = collect(read_document(data, file), tree, declared)
    if found.format != SRDF:
        raise InputError(f"{file}: it is <{found.document.root.tag}> of a URDF; name an SRDF")
    if not part.prefix:
        return PartSemantics(part, data, file)
    kinds = (*PREFIXED, "group")
    with in_one_line():
        prepared = pipeline.prepare(data, file, prefixing(kinds), tree, declared)
        data = next(pipeline.render(prepared, [part.prefix], again=True))
    return PartSemantics(part, data, file, tuple(prepared.findings))


def joined_srdf(
    parts: Sequence[PartSemantics], urdf: bytes, samples: int = 0, hint: str = _PREFIX
) -> JoinedSemantics:
    """Return one SRDF for the joined ``urdf``; raises InputError for a name that two parts have.

    ``hint`` says what to do then. With ``samples`` it raises as ``touching``."""
    described = read_xml(urdf, "the joined description")
    root = etree.Element("robot", name=described.get("name", ""))
    known: dict[tuple[str, ...], str] = {}
    for at, it in enumerate(parts):
        own = read_xml(it.data, it.file) if it.data else root.makeelement("robot", {})
        if at:
            without_virtual_joints(own)
        named = [(str(one.tag), one.get("name", "")) for tag in _NAMED for one in own.findall(tag)]
        for key in dict.fromkeys(named):
            if key in known:
                what = f"{key[0]} {key[1]!r} is in {known[key]}, too"
                raise InputError(f"{it.file}: {what}; {hint}")
            known[key] = it.file
        root.extend(list(own))
    reasons = dict.fromkeys(sorted(set(_adjacent(described, parts))), "Adjacent")
    others = [it for it in _between(described, parts) if it not in reasons]
    notes = []
    if others:
        what = f"{plural(len(others), 'pair')} of links of two parts are checked for collisions"
        notes = [f"SRDF: {what}; MoveIt's Setup Assistant finds those that never touch"]
    if samples and others:
        files = {link: it.part.file for it in parts for link in it.part.robot.link}
        found = touching(described, others, files, samples)
        reasons |= found.reasons
        notes = list(_notes(others, found, samples))
    for (one, other), why in reasons.items():
        etree.SubElement(root, "disable_collisions", link1=one, link2=other, reason=why)
    told = dict.fromkeys(str(it) for part in parts for it in part.findings if it.level == WARNING)
    return JoinedSemantics(xml_text(root), (*told, *notes))


def without_virtual_joints(own: _Element) -> None:
    """Take the virtual joints of an SRDF out, and their uses in groups and states."""
    joints = list(own.iterchildren("virtual_joint"))
    names = {it.get("name") for it in joints}
    uses = (it for tag in _USES for above in own.findall(tag) for it in above.findall("joint"))
    for it in [*joints, *(it for it in uses if it.get("name") in names)]:
        above = it.getparent()
        if above is not None:
            above.remove(it)


def xml_text(root: _Element) -> bytes:
    """Return a description as indented XML."""
    etree.indent(root)
    return etree.tostring(root, xml_declaration=True, encoding="utf-8") + b"\n"


def _adjacent(described: _Element, parts: Iterable[PartSemantics]) -> Iterator[tuple[str, str]]:
    """Yield pairs of links of two parts that touch by links without shapes alone."""
    joints = described.iterchildren("joint")
    ends = [(end_of(it, "parent"), end_of(it, "child")) for it in joints]
    beside = sets_by_key((*ends, *((child, parent) for parent, child in ends)))
    shaped = _links_with_collision(described)
    for it in parts:
        own = set(it.part.robot.link)
        for link in sorted(own & shaped):
            for other in _nearest(link, beside, shaped):
                if other not in own:
                    yield min(link, other), max(link, other)


def _links_with_collision(described: _Element) -> set[str]:
    links = described.iterchildren("link")
    return {it.get("name", "") for it in links if it.find("collision") is not None}


def _nearest(link: str, beside: dict[str, set[str]], shaped: Collection[str]) -> Iterator[str]:
    """Yield the links with a shape that no other link with one separates from a link."""
    seen, todo = {link}, [link]
    for at in todo:  # grows
        for other in beside[at] - seen:
            seen.add(other)
            if other in shaped:
                yield other
            else:
                todo.append(other)


def _between(described: _Element, parts: Sequence[PartSemantics]) -> Iterator[tuple[str, str]]:
    """Yield the pairs of links of two parts that have shapes."""
    shaped = _links_with_collision(described)
    own = [sorted(shaped & set(it.part.robot.link)) for it in parts]
    for some, more in combinations(own, 2):
        yield from ((min(it), max(it)) for it in product(some, more))


def _notes(pairs: Sequence[tuple[str, str]], found: Touching, samples: int) -> Iterator[str]:
    """Yield notes on links that touch always or never in the random poses."""
    many = Counter(found.reasons.values())
    what = f"of {plural(len(pairs), 'pair')} of links of two parts {many[NEVER]} never touch"
    yield f"SRDF: {what} in {samples} random poses; the others are checked for collisions"
    for (one, other), why in found.reasons.items():
        if why == ALWAYS:
            what = f"{one!r} and {other!r} touch in every pose, and are not checked"
            yield f"SRDF: {what}; see whether the part is where it should be"
    for link, why in found.unknown.items():
        yield f"SRDF: the collisions of {link!r} were not checked: {why}"
