# SPDX-License-Identifier: Apache-2.0
"""Our node sets are what the launch files of each release start, or an exception says why not.

``fixtures/interfaces/launch_exceptions.tsv`` has kind, node set, node (and rule) and the reason.
"""

from __future__ import annotations

from functools import cache

import pytest
from paths import FIXTURES, ROOT

from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.producers.sources.records import Place
from tools.interfaces.launch_comparison import (
    NOT_OURS,
    NOT_STARTED,
    RULE_MISSING,
    RULE_NOT_THERE,
    LaunchDifference,
    SetNode,
    launch_differences,
    launch_files,
    nodes_of_sets,
)
from tools.interfaces.launch_files import LaunchedNode
from tools.interfaces.parameter_tables import LaunchFact, launch_lines, read_launches
from tools.interfaces.table import read_packed

TABLES = FIXTURES / "interfaces"
NODE_SETS = (ROOT / "multibot_rewrite" / "knowledge" / "node_sets.yaml").read_text()
EXCEPTIONS = {
    LaunchDifference(*words): why
    for *words, why in (
        it.split("\t") for it in (TABLES / "launch_exceptions.tsv").read_text().splitlines()
    )
}


@cache
def facts(release: str) -> tuple[LaunchFact, ...]:
    return read_launches(read_packed(TABLES / f"launch_{release}.tsv.xz"))


@cache
def found(release: str) -> tuple[LaunchDifference, ...]:
    return tuple(
        it
        for node_set, paths in launch_files().items()
        for it in launch_differences(
            node_set, nodes_of_sets(NODE_SETS, node_set, release), facts(release), paths
        )
    )


@pytest.mark.slow
@pytest.mark.parametrize("release", RELEASES)
def test_every_difference_is_excepted(release: str) -> None:
    assert [it for it in found(release) if it not in EXCEPTIONS] == []


@pytest.mark.slow
def test_every_exception_is_needed_and_says_why() -> None:
    needed = {it for release in RELEASES for it in found(release)}
    assert sorted(EXCEPTIONS.keys() - needed) == []
    assert all(len(reason.split()) >= 3 for reason in EXCEPTIONS.values())


@pytest.mark.more
def test_what_was_corrected_stays_so() -> None:
    rows = [it.split("\t") for it in (TABLES / "launch_corrected.tsv").read_text().splitlines()]
    assert len(rows) >= 9
    for *words, releases in rows:
        for release in releases.split():
            assert LaunchDifference(*words) not in found(release)


@pytest.mark.parametrize("release", RELEASES)
def test_a_table_is_read_as_it_is_written(release: str) -> None:
    text = read_packed(TABLES / f"launch_{release}.tsv.xz")
    assert "".join(f"{it}\n" for it in launch_lines(facts(release))) == text


@pytest.mark.slow
@pytest.mark.parametrize(
    ("node", "releases"),
    [
        ("route_server", ("jazzy", "kilted", "lyrical", "rolling")),
        ("docking_server", ("jazzy", "kilted", "lyrical", "rolling")),
        ("collision_monitor", ("jazzy", "kilted", "lyrical", "rolling")),
        ("following_server", ("lyrical", "rolling")),
        ("velocity_smoother", RELEASES),
    ],
)
def test_a_node_of_navigation_by_release(node: str, releases: tuple[str, ...]) -> None:
    started = [it for it in RELEASES if node in {fact.node.name for fact in facts(it)}]
    there = [
        it
        for it in RELEASES
        if node in {n.name for n in nodes_of_sets(NODE_SETS, "navigation", it)}
    ]
    assert tuple(started) == tuple(there) == releases


PLACE = Place("acme/nav", "1.0.0", "nav/launch/a.launch.py", 1)
PATHS = ("nav/a.launch.py",)


def launched(name: str, remaps: str = "", executable: str = "server") -> LaunchFact:
    return LaunchFact("nav", LaunchedNode("node", "nav", executable, name, "", remaps, 1), PLACE)


def ours(name: str, *rules: str) -> SetNode:
    return SetNode(name, name, frozenset(rules))


@pytest.mark.parametrize(
    ("node", "fact", "kinds"),
    [
        pytest.param(ours("amcl"), launched("amcl"), [], id="agree"),
        pytest.param(ours("server"), launched(""), [], id="its-own-name"),
        pytest.param(ours("a"), launched("b"), [NOT_STARTED, NOT_OURS], id="another-node"),
        pytest.param(ours("a"), launched("a", "x:=y"), [RULE_MISSING], id="a-rule-more"),
        pytest.param(ours("a", "x:=y"), launched("a"), [RULE_NOT_THERE], id="a-rule-less"),
        pytest.param(ours("a"), launched("a", "/tf:=tf x:=x"), [], id="no-rule-of-the-node-set"),
    ],
)
def test_a_difference_is_noticed(node: SetNode, fact: LaunchFact, kinds: list[str]) -> None:
    assert [it.kind for it in launch_differences("s", [node], [fact], PATHS)] == kinds


def test_a_release_without_the_file_is_not_compared() -> None:
    assert list(launch_differences("s", [ours("a")], [launched("b")], ("nav/other.py",))) == []
