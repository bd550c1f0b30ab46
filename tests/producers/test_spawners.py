# SPDX-License-Identifier: Apache-2.0
"""The spawner's arguments, by ros2_control's spawner.py: which controllers run, where, with what."""

from __future__ import annotations

import pytest
from launched_nodes import AMCL, AT, launched, runs, started

from multibot_rewrite.producers.launch.records import LaunchedNode, ParameterText
from multibot_rewrite.producers.launch.spawners import active, controller_files, spawned_in

DRIVE, ARM = "diff_drive_controller/DiffDriveController", "pid_controller/PidController"
MANAGER_FILE = ParameterText(
    "/ws/c.yaml",
    f"""\
/**:
  controller_manager:
    ros__parameters:
      drive: {{type: {DRIVE}}}
      spare: {{type: {ARM}}}
""",
)
OWN_FILE = ParameterText(
    "/ws/own.yaml", f"/**/drive:\n  ros__parameters: {{type: {DRIVE}, base_frame_id: base}}\n"
)


def spawner(*words: str, **more: object) -> LaunchedNode:
    return started("controller_manager", "spawner", **more)._replace(arguments=words)


def manager(*files: ParameterText, namespace: str = "/") -> LaunchedNode:
    node = started("controller_manager", "ros2_control_node", namespace=namespace)
    return node._replace(parameters=files)


@pytest.mark.parametrize(
    ("words", "namespace", "found"),
    [
        ("a b", "/", ["/a", "/b"]),
        ("a b", "/robot1", ["/robot1/a", "/robot1/b"]),
        ("a -c /x/controller_manager", "/robot1", ["/x/a"]),
        ("--controller-manager cm a", "/robot1", ["/robot1/a"]),
        ("-n x a b --inactive", "/", ["/x/a", "/x/b"]),
        ("a -u --switch-timeout 5 --activate-as-group --no-switch-asap", "/", ["/a"]),
        ("-c /x/cm --controller a --inactive --controller b -p f", "/", ["/x/a", "/x/b"]),
    ],
)
def test_names_and_manager(words: str, namespace: str, found: list[str]) -> None:
    made, notes = spawned_in([spawner(*words.split(), namespace=namespace)])
    assert ([it.full_name for it in made], notes) == (found, ())


def test_options_of_each_controller_are_its_own() -> None:
    words = ["--controller", "a", "--inactive", "--controller", "b"]
    words += ["--controller-ros-args", "-r x:=y -r ~/a:=b"]
    made, _ = spawned_in([spawner(*words)])
    assert [(it.name, it.inactive, it.rules) for it in made] == [
        ("a", True, ()),
        ("b", False, (("x", "y"), ("~/a", "b"))),
    ]


@pytest.mark.parametrize("words", ["", "a --bogus", "a --inactive b", "a -c", "--controller"])
def test_wrong_arguments_are_a_note_at_the_spawner(words: str) -> None:
    made, notes = spawned_in([spawner(*words.split())])
    assert made == ()
    assert [it.place for it in notes] == [AT]
    assert "spawner" in notes[0].message


def test_the_files_that_a_spawner_names() -> None:
    words = ["a", "-p", "one.yaml", "--param-file", "two.yaml", "-p", "one.yaml"]
    assert controller_files("controller_manager/spawner", words) == ("one.yaml", "two.yaml")
    assert controller_files("acme/spawner", words) == ()


def test_what_is_spawned_runs_and_what_is_not_may_be_missing() -> None:
    found = runs(launched(manager(MANAGER_FILE), spawner("drive")))
    assert (found["drive"].when, str(found["drive"].origin)) == ("", "/ws/c.yaml:4")
    assert "no spawner" in found["spare"].when
    assert "~/odom" in {it.name for it in found["drive"].endpoints}


def test_where_nothing_is_spawned_declared_controllers_run() -> None:
    assert runs(launched(manager(MANAGER_FILE)))["spare"].when == ""


def test_inactive_controllers_of_the_same_joints_are_there() -> None:
    joints = "command_interfaces: [position], joints: [elbow], state_interfaces: [position]"
    type_ = "joint_trajectory_controller/JointTrajectoryController"
    file = ParameterText(
        "/ws/c.yaml",
        f"controller_manager:\n  ros__parameters: {{a.type: {type_}, b.type: {type_}}}\n"
        f"a:\n  ros__parameters: {{{joints}}}\nb:\n  ros__parameters: {{{joints}}}\n",
    )
    either = runs(launched(manager(file)))
    assert all("same joints" in either[name].when for name in "ab")
    both = runs(launched(manager(file), spawner("a"), spawner("b", "--inactive")))
    assert {both[name].when for name in "ab"} == {""}


def test_a_file_of_the_spawner_has_the_type_and_the_parameters() -> None:
    one = spawner("drive", namespace="/robot1")._replace(parameters=(OWN_FILE,))
    found = runs(launched(manager(namespace="/robot1"), one))["drive"]
    assert found.package == "diff_drive_controller"
    assert {it.default for it in found.frames if it.given} == {"base"}


def test_the_type_may_be_an_argument() -> None:
    assert (
        runs(launched(manager(), spawner("d", "-t", DRIVE)))["d"].package == "diff_drive_controller"
    )


def test_a_controller_without_a_type_has_its_name_alone_and_a_note() -> None:
    found = launched(manager(), spawner("d"))
    assert (runs(found)["d"].host, runs(found)["d"].endpoints) == ("controller_manager", ())
    assert runs(found)["d"].origin.place == AT


def test_rules_of_a_spawner_are_those_of_its_controllers() -> None:
    rules = "-r ~/cmd_vel:=cmd_vel -r /robot1/drive/odom:=/robot1/odom -r /tf:=tf"
    words = ("drive", "--controller-ros-args", rules)
    one = spawner(*words, namespace="/robot1")
    found = runs(launched(manager(MANAGER_FILE, namespace="/robot1"), one))["drive"]
    moved = {it.name: it.remapped for it in found.endpoints if it.remapped}
    assert moved == {"~/cmd_vel": "cmd_vel", "~/odom": "odom"}


def test_a_spawner_that_an_event_starts_makes_its_controllers_optional() -> None:
    late = spawner("drive")._replace(later="at an event")
    assert runs(launched(manager(MANAGER_FILE), late))["drive"].when == "at an event"
    assert "spawner" not in runs(launched(AMCL, late))


@pytest.mark.parametrize("words", [("drive", "--inactive"), ("drive", "--load-only")])
def test_what_a_spawner_leaves_inactive(words: tuple[str, ...]) -> None:
    late = spawner("spare")._replace(later="at an event")
    found = launched(manager(MANAGER_FILE), spawner(*words), late)
    assert active(found.spawned) == set()
    assert active(launched(manager(MANAGER_FILE), spawner("drive"), late).spawned) == {"drive"}
