"""What is wrong with the names and keys of a MoveIt file."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

import yaml

from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.moveit.controller_manager import unreachable_managers
from multibot_rewrite.companions.moveit.name_sites import MoveitName, MoveitNames
from multibot_rewrite.companions.names.by_kind import expressible, is_plain
from multibot_rewrite.companions.names.undeclared import (
    holds_a_name,
    is_undeclared,
    renamed_names,
    undeclared_message,
)
from multibot_rewrite.companions.yaml_text import YamlText, found_at, is_text
from multibot_rewrite.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.findings.rule import Rule, declare
from multibot_rewrite.rosnames import check_topic_name

GRAPH_WORDS = ("topic", "service")
_CLOSED = ("joint", "link", "frame", "group")
# Fewer names are mistakes in a file that is meant for the robot.
_FEWEST = 3
_EVALUATOR = re.compile(r"\s*(joint|link)s?\s*\(([^()]*)\)\s*")
# The rule, the message and the hint.
_Problem = tuple[Rule, str, str]


def file_findings(document: YamlText, context: Context, sites: MoveitNames) -> tuple[Finding, ...]:
    """The findings about a file, each once, in the order of the lines."""
    found = [
        *_repeated(document, sites.twice),
        *unreachable_managers(document, context, sites.names),
        *_name_findings(document, context, sites.names),
        *_mentions(document, context, sites.unclaimed),
    ]
    return tuple(sorted(dict.fromkeys(found), key=lambda it: (it.line, it.column)))


REPEATED_KEY = declare(
    "MF303",
    "moveit-repeated-key",
    WARNING,
    what="A key is set twice in one map.",
    why="PyYAML, with which MoveItConfigsBuilder reads the file, keeps only the last value and "
    "says nothing.",
    fix="Remove one of them.",
    bad="""\
joint_limits:
  wheel_joint: {max_velocity: 1.0}
  wheel_joint: {max_velocity: 2.0}
""",
    good="""\
joint_limits:
  wheel_joint: {max_velocity: 1.0}
  lidar_joint: {max_velocity: 2.0}
""",
    line=3,
    formats=("moveit",),
)


def _repeated(document: YamlText, keys: Iterable[yaml.ScalarNode]) -> Iterator[Finding]:
    for key in keys:
        message = f"{key.value!r} is set twice; PyYAML keeps only the last value"
        yield found_at(document, key, REPEATED_KEY, message, "remove one of them")


def _name_findings(
    document: YamlText, context: Context, sites: Iterable[MoveitName]
) -> Iterator[Finding]:
    """What is wrong with each name, at its first place."""
    first: dict[tuple[str, str], MoveitName] = {}
    for site in sites:
        for name in _named(site):
            first.setdefault(name, site)
    closed = [name for name in first if name[0] in _CLOSED]
    missing = [name for name in closed if is_undeclared(context, *name)]
    if len(missing) >= _FEWEST and 2 * len(missing) > len(closed):
        yield _of_another(document, context, first[missing[0]], missing, len(closed))
        first = {name: site for name, site in first.items() if name not in missing}
    for (word, text), site in first.items():
        problems = (check(context, word, text) for check in _CHECKS)
        if problem := next(filter(None, problems), None):
            yield found_at(document, site.scalar, *problem)


def _named(site: MoveitName) -> Iterator[tuple[str, str]]:
    """The names that the description must declare."""
    found = _EVALUATOR.fullmatch(site.text) if site.word == "words" else None
    if found:
        yield from ((found[1], word.strip()) for word in found[2].split(","))
    else:
        yield site.word, site.text


UNDECLARED = declare(
    "MF301",
    "moveit-undeclared-name",
    WARNING,
    what="A joint, link, frame or group is neither in the URDF nor in the SRDF.",
    why="It stays unchanged, and nothing has that name: move_group does not use the limits of "
    "such a joint or the solver of such a group, and sends no trajectory to a controller of such "
    "joints.",
    fix="Correct the name; the hint has the nearest one.",
    bad="""\
