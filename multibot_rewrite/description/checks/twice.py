# SPDX-License-Identifier: Apache-2.0
"""Does a description carry a robot's name already? A rewrite for that robot would add it once more."""

from collections import Counter
from collections.abc import Collection, Iterable, Iterator
from typing import NamedTuple

from multibot_rewrite.base.conventions import ROWS
from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.model import Claim
from multibot_rewrite.base.naming import (
    FRAME_KINDS,
    NO_OWN_NAMES,
    SEPARATORS,
    TOPIC_KINDS,
    OwnNames,
)
from multibot_rewrite.base.wording import plural
from multibot_rewrite.description.checks.problem import Problem, about
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.inserted import markers

# What a rewrite may put between a name and the robot's; "__" begins and ends like "_".
BETWEEN = ("/", "_", "-", ".")
# A model may well be called like its robot without any rewrite, and a shape like a part of it.
CARRYING = frozenset(SEPARATORS) - {"model", "shape"}
PART_WORDS = frozenset(word for words, _ in ROWS["words of parts"] for word in words)
# Names of these kinds are counted together where a robot is called like a part.
GROUPS = {**dict.fromkeys(FRAME_KINDS, "link"), **dict.fromkeys(TOPIC_KINDS, "topic")}
COUNTED = ("link", "joint", "namespace", "topic")
SHOWN = 3


class UsedName(NamedTuple):
    """A name of a description, and the first value that holds it."""

    kind: str
    text: str
    claim: Claim


def already_rewritten(
    inventory: Inventory,
    robots: Iterable[str],
    again: bool,
    own: OwnNames = NO_OWN_NAMES,
    kinds: Collection[str] = CARRYING,
) -> Iterator[Problem]:
    """Yield robots whose name is already in names or markers of the document.

    With ``again`` only markers count. Names of ``own`` have the robot's name by a xacro argument
    and do not count. ``kinds`` are the kinds of names that get the robot's name."""
    marked = {mark.robot for mark in markers(inventory.document)}
    asked = list(robots)
    text = "\n".join({name.text for names in inventory.names for name in names}) if asked else ""
    for robot in asked:
        # Most robots are in no name at all. With ``again`` names alone do not matter.
        looked = robot in text and (not again or robot in marked)
        found = carrying(_names(inventory, kinds), robot, own) if looked else []
        if found or robot in marked:
            yield _problem(inventory, robot, found, robot in marked)


def rewritten_before(inventory: Inventory) -> Iterator[Problem]:
    """Yield the robots for which an earlier rewrite inserted something, or that every name tells of."""
    marked = dict.fromkeys(it.robot for it in markers(inventory.document))
    for robot in marked or _in_every_name(inventory):
        message = f"it was rewritten for {robot}, and its names stay in it"
        hint = "rewrite the source file, or undo that with --undo"
        yield Problem(inventory.document.root, message, None, hint, (), "MB106")


def _in_every_name(inventory: Inventory) -> Iterator[str]:
    """Yield prefixes or postfixes that all links have, and those of the model."""
    model = next((it.text for it in _names(inventory, ("model",))), "")
    links = [it.text for it in _names(inventory, ("link",))]
    for at, beside in ((-1, model.endswith), (0, model.startswith)):
        words = {it.split("/")[at] if "/" in it else "" for it in links}
        if len(words) == 1 and beside(("_" + min(words), min(words) + "_")[at + 1]):
            yield from filter(None, words)


def _names(inventory: Inventory, kinds: Collection[str]) -> list[UsedName]:
    """Return each name of these kinds that a rewrite changes, with its first value."""
    found: dict[tuple[str, str], UsedName] = {}
    for claim, names in zip(inventory.claims, inventory.names, strict=True):
        for name in names if claim.site.role != "keep" else ():
            kind = name.kind or name.kinds[0]
            if kind in kinds and (kind, name.text) not in found:
                found[kind, name.text] = UsedName(kind, name.text, claim)
    return list(found.values())


def carrying(known: list[UsedName], robot: str, own: OwnNames = NO_OWN_NAMES) -> list[UsedName]:
    """Return the names with a robot's name in any layout, with any separator, without ``own``.

    If it is a usual word for a part, such as ``left`` or ``arm``, only if more than half of the links,
    joints, namespaces or topics have it: a few have the word without any rewrite.
    """
    kept = {text for _, text in own}
    found = [name for name in known if name.text not in kept and _carries_name(name, robot)]
    return found if not is_part(robot) or _is_in_most(found, known, robot) else []


def is_part(robot: str) -> bool:
    """Return whether a robot is named as a part: ``left``, ``base``, ``left_arm``, ``lf``."""
    words = robot.split("_")
    return all(word in PART_WORDS or (len(word) < 3 and word.isalpha()) for word in words)


def _carries_name(name: UsedName, robot: str) -> bool:
    # A name may be a slash and no more: that of robot1 is //robot1.
    text = name.text.removeprefix("/")
    if text == robot:
        return name.kind == "namespace"
    # A joint is called left_joint whatever the robot is called.
    if robot == name.kind:
        return False
    return text.lstrip("/").startswith(tuple(robot + it for it in BETWEEN)) or text.endswith(
        tuple(it + robot for it in BETWEEN)
    )


def _is_in_most(found: Iterable[UsedName], known: Iterable[UsedName], robot: str) -> bool:
    """Return whether more than half of a kind's names carry the robot's name."""
    # In a topic it must be between slashes: ``left_scan`` is the scan of a part.
    counted = (it for it in found if it.kind not in TOPIC_KINDS or robot in it.text.split("/"))
    carried, all_ = (
        Counter(GROUPS.get(it.kind, it.kind) for it in names) for names in (counted, known)
    )
    return any(2 * carried[kind] > all_[kind] for kind in COUNTED)


def _problem(inventory: Inventory, robot: str, found: list[UsedName], marked: bool) -> Problem:
    """Return the problem that a description is already rewritten for a robot."""
    carried = f"its name is in {_names_in_words(inventory, found)}" if found else ""
    added = "elements were added for it" if marked else ""
    why = " and ".join(filter(None, (carried, added)))
    message = f"the description is already rewritten for {robot}: {why}"
    # Two layers of added elements could not be told apart.
    again = "" if marked else ", or add its name once more with urdf-postfix --force"
    way = "undo the rewrite with urdf-postfix --undo and the options it was made with"
    hint = f"{way}, or name the robot otherwise{again}"
    if found:
        return about(found[0].claim, "MB106", message, hint)
    return Problem(inventory.document.root, message, None, hint, (), "MB106")


def _names_in_words(inventory: Inventory, found: list[UsedName]) -> str:
    # One of each kind tells more than three links.
    by_kind: dict[str, UsedName] = {}
    for name in found:
        by_kind.setdefault(name.kind, name)
    source = inventory.document.source
    first = [
        f"{name.kind} {name.text!r} (line {locate(source, name.claim.start)[0]})"
        for name in list(by_kind.values())[:SHOWN]
    ]
    rest = len(found) - len(first)
    *parts, last = [*first, *([plural(rest, "more name")] if rest else [])]
    return f"{', '.join(parts)} and {last}" if parts else last
