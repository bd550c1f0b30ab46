# SPDX-License-Identifier: Apache-2.0
"""Two arms of one description move by their own trajectories, whatever moves their joints: what a
client sends to a controller arrives there and at no other arm's, and joint states are those of its own
arm."""

from __future__ import annotations

from itertools import product
from pathlib import Path
from typing import NamedTuple

import fleet
import pytest
import rcl_names
import verdict
from node_set_cells import LAYOUTS, shares_rules
from paths import ROOT

from multibot_rewrite.base.releases import RELEASES, has_release
from multibot_rewrite.cli import multibot

pytestmark = [pytest.mark.live, rcl_names.needed()]
EXAMPLE = ROOT / "examples/two_arms_moveit"
MOCK = "mock_components/GenericSystem"
PARAMETERS = "<parameters>controllers.yaml</parameters>"
JOINTS = {"arm_controller": ("shoulder_joint", "elbow_joint"), "hand_controller": ("finger_joint",)}


class Arm(NamedTuple):
    """What moves the joints: its hardware, what a simulator loads, and the set that starts it."""

    node_set: str
    simulator: str
    hardware: str = ""
    plugins: str = ""


SYSTEMS = "".join(
    '<plugin filename="gz-sim-joint-trajectory-controller-system" '
    f'name="gz::sim::systems::JointTrajectoryController"><topic>{name}/joint_trajectory</topic>'
    f"{''.join(f'<joint_name>{it}</joint_name>' for it in joints)}</plugin>"
    for name, joints in JOINTS.items()
)
ARMS = {
    "mock": Arm("ros2_control", "none", MOCK),
    "gz": Arm(
        "gz_ros2_control",
        "gazebo",
        "gz_ros2_control/GazeboSimSystem",
        '<plugin filename="gz_ros2_control-system" '
        f'name="gz_ros2_control::GazeboSimROS2ControlPlugin">{PARAMETERS}</plugin>',
    ),
    "classic": Arm(
        "gazebo_ros2_control",
        "gazebo",
        "gazebo_ros2_control/GazeboSystem",
        '<plugin filename="libgazebo_ros2_control.so" name="gazebo_ros2_control">'
        f"{PARAMETERS}</plugin>",
    ),
    # gz-sim moves the joints itself, and sends their states.
    "system": Arm(
        "robot_state",
        "gazebo",
        plugins=SYSTEMS + '<plugin filename="gz-sim-joint-state-publisher-system" '
        'name="gz::sim::systems::JointStatePublisher"/>',
    ),
}
MOVEIT = ("", "moveit", "moveit, rviz_moveit")
ROWS = [
    (arm, more, release)
    for arm, more, release in product(ARMS, MOVEIT, RELEASES)
    if (arm != "classic" or has_release("humble", release)) and not (arm == "system" and more)
]


def description(arm: Arm) -> str:
    """Return the arm of the example with what moves its joints."""
    text = (EXAMPLE / "arm.urdf").read_text()
    before, _, rest = text.partition("<ros2_control")
    control, end, after = rest.partition("</ros2_control>")
    control = f"<ros2_control{control}{end}".replace(MOCK, arm.hardware) if arm.hardware else ""
    gazebo = f"<gazebo>{arm.plugins}</gazebo>" if arm.plugins else ""
    return f"{before}{control}{after}".replace("</robot>", f"{gazebo}</robot>")


def fleet_of(arm: Arm, more: str, release: str, layout: str) -> str:
    """Return the text of the fleet file of two such arms, with the files that an arm has."""
    node_set = ", ".join(filter(None, (arm.node_set, more)))
    files = ["params: controllers.yaml"] if arm.hardware else []
    files += ["moveit: [kinematics.yaml, moveit_controllers.yaml]"] if more else []
    poses = [f", pose: {{y: {y}}}" if arm.simulator == "gazebo" else "" for y in (0.0, 3.0)]
    return (
        f"distro: {release}\nlayout: {layout}\nsimulator: {arm.simulator}\nnode_sets: [{node_set}]\n"
        f"description: arm.urdf\n{f'srdf: {EXAMPLE}/arm.srdf' if more else ''}\n"
        f"robots: [{{name: left{poses[0]}}}, {{name: right{poses[1]}}}]\n"
        f"related_files: {{{', '.join(files)}}}\n"
    )


@pytest.mark.sample(13)
@pytest.mark.parametrize("row", ROWS, ids=["-".join(it) for it in ROWS])
def test_an_arm_moves_alone(
    row: tuple[str, str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arm, more, release = ARMS[row[0]], row[1], row[2]
    (tmp_path / "arm.urdf").write_text(description(arm))
    for name in ("controllers", "kinematics", "moveit_controllers"):
        (tmp_path / f"{name}.yaml").write_text((EXAMPLE / f"{name}.yaml").read_text())
    wrong = {}
    for layout in LAYOUTS:
        # move_group reads the links as the URDF has them: build refuses this (MF837).
        if layout == "frame-prefix" and more:
            continue
        (tmp_path / "fleet.yaml").write_text(fleet_of(arm, more, release, layout))
        out = tmp_path / layout
        command = ["build", str(tmp_path / "fleet.yaml"), "-o", str(out), "-q"]
        if arm.simulator == "gazebo" and arm.hardware and shares_rules(release, layout):
            assert multibot.main(command) == 1
            assert "left and right publish on /joint_states/" in capsys.readouterr().err
            continue
        assert multibot.main(command) == 0
        found = fleet.read(out, release)
        faults = verdict.judged(found)
        done = {it: words.get("drives") for it, words in verdict.done(found).items()}
        moved = {name for it in ("left", "right") for name in moved_by(found, it)}
        if faults or done != {"left": "yes", "right": "yes"} or len(moved) != 2 * ends_of(arm):
            wrong[layout] = (faults, done, found.unknown, moved)
    assert not wrong


def ends_of(arm: Arm) -> int:
    """So many topics and actions a client of one arm has: both of each controller of ros2_control, a
    topic of each system of gz-sim."""
    return len(JOINTS) * (2 if arm.hardware else 1)


def moved_by(found: fleet.Fleet, robot: str) -> set[tuple[str, str, str]]:
    """Return what moves an arm, where that moves no other one."""
    own = {it for it in verdict.heard(found) if it[0] == robot}
    return {it for it in own if verdict.reached(found, *it[1:]) == {robot}}
