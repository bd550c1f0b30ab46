# SPDX-License-Identifier: Apache-2.0
"""The verification of every join: the joined text has each part, byte by byte, and is one tree.

An earlier part may have what a part leaves out: a material, a block of the whole robot. Its link
``world`` is replaced by the link that it is on, its ros2_control by one that drives all of it."""

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import chain
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import InputError, ProofError
from multibot_rewrite.description import pipeline
from multibot_rewrite.description.checks.links_and_joints import WORLD
from multibot_rewrite.description.checks.poses import Pose, placed, pose_of, pose_of_six
from multibot_rewrite.description.joining.blocks import bare, has_all, like, word_of
from multibot_rewrite.description.joining.kept import KeptText, is_joined_whole, sections
from multibot_rewrite.description.joining.part import ReadPart, in_one_line, prefixing
from multibot_rewrite.description.readback.xml import plain, read_xml
from multibot_rewrite.description.rewriters.text import end_of
from multibot_rewrite.description.rewriters.tree import Tree

# Metres, and entries of a matrix.
_ROUNDED = 1e-9


class Mounted(NamedTuple):
    """A part in place: on link ``at`` at a ``pose``, by a new ``joint`` or, if empty, its own."""

    part: ReadPart
    at: str
    pose: Sequence[float]
    joint: str
    text: bytes

    @property
    def is_without_world(self) -> bool:
        """Whether its link ``world`` gives way to the base."""
        return bool(self.at) and self.part.root == WORLD


def check_read(root: _Element, parts: Sequence[Mounted]) -> None:
    """Raise ProofError unless the joined description is one tree of all that the parts have."""
    left = Counter(plain(it) for it in root.iterchildren("*"))
    wanted: Counter[tuple[str, str]] = Counter()
    for mounted in parts:
        file = mounted.part.file
        own = read_xml(mounted.part.inventory.document.source, file)
        for it in own.iterchildren("*"):
            key = plain(it)
            if left[key]:
                left[key] -= 1
            elif not _stands_for_it(it, mounted, root):
                raise ProofError(f"{file}: <{it.tag}> {it.get('name', '')!r} is changed")
        wanted.update(_tags_and_names(own))
        wanted -= Counter([("link", WORLD)] if mounted.is_without_world else [])
        if mounted.joint:
            wanted["joint", mounted.joint] += 1
            joint = next(it for it in root.iterchildren("joint") if it.get("name") == mounted.joint)
            ends = [end_of(joint, tag) for tag in ("parent", "child")]
            fixed = joint.get("type") == "fixed" and ends == [mounted.at, mounted.part.root]
            if not fixed or not _has_pose(joint, pose_of_six(mounted.pose)):
                raise ProofError(f"{mounted.part.file}: it is not fixed to {mounted.at!r} as asked")
    found = Counter(_tags_and_names(root))
    if found != wanted:
        kind, name = next(iter((found - wanted) + (wanted - found)))
        raise ProofError(f"{kind} {name!r} is there {found[kind, name]} times")
    _check_tree(root)


def _tags_and_names(root: _Element) -> Iterator[tuple[str, str]]:
    return ((str(it.tag), it.get("name", "")) for it in root.iterchildren("link", "joint"))


def _stands_for_it(it: _Element, mounted: Mounted, root: _Element) -> bool:
    """Return whether an element of a part needs no copy: another in the whole text stands for it."""
    name = it.get("name", "")
    of_world = {"link": name, "gazebo": it.get("reference", "")}.get(str(it.tag)) == WORLD
    if mounted.is_without_world and of_world:
        return True
    if it.tag == "ros2_control":
        return has_all(it, like(it, root))
    if it.tag == "joint":
        on_world = mounted.is_without_world and end_of(it, "parent") == WORLD
        return on_world and _moved(it, mounted, root)
    if it.tag == "material":
        return any(other.get("name") == name for other in root.iterchildren("material"))
    return it.tag == "gazebo" and not it.get("reference") and _has_block(it, root)


def _has_block(block: _Element, root: _Element) -> bool:
    """Return whether the whole text has all of a block, and of a plugin all parameter files."""
    blocks = [it for it in root.iterchildren("gazebo") if not it.get("reference")]
    said = [it for block in blocks for it in block.iterchildren("*")]
    for it in block.iterchildren("*"):
        same = [one for one in said if plain(one) == plain(it)]
        there = [
            one
            for one in said
            if one.tag == "plugin" == it.tag and one.get("filename") == it.get("filename")
        ]
        files = {plain(file) for one in there for file in one.iterchildren("parameters")}
        has_files = all(plain(file) in files for file in it.iterchildren("parameters"))
        if not same and not (there and has_files):
            return False
    return True


def _moved(old: _Element, mounted: Mounted, root: _Element) -> bool:
    """Return whether a joint on the world is unchanged on the part's link now."""
    new = next((it for it in root.iterchildren("joint") if it.get("name") == old.get("name")), None)
    if new is None or end_of(new, "parent") != mounted.at:
        return False
    same = [[plain(it) for it in one if it.tag not in ("parent", "origin")] for one in (old, new)]
    inner = pose_of(old.find("origin"))
    if inner is None or same[0] != same[1] or old.attrib != new.attrib:
        return False
    return _has_pose(new, placed(pose_of_six(mounted.pose), inner))


def _has_pose(joint: _Element, wanted: Pose) -> bool:
    found = pose_of(joint.find("origin"))
    if found is None:
        return False
    one, other = (chain(pose.at, *pose.matrix) for pose in (found, wanted))
    return all(abs(a - b) < _ROUNDED for a, b in zip(one, other, strict=True))


def _check_tree(root: _Element) -> None:
    """Raise an error unless there is one root, and each other link below it, by one joint."""
    links = {it.get("name", "") for it in root.iterchildren("link")}
    ends = [(end_of(it, "child"), end_of(it, "parent")) for it in root.iterchildren("joint")]
    below = lists_by_key((parent, child) for child, parent in ends)
    todo = sorted(links - {child for child, _ in ends})
    is_one = len(todo) == 1 and len(ends) == len(links) - 1
    for link in todo:  # grows
        todo += below.get(link, [])
        if len(todo) > len(links):
            break
    if not is_one or set(todo) != links:
        raise ProofError("the joined description is not one tree")


def taken_out(it: KeptText, file: str, tree: Tree) -> bytes:
    """Return a part of a joined text as it was; raises InputError if the text was edited by hand."""
    word = word_of(it.name, it.prefix)
    text = bare(it.text, file, word, it.materials) if it.materials else it.text
    if not it.prefix:
        return text
    with in_one_line():
        return pipeline.strip(text, file, it.prefix, prefixing(), tree)


def split_text(data: bytes, file: str, tree: Tree) -> dict[str, bytes]:
    """Return the parts of a joined description by name, as they were."""
    return {it.name: taken_out(it, file, tree) for it in sections(data, file)}


def prove(data: bytes, parts: Sequence[Mounted], tree: Tree) -> None:
    """Raise ProofError unless ``data`` is these parts and nothing else."""
    try:
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
        check_read(read_xml(data, "the joined description"), parts)
    except InputError as error:
        raise ProofError(f"the joined description cannot be read: {error}") from None
