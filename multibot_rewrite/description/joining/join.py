# SPDX-License-Identifier: Apache-2.0
"""Parts -> one description: each text is kept as it is, behind those before it, with a joint between.

The first part's file goes on: its declaration, name and attributes are those of the whole. A root
link ``world`` of a later part is left out, and what is fixed to it is fixed to ``at`` itself."""

import os
from collections.abc import Collection, Iterable, Iterator, Sequence
from math import isfinite
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.loose_xml import ESCAPES
from multibot_rewrite.base.model import Edit, InputError, UsageError
from multibot_rewrite.base.nearest import did_you_mean_one_of
from multibot_rewrite.description.checks.links_and_joints import WORLD, Joint, Robot, read_robot
from multibot_rewrite.description.checks.poses import (
    HERE,
    Pose,
    placed as pose_in_parent,
    pose_of,
    pose_of_six,
    rpy_of,
)
from multibot_rewrite.description.joining import kept
from multibot_rewrite.description.joining.blocks import (
    Once,
    one_system,
    other_looks,
    prefixed,
    repeated,
    said_once,
    same_ids,
    word_of,
)
from multibot_rewrite.description.joining.part import (
    ZERO,
    Part,
    ReadPart,
    check_meeting,
    read_part,
    with_names,
)
from multibot_rewrite.description.joining.second_reading import Mounted, prove
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.steps.apply import Spans, cut
from multibot_rewrite.description.steps.collect import collect
from multibot_rewrite.description.steps.document import Document, read_document, tag_end, value_slot

_MOUNT = """
  <joint name="{name}" type="fixed">
    {origin}
    <parent link="{parent}"/>
    <child link="{child}"/>
  </joint>"""


class Fixed(NamedTuple):
    """The edits that fix a part, the joint that they make, and notes for the user."""

    edits: tuple[Edit, ...]
    joint: str
    notes: tuple[str, ...] = ()


def fixed(part: ReadPart, spec: Part, spans: Spans) -> Fixed:
    """Return a part fixed to ``spec.at``; raises InputError if its link ``world`` prevents that."""
    robot = read_robot(spans.document.root)
    if part.root != WORLD:
        name = f"{part.name}_mount"
        origin = _origin(pose_of_six(spec.pose), spec.pose)
        names = (it.translate(ESCAPES) for it in (spec.at, part.root))
        words = dict(zip(("parent", "child"), names, strict=True))
        at, _ = spans.inside(spans.document.root)
        text = _MOUNT.format(name=name, origin=origin, **words)
        return Fixed((kept.was(at, at, b"", text.encode()),), name)
    joints = robot.below.get(WORLD, ())
    root = spans.document.root
    link = next(it for it in root.iterchildren("link") if it.get("name") == WORLD)
    if len(link) or not joints:
        what = "has shapes of its own" if len(link) else "is all it has"
        raise InputError(f"{part.file}: its link {WORLD!r} {what}; give that another name")
    free = next((it for it in joints if it.type in ("floating", "planar")), None)
    if free is not None:
        raise InputError(f"{part.file}: joint {free.name!r} is {free.type}: make it a fixed one")
    blocks = [it for it in root.iterchildren("gazebo") if it.get("reference") == WORLD]
    gone = (kept.left_out(spans, it) for it in (link, *blocks))
    notes = (f"{part.file}:{it.sourceline}: left out: it is about {WORLD!r}" for it in blocks)
    moved = (_moved(part, it, spec, spans) for it in joints)
    return Fixed((*gone, *moved), "", tuple(notes))


def _moved(part: ReadPart, joint: Joint, spec: Part, spans: Spans) -> Edit:
    """Return the edit that puts a joint of the world onto the part's link instead."""
    element = joint.element
    start, end = spans.start_of(element), spans.end_of(element)
    parent = joint.parts["parent"]
    source = spans.document.source
    slot = value_slot(source, spans.start_of(parent), "link", joint.parent)
    if slot is None:
        raise InputError(f"{part.file}: <parent> of {joint.name!r}: write its link as plain text")
    edits = [Edit(*slot, spec.at.translate(ESCAPES).encode(), None)]
    edits += _turned(part, joint, spec.pose, spans)
    return kept.was(start, end, source[start:end], _edited_text(source[:end], edits)[start:])


