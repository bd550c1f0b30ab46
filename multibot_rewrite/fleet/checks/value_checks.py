"""Checks of one value in a written file: another robot's name, a doubled prefix, a wrong tf topic."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise

from multibot_rewrite.base.conventions import USUAL_FRAMES
from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.base.naming import TF_TOPICS, Naming
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.names.rename_map import spell
from multibot_rewrite.fleet.checks.doubled_names import doubled
from multibot_rewrite.fleet.outputs.output_values import OutputValue
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot

TF = tuple(f"/{it}" for it in TF_TOPICS)
# Parameters and properties that make nodes put a prefix before frames.
PREFIXES = frozenset({"frame_prefix", "tf_prefix", "TF Prefix"})
ENABLES = "tf_frame_prefix_enable"
# Only where such letters begin, or a line of dashes would be looked at from each of them.
TOKEN = re.compile(r"(?<![A-Za-z0-9_~/.-])[A-Za-z0-9_~/.-]*[A-Za-z0-9_]")
# Keys that name one frame.
_FRAME_KEY = re.compile(r"(?:^|_)(?:frame|frame_id|link)$")
_TOPIC_KEY = re.compile(r"(?:^|_)(?:topic|service)(?:_name)?$", re.IGNORECASE)
_BETWEEN = "/_-."
# Values that are not names, such as URLs, substitutions and paths.
_NOT_A_NAME = re.compile(
    r"://|\$\(|\$\{|\.(?:yaml|rviz|urdf|xml|stl|dae|obj|world|sdf|pgm|png|so)\b"
)


class RobotNames(NamedTuple):
    """The names of one robot: ``words`` stand for the robot itself; ``right`` are its correct names,
    without a leading slash; ``bare`` maps names of its sources to what they may become."""

    robot: RewrittenRobot
    words: tuple[str, ...]
    right: frozenset[str]
    bare: Mapping[str, frozenset[str]]


class ValueInFile(NamedTuple):
    """A value of a robot's file, the robot's names, and the words of the other robots.

    ``before_names`` is true for what the node puts before names of the description as they are."""

    own: RobotNames
    others: Mapping[str, str]
    naming: Naming
    value: OutputValue
    before_names: bool = False


Check = Callable[[ValueInFile], Iterator[Finding]]


def check_value(place: ValueInFile) -> Iterator[Finding]:
    """Everything that is wrong with one value; the findings are without a place."""
    if _NOT_A_NAME.search(place.value.text):
        return
    for check in _CHECKS:
        yield from check(place)


def _tokens(place: ValueInFile) -> Iterator[str]:
    """Words of a value that may be names and are not correct names of the robot."""
    for token in TOKEN.findall(place.value.text):
        if token.strip("/") not in place.own.right:
            yield token


OTHER_ROBOT = declare(
    "MF602",
    "name-of-other-robot",
    ERROR,
    what="A file that is written for one robot holds a name of another robot.",
    why="The robot uses data of the other one, or drives it.",
    fix="Remove the robot name from the source. The build adds it for each robot.",
    bad="""\
acme_driver:
  ros__parameters:
    source: /model/robot2/scan
""",
    good="""\
acme_driver:
  ros__parameters:
    source: /model/rover/scan
