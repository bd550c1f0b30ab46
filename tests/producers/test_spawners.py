# SPDX-License-Identifier: Apache-2.0
"""The spawner's arguments, by ros2_control's spawner.py: which controllers run, where, with what."""

from __future__ import annotations

import pytest
from launched_nodes import AMCL, AT, launched, runs, started

from multibot_rewrite.fleet.fleet import known_nodes
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.planning.of_runs import with_names
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchGraph, ParameterText
from multibot_rewrite.producers.launch.running import Knowledge, running_nodes
from multibot_rewrite.producers.launch.spawners import spawned_in

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


@pytest.mark.parametrize("words", ["", "a --bogus", "a --inactive b", "a -c", "--controller"])
def test_wrong_arguments_are_a_note_at_the_spawner(words: str) -> None:
    made, notes = spawned_in([spawner(*words.split())])
    assert made == ()
    assert [it.place for it in notes] == [AT]
    assert "spawner" in notes[0].message


def test_a_spawner_that_an_event_starts_makes_its_controllers_optional() -> None:
    late = spawner("drive")._replace(later="at an event")
    assert runs(launched(manager(MANAGER_FILE), late))["drive"].when == "at an event"
    assert "spawner" not in runs(launched(AMCL, late))


@pytest.mark.parametrize(("release", "is_process"), [("humble", True), ("jazzy", False)])
@pytest.mark.parametrize("name", ["", "cm"])
def test_the_name_of_a_manager_is_that_of_its_process(
    name: str, release: str, is_process: bool
) -> None:
    """As rcl has it for three nodes of one process with __node:=cm (asked with rclpy): /robot1/cm for
    each, ~/odom of each is /robot1/cm/odom."""
    own = manager(MANAGER_FILE, namespace="/robot1")._replace(name=name)
    load = spawner("drive", "-c", name or "controller_manager", namespace="/robot1")
    nodes = known_nodes(None, release, ()).library.nodes
    known = Knowledge(nodes, load_known_nodes("", release), release)
    found = running_nodes(LaunchGraph((own, load), ()), known).nodes
    (drive,) = (it for it in found if it.node == "drive")
    node = "/robot1/cm" if name and is_process else "/robot1/drive"
    assert drive.full_name == node
    assert f"{node}/odom" in [told for _, told in with_names(drive).names]
