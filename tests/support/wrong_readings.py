# SPDX-License-Identifier: Apache-2.0
"""Readings of a source, or of an output, that are wrong, and the check that has to refuse each."""

from __future__ import annotations

from typing import Any

from proof_faults import ROVER
from wrong_plans import NOTE, Fault, Wrong

from multibot_rewrite.base.model import Edit
from multibot_rewrite.description import pipeline
from multibot_rewrite.description.steps import strip, verify as proof
from multibot_rewrite.description.steps.collect import Inventory

# ---------------------------------------------------------------- readings of the source


def claim_of(inventory: Inventory, text: bytes) -> int:
    """Which claim is that of the element that starts with a text."""
    start = inventory.document.source.index(text)
    return next(at for at, it in enumerate(inventory.claims) if it.start == start)


def without(text: bytes) -> Wrong:
    """Return a reading that misses what is claimed of an element."""

    def wrong(inventory: Inventory) -> Inventory:
        gone = claim_of(inventory, text)
        return inventory._replace(
            claims=[it for at, it in enumerate(inventory.claims) if at != gone],
            names=[it for at, it in enumerate(inventory.names) if at != gone],
        )

    return wrong


def claimed(text: bytes, **fields: Any) -> Wrong:
    """Return a reading with another claim in the place of that of an element."""

    def wrong(inventory: Inventory) -> Inventory:
        at = claim_of(inventory, text)
        claims = list(inventory.claims)
        claims[at] = claims[at]._replace(**fields)
        return inventory._replace(claims=claims)

    return wrong


def also_claimed(text: bytes, like: bytes, attribute: str, value: str) -> Wrong:
    """Return a reading with one claim more, behind that of the element ``like``, which it resembles."""

    def wrong(inventory: Inventory) -> Inventory:
        document = inventory.document
        number = document.starts.index(document.source.index(text))
        at = claim_of(inventory, like)
        new = inventory.claims[at]._replace(
            element=document.elements[number],
            start=document.starts[number],
            attribute=attribute,
            value=value,
        )
        names, claims = list(inventory.names), list(inventory.claims)
        claims.insert(at + 1, new)
        names.insert(at + 1, names[at])
        return inventory._replace(claims=claims, names=names)

    return wrong


def resolved(text: bytes, *names: dict[str, Any]) -> Wrong:
    """Return a reading with other names in an element's value: the first one but for these."""

    def wrong(inventory: Inventory) -> Inventory:
        at = claim_of(inventory, text)
        first = inventory.names[at][0]
        changed = list(inventory.names)
        changed[at] = tuple(first._replace(**it) for it in names)
        return inventory._replace(names=changed)

    return wrong


def other_order(inventory: Inventory) -> Inventory:
    """Return the first two claims of links in the place of each other."""
    one, two = claim_of(inventory, b'<link name="base'), claim_of(inventory, b"<link name='wheel")
    claims, names = list(inventory.claims), list(inventory.names)
    claims[one], claims[two] = claims[two], claims[one]
    names[one], names[two] = names[two], names[one]
    return inventory._replace(claims=claims, names=names)


PARENT, CHILD, LINK = b'<parent link="base', b'<child link="wheel', b'<link name="base'
INPUTS = (
    ("a declaration that is not seen", "same_names", without(LINK)),
    ("a use that is not seen", "same_names", without(PARENT)),
    ("the text of a plugin that is not seen", "same_names", without(b"<left_joint>")),
    ("a rule that is not seen", "same_names", without(b"<remapping>")),
    ("a claim too many", "same_names", also_claimed(NOTE, PARENT, "link", "base")),
    ("a text that is claimed, too", "same_names", also_claimed(NOTE, PARENT, "", "base and axle")),
    (
        "the claim of another attribute",
        "same_names",
        claimed(b'<joint name="axle', attribute="type", value="continuous"),
    ),
    (
        "the claim of another element",
        "unreadable",
        claimed(CHILD, start=ROVER.index(PARENT), value="base"),
    ),
    ("a use that is resolved as a joint", "same_targets", resolved(PARENT, {"kind": "joint"})),
    ("a use that is not resolved", "same_targets", resolved(PARENT, {"kind": ""})),
    ("a value without names", "same_targets", resolved(PARENT)),
    ("a value with a name twice", "same_targets", resolved(PARENT, {"kind": ""}, {"kind": ""})),
    ("a name that ends before", "same_targets", resolved(PARENT, {"text": "bas"})),
    (
        "a joint that is taken for a link",
        "same_targets",
        resolved(b"<left_joint>", {"kind": "link"}),
    ),
    ("claims in another order", "same_names", other_order),
    ("a plugin that is not seen", "nothing_to_add", lambda it: it._replace(hosts=it.hosts[1:])),
    (
        "a plugin that is taken for another",
        "nothing_to_add",
        lambda it: it._replace(hosts=[host._replace(node=it.hosts[-1].node) for host in it.hosts]),
    ),
)


# ---------------------------------------------------------------- readings of the output

OUTPUTS = (
    (
        "a declaration of the output that is not seen",
        "same_names",
        without(b'<link name="base/robot1'),
    ),
    ("a use of the output that is not seen", "same_names", without(b'<parent link="base/robot1')),
    (
        "a claim of the output too many",
        "same_names",
        also_claimed(NOTE, b'<parent link="base/', "link", "base"),
    ),
    (
        "a use of the output that is not resolved",
        "same_targets",
        resolved(b'<parent link="base/', {"kind": ""}),
    ),
)

STRIPS = (
    ("nothing is stripped", lambda edits_: []),
    ("one name is not stripped", lambda edits_: edits_[1:]),
    (
        "too much is stripped",
        lambda edits_: [*edits_[:-1], edits_[-1]._replace(end=edits_[-1].end + 1)],
    ),
    ("something else is stripped, too", lambda edits_: [Edit(0, 1, b"", None), *edits_]),
    (
        "what is inserted is not stripped",
        lambda edits_: [it for it in edits_ if it.end - it.start < 9],
    ),
)

# As values without their affixes, where a text is stripped value by value.
VALUES = (
    ("no value is stripped", lambda value: f"{value}/robot1"),
    ("a value loses too much", lambda value: value[:-1]),
)

READINGS = [
    *(Fault(about, by, pipeline, "collect", wrong) for about, by, wrong in INPUTS),
    *(Fault(about, by, proof, "collect", wrong) for about, by, wrong in OUTPUTS),
    *(Fault(about, "strips_to_source", strip, "strip_edits", wrong) for about, wrong in STRIPS),
    *(
        Fault(about, "strips_to_source", strip, "stripped", wrong, "model")
        for about, wrong in VALUES
    ),
]
