# SPDX-License-Identifier: Apache-2.0
"""A built folder as it would run: launch, or a stand-in for it, executes its launch file, each program
opens what the sources of its package say, the real rcl resolves every name, tables stand in for Gazebo.

No module of the package is imported here: what it wrote is judged.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import controllers
import gazebo
import lifecycles
import programs
import rcl_names
import simulator
import yaml
from gazebo import GzEnd
from lxml import etree
from nodes import SPAWNERS, Node, Reader, nodes_of, plugin_nodes, sections_of
from trees import Edge, edges_of, with_odometry

HERE = Path(__file__).parent
# TinyXML-2 asks for no declaration of prefixes.
LOOSE = etree.XMLParser(recover=True)


# What rcl_action makes of the name of an action.
GOAL = "/_action/send_goal"


class End(NamedTuple):
    """An end of a topic or service, as it is in the graph."""

    robot: str
    node: str
    role: str
    name: str
    type: str
    sure: bool


class Bridge(NamedTuple):
    """A row of a bridge."""

    ros: str
    gz: str
    type: str
    gz_type: str
    to_ros: bool
    to_gz: bool


class Fleet(NamedTuple):
    """What runs, and what does not come up: a line each."""

    robots: tuple[str, ...]
    nodes: tuple[Node, ...]
    ends: tuple[End, ...]
    gz: tuple[GzEnd, ...]
    models: Mapping[str, str]
    bridges: tuple[Bridge, ...]
    edges: tuple[Edge, ...]
    told: Mapping[str, str]
    faults: tuple[tuple[str, str, str], ...]
    unknown: tuple[tuple[str, str], ...]
    whole: bool = False


def launched(file: Path, robot: str = "") -> Mapping[str, Any]:
    """Return what the launch file starts; a file that raises is a fault of the folder."""
    words = [f"robots:={robot}"] if robot else []
    child = HERE / ("launched.py" if find_spec("launch_ros") else "started.py")
    return run(child, file, *words)


def run(child: Path, file: Path, *words: str) -> Mapping[str, Any]:
    """Return what a child says that a launch file starts."""
    command = [sys.executable, str(child), str(file), *words]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr.strip().splitlines()[-1])
    found: Mapping[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return found


def read(folder: Path, release: str, sources: tuple[Path, ...] = ()) -> Fleet:
    """Return the fleet of a built folder; with ``sources`` of the vendor's packages it is whole
    if nothing in it is unknown."""
    file = folder / "fleet.launch.py"
    try:
        every = launched(file)
        own = every.get("own") or {it: launched(file, it)["starts"] for it in every["robots"]}
    except (RuntimeError, OSError) as error:
        return Fleet(
            (),
            (),
            (),
            (),
            {},
            (),
            (),
            {},
            (("", "starts", f"the launch file raises: {error}"),),
            (),
        )
    shared = [it for it in every["starts"] if all(it in each for each in own.values())]
    if len(own) == 1:
        shared = [it for it in shared if "include" in it]
    starts = [("", it) for it in shared]
    starts += [(robot, it) for robot, each in own.items() for it in each if it not in shared]
    return assembled(Reader(starts, release, folder, sources), tuple(own), file)


def assembled(given: Reader, robots: tuple[str, ...], file: Path) -> Fleet:
    faults = list(missing_files(given))
    nodes = list(nodes_of(given))
    roots = dict(descriptions(given))
    models = dict(models_of(given))
    spawned = {**roots, **dict(spawned_files(given))}
    nodes += plugin_nodes(spawned, models)
    world = simulator.world_of(given.starts, given.folder)
    there = list(simulator.models_of(spawned, models))
    found = controllers.read(given, roots, nodes, {it.robot: it.kept.joints for it in there})
    nodes += found.nodes
    faults += found.faults
    resolved = resolve(nodes)
    bridges = tuple(bridges_of(given, nodes, resolved))
    ends = tuple(ends_of(nodes, resolved))
    gz = tuple(end for it in there for end in simulator.ends_of(it, world))
    nodes = [with_odometry(it, nodes, ends, gz, bridges) for it in nodes]
    edges = tuple(edges_of(given, nodes, roots, ends, gz, bridges))
    unknown = tuple(sorted({*strangers(given, nodes), *gazebo.strangers(spawned, models)}))
    faults += [*undelivered(given, nodes, ends), *lifecycles.faults(given, nodes)]
    posed = {it.robot for it in nodes if it.what.startswith("joint_state_publisher")}
    broken = [fault for it in there for fault in simulator.broken(it, world, it.robot in posed)]
    broken += [*simulator.one_port(there), *simulator.rendered_twice(there, world)]
    for it in there:
        broken += simulator.idle(
            it, [each.values for each in found.nodes if each.robot == it.robot]
        )
    return Fleet(
        robots,
        tuple(nodes),
        ends,
        gz,
        models,
        bridges,
        edges,
        told(file, robots),
        (*((who, "starts", why) for who, why in faults), *broken),
        unknown,
        bool(given.sources) and not unknown,
    )


# What opens nothing of a robot's, beside the programs of the table.
QUIET = (
    *("parameter_bridge", "rviz2", "gz_sim.launch.py", "gazebo.launch.py"),
    *("component_container", "component_container_isolated", "static_transform_publisher"),
)


def strangers(given: Reader, nodes: list[Node]) -> Iterator[tuple[str, str]]:
    """Programs, components, controllers and included launch files that no source was read of."""
    for it in nodes:
        # Its manager and controllers are read on their own.
        if any(word in it.what for word in gazebo.CONTROL):
            continue
        if not it.ends and it.what not in QUIET and not programs.is_known(it.what, given.release):
            yield it.robot, it.what
    for who, start in given.starts:
        name = start.get("include") or " ".join(start.get("command", ()))
        if name and Path(name).name not in QUIET:
            yield who, name


def missing_files(given: Reader) -> Iterator[tuple[str, str]]:
    """Files and folders that a start names and that are not there."""
    for who, it in given.starts:
        values = [value for each in it.get("parameters", ()) for value in each.values()]
        for word in (*values, *it.get("arguments", ())):
            if (
                isinstance(word, str)
                and word.startswith(str(given.folder))
                and not Path(word).exists()
            ):
                yield who, f"{it['executable']} is given {word}, which is not there"


def descriptions(given: Reader) -> Iterator[tuple[str, etree._Element]]:
    """Yield the description that each robot's robot_state_publisher has."""
    for who, it in given.of("robot_state_publisher"):
        text = programs.parameters_of("/x", [x for x in sections_of(it) if "" in x]).get(
            "robot_description"
        )
        if text:
            yield who, etree.fromstring(text.encode(), LOOSE)


