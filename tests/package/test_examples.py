# SPDX-License-Identifier: Apache-2.0
"""The worked examples: what their pages show is printed, and each fleet's rehearsal is as planned."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

import live_commands
import page_commands
import pytest
from page_commands import Shown
from paths import ROOT
from plans import own, robot_named

from multibot_rewrite.planning.plan import read_plan

pytestmark = pytest.mark.slow

OURS = ("two_robots_postfix", "namespace_and_prefix")
# Each a fleet file, with files of others or few of its own.
SMALL = ("two_robots_nav2", "two_arms_moveit", "mixed_fleet")
# The pages about launch files and the tests with colcon try the rest of these.
LAUNCHED = ("launch_tutorial", "multibot_example")
FOLDERS = [ROOT / "examples" / name for name in (*OURS, *SMALL, *LAUNCHED)]
FLEETS = [
    path
    for folder in FOLDERS
    for path in sorted(folder.rglob("*.yaml"))
    if re.search(r"^(robots|include):", path.read_text(), re.MULTILINE)
]
PAGES = {
    f"{folder.name}: {heading}": commands
    for folder in FOLDERS
    for heading, commands in page_commands.sections((folder / "README.md").read_text()).items()
}
# Others are rehearsed in the deep run alone.
REHEARSED = "namespace_and_prefix: Nav2 for two robots"
DEEP = [it for it in PAGES if page_commands.is_live(PAGES[it]) and it != REHEARSED]
USUAL = {
    part: [it for it in commands if part == REHEARSED or not page_commands.is_live([it])]
    for part, commands in PAGES.items()
}


@pytest.fixture(scope="module")
def tried(tmp_path_factory: pytest.TempPathFactory, tf2: dict[str, str]) -> page_commands.Tried:
    """Return what the commands of every part of the pages do."""
    return page_commands.tried(USUAL, tmp_path_factory.mktemp("pages"), 20, tf2)


@pytest.mark.live
@pytest.mark.parametrize("name", [it for it, commands in USUAL.items() if commands])
def test_a_page_shows_what_is_printed(name: str, tried: page_commands.Tried) -> None:
    page_commands.assert_as_shown(name, tried)


@pytest.mark.live
@pytest.mark.deep
@pytest.mark.parametrize("name", DEEP)
def test_a_rehearsal_of_a_page_is_what_is_printed(
    name: str, tmp_path: Path, tf2: dict[str, str]
) -> None:
    found = page_commands.tried({name: PAGES[name]}, tmp_path, 20, tf2)
    page_commands.assert_as_shown(name, found)


def rehearsed(commands: Iterable[Shown]) -> dict[str, tuple[str, ...]]:
    return {
        it.command.split()[-1]: it.lines
        for it in commands
        if it.command.startswith(page_commands.LIVE)
    }


def test_every_fleet_is_shown_and_rehearsed() -> None:
    found = {
        file: lines for commands in PAGES.values() for file, lines in rehearsed(commands).items()
    }
    assert len(FLEETS) == 11
    assert {str(it.relative_to(ROOT)) for it in FLEETS} <= found.keys()
    fine = re.compile(r": (as planned|no error, see the notes) ")
    assert all(fine.search(lines[-1]) for lines in found.values())
    assert any(line.startswith("multibot: 5 robots") for it in found.values() for line in it)


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Return the fleets of two robots that have all their files, built; by the names of the file."""
    folder = tmp_path_factory.mktemp("built")
    there = page_commands.reader(folder)
    fleets = [it for it in FLEETS if it.parent.name in OURS]
    for fleet in fleets:
        done = there.run(
            f"multibot build {fleet.relative_to(ROOT)} -o {fleet.stem}-{fleet.parent.name}"
        )
        assert done.returncode == 0, done.stdout
    return {f"{it.stem}-{it.parent.name}": folder / f"{it.stem}-{it.parent.name}" for it in fleets}


def test_every_folder_is_known_and_says_what_it_is() -> None:
    found = {it.name for it in (ROOT / "examples").iterdir()}
    assert found == {*OURS, *SMALL, *LAUNCHED}
    assert all((ROOT / "examples" / it / "README.md").is_file() for it in found)
    readme = (ROOT / "README.md").read_text()
    assert [it for it in sorted(found) if f"examples/{it}/README.md" not in readme] == []


def words(robot: str) -> re.Pattern[str]:
    return re.compile(rf"(?<![a-z0-9]){robot}(?![0-9])", re.IGNORECASE)


def test_no_file_of_a_robot_has_another_robot_in_it(built: dict[str, Path]) -> None:
    for folder in built.values():
        for robot, other in (("robot1", "robot2"), ("robot2", "robot1")):
            files = [it for it in (folder / robot).iterdir() if it.is_file()]
            assert files
            for file in files:
                assert not words(other).search(file.read_text()), file
                assert words(robot).search(file.read_text()), file


def test_two_robots_differ_by_their_names_alone(built: dict[str, Path]) -> None:
    """What is not a name, a pose or a colour is the same text."""
    for name, folder in built.items():
        for file in (folder / "robot1").glob("*params.yaml"):
            other = folder / "robot2" / file.name
            assert other.read_text() == file.read_text().replace("robot1", "robot2"), name
    urdf = built["nav2-namespace_and_prefix"] / "robot1" / "hexbase.urdf"
    other = urdf.parent.parent / "robot2" / urdf.name
    assert other.read_text() == urdf.read_text().replace("robot1", "robot2")


