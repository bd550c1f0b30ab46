# SPDX-License-Identifier: Apache-2.0
"""The proof that runs on every join: it reads the joined bytes again.

Each part that is taken out is, byte by byte, what went in. As a second reader sees it, the whole is one
tree, every link and joint of a part is there once, and no joint inside a part has changed.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from lxml.etree import _Element

from multibot_rewrite.base.model import InputError, ProofError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description import pipeline
from multibot_rewrite.description.checks.links_and_joints import WORLD
from multibot_rewrite.description.joining.kept import Section, is_joined_whole, sections
from multibot_rewrite.description.joining.materials import bare
from multibot_rewrite.description.joining.part import ReadPart, prefixing
from multibot_rewrite.description.readback.xml import plain, read_xml
from multibot_rewrite.description.rewriters.tree import Tree

_KINDS = ("link", "joint")


class Mounted(NamedTuple):
    """A part with where it is in the joined robot: fixed to the link ``at``, ``joint`` is the new
    joint that does it, empty where one of its own does. ``text`` is its text there."""

    part: ReadPart
    at: str
    joint: str
    text: bytes


def taken_out(it: Section, file: str, tree: Tree) -> bytes:
    """A part of a joined text as it was before; raises InputError and RewriteRefused where the text
    was edited by hand."""
    text = bare(it.text, file, it.prefix, it.materials) if it.materials else it.text
    return pipeline.strip(text, file, it.prefix, prefixing(), tree) if it.prefix else text


def split_text(data: bytes, file: str, tree: Tree) -> dict[str, bytes]:
    """The parts of a joined description by name, as they were."""
    return {it.name: taken_out(it, file, tree) for it in sections(data, file)}


def prove(data: bytes, parts: Sequence[Mounted], tree: Tree) -> None:
    """Raise ProofError unless ``data`` is these parts and nothing else."""
    try:
        _same_parts(data, parts, tree)
        _one_tree(read_xml(data, "the joined description"), parts)
    except InputError as error:
        raise ProofError(f"the joined description cannot be read: {error}") from None


def _same_parts(data: bytes, parts: Sequence[Mounted], tree: Tree) -> None:
    found = split_text(data, "the joined description", tree)
    first = parts[0].part
    before = split_text(first.data, first.file, tree) if is_joined_whole(first.data) else {}
    wanted = before or {first.name: first.data}
    wanted |= {it.part.name: it.part.data for it in parts[1:]}
    for name, text in wanted.items():
        if found.get(name) != text:
            raise ProofError(f"part {name!r} cannot be taken out again as it was")
    if list(found) != list(wanted):
        raise ProofError(f"{len(wanted)} parts went in, {len(found)} come out")


def _one_tree(root: _Element, parts: Sequence[Mounted]) -> None:
    joints = {it.get("name", ""): it for it in root.iterchildren("joint")}
    wanted: Counter[tuple[str, str]] = Counter()
    for mounted in parts:
        own = read_xml(mounted.part.text, mounted.part.file)
        moved = mounted.at and mounted.part.root == WORLD
        for it in own:
            if it.tag in _KINDS and not (moved and it.tag == "link" and it.get("name") == WORLD):
                wanted[str(it.tag), it.get("name", "")] += 1
        if mounted.joint:
            wanted["joint", mounted.joint] += 1
        for what in _changed(own, joints, bool(moved)):
            raise ProofError(f"{mounted.part.file}: {what}")
        _check_mount(mounted, joints)
    found = Counter((str(it.tag), it.get("name", "")) for it in root if it.tag in _KINDS)
    if found != wanted:
        name = next(iter((found - wanted) + (wanted - found)))
        raise ProofError(f"{name[0]} {name[1]!r} is there {found[name]} times, not {wanted[name]}")
    _check_roots(root)


def _changed(own: _Element, joints: dict[str, _Element], moved: bool) -> Iterator[str]:
    for it in own.iterchildren("joint"):
        name = it.get("name", "")
        parent = it.find("parent")
        if moved and parent is not None and parent.get("link") == WORLD:
            continue
        if name not in joints or plain(joints[name]) != plain(it):
            yield f"joint {name!r} is not what it was"


def _check_mount(mounted: Mounted, joints: dict[str, _Element]) -> None:
    if not mounted.joint:
        return
    ends = [joints[mounted.joint].find(tag) for tag in ("parent", "child")]
    names = [None if it is None else it.get("link") for it in ends]
    if names != [mounted.at, mounted.part.root]:
        raise ProofError(f"{mounted.part.file}: joint {mounted.joint!r} joins {names}")


def _check_roots(root: _Element) -> None:
    links = {it.get("name") for it in root.iterchildren("link")}
    first = (it.find("child") for it in root.iterchildren("joint"))
    children = [it.get("link") for it in first if it is not None]
    if len(links - set(children)) != 1 or len(children) != len(set(children)):
        raise ProofError("the joined description is not one tree")
