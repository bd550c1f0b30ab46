# SPDX-License-Identifier: Apache-2.0
"""The referee of bringups sees what a launch file starts, and says what a fleet has not of it."""

from __future__ import annotations

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from paths import fixture_text
from waiting import wait_until

from tools.bringups import running
from tools.bringups.__main__ import Made, Verdict, details, installed, is_named, table
from tools.bringups.choose import Choice, chosen, launch_files, unread, unstarted
from tools.bringups.compare import Comparison, compare
from tools.bringups.install import install
from tools.bringups.reading import read
from tools.bringups.running import Process, Ran, by_controller, start
from tools.strangers import strangers

ROBOTS = ("robot1", "robot2")
STUB = Path(running.__file__).with_name("stub.py")


def of_each(program: Process) -> list[Process]:
    """Return a process for each robot, in its namespace."""
    return [program._replace(namespace=f"/{robot}") for robot in ROBOTS]


def where(found: Comparison) -> list[str]:
    return [it.where for it in found.matches]


DRIVER = Process(
    "acme",
    "driver",
    name="driver",
    rules=(("/scan", "/front/scan"),),
    parameters={"port": "/dev/ttyUSB0", "frame": "laser", "rate": 5},
    environ={"MODEL": "x"},
    facts={"respawn": "yes"},
)


def test_a_process_is_there_for_each_robot_once_or_missing() -> None:
    watch = Process("rviz2", "rviz2")
    fleet = [*of_each(DRIVER), watch, *of_each(Process("nav2_amcl", "amcl"))]
    found = compare([DRIVER, watch, Process("acme", "odometry")], fleet, ROBOTS)
    assert where(found) == ["each", "once", "missing"]
    assert [it.differs for it in found.matches] == [(), (), ()]
    assert [it.program for it in found.extra] == ["amcl", "amcl"]


def test_a_simulator_is_there_by_its_launch_file() -> None:
    program = Process("", "ign", words=("gazebo", "-r"))
    fleet = [Process("ros_gz_sim", "launch/gz_sim.launch.py", kind="include")]
    found = compare([program], fleet, ROBOTS)
    assert (where(found), found.extra) == (["once"], ())
    assert found.matches[0].differs == ("include in place of program",)
    assert where(compare([Process("", "gazebo", words=("-r",))], fleet, ROBOTS)) == ["missing"]
    classic = [Process("gazebo_ros", "launch/gazebo.launch.py", kind="include")]
    server = Process("gazebo_ros", "launch/gzserver.launch.py", kind="include")
    assert where(compare([server, program], classic, ROBOTS)) == ["once", "missing"]
    assert where(compare([Process("", "gazebo", words=("-r",))], classic, ROBOTS)) == ["once"]
    assert is_named(classic[0], "left: gazebo_ros gzserver (sim.launch.py:30)")
    script, moved = (Process("", "python3", words=(f"/{it}/show.py",)) for it in ("a", "b/c"))
    assert where(compare([script], [moved], ROBOTS)) == ["once"]
    old, new = Process("ros_ign_gazebo", "create"), Process("ros_gz_sim", "create")
    assert where(compare([old], of_each(new), ROBOTS)) == ["each"]


def test_installed_packages_are_copies_with_their_modules(tmp_path: Path) -> None:
    """What a fenced launch file may read is in the prefix: a link leads out of it."""
    package = tmp_path / "src/acme"
    (package / "acme").mkdir(parents=True)
    (package / "acme/__init__.py").write_text("")
    (package / "package.xml").write_text("<package><name>acme</name></package>")
    prefix = installed([tmp_path / "src"], tmp_path / "there")
    for path in (prefix / "share/acme/package.xml", prefix / "site/acme/__init__.py"):
        assert path.is_file() and not path.is_symlink()


def test_a_process_of_one_robot_alone_is_not_there_for_each() -> None:
    assert where(compare([DRIVER], of_each(DRIVER)[:1], ROBOTS)) == ["some"]


def test_what_the_rename_map_does_is_no_difference() -> None:
    fleet = [
        it._replace(
            name=f"driver_{robot}",
            rules=(("/scan", f"/{robot}/front/scan"), ("/tf", "tf"), ("other:/map", "map")),
            parameters={"port": "/dev/ttyUSB0", "frame": f"{robot}/laser", "rate": 5.0},
        )
        for it, robot in zip(of_each(DRIVER), ROBOTS, strict=True)
    ]
    (match,) = compare([DRIVER], fleet, ROBOTS).matches
    assert (match.where, match.differs) == ("each", ())


