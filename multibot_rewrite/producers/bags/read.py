# SPDX-License-Identifier: Apache-2.0
"""A bag of rosbag2, MCAP or sqlite3 -> what it holds. The only module that imports rosbags.

A bag may be cut off or made by anybody: whatever its reader raises, the bag is at fault.
"""

from __future__ import annotations

import errno
import os
import re
from collections.abc import Collection, Iterable, Iterator
from functools import partial
from itertools import chain, islice
from math import inf
from typing import TYPE_CHECKING, Any

from multibot_rewrite.base.bounded import load_yaml, read_text
from multibot_rewrite.base.conventions import ROWS
from multibot_rewrite.base.file_kinds import BAG, refuse_others
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import InputError, Unusable
from multibot_rewrite.base.wording import SEVERAL, one_line, shorten
from multibot_rewrite.base.workers import limit_files, worker_pool
from multibot_rewrite.producers.bags.recording import RECORDER, RecordedTopic, Recording
from multibot_rewrite.producers.ros.assemble import TF_TYPES, numbers_of
from multibot_rewrite.producers.ros.headers import CLOCK_TYPE, JOINTED, pose_in
from multibot_rewrite.producers.ros.tf_subscriptions import Pace
from multibot_rewrite.producers.zenoh.cdr import (
    read_header_frame,
    read_joint_names,
    read_stamp,
    read_tf,
)
from multibot_rewrite.system.records import Caveat, Edge, Qos

if TYPE_CHECKING:
    from rosbags.interfaces import Connection
    from rosbags.rosbag2 import Reader

METADATA = "metadata.yaml"
_REINDEX = "is the recording complete? ros2 bag reindex may mend it"
# Of a topic with a header, and of tf: a robot that runs for an hour sends no new frames.
HEADERS, TRANSFORMS = 5, 50_000
# The first field of a type that has a header, in the definition that the bag holds.
_HEADER = re.compile(r"\s*(?:#[^\n]*\n\s*)*(?:std_msgs/(?:msg/)?)?Header\s+header\b")
# Where a bag holds no definitions.
_HEADED = {f"{of}/msg/{name}" for (of, *names), _ in ROWS["headed"] for name in names}
# What a file of a bag is unpacked to, at most: messages pack to a twentieth, images to less.
LEAST_UNPACKED, MOST_PACKED, _PART = 2**30, 40, 2**20
_NO_LIMIT_SECONDS = 9_223_372_036


def read_bag(path: str) -> Recording:
    """Return what a bag, a folder or a file .mcap or .db3, holds; raises InputError, Unusable."""
    from tempfile import TemporaryDirectory  # slow to import; few look at bags

    try:
        import rosbags.rosbag2  # noqa: F401
    except ImportError as error:
        hint = "pip install 'multibot_rewrite[bags]'"
        raise Unusable(f"a bag cannot be read: {error}; {hint}") from None
    files = [os.path.join(path, it) for it in os.listdir(path)] if os.path.isdir(path) else [path]
    if not all(os.path.isfile(it) or os.path.isdir(it) for it in files):  # a pipe has no end
        raise InputError(f"{path}: there is no such bag; name a folder, or a file .mcap or .db3")

    def lost(_: object, died_of: int) -> InputError:
        return InputError(f"{path}: the process that read it was ended by signal {died_of}")

    most = max(LEAST_UNPACKED, MOST_PACKED * max(map(os.path.getsize, files), default=0))
    # What it unpacks is in the folder, and so goes also where that process is killed.
    with (
        TemporaryDirectory() as folder,
        worker_pool(partial(_read_with_limits, folder, most), [path], lost, 1) as workers,
    ):
        found = next(workers.results())
    if isinstance(found, InputError):
        raise found
    return found


def _read_with_limits(folder: str, most: int, path: str) -> Recording | InputError:
    """Return what a bag holds, or why not, from a process with limits: little may unpack to much."""
    import tempfile

    from rosbags.rosbag2 import Reader

    tempfile.tempdir = folder
    try:
        # What the reader's own parser might not survive.
        metadata = os.path.join(path, METADATA)
        if not os.path.isdir(path):
            with open(path, "rb") as file:
                refuse_others(file.read(_PART), path, BAG)
        elif os.path.exists(metadata):
            load_yaml(read_text(metadata), metadata, _REINDEX)
        limit_files(most)
        with Reader(path) as reader:
            return _recording(reader)
    except InputError as error:
        return error
    except Exception as error:  # a damaged bag fails in sqlite3, zstandard, PyYAML or struct
        if isinstance(error, MemoryError) or getattr(error, "errno", 0) == errno.EFBIG:
            return InputError(f"{path}: it unpacks to more than a bag may hold; leave it out")
        reason = one_line(str(error) or type(error).__name__)[:200].rstrip(".")
    return InputError(f"{path}: not a readable bag: {reason}; {_REINDEX}")


