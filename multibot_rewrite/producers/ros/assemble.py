# SPDX-License-Identifier: Apache-2.0
"""The pure part of a snapshot: when the graph is settled, what to query, how answers are joined."""

import math
import time
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from multibot_rewrite.base.conventions import SENT_BY_EVERY_NODE
from multibot_rewrite.base.grouping import sets_by_key
from multibot_rewrite.base.wording import SEVERAL, plural, shorten
from multibot_rewrite.system.record_values import FARTHEST
from multibot_rewrite.system.records import (
    BUSY_MACHINE,
    EXPECTED,
    QUIET,
    TIMEOUT,
    TOPIC,
    Caveat,
    End,
    Node,
)

# Participants announce themselves every 3 s: a shorter quiet time proves nothing.
QUIET_SECONDS = 3.5
# What a network loses is sent again every 3 s, and may be lost again.
LOSSY_QUIET_SECONDS = 10.5
# Where all participants that there can be are known. Their nodes and endpoints follow at once, or one
# after another where a program starts.
ALL_KNOWN_SECONDS = 1.5
# More than this of one delay is a pause: of the process, or of the machine.
DELAY_SECONDS = 0.5
# So much of its time a look may wait for a processor.
STARVED = 1 / 3
# The endpoints of one participant arrive together; a busy machine may pause in between.
BURST_SECONDS = 0.5
# The second replaces the first in a rehearsal on a machine without tf2_msgs.
TF_TYPES = ("tf2_msgs/msg/TFMessage", "geometry_msgs/msg/TransformStamped")
# Their QoS is wanted where nobody reads them, too: what is latched comes to no other reader.
_LISTENED_TO = frozenset((
    *TF_TYPES, "nav_msgs/msg/OccupancyGrid", "geometry_msgs/msg/PoseWithCovarianceStamped",
))  # fmt: skip
# While a watched graph changes: what is silent is not known.
LISTENING = Caveat("headers-not-read", False, "sensors are listened to again after a change")
NO_ENCLAVES: Mapping[str, str] = {}
# Of transforms: below a micrometre.
_DIGITS = 9


class ReceivedTransform(NamedTuple):
    """A transform received on ``topic``; ``latched`` if the subscription is transient local."""

    topic: str
    latched: bool
    parent: str
    child: str


class LastChange(NamedTuple):
    """When the graph last changed, all of it and what is expected of it; in seconds."""

    all: float
    expected: float


class ObservationClock(NamedTuple):
    """Seconds of observation, and when the last poll was.

    While this process or the machine is paused, or has no processor for it, the graph is not quiet:
    what arrived meanwhile has not been read yet. So a poll that comes late adds no more to ``observed``
    than one in time. ``delayed`` are the seconds by which polls were late, of each half a second at
    most: one long pause is no busy machine.
    """

    observed: float = 0.0
    last: float = 0.0
    delayed: float = 0.0

    def after(self, now: float, planned: float) -> "ObservationClock":
        """Return the clock at a poll that was planned for ``planned`` seconds after the last one."""
        passed = now - self.last
        late = min(max(0.0, passed - planned), DELAY_SECONDS)
        return ObservationClock(self.observed + min(passed, planned), now, self.delayed + late)

    def since(self, other: "ObservationClock") -> "ObservationClock":
        """Return what was observed, and delayed, after ``other``."""
        return ObservationClock(
            self.observed - other.observed, self.last, self.delayed - other.delayed
        )

    def starved(self) -> Iterator[Caveat]:
        """Yield a limitation if a snapshot lacked processor time so long that nodes may be missing."""
        part = self.delayed / max(self.observed + self.delayed, DELAY_SECONDS)
        if part > STARVED:
            text = (
                f"this machine was too busy: the look waited for a processor in {part:.0%} of its time,"
                " so what is missing may only be late; look again when the machine is less busy"
            )
            yield Caveat(BUSY_MACHINE, True, text)


def so_far(names: Sequence[str]) -> str:
    """Return what is seen of a graph that may be incomplete yet: how many nodes, and where they are."""
    spaces = sorted({name.split("/")[1] for name in names if name.count("/") > 1})
    where = f" in {shorten(spaces, SEVERAL)}" if spaces else ""
    return f"{plural(len(names), 'node')}{where} so far"


def cut_short(names: Sequence[str], endpoints: Iterable[End]) -> Iterator[Caveat]:
    """Yield what was not queried when the time was over during the slow queries."""
    known = {it.name for it in endpoints if it.qos is not None}
    topics = {it.name: [it.name] for it in endpoints if it.kind == TOPIC}
    left = [it for it in topics_to_query(names, endpoints, topics, ()) if it not in known]
    which = f" ({shorten(left, SEVERAL)})" if left else ""
    text = f"the timeout was over before the QoS of all topics was read{which}"
    yield Caveat("cut-short", True, f"{text}; give a longer --timeout")