@pytest.mark.parametrize(
    ("change", "line"),
    [
        ({"rules": ()}, "rule lost: scan:=front/scan"),
        ({"rules": (*DRIVER.rules, ("a", "b"))}, "rule more: a:=b"),
        ({"environ": {}}, "environment lost: MODEL"),
        ({"environ": {"MODEL": "y"}}, "environment changed: MODEL: x -> y"),
        ({"facts": {}}, "respawn lost: yes"),
        ({"words": ("-v",)}, "argument more: -v"),
        ({"kind": "component"}, "component in place of program"),
        ({"parameters": {**DRIVER.parameters, "rate": 6}}, "parameter changed: rate: 5 -> 6"),
        ({"parameters": {"port": "/dev/ttyUSB0", "rate": 5}}, "parameter lost: frame"),
        ({"parameters": {**DRIVER.parameters, "more": 1}}, "parameter more: more"),
    ],
)
def test_each_difference_is_named(change: dict[str, object], line: str) -> None:
    fleet = of_each(DRIVER._replace(**change))  # type: ignore[arg-type]
    (match,) = compare([DRIVER], fleet, ROBOTS).matches
    assert match.differs == (line,)


@pytest.mark.parametrize(("name", "differs"), [("", ("parameter lost: a",)), ("driver", ())])
def test_sections_of_a_node_without_a_name_are_asked_of_one_without(
    name: str, differs: tuple[str, ...]
) -> None:
    vendor = Process("acme", "driver", parameters={"a": 1}, loose=frozenset("a"))
    fleet = of_each(Process("acme", "driver", name=name))
    assert compare([vendor], fleet, ROBOTS).matches[0].differs == differs


def test_another_namespace_than_the_robots_is_named() -> None:
    fleet = [it._replace(namespace=f"{it.namespace}/sub") for it in of_each(DRIVER)]
    (match,) = compare([DRIVER], fleet, ROBOTS).matches
    assert match.differs[0] == "namespace '': '/robot1/sub'"


def test_two_processes_of_one_program_are_told_apart() -> None:
    left, right = (DRIVER._replace(parameters={"port": it}) for it in ("left", "right"))
    fleet = [*of_each(right), *of_each(left)]
    found = compare([left, right], fleet, ROBOTS)
    assert [it.differs for it in found.matches] == [(), ()]
    assert not found.extra


def test_a_bridge_is_there_if_its_topics_are_bridged() -> None:
    rows, rules = ("/lidar@a[b", "/imu@a[b"), (("lidar", "scan"),)
    vendor = [
        Process("ros_gz_bridge", "parameter_bridge", words=rows, rules=rules),
        Process("ros_gz_bridge", "parameter_bridge", words=("/clock@a[b",)),
    ]
    names = [f"/{robot}/scan" for robot in ROBOTS]
    fleet = [
        Process("ros_gz_bridge", "parameter_bridge", parameters={running.BRIDGED: [name]})
        for name in (*names, "/clock")
    ]
    first, second = compare(vendor, fleet, ROBOTS).matches
    assert (first.where, first.differs) == ("each", ("not bridged: imu",))
    assert (second.where, second.differs) == ("once", ())


def test_of_a_bringup_of_several_robots_the_first_is_compared() -> None:
    """The vendor calls his robots as he likes; what the second one has more is missing."""
    publisher = Process("robot_state_publisher", "robot_state_publisher")
    theirs = [
        it._replace(namespace=f"/tb{number}", parameters={"map_topic": f"/tb{number}/map"})
        for number in (1, 2)
        for it in (publisher, DRIVER)
    ]
    more = Process("acme", "lamp", namespace="/tb2")
    fleet = [
        it._replace(namespace=f"/{robot}", parameters={"map_topic": f"/{robot}/map"})
        for robot in ROBOTS
        for it in (publisher, DRIVER)
    ]
    found = compare([*theirs, more], fleet, ROBOTS)
    assert where(found) == ["each"] * 4 + ["missing"]
    assert not any(it.differs for it in found.matches)
    sides = [publisher._replace(namespace=f"/{side}") for side in ("left", "right")]
    assert where(compare(sides, of_each(publisher), ROBOTS)) == ["each", "missing"]


def test_an_include_may_be_there_as_its_nodes() -> None:
    include = Process("twist_mux", "launch/twist_mux_launch.py", "include")
    found = compare([include], of_each(Process("twist_mux", "twist_mux")), ROBOTS)
    assert (where(found), found.extra) == (["each"], ())
    assert where(compare([include], [], ROBOTS)) == ["missing"]


