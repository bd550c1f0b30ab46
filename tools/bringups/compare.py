# SPDX-License-Identifier: Apache-2.0
"""What a fleet starts of what a bringup starts: for each robot, once, or not; and how it differs."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from tools.bringups.running import BRIDGED, Process, flat, sections, value_of

# Programs that run once for all robots, and need no reason: simulators, worlds, tools.
SHARED = {
    *("gz_sim.launch.py", "gz_server.launch.py", "gz_client.launch.py", "gazebo.launch.py"),
    *("gzserver.launch.py", "gzclient.launch.py", "gz", "ign", "gzserver", "gzclient", "gazebo"),
    *("rviz2", "rqt", "rqt_graph", "foxglove_bridge", "rosbridge_websocket", "map_server"),
}
# The bridge of a robot carries images, too.
IMAGES = "image_bridge"
BRIDGES = {"parameter_bridge", "bridge_node", "ros_gz_bridge::RosGzBridge", IMAGES}
STATIC = {"static_transform_publisher", "tf2_ros::StaticTransformBroadcasterNode"}


_NAVIGATION = (
    *("controller_server", "smoother_server", "planner_server", "behavior_server"),
    *("bt_navigator", "waypoint_follower", "velocity_smoother", "lifecycle_manager"),
)
# Launch files of public packages that a fleet may start as nodes, with the programs they start.
INCLUDED: dict[str, tuple[str, ...]] = {
    "navigation_launch.py": _NAVIGATION,
    "localization_launch.py": ("map_server", "amcl", "lifecycle_manager"),
    "bringup_launch.py": ("map_server", "amcl", *_NAVIGATION),
    "online_async_launch.py": ("async_slam_toolbox_node",),
    "online_sync_launch.py": ("sync_slam_toolbox_node",),
    "twist_mux_launch.py": ("twist_mux",),
    "rosbridge_websocket_launch.xml": ("rosbridge_websocket",),
}


# Arguments that are the robot's own; with a value only that one.
_PLACE = dict.fromkeys(("-x", "-y", "-z", "-R", "-P", "-Y", "-name", "-entity"), "")
OWN: dict[str, dict[str, str]] = {
    "create": _PLACE,
    "spawn_entity.py": _PLACE,
    "gz_spawn_model": _PLACE,
    "spawner": {"--controller-manager": "controller_manager", "-c": "controller_manager"},
}


# What starts one simulator: the program, or the launch file that starts it with the same options.
SIMULATORS = {
    **dict.fromkeys(("gz", "ign", "gz_sim.launch.py", "ign_gazebo.launch.py"), "gz_sim"),
    **dict.fromkeys(("gazebo.launch.py", "gzserver.launch.py", "gazebo", "gzserver"), "classic"),
}
WINDOWS = {"gzclient.launch.py", "gzclient"}
# One package under two names, of which Humble has both.
RENAMED = {"ros_ign_gazebo": "ros_gz_sim", "ros_ign_bridge": "ros_gz_bridge"}
# Static transforms for the poses in the fleet file.
POSES = {"start_pose"}


class Match(NamedTuple):
    """A process of the bringup: where it is in the fleet, and what differs there."""

    process: Process
    where: str  # "each", "once", "some", "missing"
    differs: tuple[str, ...] = ()


class Comparison(NamedTuple):
    """What was compared: the bringup's processes, and what the fleet starts beside them."""

    matches: tuple[Match, ...]
    extra: tuple[Process, ...]


def compare(
    bringup: Sequence[Process], fleet: Sequence[Process], robots: Sequence[str]
) -> Comparison:
    """Return where each process of the bringup is in the fleet. A bringup of several robots is that of
    the first; what starts for the others is where the same of the first is."""
    left, vendors = list(fleet), _several(bringup)
    first, others = vendors[:1], vendors[1:]
    own = [it for it in bringup if owner(it, vendors) not in others]
    matches = [_match(_of_any(it, *first), left, robots) for it in own]
    free = [it for it in matches if owner(own[matches.index(it)], vendors)]
    for process in (it for it in bringup if owner(it, vendors) in others):
        matches.append(_as_first(_of_any(process, owner(process, vendors)), free))
    # The fleet's launch file of Gazebo Classic opens its window, too.
    classic = [it.words for it in fleet if os.path.basename(it.program) == "gazebo.launch.py"]
    if any(("gui", "false") not in pairwise(words) for words in classic):
        windows = [it for it in matches if os.path.basename(it.process.program) in WINDOWS]
        matches = [it._replace(where="once") if it in windows else it for it in matches]
    # Bridges are merged: each is there if its topics are bridged.
    left = [it for it in left if it.program not in BRIDGES and it.name not in POSES]
    return Comparison(tuple(matches), tuple(left))