def _turned(part: ReadPart, joint: Joint, pose: Sequence[float], spans: Spans) -> Iterator[Edit]:
    """Yield the edits of a joint's origin, which becomes relative to the part's link."""
    if tuple(pose) == ZERO:
        return
    old = joint.parts.get("origin")
    inner = pose_of(old)
    if inner is None:
        raise InputError(
            f"{part.file}: the origin of {joint.name!r} is not six numbers, correct it"
        )
    outer = pose_of_six(pose)
    text = _origin(outer, pose) if inner == HERE else _origin(pose_in_parent(outer, inner))
    start = spans.start_of(joint.element if old is None else old)
    if old is None:
        start = end = tag_end(spans.document.source, start)
    else:
        end = spans.end_of(old)
    yield Edit(start, end, text.encode(), None)


def _origin(pose: Pose, given: Sequence[float] = ()) -> str:
    """Return ``<origin>``, in the given numbers if there are any."""
    six = given or [round(it, 15) for it in (*pose.at, *rpy_of(pose.matrix))]
    words = [repr(float(it) + 0.0).removesuffix(".0") for it in six]
    return f'<origin xyz="{" ".join(words[:3])}" rpy="{" ".join(words[3:])}"/>'


JOINED = "the joined description"
# So many links of a robot are offered where none is named.
_ENDS = 5


class JoinedText(NamedTuple):
    """One description of several; ``notes`` for people, ``findings`` about names without prefix."""

    data: bytes
    parts: tuple[Mounted, ...]
    notes: tuple[str, ...]
    findings: tuple[Finding, ...]


class GivenPart(NamedTuple):
    """A part and the bytes and name of its file."""

    part: Part
    data: bytes
    file: str


class Output(NamedTuple):
    """The file that a joined description goes to, and that of all controllers; empty if unknown."""

    path: str = ""
    controllers: str = ""


NOWHERE = Output()


def _with_references(part: ReadPart, spec: Part, output: Output, tree: Tree) -> ReadPart:
    """Return a part that refers to files from the folder of the output, and to all controllers."""
    # Source: gz_ros2_control_plugin.cpp (``<parameters>`` is a path).
    document = read_document(part.text, part.file)
    spans, controllers = Spans(document), {os.path.basename(it) for it in spec.controllers}
    folder = os.curdir
    if output.path and not part.file.startswith("<"):
        here, there = (os.path.dirname(os.path.abspath(it)) for it in (part.file, output.path))
        folder = os.path.relpath(here, there)
    edits: list[Edit] = []
    for element in document.root.iter("mesh", "texture", "parameters"):
        is_files = element.tag == "parameters"
        path = ((element.text if is_files else element.get("filename")) or "").strip()
        new = path
        if is_files and os.path.basename(path) in controllers:
            new = output.controllers
        elif not is_files and path and "://" not in path and folder != os.curdir:
            new = os.path.join(folder, path)
        if new and new != path:
            edits += kept.path_edits(spans, element, new.translate(ESCAPES).encode())
    text = _edited_text(document.source, edits)
    return part._replace(text=text, inventory=collect(read_document(text, part.file), tree))


def join_texts(given: Sequence[GivenPart], tree: Tree, output: Output = NOWHERE) -> JoinedText:
    """Join descriptions that go to ``output``; raises UsageError and InputError, ProofError."""
    if len(given) < 2:
        raise UsageError("one description alone: give those that are joined to it, too")
    parts = [read_part(*it, tree, at == 0) for at, it in enumerate(given)]
    _check_parts(given, parts)
    known: dict[tuple[str, str], str] = {}
    with_names(known, parts[0])
    if not kept.is_joined_whole(parts[0].data):
        parts[0] = _with_references(parts[0], given[0].part, output, tree)
    mounted = [Mounted(parts[0], "", ZERO, "", parts[0].text)]
    data = parts[0].text
    notes: list[str] = []
    for it, part in zip(given[1:], parts[1:], strict=True):
        check_meeting(part, known)
        data, made, told = _added(data, it.part, part, parts[0], tree, output)
        with_names(known, part)
        mounted.append(made)
        notes += told
    prove(data, mounted, tree)
    findings = tuple(found for part in parts for found in part.findings)
    return JoinedText(data, tuple(mounted), tuple(notes), findings)


def _check_parts(given: Sequence[GivenPart], parts: Sequence[ReadPart]) -> None:
    if given[0].part.at:
        raise UsageError(f"{given[0].file}: it is the first part, there is no link before it")
    first = parts[0]
    before = kept.sections(first.data, first.file) if kept.is_joined_whole(first.data) else [first]
    names = [it.name for it in (*before, *parts[1:])]
    twice = next((it for at, it in enumerate(names) if it in names[:at]), None)
    if twice is not None:
        raise UsageError(f"two parts are called {twice!r}; give one a name or prefix of its own")
    for it in given:
        pose = tuple(it.part.pose)
        are_numbers = all(isinstance(one, int | float) and isfinite(one) for one in pose)
        if len(pose) != 6 or not are_numbers:
            raise UsageError(f"{it.file}: a pose is six numbers: x y z roll pitch yaw")


