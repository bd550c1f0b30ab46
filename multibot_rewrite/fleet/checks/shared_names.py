# SPDX-License-Identifier: Apache-2.0
"""Names that all robots of a fleet are to share, and that none of its robots has."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import Protocol

from multibot_rewrite.base.conventions import SHARED_TOPICS, WORLD_FRAMES
from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding, declare
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.naming import FRAME_KINDS, TF_TOPICS, TOPIC_KINDS, Naming
from multibot_rewrite.base.nearest import MISTYPED, nearest
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.spelling.records import Table
from multibot_rewrite.spelling.transforms import Edges

TOPICS, FRAMES = "shared_topics", "shared_frames"
NOWHERE: Mapping[str, tuple[str, int]] = {}
_UNKNOWN = "correct it, unless a node that is not known has it"
# What may be between a name and the robot's.
_BETWEEN = "/_-."
NOBODYS = declare("MF838", "shared-by-nothing", WARNING, formats=("fleet",))


class NamesOfFleet(Protocol):
    """What is asked of a fleet: its names, and the words that stand for each robot in them."""

    @property
    def naming(self) -> Naming: ...
    @property
    def inventories(self) -> Mapping[str, Inventory]: ...
    @property
    def table(self) -> Table: ...
    @property
    def edges(self) -> Edges: ...
    @property
    def words(self) -> Mapping[str, str]: ...


def shared_by_nothing(
    fleet: NamesOfFleet,
    texts: Iterable[bytes] = (),
    places: Mapping[str, tuple[str, int]] = NOWHERE,
) -> Iterator[Finding]:
    """Yield a finding for each shared name that no description and no node of the robots has.

    A name that is in one of ``texts``, those of further files of the robots, is not missed. ``places``
    are the file and line of the keys of a fleet file.
    """
    usual_topics = {*(it.strip("/") for it in SHARED_TOPICS), *TF_TOPICS}
    asked_topics = sorted(fleet.naming.shared_topics - usual_topics)
    asked_frames = sorted(fleet.naming.shared_frames - {*WORLD_FRAMES})
    if not asked_topics and not asked_frames:
        return
    frames, topics = _described(fleet, FRAME_KINDS), _described(fleet, TOPIC_KINDS)
    frames |= {
        it for sent in fleet.edges.values() for edge in sent for it in (edge.child, edge.parent)
    }
    topics |= {end.name.strip("/") for _, end, _ in fleet.table.ends}
    further = b"\n".join(texts)
    asked = (
        *((it, topics, frames, "/") for it in asked_topics),
        *((it, frames, topics, "") for it in asked_frames),
    )
    for name, own, others, slash in asked:
        if name not in own and name.encode() not in further:
            file, line = places.get(TOPICS if slash else FRAMES, ("", 0))
            what, other, key = ("topic", "frame", FRAMES) if slash else ("frame", "topic", TOPICS)
            message = f"{slash}{name} is to be shared, and no robot has a {what} of that name"
            near = nearest(name, sorted(own), MISTYPED)
            hint = f"did you mean {slash + near!r}?" if near else ""
            if name in others:
                option = f"--shared {'' if slash else '/'}{name}"
                hint = f"it is a {other}: write it below {key}, or {option}"
            level, names = WARNING if hint else NOTE, (f"{slash}{name}",)
            found = NOBODYS.finding(message, hint or _UNKNOWN, level=level, names=names)
            yield found._replace(file=file, line=line, column=min(line, 1))


def _described(fleet: NamesOfFleet, kinds: Collection[str]) -> set[str]:
    """Return the names of some kinds in the descriptions, with and without the robot's name."""
    words = lists_by_key((robot, word) for word, robot in fleet.words.items())
    found: set[str] = set()
    for robot, inventory in fleet.inventories.items():
        named = (it for names in inventory.names for it in names)
        texts = {
            it.text.strip("/")
            for it in named
            if it.kind in kinds or any(kind in kinds for kind in it.kinds)
        }
        found |= texts
        found |= {text.replace(word, "").strip(_BETWEEN) for text in texts for word in words[robot]}
    return found
