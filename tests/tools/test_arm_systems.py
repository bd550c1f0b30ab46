# SPDX-License-Identifier: Apache-2.0
"""Two healthy arms with MoveIt and ros2_control have no finding, in any layout and release.

``fixtures/arm_systems.yaml`` has what the vendors' launch files start, ``fixtures/interfaces/`` what
the sources of these nodes declare. The plan is made from a controllers.yaml and a system model with
the same names; the rules are those of its table.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import yaml
from declared_graph import endpoints, facts
from fleet_folder import planned_fleet
from lxml import etree
from nav2_graphs import environment
from paths import FIXTURES, fixture_text

from multibot_rewrite import compare
from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.base.rosnames import bind, resolve_bound
from multibot_rewrite.fleet.fleet import expected
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.knowledge.parameters import built_in_nodes
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.planning.of_runs import parsed
from multibot_rewrite.planning.records import Run
from multibot_rewrite.system.records import TOPIC, Edge, End, Node, System

LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")
SYSTEMS = yaml.load((FIXTURES / "arm_systems.yaml").read_bytes(), yaml.CSafeLoader)
CASES = [(name, release) for name, it in SYSTEMS.items() for release in it["releases"]]
ROBOTS = ("left", "right")
PUBLISHER = "robot_state_publisher"
# Humble's manager subscribes to it only without the parameter of that name, which the vendors' launch
# files give it (controller_manager.cpp): with all that its sources declare it waits for a publisher.
WAITS = {
    ("humble", f"/{it}{sep}controller_manager/robot_description", f"/{it}/robot_description")
    for it in ROBOTS
    for sep in "/_"
}
# The vendor's launch file leads this client to the controller by a rule (ur_control.launch.py); the
# system here starts it without.
_FOLLOW = "follow_joint_trajectory"
WAITS |= {
    (
        release,
        f"/{it}/motion_controller/{_FOLLOW}",
        f"/{it}{sep}joint_trajectory_controller/{_FOLLOW}",
    )
    for it in ROBOTS
    for sep in "/_"
    for release in ("kilted", "lyrical")
}
ARM = fixture_text("arm_systems_arm.urdf")


@cache
def started(name: str, release: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the nodes and the controllers of a system in a release."""
    system = SYSTEMS[name]
    nodes, controllers = (
        {key: it for key, it in system[part].items() if release in it.get("releases", [release])}
        for part in ("nodes", "controllers")
    )
    return nodes, controllers


def planned(name: str, release: str, layout: str, folder: Path) -> FleetPlan:
    nodes, controllers = started(name, release)
    sections: dict[str, Any] = {
        key: {"ros__parameters": it["params"]} for key, it in controllers.items() if "params" in it
    }
    types = {key: {"type": it.get(release, it["type"])} for key, it in controllers.items()}
    sections["controller_manager"] = {"ros__parameters": types}
    model = {f"/{key}": _model(key, it) for key, it in nodes.items()}
    fleet = {
        "layout": layout,
        "affix": "prefix",
        "distro": release,
        "description": "arm.urdf",
        "launch": ["system.yaml"],
        "related_files": {"params": ["controllers.yaml"]},
        "robots": [{"name": it} for it in ROBOTS],
    }
    texts = {"fleet.yaml": fleet, "controllers.yaml": sections}
    for file, data in (*texts.items(), ("system.yaml", {"structure": {"nodes": model}})):
        (folder / file).write_text(yaml.safe_dump(data, sort_keys=False))
    (folder / "arm.urdf").write_text(ARM)
    return planned_fleet(folder / "fleet.yaml", trust=True)


def _model(name: str, it: dict[str, Any]) -> dict[str, Any]:
    package, executable = it["runs"].split("/")
    return {"pkg": package, "exec": executable, "node_name": name, "params": it.get("params", {})}


def kinds(name: str, release: str) -> dict[str, str]:
    """Every node that runs -> the node of the facts that it is."""
    nodes, controllers = started(name, release)
    types = built_in_nodes(release).types
    loaded = {key: types[it.get(release, it["type"])] for key, it in controllers.items()}
    return {**{it: it for it in nodes}, **loaded}


def played(name: str, release: str, plan: FleetPlan) -> System:
    """Return the graph of all nodes that run, with what their sources declare."""
    placed = {(it.robot, it.node): it for it in plan.fleet.table.runs}
    known: dict[str, NodeFacts] = {it.name: it for it in plan.fleet.facts}
    ends: list[End] = []
    nodes: list[str] = []
    for robot in ROBOTS:
        for node, kind in kinds(name, release).items():
            at = placed[robot, node]
            nodes.append(f"{at.namespace.rstrip('/')}/{at.name}")
            there = known.get(node, built_in(release).nodes[kind])
            ends += endpoints(kind, there, at, release) if kind in facts(release) else ()
    if release in ("lyrical", "rolling"):
        # hardware_component_interface.cpp:119-133: each component is a node beside the manager's.
        for robot in plan.robots:
            manager = placed[robot.spec.name, "controller_manager"]
            names = re.findall(r'<ros2_control name="([^"]+)"', str(robot.description))
            nodes += [f"{manager.namespace.rstrip('/')}/{it.lower()}" for it in names]
    owners = dict.fromkeys([*nodes, *(it.node for it in ends)])
    frames = [
        frame
        for robot in plan.robots
        for frame in _tree(robot.description, placed[robot.spec.name, PUBLISHER])
    ]
    frames += [
        _pose(frame, it["params"])
        for it in started(name, release)[1].values()
        if it["type"] == "pose_broadcaster/PoseBroadcaster"
        for frame in frames
        if not frame.static
    ]
    return System(tuple(map(_node, owners)), tuple(ends), tuple(frames), environment())


