# SPDX-License-Identifier: Apache-2.0
"""What nodes and node sets are in one release: facts left out, conditional, different, or refused."""

from __future__ import annotations

import pytest
from paths import fixture_text

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.knowledge.node_library import NodeLibrary, extend, nodes_of_set
from multibot_rewrite.knowledge.node_sets import in_release
from multibot_rewrite.knowledge.records import NodeFacts

NOTHING = NodeLibrary({}, {}, {})
DOCK = fixture_text("by_release_dock.yaml")


def library(release: str, text: str = DOCK) -> NodeLibrary:
    return in_release(extend(NOTHING, text, "n.yaml"), release)


def dock(release: str) -> NodeFacts:
    return library(release).nodes["docking_server"]


def conditions(node: NodeFacts) -> dict[str, str]:
    return {it.name: it.when for it in node.endpoints}


def test_what_came_with_a_version_of_the_package_is_conditional_there() -> None:
    found = conditions(dock("jazzy"))
    assert found["staging_pose"] == found["~/reload"] == "version: opennav_docking 1.3.9"
    assert found["dock_pose"] == ""


def test_a_node_that_came_with_a_version_is_conditional_beside_its_own_condition() -> None:
    text = "nodes: {a: {package: p, releases: jazzy 2.0+}}\n"
    text += "node_sets: {s: {nodes: [{node: a, when: asked}]}}"
    (node,) = nodes_of_set(library("jazzy", text), "s")
    assert node.when == "asked and version: p 2.0"


@pytest.mark.parametrize(
    ("release", "names"),
    [("humble", ["camera", "second"]), ("jazzy", ["docking_server", "camera"])],
)
def test_a_node_set_has_the_nodes_of_the_release(release: str, names: list[str]) -> None:
    assert [it.name for it in nodes_of_set(library(release), "all")] == names


@pytest.mark.parametrize(
    ("release", "name", "releases"),
    [
        ("humble", "docks", "jazzy, kilted, lyrical, rolling"),
        ("humble", "docking_server", "jazzy, kilted, lyrical, rolling"),
        ("jazzy", "new", "rolling"),
        ("rolling", "later", "lyrical"),
    ],
)
def test_a_node_set_without_nodes_is_refused_with_the_releases_that_have_it(
    release: str, name: str, releases: str
) -> None:
    with pytest.raises(
        UsageError, match=f"node set .{name}. has no node in {release}; .* {releases};"
    ):
        nodes_of_set(library(release), name)


def test_a_node_set_that_never_has_nodes_is_in_every_release() -> None:
    assert [nodes_of_set(library(it), "nobody") for it in RELEASES] == [()] * 5


def test_two_nodes_of_a_name_may_be_in_different_releases() -> None:
    text = """
nodes: {a: {package: a}, b: {package: b}}
node_sets: {s: {nodes: [{node: a, as: x, releases: <=jazzy}, {node: b, as: x, releases: REST}]}}
"""
    (node,) = nodes_of_set(library("humble", text.replace("REST", "kilted+")), "s")
    assert (node.name, node.package) == ("x", "a")
    with pytest.raises(
        UsageError, match=r"n.yaml:3: node set 's' has two different nodes called 'x'"
    ):
        library("humble", text.replace("REST", "jazzy+"))
