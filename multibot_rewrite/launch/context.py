# SPDX-License-Identifier: Apache-2.0
"""What actions and substitutions ask while a launch runs: its fleets, robots and files.

A launch keeps each fleet and a folder for files that goes at its end. A robot or fleet that is not
given is that of the enclosing group. It is among the locals of the context: launch keeps these for
timers, and here for event handlers (launch jazzy launch_service.py, timer_action.py)."""

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from tempfile import TemporaryDirectory
from types import MappingProxyType
from typing import Any, NamedTuple

from multibot_rewrite.base.findings.finding import NOTE, Finding
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.nearest import unknown
from multibot_rewrite.fleet.file.robot_spec import Pose
from multibot_rewrite.fleet.robots.loaded_robot import LoadedRobot
from multibot_rewrite.library.loaded_fleet import LoadedFleet, load_fleet
from multibot_rewrite.producers.ends import BRIDGE_FILE
from multibot_rewrite.producers.launch.door import of_launch, of_launch_ros

# launch's SomeSubstitutionsType: a string, a substitution, or several of both.
Text = Any
Action = Any
Context = Any
Substitution = Any
# Launch configurations: fleet and robot of a group; may xacro files do anything ("true")? the release.
FLEET, ROBOT, TRUST, DISTRO = (f"multibot_{it}" for it in ("fleet", "robot", "trust", "distro"))
# The robots in place of those of the file, as a text with poses, or the number of those of a pattern.
ROBOTS, COUNT = "multibot_robots", "multibot_count"
# What a launch keeps: its fleets by path, its folder, the warnings that it has logged.
_FLEETS, _FOLDER, _LOGGED = "multibot_fleets", "multibot_folder", "multibot_logged"
_CARRIED = "multibot_carried"

# The launch argument that most launch files have.
SIM_TIME = "use_sim_time"
_TRUTH = MappingProxyType({"true": True, "1": True, "false": False, "0": False})


class RobotRef(NamedTuple):
    """A robot of a fleet; None means that of the enclosing group."""

    robot: Text = None
    fleet: Text = None


HERE = RobotRef()


Here = tuple[LoadedFleet | None, str | None]


def entered(context: Context, group: Here) -> None:
    """Set the fleet and the robot from here on, also for later events and timers; None for none."""
    _carry(context)
    context.extend_locals(dict(zip((FLEET, ROBOT), group, strict=True)))


def here(context: Context) -> Here:
    """Return the fleet and the robot of the enclosing group; None outside of one."""
    known = context.get_locals_as_dict()
    return known.get(FLEET), known.get(ROBOT)


def _carry(context: Context) -> None:
    """Let event handlers that are registered from now on start their actions for the current robot."""
    if _CARRIED in context.get_locals_as_dict():
        return
    context.extend_globals({_CARRIED: True})
    register = context.register_event_handler

    def registered(event_handler: Any, *more: Any, **options: Any) -> None:
        group = here(context)
        if any(group) and not _is_of_timers(event_handler):
            event_handler.handle = _handler_for_group(event_handler.handle, group)
        register(event_handler, *more, **options)

    context.register_event_handler = registered


def _handler_for_group(handle: Callable[..., Any], group: Here) -> Callable[..., Any]:
    """Return an event handler that first sets fleet and robot of ``group``."""

    def handled(event: Any, context: Context) -> Any:
        # launch drops the locals when it has visited what this returns.
        entered(context, group)
        return handle(event, context)

    return handled


def _is_of_timers(handler: Any) -> bool:
    """Return whether a handler is the one for all timers of a launch, which keep locals."""
    event = of_launch("events").TimerEvent(timer_action=None)
    return type(handler).__name__ == "EventHandler" and bool(handler.matches(event))


def fleet_of(context: Context, fleet: Text = None) -> LoadedFleet:
    """Return the fleet of a file, which a launch loads once, for a function of OpaqueFunction.

    ``fleet`` may hold substitutions. The launch configurations ``multibot_trust:=true`` and
    ``multibot_distro``, ``multibot_robots`` and ``multibot_count`` are options of ``load_fleet``.
    Findings go to launch's log. Raises as that."""
    enclosing, _ = here(context)
    if fleet is None and enclosing:
        return enclosing
    path = _launch_argument(context, FLEET, "fleet") if fleet is None else perform(context, fleet)
    known: dict[str, LoadedFleet] = _of_launch(context, _FLEETS, dict)
    words = (TRUST, DISTRO, ROBOTS, COUNT)
    trust, distro, robots, count = (str(context.launch_configurations.get(it, "")) for it in words)
    key = f"{path} {robots} {count}"
    if key not in known:
        trusted = trust.lower() in ("true", "1")
        number = number_of(count)
        known[key] = load_fleet(path, trust=trusted, distro=distro, robots=robots, count=number)
        _log_findings(context, known[key].findings)
    return known[key]