def _several(bringup: Sequence[Process]) -> list[str]:
    """Return the namespaces of state publishers, where there are some that differ by a number alone,
    or a spawner in each."""
    above = [(it.program, it.namespace.strip("/").partition("/")[0]) for it in bringup]
    homes = {home for program, home in above if program == "robot_state_publisher"} - {""}
    spawned = {home for program, home in above if program in ("create", "spawn_entity.py")}
    is_one = len({re.sub(r"\d+", "", it) for it in homes}) != 1 and not homes <= spawned
    return [] if is_one or len(homes) < 2 else sorted(homes)


def _of_any(process: Process, robot: str = "") -> Process:
    """Return a process without the name of a robot."""
    values = process.parameters.items()
    return (
        process._replace(
            name=bare(process.name, robot),
            namespace=f"/{bare(process.namespace, robot)}",
            rules=tuple((bare(old, robot), bare(new, robot)) for old, new in process.rules),
            words=tuple(bare(it, robot) if robot in it else it for it in process.words),
            parameters={k: bare(it, robot) if isinstance(it, str) else it for k, it in values},
        )
        if robot
        else process
    )


def _as_first(process: Process, free: list[Match]) -> Match:
    """Return where a process is of which the first robot has the same, and take that out."""
    same = (it for it in free if _key(it.process, "") == _key(process, ""))
    found = next((it for it in same if _may_be(process, it.process, "")), None)
    if found is None:
        return Match(process, "missing")
    free.remove(found)
    return found._replace(process=process)


def _match(process: Process, left: list[Process], robots: Sequence[str]) -> Match:
    """Find a process for each robot, and take what was found out of what is left."""
    if process.program in BRIDGES:
        return _bridged(process, left, robots)
    found = {robot: _nearest(process, left, robot, robots) for robot in robots}
    there = {robot: it for robot, it in found.items() if it is not None}
    if not there and process.kind == "include":
        return _as_nodes(process, left, robots)
    if not there:
        shared = _nearest(process, left, "", robots)
        if shared is None:
            return Match(process, "missing")
        left.remove(shared)
        return Match(process, "once", tuple(differences(process, shared, "")))
    for it in there.values():
        left.remove(it)
    differs = {it: None for robot, one in there.items() for it in differences(process, one, robot)}
    return Match(process, "each" if len(there) == len(robots) else "some", tuple(differs))


def _as_nodes(process: Process, left: list[Process], robots: Sequence[str]) -> Match:
    """Return whether an include is there for all robots, or its programs are in its place."""
    shared = _nearest(process, left, "", robots)
    if shared is not None:
        left.remove(shared)
        return Match(process, "once", tuple(differences(process, shared, "")))
    programs = INCLUDED.get(os.path.basename(process.program), ())
    for where, owners in (("each", robots), ("once", ("",))):
        nodes = [
            next((it for it in left if it.program == one and owner(it, robots) == robot), None)
            for robot in owners
            for one in programs
        ]
        if nodes and None not in nodes:
            left[:] = [it for it in left if it not in nodes]
            return Match(process, where, ("its nodes in place of the include",))
    return Match(process, "missing")


def _nearest(
    process: Process, left: Iterable[Process], robot: str, robots: Sequence[str]
) -> Process | None:
    """Return the process of a robot, or of none, that is started most like one of the bringup."""
    same = [
        it
        for it in left
        if _key(it, robot) == _key(process, "")
        and owner(it, robots) == robot
        and _may_be(process, it, robot)
    ]
    return min(same, key=lambda it: len(list(differences(process, it, robot))), default=None)


def _key(process: Process, robot: str) -> tuple[str, ...]:
    """Return what two processes that do one thing have in common."""
    if process.program == "spawner":
        return ("spawner", bare(process.words[0], robot) if process.words else "")
    if of_one := SIMULATORS.get(os.path.basename(process.program)):
        return (of_one,)
    if process.program in STATIC:
        return ("static", *(bare(it, robot) for it in frames(process)))
    if not process.package:
        return (process.program, *(str(value(it, robot)) for it in process.words[:1]))
    package = RENAMED.get(process.package, process.package)
    return (package, os.path.basename(process.program))


def _may_be(process: Process, other: Process, robot: str) -> bool:
    """Return whether two of one program can be the same one: their names do not contradict."""
    named = process.name and other.name
    return not named or bare(process.name, "") == bare(other.name, robot)


def owner(process: Process, robots: Sequence[str]) -> str:
    """Return the robot that a process is of; of none if it has the names of several, or of none."""
    words = [process.namespace, process.name, *process.words]
    words += [it for rule in process.rules for it in rule]
    words += [str(it) for name, it in process.parameters.items() if name != "robot_description"]
    text = " ".join(words)
    of = [it for it in robots if re.search(rf"(?<![^\W_]){re.escape(it)}(?![^\W_])", text)]
    return of[0] if len(of) == 1 else ""


