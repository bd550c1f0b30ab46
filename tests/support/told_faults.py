# SPDX-License-Identifier: Apache-2.0
"""Faults of ``fixtures/told_faults.txt``: a graph, its healthy twin, the words to be said of it.

``python tests/support/told_faults.py`` prints which commands find which.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache, reduce
from typing import NamedTuple

from fault_changes import nav, shared_tf, simulation
from graph_cases import moved, qos, reframed, sent, without_node
from healthy_systems import arms, single, slam_with_filters, with_ends, with_mux, with_node
from node_answers import told
from open_faults import heard_all_but
from patches import remapped
from paths import ROOT

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, Remap
from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.live.seen_plan import seen_plan
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.parameters import with_answers
from multibot_rewrite.system.records import Edge, Heard, Lookup, Parameter, System

FILE = ROOT / "fixtures" / "told_faults.txt"
SYSTEMS: Mapping[str, Callable[[], System]] = {
    "single": single,
    "nav": nav,
    "shared": shared_tf,
    "sim": simulation,
    "slam": slam_with_filters,
    "mux": with_mux,
    "arms": arms,
}
PACKAGES = {
    "sensor_msgs/msg": "LaserScan Image PointCloud2 PointCloud Joy Imu MagneticField BatteryState "
    "Range CameraInfo NavSatFix JointState CompressedImage",
    "nav_msgs/msg": "Odometry OccupancyGrid",
    "geometry_msgs/msg": "Twist TwistStamped PoseStamped PoseWithCovarianceStamped",
    "std_msgs/msg": "Bool String Float64MultiArray",
    "std_srvs/srv": "Trigger Empty",
    "trajectory_msgs/msg": "JointTrajectory",
    "ackermann_msgs/msg": "AckermannDriveStamped",
    "tf2_msgs/msg": "TFMessage",
    "lifecycle_msgs/srv": "ChangeState",
    "control_msgs/action": "GripperCommand FollowJointTrajectory",
    "nav2_msgs/action": "NavigateToPose NavigateThroughPoses FollowWaypoints",
    "nav2_msgs/srv": "ClearEntireCostmap",
    "nav2_msgs/msg": "SpeedLimit CostmapFilterInfo",
    "slam_toolbox/srv": "SaveMap",
}
TYPES = {name: f"{package}/{name}" for package, names in PACKAGES.items() for name in names.split()}


class Told(NamedTuple):
    """``bad`` and ``twin`` are steps; ``says`` are words of one error or warning; ``unknown`` to these
    commands, ``doctor`` or ``check``."""

    name: str
    on: str
    bad: tuple[str, ...]
    twin: tuple[str, ...]
    says: tuple[str, ...]
    unknown: tuple[str, ...] = ()

    def faulty(self) -> System:
        return _made(self.on, self.bad)

    def healthy(self) -> System:
        return _made(self.on, self.twin)


def read(text: str) -> Iterator[Told]:
    lines = "\n".join(it for it in text.splitlines() if not it.startswith("#"))
    for block in filter(None, (it.strip() for it in lines.split("\n\n"))):
        name, *rest = block.splitlines()
        words = [line.split(" ", 1) for line in rest]
        of = {key: tuple(w[1] for w in words if w[0] in key.split()) for key in KEYS}
        on, bad, twin, says, unknown = of.values()
        yield Told(name, on[0], bad, twin, tuple(says[0].split()), unknown)


# What is otherwise than in the plan.
DEVIATIONS = ("MG101", "MG102", "MG108", "MG204", "MG306", "MG406")
KEYS = ("on", "both bad", "both twin", "says", "unknown")


@cache
def faults() -> tuple[Told, ...]:
    return tuple(read(FILE.read_text()))


def _made(on: str, steps: tuple[str, ...]) -> System:
    return sent(reduce(_step, steps, _system(on)))


@cache
def _system(on: str) -> System:
    return SYSTEMS[on]()


def _step(graph: System, step: str) -> System:
    verb, *words = step.split()
    return STEPS[verb](graph, *words)


def _add(graph: System, node: str, role: str, name: str, type_: str) -> System:
    there = any(it.name == node for it in graph.nodes)
    return (with_ends if there else with_node)(graph, node, (role, name, TYPES[type_]))


def _cut(graph: System, node: str, name: str) -> System:
    kept = tuple(it for it in graph.ends if (it.node, it.name) != (node, name))
    assert len(kept) < len(graph.ends), (node, name)
    return graph._replace(ends=kept)


def _tf(graph: System, parent: str, child: str, topic: str) -> System:
    more = Edge(child, parent, topic, "static" in topic, ())
    return graph._replace(edges=(*graph.edges, more))


def _edges(graph: System, child: str, topic: str, **change: object) -> System:
    """Return the transforms of a frame, on a topic or on all, changed or without a change left out."""

    def one(it: Edge) -> Edge | None:
        if it.child != child or (topic and it.topic != topic):
            return it
        return it._replace(**change) if change else None  # type: ignore[arg-type]

    return reframed(one)(graph)


def _at(graph: System, child: str, *words: str) -> System:
    numbers, rest = words[:7], words[7:]
    return _edges(graph, child, "".join(rest), transform=tuple(map(float, numbers)))


def _qos(graph: System, name: str, role: str, *words: str) -> System:
    given = dict(it.split("=") for it in words)
    values = {k: float(v) if k == "deadline" else v for k, v in given.items()}
    ends = (
        it._replace(qos=qos(**values)) if (it.name, it.role) == (name, role) else it
        for it in graph.ends
    )
    return graph._replace(ends=tuple(ends))


def _type(graph: System, name: str, type_: str) -> System:
    ends = (it._replace(type=TYPES[type_]) if it.name == name else it for it in graph.ends)
    return graph._replace(ends=tuple(ends))


def _heard(graph: System, topic: str, frame: str, age: str = "0") -> System:
    return graph._replace(heard=(*graph.heard, Heard(topic, frame, float(age))))


def _set(graph: System, node: str, name: str, value: str) -> System:
    return graph._replace(parameters=(*graph.parameters, Parameter(node, name, value)))


STEPS: Mapping[str, Callable[..., System]] = {
    "add": _add,
    "drop": without_node,
    "cut": _cut,
    "space": lambda graph, node, space: remapped(graph, [Remap(node, "__ns", space)]),
    "name": lambda graph, old, new, node="": moved(graph, old, new, node),
    "tf": _tf,
    "cuttf": lambda graph, child, topic="": _edges(graph, child, topic),
    "reparent": lambda graph, child, parent, topic="": _edges(graph, child, topic, parent=parent),
    "at": _at,
    "twice": lambda graph, child: _edges(graph, child, "", several=True),
    "heard": _heard,
    "silent": heard_all_but(),
    "ask": lambda graph, *words: graph._replace(lookups=(*graph.lookups, Lookup(*words))),
    "set": _set,
    "state": lambda graph, node, label: with_answers(graph, (told(node, label),)),
    "qos": _qos,
    "type": _type,
}


def by_doctor(graph: System) -> tuple[Finding, ...]:
    return diagnose(graph).findings


def by_check(plan: System, graph: System) -> tuple[Finding, ...]:
    """With the plan of the twin, as ``check --suggest`` begins one."""
    return tuple(check(seen_plan(diagnose(plan)), graph))


def tells(fault: Told, found: Iterable[Finding]) -> bool:
    """Return whether one error or warning has all the words. If it says what is not as planned,
    two of them are enough: the plan says the rest."""
    words = [re.compile(rf"(?<!\w){re.escape(it)}(?![\w/])", re.IGNORECASE) for it in fault.says]
    return any(
        sum(bool(word.search(f"{it} {it.hint}")) for word in words)
        >= (2 if it.code in DEVIATIONS else len(fault.says))
        for it in found
        if it.level in (ERROR, WARNING)
    )


def _line(fault: Told) -> str:
    bad, twin = fault.faulty(), fault.healthy()
    doctor, planned = by_doctor(bad), by_check(twin, bad)
    marks = "".join(
        mark if tells(fault, it) else "-" for mark, it in (("D", doctor), ("C", planned))
    )
    return f"{marks} {fault.name}: {' '.join(sorted({it.code for it in (*doctor, *planned)}))}"


if __name__ == "__main__":
    for one in faults():
        print(_line(one), flush=True)
