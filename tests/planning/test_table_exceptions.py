# SPDX-License-Identifier: Apache-2.0
"""Names a remap table treats in a way of their own: image transports, names made at run time, kinds."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from multibot_rewrite.base.naming import Naming, make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.checks.meeting import robots_meet
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.planning.records import Run, Table
from multibot_rewrite.planning.table import build_table
from multibot_rewrite.system.records import (
    PUBLISHES,
    SUBSCRIBES,
    TOPIC,
)

ROBOTS = ("robot1", "robot2")
# The packages of image_transport_plugins; raw is the topic itself.
TRANSPORTS = ("compressed", "compressedDepth", "theora", "zstd")
NAMESPACED = ("tf-per-robot", "frames-per-robot", "both")


def node(name: str, *endpoints: Endpoint) -> NodeFacts:
    return NodeFacts(name, "pack", endpoints)


def table(layout: str, *nodes: NodeFacts) -> Table:
    naming = make_naming(layout)
    return with_meetings(build_table(ROBOTS, nodes, naming, release=NEWEST_LTS), naming)


def with_meetings(made: Table, naming: Naming) -> Table:
    return made._replace(problems=(*made.problems, *robots_meet(made, (), naming)))


def rules(made: Table, robot: str = "robot1") -> dict[str, str]:
    return dict(it for one in made.runs if one.robot == robot for it in one.rules)


def problems(made: Table) -> list[tuple[str, str]]:
    return [(it.code, it.node) for it in made.problems]


# Image transports.


@pytest.mark.parametrize("transport", TRANSPORTS)
def test_every_image_transport_is_moved_with_its_topic(transport: str) -> None:
    camera = node("camera", Endpoint(TOPIC, PUBLISHES, "image_raw", transport=True))
    made = rules(table("postfix", camera))
    assert made["image_raw"] == "image_raw/robot1"
    assert made[f"image_raw/{transport}"] == f"image_raw/robot1/{transport}"
    camera = node("camera", Endpoint(TOPIC, PUBLISHES, "/image_raw", transport=True))
    assert rules(table("both", camera))[f"/image_raw/{transport}"] == f"image_raw/{transport}"


@pytest.mark.parametrize("transport", TRANSPORTS)
def test_who_asks_for_one_image_transport_by_name_meets_the_camera(transport: str) -> None:
    asked = f"image_raw/{transport}"
    camera = node("camera", Endpoint(TOPIC, PUBLISHES, "image_raw", transport=True))
    viewer = node("viewer", Endpoint(TOPIC, SUBSCRIBES, asked))
    made = table("postfix", camera, viewer)
    sent, heard = (
        [it.rules for it in made.runs if it.node == name] for name in ("camera", "viewer")
    )
    for one, other in zip(sent, heard, strict=True):
        targets = dict(one)
        assert [*other] == [(asked, targets[asked])]


# Names that are made at run time.


@pytest.mark.parametrize("layout", NAMESPACED)
def test_a_relative_name_made_at_run_time_follows_its_namespace(layout: str) -> None:
    made = table(layout, node("driver", Endpoint(TOPIC, PUBLISHES, "<sensor>/image")))
    assert problems(made) == []


@pytest.mark.parametrize("layout", NAMESPACED)
def test_an_absolute_name_made_at_run_time_leaves_its_namespace(layout: str) -> None:
    made = table(layout, node("driver", Endpoint(TOPIC, PUBLISHES, "/<sensor>/image")))
    assert problems(made) == [("MR101", "driver")]
    assert "/<sensor>/image" in made.problems[0].message


@pytest.mark.parametrize("name", ["<sensor>/image", "/<sensor>/image"])
def test_a_name_made_at_run_time_gets_no_postfix(name: str) -> None:
    made = table("postfix", node("driver", Endpoint(TOPIC, PUBLISHES, name)))
    assert problems(made) == [("MR101", "driver")]


# Names of two robots that are alike.


def alike(*pairs: tuple[str, Sequence[Endpoint]]) -> Table:
    """Return the table of two robots' plugins, whose nodes ask for names which no rule moves."""
    plugins = {
        robot: [Run(robot, "p", "/", f"{robot}_plugin", (), node(f"{robot}_plugin", *ends))]
        for robot, ends in pairs
    }
    naming = make_naming("both")
    return with_meetings(build_table(ROBOTS, (), naming, plugins, release=NEWEST_LTS), naming)


def both(first: Endpoint, second: Endpoint) -> list[tuple[str, str]]:
    return problems(alike(("robot1", [first]), ("robot2", [second])))
