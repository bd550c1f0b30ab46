# SPDX-License-Identifier: Apache-2.0
"""``nodes.yaml`` says of each release what its sources say, or an exception says why not.

``fixtures/interfaces/RELEASE.tsv.xz`` is what ``python -m tools.interfaces`` found in the
checkouts that ``fixtures/interfaces/sources.tsv`` lists.
"""

from __future__ import annotations

import re
from functools import cache

import pytest
from paths import FIXTURES

from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.knowledge.node_sets import built_in
from tools.interfaces.compare import (
    OURS,
    THEIRS,
    WAY,
    Difference,
    differences,
    excepted,
    exceptions_of,
)
from tools.interfaces.table import Fact, from_table, read_packed

EXCEPTIONS = exceptions_of((FIXTURES / "interfaces_exceptions.tsv").read_text())
LEAST_FACTS = 400
TF = "tf2_msgs/msg/TFMessage"


@cache
def facts(release: str) -> tuple[Fact, ...]:
    return from_table(read_packed(FIXTURES / "interfaces" / f"{release}.tsv.xz"))


@cache
def found(release: str) -> frozenset[Difference]:
    return frozenset(differences(facts(release), built_in(release)))


@pytest.mark.parametrize("release", RELEASES)
def test_nothing_was_lost(release: str) -> None:
    assert len(facts(release)) >= LEAST_FACTS


@pytest.mark.parametrize("release", RELEASES)
def test_every_fact_has_its_source(release: str) -> None:
    rows = (FIXTURES / "interfaces/sources.tsv").read_text().splitlines()[1:]
    known = {tuple(row.split("\t"))[:3] for row in rows}
    assert {(release, it.place.repository, it.place.version) for it in facts(release)} <= known
    assert all(it.place.path and it.place.line > 0 for it in facts(release))


@pytest.mark.slow
@pytest.mark.parametrize("release", RELEASES)
def test_every_difference_is_excepted(release: str) -> None:
    new = [it for it in found(release) if not excepted(it, EXCEPTIONS)]
    assert sorted(new) == []


@pytest.mark.slow
def test_every_exception_is_needed_and_says_why() -> None:
    every = {it for release in RELEASES for it in found(release)}
    unused = [it for it in EXCEPTIONS if not any(excepted(one, (it,)) for one in every)]
    assert unused == []
    assert all(len(it.reason.split()) >= 4 for it in EXCEPTIONS)


def of(release: str, node: str, role: str, name: str) -> set[tuple[str, str]]:
    """Type and way of what the sources say about a name."""
    return {(it.type, it.way) for it in facts(release) if it[:3] == (node, role, name)}


# From the sources by hand: slam_toolbox_common.cpp:123 and ros_filter.cpp:116 of
# robot_localization make TransformListener(*buffer); amcl_node.cpp:1522 of 1.3.13 gives it itself.
@pytest.mark.parametrize(
    ("node", "way"), [("slam_toolbox", "helper"), ("ekf_filter_node", "helper"), ("amcl", "")]
)
def test_who_listens(node: str, way: str) -> None:
    assert of("jazzy", node, "subscribes", "/tf") == {(TF, way)}


def test_who_sends_nothing() -> None:
    for release in RELEASES:
        assert not of(release, "docking_server", "publishes", "/tf")
        assert not of(release, "navsat_transform_node", "publishes", "/tf")
        assert of(release, "navsat_transform_node", "publishes", "/tf_static")


def test_the_planning_scene_is_of_a_private_node() -> None:
    own = {it.way for it in facts("jazzy") if it.type == "moveit_msgs/msg/PlanningScene"}
    assert own == {"private _"}


def difference(name: str, **changed: str) -> set[str]:
    """Return what is said of amcl's initial pose, if the sources had it another way."""
    rest = [it for it in facts("jazzy") if it.node == "amcl" and it.name != "initialpose"]
    (fact,) = (it for it in facts("jazzy") if it[:3] == ("amcl", "subscribes", "initialpose"))
    made = differences([*rest, fact._replace(name=name, **changed)], built_in("jazzy"))
    return {it.what for it in made if it.name in ("initialpose", name)}


def test_a_difference_is_seen() -> None:
    assert difference("initialpose") == set()
    assert difference("initial_pose") == {OURS, THEIRS}
    assert difference("initialpose", type="geometry_msgs/msg/Pose") == {OURS, THEIRS}
    assert difference("initialpose", role="publishes") == {OURS, THEIRS}
    assert difference("initialpose", way="helper") == {WAY}
    assert difference("<topic>") == set()


def test_exceptions_are_patterns() -> None:
    (one,) = exceptions_of("node\trole\tname\twhat\treason\nam*\t*\tx/*\tanother way\tfor a test\n")
    seen = Difference("amcl", "serves", "x/y", "", WAY)
    assert excepted(seen, (one,)) == "for a test"
    assert not re.search("x", excepted(seen._replace(name="y"), (one,)))
