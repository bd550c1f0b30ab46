# SPDX-License-Identifier: Apache-2.0
"""One ``<ros2_control>`` for parts that one driver serves: joints, sensors and gpios of a part's system
go into an earlier one with the same type and ``<hardware>``.

Source: ros2_control component_parser.cpp (``parse_resource_from_xml``): a system has one hardware, and
any number of joints, sensors, gpios and transmissions.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from lxml.etree import _Element

from multibot_rewrite.base.model import Edit
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.joining.kept import left_out, was
from multibot_rewrite.description.readback.xml import plain
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.spans import Spans

_SYSTEM, _HARDWARE = "ros2_control", "hardware"


class OneSystem(NamedTuple):
    """The edits of a part, whose systems are left out, and of what is before it; ``notes`` are about
    systems that stay."""

    part: tuple[Edit, ...] = ()
    joined: tuple[Edit, ...] = ()
    notes: tuple[str, ...] = ()


def one_system(joined: Inventory, part: Inventory) -> OneSystem:
    """A part's systems put into earlier ones; one that has no like stays."""
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
    return OneSystem(tuple(gone), tuple(more), tuple(notes))


def like(system: _Element, root: _Element) -> Iterator[_Element]:
    """The systems with the type and hardware of another one."""
    wanted = _hardware(system)
    yield from (it for it in root.iterchildren(_SYSTEM) if _hardware(it) == wanted)


def driven(system: _Element) -> Sequence[_Element]:
    """What a system has besides its hardware."""
    return [it for it in system.iterchildren("*") if it.tag != _HARDWARE]


def has_all(system: _Element, others: Iterable[_Element]) -> bool:
    """Has one of some systems all that another one drives?"""
    wanted = [plain(it) for it in driven(system)]
    return any(
        all(it in [plain(one) for one in driven(other)] for it in wanted) for other in others
    )


def _hardware(system: _Element) -> tuple[object, ...]:
    found = [plain(it) for it in system.iterchildren(_HARDWARE)]
    return system.get("type", ""), tuple(sorted(found, key=repr))
