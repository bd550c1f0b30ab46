# SPDX-License-Identifier: Apache-2.0
"""The printed launch file is compared with the records that it is printed from, value by value.

The measure: whatever is changed in the file, one text, number, keyword or item at a time, is noticed.
"""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
from built_launch import CONTROLLERS, FLEETS
from fleet_folder import planned_fleet
from paths import ROBOTS, ROOT
from printed_mutants import mutants

from multibot_rewrite.checks.as_printed import Difference, not_as_printed
from multibot_rewrite.checks.build import Outputs, make_outputs
from multibot_rewrite.checks.read_back import read_back
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.launch import launch_file
from multibot_rewrite.fleet.launch.launch_python import to_python
from multibot_rewrite.fleet.launch.starts import CLASSIC, GZ, FleetStarts, RobotStarts
from multibot_rewrite.fleet.outputs.relays import BRIDGE
from multibot_rewrite.planning.start import File, Process, Start, Text

LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "frame-prefix", "postfix")


def robot(name: str, model: str, x: str, robots_number: int) -> RobotStarts:
    """Return a robot with all that one may start."""
    params, more = File(f"{name}/p.yaml"), File(f"{name}/q.yaml", substituted=True)
    frames = {"frame_prefix": f"{name}/", "rate": 1.5, "n": 2}
    box = Start(
        "pkg", "", f"/{name}", "part", (params, {"on": True}), (("a", "b"),), plugin="pkg::Part"
    )
    return RobotStarts(
        name, "rover.urdf", f"namespace /{name}", (params, more),
        (
            Start("state", "state", f"/{name}", "state",
                  (params, more, {"robot_description": Text(f"{name}/rover.urdf"), **frames}),
                  (("/tf", "tf"), ("/scan", f"/{name}/scan"))),
            Start("rclcpp_components", "isolated", f"/{name}", "box", components=(box,)),
            Start("slam_toolbox", "sync", f"/{name}", "slam", brought_up=True),
            Start("nav2", "manager", f"/{name}", "manager", ({"node_names": ["a", f"b_{name}"]},)),
            Start("tf2_ros", "static", arguments=("--x", x, "--frame-id", "map", "-q")),
            Start("tf_namespace_bridge", "tf_namespace_bridge", f"/{name}", "relay", needs=BRIDGE),
            Start("ros_gz_sim", "create", condition="simulator",
                  arguments=("-name", model, "-file", File(f"{name}/r.sdf"))),
            Start("ros_gz_bridge", "bridge", f"/{name}", "", ({"config": File(f"{name}/b.yaml")},),
                  condition="simulator"),
            Start("rviz2", "rviz2", arguments=("-d", File(f"view{robots_number}.rviz")),
                  condition="rviz"),
        ),
        (("driver", "no program"),),
        f"the tf of {name} is not on /tf",
    )  # fmt: skip


OTHER = RobotStarts(
    "arm", "arm.urdf", "the root namespace", (),
    (Start("slam_toolbox", "async", brought_up=True), Start("p", "e", arguments=("it's", '"{x}"'))),
    clock=False,
)  # fmt: skip
ALL = FleetStarts(
    "Three robots.",
    (CLASSIC, GZ),
    (
        Start(
            "ros_gz_bridge",
            "bridge",
            "",
            "",
            ({"config": File("bridge.yaml")},),
            condition="simulator",
        ),
        Start("nav2_map_server", "map_server", "/maps", "map_server", (File("r1/p.yaml"),)),
    ),
    (robot("r1", "red", "1.0", 1), robot("r2", "r2", "2.0", 2), OTHER),
    (Start("rviz2", "rviz2", arguments=("-d", File("all.rviz")), condition="rviz"),),
    True,
    ("ros2 run teleop",),
    File("world.sdf"),
    {"": 1, "r1": 11, "r2": 12, "arm": 13},
)


def launched(name: str) -> RobotStarts:
    """Return a robot with all that a vendor's launch file may start."""
    later = Process(delay=2.5, event="OnProcessExit", after=0)
    how = Process("nice", True, 1.5, "/srv", delay=4.0)
    included = Process(is_include=True)
    tf = (("/tf", f"/{name}/tf"),)
    return RobotStarts(
        name, "rover.urdf", f"namespace /{name}", (),
        (
            Start("acme", "first", f"/{name}", "first", process=Process(prefix="nice"), number=0),
            Start("acme", "then", f"/{name}", process=Process(event="OnProcessStart", after=0),
                  number=1),
            Start("", "agent", arguments=("--dev", f"/dev/{name}"), process=later, number=2,
                  environment={"LEVEL": "4", "PATH": "/own:", "OLD": ":/more"}),
            Start("", "a | b", process=Process(shell=True, event="OnExecutionComplete", after=1)),
            Start("acme", "late", f"/{name}", "late", process=how),
            Start("lidar", "launch/x.launch.py", f"/{name}/front", "", (), tf,
                  ("port", "/dev/ttyS1", "file", File(f"{name}/p.yaml")), environment={"A": "b"},
                  process=included),
            Start("web", "launch/w.launch.xml", process=included),
        ),
    )  # fmt: skip


