# SPDX-License-Identifier: Apache-2.0
"""What a recording holds: frozen records. It knows topics and not nodes."""

from collections.abc import Iterable
from typing import NamedTuple

from multibot_rewrite.base.grouping import dicts_by_key
from multibot_rewrite.system.records import (
    PUBLISHES,
    QUIET,
    TOPIC,
    Caveat,
    Edge,
    End,
    Environment,
    Heard,
    Qos,
    System,
    surely,
)

# In place of the RMW: such a snapshot has no nodes, so what asks for nodes has no answer.
ROSBAG = "rosbag2"
# In place of the nodes that sent what was recorded. A tool by its name.
RECORDER = "/_recorded"


class RecordedTopic(NamedTuple):
    """A topic of a recording.

    ``qos`` has one profile for each publisher that was recorded; ``frames`` are the ``header.frame_id``
    of its first messages, ``joints`` the names in those of joints, ``back`` by how many seconds a clock
    went back, ``pose`` that of the first of them, or of one with a number that is none.
    """

    name: str
    type: str
    messages: int
    qos: tuple[Qos, ...] = ()
    frames: tuple[str, ...] = ()
    joints: tuple[tuple[str, ...], ...] = ()
    back: float = 0.0
    pose: tuple[float, ...] = ()


class Recording(NamedTuple):
    """What was recorded in so many seconds, with the transforms of its tf topics."""

    topics: tuple[RecordedTopic, ...]
    transforms: tuple[Edge, ...]
    seconds: float
    caveats: tuple[Caveat, ...] = ()


def is_recorded(graph: System) -> bool:
    """Return whether a snapshot is of a recording."""
    return graph.environment.rmw == ROSBAG


def as_snapshot(found: Recording, plan: System | None = None) -> System:
    """Return the recording as a snapshot; transforms have the senders that the plan has."""
    seconds = round(found.seconds, 2)
    sent = [it for it in surely(plan).ends if it.role == PUBLISHES] if plan else []
    senders = dicts_by_key((it.name, it.node, None) for it in sent)
    frames = tuple(
        it._replace(publishers=tuple(senders.get(it.topic, it.publishers)))
        for it in found.transforms
    )
    around = Environment(0, "OFF", (), ROSBAG, "", False, 0, QUIET, seconds, found.caveats)
    heard = tuple(one for it in found.topics for one in _heard_on(it))
    ends = (
        End(TOPIC, PUBLISHES, it.name, it.type, "", RECORDER, qos, "")
        for it in found.topics
        for qos in it.qos or (None,)
    )
    return System((), tuple(ends), frames, around, heard)


def _heard_on(it: RecordedTopic) -> Iterable[Heard]:
    """Yield what the messages of a topic name: frames, joints, a clock that went back."""
    yield from (Heard(it.name, frame, pose=it.pose) for frame in it.frames)
    yield from (Heard(it.name, "", joints=names) for names in it.joints)
    if it.back:
        yield Heard(it.name, "", back=it.back)


def counted(found: Recording) -> dict[str, int]:
    """Return by topic how many messages were recorded."""
    return {it.name: it.messages for it in found.topics}
