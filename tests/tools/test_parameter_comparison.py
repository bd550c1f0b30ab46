# SPDX-License-Identifier: Apache-2.0
"""Our table of parameters is what the sources of each release say, or an exception says why not.

``fixtures/interfaces/parameters_RELEASE.tsv.xz`` is made by ``python -m
tools.interfaces.parameter_tables``; ``parameters_exceptions.tsv`` has kind, subject, path
and reason, ``parameters_corrected.tsv`` what was wrong once, with its releases.
"""

from __future__ import annotations

from functools import cache

import pytest
from paths import FIXTURES

from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.knowledge.declared import DECLARED, YAML
from multibot_rewrite.knowledge.node_sets import every_release
from multibot_rewrite.producers.sources.records import Place
from tools.interfaces.declared_table import plugin_owners
from tools.interfaces.parameter_comparison import (
    DEFAULT,
    MISSING,
    UNKNOWN,
    Difference,
    OurParameter,
    differences,
    our_parameters,
    same,
)
from tools.interfaces.parameter_facts import ParameterFact, parameter_lines, read_parameters
from tools.interfaces.table import read_packed

TABLES = FIXTURES / "interfaces"
LEAST_FACTS = 1400
PLACE = Place("acme/nav", "1.0.0", "nav/src/nav.cpp", 1)
NONE: dict[str, str] = {}


def rows(file: str) -> list[list[str]]:
    return [line.split("\t") for line in (TABLES / file).read_text().splitlines()]


EXCEPTIONS = {
    (kind, subject, path): reason
    for kind, subject, path, reason in rows("parameters_exceptions.tsv")
}


@cache
def facts(release: str) -> tuple[ParameterFact, ...]:
    return read_parameters(read_packed(TABLES / f"parameters_{release}.tsv.xz"))


@cache
def found(release: str) -> tuple[Difference, ...]:
    ours = our_parameters(every_release().parameters.values())
    return tuple(differences(ours, facts(release), release, plugin_owners().below))


@pytest.mark.slow
@pytest.mark.parametrize("release", RELEASES)
def test_every_difference_is_excepted(release: str) -> None:
    assert [it for it in found(release) if it.key not in EXCEPTIONS] == []


@pytest.mark.slow
def test_every_exception_is_needed_and_says_why() -> None:
    needed = {it.key for release in RELEASES for it in found(release)}
    assert sorted(EXCEPTIONS.keys() - needed) == []
    assert all(len(reason.split()) >= 3 for reason in EXCEPTIONS.values())


@pytest.mark.slow
def test_what_was_corrected_stays_so() -> None:
    wrong = {(*it.key, it.release) for release in RELEASES for it in found(release)}
    corrected = {
        (kind, subject, path, release)
        for kind, subject, path, words in rows("parameters_corrected.tsv")
        for release in words.split()
    }
    assert len(corrected) > 100
    assert corrected & wrong == set()


@pytest.mark.parametrize("release", RELEASES)
def test_nothing_was_lost(release: str) -> None:
    """Each fact has a place, and files of all kinds are read."""
    assert len(facts(release)) >= LEAST_FACTS
    assert all(it.place.repository and it.place.version and it.place.line for it in facts(release))
    assert {it.how for it in facts(release)} == {"yaml", "declared", "read"}
    assert len({it.place.repository for it in facts(release)}) >= 14


@pytest.mark.parametrize("release", RELEASES)
def test_a_table_is_read_as_it_is_written(release: str) -> None:
    text = read_packed(TABLES / f"parameters_{release}.tsv.xz")
    assert "".join(f"{it}\n" for it in parameter_lines(facts(release))) == text


