# SPDX-License-Identifier: Apache-2.0
"""``<gazebo>`` blocks of the whole robot: what two parts both say is said once.

A plugin that makes a controller manager is there once for all parts, with the parameter files of all
(gz_ros2_control_plugin.cpp and gazebo_ros2_control_plugin.cpp read each ``<parameters>``). The first
part's other settings count.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from lxml.etree import _Element

from multibot_rewrite.base.model import Edit
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.joining.kept import left_out, was
from multibot_rewrite.description.readback.xml import plain, text_of
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.spans import Spans

_FILES = "parameters"
# What stands in a block for itself; anything else is a setting of the robot.
_THINGS = ("plugin", "joint", "link", "frame", "model", "gripper", "sensor", "light")


class Once(NamedTuple):
    """The edits of a part and of what is before it, and what a person should know."""

    part: tuple[Edit, ...]
    joined: tuple[Edit, ...]
    notes: tuple[str, ...]


def said_once(joined: Inventory, part: Inventory) -> Once:
    """What of a part's blocks for the whole robot is left out, as an earlier part says it."""
    managers, others = _managers(joined), _managers(part)
    said = {plain(it) for block in _blocks(joined) for it in _inside(block)}
    spans, before = Spans(part.document), Spans(joined.document)
    edits: list[Edit] = []
    more: list[Edit] = []
    notes: list[str] = []
    for block in _blocks(part):
        doubles = [it for it in _inside(block) if plain(it) in said]
        for plugin, names in others.items():
            if plugin.getparent() is not block or plugin in doubles or not managers:
                continue
            first = next((it for it, its in managers.items() if its == names), None)
            if first is None:
                notes.append(_another(plugin, part))
                continue
            doubles.append(plugin)
            more += _more_files(before, first, plugin, spans)
            notes += _other_settings(first, plugin, part)
        notes += _of_the_whole(block, doubles, part)
        gone = [block] if doubles and len(doubles) == len(_inside(block)) else doubles
        edits += [left_out(spans, it) for it in gone]
    return Once(tuple(edits), tuple(more), tuple(notes))


def _blocks(inventory: Inventory) -> Iterator[_Element]:
    for it in inventory.document.root.iterchildren("gazebo"):
        if not it.get("reference"):
            yield it


def _inside(element: _Element) -> list[_Element]:
    return list(element.iterchildren("*"))


def _managers(inventory: Inventory) -> dict[_Element, tuple[str, ...]]:
    """The plugins that make a controller manager, with the names of what is known of them."""
    return {element: section.names for element, section in inventory.served if section.process_wide}


def _another(plugin: _Element, part: Inventory) -> str:
    name = plugin.get("filename", "")
    where = f"{part.document.file}:{plugin.sourceline}"
    return f"{where}: {name!r} makes a controller manager, and another plugin before it does, too"


def _files(plugin: _Element) -> list[_Element]:
    return list(plugin.iterchildren(_FILES))


def _more_files(before: Spans, plugin: _Element, other: _Element, spans: Spans) -> Iterator[Edit]:
    """The parameter files of a plugin that is left out, put into the one that stays."""
    known = {text_of(it) for it in _files(plugin)}
    texts = [spans.text_of(it) for it in _files(other) if text_of(it) not in known]
    last = _inside(plugin)[-1:]
    if last:
        at = before.end_of(last[0])
        yield from (was(at, at, b"", b"\n      " + text) for text in texts)
    elif texts:
        start, end = before.start_of(plugin), before.end_of(plugin)
        old = before.text_of(plugin)
        yield was(start, end, old, _filled(old, b"".join(texts), plugin))


def _filled(old: bytes, inside: bytes, plugin: _Element) -> bytes:
    """A plugin without elements, with one."""
    head = old[:-2] + b">" if old.endswith(b"/>") else old[: old.rindex(b"</")]
    return head + inside + b"</%s>" % str(plugin.tag).encode()


def _other_settings(plugin: _Element, other: _Element, part: Inventory) -> Iterator[str]:
    first = {plain(it) for it in _inside(plugin)}
    for it in _inside(other):
        if it.tag != _FILES and plain(it) not in first:
            where = f"{part.document.file}:{it.sourceline}"
            yield f"{where}: <{it.tag}> is left out: the plugin of an earlier part counts"


def _of_the_whole(block: _Element, gone: Iterable[_Element], part: Inventory) -> Iterator[str]:
    for it in _inside(block):
        if it.tag not in _THINGS and it not in gone:
            yield f"{part.document.file}:{it.sourceline}: <{it.tag}> is now said of the whole robot"