LAUNCHED = FleetStarts(
    "Two robots.", (), (), (launched("r1"), launched("r2")), (), False, (),
    environment={"RMW": "zenoh", "GZ_PATH": ":/meshes", "BIN": "/own:"},
)  # fmt: skip
# Of these nothing depends: what an error says of a robots:= that the fleet has not, and the type of
# a text that is no substitution (launch_ros parameter_descriptions.py, ParameterValue.evaluate).
MEANS_NOTHING = (
    *("'multibot build FLEET -o '", "' --count '", "'robots:='", "': ' is", "' robots were built"),
    *("', ' is", "' is not in this fleet", "0 is 1", "without value_type=str"),
)


def differences(starts: FleetStarts, text: str, folder: Path) -> list[Difference]:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    return not_as_printed(starts, text.encode(), str(folder))


def unnoticed(starts: FleetStarts, text: str, folder: Path, part: slice = slice(None)) -> list[str]:
    every = [it for it in mutants(text) if not any(one in it[0] for one in MEANS_NOTHING)]
    assert len(every) > 100 and not differences(starts, text, folder)
    return [what for what, changed in every[part] if not differences(starts, changed, folder)]


def test_what_is_printed_is_what_is_planned(tmp_path: Path) -> None:
    assert differences(ALL, to_python(ALL), tmp_path / "out") == []


@pytest.mark.slow
@pytest.mark.sample(5)
@pytest.mark.parametrize("part", range(5))
@pytest.mark.parametrize("starts", [ALL, LAUNCHED])
def test_whatever_is_changed_is_noticed(starts: FleetStarts, part: int, tmp_path: Path) -> None:
    assert unnoticed(starts, to_python(starts), tmp_path / "out", slice(part, None, 5)) == []


def test_a_process_of_a_launch_is_printed_as_planned(tmp_path: Path) -> None:
    """Moved out of its timer, or behind the event that it waits for, it is another."""
    text = to_python(LAUNCHED)
    assert differences(LAUNCHED, text, tmp_path / "out") == []
    first, *others = LAUNCHED.robots[0].starts
    rest = (it._replace(process=it.process._replace(delay=0.0, event="")) for it in others)
    robots = (LAUNCHED.robots[0]._replace(starts=(first, *rest)), LAUNCHED.robots[1])
    assert differences(LAUNCHED._replace(robots=robots), text, tmp_path / "out")


@pytest.mark.deep
def test_one_simulator_and_one_domain(tmp_path: Path) -> None:
    """Other constants of the file: only gz, no domain, no default clock."""
    starts = ALL._replace(simulators=(GZ,), domains={}, use_sim_time=False)
    starts = starts._replace(robots=(ALL.robots[0], OTHER))
    assert unnoticed(starts, to_python(starts), tmp_path / "out") == []


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("model='red'", "model='{name}_red'",
         "ros_gz_sim/create: arguments[1] is '{name}_red', planned is 'red'"),
        ("x=1.0", "x=1.5", "tf2_ros/static: arguments[1] is '1.5', planned is '1.0'"),
        ("('/scan', f'/{name}/scan')", "('/scan', '/scan')",
         "state/state /r1/state: remappings[1][1] is '/scan', planned is '/r1/scan'"),
        ("text(f'{name}/rover.urdf')", "file(f'{name}/rover.urdf')",
         "robot_description is 'OUT/r1/rover.urdf', planned is 'the text of r1/rover.urdf'"),
        ("            name='slam',\n", "",
         "slam_toolbox/sync /r1/slam: name is missing, planned is 'slam'"),
        ("'on': True", "'on': 1", "parameters[1].on is 1, planned is True"),
        ("'r2': '12'", "'r2': '11'", "/r2/state: environment.ROS_DOMAIN_ID is '11', planned is '12'"),
        ("            OpaqueFunction(function=chosen),\n", "",
         "state/state /r1/state is planned and is not started"),
        ("            executable='map_server',\n", "            executable='other',\n",
         "nav2_map_server/map_server /maps/map_server: executable is 'other', planned is 'map_server'"),
    ],
)  # fmt: skip
def test_a_difference_says_which_process_and_which_value(
    old: str, new: str, said: str, tmp_path: Path
) -> None:
    text = to_python(ALL)
    assert old in text
    found = differences(ALL, text.replace(old, new), tmp_path / "out")
    home = os.path.realpath(tmp_path / "out")
    assert any(said in it.message.replace(home, "OUT") for it in found), found
    assert all(it.place.file.endswith("fleet.launch.py") for it in found if it.place.file)