def _recording(reader: Reader) -> Recording:
    every: Iterable[Connection] = reader.connections
    by_topic = lists_by_key((f"/{str(it.topic).removeprefix('/')}", it) for it in every)
    topics = tuple(_topic(reader, name, by_topic[name]) for name in sorted(by_topic))
    transforms: list[Edge] = []
    caveats: list[Caveat] = []
    for name, connections in sorted(by_topic.items()):
        if connections[0].msgtype == TF_TYPES[0]:
            found, unread = _transforms(reader, name, connections)
            transforms += found
            what = f"messages on {name} are no TFMessage, or more than {TRANSFORMS:,}"
            caveats += [Caveat("frames-not-read", True, f"{what}: not all were read")] * unread
    empty = [it.name for it in topics if not it.messages]
    if len(empty) == len(topics):
        text = (
            f"no message was recorded ({shorten(empty, SEVERAL)})" if empty else "it has no topics"
        )
        caveats.append(Caveat("empty-bag", True, text))
    return Recording(topics, tuple(transforms), max(0, reader.duration) / 1e9, tuple(caveats))


def _topic(reader: Reader, name: str, connections: list[Connection]) -> RecordedTopic:
    """Return a topic of a bag, with what its first messages say."""
    first = connections[0]
    count = sum(it.msgcount for it in connections)
    type_, frames, joints, back = str(first.msgtype), {}, {}, 0.0
    pose: tuple[float, ...] = ()
    text = first.msgdef.data
    has_header = bool(_HEADER.match(text)) if text else type_ in _HEADED
    if type_ in JOINTED:
        names = map(read_joint_names, _first_messages(reader, connections, HEADERS))
        joints = dict.fromkeys(it for it in names if it)
    elif count and has_header:
        read = list(_first_messages(reader, connections, HEADERS))
        found = map(read_header_frame, read)
        frames = dict.fromkeys(it for it in found if it is not None)
        pose = max((pose_in(type_, it) for it in read), key=lambda it: inf in it, default=())
    elif type_ == CLOCK_TYPE:
        pace = Pace()
        for data in _first_messages(reader, connections, TRANSFORMS):
            pace = pace.after(read_stamp(data) or 0.0)
        back = round(pace.back, 1)
    offered = (getattr(it.ext, "offered_qos_profiles", ()) for it in connections)
    qos = tuple(map(_qos, chain.from_iterable(offered)))
    return RecordedTopic(name, type_, count, qos, tuple(frames), tuple(joints), back, pose)


def _first_messages(reader: Reader, connections: list[Connection], many: int) -> Iterator[bytes]:
    return (bytes(data) for _, _, data in islice(reader.messages(connections), many))


def _transforms(
    reader: Reader, topic: str, connections: list[Connection]
) -> tuple[Collection[Edge], bool]:
    """Return the last transforms on a tf topic; and whether some could not be read."""
    found: dict[tuple[str, str], Edge] = {}
    paces: dict[tuple[str, str], Pace] = {}
    static, cut = topic.rpartition("/")[2] == "tf_static" or "/tf_static/" in topic, False
    for read, data in enumerate(_first_messages(reader, connections, TRANSFORMS + 1)):
        message = read_tf(data) if read < TRANSFORMS else None
        if cut := message is None:
            break
        for it in message.transforms:
            edge = (it.child_frame_id, it.header.frame_id)
            last = numbers_of(it.transform)
            found[edge] = Edge(*edge, topic, static, (RECORDER,), transform=last)
            paces[edge] = paces.get(edge, Pace()).after(it.header.stamp)
    rates = {key: 0.0 if static else pace.rate() for key, pace in paces.items()}
    return [it._replace(rate=rates[key]) for key, it in found.items()], cut


def _qos(given: Any) -> Qos:
    return Qos(
        given.history.name,
        int(given.depth),
        given.reliability.name,
        given.durability.name,
        _seconds(given.deadline),
        _seconds(given.lifespan),
        given.liveliness.name,
        _seconds(given.liveliness_lease_duration),
    )


def _seconds(given: Any) -> float:
    """Return the seconds of a duration of QoS; infinite for 0 and for what stands for no limit."""
    passed = given.sec + given.nsec / 1e9
    return inf if given.sec >= _NO_LIMIT_SECONDS or passed == 0 else passed
