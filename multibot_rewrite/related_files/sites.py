# SPDX-License-Identifier: Apache-2.0
"""Names in a related file: what each is, where it is, what is known of it."""

from typing import TYPE_CHECKING, NamedTuple

import yaml

from multibot_rewrite.base.findings.finding import Finding, Rule

if TYPE_CHECKING:
    from multibot_rewrite.knowledge.records import Param

# The name of a section of parameters, which is that of a node.
SECTION = "section"
# What Gazebo calls a topic.
GZ_TOPIC = "gz topic"
# Where a relative name is resolved: in the node's namespace, in the one above it (the node joins the
# two itself), or outside of the robot's namespace, so that it has to be made absolute.
FROM_NODE, FROM_PARENT, IN_FULL = "node", "parent", "full"


class Slot(NamedTuple):
    """A value as it is written: its place, its characters with quotes, and what they say.

    ``style`` is how YAML writes it, or one of those here."""

    line: int
    column: int
    start: int
    end: int
    value: str
    style: str = ""

    @property
    def is_block(self) -> bool:
        """Return whether a slot is a block of several lines, where no name can be. Raises nothing."""
        return self.style in ("|", ">")


# Between its quotes: as it is, with XML's entities, and where it cannot be told from them.
AS_IS, XML, UNCLEAR = "as it is", "xml", "unclear"


class Site(NamedTuple):
    """A text in a file: its kind, the name as it is for one robot, its key and slot.

    ``kind`` is empty where the use is unknown. The text is the ``size`` characters from ``at``
    of the slot's value. ``is_sure`` is false for a guessed kind; ``in_key`` is true for a name
    in a key. ``together`` is the same for names of one list. ``bare`` says that the reader takes
    a slash in front off. ``node`` is the node that reads it, as the node sets call it, ``reach``
    where that resolves a relative name, ``param`` what is known of the parameter."""

    kind: str
    text: str
    key: str
    slot: Slot
    at: int = 0
    size: int = -1
    is_sure: bool = True
    in_key: bool = False
    together: int = 0
    bare: bool = False
    node: str = ""
    reach: str = FROM_NODE
    param: "Param | None" = None

    @property
    def line(self) -> int:
        """The line of its slot; raises nothing."""
        return self.slot.line

    @property
    def column(self) -> int:
        """The column of its slot; raises nothing."""
        return self.slot.column

    @property
    def own(self) -> bool:
        """Return whether the node itself makes the name. Raises nothing."""
        return self.param is not None and self.param.own


def slot_of(node: yaml.Node) -> Slot:
    """Return where a node of YAML is written, with its anchor and tag."""
    start, end = node.start_mark, node.end_mark
    style = getattr(node, "style", None) or ""
    return Slot(start.line + 1, start.column + 1, start.index, end.index, str(node.value), style)


def site_at(node: yaml.Node, kind: str, text: str, key: str = "", in_key: bool = False) -> Site:
    """Return the site that is the whole of a YAML node."""
    return Site(kind, text, key, slot_of(node), in_key=in_key)


def found_in(file: str, slot: Slot, rule: Rule, message: str, hint: str) -> Finding:
    """Return a finding of ``rule`` at a slot."""
    return rule.finding(message, hint, file=file, line=slot.line, column=slot.column)
