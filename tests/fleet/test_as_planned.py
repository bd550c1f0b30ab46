# SPDX-License-Identifier: Apache-2.0
"""How bad it is that a built folder is other than its plan: by whom it is, and what it may lack."""

from __future__ import annotations

import pytest
from graph_examples import read_example

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.checks.as_planned import not_as_planned
from multibot_rewrite.producers.launch.launched import NOT_WHOLE
from multibot_rewrite.system.records import Caveat, Environment

AMCLS = "".join(
    f"planned: frames of robot{it} on /tf: robot{it}/odom, robot{it}/base_link\n"
    f"as planned: /robot{it}/amcl publishes /tf tf2_msgs/msg/TFMessage\n"
    for it in (1, 2)
)
MAP = "running: transform map -> {} on /tf by /robot{}/amcl\n"
BASE = "running: transform robot1/base_link -> robot1/laser on /tf by /robot1/driver\n"


def levels(lines: str, *caveats: Caveat) -> set[str]:
    """Code and level of what is said of transforms."""
    plan, seen = read_example(lines)
    seen = seen._replace(environment=Environment(caveats=caveats))
    started = {it.name for it in plan.nodes}
    found = not_as_planned(plan, seen, started, ())
    return {f"{it.code} {it.level}" for it in found if it.code.startswith("MG4")}


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        # What robots do to each other is the build's.
        (MAP.format("odom", 1) + MAP.format("odom", 2), {"MG402 error"}),
        (MAP.format("robot1/odom", 1) + MAP.format("robot2/odom", 2), set()),
        # What one does by its own files is told, and built.
        (MAP.format("robot1/odom", 1) + BASE, {"MG406 warning"}),
    ],
)
def test_how_bad_a_transform_of_a_built_folder_is(lines: str, said: set[str]) -> None:
    assert levels(AMCLS + lines) == said


def test_a_tree_in_pieces_is_not_told_where_more_may_be_started() -> None:
    lines = AMCLS + MAP.format("robot1/odom", 1) + BASE
    assert levels(lines, Caveat(NOT_WHOLE, True, "a program is not known")) == set()
    assert levels(lines, Caveat("note", False, "a stand-in read it")) == {"MG406 warning"}


READERS = """\
planned: /robot1/pilot subscribes /robot1/odom nav_msgs/msg/Odometry as odom
planned: /robot1/drive publishes /robot1/drive/odom nav_msgs/msg/Odometry as ~/odom
running: /robot1/pilot subscribes /robot1/odom nav_msgs/msg/Odometry as odom
running: /robot1/drive publishes /robot1/drive/odom nav_msgs/msg/Odometry as ~/odom
"""


@pytest.mark.parametrize(
    ("told", "said"),
    [
        ((), ["/robot1/pilot error"]),
        # Both readers were told, with names of the sources.
        (
            (
                Finding("MG303", "warning", "one", names=("/odom", "/drive/odom")),
                Finding("MG303", "warning", "other", names=("/odom", "/drive/odom")),
            ),
            ["one error", "other error"],
        ),
        # Nothing else is known to send it.
        ((Finding("MG303", "warning", "alone", names=("/robot1/odom",)),), []),
    ],
)
def test_what_was_told_is_said_as_it_was_told(told: tuple[Finding, ...], said: list[str]) -> None:
    plan, seen = read_example(READERS)
    found = not_as_planned(plan, seen, {it.name for it in plan.nodes}, told)
    about = [it for it in found if it.code == "MG303"]
    assert [f"{it.node or it.message} {it.level}" for it in about] == said