@pytest.mark.parametrize(
    ("release", "package", "path", "default"),
    [
        ("humble", "nav2_behaviors", "global_frame", "odom"),
        ("jazzy", "nav2_behaviors", "global_frame", "map"),
        ("humble", "nav2_amcl", "base_frame_id", "base_footprint"),
        ("lyrical", "nav2_amcl", "saved_pose_filepath", "/tmp/amcl_saved_pose"),
        ("jazzy", "joint_state_publisher", "rate", "10"),
        ("kilted", "joint_state_broadcaster", "publish_dynamic_joint_states", "true"),
        ("rolling", "steering_controllers_library", "tf_frame_prefix", '""'),
        ("jazzy", "rosbridge_server", "port", "9090"),
        ("jazzy", "slam_toolbox", "scan_topic", "/scan"),
    ],
)
def test_a_fact_that_was_looked_up_by_hand(
    release: str, package: str, path: str, default: str
) -> None:
    assert default in {
        it.default for it in facts(release) if (it.package, it.path) == (package, path)
    }


def test_a_parameter_that_is_gone_is_not_there() -> None:
    """ros2_controllers 6.8.0: Remove dynamic_joint_states."""
    gone = ("joint_state_broadcaster", "publish_dynamic_joint_states")
    assert gone not in {(it.package, it.path) for it in facts("lyrical")}
    assert gone in {(it.package, it.path) for it in facts("jazzy")}


def fact(path: str, type_: str = "string", default: str = "", how: str = DECLARED) -> ParameterFact:
    return ParameterFact("nav", "Nav", path, type_, default, "", "", how, PLACE)


def ours(path: str, kind: str = "frame", default: str = "", releases: str = "") -> OurParameter:
    return OurParameter("nav", ("nav",), path, kind, default, releases)


@pytest.mark.parametrize(
    ("row", "source", "kinds"),
    [
        pytest.param(ours("base_frame"), fact("base_frame", default='""'), [], id="agree"),
        pytest.param(ours("base", default="a"), fact("base", default="b"), [DEFAULT], id="default"),
        pytest.param(ours("base", default="a"), fact("base"), [], id="default-not-in-the-text"),
        pytest.param(ours("base"), fact("frame"), [MISSING, UNKNOWN], id="another-name"),
        pytest.param(ours("base", releases="lyrical+"), fact("rate", "double"), [], id="later-release"),
        pytest.param(ours("base", kind="keep"), fact("rate", "double"), [], id="no-name"),
        pytest.param(ours("frame", kind="keep"), fact("frame"), [], id="known-to-be-none"),
        pytest.param(ours("rate", "keep"), fact("goal", default="odom"), [UNKNOWN], id="by-default"),
        pytest.param(ours("rate", kind="keep"), fact("goal", default="a/b"), [UNKNOWN], id="by-slash"),
        pytest.param(ours("rate", kind="keep"), fact("frame", "double"), [], id="a-number"),
        pytest.param(ours("<id>.topic", "topic"), fact("topic", how=YAML), [], id="below-a-prefix"),
    ],
)  # fmt: skip
def test_a_difference_is_noticed(
    row: OurParameter, source: ParameterFact, kinds: list[str]
) -> None:
    assert [it.kind for it in differences([row], [source], "jazzy", NONE)] == kinds


def test_a_package_that_is_not_read_is_not_compared() -> None:
    other = ours("base_frame")._replace(packages=("elsewhere",))
    assert list(differences([other], [fact("rate", "double")], "jazzy", NONE)) == []


@pytest.mark.parametrize(
    ("own", "source", "equal"),
    [
        ("<id>.<id>.topic", "<id>.<id>.topic", True),
        ("gains.<joint>.*", "gains.<dof_names>.p", True),
        ("odom<index>", "odom0", True),
        ("topics.<id>.topic", "<id>.topic", True),
        ("<id>.topic", "topic", False),
        ("base_frame", "<id>_frame", True),
        ("frame_id", "frame", False),
        ("a.b", "a_b", False),
    ],
)
def test_paths_are_compared_by_segments(own: str, source: str, equal: bool) -> None:
    assert same(own, source) == equal