def spawned_files(given: Reader) -> Iterator[tuple[str, etree._Element]]:
    """Yield the model that the simulator gets from a file, perhaps not the description."""
    for who, it in given.of(*SPAWNERS):
        words = it["arguments"]
        path = words[words.index("-file") + 1] if "-file" in words else ""
        if Path(path).is_file():
            yield who, etree.parse(path, LOOSE).getroot()


def models_of(given: Reader) -> Iterator[tuple[str, str]]:
    """Yield the name of each robot in the simulator."""
    for who, it in given.of(*SPAWNERS):
        words = it["arguments"]
        yield who, words[words.index(SPAWNERS[it["executable"]]) + 1]


def resolve(nodes: list[Node]) -> dict[tuple[str, programs.Opened], str]:
    """Where each name of each node leads, by the real rcl; a rule of a program reaches all in it, and
    what a helper opens is in the namespace of the process."""
    parts = [
        (f"{at}", it, place, ends)
        for at, it in enumerate(nodes)
        for helper, place in ((False, (it.namespace, it.rules)), (True, it.process))
        if (ends := [end for end in it.ends if "<" not in end.name and is_in(it, end) == helper])
    ]
    cases = [
        {
            "ask": "started",
            "node": it.name,
            "namespace": space,
            "process_rules": [f"{old}:={new}" for old, new in rules],
            "node_rules": [],
            "use_process_rules": True,
            "names": [asked(it, end) for end in ends],
        }
        for _, it, (space, rules), ends in parts
    ]
    answers = rcl_names.ask(cases)
    return {
        (at, end): name.removesuffix(GOAL)
        for (at, _, _, ends), answer in zip(parts, answers, strict=True)
        if answer
        for end, name in zip(ends, answer[1:], strict=True)
    }


