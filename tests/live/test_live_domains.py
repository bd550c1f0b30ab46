# SPDX-License-Identifier: Apache-2.0
"""``check`` and ``rehearse`` of robots in ROS domains of their own, before real nodes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import live_commands
import live_fleet
import pytest
from live_commands import TEXT
from paths import ROBOTS
from plans import PlannedRobot, planned, planned_end

from multibot_rewrite.planning.domain_bridge import with_bridges
from multibot_rewrite.planning.plan import to_yaml
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, TOPIC, Domain

pytestmark = pytest.mark.live

pytest.importorskip("rclpy", reason="no rclpy: pip install '.[ros]'", exc_type=ImportError)
ALL, FIRST, SECOND = (live_commands.domain(60 + at) for at in range(3))
FLEET = f"""\
layout: tf-per-robot
description: {ROBOTS / "rover.urdf"}
node_sets: robot_state
simulator: none
domains: {{robot1: 11, robot2: 12}}
crossing: robot_description
robots: [{{name: robot1}}, {{name: robot2}}]
"""


def write_plan(folder: Path) -> Path:
    """Two robots, each in its domain, and a monitor of all that reads their odometry."""
    names = ("robot1", "robot2")
    robots = [PlannedRobot(it, (f"/{it}/drive",), (), f"/{it}/tf") for it in names]
    ends = []
    for it in names:
        odom = (f"/{it}/odom", TEXT, "odom")
        ends.append(planned_end(f"/{it}/drive", TOPIC, PUBLISHES, *odom))
        ends.append(planned_end("/monitor", TOPIC, SUBSCRIBES, *odom))
    plan = planned("both", robots, ("/monitor",), live_commands.SHARED, ("map",), tuple(ends))
    domains = (Domain("", ALL), Domain("robot1", FIRST), Domain("robot2", SECOND))
    path = folder / "plan.yaml"
    path.write_text(to_yaml(with_bridges(plan._replace(domains=domains))))
    return path


def node(name: str, space: str = "/", **ends: list[list[str]]) -> dict[str, Any]:
    return {"name": name, "namespace": space, "bare": True, **ends}


def robot(name: str, number: int) -> list[dict[str, Any]]:
    """Return a robot with its end of the bridge, and a tool that both domains have."""
    bridge = f"{name}_bridge"
    odom = [f"/{name}/odom", "String"]
    return [
        node("drive", f"/{name}", publishers=[odom]),
        node(bridge),
        node(f"{bridge}_{number}", subscriptions=[odom]),
        node("rviz2", publishers=[["/initialpose", "String"]]),
    ]


def shared(*bridged: str) -> list[dict[str, Any]]:
    odoms = [[f"/{it}/odom", "String"] for it in ("robot1", "robot2")]
    bridges = [node(f"{it}_bridge_{ALL}", publishers=[[f"/{it}/odom", "String"]]) for it in bridged]
    return [node("monitor", subscriptions=odoms), *bridges]


def test_each_domain_is_looked_at_and_what_does_not_cross_is_told(tmp_path: Path) -> None:
    plan = write_plan(tmp_path)
    words = ("check", plan, *live_commands.PATIENTLY)
    with (
        live_fleet.running(FIRST, robot("robot1", FIRST)),
        live_fleet.running(SECOND, robot("robot2", SECOND)),
    ):
        with live_fleet.running(ALL, shared("robot1", "robot2")):
            done = live_commands.multibot(*words, env=live_fleet.environ(ALL))
            assert (done.returncode, done.stdout) == (0, ""), done.stdout + done.stderr
        with live_fleet.running(ALL, shared("robot1")):
            done = live_commands.multibot(*words, env=live_fleet.environ(ALL))
            assert done.returncode == 1, done.stdout + done.stderr
            assert f"/robot2_bridge_{ALL}" in done.stdout
            assert f"in domain {ALL}" in done.stdout
            assert "MG301" not in done.stdout
            alone = ("check", "--domain", f"{FIRST},{SECOND}", *live_commands.PATIENTLY)
            done = live_commands.multibot(*alone, env=live_fleet.environ(ALL))
            assert done.returncode == 0, done.stdout + done.stderr
            assert f"domain {FIRST}: " in done.stderr and f"domain {SECOND}: " in done.stderr
            one = (*words, "--domain", SECOND)
            done = live_commands.multibot(*one, env=live_fleet.environ(ALL))
            assert (done.returncode, done.stdout) == (0, ""), done.stdout + done.stderr


def test_a_rehearsal_plays_every_domain(tmp_path: Path) -> None:
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(FLEET)
    words = ("rehearse", fleet, "--domain", ALL, *live_commands.PATIENTLY)
    done = live_commands.multibot(*words, env=live_fleet.environ(ALL))
    assert done.returncode == 0, done.stdout + done.stderr
    assert f"nodes in domains {ALL}, " in done.stderr
    assert "as planned" in done.stderr
