"""Names of the robot in files beside its description."""

from __future__ import annotations

from collections.abc import Iterator

import yaml

from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.moveit.file_kind import find_kind
from multibot_rewrite.companions.moveit.name_sites import find_names as moveit_names
from multibot_rewrite.companions.names.rename_map import KINDS, CompanionNames
from multibot_rewrite.companions.params.name_sites import find_names
from multibot_rewrite.companions.params.sections import identify_sections, raw_sections
from multibot_rewrite.companions.rviz.read_config import every, read_config, value
from multibot_rewrite.knowledge.parameters import built_in_nodes
from multibot_rewrite.lint.beside.kinds import PARAMS, RVIZ
from multibot_rewrite.lint.beside.records import Beside, Remark
from multibot_rewrite.lint.beside.robots import NO_ROBOTS, robots_of
from multibot_rewrite.lint.facts.typos import meant_name
from multibot_rewrite.model import InputError
from multibot_rewrite.naming import make_naming
from multibot_rewrite.nearest import HINTED
from multibot_rewrite.record import NamedTuple
from multibot_rewrite.system.conventions import PLACEHOLDER, SENT_FRAMES

FRAME_WORDS, JOINT_WORDS = ("frame", "link"), ("joint",)
_AS_WRITTEN = make_naming("tf-per-robot")


class Named(NamedTuple):
    """A name in a file, its kind, and the list of names that it is one of."""

    node: yaml.Node
    kind: str
    text: str
    where: int


def misspelled_frames(beside: Beside) -> Iterator[Remark]:
    """Frames and links that differ from a link of a description by one typing mistake."""
    names = [it for it in _names(beside) if it.kind in FRAME_WORDS and _is_plain(it.text)]
    declared = robots_of(beside).declared if names else {}
    links = declared.get("link", {})
    if not links:
        return
    meant: dict[str, str] = {}
    for it in names:
        name = it.text.strip("/").rpartition("/")[2]
        if name in SENT_FRAMES or any(name in declared[kind] for kind in ("link", "frame")):
            continue
        if name not in meant:
            meant[name] = meant_name(name, links) if len(meant) < HINTED else ""
        if meant[name]:
            message = f"{it.text!r} is no link of the robot"
            yield Remark(it.node, message, f"did you mean {meant[name]!r}?")


def undeclared_joints(beside: Beside) -> Iterator[Remark]:
    """Joints that no description has, beside others that one has; where a description could not be
    read, those with a typing mistake."""
    names = [it for it in _names(beside) if it.kind in JOINT_WORDS and _is_plain(it.text)]
    robots = robots_of(beside) if names else NO_ROBOTS
    joints = robots.declared.get("joint", {})
    there = {it.where for it in names if it.text in joints}
    for it in names if joints else ():
        if it.text in joints:
            continue
        near = meant_name(it.text, joints)
        if near or (robots.is_whole and it.where in there):
            message = f"no description of the package has the joint {it.text!r}"
            yield Remark(it.node, message, f"did you mean {near!r}?" if near else "")


def _is_plain(text: str) -> bool:
    return bool(text) and not PLACEHOLDER.search(text) and " " not in text


def _names(beside: Beside) -> list[Named]:
    """The names in a file; none where its reader rejects it, which is told where a fleet is built."""
    if _names not in beside.memo:
        try:
            beside.memo[_names] = list(_READERS.get(beside.kind, _of_moveit)(beside))
        except InputError:
            beside.memo[_names] = []
    found: list[Named] = beside.memo[_names]
    return found


def _of_parameters(beside: Beside) -> Iterator[Named]:
    document, settings = beside.document, beside.settings
    known = built_in_nodes(settings.distro)
    names = CompanionNames({}, _AS_WRITTEN, "")
    context = Context(names, names, {}, settings.distro)
    for section in identify_sections(raw_sections(document), context, known):
        for site in find_names(document, section, known).sites:
            # A guess of an unknown node's parameter may be anything.
            if site.param is not None and not site.param.own:
                yield Named(site.scalar, site.kind, site.value, id(site.key))


def _of_rviz(beside: Beside) -> Iterator[Named]:
    config = read_config(beside.document)
    fixed = value(value(config.manager, "Global Options"), "Fixed Frame")
    if isinstance(fixed, yaml.ScalarNode):
        yield Named(fixed, "frame", str(fixed.value), 0)
    for item in every((*config.displays, *config.tools)):
        for place in item.places:
            # RViz keeps links and frames that it has seen once: those are keys.
            if place.word in FRAME_WORDS and "*" not in place.path:
                yield Named(place.node, place.word, str(place.node.value), 0)


def _of_moveit(beside: Beside) -> Iterator[Named]:
    kind = find_kind(beside.document)
    declared = robots_of(beside).declared if kind else {}
    every_kind = {it: declared.get(it, {}) for kinds in KINDS.values() for it in kinds}
    found = moveit_names(
        beside.document.root,
        kind.names if kind else {},
        CompanionNames(every_kind, _AS_WRITTEN, ""),
    )
    for it in found.names:
        yield Named(it.scalar, it.word, it.text, 0)


_READERS = {PARAMS: _of_parameters, RVIZ: _of_rviz}
