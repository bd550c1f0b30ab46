# SPDX-License-Identifier: Apache-2.0
"""A few messages a sensor topic, for frame and rate, and descriptions; by a function passed in.

Images are large: of a message only the frame is kept, and their topic is left at once."""

import math
import time
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Set
from functools import partial
from typing import NamedTuple

from multibot_rewrite.base.conventions import CLOCK, LISTENER
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.producers.ros.assemble import age_of, numbers_of
from multibot_rewrite.producers.ros.tf_subscriptions import Mark, Pace
from multibot_rewrite.producers.zenoh.cdr import (
    read_child_frame,
    read_header_frame,
    read_joint_names,
    read_pose,
    read_stamp,
    read_text,
)
from multibot_rewrite.system.records import PUBLISHES, TOPIC, Caveat, Description, End, Heard
from multibot_rewrite.system.words import is_description, is_of_a_body

# Their headers name frames of tf; where there are too many topics the first ones matter most.
PACKAGES = (
    "sensor_msgs", "nav_msgs", "geometry_msgs", "stereo_msgs", "vision_msgs", "radar_msgs",
    "map_msgs", "nav2_msgs", "grid_map_msgs", "octomap_msgs", "visualization_msgs", "trajectory_msgs",
)  # fmt: skip
# But not these: joint_state_broadcaster, joy and teleop_twist_joy write words of their own there.
WITHOUT_FRAME = frozenset({
    "sensor_msgs/msg/JointState", "sensor_msgs/msg/MultiDOFJointState", "sensor_msgs/msg/Joy",
    "sensor_msgs/msg/TimeReference", "sensor_msgs/msg/BatteryState", "geometry_msgs/msg/TwistStamped",
    "geometry_msgs/msg/AccelStamped",
})  # fmt: skip
# These name joints: of a robot, and of whom a planner sends there.
JOINTED = frozenset({
    "sensor_msgs/msg/JointState", "sensor_msgs/msg/MultiDOFJointState",
    "trajectory_msgs/msg/JointTrajectory",
})  # fmt: skip
CLOCK_TYPE = "rosgraph_msgs/msg/Clock"
# A subscription costs a few milliseconds.
MOST_TOPICS = 200
# Of a topic with several publishers.
MOST_FRAMES = 8
# Of these one message is enough.
LARGE = frozenset({
    "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/PointCloud2",
    "nav_msgs/msg/OccupancyGrid", "stereo_msgs/msg/DisparityImage",
})  # fmt: skip
# A rate is that of so many seconds at least, so that 2 Hz are known, and of no more messages.
RATE_SECONDS, MOST_MESSAGES = 0.4, 100
# One message in so many seconds says that more do not come.
ONE_SECONDS = 2.0
# So much longer a laser, an IMU or odometry is waited for: that it is silent is an error.
BODY_FACTOR = 2
ODOMETRY = "nav_msgs/msg/Odometry"
# The texts before their pose: frames.
POSED = {
    ODOMETRY: 2,
    "geometry_msgs/msg/PoseStamped": 1,
    "geometry_msgs/msg/PoseWithCovarianceStamped": 1,
}
# topic, type, latched, callback -> what ends the subscription; None for a type without a header first.
Receive = Callable[[bytes, Mark], None]
Subscribe = Callable[[str, str, bool, Receive], "Callable[[], None] | None"]


class SensorTopic(NamedTuple):
    """A topic whose messages name a frame; ``latched`` if all its publishers are transient local."""

    name: str
    type: str
    latched: bool
    publishers: int

    @property
    def has_rate(self) -> bool:
        """Return whether a topic's rate is worth several messages: small ones of one publisher."""
        return (
            self.type != CLOCK_TYPE
            and self.publishers == 1
            and not self.latched
            and self.type not in LARGE
        )


class _Span(NamedTuple):
    """The numbers and stamps of the first message of a topic and of the last."""

    first: int
    began: float
    last: int
    ended: float
    messages: int

    def rate(self) -> float:
        """Return messages a second by their numbers, so that a missed one counts; 0 if unknown."""
        seconds = self.ended - self.began
        known = seconds >= RATE_SECONDS and self.last > self.first
        return round((self.last - self.first) / seconds, 1) if known else 0.0