def is_in(node: Node, end: programs.Opened) -> bool:
    """Return whether a helper in a process of several nodes opens the end."""
    return end.helper and node.process is not None


def asked(node: Node, end: programs.Opened) -> list[str]:
    """Return what rcl resolves for an end; of an action that is the service that takes its goals."""
    kind = "topic" if end.role in ("publishes", "subscribes") else "service"
    return [kind, above(node, end.name) + (GOAL if "/action/" in end.type else "")]


def above(node: Node, name: str) -> str:
    """``../scan`` is a topic of the namespace above."""
    parent = node.namespace.rpartition("/")[0]
    return f"{parent}/{name[3:]}" if name.startswith("../") else name


def ends_of(nodes: list[Node], resolved: Mapping[Any, str]) -> Iterator[End]:
    for at, it in enumerate(nodes):
        for end in it.ends:
            name = resolved.get((f"{at}", end))
            if name:
                yield End(it.robot, it.fqn, end.role, name, end.type, end.sure)


def bridges_of(given: Reader, nodes: list[Node], resolved: Mapping[Any, str]) -> Iterator[Bridge]:
    """Yield the rows of all bridges, with the ROS name as the bridge's node resolves it."""
    rows = []
    for it in nodes:
        file = Path(str(it.values.get("config_file", "")))
        if it.what == "parameter_bridge" and file.is_file():
            rows += [(it, row) for row in yaml.safe_load(file.read_text()) or ()]
    names = [row.get("ros_topic_name") or row.get("topic_name") for _, row in rows]
    cases = [
        {
            "ask": "started",
            "node": it.name,
            "namespace": it.namespace,
            "process_rules": [f"{old}:={new}" for old, new in it.rules],
            "node_rules": [],
            "use_process_rules": True,
            "names": [["topic", name]],
        }
        for (it, _), name in zip(rows, names, strict=True)
        if not name.startswith("/") or it.rules
    ]
    answers = iter(rcl_names.ask(cases) if cases else ())
    for (it, row), name in zip(rows, names, strict=True):
        ros = next(answers)[1] if not name.startswith("/") or it.rules else name
        way = row.get("direction", "BIDIRECTIONAL")
        gz = gazebo.valid(row.get("gz_topic_name") or row.get("topic_name"))
        types = row["ros_type_name"], row["gz_type_name"].replace("ignition.", "gz.")
        yield Bridge(ros, gz, *types, way != "ROS_TO_GZ", way != "GZ_TO_ROS")


def told(file: Path, robots: tuple[str, ...]) -> Mapping[str, str]:
    """Where the launch file tells its reader to send commands, by robot."""
    lines = re.findall(r"-r (?:\\\n\s*)?cmd_vel:=(\S+)", file.read_text().split('"""')[1])
    return (
        dict(zip(robots, lines, strict=False))
        if len(lines) == len(robots)
        else {robot: line for robot in robots for line in lines if line.startswith(f"/{robot}/")}
    )


def undelivered(
    given: Reader, nodes: list[Node], ends: tuple[End, ...]
) -> Iterator[tuple[str, str]]:
    """Who waits for a description on a topic that nobody has, or another robot: spawners, managers."""
    sent = {
        it.name: it.robot
        for it in ends
        if it.role == "publishes" and it.type == "std_msgs/msg/String"
    }
    for who, it in given.of(*SPAWNERS):
        words = it["arguments"]
        if "-topic" in words:
            topic = words[words.index("-topic") + 1]
            space = it["namespace"].strip("/")
            name = topic if topic.startswith("/") else f"/{space}/{topic}".replace("//", "/")
            yield from unsent(who, it["executable"], name, sent)
    told = {it.fqn for it in nodes if "robot_description" in it.values}
    for end in ends:
        wanted = end.role == "subscribes" and end.name.endswith("robot_description")
        if wanted and end.node not in told:
            yield from unsent(end.robot, end.node, end.name, sent)


def unsent(who: str, what: str, name: str, sent: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    if name not in sent:
        yield who, f"{what} waits for {name}, which no node sends"
    elif sent[name] != who:
        yield who, f"{what} waits for {name}, which {sent[name] or 'another'} sends"
