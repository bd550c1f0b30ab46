# SPDX-License-Identifier: Apache-2.0
"""The drawings on the page: a group for each robot, the overview above them, the trees of frames."""

from __future__ import annotations

import re

import pytest
from page_calls import (
    CLASH,
    LEAK,
    MISSING,
    OK,
    UNEXPECTED,
    Crossing,
    DrawnEdge,
    DrawnGroup,
    DrawnName,
    DrawnNode,
    FrameRow,
    FrameTree,
    Outcome,
    Scene,
    Verdict,
    group_svg,
    make_ids,
    make_sections,
    only_common,
    tree_svg,
)

from multibot_rewrite.pages.overview import Tile, overview
from multibot_rewrite.pages.page import graphs, trees
from multibot_rewrite.system.records import PUBLISHES, TOPIC, Environment


def group(robot: str, node: str, *names: str, state: str = OK, common: str = "") -> DrawnGroup:
    """Return a node with its topics; one is what every node has."""
    known = (*names, *filter(None, [common]))
    return DrawnGroup(
        robot, (DrawnNode(node, robot, state),),
        tuple(DrawnName(TOPIC, it, robot, state, ()) for it in known),
        tuple(DrawnEdge(node, TOPIC, PUBLISHES, it, "", state, it == common) for it in known),
    )  # fmt: skip


SHARED = group("", "/tool", "/all")


def scene(*groups: DrawnGroup, **more: object) -> Scene:
    robots = tuple(it.robot for it in groups if it.robot)
    made = Scene(
        Outcome(Verdict.PLANNED, "so"), "both", robots, groups, (), (), (), (), Environment(), (),
        frozenset(),
    )  # fmt: skip
    return made._replace(**more)  # type: ignore[arg-type]


def drawn(made: Scene) -> str:
    return "".join(graphs(made, make_ids(made), make_sections(made)))


def test_groups_below_an_overview() -> None:
    one = group("r<1>", "/r/a", "/r/t", common="/rosout")
    crossing = Crossing("", "/tool", "r<1>", OK, ("publishes /r/t",))
    made = scene(one, SHARED, crossings=(crossing,))
    ids, (first, rest) = make_ids(made), make_sections(made)
    assert drawn(made) == (
        '<section id="graph">\n<h2>Nodes and names</h2>\n<div class="frame"><div class="pane">'
        f"{overview([Tile('r<1>', 'r<1>', '1 node', '#g0', 'good')], [crossing], ['/tool'])}"
        '</div></div>\n<input type="checkbox" id="more"><label for="more">show what every node has:'
        " parameters, life cycle, /rosout, tf, the topics and services of actions</label>\n"
        '<ul class="legend"><li class="ok">as planned</li></ul>\n<div class="groups">\n'
        '<details class="group" id="g0" data-robot="0" open><summary class="good"><b>r&lt;1&gt;</b>'
        " <span>1 node, 2 names</span> <em></em></summary>\n"
        f'<div class="frame"><div class="pane">{group_svg(first.shown, ids, "g0-")}</div></div>\n'
        '<div class="frame more"><div class="pane">'
        f"{group_svg(only_common(one), ids, '')}</div></div>\n</details>\n"
        '<details class="group" id="shared" data-robot="-1" open><summary class="good">'
        "<b>shared and others</b> <span>1 node, 1 name</span> <em></em></summary>\n"
        f'<div class="frame"><div class="pane">{group_svg(rest.shown, ids, "shared-")}</div></div>\n'
        "</details>\n</div>\n</section>\n"
    )
    assert "overview" not in drawn(made._replace(crossings=()))


def test_robots_that_nothing_reaches_are_not_in_the_overview() -> None:
    """What is said of a robot: its findings, else that another uses it, else how many nodes it has."""
    groups = (
        group("a", "/a/x", "/a/t"),
        group("b", "/b/x", "/b/t", state=LEAK),
        group("c", "/c/x"),
    )
    box = DrawnGroup(
        "", (DrawnNode("a", "a", OK, is_robot=True), DrawnNode("/tool", "", OK)), (), ()
    )
    made = scene(*groups, box, crossings=(Crossing("a", "", "b", LEAK, ("calls /b/t",)),))
    text = drawn(made)
    assert text.count('<g class="tile') == 3
    assert ">used by another robot</text>" in text and ">1 node</text>" in text
    assert '<g class="tile odd">' in text and "<title>/tool\nof no robot</title>" in text
    # A box of a robot is no node.
    assert "<b>shared and others</b> <span>1 node, 0 names</span>" in text


def legend(made: Scene) -> list[tuple[str, str]]:
    (listed,) = re.findall('<ul class="legend">(.*?)</ul>\n', drawn(made))
    return re.findall('<li class="(.*?)">(.*?)</li>', listed)


