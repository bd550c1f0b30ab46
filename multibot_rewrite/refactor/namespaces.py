# SPDX-License-Identifier: Apache-2.0
"""A description package gets an argument for a ROS namespace, in addition to that for its prefix.

What a rewrite below a namespace changes in plugins and sensors is asked of the rewrite: namespaces,
absolute names, and elements that are not written. Without a namespace nothing changes. Verified by
expansion: with one the description is what the rewrite makes of it."""

import os
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import PREFIX, ROS_KINDS, Naming, make_naming
from multibot_rewrite.description import pipeline
from multibot_rewrite.description.joining.part import in_one_line
from multibot_rewrite.description.readback.xml import read_xml
from multibot_rewrite.description.rewriters.renaming import ROBOT_SLOT
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.steps.apply import Template
from multibot_rewrite.description.steps.document import tag_end
from multibot_rewrite.description.steps.inserted import elements_of, lead_of
from multibot_rewrite.refactor.package import Description, Expanding, read_text
from multibot_rewrite.refactor.placing import Left, Spot, placed
from multibot_rewrite.refactor.source_edits import (
    SourceEdit,
    ValueEdit,
    change_of,
    first_difference,
    place,
)
from multibot_rewrite.refactor.xacro_sources import SPACES, Sources, declared

# No robot is called so: a description with robot1_ before its names can be tried with it.
TRIED_SPACE = "ns1"


class Spaced(NamedTuple):
    """A description, and what a rewrite makes of it."""

    found: Description
    template: Template


class Namespaced(NamedTuple):
    """The argument, empty without changes; edits that add it, descriptions, and what is left."""

    argument: str
    edits: tuple[SourceEdit, ...]
    every: tuple[Spaced, ...]
    left: tuple[Left, ...]


class _Added(NamedTuple):
    """What goes into an element, first or, where it is empty, as its text."""

    xml: tuple[str, ...] = ()
    text: str = ""


def spacing() -> Naming:
    """Return the naming below a namespace: ROS names, no frame and no joint."""
    naming = make_naming("frames-per-robot", PREFIX)
    kept = {kind: it for kind, it in naming.separators.items() if kind in ROS_KINDS}
    return naming._replace(separators=kept)


def namespaced(found: Sequence[Description], texts: Mapping[str, bytes], tree: Tree) -> Namespaced:
    """Return the edits of the sources ``texts``, by their real paths."""
    every, left = _spaced_urdfs(found, tree)
    sources = Sources(texts)
    argument = sources.free_name(SPACES, sources.hiding)
    made = placed(
        [it.found for it in every],
        [list(_namespace_edits(it.template)) for it in every],
        lambda _, change: _conditional_namespace(change, argument),
    )
    edits, left = list(made.edits), [*left, *made.left]
    for (file, start), wanted in _added_by_spot(every).items():
        if len(wanted) > 1:
            where = place(file, texts[file], start)
            left.append(Left(where, "its copies need different ROS names; write them out"))
        else:
            edits += _element_edits(file, texts[file], start, next(iter(wanted)), argument)
    if not edits:
        return Namespaced("", (), (), tuple(left))
    tops = {os.path.realpath(it.found.path) for it in every}
    edits += [*declared(texts, edits, tops, argument, True)]
    return Namespaced(argument, tuple(edits), tuple(every), tuple(left))


def _spaced_urdfs(found: Iterable[Description], tree: Tree) -> tuple[list[Spaced], list[Left]]:
    """Return each URDF prepared for a namespace, and those that the rewrite refuses."""
    every: list[Spaced] = []
    left: list[Left] = []
    for it in found:
        if it.inventory.format != "robot":
            continue
        try:
            every.append(_with_namespace(it, it.inventory.document.source, tree))
        except InputError as error:
            left.append(Left(it.words, f"it gets no namespace: {error}"))
    return every, left


def _with_namespace(it: Description, data: bytes, tree: Tree) -> Spaced:
    with in_one_line():
        return Spaced(it, pipeline.prepare(data, it.path, spacing(), tree))


def space_verified(
    space: Namespaced,
    prefix: str,
    tried: str,
    after: Mapping[str, bytes],
    how: Expanding,
    tree: Tree,
) -> tuple[tuple[str, ...], tuple[Left, ...]]:
    """Return the paths of verified descriptions, and for the others what is wrong with them."""
    # With a namespace they are what a rewrite makes of them, also with a ``prefix``, which is
    # ``tried`` with the default arguments.
    wrong: dict[str, Left] = {}
    for it in space.every:
        why = _namespace_fault(it, after, {}, space.argument, how)
        if not why and not it.found.arguments:
            given = {prefix: tried}
            beside = Expanding(how.reach, {**how.arguments, **given})
            data, _ = read_text(it.found.path, beside, after)
            why = _namespace_fault(
                _with_namespace(it.found, data, tree), after, given, space.argument, how
            )
        if why:
            wrong[it.found.path] = Left(it.found.words, f"its ROS names are not verified: {why}")
    paths = dict.fromkeys(it.found.path for it in space.every)
    return tuple(it for it in paths if it not in wrong), tuple(wrong.values())


