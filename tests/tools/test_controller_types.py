# SPDX-License-Identifier: Apache-2.0
"""Every controller type that packages register is known, in the releases that have it.

``fixtures/interfaces/controller_types.tsv`` has the types of their plugin files; the checkouts that it
was made from are those of ``sources.tsv``.
"""

from __future__ import annotations

import pytest
from paths import FIXTURES

from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.knowledge.parameters import built_in_nodes
from multibot_rewrite.knowledge.stacks import built_in

ROWS = [
    line.split("\t")
    for line in (FIXTURES / "interfaces/controller_types.tsv").read_text().splitlines()[1:]
]
# These have a branch for every release.
WHOLE = ("ros2_controllers", "Universal_Robots_ROS2_Driver")


@pytest.mark.parametrize("release", RELEASES)
def test_a_registered_type_is_known(release: str) -> None:
    nodes, types = built_in(release).nodes, built_in_nodes(release).types
    there = {type_ for type_, _, releases in ROWS if release in releases.split()}
    assert len(there) >= 35
    assert sorted(it for it in there if types.get(it) not in nodes) == []


@pytest.mark.parametrize("release", RELEASES)
def test_no_controller_of_another_release_is_known(release: str) -> None:
    nodes, types = built_in(release).nodes, built_in_nodes(release).types
    every = {types[type_] for type_, repository, _ in ROWS if repository in WHOLE}
    there = {types[type_] for type_, _, releases in ROWS if release in releases.split()}
    assert sorted((every & nodes.keys()) - there) == []