joint_limits:
  whel_joint: {max_velocity: 1.0}
""",
    good="""\
joint_limits:
  wheel_joint: {max_velocity: 1.0}
""",
    line=2,
    formats=("moveit",),
)


def _undeclared(context: Context, word: str, text: str) -> _Problem | None:
    if word in _CLOSED and is_undeclared(context, word, text):
        return UNDECLARED, *undeclared_message(context, word, text)
    return None


OF_ANOTHER = declare(
    "MF309",
    "moveit-file-of-another-robot",
    ERROR,
    what="Most joints, links, frames and groups that a file names are not in the description.",
    why="move_group takes no limits, solvers or controllers from such a file: trajectories have the "
    "limits of the URDF, groups have no inverse kinematics, and execution fails.",
    fix="Name the file of this robot, or give its xacro the arguments that the file was written for.",
    bad="""\
joint_limits:
  left_wheel_joint: {max_velocity: 1.0}
  left_lidar_joint: {max_velocity: 1.0}
  left_arm_joint: {max_velocity: 1.0}
""",
    good="""\
joint_limits:
  wheel_joint: {max_velocity: 1.0}
""",
    line=2,
    formats=("moveit",),
)


def _of_another(
    document: YamlText,
    context: Context,
    site: MoveitName,
    missing: list[tuple[str, str]],
    count: int,
) -> Finding:
    message = f"{len(missing)} of the {count} names in this file are not in the description: "
    message += ", ".join(text for _, text in missing[:2]) + " and others"
    _, hint = undeclared_message(context, *missing[0])
    return found_at(document, site.scalar, OF_ANOTHER, message, hint)


SUBSTITUTION_KEPT = declare(
    "MF304",
    "moveit-substitution-kept",
    WARNING,
    what="A name has a substitution such as $(arg prefix) or ${prefix} in it, so it stays "
    "unchanged.",
    why="A launch file or xacro replaces it later. The result is a name of the robot only if that "
    "adds the same prefix or postfix as the fleet.",
    fix="Make sure that it results in the robot's own name, or write the name without a "
    "substitution.",
    bad="""\
joint_limits:
  $(arg prefix)wheel_joint: {max_velocity: 1.0}
""",
    good="""\
joint_limits:
  wheel_joint: {max_velocity: 1.0}
""",
    line=2,
    formats=("moveit",),
)


def _substitution(context: Context, word: str, text: str) -> _Problem | None:
    if not text or is_plain(text) or not _matters(context, word):
        return None
    message = f"{word} {text!r} holds a substitution and stays unchanged"
    return SUBSTITUTION_KEPT, message, "make sure that it results in the robot's own name"


def _matters(context: Context, word: str) -> bool:
    """Would a name of this kind be renamed for a robot?"""
    if word in _CLOSED:
        return word in context.names.naming.separators
    return word in GRAPH_WORDS or word == "controller"


GROUPS_WITHOUT_SRDF = declare(
    "MF305",
    "moveit-groups-without-srdf",
    WARNING,
    what="The fleet renames planning groups (groups: rename), but no SRDF is given.",
    why="Only the SRDF says which names are groups, so the groups in this file stay unchanged. "
    "move_group gets an SRDF with other groups from elsewhere and finds no solver or planner for "
    "them.",
    fix="Name the SRDF under srdf: in the fleet file.",
    bad="""\
groups: rename
companions: {moveit: kinematics.yaml}
""",
    good="""\
