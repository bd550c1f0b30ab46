# SPDX-License-Identifier: Apache-2.0
"""A xacro's arguments: those that no file knows, those that reach one of a frame and its link."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import WARNING, XACRO, declare
from multibot_rewrite.base.model import Claim
from multibot_rewrite.base.naming import FRAME_KINDS
from multibot_rewrite.base.nearest import did_you_mean_one_of
from multibot_rewrite.description.checks.problem import Problem, about
from multibot_rewrite.description.steps.collect import Inventory

if TYPE_CHECKING:
    from multibot_rewrite.description.steps.renames import RenameMap

SEPARATORS = "/_-."
UNREAD = "MB144"
# More names are not listed where none is like the one that is given.
_LISTED = 10

ARGUMENT_MISSES_REFERENCE = declare(
    "MB143",
    "argument-misses-reference",
    WARNING,
    formats=("rewrite", XACRO),
    options={"xacro_args": {"prefix": "{robot}_"}},
)


def missed_by_arguments(
    inventory: Inventory, renames: RenameMap, plain: Mapping[tuple[str, str], str], robot: str
) -> Iterator[Problem]:
    """Yield frames that arguments do not rename: ``plain`` maps names without the arguments (kind
    and text) to those that ``robot`` has with them."""
    links = inventory.declared["link"]
    pairs = zip(inventory.claims, inventory.names, strict=True) if robot else ()
    for claim, names in pairs:
        for name in names:
            text = name.text.removeprefix("/")
            if name.kind not in FRAME_KINDS or text in links:
                continue
            if plain.get(("link", text)) in links:
                yield _missed(claim, text, plain["link", text])
            # A frame with the argument, named after a link without it.
            bare = text.replace(robot, "").strip(SEPARATORS)
            if (name.kind, name.text) in renames.naming.own and bare in links:
                link = renames.spelled(robot, "link", bare)
                if link != text:
                    yield _missed(claim, text, link)


def _missed(claim: Claim, frame: str, link: str) -> Problem:
    message = f"frame {frame!r} is the link {link!r}: the xacro's argument reaches only one of them"
    hint = "write the argument at both, or do not give it"
    return about(claim, ARGUMENT_MISSES_REFERENCE.code, message, hint)


def unread_arguments(
    root: _Element, unread: Iterable[str], known: Sequence[str]
) -> Iterator[Problem]:
    """Yield given arguments that no file of a xacro knows; ``known`` are those that it knows."""
    for name in unread:
        message = f"argument {name!r} is given, and no file of this xacro declares or reads it"
        more = ", ..." if len(known) > _LISTED else ""
        listed = f"its arguments are {', '.join(known[:_LISTED])}{more}" if known else "it has none"
        yield Problem(root, message, None, did_you_mean_one_of(name, known) or listed, (), UNREAD)
