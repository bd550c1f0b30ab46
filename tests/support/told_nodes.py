# SPDX-License-Identifier: Apache-2.0
"""What programs were told by a launch -> the nodes that they would be, for rcl to name.

The rules, names and namespaces are the words of the command lines. What is in a node's code (its
endpoints, the transforms that it sends) and what plugins of a simulator make of a description are as
in the plan of the fleet.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import yaml

from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.library.loaded_fleet import LoadedFleet
from multibot_rewrite.live.rehearsal import Stub, played, stub_nodes
from multibot_rewrite.planning.transforms import with_odometry
from multibot_rewrite.planning.way_checks import running_nodes
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, TOPIC, Edge, edge_of

Told = Mapping[str, Any]
ROS_ARGS = "--ros-args"


def words_of(told: Told) -> tuple[str, list[str], list[str]]:
    """Return the program, its own words, and those for ROS without parameters."""
    program, *words = told["words"]
    own, ros = words, []
    if ROS_ARGS in words:
        at = words.index(ROS_ARGS)
        own, ros = words[:at], words[at + 1 :]
    pairs = [ros[at : at + 2] for at, word in enumerate(ros[:-1]) if word in ("-r", "--remap")]
    return os.path.basename(program), own, [word for pair in pairs for word in pair]


def placed(rules: Iterable[str]) -> tuple[str, str]:
    """Namespace and name that rules give."""
    found = dict(it.split(":=", 1) for it in rules if ":=" in it)
    return found.get("__ns", "/"), found.get("__node", "")


def nodes_of(every: Iterable[Told], fleet: LoadedFleet) -> Iterator[Stub]:
    """Yield the nodes of these programs."""
    stubs = dict(_known(fleet))
    for told in every:
        program, own, rules = words_of(told)
        if program == "parameter_bridge":
            yield _bridge(told, rules, fleet)
        elif program in ("create", "spawn_entity.py"):
            model = own[own.index("-name" if "-name" in own else "-entity") + 1]
            yield from _plugins(model, fleet, stubs)
        elif program == "spawner":
            yield from _controller(own, rules, stubs)
        elif program != "rviz2":
            namespace, name = placed(rules)
            yield from _process(f"{namespace.rstrip('/')}/{name}", rules, fleet, stubs)


def _known(fleet: LoadedFleet) -> Iterator[tuple[str, Stub]]:
    """All nodes of the plan by full name."""
    table = fleet.planned.table
    made = stub_nodes(table, fleet.planned.edges)
    for (_, it), stub in zip(running_nodes(table, ()), made, strict=True):
        yield it.full_name, stub


def _process(
    full: str, rules: list[str], fleet: LoadedFleet, stubs: Mapping[str, Stub]
) -> Iterator[Stub]:
    """Yield the node of a process and those that it makes; one that no plan has is there, too."""
    arguments = (ROS_ARGS, *rules) if rules else ()
    own = [it for it in fleet.planned.table.runs if it.full_name == full]
    if not own:
        yield played(full.rpartition("/")[2] or "unnamed", (), arguments=arguments), ()
    for it in own:
        yield _told(stubs[it.full_name], arguments)
        hosted = [
            one
            for one in fleet.planned.table.runs
            if one.robot == it.robot and one.fact.host == it.node and not one.fact.plugin
        ]
        free = tuple(word for word in rules if not word.startswith(("__ns", "__node")))
        for one in hosted:
            stub = stubs[one.full_name]
            placing = _placing(stub[0].arguments)
            yield _told(stub, (ROS_ARGS, *placing, *_paired(free)))


def _paired(words: Iterable[str]) -> list[str]:
    return [word for it in words if ":=" in it for word in ("-r", it)]


def _placing(arguments: Iterable[str]) -> list[str]:
    return _paired(it for it in arguments if it.startswith(("__ns", "__node")))


def _told(stub: Stub, arguments: tuple[str, ...]) -> Stub:
    """Return what helpers in the process get, too, without the name, which their code sets."""
    run, edges = stub
    pairs = (it.split(":=", 1) for it in arguments if ":=" in it and not it.startswith("__node"))
    rules = tuple((old, new) for old, new in pairs)
    return run._replace(arguments=arguments, process_namespace="/", process_rules=rules), edges


def _controller(own: list[str], rules: list[str], stubs: Mapping[str, Stub]) -> Iterator[Stub]:
    """Yield a controller in the namespace of its spawner, with the rules that the spawner hands on."""
    namespace, _ = placed(rules)
    flag = "--controller-ros-args"
    given = own[own.index(flag) + 1].split() if flag in own else []
    place = [*(["-r", f"__ns:={namespace}"] if namespace != "/" else []), "-r", f"__node:={own[0]}"]
    stub = stubs[f"{namespace.rstrip('/')}/{own[0]}"]
    yield _told(stub, (ROS_ARGS, *place, *given))


def _plugins(model: str, fleet: LoadedFleet, stubs: Mapping[str, Stub]) -> Iterator[Stub]:
    (robot,) = (it for it in fleet.plan.robots if it.spec.model == model)
    for it in fleet.planned.table.runs:
        if it.robot == robot.spec.namespace and it.fact.plugin:
            yield stubs[it.full_name]


def _bridge(told: Told, rules: list[str], fleet: LoadedFleet) -> Stub:
    """Return a bridge with the rows of its file, resolved in its namespace. It brings odometry."""
    files = list(told["files"].values())[1:]  # the first one is the program
    sections = [it for text in files for it in (yaml.safe_load(text) or {}).values()]
    (config,) = {
        it["ros__parameters"]["config_file"] for it in sections if "config_file" in str(it)
    }
    rows = yaml.safe_load(Path(config).read_text())
    ends = tuple(
        Endpoint(
            TOPIC,
            role,
            row["topic_name" if "topic_name" in row else "ros_topic_name"],
            row["ros_type_name"],
        )
        for row in rows
        for role in _ROLES[row.get("direction", "BIDIRECTIONAL")]
    )
    sends = any(row["ros_type_name"] == _TF for row in rows)
    edges = tuple(_odometry(Path(config).parent.name, fleet) if sends else ())
    return played("ros_gz_bridge", ends, arguments=(ROS_ARGS, *rules) if rules else ()), edges


def _odometry(name: str, fleet: LoadedFleet) -> Iterator[Edge]:
    """Of the robot whose bridge it is; the bridge of all robots is in no robot's folder."""
    robots = [it for it in fleet.plan.robots if it.spec.name == name]
    for robot in robots or fleet.plan.robots:
        planned = fleet.planned
        _, added = with_odometry(planned.edges, robot.spec.namespace, planned.naming)
        yield from (edge_of(*added.split(" -> ")) for _ in [added] if added)


_TF = "tf2_msgs/msg/TFMessage"
_ROLES = {
    "GZ_TO_ROS": (PUBLISHES,),
    "ROS_TO_GZ": (SUBSCRIBES,),
    "BIDIRECTIONAL": (PUBLISHES, SUBSCRIBES),
}
