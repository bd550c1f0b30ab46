# SPDX-License-Identifier: Apache-2.0
"""One message a sensor topic, for the frame that its header names; the function that subscribes is
passed in.

Images are large: of a message only the frame is kept, and its topic is left at once.
"""

from __future__ import annotations

import math
import time
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator

from multibot_rewrite.base.conventions import LISTENER
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.producers.zenoh.cdr import read_header_frame, read_stamp
from multibot_rewrite.system.records import PUBLISHES, TOPIC, Caveat, End, Heard

# Their headers name frames of tf; where there are too many topics the first ones matter most.
PACKAGES = (
    "sensor_msgs", "nav_msgs", "geometry_msgs", "stereo_msgs", "vision_msgs", "radar_msgs",
    "map_msgs", "nav2_msgs", "grid_map_msgs", "octomap_msgs", "visualization_msgs",
)  # fmt: skip
# But not these: joint_state_broadcaster, joy and teleop_twist_joy write words of their own there.
WITHOUT_FRAME = frozenset({
    "sensor_msgs/msg/JointState", "sensor_msgs/msg/MultiDOFJointState", "sensor_msgs/msg/Joy",
    "sensor_msgs/msg/TimeReference", "sensor_msgs/msg/BatteryState", "geometry_msgs/msg/TwistStamped",
    "geometry_msgs/msg/AccelStamped",
})  # fmt: skip
# A subscription costs a few milliseconds.
MOST_TOPICS = 200
# Of a topic with several publishers.
MOST_FRAMES = 8
# topic, type, latched, callback -> what ends the subscription; None for a type without a header first.
Subscribe = Callable[[str, str, bool, Callable[[bytes], None]], "Callable[[], None] | None"]


class SensorTopic(NamedTuple):
    """A topic whose messages name a frame; ``latched`` if all its publishers are transient local."""

    name: str
    type: str
    latched: bool
    publishers: int


def sensor_topics(endpoints: Iterable[End]) -> Iterator[SensorTopic]:
    """The topics worth a subscription, sensors first."""
    found: dict[str, list[End]] = defaultdict(list)
    for end in endpoints:
        if (end.kind, end.role) == (TOPIC, PUBLISHES) and _names_a_frame(end):
            found[end.name].append(end)
    for name, ends in sorted(found.items(), key=_rank):
        latched = all(it.qos and it.qos.durability == "TRANSIENT_LOCAL" for it in ends)
        yield SensorTopic(name, ends[0].type, latched, len(ends))


def _rank(topic: tuple[str, list[End]]) -> tuple[int, str]:
    name, ends = topic
    return PACKAGES.index(ends[0].type.partition("/")[0]), name


def _names_a_frame(end: End) -> bool:
    known = end.type.partition("/")[0] in PACKAGES and end.type not in WITHOUT_FRAME
    return known and "/_" not in end.name and LISTENER not in end.node


class HeaderSamples:
    """Subscriptions to sensor topics, each until its first message; what their headers name."""

    def __init__(self, subscribe: Subscribe) -> None:
        self._subscribe = subscribe
        self._asked: set[str] = set()
        self._open: dict[str, Callable[[], None]] = {}
        self._heard: dict[str, dict[str, float]] = defaultdict(dict)
        self._left_out = 0
        self._began = time.monotonic()

    def update(self, endpoints: Iterable[End]) -> None:
        """Subscribe to every sensor topic that was not there before."""
        new = [it for it in sensor_topics(endpoints) if it.name not in self._asked]
        room = max(0, MOST_TOPICS - len(self._asked))
        self._left_out = len(new[room:])
        for topic in new[:room]:
            self._asked.add(topic.name)
            self._add(topic)

    def _add(self, topic: SensorTopic) -> None:
        end = self._subscribe(
            topic.name, topic.type, topic.latched, lambda data: self._receive(topic, data)
        )
        if end:
            self._open[topic.name] = end
            self._began = time.monotonic()

    def _receive(self, topic: SensorTopic, data: bytes) -> None:
        frame = read_header_frame(data)
        if frame is not None:
            self._heard[topic.name][frame] = 0.0 if topic.latched else _age(read_stamp(data))
        if topic.publishers == 1 or len(self._heard[topic.name]) >= MOST_FRAMES:
            self._close(topic.name)

    def _close(self, topic: str) -> None:
        end = self._open.pop(topic, None)
        if end:
            end()

    def keep_waiting(self, seconds: float) -> bool:
        """Whether to wait for silent topics, until ``seconds`` after the last subscription."""
        silent = self._open.keys() - self._heard.keys()
        return bool(silent) and time.monotonic() - self._began < seconds

    def heard(self) -> tuple[Heard, ...]:
        """The frames by topic; several of a topic that several nodes publish."""
        heard = (Heard(topic, *it) for topic, own in self._heard.items() for it in own.items())
        return tuple(sorted(heard))

    def caveats(self) -> Iterator[Caveat]:
        """Where there were more topics than are listened to."""
        if self._left_out:
            text = f"frame_id was read of {MOST_TOPICS} topics, and not of {self._left_out} more"
            yield Caveat("headers-not-read", False, text)


def _age(stamp: float | None) -> float:
    """How old a message is by this machine's clock; what is less than a second is the network's."""
    if stamp is None:
        return 0.0
    age = round(time.time() - stamp, 1)
    return math.inf if not stamp else age if abs(age) >= 1.0 else 0.0