""",
    line=3,
    formats=("params",),
)


def _of_another_robot(place: ValueInFile) -> Iterator[Finding]:
    name = place.own.robot.spec.name
    for token in _tokens(place):
        robot = _other_robot(token.strip("/"), place)
        if robot:
            message = f"{token} belongs to robot {robot}, but this is a file of robot {name}"
            hint = "remove the robot name from the source; the build adds it for each robot"
            yield OTHER_ROBOT.finding(message, hint)


def _other_robot(token: str, place: ValueInFile) -> str:
    """Another robot whose word a name begins or ends with; empty for none."""
    words = token.split("/")
    ends = ["/".join(words[:at]) for at in range(1, len(words))]
    ends += ["/".join(words[at:]) for at in range(1, len(words))]
    ends += [word for before, word in pairwise(words) if before == "model"]
    for separator in ("_", "/"):
        head, found, name = token.partition(separator)
        ends += [head] if found and name in place.own.bare else []
        name, found, tail = token.rpartition(separator)
        ends += [tail] if found and name in place.own.bare else []
    return next((place.others[it] for it in ends if it in place.others), "")


ROBOT_TWICE = declare(
    "MF603",
    "robot-twice-in-value",
    ERROR,
    what="A name holds its robot twice, as in robot1/robot1/scan, or a parameter makes a node add the "
    "prefix to frames that have it.",
    why="No other node uses that name: topics have no publisher, and every lookup of the frame fails.",
    fix="Remove the robot name from the source. Write an empty frame_prefix or tf_prefix, and false at "
    "tf_frame_prefix_enable.",
    bad="""\
acme_driver:
  ros__parameters:
    tf_prefix: robot1
""",
    good="""\
acme_driver:
  ros__parameters:
    tf_prefix: ""
""",
    line=3,
    formats=("params",),
)


def _doubled(place: ValueInFile) -> Iterator[Finding]:
    for token in _tokens(place):
        word = doubled(token, place.own.words, place.own.right, place.own.bare)
        if word:
            yield holds_twice(token, word)


def holds_twice(token: str, word: str) -> Finding:
    """A name that holds a robot's word twice; without a place."""
    hint = "remove it from the source; the build adds it once"
    return ROBOT_TWICE.finding(f"{token} holds {word} twice", hint)


def _prefix_at_run_time(place: ValueInFile) -> Iterator[Finding]:
    """A parameter that makes a node add the prefix a second time."""
    key, text = place.value.key, place.value.text.strip()
    if not place.naming.layout.frames or place.value.is_key or place.before_names:
        return
    tag, run_time = place.own.robot.spec.tag, place.naming.layout.at_run_time
    right = {"", "~", "null", "/", *((tag, f"{tag}/") if run_time else ())}
    prefix = key in PREFIXES and text not in right
    if prefix or (key == ENABLES and text.lower() == "true"):
        message = f"{key}: {text} adds a prefix to frames that already have the robot's name"
        yield ROBOT_TWICE.finding(message, 'write ""' if key in PREFIXES else "write false")


OTHER_SEPARATOR = declare(
    "MF604",
    "other-separator",
    WARNING,
    what="A name holds the robot with another separator than that of the layout, as in robot1_odom.",
    why="It is not the name that other nodes and descriptions use, so the two do not find each other.",
    fix="Remove the robot name from the source. The build adds it with its separator.",
    bad="""\
acme_driver:
  ros__parameters:
    odom: robot1_odom
""",
    good="""\
acme_driver:
  ros__parameters:
    odom: odom
""",
    line=3,
    formats=("params",),
)


def _wrong_separator(place: ValueInFile) -> Iterator[Finding]:
    word, bare = place.own.robot.spec.tag, place.own.bare
    for token in (it for it in _tokens(place) if not it.startswith("/")):
        for rest in _without(token, word):
            name = rest.strip(_BETWEEN)
            right = bare.get(name, frozenset())
            if (
                right
                and not _is_a_new_frame(place, token, name)
                and not _is_its_topic(place, token, name)
            ):
                message = f"{token} should be {' or '.join(sorted(right))}"
                hint = "remove the robot name from the source; the build adds it"
                yield OTHER_SEPARATOR.finding(message, hint)
                break


def _without(token: str, word: str) -> Iterator[str]:
    if token.startswith(word):
        yield token[len(word) :].lstrip(_BETWEEN)
    if token.endswith(word):
        yield token[: -len(word)].rstrip(_BETWEEN)