def sensor_topics(endpoints: Iterable[End]) -> Iterator[SensorTopic]:
    """Yield the topics worth a subscription, sensors first."""
    sent = (it for it in endpoints if (it.kind, it.role) == (TOPIC, PUBLISHES))
    # The clock of all: its time is where others have their stamp.
    clock = CLOCK, CLOCK_TYPE
    found = lists_by_key(
        (it.name, it) for it in sent if _names_a_frame(it) or (it.name, it.type) == clock
    )
    for name, ends in sorted(found.items(), key=_rank):
        latched = all(it.qos and it.qos.durability == "TRANSIENT_LOCAL" for it in ends)
        yield SensorTopic(name, ends[0].type, latched, len(ends))


def _rank(topic: tuple[str, list[End]]) -> tuple[int, str]:
    """Return the key by which topics are sorted: sensors first."""
    name, ends = topic
    package = ends[0].type.partition("/")[0]
    return PACKAGES.index(package) if package in PACKAGES else -1, name


def _names_a_frame(end: End) -> bool:
    other = end.type not in WITHOUT_FRAME or end.type in JOINTED
    known = end.type.partition("/")[0] in PACKAGES and other
    return known and "/_" not in end.name and LISTENER not in end.node


def pose_in(type_: str, data: bytes) -> tuple[float, ...]:
    """Return the pose in a message of this type, as a snapshot keeps a transform; or empty."""
    found = read_pose(data, POSED[type_]) if type_ in POSED else None
    return numbers_of(found) if found else ()


class HeaderSamples:
    """Subscriptions to sensor topics, each until its frame and its rate are known."""

    def __init__(self, subscribe: Subscribe) -> None:
        self._subscribe = subscribe
        self._asked: set[str] = set()
        self.open: dict[str, Callable[[], None]] = {}
        self._heard: dict[str, dict[tuple[str, ...], Heard]] = defaultdict(dict)
        self._clock: Pace | None = None
        self._spans: dict[str, _Span] = {}
        self._since: dict[str, float] = {}
        self._bodies: set[str] = set()
        self._left_out = 0
        self._began = time.monotonic()

    def update(self, endpoints: Iterable[End]) -> None:
        """Subscribe to every sensor topic that was not there before."""
        new = [it for it in sensor_topics(endpoints) if it.name not in self._asked]
        room = max(0, MOST_TOPICS - len(self._asked))
        self._left_out = len(new[room:])
        for topic in new[:room]:
            self._asked.add(topic.name)
            receive = partial(self._receive, topic)
            if end := self._subscribe(topic.name, topic.type, topic.latched, receive):
                self.open[topic.name] = end
                self._bodies.update([topic.name] if is_of_a_body(topic.type) else [])
                self._began = self._since[topic.name] = time.monotonic()

    def _receive(self, topic: SensorTopic, data: bytes, mark: Mark = None) -> None:
        if topic.type == CLOCK_TYPE:
            self._clock = (self._clock or Pace()).after(read_stamp(data) or 0.0)
            return
        joints = read_joint_names(data) if topic.type in JOINTED else ()
        # What is there in place of a frame is a word of its sender's own.
        frame = "" if topic.type in JOINTED else read_header_frame(data)
        own = self._heard[topic.name]
        said = (frame or "", *joints)
        pose = pose_in(topic.type, data)
        if frame is not None and (said not in own or math.inf in pose):
            age = 0.0 if topic.latched else age_of(read_stamp(data))
            child = read_child_frame(data) if topic.type == ODOMETRY else ""
            told = Heard(topic.name, frame, age, child=child or "", joints=joints, pose=pose)
            own[said] = told
        more = topic.has_rate and self._spanned(topic, data, mark)
        done = not more and (topic.publishers == 1 or len(own) >= MOST_FRAMES)
        if done and (end := self.open.pop(topic.name, None)):
            end()

    def _spanned(self, topic: SensorTopic, data: bytes, mark: Mark) -> bool:
        """Count a message, and return whether more are wanted for a rate."""
        stamp = read_stamp(data)
        if not stamp or not isinstance(mark, int):
            return False
        span = self._spans.get(topic.name, _Span(mark, stamp, mark, stamp, 0))
        span = span._replace(last=mark, ended=stamp, messages=span.messages + 1)
        self._spans[topic.name] = span
        return not span.rate() and span.messages < MOST_MESSAGES

    def keep_waiting(self, seconds: float) -> bool:
        """Return whether to wait for silent topics or second messages, up to ``seconds``."""
        now, silent = time.monotonic(), self.silent()
        longer = seconds * (BODY_FACTOR if silent & self._bodies else 1)
        if silent and now - self._began < longer:
            return True
        once = (it for it in self.open if it in self._spans and self._spans[it].messages == 1)
        return any(now - self._since[it] < ONE_SECONDS for it in once)

    def silent(self) -> Set[str]:
        """Return the topics on which nothing has come."""
        runs = {CLOCK} if self._clock and self._clock.between else set()
        return self.open.keys() - self._heard.keys() - runs

    def heard(self) -> tuple[Heard, ...]:
        """Return what was heard by topic; several for a topic that several nodes publish."""
        now = time.monotonic()
        rates = {it: own.rate() or self._at_most(it, now) for it, own in self._spans.items()}
        heard = [it for own in self._heard.values() for it in own.values()]
        told = [it._replace(rate=rates.get(it.topic, 0.0)) for it in heard]
        if CLOCK in self.open:
            clock = self._clock or Pace()
            stands = not (clock.between or clock.back)
            told.append(Heard(CLOCK, "", math.inf if stands else 0.0, back=round(clock.back, 1)))
        return tuple(sorted(told))

    def _at_most(self, topic: str, now: float) -> float:
        """Return the highest possible rate after one message in some seconds; 0 if unknown."""
        waited = now - self._since.get(topic, now)
        once = self._spans[topic].messages == 1
        return round(1 / waited, 1) if once and waited >= ONE_SECONDS else 0.0

    def caveats(self) -> Iterator[Caveat]:
        """Yield a limitation if there were more topics than are listened to."""
        if self._left_out:
            text = f"frame_id was read of {MOST_TOPICS} topics, and not of {self._left_out} more"
            yield Caveat("headers-not-read", False, text)


