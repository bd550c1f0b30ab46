# SPDX-License-Identifier: Apache-2.0
"""What is known of a node stands in two tables: its names in knowledge/*.yaml, its parameters in
related_files/params/params.yaml. They may not say two things of one node, in any release."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from multibot_rewrite.base.releases import RELEASES, has_release
from multibot_rewrite.knowledge.conditions import ALSO
from multibot_rewrite.knowledge.declared import declared_by
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.knowledge.parameters import built_in_nodes
from multibot_rewrite.knowledge.records import Branch, NodeFacts, NodeParameters, Param

# Without a section in parameter files: a Lua file, a file of its own, no parameters but actions.
NO_PARAMETERS = {"cartographer_node", "rviz2", "ros_gz_bridge", "trajectory_until_node"}
# Their parameters are those of another node, by an alias.
LIKE = {
    "joint_state_publisher_gui": "joint_state_publisher",
    "bicycle_steering_controller": "ackermann_steering_controller",
    "tricycle_steering_controller": "ackermann_steering_controller",
}
NAMES = {"topic", "service", "namespace", "node", "text", "stem", "words", "keep"}
FRAMES = {"frame", "link"}
# The parameter names one topic; the node makes this one of it.
MADE = ("_updates", "_metadata")


def params_of(node: NodeParameters, path: str) -> Iterator[Param]:
    """Every parameter that may have this path."""
    branches = [node.tree]
    for segment in path.split("."):
        branches = [below for it in branches for below in _below(it, segment)]
    yield from (param for it in branches for param in it.params)


def _below(branch: Branch, segment: str) -> Iterator[Branch]:
    if segment in branch.exact:
        yield branch.exact[segment]
    numbered = re.fullmatch(r"(.*?)(\d+|N)", segment)
    if numbered and numbered[1] in branch.numbered:
        yield branch.numbered[numbered[1]]
    yield from branch.wild.values()


def both(release: str) -> Iterator[tuple[NodeFacts, NodeParameters | None]]:
    params, library = built_in_nodes(release), built_in(release)
    for facts in library.nodes.values():
        name = facts.name.rpartition("/")[2]
        yield facts, params.nodes.get(params.names.get(name, ""))


@pytest.mark.parametrize("release", RELEASES)
def test_a_node_of_both_tables_is_of_one_package(release: str) -> None:
    found = {
        it.name: (it.package, node.package)
        for it, node in both(release)
        if node and it.package != node.package and LIKE.get(it.name) != node.name
    }
    assert found == {}


@pytest.mark.parametrize("release", RELEASES)
def test_a_parameter_that_names_something_is_known_as_a_name(release: str) -> None:
    found = []
    for facts, node in both(release):
        if facts.name in NO_PARAMETERS:
            continue
        ends = [it.parameter for it in facts.endpoints if it.parameter]
        wanted = [(one, NAMES) for it in ends for one in it.split(ALSO)]
        named = (it.parameter for it in facts.frames)
        wanted += [(it, FRAMES) for it in named if "<" not in it]
        for path, kinds in wanted:
            there = {it.kind for it in params_of(node, path)} if node else set()
            if not there & kinds:
                found.append((facts.name, path, there))
    assert found == []


@pytest.mark.parametrize("release", RELEASES)
def test_what_a_frame_is_made_of_has_the_default_of_its_parameter(release: str) -> None:
    made = 0
    for facts, node in both(release):
        for path, default in re.findall(
            "<([^<>=]+)=([^<>]*)>", " ".join(it.parameter for it in facts.frames)
        ):
            known = params_of(node, path) if node else ()
            assert all(it.kind == "keep" or it.default == default for it in known), path
            assert known or not default, path
            made += 1
    assert made


@pytest.mark.parametrize("release", RELEASES)
def test_a_parameter_that_a_package_declares_in_a_release_is_there_in_it(release: str) -> None:
    lacking = [
        (node.name, it.path)
        for node in built_in_nodes(release).nodes.values()
        for owner in (node.package, *node.declared_in)
        for it in declared_by(owner)
        if it.path in node.params
        and has_release(it.releases, release)
        and not has_release(node.params[it.path].releases, release)
    ]
    assert lacking == []


@pytest.mark.parametrize("release", RELEASES)
def test_both_tables_have_the_same_defaults(release: str) -> None:
    found = []
    for facts, node in both(release):
        given = [(it.parameter, it.default) for it in facts.frames]
        given += [
            (it.parameter, it.name)
            for it in facts.endpoints
            if it.parameter and "<" not in it.name + it.parameter and not it.name.endswith(MADE)
        ]
        for path, default in given:
            other = {it.default for it in params_of(node, path)} - {""} if node else set()
            if other and default not in other:
                found.append((facts.name, path, default, other))
    assert found == []
