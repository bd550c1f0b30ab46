# SPDX-License-Identifier: Apache-2.0
"""Leaves out what an earlier part has: ``<gazebo>`` blocks, ``<ros2_control>``, materials.

A plugin that makes a controller manager exists once for all parts, with the parameter files of
all (gz_ros2_control_plugin.cpp and gazebo_ros2_control_plugin.cpp read each ``<parameters>``).
The first part's other settings count. Joints, sensors and gpios of a part's system go into an
earlier one with the same type and ``<hardware>``. Sources: ros2_control component_parser.cpp
(``parse_resource_from_xml``): a system has one hardware, and any number of joints, sensors,
gpios and transmissions; urdfdom model.cpp (``parseURDF``: a material below ``<robot>`` that is
there twice is an error; ``assignMaterial``: of a name that the model has, whatever is in the
visual is not read)."""

import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import chain
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.model import Edit, InputError
from multibot_rewrite.description.checks.numbers import numbers
from multibot_rewrite.description.joining.kept import left_out, was
from multibot_rewrite.description.joining.part import ReadPart
from multibot_rewrite.description.readback.xml import plain, text_of
from multibot_rewrite.description.steps.apply import Spans, cut
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.document import Document, read_document, value_slot

_FILES = "parameters"
# What stands in a block for itself; anything else is a setting of the robot.
_THINGS = ("plugin", "joint", "link", "frame", "model", "gripper", "sensor", "light")


class Once(NamedTuple):
    """The edits of a part and of the text before it, and notes for the user."""

    part: tuple[Edit, ...] = ()
    joined: tuple[Edit, ...] = ()
    notes: tuple[str, ...] = ()


def said_once(joined: Inventory, part: Inventory) -> Once:
    """Return the edits that leave out a part's blocks which an earlier part has, and notes."""
    managers, others = _managers(joined), _managers(part)
    said = {plain(it) for block in _whole_robot_blocks(joined) for it in _child_elements(block)}
    spans, before = Spans(part.document), Spans(joined.document)
    edits: list[Edit] = []
    more: list[Edit] = []
    notes: list[str] = []
    file = part.document.file
    for block in _whole_robot_blocks(part):
        doubles = [it for it in _child_elements(block) if plain(it) in said]
        for plugin, names in others.items():
            if plugin.getparent() is not block or plugin in doubles or not managers:
                continue
            first = next((it for it, its in managers.items() if its == names), None)
            if first is None:
                name, where = plugin.get("filename", ""), f"{file}:{plugin.sourceline}"
                what = f"{name!r} makes a controller manager"
                notes.append(f"{where}: {what}, and so does an earlier plugin")
                continue
            doubles.append(plugin)
            more += _more_files(before, first, plugin, spans)
            notes += _left_out_settings(first, plugin, part)
        notes += (
            f"{file}:{it.sourceline}: <{it.tag}> now applies to the whole robot"
            for it in _child_elements(block)
            if it.tag not in _THINGS and it not in doubles
        )
        gone = [block] if doubles and len(doubles) == len(_child_elements(block)) else doubles
        edits += [left_out(spans, it) for it in gone]
    return Once(tuple(edits), tuple(more), tuple(notes))


def _whole_robot_blocks(inventory: Inventory) -> Iterator[_Element]:
    for it in inventory.document.root.iterchildren("gazebo"):
        if not it.get("reference"):
            yield it


def _child_elements(element: _Element) -> list[_Element]:
    return list(element.iterchildren("*"))


def _managers(inventory: Inventory) -> dict[_Element, tuple[str, ...]]:
    """Return the plugins that make a controller manager, with the names of their definitions."""
    return {element: section.names for element, section in inventory.served if section.process_wide}


def _more_files(before: Spans, plugin: _Element, other: _Element, spans: Spans) -> Iterator[Edit]:
    """Yield the edits that move parameter files of a removed plugin into the one that stays."""
    known = {text_of(it) for it in plugin.iterchildren(_FILES)}
    texts = [spans.text_of(it) for it in other.iterchildren(_FILES) if text_of(it) not in known]
    if last := _child_elements(plugin)[-1:]:
        at = before.end_of(last[0])
        yield from (was(at, at, b"", b"\n      " + text) for text in texts)
    elif texts:
        start, end = before.start_of(plugin), before.end_of(plugin)
        old = before.text_of(plugin)
        # A plugin without elements, with one.
        head = old[:-2] + b">" if old.endswith(b"/>") else old[: old.rindex(b"</")]
        yield was(start, end, old, head + b"".join(texts) + b"</%s>" % str(plugin.tag).encode())


def _left_out_settings(plugin: _Element, other: _Element, part: Inventory) -> Iterator[str]:
    first = {plain(it) for it in _child_elements(plugin)}
    for it in _child_elements(other):
        if it.tag != _FILES and plain(it) not in first:
            where = f"{part.document.file}:{it.sourceline}"
            yield f"{where}: <{it.tag}> is left out: the plugin of an earlier part counts"


# A parameter of a joint, gpio or sensor that is its number on a bus.
_ID = re.compile(r"(^|_)id$", re.IGNORECASE)
_SYSTEM, _HARDWARE = "ros2_control", "hardware"