class DescriptionSamples:
    """Subscriptions to the topics of descriptions, each until one has come."""

    def __init__(self, subscribe: Subscribe) -> None:
        self._subscribe = subscribe
        self.open: dict[str, Callable[[], None]] = {}
        self._asked: set[str] = set()
        self._found: dict[str, Description] = {}

    def update(self, endpoints: Iterable[End]) -> None:
        """Subscribe to every such topic that was not there before, as its publisher offers it."""
        for it in endpoints:
            sent = (it.kind, it.role) == (TOPIC, PUBLISHES) and is_description(it.name, it.type)
            if sent and it.name not in self._asked and len(self._asked) < MOST_TOPICS:
                self._asked.add(it.name)
                # What nobody reads was not asked for its QoS: nearly all are latched.
                latched = not (it.qos and it.qos.durability == "VOLATILE")
                end = self._subscribe(it.name, it.type, latched, partial(self._receive, it.name))
                if end:
                    self.open[it.name] = end

    def _receive(self, topic: str, data: bytes, _: Mark = None) -> None:
        text = read_text(data)
        if text is not None:
            self._found[topic] = described(topic, text)
            self.open.pop(topic)()

    def found(self) -> tuple[Description, ...]:
        """Return the descriptions that have come, by topic."""
        return tuple(self._found[it] for it in sorted(self._found))


def described(topic: str, text: str) -> Description:
    """Return the links and moving joints of a URDF; neither for another text."""
    from lxml import etree  # takes longer than the rest of a look's start

    parser = etree.XMLParser(resolve_entities=False, no_network=True)
    try:
        root = etree.fromstring(text.encode(), parser)
    except (etree.XMLSyntaxError, ValueError):
        return Description(topic)
    links = tuple(it.get("name", "") for it in root.iterfind("link"))
    moving = (it for it in root.iterfind("joint") if it.get("type") != "fixed")
    return Description(topic, links, tuple(it.get("name", "") for it in moving))