def unannounced(announced: int, here: int, nodes: int, lost: int) -> Iterator[Caveat]:
    """Yield a limitation if fewer participants ``announced`` themselves than are ``here`` by ports.

    Both count the observer's own; ``nodes`` were seen, datagrams ``lost``."""
    silent = here - announced
    if silent <= 0:
        return
    about = round(nodes * (here - 1) / max(announced - 1, 1))
    seen = f"{nodes} of about {about} nodes seen: " if nodes and announced > 1 else ""
    dropped = f", and this machine lost {plural(lost, 'datagram')} meanwhile" if lost > 0 else ""
    text = (
        f"{seen}{silent} of {plural(here - 1, 'program')} in this domain on this machine announced no"
        f" nodes{dropped}; they are stopped, still starting, or use another discovery range: look again"
    )
    yield Caveat("programs-unannounced", True, text)


def seen_by_one(nodes: Sequence[str]) -> Iterator[Caveat]:
    """Yield a limitation if two participants of this process see different ends of these nodes."""
    if nodes:
        text = (
            f"two participants of this look see different topics or services of"
            f" {shorten(nodes, SEVERAL)}: the network between the machines loses packets;"
            " look again, with a longer --timeout"
        )
        yield Caveat("network-loses-packets", True, text)


def not_heard(silent: Sequence[str]) -> Iterator[Caveat]:
    """Yield the silent topics if the time was over before messages could come."""
    which = f" on {shorten(silent, SEVERAL)}" if silent else ""
    text = f"the timeout was over before messages could come{which}; give a longer --timeout"
    yield Caveat("cut-short", True, text)


def why_settled(
    now: float,
    changed: LastChange,
    complete: bool,
    timeout: float,
    quiet: float = QUIET_SECONDS,
    *,
    unsure: bool = False,
) -> str:
    """Return why the observation can end, or an empty string; times are seconds since its start.

    ``complete``: all that is expected is there; ``quiet``: so long without a change suffices,
    unless the result is ``unsure``: it waited for a processor meanwhile, or two participants see
    different ends."""
    if complete and now - changed.expected >= BURST_SECONDS:
        return EXPECTED
    if now - changed.all >= quiet and not unsure:
        return QUIET
    return TIMEOUT if now >= timeout else ""


def topics_to_query(
    names: Sequence[str],
    endpoints: Iterable[End],
    topics: Mapping[str, Sequence[str]],
    requested: Collection[str],
) -> list[str]:
    """Return the topics to query for QoS and process, which is slow; all if node names repeat.

    ``topics`` are all topics of the graph with their types. Two nodes of one name hide each
    other's."""
    if len(set(names)) < len(names):
        return sorted(topics)
    sides = sets_by_key((end.name, end.role) for end in endpoints if end.kind == TOPIC)
    # Almost every node publishes one of these, so few queries show which nodes share a process.
    wanted = {*SENT_BY_EVERY_NODE, *requested}
    return sorted(
        topic
        for topic, types in topics.items()
        if len(sides[topic]) != 1 or topic in wanted or not _LISTENED_TO.isdisjoint(types)
    )


def merged(by_node: Iterable[End], by_topic: Mapping[str, Iterable[End]]) -> list[End]:
    """Return the endpoints by node; for queried topics those of the query, which know more."""
    kept = [end for end in by_node if end.kind != TOPIC or end.name not in by_topic]
    return kept + [end for ends in by_topic.values() for end in ends]


def processes_by_node(endpoints: Iterable[End]) -> dict[str, list[str]]:
    """Return the processes seen for each node name."""
    found = sets_by_key((end.node, end.process) for end in endpoints if end.process)
    return {node: sorted(own) for node, own in found.items()}


def nodes_with_process(
    names: Sequence[str],
    processes: Mapping[str, Sequence[str]],
    enclaves: Mapping[str, str] = NO_ENCLAVES,
) -> list[Node]:
    """Return one record for each node; nodes with one name are spread over its processes."""
    result = []
    for name, times in sorted(Counter(names).items()):
        own = processes.get(name) or [""]
        enclave = enclaves.get(name, "")
        result += [Node(name, own[at % len(own)], enclave) for at in range(times)]
    return result


def endpoints_with_process(
    endpoints: Iterable[End], processes: Mapping[str, Sequence[str]]
) -> list[End]:
    """Return endpoints sorted, each with the process of its node where the node has only one."""
    only = {node: own[0] for node, own in processes.items() if len(own) == 1}
    placed = (it._replace(process=it.process or only.get(it.node, "")) for it in endpoints)
    return sorted(
        placed,
        key=lambda it: (it.kind, it.name, it.role, it.node, it.process, it.type, repr(it.qos)),
    )


def numbers_of(transform: Any) -> tuple[float, ...]:
    """Return a geometry_msgs/Transform as a snapshot keeps it: inf where a number is none (NaN)."""
    at, turn = transform.translation, transform.rotation
    numbers = at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w
    return tuple(round(it, _DIGITS) if abs(it) < FARTHEST else math.inf for it in numbers)


def age_of(stamp: float | None) -> float:
    """Return a message's age by this machine's clock; less than a second is due to the network."""
    if stamp is None:
        return 0.0
    age = round(time.time() - stamp, 1)
    return math.inf if not stamp else age if abs(age) >= 1.0 else 0.0
