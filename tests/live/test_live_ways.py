"""A rehearsal gives each rule where it stands: what a release does not hand on is found missing."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from subprocess import CompletedProcess

import live_commands
import live_fleet
import pytest
from live_commands import PATIENTLY
from paths import ROBOTS

pytestmark = pytest.mark.live

pytest.importorskip("rclpy", reason="no rclpy: pip install '.[ros]'", exc_type=ImportError)
FLEET = """\
layout: tf-per-robot
distro: {release}
stack: {stack}
robots:
  - {{name: robot1, description: {robot}}}
  - {{name: robot2, description: {robot}}}
"""
CONTROLLERS, NONE = "gz_ros2_control", "robot_state"
# Of a rehearsal: release, stack, what is left out.
AT_SPAWNER = ("lyrical", CONTROLLERS, "")
TAG_ALONE = ("lyrical", CONTROLLERS, "spawner")
UNKNOWN = ("lyrical", NONE, "")
FORWARDED = ("jazzy", CONTROLLERS, "spawner")
FORWARDED_TO_UNKNOWN = ("jazzy", NONE, "")
NOWHERE = ("jazzy", CONTROLLERS, "spawner,plugin")
COMPOSED = ("jazzy", "nav2_composed", "")
LEAKING = {TAG_ALONE: "diff_drive_controller", UNKNOWN: "controller_manager"}
LEAKING[NOWHERE] = "diff_drive_controller"
ALL = (AT_SPAWNER, TAG_ALONE, UNKNOWN, FORWARDED, FORWARDED_TO_UNKNOWN, NOWHERE, COMPOSED)
Case = tuple[str, str, str]


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> dict[Case, CompletedProcess[str]]:
    """All rehearsals, side by side: most of it is waiting."""
    folder = tmp_path_factory.mktemp("ways")

    def run(at: int, case: Case) -> CompletedProcess[str]:
        return _rehearsed(folder, at, case)

    with ThreadPoolExecutor() as pool:
        return dict(zip(ALL, pool.map(run, range(len(ALL)), ALL), strict=True))


def _rehearsed(folder: Path, at: int, case: Case) -> CompletedProcess[str]:
    release, stack, left_out = case
    file = folder / f"fleet{at}.yaml"
    robot = ROBOTS / "rover_gz.urdf"
    file.write_text(FLEET.format(release=release, stack=stack, robot=robot))
    domain = live_commands.domain(90 + at)
    words = ["rehearse", str(file), "--domain", domain, "--ignore", "MB425", *PATIENTLY]
    words += ["--without-rules", left_out] if left_out else []
    return live_commands.multibot(*words, env=live_fleet.environ(domain))


@pytest.mark.parametrize("case", [it for it in ALL if it not in LEAKING])
def test_what_a_release_hands_on_is_as_planned(
    case: Case, done: dict[Case, CompletedProcess[str]]
) -> None:
    # That the rover has two senders of odometry, or of joint states, is said as well.
    assert done[case].returncode == 0, done[case].stdout
    assert ": as planned" in done[case].stderr
    assert not {" MG1", " MG2"} & {it[:4] for it in done[case].stdout.split(":")}


@pytest.mark.parametrize("case", list(LEAKING))
def test_what_it_does_not_hand_on_leaks(
    case: Case, done: dict[Case, CompletedProcess[str]]
) -> None:
    assert done[case].returncode == 1, done[case].stderr
    node = f"/robot1/{LEAKING[case]}"
    assert f"{node}: error: MG102 should publish topic /robot1/tf" in done[case].stdout
