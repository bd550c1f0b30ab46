# SPDX-License-Identifier: Apache-2.0
"""Dangers of ros2_control and MoveIt: an interface that is claimed and not exported, or claimed twice.

Source: ros2_control controller_manager.cpp (a controller whose interfaces do not exist is not
activated; a command interface has one owner) and its chaining: a controller's own interfaces are called
``CONTROLLER/...``.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding
from multibot_rewrite.base.nearest import Guesses
from multibot_rewrite.rules import declaration
from multibot_rewrite.rules.declaration import see, where
from multibot_rewrite.system.index import Index
from multibot_rewrite.system.records import CLAIMS, COMMAND, EXPORTS, JOINT, Interface, Place
from multibot_rewrite.system.tool_nodes import last_word

# What is done with it, what it is called besides its kind, and who does not give it.
_OF_HARDWARE = ("claims", " interface", "no ros2_control exports")
_WORDS = {JOINT: ("plans for", "", "no controller of MoveIt moves")}


class Missing(NamedTuple):
    """What a controller claims at one place and no hardware exports; ``near`` is what may be ``meant``,
    or another interface of the same joint, sensor or gpio."""

    claims: tuple[Interface, ...]
    near: Interface | None
    meant: str


def _not_exported(seen: Index) -> Iterator[Finding]:
    """Nothing is said where no hardware is known: another description may have it."""
    for robot, known in _by_robot(seen).items():
        for it in missing(known):
            first, *more = it.claims
            does, needed, gives = _WORDS.get(first.kind, _OF_HARDWARE)
            also = f" and {len(more)} more" if more else ""
            near = [it.near] if it.near else []
            cause = f"name one that is there{see((*near, first))}"
            if it.meant:
                cause = f"did you mean {it.meant}{see((*near, first))}"
            yield interface_not_exported.finding(
                f"{does} {first.kind}{needed} {first.name}{also}, which {gives}", cause,
                level=NOTE if first.kind == JOINT else WARNING,
                robot=robot, node=first.node, names=(first.name,), **where([first]),
            )  # fmt: skip


interface_not_exported = declaration.NOT_EXPORTED._replace(check=_not_exported)


def _by_robot(seen: Index) -> dict[str, list[Interface]]:
    found: dict[str, list[Interface]] = defaultdict(list)
    for it in seen.system.interfaces:
        found[seen.robot(it.node)].append(it)
    return found


def missing(known: Sequence[Interface]) -> Iterator[Missing]:
    """The claims without an export among the interfaces of one robot, by controller and place."""
    exports = {(it.kind, it.name): it for it in known if it.role == EXPORTS}
    opened: dict[tuple[str, Place], list[Interface]] = defaultdict(list)
    for it in open_claims(known):
        opened[it.node, it.place].append(it)
    hints = Guesses()
    for first, *more in opened.values():
        near = hints.nearest(first.name, [name for kind, name in exports if kind == first.kind])
        meant = exports.get((first.kind, near))
        yield Missing((first, *more), meant or _beside(first.name, exports.values()), near)


def open_claims(known: Sequence[Interface]) -> list[Interface]:
    """The claims that nothing exports; a controller chains to another one, whose name may be that of a
    sensor."""
    exports = {(it.kind, it.name) for it in known if it.role == EXPORTS}
    given = {kind == JOINT for kind, _ in exports}
    claims = [it for it in known if it.role == CLAIMS]
    chained = {last_word(it.node) for it in claims}
    return [
        it
        for it in claims
        if (it.kind == JOINT) in given
        and (it.kind, it.name) not in exports
        # Launch files fill in placeholders such as <namespace>.
        and not PLACEHOLDER.search(it.name)
        and it.name.partition("/")[0] not in chained - {last_word(it.node)}
    ]


def claims_any(known: Iterable[Interface]) -> bool:
    """Do the controllers claim an interface of this hardware? Else they are for another robot."""
    sides: dict[str, set[tuple[str, str]]] = {EXPORTS: set(), CLAIMS: set()}
    for it in known:
        sides[it.role].add((it.kind, it.name))
    return not sides[EXPORTS].isdisjoint(sides[CLAIMS])


def _beside(name: str, exports: Iterable[Interface]) -> Interface | None:
    owner = name.rpartition("/")[0]
    return next((it for it in exports if it.name.rpartition("/")[0] == owner), None)


def _claimed_twice(seen: Index) -> Iterator[Finding]:
    """Of one controller; what two of them command is a rule about those that are active."""
    for other, it in claimed_twice(seen.system.interfaces):
        yield interface_claimed_twice.finding(
            f"claims {it.name} by two parameters", f"name another joint{see((other, it))}",
            robot=seen.robot(it.node), node=it.node, names=(it.name,), **where([it]),
        )  # fmt: skip


interface_claimed_twice = declaration.CLAIMED_TWICE._replace(check=_claimed_twice)


def claimed_twice(known: Iterable[Interface]) -> Iterator[tuple[Interface, Interface]]:
    """Command interfaces that one controller claims a second time, behind the first claim."""
    first: dict[tuple[str, str], Interface] = {}
    for it in (it for it in known if (it.role, it.kind) == (CLAIMS, COMMAND)):
        other = first.setdefault((it.node, it.name), it)
        if other is not it:
            yield other, it