def _namespace_fault(
    it: Spaced, after: Mapping[str, bytes], given: Mapping[str, str], argument: str, how: Expanding
) -> str:
    """Return what is wrong with a description with a namespace."""
    arguments = {**how.arguments, **it.found.arguments, **given, argument: TRIED_SPACE}
    try:
        made, _ = read_text(it.found.path, Expanding(how.reach, arguments), after)
        with in_one_line():
            wanted = next(pipeline.render(it.template, [TRIED_SPACE], again=True))
    except InputError as error:
        return str(error)
    other = first_difference(_as_read(made), _as_read(wanted))
    return f"with {argument}:={TRIED_SPACE} it has {other}" if other else ""


def _as_read(data: bytes) -> bytes:
    """Return a description as its readers see it: without comments, an element a line."""
    root = read_xml(data, "")
    etree.strip_tags(root, etree.Comment)
    etree.indent(root)
    return etree.tostring(root)


def _namespace_edits(template: Template) -> Iterator[ValueEdit]:
    """Yield the changes of existing values that put the namespace into them."""
    document, claims, *_ = template.inventory
    for claim, spelling in zip(claims, template.plan.renames.values, strict=True):
        for *_, (at, before, after) in spelling if claim.value else ():
            yield change_of(document, claim, at, at, f"{before}{TRIED_SPACE}{after}")


def _conditional_namespace(change: ValueEdit, argument: str) -> str:
    """Return ``${...}`` with the new name of a change, which is empty without a namespace."""
    before, after = change.new.split(TRIED_SPACE)
    words = [f"'{before}'"] * bool(before) + [argument] + [f"'{after}'"] * bool(after)
    test = f"{argument} and " if len(words) > 1 else ""
    return f"${{{test}{' + '.join(words)}}}"


def _added_by_spot(every: Iterable[Spaced]) -> dict[Spot, set[_Added]]:
    """Return what is added where an element is written, for each element that it makes."""
    found: dict[Spot, set[_Added]] = defaultdict(set)
    for it in every:
        read, document = it.found.read, it.template.inventory.document
        assert read is not None
        needs = _added_by_element(it.template)
        for number, element in enumerate(document.elements):
            if origin := read.origins.of(number):
                spot = os.path.realpath(origin.file), origin.start
                found[spot].add(needs.get(element, _Added()))
    return {spot: added for spot, added in found.items() if added != {_Added()}}


def _added_by_element(template: Template) -> dict[etree._Element, _Added]:
    """Return what is added to which element."""
    items = template.plan.insertions
    groups = lists_by_key((it.parent, it) for it in items if it.filled is None)
    texts = {it.filled: it.new for it in items if it.filled is not None}
    renames = zip(template.inventory.claims, template.plan.renames.values, strict=True)
    for claim, spelling in renames:
        if spelling and not claim.value:
            texts[claim.element] = spelling[0].affix.spell("", ROBOT_SLOT)
    made = {it: _Added(tuple(elements_of(own, ""))) for it, own in groups.items()}
    return made | {it: _Added((), text) for it, text in texts.items()}


def _element_edits(
    file: str, source: bytes, start: int, added: _Added, argument: str
) -> Iterator[SourceEdit]:
    """Yield the edits that add conditional elements; ``<a/>`` gets an end tag."""
    end = tag_end(source, start)
    is_empty = source[end - 2 : end] == b"/>"
    # White space alone would be left in an element that had none.
    lead = "" if added.text or is_empty else lead_of(source, end)
    step = lead and f"{lead}  "
    inside = added.text + "".join(f"{step}{it}" for it in added.xml)
    test = f"<xacro:if value=\"${{{argument} != ''}}\">"
    text = f"{lead}{test}{inside.replace(ROBOT_SLOT, f'${{{argument}}}')}{lead}</xacro:if>"
    if is_empty:
        tag = source[start + 1 : end].split(None, 1)[0].rstrip(b"/>").decode()
        yield SourceEdit(file, end - 2, end, f">{text}</{tag}>".encode())
    else:
        yield SourceEdit(file, end, end, text.encode())