groups: rename
srdf: robot.srdf
companions: {moveit: kinematics.yaml}
""",
    formats=("fleet",),
    beside={
        "kinematics.yaml": "arm: {kinematics_solver: kdl_kinematics_plugin/KDLKinematicsPlugin}\n",
        "robot.srdf": '<robot name="rover"><group name="arm"><link name="wheel"/></group></robot>',
    },
)


def _no_srdf(context: Context, word: str, text: str) -> _Problem | None:
    renamed = word == "group" and "group" in context.names.naming.separators
    if not renamed or context.names.declared.get("group"):
        return None
    message = f"groups are renamed, but no SRDF is given, so {text!r} stays unchanged"
    return GROUPS_WITHOUT_SRDF, message, "name the SRDF under srdf:"


PREFIX_ONLY = declare(
    "MF306",
    "moveit-prefix-only",
    WARNING,
    what="The link_prefix of an IKFast solver can only add a prefix, but the fleet uses a postfix.",
    why="IKFast puts link_prefix in front of the link names that it was generated with. It cannot "
    "make base_link_robot1, so the solver does not find the links of the robot.",
    fix="Write affix: prefix in the fleet file, or take a solver that reads its links from the "
    "SRDF.",
    bad="""\
arm:
  kinematics_solver: my_arm_ikfast/IKFastKinematicsPlugin
  link_prefix: ""
""",
    good="""\
arm:
  kinematics_solver: kdl_kinematics_plugin/KDLKinematicsPlugin
""",
    line=3,
    formats=("moveit",),
    options={"affix": "postfix"},
)


def _prefix_only(context: Context, word: str, text: str) -> _Problem | None:
    if expressible(context, word):
        return None
    message = f"{word} can only add a prefix, but the fleet uses a postfix"
    return PREFIX_ONLY, message, "set affix: prefix"


TOPIC_INVALID = declare(
    "MF307",
    "moveit-topic-invalid",
    WARNING,
    what="The value of a topic or service is not a valid ROS name.",
    why="It stays unchanged. The node that reads it fails when it creates the subscription or "
    "client.",
    fix="Correct the name: letters, digits, _ and /, and no digit at the start of a part.",
    bad="""\
sensors: [lidar]
lidar:
  sensor_plugin: occupancy_map_monitor/PointCloudOctomapUpdater
  point_cloud_topic: 3d/points
""",
    good="""\
sensors: [lidar]
lidar:
  sensor_plugin: occupancy_map_monitor/PointCloudOctomapUpdater
  point_cloud_topic: lidar/points
""",
    line=4,
    formats=("moveit",),
)


def _invalid_topic(context: Context, word: str, text: str) -> _Problem | None:
    fault = check_topic_name(text) if word in GRAPH_WORDS and is_plain(text) else None
    if fault is None:
        return None
    message = f"{text!r} is not a valid {word} name: {fault.reason}"
    return TOPIC_INVALID, message, "it stays unchanged; correct it"


# Only the first problem of a name is reported.
_CHECKS = (_undeclared, _substitution, _no_srdf, _prefix_only, _invalid_topic)

UNKNOWN_USE = declare(
    "MF302",
    "moveit-name-at-unknown-key",
    WARNING,
    what="A name of the robot or an absolute ROS name is at a key whose use is not known.",
    why="It stays unchanged. If the plugin that reads it looks for a link, joint or topic, it "
    "finds that of no robot, or all robots use the same one.",
    fix="If each robot needs its own, rename it by hand in the files of the robots.",
    bad="""\
arm:
  kinematics_solver: my_solver/Plugin
  tool_frame: lidar_link
""",
    good="""\
arm:
  kinematics_solver: my_solver/Plugin
  tip_link: lidar_link
""",
    line=3,
    formats=("moveit",),
)


def _mentions(
    document: YamlText, context: Context, unclaimed: Iterable[yaml.ScalarNode]
) -> Iterator[Finding]:
    names = renamed_names(context)
    for scalar in unclaimed:
        text = str(scalar.value)
        if is_text(scalar) and holds_a_name(text, names):
            message = f"{text!r} is a name of the robot, but its use here is not known"
            hint = "it stays unchanged; if each robot needs its own, rename it by hand"
            yield found_at(document, scalar, UNKNOWN_USE, message, hint)