def test_a_process_that_nobody_planned_is_said_with_its_line(tmp_path: Path) -> None:
    text = to_python(ALL).replace(
        "            OpaqueFunction(", "            Node(package='spy', executable='spy'),\n"
        "            OpaqueFunction(",
    )  # fmt: skip
    found = differences(ALL, text, tmp_path / "out")
    assert {it.message for it in found} == {"spy/spy is started and is not planned"}
    line = text[: text.index("Node(package='spy'")].count("\n") + 1
    assert {it.place.line for it in found} == {line}


def test_a_file_that_is_no_python_is_a_difference(tmp_path: Path) -> None:
    (found,) = differences(ALL, to_python(ALL) + "\n)", tmp_path / "out")
    assert "SyntaxError" in found.message


# ---------------------------------------------------------------- of fleets that are built


@cache
def planned(text: str) -> tuple[FleetPlan, Outputs]:
    plan = planned_fleet(text, around=os.environ)
    return plan, make_outputs(plan, "/any/out")


def in_folder(folder: Path, text: str) -> Outputs:
    for name in ("rover.urdf", "rover_gz.urdf", "rover.sdf", "two_finger_arm.urdf"):
        shutil.copy(ROBOTS / name, folder)
    (folder / "c.yaml").write_text(CONTROLLERS)
    (folder / "fleet.yaml").write_text(text)
    return planned(str(folder / "fleet.yaml"))[1]


def launch_of(made: Outputs) -> str:
    return next(it.text for it in made.files if it.path == "fleet.launch.py")


@pytest.mark.more
@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("kind", FLEETS)
def test_each_kind_of_fleet_is_as_planned(kind: str, layout: str, tmp_path: Path) -> None:
    made = in_folder(tmp_path, f"layout: {layout}\n{FLEETS[kind]}")
    assert differences(made.starts, launch_of(made), tmp_path / "out") == []


@pytest.mark.more
@pytest.mark.parametrize(
    "names",
    [
        ("gz", "create"), ("base_link", "name"), ("map", "world"), ("r1", "r1_a", "r"),
        ("file", "text", "params"), ("rover", "scout"), ("x", "y"), ("start", "start_rover"),
        ("robot_state_publisher", "tf2_ros"), ("None", "Node"), ("partial", "FOLDER", "CLOCK"),
    ],
)  # fmt: skip
def test_robots_may_be_called_like_a_word_of_the_file(
    names: tuple[str, ...], tmp_path: Path
) -> None:
    rows = "".join(
        f"  - {{name: {it}, model: {it}_m{at}, pose: {{x: {at}}}}}\n" for at, it in enumerate(names)
    )
    text = f"layout: tf-per-robot\ndistro: jazzy\ndescription: rover_gz.urdf\nrobots:\n{rows}"
    made = in_folder(tmp_path, text)
    assert differences(made.starts, launch_of(made), tmp_path / "out") == []
    spawned = [one for it in made.starts.robots for one in it.starts if one.executable == "create"]
    models = [it.arguments[1] for it in spawned]
    assert models == [f"{it}_m{at}" for at, it in enumerate(names)]


@pytest.mark.more
def test_a_robot_has_its_own_clock_where_not_all_have_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = "  - {name: r1, use_sim_time: false}\n  - {name: r2, pose: {x: 3}}\n"
    text = f"layout: tf-per-robot\ndistro: jazzy\ndescription: rover.urdf\nrobots:\n{rows}"
    made = in_folder(tmp_path, text)
    assert [it.clock for it in made.starts.robots] == [False, None]
    assert differences(made.starts, launch_of(made), tmp_path / "made") == []
    out = tmp_path / "out"
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(out), "-q"]) == 0
    assert "MG132" not in capsys.readouterr().err
    python = (out / "fleet.launch.py").read_text()
    of_first = python[python.index("def start_r1") : python.index("def start_r2")]
    assert "CLOCK" not in of_first and "{'use_sim_time': False}" in of_first
    assert "CLOCK" in python[python.index("def start_r2") :]


