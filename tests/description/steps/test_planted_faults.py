# SPDX-License-Identifier: Apache-2.0
"""Faults planted by chance in the texts and plans of many descriptions: the proof refuses each.

And what holds for further robots, whose texts are not read again.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from typing import cast

import pytest
from case_files import Case, all_cases
from description_calls import (
    NEWEST_LTS,
    Policy,
    Template,
    builtin_tree,
    cut,
    declarations,
    fill,
    make_naming,
)
from hypothesis import given, settings, strategies as st
from paths import ROBOTS
from planted_faults import TOKENS, wrong_plans, wrong_texts
from proof_faults import SOURCES
from random_robots import LAYOUTS, Robot, random_robots

from multibot_rewrite import ProofError, RewriteRefused, rewrite, rewrite_all
from multibot_rewrite.description import pipeline

# Words of a case that are not of its naming.
NO_POLICY = ("again", "file", "urdf", "distro")
CASES = [case for case in all_cases() if case.expect == "changed"]
SOME = CASES[::40]
options = st.fixed_dictionaries(
    {"layout": st.sampled_from(LAYOUTS), "affix": st.sampled_from(("postfix", "prefix"))}
)


def template(case: Case) -> Template:
    """Return the case, ready for any robot."""
    words = {key: it for key, it in case.options.items() if key not in NO_POLICY}
    urdf = case.options.get("urdf")
    tree = builtin_tree((), str(case.options.get("distro", NEWEST_LTS)))
    beside = {} if urdf is None else declarations(urdf.read_bytes(), "", tree)
    naming = make_naming(**cast(Policy, words))
    return pipeline.prepare(case.source, case.name, naming, tree, beside)


def passes(wrong: Template, text: bytes | None = None) -> bool:
    """Is a wrong template, or a wrong text in the place of what it gives, verified all the same?"""
    with pytest.MonkeyPatch.context() as patch:
        if text is not None:
            patch.setattr(pipeline, "fill", lambda pieces, robot: text)
        try:
            list(pipeline.render(wrong, ["robot1"], again=True))
        except ProofError:
            return False
    return True


def proved_texts(right: Template, seed: str, times: int) -> list[str]:
    """Return the wrong texts of a template that are verified."""
    text = fill(right.pieces, "robot1")
    found = wrong_texts(text, random.Random(seed), times)
    return [about for about, wrong in found if passes(right, wrong)]


def proved_plans(right: Template) -> list[str]:
    """Return the wrong plans of a template that are verified."""
    return [about for about, wrong in wrong_plans(right) if passes(wrong)]


@pytest.mark.sample(1)
@pytest.mark.parametrize("case", SOME, ids=lambda case: case.name)
def test_a_wrong_text_of_a_case_is_refused(case: Case) -> None:
    assert proved_texts(template(case), case.name, 3) == []


@pytest.mark.sample(4)
@pytest.mark.slow
@pytest.mark.parametrize("case", SOME, ids=lambda case: case.name)
def test_a_wrong_plan_of_a_case_is_refused(case: Case) -> None:
    assert proved_plans(template(case)) == []


@pytest.mark.deep
@pytest.mark.parametrize("part", range(0, 60, 10))
def test_a_wrong_text_or_plan_of_many_cases_is_refused(part: int) -> None:
    for case in CASES[part::60]:
        right = template(case)
        assert (case.name, proved_texts(right, case.name, 5)) == (case.name, [])
        assert (case.name, proved_plans(right)) == (case.name, [])


def prepared(robot: Robot, words: dict[str, str]) -> Template | None:
    """Return a random robot, ready; None where its names are refused."""
    try:
        naming = make_naming(**words)  # type: ignore[arg-type]
        right = pipeline.prepare(robot.text, "robot", naming, builtin_tree((), NEWEST_LTS))
        list(pipeline.render(right, ["robot1"], again=True))
    except RewriteRefused:
        return None
    return right


@pytest.mark.slow
@given(random_robots(), options, st.integers(0, 9999))
@settings(max_examples=20)
def test_a_wrong_text_or_plan_of_a_random_robot_is_refused(
    robot: Robot, words: dict[str, str], seed: int
) -> None:
    right = prepared(robot, words)
    if right is not None:
        assert proved_texts(right, str(seed), 2) == []
        assert proved_plans(right) == []


def test_every_sort_of_token_is_tried() -> None:
    text = fill(template(SOME[0]).pieces, "robot1") + SOURCES["rover"]
    tried = {about.partition(" ")[0] for about, _ in wrong_texts(text, random.Random("all"), 9)}
    assert tried == {kind.replace(" ", "_") for kind in TOKENS}


# Further robots: a slot for each name of the first one is what holds for them.


def sources() -> Iterator[bytes]:
    """Descriptions of the repository that need nothing beside them."""
    yield from (path.read_bytes() for path in sorted(ROBOTS.glob("*.urdf")))
    yield SOURCES["rover"]
    yield SOURCES["touch"]


@pytest.mark.sample(1)
@pytest.mark.parametrize("source", list(sources()))
@pytest.mark.parametrize("layout", ["tf-per-robot", "frames-per-robot", "both", "postfix"])
def test_each_robot_gets_the_text_that_is_proved_for_it_alone(source: bytes, layout: str) -> None:
    names = ["robot1", "r", "_b", "robot_with_a_long_name", "odom2"]
    together = [it.data for it in rewrite_all(source, names, layout=layout)]
    assert together == [rewrite(source, name, layout=layout).data for name in names]


def test_what_is_right_for_the_first_robot_alone_is_refused() -> None:
    """The first robot's name is in the plan in the place of one slot: its own text is right."""
    right = template(SOME[0])
    first, *others = right.plan.edits
    literal = first._replace(before=first.before + b"robot1" + (first.after or b""), after=None)
    plan = right.plan._replace(edits=[literal, *others])
    wrong = right._replace(plan=plan, pieces=cut(right.inventory.document.source, plan.edits))
    assert fill(wrong.pieces, "robot1") == fill(right.pieces, "robot1")
    with pytest.raises(ProofError, match="slots"):
        list(pipeline.render(wrong, ["robot1", "robot2"]))