def test_files_that_an_include_is_given_are_compared(tmp_path: Path) -> None:
    def include(folder: str, text: str) -> Process:
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "nav.yaml").write_text(text)
        return Process(
            "nav2", "x_launch.py", "include", words=(f"p:={tmp_path}/{folder}/nav.yaml",)
        )

    text = "amcl: {ros__parameters: {base: base_link, rate: 5, map: map}}"
    fleet = [
        include(
            robot, f"{robot}: {{amcl: {{ros__parameters: {{base: {robot}/base_link, rate: 6}}}}}}"
        )
        for robot in ROBOTS
    ]
    fleet = [it._replace(namespace=f"/{robot}") for it, robot in zip(fleet, ROBOTS, strict=True)]
    (match,) = compare([include("own", text)], fleet, ROBOTS).matches
    assert match.differs == ("nav.yaml lost: amcl.map", "nav.yaml changed: amcl.rate")


def test_a_node_reads_the_sections_that_are_for_it() -> None:
    text = json.dumps(
        {
            "/**": {"ros__parameters": {"a": 1, "b": 1}},
            "driver": {"ros__parameters": {"a": {"c": 2}, "b": 2}},
            "other": {"ros__parameters": {"d": 3}},
            "/robot1": {"driver": {"ros__parameters": {"e": 4}}},
        }
    )
    assert running.parameters_of(text, "driver", "/") == {"a": 1, "b": 2, "a.c": 2}
    assert running.parameters_of(text, "driver", "/robot1") == {"a": 1, "b": 1, "e": 4}
    assert running.parameters_of(text, "", "/").keys() == {"a", "a.c", "b", "d", "e"}


def test_a_package_is_installed_as_its_build_does(tmp_path: Path) -> None:
    source = tmp_path / "acme"
    for name in ("bringup/launch/b.launch.py", "description/launch/d.launch.py", "urdf/a.urdf"):
        (source / name).parent.mkdir(parents=True, exist_ok=True)
        (source / name).write_text(name)
    (source / "CMakeLists.txt").write_text(
        "install(DIRECTORY bringup/launch  # of the robot\n DESTINATION share/${PROJECT_NAME})\n"
        "install(\nDIRECTORY description/launch\nDESTINATION share/${PROJECT_NAME}\n)\n"
    )
    install("acme", source, tmp_path / "install")
    share = tmp_path / "install/share/acme"
    assert sorted(it.name for it in (share / "launch").iterdir()) == ["b.launch.py", "d.launch.py"]
    assert (share / "urdf/a.urdf").read_text() == "urdf/a.urdf"


def test_a_stub_writes_down_how_it_was_started(tmp_path: Path) -> None:
    (tmp_path / "p.yaml").write_text("a: 1")
    environ = {**os.environ, "BRINGUP_ROWS": str(tmp_path / "rows"), "MODEL": "x"}
    (tmp_path / "rows").mkdir()
    command = [sys.executable, str(STUB), "p.yaml", "--x"]
    with subprocess.Popen(command, env=environ, cwd=tmp_path) as child:
        wait_until(lambda: list((tmp_path / "rows").glob("*.json")))
        assert child.poll() is None  # it stays, as a node does
        child.terminate()
    (row,) = (json.loads(it.read_text()) for it in (tmp_path / "rows").iterdir())
    assert (row["words"][1:], row["folder"]) == (["p.yaml", "--x"], str(tmp_path))
    assert (row["files"], row["environ"]["MODEL"]) == ({"p.yaml": "a: 1"}, "x")


LAUNCH = fixture_text("bringups_launch.txt")


@pytest.mark.slow
@pytest.mark.live
@pytest.mark.skipif(
    not importlib.util.find_spec("launch_ros") or os.geteuid() != 0,
    reason="needs launch and launch_ros, and the rights to make namespaces",
)
def test_all_that_a_launch_file_starts_is_seen(tmp_path: Path) -> None:
    package = tmp_path / "src" / "acme"
    for name, text in {
        "package.xml": "<package><name>acme</name></package>",
        "config/p.yaml": "/**: {ros__parameters: {a: 1}}\nother: {ros__parameters: {z: 1}}",
        "launch/b.launch.py": LAUNCH,
    }.items():
        (package / name).parent.mkdir(parents=True, exist_ok=True)
        (package / name).write_text(text)
    ran = start(package / "launch/b.launch.py", (), [tmp_path / "src"], tmp_path / "run")
    assert not ran.fault
    found = {it.label: it for it in ran.processes}
    assert found.keys() == {
        *("acme/first", "acme/second", "acme/third", "not_here/launch/x.launch.py"),
        *("controller_manager/spawner", "MicroXRCEAgent udp4", "touch /etc/x"),
    }
    assert len(ran.processes) == len(found) + 1  # the spawner of two controllers
    first = found["acme/first"]
    assert (first.name, first.namespace, first.words) == ("first", "/sub", ("--fast",))
    assert (first.rules, first.parameters) == ((("scan", "/front"),), {"a": 1, "b": "y"})
    assert first.environ == {"MODEL": "x"}
    assert first.facts == {"respawn": "yes", "prefix": "gdb --args"}
    assert (found["acme/third"].words, found["acme/third"].facts) == (("-v",), {"delay": "900.0"})
    assert found["MicroXRCEAgent udp4"].words == ("udp4",)
    assert found["not_here/launch/x.launch.py"].words == ("k:=v",)
    spawners = [it.words[0] for it in ran.processes if it.program == "spawner"]
    assert spawners == ["a", "b"]


