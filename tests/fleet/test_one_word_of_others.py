# SPDX-License-Identifier: Apache-2.0
"""Bridge, check and lint say of a node what the plan and the written files say, for random files."""

from __future__ import annotations

import random
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml
from fleet_folder import planned_fleet
from graph_cases import as_planned
from random_parameters import LAYOUTS, NODE_SETS, RELEASE, planned, random_file

from multibot_rewrite import compare
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.checks.closed_plan import closed_plan
from multibot_rewrite.fleet.fleet import expected
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.rules.settings import Settings
from multibot_rewrite.system.records import System

pytestmark = pytest.mark.slow

# Rules about names: one node under another topic, of another robot, or not there. In random files two
# nodes of other types may have one topic, which is told, and is right.
NAMES = ("MG101", "MG102", "MG310", "MG311", "MG320", "MG321", "MG301", "MG307", "MG108")


@pytest.mark.parametrize("seed", range(8))
def test_a_graph_as_planned_has_no_finding(seed: int, tmp_path: Path) -> None:
    draw = random.Random(seed)
    text, node_set = random_file(draw), draw.choice(NODE_SETS)
    made, _ = planned(
        tmp_path, text, LAYOUTS[seed % 4], draw.choice(("prefix", "postfix")), node_set
    )
    plan = expected(made.fleet)
    found = [it for it in compare(plan, as_planned(plan)) if it.code in NAMES]
    assert found == [], (node_set, text)


SCAN = "sensor_msgs/msg/LaserScan"
SENSORS = ("scan", "/scan", "front/scan", "/front/points")
ROVER = """\
<robot name="rover">
  <link name="base_link"/>
  <gazebo reference="base_link">
    <sensor name="lidar" type="gpu_lidar"><topic>{0}</topic></sensor>
  </gazebo>
</robot>
"""
FLEET = """\
layout: {layout}
affix: {affix}
distro: {release}
description: robot.urdf
related_files: {{params: p.yaml{more}}}
robots: [{{name: robot1}}, {{name: robot2}}]
"""


def bridged(folder: Path, layout: str, affix: str, row: str, read: str) -> tuple[System, list[str]]:
    """Return the plan of a fleet with a bridge and a reader, and the names in the written rows."""
    (folder / "robot.urdf").write_text(ROVER.format(row))
    (folder / "p.yaml").write_text(f"slam_toolbox:\n  ros__parameters: {{scan_topic: {read}}}\n")
    words = {"gz_topic_name": row, "ros_topic_name": row, "direction": "GZ_TO_ROS"}
    types = {"ros_type_name": SCAN, "gz_type_name": "gz.msgs.LaserScan"}
    (folder / "b.yaml").write_text(yaml.safe_dump([words | types]))
    text = FLEET.format(layout=layout, affix=affix, release=RELEASE, more=", bridge: b.yaml")
    (folder / "fleet.yaml").write_text(text)
    plan = planned_fleet(folder / "fleet.yaml")
    files = [it for it in make_outputs(plan).files if it.path.endswith("bridge.yaml")]
    rows = [row for it in files for row in yaml.safe_load(it.data) or []]
    scans = (it["ros_topic_name"] for it in rows if it["ros_type_name"] == SCAN)
    return expected(closed_plan(plan)), [f"/{it.lstrip('/')}" for it in scans]


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("seed", range(3))
def test_who_met_the_bridge_before_meets_it_after(layout: str, seed: int, tmp_path: Path) -> None:
    """ros_gz_bridge publishes ros_topic_name, slam_toolbox reads scan_topic, both resolved by rcl."""
    draw = random.Random(f"{layout} {seed}")
    row = draw.choice(SENSORS)
    read = draw.choice((row, row.strip("/"), *SENSORS))
    plan, rows = bridged(tmp_path, layout, draw.choice(("prefix", "postfix")), row, read)
    readers = {it.name for it in plan.ends if it.node.endswith("slam_toolbox") or "slam" in it.node}
    meet = row.lstrip("/") == read.lstrip("/")
    assert len(set(rows)) == 2
    assert (set(rows) <= readers) == meet, (row, read, rows)
    assert set(rows) == {it.name for it in plan.topics if it.bridge and it.type == SCAN}


JOINTS, INTERFACES = ("a", "b", "c"), ("position", "velocity", "effort")


def random_arm(draw: random.Random) -> tuple[str, str]:
    """Return a description with the hardware of some joints, and controllers of some."""
    links = '<link name="l0"/>'
    joints, hardware = "", ""
    for at, name in enumerate(JOINTS):
        links += f'<link name="l{at + 1}"/>\n'
        ends = f'<parent link="l{at}"/><child link="l{at + 1}"/>'
        joints += f'<joint name="{name}" type="continuous">{ends}</joint>\n'
        own = "".join(
            f'<command_interface name="{it}"/>\n<state_interface name="{it}"/>\n'
            for it in draw.sample(INTERFACES, 2)
        )
        hardware += f'<joint name="{name}">{own}</joint>\n'
    system = f'<ros2_control name="s" type="system">{hardware}</ros2_control>'
    loads = "<parameters>p.yaml</parameters>"
    plugin = f'<plugin name="p" filename="gz_ros2_control-system">{loads}</plugin>'
    body = f"{links}{joints}{system}<gazebo>{plugin}</gazebo>"
    return f'<robot name="arm">{body}</robot>', "".join(_controllers(draw))


def _controllers(draw: random.Random) -> Iterator[str]:
    names = ("one", "two", "three")
    yield "controller_manager:\n  ros__parameters:\n"
    for it in names:
        yield f"    {it}: {{type: joint_trajectory_controller/JointTrajectoryController}}\n"
    for it in names:
        chosen = ", ".join(draw.sample(JOINTS, 2))
        both = [draw.choice(INTERFACES), draw.choice(INTERFACES)]
        yield f"{it}:\n  ros__parameters:\n    joints: [{chosen}]\n"
        yield f"    command_interfaces: [{both[0]}]\n    state_interfaces: [{both[1]}]\n"


@pytest.mark.sample(1)
@pytest.mark.parametrize("seed", range(8))
def test_the_lint_finds_what_a_plan_finds(seed: int, tmp_path: Path) -> None:
    draw = random.Random(seed)
    description, controllers = random_arm(draw)
    (tmp_path / "robot.urdf").write_text(description)
    (tmp_path / "p.yaml").write_text(controllers)
    more = {"layout": LAYOUTS[seed % 4], "affix": "prefix", "release": RELEASE, "more": ""}
    (tmp_path / "fleet.yaml").write_text(FLEET.format(**more))
    plan = planned_fleet(tmp_path / "fleet.yaml")
    open_ = [it for it in closed_plan(plan).gaps if it.code == "MB229"]
    said = {(Path(it.file).name, it.line, it.message.partition(" ")[0]) for it in open_}
    settings = Settings(select=("MB229",), distro=RELEASE)
    linted = [it.message.split(" ") for it in lint_file(str(tmp_path / "robot.urdf"), settings)]
    found = {(at.partition(":")[0], int(at.split(":")[1]), name) for at, name, *_ in linted}
    assert found == said