def frames(process: Process) -> tuple[str, str]:
    """Return parent and child of a static transform."""
    words = list(process.words)
    given = dict(pairwise(words))
    if "--child-frame-id" in given:
        return given.get("--frame-id", ""), given["--child-frame-id"]
    if process.kind == "component" or len(words) < 8:
        values = process.parameters
        return str(values.get("frame_id", "")), str(values.get("child_frame_id", ""))
    return words[-2], words[-1]


def _bridged(process: Process, left: Sequence[Process], robots: Sequence[str]) -> Match:
    """Return whether the topics of a bridge are bridged, whatever bridge does it."""
    wanted = {bare(it, "") for it in topics(process)}
    bridges = [it for it in left if it.program in BRIDGES]
    by_robot = {
        robot: {bare(name, robot) for it in bridges for name in topics(it) if robot in name}
        for robot in robots
    }
    shared = {
        bare(name, "")
        for it in bridges
        for name in topics(it)
        if not any(robot in name for robot in robots)
    }
    lost = {robot: wanted - has - shared for robot, has in by_robot.items()}
    if all(not it for it in lost.values()):
        return Match(process, "once" if wanted <= shared else "each")
    if all(it == wanted for it in lost.values()):
        return Match(process, "missing")
    lines = (f"not bridged: {', '.join(sorted(it))}" for it in lost.values() if it)
    return Match(process, "each", tuple(dict.fromkeys(lines)))


def topics(process: Process) -> Iterator[str]:
    """Return the ROS topics that a bridge is told: in its words, its file or its parameters."""
    renamed = {_whole(process, old): new for old, new in process.rules}
    names = list(process.parameters.get(BRIDGED, ()))
    for word in process.words:
        name = word.partition("@")[0]
        is_image = process.program == IMAGES and word[:1] != "-"
        if name and ("@" in word or is_image):
            names.append(name)
    for name in (_whole(process, it) for it in names):
        yield _whole(process, renamed.get(name, name))


def _whole(process: Process, name: str) -> str:
    return name if name.startswith("/") else f"{process.namespace.rstrip('/')}/{name}"


def bare(text: str, robot: str) -> str:
    """Return a name without a robot's name and without the slash before it."""
    if robot:
        one = re.escape(robot)
        text = re.sub(rf"(?<![^\W_]){one}[/_]|[/_]{one}(?![^\W_])", "", text)
        text = re.sub(rf"(?<![^\W_]){one}(?![^\W_])", "", text)
    return re.sub(r"^/+|/+$", "", text)


def value(it: Any, robot: str) -> Any:
    """Return a value as it is compared: names bare, of paths the last part, of XML that it is one."""
    if isinstance(it, (list, tuple)):
        return [value(one, robot) for one in it]
    if isinstance(it, bool) or it is None:
        return it
    if isinstance(it, (int, float)):
        return float(it)
    text = str(it).strip()
    if text.startswith("<") or "\n" in text:
        return "<text>"
    if os.path.isabs(text) and os.path.splitext(text)[1]:
        return os.path.basename(text)
    return bare(text, robot)


def differences(process: Process, other: Process, robot: str) -> Iterator[str]:
    """Return in what a process of the fleet differs, beyond the names of its robot."""
    if process.kind != other.kind:
        yield f"{other.kind} in place of {process.kind}"
    if bare(process.namespace, "") != bare(other.namespace, robot):
        yield f"namespace {process.namespace!r}: {other.namespace!r}"
    yield from _rules(process, other, robot)
    yield from _parameters(process, other, robot)
    if process.program not in STATIC and process.kind == other.kind:
        yield from _words(process, other, robot)
        yield from _files(process, other, robot)
    for name, it in process.facts.items():
        if value(other.facts.get(name, ""), robot) != value(it, ""):
            yield f"{name} lost: {_short(it)}"
    for name, it in process.environ.items():
        if name not in other.environ:
            yield f"environment lost: {name}"
        elif _paths(other.environ[name], robot) != _paths(it, ""):
            yield f"environment changed: {name}: {_short(it)} -> {_short(other.environ[name])}"


def _paths(text: str, robot: str) -> list[str]:
    """Return the parts of a variable; of a path of files the last name, unless it is a made one."""
    parts = text.split(os.pathsep)
    return [
        os.path.basename(it) if it.count("/") > 3 and "/multibot_" not in it else bare(it, robot)
        for it in parts
    ]


