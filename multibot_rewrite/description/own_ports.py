# SPDX-License-Identifier: Apache-2.0
"""Gives each further robot the next free number for a port that an earlier robot has.

A comment in front of what is changed says what was there, so that ``--undo`` can give it back:

    <!-- multibot robot2 numbered from 9002 -->

It says ``the default`` where nothing was written.

Sources of the steps (``address+STEP`` in the plugin definitions): ArduPilot
libraries/AP_HAL_SITL/SITL_cmdline.cpp (10 for each instance, ``sim_vehicle.py -I``); PX4-Autopilot
launch/multi_uav_mavros_sitl.launch (1 for each instance); of hardware see its section.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from lxml.etree import Comment, _Element

from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding, locate
from multibot_rewrite.base.model import Change, Edit, InputError
from multibot_rewrite.description.checks.problem import Problem, to_findings
from multibot_rewrite.description.readback.meeting import (
    NUMBERED,
    OPENED,
    advice,
    code_of,
    meetings,
    said,
)
from multibot_rewrite.description.readback.parameters import holds
from multibot_rewrite.description.readback.reading import read
from multibot_rewrite.description.readback.xml import elements_at
from multibot_rewrite.description.rewriters.plugin_definitions import grammar
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.steps.apply import Template, cut
from multibot_rewrite.description.steps.collect import Inventory, collect
from multibot_rewrite.description.steps.document import (
    Document,
    path_of,
    read_document,
    tag_end,
    text_slot,
)
from multibot_rewrite.description.steps.inserted import end_of

# So many robots are named in the note.
_NAMED = 4
_MARK = "<!-- multibot {} numbered from {} -->"
_DEFAULT = "the default"


class Port(NamedTuple):
    """A port number, the element and parameter with it, and what ``text`` replaces to change it.

    ``step`` leads to the next robot's number, ``last`` is the largest; ``element`` begins
    ``at``."""

    name: str
    number: int
    step: int
    last: int
    element: _Element
    at: int
    start: int
    end: int
    text: str

    @property
    def is_written(self) -> bool:
        """Return whether the file sets the port, so that it is no default."""
        return self.start < self.end


class Numbered(NamedTuple):
    """The texts of robots with own port numbers, and a message and a hint for each parameter."""

    texts: tuple[bytes, ...]
    notes: tuple[tuple[str, str], ...]


def numbered(robots: Mapping[str, tuple[bytes, Sequence[Port]]]) -> Numbered:
    """Return texts of robots in which no two have a number in common; raises nothing."""
    taken = {port.number for _, own in robots.values() for port in own}
    held: set[int] = set()
    given: dict[str, list[tuple[str, int]]] = {}
    changed: set[str] = set()
    texts: list[bytes] = []
    for robot, (text, own) in robots.items():
        new: dict[int, int] = {}
        for it in own:
            new[it.number] = new.get(it.number) or _next_free_number(it, held, taken)
            taken.add(new[it.number])
            given.setdefault(it.name, []).append((robot, new[it.number]))
        held |= {*new.values()}
        edits = _port_edits(robot, ((it, new[it.number]) for it in own))
        changed |= {it.name for it in own if new[it.number] != it.number}
        texts.append(b"".join(cut(text, edits)) if edits else text)
    notes = tuple(numbers_message(it, given[it]) for it in sorted(changed))
    return Numbered(tuple(texts), notes)


def numbers_message(name: str, given: Iterable[tuple[str, int]]) -> tuple[str, str]:
    """Return message and hint: which number each robot got for a port; raises nothing."""
    words = [f"{robot} {number}" for robot, number in given]
    more = f" and {len(words) - _NAMED} more" if words[_NAMED:] else ""
    message = f"{name} is numbered: {', '.join(words[:_NAMED])}{more}"
    return message, "start what each robot talks to with its number"


def _next_free_number(port: Port, held: set[int], taken: set[int]) -> int:
    """Return the next free number for a port; the robot's own if none is left."""
    number = port.number
    while number in held or (number in taken and number != port.number):
        number += port.step
    return number if number <= port.last else port.number


def ports_of(inventory: Inventory) -> Iterator[Port]:
    """Yield the numbers that can differ for each robot, with their places; raises nothing."""
    document = inventory.document
    starts = dict(zip(document.elements, document.starts, strict=True))
    for host, section in inventory.served:
        for word in section.opens:
            opened = grammar.split_opens(word)
            if opened.step and (not opened.when or holds(host, opened.when)):
                there = list(elements_at(host, grammar.split_path(opened.path)[0]))
                for it in there:
                    yield from _written_ports(document.source, starts[it], it, opened)
                if opened.default and not there:
                    yield from _default(document.source, starts, host, opened)


def _written_ports(
    source: bytes, start: int, element: _Element, opened: grammar.Opened
) -> Iterator[Port]:
    """Yield the port that an element's text is, if it is a number above 0."""
    text = text_of(element)
    slot = text_slot(source, start, text) if text.isdecimal() and int(text) else None
    if slot:
        name = grammar.split_step(grammar.split_path(opened.path)[0][-1])[2] or opened.path
        yield Port(name, int(text), *opened.numbers, element, start, *slot, "{}")