def test_the_legend_has_the_states_that_are_drawn_the_worst_first() -> None:
    made = scene(
        group("a", "/a", state=MISSING), group("b", "/b", state=OK),
        DrawnGroup("", (DrawnNode("/a", "a", OK),), (DrawnName(TOPIC, "/t", "", OK, ()),),
                   (DrawnEdge("/a", TOPIC, PUBLISHES, "/t", "", UNEXPECTED, True),)),
    )  # fmt: skip
    assert legend(made) == [
        ("missing", "missing: in the plan, but not in the graph"),
        ("unexpected", "not in the plan, or with a warning"),
        ("ok", "as planned"),
    ]
    unplanned = made._replace(outcome=Outcome(Verdict.PLANNED, "", planned=False))
    assert legend(unplanned) == [
        ("missing", "missing: something waits for it"),
        ("unexpected", "a tool, or with a warning"),
        ("ok", "nothing wrong seen"),
    ]


@pytest.mark.parametrize(("healthy", "folded"), [(11, False), (12, True)])
def test_many_robots_without_findings_are_folded(healthy: int, folded: bool) -> None:
    groups = [group(f"r{at}", f"/r{at}/a") for at in range(healthy)]
    text = drawn(scene(*groups, group("z", "/z/a", "/z/t", state=CLASH), SHARED))
    title = (
        '<details><summary class="good"><b>12 more robots without findings</b></summary>\n<div>\n'
    )
    assert (title in text) == folded
    assert text.count('<details class="group"') == healthy + 2
    if folded:
        before, _, after = text.partition(title)
        assert before.count("<details") == 2 and after.count("<details") == 12
        assert after.endswith("</details>\n</div></details>\n</div>\n</section>\n")


def test_a_robot_that_is_not_drawn_says_so() -> None:
    groups = [group(f"r{at}", f"/r{at}/a", "/t", state=CLASH) for at in range(31)]
    text = drawn(scene(*groups, SHARED))
    note = "Not drawn: of a large fleet 30 robots are, those with findings first."
    assert text.count(f'<p class="one-of">{note}</p></details>\n') == 1
    assert text.count('<svg class="graph"') == 31


@pytest.mark.parametrize(
    ("running", "said"),
    [
        ((), '<em class="bad">none runs</em>'),
        (("/a/y",), '<em class="good">/a/y runs</em>'),
        (("/a/y", "/a/x"), '<em class="bad">/a/x, /a/y run</em>'),
    ],
)
def test_of_alternatives_one_runs(running: tuple[str, ...], said: str) -> None:
    made = scene(
        group("a", "/a/x"), group("b", "/b/x"), SHARED,
        one_of=(("/a/x", "/a/y"), ("/c/x", "/c/y")), running=frozenset(running),
    )  # fmt: skip
    line = f'<p class="one-of">one of <code>/a/x</code>, <code>/a/y</code>: {said}</p>\n'
    assert drawn(made).count('<p class="one-of">') == drawn(made).count(line) == 1


def tree(
    topic: str, robot: str, *frames: str, received: bool = True, wrong: bool = False
) -> FrameTree:
    faults = ("two parents",) * wrong
    rows = tuple(FrameRow(it, -1, 0, robot, OK, faults, False, False) for it in frames)
    return FrameTree(topic, robot, received, rows)


def panels(*found: FrameTree, robots: str = "a") -> str:
    made = scene(*(group(it, f"/{it}") for it in robots), SHARED, trees=found)
    return "".join(trees(made, make_ids(made)))


def test_the_trees_of_a_topic_are_below_its_name() -> None:
    one, lost = tree("/a/tf", "a", "x", "y", "x"), tree("/a/tf", "", "z", received=False)
    made = scene(group("a", "/a"), SHARED, trees=(one, lost))
    ids = make_ids(made)
    assert "".join(trees(made, ids)) == (
        '<section id="tf">\n<h2>tf</h2>\n<h3>/a/tf <span>and /a/tf_static</span></h3>\n'
        '<div class="trees">\n<details class="group" data-robot="0" open><summary class="good">'
        "<b>a</b> <span>2 frames</span></summary>\n"
        f'<div class="frame"><div class="pane">{tree_svg(one, ["a"], ids)}</div></div>\n</details>\n'
        '<details class="group" data-robot="-1" open><summary class="odd"><b>no robot</b>'
        " <span>1 frame</span> <em>declared, not received</em></summary>\n"
        f'<div class="frame"><div class="pane">{tree_svg(lost, ["a"], ids)}</div></div>\n</details>\n'
        "</div>\n</section>\n"
    )


def test_without_messages_that_is_said() -> None:
    assert panels() == (
        '<section id="tf">\n<h2>tf</h2>\n<p class="none">No tf messages were received.</p>\n'
        "</section>\n"
    )


def test_each_topic_has_a_heading() -> None:
    text = panels(tree("/tf/a", "a", "x"), tree("/tf/a", "a", "y"), tree("/tf<", "a", "x"))
    assert "<h3>/tf/a <span>and /tf_static/a</span></h3>" in text
    assert "<h3>/tf&lt; <span>and /tf&lt;</span></h3>" in text
    assert text.count("<h3>") == text.count('<div class="trees">') == 2


def test_of_a_larger_fleet_trees_with_faults_are_open() -> None:
    wrong, fine = tree("/tf", "a", "x", wrong=True), tree("/tf", "a", "y")
    assert panels(wrong, fine, robots="abc").count(" open>") == 2
    text = panels(wrong, fine, robots="abcd")
    assert text.count(" open>") == 1
    assert '<details class="group" data-robot="0" open><summary class="bad">' in text