def one_system(joined: Inventory, part: Inventory) -> Once:
    """Return the edits that merge a part's systems into earlier ones; an unmatched one has a note."""
    for what in same_ids(joined, part):
        raise InputError(f"{what}; change one")
    spans, before = Spans(part.document), Spans(joined.document)
    gone: list[Edit] = []
    more: list[Edit] = []
    notes: list[str] = []
    others = list(joined.document.root.iterchildren(_SYSTEM))
    for it in part.document.root.iterchildren(_SYSTEM):
        first = next(like(it, joined.document.root), None)
        if first is None or not len(first):
            where, name = f"{part.document.file}:{it.sourceline}", it.get("name", "")
            what = f"ros2_control {name!r} stays: no part before it has one of its hardware"
            notes += [f"{where}: {what}"] if others else []
            continue
        gone.append(left_out(spans, it))
        end = before.end_of(list(first.iterchildren("*"))[-1])
        texts = (spans.text_of(one) for one in driven(it))
        more += [was(end, end, b"", b"\n    " + text) for text in texts]
    return Once(tuple(gone), tuple(more), tuple(notes))


def same_ids(joined: Inventory, part: Inventory) -> Iterator[str]:
    """Yield what two parts drive under one id of one hardware, such as motors on a bus."""
    for system in part.document.root.iterchildren(_SYSTEM):
        known = dict(chain.from_iterable(map(_ids, like(system, joined.document.root))))
        for key, name in _ids(system):
            if other := known.get(key):
                where = f"{part.document.file}:{system.sourceline}"
                yield f"{where}: {name!r} and {other!r} have one {'='.join(key)} on one hardware"


def _ids(system: _Element) -> Iterator[tuple[tuple[str, str], str]]:
    """Yield ((parameter, id), name) of each joint, gpio and sensor with an id."""
    for component in driven(system):
        for param in component.iterchildren("param"):
            if _ID.search(param.get("name", "")):
                yield (param.get("name", ""), text_of(param)), component.get("name", "")


def like(system: _Element, root: _Element) -> Iterator[_Element]:
    """Yield the systems with the type and hardware of another one."""
    wanted = _system_key(system)
    yield from (it for it in root.iterchildren(_SYSTEM) if _system_key(it) == wanted)


def driven(system: _Element) -> Sequence[_Element]:
    """Return the elements of a system except its hardware."""
    return [it for it in system.iterchildren("*") if it.tag != _HARDWARE]


def has_all(system: _Element, others: Iterable[_Element]) -> bool:
    """Return whether one of some systems has all that another one drives."""
    wanted = [plain(it) for it in driven(system)]
    every = ([plain(it) for it in driven(other)] for other in others)
    return any(all(it in own for it in wanted) for own in every)


def _system_key(system: _Element) -> tuple[object, ...]:
    found = [plain(it) for it in system.iterchildren(_HARDWARE)]
    return system.get("type", ""), tuple(sorted(found, key=repr))


# Colour and texture.
_Look = tuple[tuple[float, ...], str]
_TAG = "material"


def looks(root: _Element) -> dict[str, _Look]:
    """Return the appearance of each material that is described; those below the root count first."""
    found: dict[str, _Look] = {}
    below = root.iterfind(f"link/visual/{_TAG}")
    for it in (*root.iterchildren(_TAG), *below):
        look = _colour_and_texture(it)
        if look is not None:
            found.setdefault(it.get("name", ""), look)
    found.pop("", None)
    return found


def _colour_and_texture(material: _Element) -> _Look | None:
    colour, texture = material.find("color"), material.find("texture")
    if colour is None and texture is None:
        return None
    rgba = colour.get("rgba", "") if colour is not None else ""
    return numbers(rgba) or (), "" if texture is None else texture.get("filename", "")


def other_looks(joined: _Element, part: ReadPart) -> tuple[str, ...]:
    """Return the materials of a part that earlier parts define differently."""
    known, own = looks(joined), looks(part.inventory.document.root)
    # One without a look below the root is another one, too.
    bare_names = {it.get("name", "") for it in joined.iterchildren(_TAG)} - known.keys()
    met = known.keys() | bare_names
    return tuple(name for name, look in own.items() if name in met and known.get(name) != look)


def word_of(name: str, prefix: str) -> str:
    """Return the text before the materials of a part: its prefix, or its name."""
    return prefix or f"{name}_"


def prefixed(text: bytes, file: str, prefix: str, names: Collection[str]) -> bytes:
    """Return the text with a prefix before these materials."""
    starts = _starts(read_document(text, file), names)
    return b"".join(cut(text, (Edit(it, it, prefix.encode(), None) for it in starts)))


def bare(text: bytes, file: str, prefix: str, names: Collection[str]) -> bytes:
    """Return the text with the prefix removed from these materials."""
    starts = _starts(read_document(text, file), [prefix + it for it in names])
    return b"".join(cut(text, (Edit(it, it + len(prefix), b"", None) for it in starts)))


def _starts(document: Document, names: Collection[str]) -> Iterator[int]:
    """Yield where these names begin; in a block a material is one of Gazebo's."""
    for element, start in zip(document.elements, document.starts, strict=True):
        above = element.getparent()
        if element.tag != _TAG or above is None or above.tag == "gazebo":
            continue
        name = element.get("name", "")
        slot = value_slot(document.source, start, "name", name) if name in names else None
        if slot is not None:
            yield slot[0]


def repeated(joined: _Element, spans: Spans) -> Iterator[Edit]:
    """Yield edits that remove materials below the root that exist already."""
    names = {it.get("name") for it in joined.iterchildren(_TAG)}
    for it in spans.document.root.iterchildren(_TAG):
        if it.get("name") in names:
            yield left_out(spans, it)