def _is_a_new_frame(place: ValueInFile, token: str, name: str) -> bool:
    """Is it named as the robot's frames are, but not declared? Another node may publish it."""
    names = place.own.robot.names
    if name in USUAL_FRAMES or any(name in names.declared.get(it, ()) for it in ("link", "frame")):
        return False
    return spell(names._replace(robot=place.own.robot.spec.tag), "frame", name) == token


def _is_its_topic(place: ValueInFile, token: str, name: str) -> bool:
    """Is it a topic of this robot, that is called as one of its sensors, links or joints?"""
    if not _TOPIC_KEY.search(place.value.key):
        return False
    names = place.own.robot.names._replace(robot=place.own.robot.spec.namespace)
    return spell(names, "topic", name, namespaced=False) == token


BARE_FRAME = declare(
    "MF605",
    "frame-without-robot",
    WARNING,
    what="A key for frames holds a frame of the robot without the robot's name, for example in a "
    "plugin that is not known.",
    why="The other nodes of the robot use the frame with its name, so the two are not connected. All "
    "robots share the bare frame.",
    fix="If it is a frame of the robot, write what the hint says, or describe the plugin in a "
    "vocabulary file, so that it is renamed for each robot.",
    bad="""\
<robot name="rover">
  <link name="base_link"/>
  <gazebo>
    <plugin name="acme_drive" filename="libacme_drive.so">
      <odom_frame>odom</odom_frame>
    </plugin>
  </gazebo>
</robot>
""",
    good="""\
<robot name="rover">
  <link name="base_link"/>
  <gazebo>
    <plugin name="gz::sim::systems::DiffDrive" filename="gz-sim-diff-drive-system">
      <frame_id>odom</frame_id>
    </plugin>
  </gazebo>
</robot>
""",
    line=5,
    formats=("fleet-urdf",),
)


def _bare_frame(place: ValueInFile) -> Iterator[Finding]:
    text, key = place.value.text, place.value.key
    if place.value.is_key or place.before_names or not _FRAME_KEY.search(key.rpartition(".")[2]):
        return
    if text in place.own.bare and text not in place.own.right:
        right = " or ".join(sorted(place.own.bare[text]))
        message = f"{key} is {text}, without the robot's name that other frames have"
        yield BARE_FRAME.finding(message, f"if it is a frame of the robot, write {right}")


WRONG_TF_TOPIC = declare(
    "MF606",
    "tf-topic-of-other-layout",
    WARNING,
    what="A value is /tf although each robot of the layout has its own tf topic, or a robot's tf topic "
    "although all share /tf.",
    why="The node listens to a topic that nobody publishes, or publishes where nobody listens.",
    fix="Write the topic that the hint names, or choose another layout.",
    bad="""\
acme_driver:
  ros__parameters:
    transforms: /robot1/tf
""",
    good="""\
acme_driver:
  ros__parameters:
    transforms: /tf
""",
    line=3,
    formats=("params",),
)


def _tf_topic(place: ValueInFile) -> Iterator[Finding]:
    value, naming = place.value, place.naming
    if value.is_key or value.key.startswith("gz_"):
        return
    namespace = place.own.robot.spec.namespace
    own = {f"/{namespace}{it}" for it in TF} | {f"{it}/{namespace}" for it in TF}
    if naming.layout.tf_per_robot and value.text in TF:
        message = f"{value.text} is shared by all robots, but in this layout each robot has its own"
        hint = f"write {value.text[1:]}, or choose layout frames-per-robot"
        yield WRONG_TF_TOPIC.finding(message, hint)
    if not naming.layout.tf_per_robot and value.text in own:
        message = f"{value.text} is for one robot, but in this layout all robots share /tf"
        yield WRONG_TF_TOPIC.finding(message, "write /tf, or choose layout both")


_CHECKS: tuple[Check, ...] = (
    _of_another_robot,
    _doubled,
    _prefix_at_run_time,
    _wrong_separator,
    _bare_frame,
    _tf_topic,
)
