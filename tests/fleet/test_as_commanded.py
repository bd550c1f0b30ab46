# SPDX-License-Identifier: Apache-2.0
"""The lines of ``commands.md`` are compared with the processes that are planned.

The measure: whatever word of a line is changed or left out, it is noticed. Lines of programs that only
a person starts (teleop_twist_keyboard), and of MoveIt's nodes, which have no name of their own there,
are none of it.
"""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
from fleet_folder import planned_fleet
from paths import ROBOTS, ROOT

from multibot_rewrite.checks.as_printed import not_as_commanded
from multibot_rewrite.checks.build import Outputs, make_outputs
from multibot_rewrite.checks.read_back import read_back
from multibot_rewrite.fleet.fleet_plan import FleetPlan

TOLD = (
    *("static_transform_publisher", "spawner", "create", "spawn_entity.py", "relay", "rviz2"),
    "tf_namespace_bridge",
)
TWO = "robots: [{name: r1, model: red}, {name: r2, pose: {x: 2}}]\n"
FLEETS = {
    "gz": f"layout: both\ndescription: rover_gz.urdf\nnode_sets: gz_ros2_control\n{TWO}",
    "classic": f"layout: frames-per-robot\ndescription: rover.urdf\n{TWO}",
    "relayed": f"layout: tf-per-robot\nrelayed: true\ndescription: rover.urdf\n{TWO}",
    "copied": f"layout: both\nrelayed: true\ndescription: rover.urdf\n{TWO}",
    "postfix": f"layout: postfix\ndescription: rover.sdf\n{TWO}",
    "clock": "description: rover.urdf\nuse_sim_time: false\n" + TWO,
}
EXAMPLES = ("two_robots_nav2", "two_arms_moveit", "namespace_and_prefix", "mixed_fleet")


@cache
def example(name: str) -> tuple[FleetPlan, Outputs]:
    return outputs(ROOT / "examples" / name / "fleet.yaml")


def outputs(path: Path) -> tuple[FleetPlan, Outputs]:
    plan = planned_fleet(path, around=os.environ, trust=True)
    return plan, make_outputs(plan, "/any/out")


def of_kind(folder: Path, kind: str) -> Outputs:
    text = FLEETS[kind]
    for name in ("rover.urdf", "rover_gz.urdf", "rover.sdf"):
        text = text.replace(f"description: {name}", f"description: {ROBOTS / name}")
    (folder / "fleet.yaml").write_text(f"distro: jazzy\n{text}")
    return outputs(folder / "fleet.yaml")[1]


def commands(made: Outputs) -> str:
    return next(it.text for it in made.files if it.path == "commands.md")


def changes(text: str) -> Iterator[tuple[str, str]]:
    """Yield the text with one word of a line changed, or without it."""
    lines = text.splitlines()
    for at, line in enumerate(lines):
        words = shlex.split(line) if line.startswith(("ros2 run", "rviz2")) else []
        if not {*TOLD} & {*words} or "  # " in line:
            continue
        for number, word in enumerate(words):
            if word == "-p" or word.startswith("use_sim_time:="):
                continue
            for other in ([f"{word}X"], []):
                own = shlex.join([*words[:number], *other, *words[number + 1 :]])
                yield own, "\n".join([*lines[:at], own, *lines[at + 1 :], ""])


def check(made: Outputs) -> None:
    text = commands(made)
    assert not_as_commanded(made.starts, text) == []
    every = [*changes(text)]
    assert len(every) > 10
    assert [line for line, changed in every if not not_as_commanded(made.starts, changed)] == []


@pytest.mark.more
@pytest.mark.parametrize("kind", FLEETS)
def test_whatever_word_is_changed_is_noticed(kind: str, tmp_path: Path) -> None:
    check(of_kind(tmp_path, kind))


@pytest.mark.slow
@pytest.mark.parametrize("name", EXAMPLES)
def test_whatever_word_of_an_example_is_changed_is_noticed(name: str) -> None:
    check(example(name)[1])


def test_a_build_says_the_line(tmp_path: Path) -> None:
    plan, made = example("two_robots_nav2")
    files = [
        it._replace(data=it.data.replace(b"-name robot2", b"-name robot1")) for it in made.files
    ]
    assert files != [*made.files]
    found = read_back(plan, made._replace(files=tuple(files)), "/any/out")
    own = [it for it in found if it.file == "commands.md"]
    assert [it.code for it in own] == ["MF823"]
    assert own[0].message == (
        "robot2: ros_gz_sim/create: arguments[1] is 'robot1', planned is 'robot2'"
    )


def test_a_line_that_is_missing_is_noticed() -> None:
    _, made = example("two_robots_nav2")
    text = commands(made)
    line = next(it for it in text.splitlines() if " create -name robot2 " in it)
    (found,) = not_as_commanded(made.starts, text.replace(f"{line}\n", ""))
    assert found == "robot2: ros_gz_sim/create is planned and is not started"