def number_of(count: str) -> int:
    """Return the number of robots in a launch argument, 0 for none; raises UsageError."""
    if count and not count.isdecimal():
        raise UsageError(f"{COUNT}: {count!r} is no number of robots; write {COUNT}:=20")
    return int(count or 0)


def robot_of(context: Context, of: RobotRef = HERE) -> LoadedRobot:
    """Return a robot; raises as ``fleet_of``, and UsageError for an unknown robot."""
    _, enclosing = here(context)
    if of.robot is None:
        name = enclosing or _launch_argument(context, ROBOT, "robot")
    else:
        name = perform(context, of.robot)
    return fleet_of(context, of.fleet).robot(name)


def file_of(context: Context, file: str, of: RobotRef = HERE) -> str:
    """Return the path of a robot's file, or without a robot of that for all, written for the launch."""
    fleet = fleet_of(context, of.fleet)
    asked = of.robot is not None or here(context)[1] or ROBOT in context.launch_configurations
    robot = robot_of(context, of) if asked else None
    text = robot.text(file) if robot else fleet.text(file)
    _log_findings(context, fleet.made.findings)
    return written(context, robot, os.path.basename(file), text)


def node_file_of(context: Context, file: str, of: RobotRef = HERE) -> str:
    """Return the path of a robot's parameter file, full names and substitutions filled in."""
    robot = robot_of(context, of)
    text = robot.node_text(file)
    if "$(" in text:
        text = perform(context, of_launch("frontend.parse_substitution").parse_substitution(text))
    _log_findings(context, fleet_of(context, of.fleet).made.findings)
    return written(context, robot, f"nodes/{os.path.basename(file)}", text)


def perform(context: Context, text: Text) -> str:
    """Return the value of a text with substitutions in this context."""
    utilities = of_launch("utilities")
    text = os.fspath(text) if isinstance(text, os.PathLike) else text
    parts = utilities.normalize_to_list_of_substitutions(text)
    return str(utilities.perform_substitutions(context, parts))


def sim_time(context: Context, robot: LoadedRobot, told: Text) -> bool | None:
    """Return use_sim_time as ``told``, as the launch argument or as the fleet file says; or None."""
    if isinstance(told, bool):
        return told
    text = context.launch_configurations.get(SIM_TIME) if told is None else perform(context, told)
    if text is None or not str(text).strip():
        return robot.use_sim_time
    word = str(text).strip().lower()
    if word not in _TRUTH:
        raise UsageError(f"use_sim_time is {text!r}; write true or false")
    return _TRUTH[word]


def listed(context: Context, names: Text) -> list[str]:
    """Return the names of a list or of a text with commas: launch joins lists with substitutions."""
    several = not isinstance(names, str) and isinstance(names, Sequence)
    if several and all(isinstance(it, str | os.PathLike) for it in names):
        return [os.fspath(it) for it in names]
    return [it for it in map(str.strip, perform(context, names).split(",")) if it]


def _launch_argument(context: Context, key: str, what: str) -> str:
    if key not in context.launch_configurations:
        hint = f"set {what}, or put it into multibot_robots or each_robot"
        raise UsageError(f"no {what} is given; {hint}")
    return str(context.launch_configurations[key])


def _of_launch(context: Context, key: str, make: Callable[[], Any]) -> Any:
    """Return the value that a launch keeps under ``key`` while it runs."""
    known = context.get_locals_as_dict()
    if key not in known:
        context.extend_globals({key: make()})
    return context.get_locals_as_dict()[key]


def written(context: Context, robot: LoadedRobot | None, file: str, text: str) -> str:
    """Return the path of a file that this launch writes with that text."""
    folder = _of_launch(context, _FOLDER, lambda: _folder(context))
    path = os.path.join(folder.name, robot.name if robot else "all", file)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as out:
        out.write(text.encode())
    return path


def _folder(context: Context) -> TemporaryDirectory[str]:
    """Return a folder that is removed when the launch shuts down, at the latest with its context."""
    folder = TemporaryDirectory(prefix="multibot_launch_")
    gone = of_launch("event_handlers").OnShutdown(
        on_shutdown=lambda event, context: folder.cleanup()
    )
    context.register_event_handler(gone)
    return folder


