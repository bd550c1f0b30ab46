# SPDX-License-Identifier: Apache-2.0
"""Frozen records that pass from one step to the next, and the errors that stop a job.

Text positions are byte offsets into the source; lines and columns count from 1.
"""

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from lxml.etree import _Element


class SiteRow(NamedTuple):
    """The rule that at ``path`` below its section's element lives a declaration or a reference.

    ``role`` is ``"declares"``, ``"uses"`` or ``"keep"`` (never renamed; ``note`` says why).
    ``kinds`` are tried in order until one resolves. ``form`` says where inside the value the names
    are (see ``rewriters.forms``). ``default`` is the literal the consumer falls back to. ``empty`` is
    what it makes of an element that is there and empty: ``default``, ``model`` (the model's name) or
    ``itself``.
    ``namespaced`` is true where a ROS namespace reaches the value. ``whole_value_kind`` is the
    kind where the whole value is the name of a link or joint and of nothing else. ``when`` is
    ``sibling=text`` where only that sibling's text makes the value a name. ``below_model`` are the
    releases in which a relative topic here is below the namespace of the model. ``releases`` are
    the words for the only releases that read it, empty for all. ``fill`` is what is written where the
    default cannot be, which is below the name of the model. ``does`` is what the consumer does with a
    topic or service of that name (``publishes``, ``subscribes``, ``serves``), ``type`` its type.
    """

    path: str
    role: str
    kinds: tuple[str, ...]
    form: str
    default: str
    namespaced: bool
    section: str
    note: str
    line: int
    whole_value_kind: str = ""
    when: str = ""
    file: str = ""
    empty: str = "itself"
    below_model: str = ""
    releases: str = ""
    fill: str = ""
    does: str = ""
    type: str = ""


class Claim(NamedTuple):
    """One value of a document that a site claims; ``attribute`` is empty for element text.

    ``start`` is the byte offset of the element's start tag; ``value`` is the parsed value."""

    site: SiteRow
    element: "_Element"
    start: int
    attribute: str
    value: str


class Edit(NamedTuple):
    """Replace source bytes ``start:end`` by ``before + robot + after``.

    ``after`` is None where the new text does not hold the robot's name (``before`` is all of it)."""

    start: int
    end: int
    before: bytes
    after: bytes | None


class Change(NamedTuple):
    """One renamed or inserted value, as listed by ``--output-kind changes``."""

    line: int
    column: int
    kind: str
    path: str
    old: str
    new: str
    rule: str


class MultibotError(Exception):
    """Base of all errors this package raises on purpose."""


class UsageError(MultibotError):
    """An option or a name is wrong; the message proposes a right one."""


# Why an input cannot be read, where somebody decides by it (``InputError.cause``).
UNREADABLE, TEMPLATE, FOR_ROS_1, FOR_OLD_GAZEBO = "unreadable", "template", "ros 1", "old gazebo"
REFUSED, NOT_UTF8 = "refused", "not utf-8"
XACRO_FAILED, NO_PACKAGE, NO_ARGUMENT = "xacro", "xacro: package", "xacro: argument"
NOT_DEFINED = "xacro: name"


class InputError(MultibotError):
    """The input cannot be read; the message says where, why and what to do.

    ``cause`` is one of the constants above, or empty where nobody asks. ``name`` is what is not
    defined.
    """

    def __init__(self, message: str, cause: str = "", name: str = "") -> None:
        super().__init__(message)
        self.cause, self.name = cause, name


class DefinitionsError(MultibotError):
    """A definition file is wrong; the message names file and line."""


class ProofError(MultibotError):
    """The rewritten text failed its proof: a fault of this package, never of the user's file."""


class Unusable(MultibotError):
    """What a job needs, such as rclpy, is missing or does not start; the message has the remedy."""