def _added(
    data: bytes, spec: Part, part: ReadPart, first: ReadPart, tree: Tree, output: Output
) -> tuple[bytes, Mounted, Sequence[str]]:
    """Return the text with one more part, the part in place, and notes."""
    joined = collect(read_document(data, JOINED), tree)
    robot = read_robot(joined.document.root)
    _check_link_exists(spec.at, part, robot)
    names = other_looks(joined.document.root, part)
    word = word_of(part.name, part.prefix)
    text = prefixed(part.text, part.file, word, names)
    part = _with_references(part._replace(text=text), spec, output, tree)
    root, spans = part.inventory.document.root, Spans(part.inventory.document)
    start, end = spans.inside(root)
    once, mount = said_once(joined, part.inventory), fixed(part, spec, spans)
    if mount.joint in robot.joint or mount.joint in part.robot.joint:
        what = f"joint {mount.joint!r} is there already; name the part otherwise"
        raise InputError(f"{part.file}: {what}")
    ids = Once(notes=tuple(same_ids(joined, part.inventory)))
    system = one_system(joined, part.inventory) if spec.one_system else ids
    twice = repeated(joined.document.root, spans)
    edits = [*mount.edits, *twice, *once.part, *system.part]
    made = _edited_text(part.text, [*edits, *own_spaces(joined.document, spans, edits)])
    own = kept.KeptText(part.name, part.prefix, names, made)
    more = kept.section(own, start, end + len(made) - len(part.text))
    base = _edited_text(data, (*once.joined, *system.joined))
    mounted = Mounted(part, spec.at, spec.pose, mount.joint, made)
    notes = (*mount.notes, *once.notes, *system.notes)
    return kept.placed(base, first.name, first.prefix, more), mounted, notes


def _edited_text(text: bytes, edits: Iterable[Edit]) -> bytes:
    return b"".join(cut(text, sorted(edits, key=lambda it: it.start)))


def _check_link_exists(at: str, part: ReadPart, robot: Robot) -> None:
    if at in robot.link:
        return
    turning = {it.child for it in robot.joints if it.type == "continuous"}
    roots = [it for it in robot.link if it not in robot.above and it != WORLD]
    ends = (it for it in robot.link if it not in robot.below and it not in turning)
    some = ", ".join([*dict.fromkeys((*ends, *roots))][:_ENDS])
    if not at:
        raise UsageError(f"{part.file}: name the link that it is fixed to with --at, as {some}")
    near = did_you_mean_one_of(at, robot.link) or f"name another one, as {some}"
    raise UsageError(f"{part.file}: no part before it has a link {at!r}; {near}")


def own_spaces(joined: Document, spans: Spans, others: Collection[Edit]) -> list[Edit]:
    """Return the edits that declare missing XML prefixes, if the ``others`` keep their elements."""
    edited = {it.start for it in others if it.start < it.end}
    edits: list[Edit] = []
    lacking = _declared(spans.document) - _declared(joined)
    for it in spans.document.root.iterchildren("*") if lacking else ():
        names = (name for one in it.iter("*") for name in (one.tag, *one.attrib))
        found = (etree.QName(str(name)).namespace for name in names)
        used = sorted({uri.encode() for uri in found if uri} & {uri for _, uri in lacking})
        start = spans.start_of(it)
        if not used or start in edited:
            continue
        old = spans.text_of(it)
        words = (b' xmlns:%s="%s"' % pair for pair in sorted(lacking) if pair[1] in used)
        at = 1 + len(old[1:].split(b">", 1)[0].split(None, 1)[0].rstrip(b"/"))
        edits.append(kept.was(start, spans.end_of(it), old, old[:at] + b"".join(words) + old[at:]))
    return edits


def _declared(document: Document) -> set[tuple[bytes, bytes]]:
    """Return the XML prefixes and namespaces that the root's start tag declares."""
    start = document.starts[0]
    tag = document.source[start : tag_end(document.source, start)]
    found = ((prefix, uri) for prefix, uri in document.root.nsmap.items() if prefix)
    pairs = {(prefix.encode(), uri.encode()) for prefix, uri in found}
    return {pair for pair in pairs if b"xmlns:%s" % pair[0] in tag}