def _default(
    source: bytes, starts: Mapping[_Element, int], host: _Element, opened: grammar.Opened
) -> Iterator[Port]:
    """Yield a port that the file leaves to its default, to be inserted into its plugin."""
    *above, last = grammar.split_path(opened.path)[0]
    inside = next(elements_at(host, tuple(above)), None)
    start = 0 if inside is None else starts[inside]
    at = tag_end(source, start) if start else 0
    if inside is not None and at and not source.endswith(b"/>", start, at):
        tag, attribute, value = grammar.split_step(last)
        named = f' {attribute}="{value}"' if attribute else ""
        text = f"<{tag}{named}>{{}}</{tag}>"
        number = int(opened.default)
        yield Port(value or opened.path, number, *opened.numbers, inside, at, at, at, text)


def _port_edits(robot: str, given: Iterable[tuple[Port, int]]) -> list[Edit]:
    """Return the edits that give a robot its numbers, each after a comment with the old one."""
    edits = []
    # What is put at the begin of another element stands before its comment.
    for it, number in sorted(given, key=lambda pair: pair[0].is_written):
        if number != it.number:
            mark = _MARK.format(robot, it.number if it.is_written else _DEFAULT)
            edits += [
                Edit(it.at, it.at, mark.encode(), None),
                Edit(it.start, it.end, it.text.format(number).encode(), None),
            ]
    return sorted(edits, key=lambda it: it.start)


def without_numbers(source: bytes, file: str, robot: str, tree: Tree) -> bytes:
    """Return the text with the original numbers, verified; raises InputError if it was edited."""
    document = read_document(source, file)
    edits = sorted(_taken_out(document, robot), key=lambda it: it.start)
    if not edits:
        return source
    text = b"".join(cut(source, edits))
    before, now = (ports_of(collect(it, tree)) for it in (read_document(text, file), document))
    again = _port_edits(robot, ((it, new.number) for it, new in zip(before, now, strict=False)))
    if b"".join(cut(text, again)) != source:
        raise _error_for_edit_by_hand(document, robot)
    return text


def _error_for_edit_by_hand(document: Document, robot: str) -> InputError:
    what = f"a number of {robot} or the comment before it was edited by hand; restore it"
    return InputError(f"{document.file}: {what}")


def _taken_out(document: Document, robot: str) -> Iterator[Edit]:
    """Yield the edits that restore the number of each commented element, or remove it."""
    source, starts = document.source, dict(zip(document.elements, document.starts, strict=True))
    head, tail = _MARK[4:-3].format(robot, "\n").split("\n")
    for comment in document.root.iter(Comment):
        said, element = comment.text or "", next(comment.itersiblings("*"), None)
        if not (said.startswith(head) and said.endswith(tail)):
            continue
        start = starts[element] if element is not None else 0
        mark, old = f"<!--{said}-->".encode(), said[len(head) : -len(tail)]
        slot = text_slot(source, start, text_of(element)) if element is not None else None
        if slot is None or not source.endswith(mark, 0, start):
            raise _error_for_edit_by_hand(document, robot)
        end = end_of(source, start) if old == _DEFAULT else start
        yield Edit(start - len(mark), end, b"", None)
        if old != _DEFAULT:
            yield Edit(*slot, old.encode(), None)


def number_changes(template: Template, data: bytes) -> Iterator[Change]:
    """Yield the numbers of a robot's text that differ from the source, with places; raises nothing."""
    source, file, *_ = template.inventory.document
    written = collect(read_document(data, file), template.tree)
    for it, new in zip(ports_of(template.inventory), ports_of(written), strict=False):
        if new.number != it.number:
            place, path = locate(source, it.start), path_of(it.element)
            yield Change(*place, "port", path, str(it.number), str(new.number), "numbered")


def judged_together(
    template: Template, texts: Mapping[str, bytes]
) -> tuple[list[bytes], list[Finding]]:
    """Return the texts of robots with own port numbers, and findings: numbers and shared names."""
    document, definitions = template.inventory.document, template.tree.definitions
    file = document.file
    again = {it: collect(read_document(texts[it], file), template.tree) for it in texts}
    made = numbered({it: (texts[it], [*ports_of(again[it])]) for it in texts})
    names = {
        robot: [it for it in read(text, file, definitions).names if code_of(it) == OPENED]
        for robot, text in zip(texts, made.texts, strict=True)
    }
    root = document.root
    met = [
        Problem(
            it.name.element_in(root),
            said(f"{it.robot} and {it.other} would both", it.name, it.twin),
            hint=advice(it.name, together=True),
            code=OPENED,
        )
        for it in meetings(names, template.naming)
    ]
    notes = [Problem(root, message, hint=hint, code=NUMBERED) for message, hint in made.notes]
    told = to_findings(document, notes, NOTE, of_file=True)
    return [*made.texts], [*to_findings(document, met, WARNING), *told]
