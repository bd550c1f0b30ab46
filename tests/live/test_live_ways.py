# SPDX-License-Identifier: Apache-2.0
"""A rehearsal gives each rule where it stands: what a release does not hand on is found missing."""

from __future__ import annotations

from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any

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
USUAL = (AT_SPAWNER, NOWHERE)
Case = tuple[str, str, str]


def rows(cases: Iterable[Case]) -> list[Any]:
    return [pytest.param(it, marks=[] if it in USUAL else [pytest.mark.deep]) for it in cases]


@pytest.fixture(scope="module")
def done(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> dict[Case, CompletedProcess[str]]:
    """The rehearsals that are asked for, side by side: most of it is waiting."""
    folder = tmp_path_factory.mktemp("ways")
    asked = [it.callspec.params.get("case") for it in request.session.items if _is_here(it)]

    def run(at: int, case: Case) -> CompletedProcess[str]:
        return _rehearsed(folder, at, case)

    with ThreadPoolExecutor() as pool:
        cases = [it for it in ALL if it in asked]
        return dict(zip(cases, pool.map(run, range(len(cases)), cases), strict=True))


def _is_here(item: pytest.Item) -> bool:
    return item.path == Path(__file__) and hasattr(item, "callspec")


def _rehearsed(folder: Path, at: int, case: Case) -> CompletedProcess[str]:
    release, stack, left_out = case
    file = folder / f"fleet{at}.yaml"
    robot = ROBOTS / "rover_gz.urdf"
    file.write_text(FLEET.format(release=release, stack=stack, robot=robot))
    domain = live_commands.domain(90 + at)
    words = ["rehearse", str(file), "--domain", domain, "--ignore", "MB425", *PATIENTLY]
    words += ["--without-rules", left_out] if left_out else []
    return live_commands.multibot(*words, env=live_fleet.environ(domain))


@pytest.mark.parametrize("case", rows(it for it in ALL if it not in LEAKING))
def test_what_a_release_hands_on_is_as_planned(
    case: Case, done: dict[Case, CompletedProcess[str]]
) -> None:
    assert done[case].returncode == 0, done[case].stdout
    # joint_state_publisher of robot_state may run beside the broadcaster of the plugin.
    is_sent_twice = case == FORWARDED_TO_UNKNOWN
    verdict = "no error, see the warnings" if is_sent_twice else "as planned"
    assert f": {verdict} (" in done[case].stderr
    codes = {word for word in done[case].stdout.split() if word.startswith("MG")}
    assert "warning: MG324" in done[case].stdout or not is_sent_twice
    assert codes <= ({"MG324"} if is_sent_twice else set()), done[case].stdout
    assert not {" MG1", " MG2"} & {it[:4] for it in done[case].stdout.split(":")}


@pytest.mark.parametrize("case", rows(LEAKING))
def test_what_it_does_not_hand_on_leaks(
    case: Case, done: dict[Case, CompletedProcess[str]]
) -> None:
    assert done[case].returncode == 1, done[case].stderr
    node, lines = f"/robot1/{LEAKING[case]}", done[case].stdout.splitlines()
    (line,) = (it for it in lines if it.startswith(f"{node}: error: MG405 {node} sends tf on /tf"))
    assert "by the plan it should publish topic /robot1/tf, but does not" in line