def test_what_is_of_no_use_without_a_simulator_or_a_screen_depends_on_it() -> None:
    """So ``simulator:=false`` starts the robots alone, and ``rviz:=false`` opens no window."""
    _, made = planned(str(ROOT / "examples" / "two_robots_nav2" / "fleet.yaml"))
    conditions = {"create": "simulator", "parameter_bridge": "simulator", "rviz2": "rviz"}
    every = [it for it in made.starts.every if it.executable]
    assert {it.executable for it in every} > conditions.keys()
    assert all(it.condition == conditions.get(it.executable, "") for it in every)


@pytest.mark.deep
@pytest.mark.parametrize("path", ["two_robots_nav2", "two_arms_moveit", "mixed_fleet"])
def test_whatever_is_changed_in_an_example_is_noticed(path: str, tmp_path: Path) -> None:
    _, made = planned(str(ROOT / "examples" / path / "fleet.yaml"))
    assert unnoticed(made.starts, launch_of(made), tmp_path / "out") == []


def spoiled(starts: FleetStarts) -> str:
    """Return the file of a printer that takes a model for a template."""
    return to_python(starts).replace("model='r1_red'", "model='{name}_red'")


@pytest.fixture
def two_models(tmp_path: Path) -> Iterator[Path]:
    shutil.copy(ROBOTS / "rover_gz.urdf", tmp_path)
    rows = "".join(
        f"  - {{name: {it}, model: {it}_{of}}}\n" for it, of in (("r1", "red"), ("r2", "b"))
    )
    path = tmp_path / "fleet.yaml"
    path.write_text(
        f"layout: tf-per-robot\ndistro: jazzy\ndescription: rover_gz.urdf\nrobots:\n{rows}"
    )
    yield path


def test_a_build_says_what_is_not_as_planned_and_writes_nothing(
    two_models: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    out = two_models.parent / "out"
    assert main(["build", str(two_models), "-o", str(out), "-q"]) == 0
    text = (out / "fleet.launch.py").read_text()
    shutil.rmtree(out)
    capsys.readouterr()
    monkeypatch.setattr(launch_file, "to_python", spoiled)
    assert main(["build", str(two_models), "-o", str(out), "-q"]) == 1
    said = capsys.readouterr().err
    line = text[: text.index("executable='create'")].count("\n") - 1
    assert (
        f"fleet.launch.py:{line}:1: error: MF823 ros_gz_sim/create: arguments[1] is '{{name}}_red', "
        "planned is 'r1_red' (the fleet would not start as planned; please report it, with the "
        "fleet file)"
    ) in said
    assert "nothing was written" in said and not out.exists()


def test_a_robot_that_is_not_read_for_its_files_is_compared(tmp_path: Path) -> None:
    """Of robots of one sort two are read; every value of all of them is compared."""
    shutil.copy(ROBOTS / "rover_gz.urdf", tmp_path)
    path = tmp_path / "fleet.yaml"
    path.write_text(
        "layout: tf-per-robot\ndistro: jazzy\ndescription: rover_gz.urdf\n"
        "robots:\n  - {name: robot, count: 9, step: {y: 2.0}}\n"
    )
    plan, made = planned(str(path))
    files = [
        it._replace(data=it.data.replace(b"'robot8', y=14.0", b"'robot8', y=14.5"))
        for it in made.files
    ]
    assert files != [*made.files]
    said = [it.message for it in read_back(plan, made._replace(files=tuple(files)), "/any/out")]
    assert any("is '14.5', planned is '14.0'" in it for it in said), said


@pytest.mark.slow
@pytest.mark.parametrize("path", ["bridge.yaml", "r1/bridge.yaml"])
def test_whatever_is_changed_in_a_row_of_a_bridge_is_noticed(path: str, tmp_path: Path) -> None:
    """The nodes of two robots with Nav2 and their simulator need all rows but one, and what a row is
    for is known by the description that is spawned."""
    shutil.copy(ROOT / "examples" / "launch_tutorial" / "rover.urdf", tmp_path)
    (tmp_path / "fleet.yaml").write_text(
        "distro: jazzy\nlayout: tf-per-robot\nnode_sets: nav2\ndescription: rover.urdf\n"
        "robots: [{name: r1, model: red}, {name: r2, pose: {x: 2}}]\n"
    )
    plan, made = planned(str(tmp_path / "fleet.yaml"))
    rows = next(it.text for it in made.files if it.path == path)
    before = read_back(plan, made, "/any/out")
    left = []
    for at, line in enumerate(lines := rows.splitlines(keepends=True)):
        changed = re.sub(r'(\w)("?)\n', r"\1X\2\n", line)
        text = "".join([*lines[:at], changed, *lines[at + 1 :]])
        files = [it._replace(data=text.encode()) if it.path == path else it for it in made.files]
        found = read_back(plan, made._replace(files=tuple(files)), "/any/out")
        left += [line] if changed == line or found == before else []
    assert lines and left == []
