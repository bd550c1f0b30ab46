# SPDX-License-Identifier: Apache-2.0
"""Random trees whose xacro prefixes some of the names: the text for a robot is known beforehand."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import pytest
from hypothesis import example, given, settings, strategies as st

from multibot_rewrite import RewriteRefused
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.description import pipeline
from multibot_rewrite.description.library import rewrite_job
from multibot_rewrite.description.sources.job import Job, job_for
from multibot_rewrite.description.steps.strip import own_places

LINKS = ("base", "x", "x_robot1", "robot1_x", "x/robot1", "robot1/x", "arm", "left_arm", "arm_left")
ROBOTS = st.sampled_from(("robot1", "left", "b", "robot_10"))
VALUES = st.sampled_from(("{robot}_", "{robot}/", "my_{robot}_", "{robot}"))
Names = Callable[[str, str], str]


class Tree(NamedTuple):
    """Links and the joints between them; ``reached`` are the names with the argument."""

    links: tuple[str, ...]
    joints: tuple[str, ...]
    parents: tuple[int, ...]
    reached: frozenset[tuple[str, str]]

    def text(self, names: Names, model: str) -> bytes:
        """Return the description with these names."""
        rows = [f'  <link name="{names("link", it)}"/>' for it in self.links]
        for at, joint in enumerate(self.joints):
            parent, child = self.links[self.parents[at]], self.links[at + 1]
            rows.append(f'  <joint name="{names("joint", joint)}" type="fixed">')
            rows.append(f'    <parent link="{names("link", parent)}"/>')
            rows.append(f'    <child link="{names("link", child)}"/>\n  </joint>')
            rows.append(f'  <gazebo reference="{names("link", child)}"><mu1>1</mu1></gazebo>')
        return "\n".join([f'<robot name="{model}">', *rows, "</robot>"]).encode()

    def source(self, value: str) -> bytes:
        """Return what xacro makes of it."""
        return self.text(lambda kind, it: value * ((kind, it) in self.reached) + it, "m")


@st.composite
def trees(draw: st.DrawFn) -> Tree:
    links = draw(st.lists(st.sampled_from(LINKS), min_size=1, max_size=5, unique=True))
    joints = draw(
        st.lists(
            st.sampled_from(LINKS), min_size=len(links) - 1, max_size=len(links) - 1, unique=True
        )
    )
    parents = tuple(draw(st.integers(0, at)) for at in range(len(joints)))
    every = [*(("link", it) for it in links), *(("joint", it) for it in joints)]
    reached = draw(st.frozensets(st.sampled_from(every)))
    return Tree(tuple(links), tuple(joints), parents, reached)


policies = st.fixed_dictionaries(
    {
        "layout": st.sampled_from(("postfix", "frames-per-robot", "tf-per-robot")),
        "affix": st.sampled_from(("prefix", "postfix")),
        "separators": st.fixed_dictionaries({"link": st.sampled_from("/_")}),
    }
)


def by_hand(policy: Mapping[str, Any], robot: str, kind: str, name: str) -> str:
    """Return a name as the rewrite spells it."""
    if policy["layout"] == "tf-per-robot":
        return name
    mark = policy["separators"]["link"] if kind == "link" else "_"
    return f"{robot}{mark}{name}" if policy["affix"] == "prefix" else f"{name}{mark}{robot}"


# An argument makes of one link what the rewrite makes of another.
MET = Tree(("arm_left", "left_arm"), ("x",), (0,), frozenset({("link", "arm_left")}))
POSTFIX = {"layout": "postfix", "affix": "postfix", "separators": {"link": "_"}}


@pytest.mark.slow
@settings(max_examples=80, deadline=None)
@given(trees(), policies, ROBOTS, VALUES)
@example(MET, POSTFIX, "left", "{robot}_")
def test_every_name_has_the_robots_name_once(
    tree: Tree, policy: dict[str, Any], robot: str, value: str
) -> None:
    naming = make_naming(**policy)

    def read(arguments: Mapping[str, str]) -> Job:
        return Job(tree.source(arguments.get("p", "")), "random", naming, (), None, NEWEST_LTS)

    job = job_for(read, {"p": value}, [robot])
    filled = value.replace("{robot}", robot)

    def names(kind: str, name: str) -> str:
        reached = (kind, name) in tree.reached
        return filled + name if reached else by_hand(policy, robot, kind, name)

    links = [names("link", it) for it in tree.links]
    joints = [names("joint", it) for it in tree.joints]
    try:
        (made,) = rewrite_job(job, [robot])
    except RewriteRefused as refused:
        assert _may_be_refused(tree, links, joints, robot, filled), refused
        return
    assert made.data == tree.text(names, by_hand(policy, robot, "model", "m"))
    template = made.template
    before = own_places(template.inventory, job.naming)
    assert bool(before) == bool(tree.reached)
    back = pipeline.strip(made.data, "random", robot, job.naming, job.tree, before=job.data)
    assert back == job.data


def _may_be_refused(
    tree: Tree, links: list[str], joints: list[str], robot: str, filled: str
) -> bool:
    """Two names become one, or are one already, or a name that no argument made holds the robot's."""
    source = [filled * (("link", it) in tree.reached) + it for it in tree.links]
    twice = len(set(links)) < len(links) or len(set(joints)) < len(joints)
    plain = [it for kind, it in _plain(tree) if robot in it]
    return twice or len(set(source)) < len(source) or bool(plain) or _met(source, links)


def _plain(tree: Tree) -> list[tuple[str, str]]:
    every = [*(("link", it) for it in tree.links), *(("joint", it) for it in tree.joints)]
    return [it for it in every if it not in tree.reached]


def _met(source: list[str], links: list[str]) -> bool:
    """Return whether another name becomes a name of the source."""
    return any(new != old and new in source for old, new in zip(source, links, strict=True))
