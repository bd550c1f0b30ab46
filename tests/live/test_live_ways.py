# SPDX-License-Identifier: Apache-2.0
"""A rehearsal gives each rule where it stands: what a release does not hand on is found missing. And
rcl says of every node of every node set what it is called, with all of its ends."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any

import live_commands
import live_fleet
import pytest
from live_commands import PATIENTLY
from paths import ROBOTS

from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.checks.judged_plan import make_fleet
from multibot_rewrite.fleet.fleet import Fleet, expected
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.live.rehearsal import stub_nodes
from multibot_rewrite.planning.records import Run
from multibot_rewrite.planning.ways import ros_arguments
from multibot_rewrite.producers.ros import ros
from multibot_rewrite.system.records import ACTION, TOPIC

pytestmark = pytest.mark.live

pytest.importorskip("rclpy", reason="no rclpy: pip install '.[ros]'", exc_type=ImportError)
FLEET = """\
layout: tf-per-robot
distro: {release}
node_sets: {node_set}
robots:
  - {{name: robot1, description: {robot}}}
  - {{name: robot2, description: {robot}}}
"""
CONTROLLERS, NONE = "gz_ros2_control", "robot_state"
# Of a rehearsal: release, node set, what is left out.
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
    """Return the rehearsals that are asked for, side by side: most of it is waiting."""
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
    release, node_set, left_out = case
    file = folder / f"fleet{at}.yaml"
    robot = ROBOTS / "rover_gz.urdf"
    file.write_text(FLEET.format(release=release, node_set=node_set, robot=robot))
    domain = live_commands.domain(90 + at)
    words = ["rehearse", str(file), "--domain", domain, "--ignore", "MB425", *PATIENTLY]
    words += ["--without-rules", left_out] if left_out else []
    return live_commands.multibot(*words, env=live_fleet.environ(domain))


@pytest.mark.parametrize("case", rows(it for it in ALL if it not in LEAKING))
def test_what_a_release_hands_on_is_as_planned(
    case: Case, done: dict[Case, CompletedProcess[str]]
) -> None:
    assert done[case].returncode == 0, done[case].stdout
    # joint_state_publisher, which only may run, is not played beside the broadcaster of the plugin.
    assert ": as planned (" in done[case].stderr
    assert not {word for word in done[case].stdout.split() if word.startswith("MG")}
    assert not {" MG1", " MG2"} & {it[:4] for it in done[case].stdout.split(":")}


@pytest.mark.parametrize("case", rows(LEAKING))
def test_what_it_does_not_hand_on_leaks(
    case: Case, done: dict[Case, CompletedProcess[str]]
) -> None:
    assert done[case].returncode == 1, done[case].stderr
    node, lines = f"/robot1/{LEAKING[case]}", done[case].stdout.splitlines()
    (line,) = (it for it in lines if it.startswith(f"{node}: error: MG405 {node} sends tf on /tf"))
    assert "by the plan it should publish topic /robot1/tf, but does not" in line


# Those that every node has.
OF_RCL = {"/rosout", "/parameter_events"}
SEND_GOAL = "/_action/send_goal"
OF_SIMULATORS = ("gz_ros2_control", "gazebo_ros2_control")


@pytest.mark.parametrize("layout", ["tf-per-robot", "postfix"])
@pytest.mark.parametrize("release", RELEASES)
def test_rcl_calls_every_end_of_every_node_set_as_planned(
    release: str, layout: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also those under a condition, which no rehearsal opens. What does not get its rules is what the
    plan says of itself (MR105)."""
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF")
    wrong, seen = [], 0
    with ros.opened() as session:
        node = cache(partial(_node, session))
        for node_set in built_in(release).node_sets:
            # The manager of these gets its rules at the plugin.
            robot = ROBOTS / ("rover_gz.urdf" if node_set in OF_SIMULATORS else "rover.urdf")
            pair, policy = ["robot1", "robot2"], {"layout": layout}
            fleet = make_fleet(str(robot), pair, [node_set], policy, release=release)
            not_taken = [str(it) for it in fleet.table.problems if it.code == "MR105"]
            for run, end, name, own in _by_rcl(fleet, node):
                seen += 1
                said = any(f"{run.robot}: {run.node}:" in it for it in not_taken)
                if own != name and not said:
                    wrong.append((node_set, run.full_name, end.name, name, own))
            planned = {(it.node, it.kind, it.role, it.name) for it in expected(fleet).ends}
            ends = {
                (f"{run.full_name}{end.by}", end.kind, end.role, name)
                for run, end, name in fleet.table.ends
                if end.role and (end.by or not end.helper) and name not in OF_RCL
            }
            assert ends == planned, node_set
    assert not wrong
    assert seen > 5_000


def _node(session: ros.Session, name: str, arguments: tuple[str, ...]) -> Any:
    return ros.add_node(session, name, arguments=arguments)


def _by_rcl(fleet: Fleet, node: Any) -> Iterator[tuple[Run, Endpoint, str, str]]:
    """Each end of the fleet's nodes with its planned name, and the one that rcl makes of what the
    code asks for."""
    stubs = {stub.full_name: stub for stub, _ in stub_nodes(fleet.table, fleet.edges)}
    for run in fleet.table.runs:
        stub = stubs[run.full_name]
        own = node(stub.code_name, stub.arguments)
        full = own.get_fully_qualified_name()
        yield run, Endpoint("node", "", run.node), run.full_name, full
        words = ros_arguments(stub.process_namespace or "/", "", stub.process_rules)
        for end, name in run.names:
            asker = node("helper", tuple(words)) if end.helper else own
            asked = end.name
            if end.by and asked.startswith("~/"):
                asked = full + asked[1:]
            if end.above:
                asked = f"{full.rsplit('/', 2)[0]}/{asked.lstrip('/')}"
            if end.beside:
                image = asker.resolve_topic_name(end.beside)
                asked = f"{image.rpartition('/')[0]}/{asked.rpartition('/')[2]}"
            part = SEND_GOAL if end.kind == ACTION else ""
            resolve = asker.resolve_topic_name if end.kind == TOPIC else asker.resolve_service_name
            yield run, end, name, resolve(asked + part).removesuffix(part)
