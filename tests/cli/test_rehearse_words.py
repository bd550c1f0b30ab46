# SPDX-License-Identifier: Apache-2.0
"""What ``multibot rehearse`` adds to the plan, because a driver or a simulator would send it."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.cli import multibot, rehearse
from multibot_rewrite.system.records import System

TWO_LINKS = """<robot name="r"><link name="base_link"/><link name="arm"/>
<joint name="j" type="fixed"><parent link="base_link"/><child link="arm"/></joint></robot>"""


@pytest.mark.parametrize(
    ("node_set", "added"),
    [
        # It sends map -> odom, and no node of the set what is between odom and the robot.
        ("slam_toolbox", ["odom -> base_link of left"]),
        ("robot_state", []),
    ],
)
def test_odometry_that_a_driver_sends_is_named_with_its_robot(
    node_set: str,
    added: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The robot is called by its name, not by its namespace."""
    (tmp_path / "r.urdf").write_text(TWO_LINKS)
    fleet = f"description: r.urdf\nlayout: tf-per-robot\nnode_sets: {node_set}\ndistro: jazzy\n"
    (tmp_path / "fleet.yaml").write_text(f"{fleet}robots: [{{name: left, namespace: x/l}}]\n")
    monkeypatch.setattr(rehearse, "_play", lambda *_: ({rehearse.ONE: System()}, {}))
    multibot.main(["rehearse", str(tmp_path / "fleet.yaml")])
    said = [it for it in capsys.readouterr().err.splitlines() if "the rehearsal sends it" in it]
    end = " comes from a driver or simulator; the rehearsal sends it"
    assert said == [f"multibot: note: {it}{end}" for it in added]