def test_the_frames_of_parameters_are_links_or_sent(built: dict[str, Path]) -> None:
    """A frame in a built parameter file is one that the plan has."""
    folder = built["nav2-namespace_and_prefix"]
    plan = read_plan((folder / "plan.yaml").read_bytes(), "plan.yaml")
    for robot in plan.robots:
        known = {*robot.frames, *plan.shared_frames, *robot.other_frames}
        text = (folder / robot.name / "nav2_params.yaml").read_text()
        frames = re.findall(r"^ *\w*(?:frame|frame_id): *(\S+)", text, re.MULTILINE)
        assert len(frames) > 15
        assert set(frames) <= known


def test_three_names_go_to_three_places(built: dict[str, Path]) -> None:
    folder = built["fleet-namespace_and_prefix"]
    commands = (folder / "commands.md").read_text()
    assert "-name Robot1 " in commands and "-name Robot2 " in commands
    plan = read_plan((folder / "plan.yaml").read_bytes(), "plan.yaml")
    for robot in ("robot1", "robot2"):
        frames = robot_named(plan, robot).frames
        assert {it.split("/")[0] for it in frames} == {f"{robot}_tf"}
        assert {it.split("/")[1] for it in own(plan, robot)} == {robot}
        assert f"{robot}_tf_wheel_left_joint" in (folder / robot / "hexbase.urdf").read_text()


def test_everything_has_the_postfix(built: dict[str, Path]) -> None:
    folder = built["fleet-two_robots_postfix"]
    plan = read_plan((folder / "plan.yaml").read_bytes(), "plan.yaml")
    for robot, frames, tf, *_ in plan.robots:
        assert tf == f"/tf/{robot}"
        assert all(it.endswith(f"/{robot}") for it in frames)
        nodes = own(plan, robot)
        assert all(it.endswith(f"_{robot}") and it.count("/") == 1 for it in nodes)
        names = [it.name for it in plan.ends if it.node in nodes]
        assert f"/cmd_vel/{robot}" in names
        # Below a camera's name its own topics follow.
        ends = (f"/{robot}", f"_{robot}/image_raw", f"_{robot}/camera_info")
        assert all(it.endswith(ends) for it in names if it not in plan.shared_topics)


def test_the_tree_hangs_below_the_world(built: dict[str, Path]) -> None:
    lines = (built["fleet-two_robots_postfix"] / "commands.md").read_text()
    for robot, x in (("robot1", "1.0"), ("robot2", "-1.0")):
        sent = rf"--x {x} .*--frame-id world --child-frame-id odom/{robot} .*/tf_static/{robot}$"
        assert re.search(sent, lines, re.MULTILINE)


def test_the_first_fleet_file_of_its_page_works_as_printed(tmp_path: Path) -> None:
    page = (ROOT / "docs" / "fleet-file.md").read_text()
    fleet, *_ = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
    (tmp_path / "fleet.yaml").write_text(fleet)
    own = ROOT / "examples" / "namespace_and_prefix"
    for file, name in (
        (ROOT / "fixtures" / "robots" / "rover.urdf", "rover.urdf"),
        (own / "nav2_params.yaml", "params.yaml"),
        (own / "nav2.rviz", "one_robot.rviz"),
    ):
        (tmp_path / name).write_bytes(file.read_bytes())
    done = page_commands.reader(tmp_path).run("multibot build fleet.yaml -o out")
    assert done.returncode == 0, done.stdout
    assert "robot2/odom" in (tmp_path / "out" / "robot2" / "params.yaml").read_text()
    assert "/robot2/goal_pose" in (tmp_path / "out" / "one_robot.rviz").read_text()


def test_a_build_is_up_to_date_until_a_source_changes(tmp_path: Path) -> None:
    there = page_commands.reader(tmp_path)
    copied = "cp -r examples/two_robots_postfix own && multibot build own/fleet.yaml -o out"
    assert there.run(copied).returncode == 0
    again = there.run("multibot build own/fleet.yaml -o out --check")
    assert (again.returncode, again.stdout.count("up to date")) == (0, 1), again.stdout
    there.run("sed -i 's/lidar_link/laser_link/' own/scout.urdf.xacro; echo >> own/params.yaml")
    stale = there.run("multibot build own/fleet.yaml -o out --check")
    assert stale.returncode == 1
    assert "robot2/params.yaml: stale" in stale.stdout


@pytest.mark.deep
def test_twenty_robots_are_as_planned(tmp_path: Path, tf2: dict[str, str]) -> None:
    if not page_commands.has_ros():
        pytest.skip("no rclpy: pip install '.[ros]'")
    rows = "".join(f"  - {{name: robot{at}, pose: {{x: {at}}}}}\n" for at in range(20))
    include = "include: examples/two_robots_postfix/fleet.yaml\n"
    (tmp_path / "twenty.yaml").write_text(f"{include}robots:\n{rows}")
    done = page_commands.reader(tmp_path, live_commands.domain(99), **tf2).run(
        "multibot rehearse twenty.yaml"
    )
    assert (
        done.returncode,
        "20 robots, 8 nodes each: all known, all seen; 0 findings: as planned" in done.stdout,
    ) == (0, True)