def test_a_bringup_is_what_no_other_file_includes(tmp_path: Path) -> None:
    texts = {
        "launch/robot.launch.py": "import launch; Node('robot_state_publisher')",
        "launch/all.launch.py": "import launch; include('robot.launch.py')",
        "launch/tool.launch.py": "import launch; Node('rviz2')",
    }
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    assert list(launch_files(tmp_path)) == ["launch/all.launch.py"]


def test_a_controller_is_behind_the_options_of_a_command() -> None:
    for manager in ((), ("-c", "/robot1/controller_manager")):
        words = ("control", "load_controller", *manager, "--set-state", "active", "arm")
        assert [it.words for it in by_controller(Process("", "ros2", words=words))] == [
            ("arm", *manager)
        ]


def test_files_that_cannot_be_read_are_said_before_a_run() -> None:
    robot = "<robot name='r'><link name='a'/><joint name='j'/></robot>"
    publisher = Process("robot_state_publisher", "robot_state_publisher")
    publisher = publisher._replace(parameters={"robot_description": robot})
    base, inner = Process("acme", "base"), Process("nav2_bringup", "x.py", "include")
    whole = Ran((publisher, base, inner), "")
    assert (unstarted(whole), unread(whole, {"nav2_bringup"})) == ("", "")
    assert unread(whole, {"acme"}) == "includes of nav2_bringup, in no release"
    assert unread(Ran((base,), ""), ()) == "no robot of its own"
    assert unstarted(Ran((base,), "")) == "fewer than three processes"


def test_the_list_has_each_once_and_no_stranger() -> None:
    names = [it.name for it in chosen()]
    assert len(names) == len(set(names))
    assert not {it.name for it in strangers()} & set(names)


def test_without_launch_the_stand_in_reads_what_would_start(tmp_path: Path) -> None:
    package = tmp_path / "acme"
    (package / "launch").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>acme</name></package>")
    (package / "launch/b.launch.py").write_text(
        "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n\n\n"
        "def generate_launch_description():\n    return LaunchDescription([\n"
        "        Node(package='acme', executable='driver', name='d', parameters=[{'a': 1}],\n"
        "             remappings=[('scan', '/front')], arguments=['-v']),\n"
        "        Node(package='controller_manager', executable='spawner', arguments=['a', 'b'])])\n"
    )
    found = read(package / "launch/b.launch.py", (), [tmp_path])
    driver, *spawners = found.processes
    assert (driver.label, driver.rules) == ("acme/driver (d)", (("scan", "/front"),))
    assert (driver.parameters, driver.words) == ({"a": 1}, ("-v",))
    assert [it.words for it in spawners] == [("a",), ("b",)]


def test_the_table_counts_what_is_there_and_what_is_named() -> None:
    choice = Choice("acme/robot", "work", "jazzy", "b.launch.py", ())
    lost = [Process("acme", "told.py"), Process("acme", "told.pyc")]
    found = compare([DRIVER, *lost], [*of_each(DRIVER), Process("a", "b")], ROBOTS)
    verdict = Verdict(choice, found, Made("", "# not started: told.py (acme)", 1.5))
    head, _, row, _ = table([verdict])
    cells = dict(zip(head.strip("| ").split(" | "), row.strip("|").split("|"), strict=True))
    counts = {name: it.strip() for name, it in cells.items()}
    assert counts == {
        **{"repository": "acme/robot", "processes": "3", "each": "1", "differ": "0", "once": "0"},
        **{"named": "1", "silent": "1", "extra": "1", "seconds": "1.5", "why not": ""},
    }
    lines = list(details(verdict))
    assert [it.split("  ")[0] for it in lines[1:]] == [
        *("each", "missing, named", "missing, silent", "extra"),
    ]