def _rules(process: Process, other: Process, robot: str) -> Iterator[str]:
    # A rule may be for one node of a process: local_costmap:/scan:=scan
    has = {(bare(old.rpartition(":")[2], robot), bare(new, robot)) for old, new in other.rules}
    wanted = {(bare(old.rpartition(":")[2], ""), bare(new, "")) for old, new in process.rules}
    wanted = {(old, new) for old, new in wanted if old != new}
    for old, new in sorted(wanted - has):
        yield f"rule lost: {old}:={new}"
    for old, new in sorted(has - wanted):
        if old != new and old.rpartition("/")[2] not in ("tf", "tf_static"):
            yield f"rule more: {old}:={new}"


def _parameters(process: Process, other: Process, robot: str) -> Iterator[str]:
    wanted = {bare(name, ""): it for name, it in process.parameters.items()}
    has = {bare(name, robot): it for name, it in other.parameters.items()}
    loose = {bare(name, robot) for name in other.loose}
    # Of a vendor's node without a name nobody knows which sections it reads.
    unsure = {bare(name, "") for name in process.loose} if other.name else set()
    yield from _grouped("parameter lost", wanted.keys() - has.keys() - unsure)
    for name in sorted(wanted.keys() & has.keys()):
        if value(has[name], robot) != value(wanted[name], ""):
            yield f"parameter changed: {name}: {_short(wanted[name])} -> {_short(has[name])}"
    yield from _grouped("parameter more", has.keys() - wanted.keys() - {"use_sim_time"} - loose)


def _grouped(title: str, names: Iterable[str]) -> Iterator[str]:
    """Return a line for each name, or for many that begin alike."""
    groups: dict[str, list[str]] = {}
    for name in sorted(names):
        groups.setdefault(name.partition(".")[0], []).append(name)
    for first, inside in groups.items():
        if len(inside) <= 3:
            yield from (f"{title}: {name}" for name in inside)
        else:
            yield f"{title}: {len(inside)} of {first}"


def _words(process: Process, other: Process, robot: str) -> Iterator[str]:
    wanted, has = options(process, ""), options(other, robot)
    for name in [it for it in wanted if has.get(it) != wanted[it]]:
        if name in has:
            yield f"argument changed: {name} {_short(wanted[name])} -> {_short(has[name])}"
        else:
            yield f"argument lost: {name} {_short(wanted[name])}".rstrip()
    for name in has.keys() - wanted.keys():
        yield f"argument more: {name} {_short(has[name])}".rstrip()


def _files(process: Process, other: Process, robot: str) -> Iterator[str]:
    """Return what differs in the parameter files among the arguments of two processes."""
    for word in process.words:
        file = word.rpartition("=")[2]
        there = [it.rpartition("=")[2] for it in other.words]
        same = [it for it in there if os.path.basename(it) == os.path.basename(file)]
        if file.endswith((".yaml", ".yml")) and same:
            wanted, has = _content(file, ""), _content(same[0], robot)
            name = os.path.basename(file)
            yield from _grouped(f"{name} lost", wanted.keys() - has.keys())
            both = wanted.keys() & has.keys()
            yield from _grouped(f"{name} changed", {it for it in both if wanted[it] != has[it]})


def _content(file: str, robot: str) -> dict[str, Any]:
    """Return the values of a parameter file by section and name, as they are compared."""
    text = Path(file).read_text(errors="replace") if os.path.isfile(file) else ""
    content = value_of(text)
    rows = sections(content, "") if isinstance(content, dict) else ()
    return {
        f"{bare(section, robot)}.{bare(name, robot)}": value(it, robot)
        for section, values in rows
        for name, it in flat(values)
    }


def options(process: Process, robot: str) -> dict[str, str]:
    """Return the words of a process as options with values; words before them have no value.

    What each robot has by itself is left out: its name and place in a simulator, the manager of its
    namespace.
    """
    found: dict[str, str] = {}
    name = ""
    for word in process.words:
        flag = re.match(r"(--?[A-Za-z][\w-]*)(?:=(.*))?$|(\w+):=(.*)$", word, re.DOTALL)
        if flag:
            key, text, argument, given = flag.groups()
            name = "" if argument or text else key
            found[(key or argument).replace("_", "-")] = _plain(text or given or "", robot)
        elif name:
            key = name.replace("_", "-")
            found[key] = f"{found[key]} {_plain(word, robot)}".strip()
        else:
            found[_plain(word, robot)] = ""
    own = OWN.get(os.path.basename(process.program), {})
    return {key: it for key, it in found.items() if key not in own or own[key] not in ("", it)}


def _plain(text: str, robot: str) -> str:
    """Return an argument as it is compared: of paths the last part."""
    words = text.replace('"', "").split(" ")
    return " ".join(str(value(it, robot)) for it in words)


def _short(it: Any) -> str:
    text = str(it)
    return text if len(text) <= 90 else f"{text[:40]}...{text[-47:]}"