def _pose(beside: Edge, params: dict[str, str]) -> Edge:
    """Return what pose_broadcaster sends: its frames are spelled as the links are."""
    child = beside.parent.replace(params["frame_id"], params["tf.child_frame_id"])
    return beside._replace(child=child)


def _node(name: str) -> Node:
    return Node(name, name)


def _tree(description: bytes, publisher: Run) -> Iterator[Edge]:
    """Yield what robot_state_publisher sends of a description."""
    bound = bind(publisher.name, publisher.namespace, parsed(publisher.rules))
    for joint in etree.fromstring(description).findall("joint"):
        fixed = joint.get("type") == "fixed"
        topic = resolve_bound("/tf_static" if fixed else "/tf", TOPIC, bound)
        parent, child = (joint.find(it).get("link") for it in ("parent", "child"))
        node = f"{publisher.namespace.rstrip('/')}/{publisher.name}"
        yield Edge(child, parent, topic, fixed, (node,))


def told(plan: FleetPlan, seen: System, release: str = "") -> list[str]:
    found = (it for it in compare(expected(plan.fleet), seen) if (release, *it.names) not in WAITS)
    return [f"{it.code} {it.node} {it.message}" for it in found]


@pytest.mark.more
@pytest.mark.sample(5)
@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize(("name", "release"), CASES)
def test_two_healthy_arms(name: str, release: str, layout: str, tmp_path: Path) -> None:
    plan = planned(name, release, layout, tmp_path)
    assert told(plan, played(name, release, plan), release) == []


@pytest.fixture(scope="module")
def ur(tmp_path_factory: pytest.TempPathFactory) -> tuple[FleetPlan, System]:
    plan = planned("ur", "jazzy", "both", tmp_path_factory.mktemp("ur"))
    return plan, played("ur", "jazzy", plan)


@pytest.mark.more
@pytest.mark.parametrize(
    ("node", "code"), [("dashboard_client", "MG101"), ("io_and_status_controller", "MG101")]
)
def test_a_node_that_is_gone_is_found(node: str, code: str, ur: tuple[FleetPlan, System]) -> None:
    plan, seen = ur
    gone = f"/right/{node}"
    left = seen._replace(
        nodes=tuple(it for it in seen.nodes if it.name != gone),
        ends=tuple(it for it in seen.ends if it.node != gone),
    )
    assert [it[:5] for it in told(plan, left)] == [code]


@pytest.mark.parametrize(
    ("name", "other"),
    [
        # The state helper of one arm asks the other.
        ("/left/io_and_status_controller/robot_mode", "/right/io_and_status_controller/robot_mode"),
        # Its rule is lost: it acts on whatever tool_contact_controller there is.
        ("/left/force_mode_controller/start_force_mode", "/force_mode_controller/start_force_mode"),
    ],
)
def test_a_name_that_goes_astray_is_found(
    name: str, other: str, ur: tuple[FleetPlan, System]
) -> None:
    plan, seen = ur
    moved = (it._replace(name=other) if it.name == name else it for it in seen.ends)
    assert any(
        it.startswith(("MG305", "MG311", "MG321"))
        for it in told(plan, seen._replace(ends=tuple(moved)))
    )


def test_every_node_of_the_systems_has_facts() -> None:
    assert len(CASES) == 14
    lacking = {
        (release, kind)
        for name, release in CASES
        for kind in kinds(name, release).values()
        if kind not in facts(release)
    }
    assert lacking == set()


# Every controller type that packages register is known, in the releases that have it.

ROWS = [
    line.split("\t")
    for line in (FIXTURES / "interfaces/controller_types.tsv").read_text().splitlines()[1:]
]
# These have a branch for every release.
WHOLE = ("ros2_controllers", "Universal_Robots_ROS2_Driver")


@pytest.mark.parametrize("release", RELEASES)
def test_a_registered_type_is_known(release: str) -> None:
    nodes, types = built_in(release).nodes, built_in_nodes(release).types
    there = {type_ for type_, _, releases in ROWS if release in releases.split()}
    assert len(there) >= 35
    assert sorted(it for it in there if types.get(it) not in nodes) == []


@pytest.mark.parametrize("release", RELEASES)
def test_no_controller_of_another_release_is_known(release: str) -> None:
    nodes, types = built_in(release).nodes, built_in_nodes(release).types
    every = {types[type_] for type_, repository, _ in ROWS if repository in WHOLE}
    there = {types[type_] for type_, _, releases in ROWS if release in releases.split()}
    assert sorted((every & nodes.keys()) - there) == []