def _log_findings(context: Context, findings: Iterable[Finding]) -> None:
    logged: set[Finding] = _of_launch(context, _LOGGED, set)
    for finding in findings:
        if finding not in logged:
            logged.add(finding)
            log = of_launch("logging").get_logger("multibot")
            (log.info if finding.level == NOTE else log.warning)(str(finding))


FILE = "file"
# Words whose values are numbers.
NUMBERS = frozenset({"pose"})


def _pose(robot: LoadedRobot, axis: str) -> str:
    values = (robot.pose or Pose())._asdict()
    if axis not in values:
        raise UsageError(f"$(multibot pose {axis}): {unknown('axis', axis, values)}")
    return str(values[axis])


WORDS: Mapping[str, Callable[[LoadedRobot, str], str]] = MappingProxyType(
    {
        "name": lambda robot, _: robot.name,
        "namespace": lambda robot, _: robot.namespace,
        "model": lambda robot, _: robot.model,
        "pose": _pose,
        "description": lambda robot, _: robot.description,
        "srdf": lambda robot, _: robot.srdf,
        "frame": LoadedRobot.frame,
        "link": LoadedRobot.link,
        "joint": LoadedRobot.joint,
        "topic": LoadedRobot.topic,
        "node": lambda robot, name: robot.table.full_name(name),
    }
)


def description(robot: Text = None, fleet: Text = None) -> Substitution:
    """Return a robot's description for ``parameters=[{"robot_description": ...}]``."""
    return value("description", robot=robot, fleet=fleet)


def params_file(file: Text, robot: Text = None, fleet: Text = None) -> Substitution:
    """Return the path of a robot's parameter file, rewritten: an item of ``parameters=[...]``."""
    return value(FILE, file, robot, fleet)


def rviz_config(file: Text, robot: Text = None, fleet: Text = None) -> Substitution:
    """Return the path of a robot's RViz config, or of the one that shows all."""
    return value(FILE, file, robot, fleet)


def bridge_config(robot: Text = None, fleet: Text = None) -> Substitution:
    """Return the path of a robot's ros_gz_bridge file, or of the one for all robots."""
    return value(FILE, BRIDGE_FILE, robot, fleet)


def value(word: Text, name: Text = "", robot: Text = None, fleet: Text = None) -> Substitution:
    """Return the substitution ``$(multibot WORD NAME)``: one of ``WORDS``, or the path of a file.

    As the value of a parameter it is a string whatever is in it, and a number for ``pose``:
    launch_ros reads other substitutions as YAML, refuses a description with ``: `` in a comment,
    and takes a robot called ``on`` for true."""
    return substitution_class()([word, name], RobotRef(robot, fleet))


@cache
def substitution_class() -> Any:
    """Return the class of the substitutions of this package; each is a ParameterValue, too."""
    substitution: Any = of_launch().Substitution
    parameter_value: Any = of_launch_ros("parameter_descriptions").ParameterValue

    class Multibot(substitution, parameter_value):  # type: ignore[misc]
        """A value about a robot, known when the launch file runs."""

        def __init__(self, words: Sequence[Text], of: RobotRef) -> None:
            parameter_value.__init__(self, "", value_type=str)
            self.words, self.of = words, of

        def perform(self, context: Context) -> str:
            return _value_of_words(context, [perform(context, it) for it in self.words], self.of)

        def evaluate(self, context: Context) -> str | float:
            text = self.perform(context)
            return float(text) if perform(context, self.words[0]) in NUMBERS else text

    return Multibot


def as_value(value: Any) -> Any:
    """Return a parameter's value in an XML or YAML file; a substitution of this package as it is."""
    untyped = getattr(value, "value_type", str) is None
    parts: Any = value.value if untyped else ()
    alone = isinstance(parts, list) and len(parts) == 1
    return parts[0] if alone and isinstance(parts[0], substitution_class()) else value


def _value_of_words(context: Context, words: Sequence[str], of: RobotRef) -> str:
    """Return the value of ``$(multibot ...)`` with these words."""
    options = [it for it in words if it.partition(":=")[0] in RobotRef._fields and ":=" in it]
    of = of._replace(**dict(it.split(":=", 1) for it in options))
    word, name = (*(it for it in words if it not in options), "", "")[:2]
    if word == FILE:
        return file_of(context, name, of)
    if word not in WORDS:
        raise UsageError(f"$(multibot {word}): {unknown('word', word, (*WORDS, FILE))}")
    return WORDS[word](robot_of(context, of), name)
