# SPDX-License-Identifier: Apache-2.0
"""The pictures as text: where boxes, lines and words are, their class, how a long name is cut."""

from __future__ import annotations

import pytest
from page_calls import (
    CLASH,
    LEAK,
    MISSING,
    OK,
    UNEXPECTED,
    DrawnEdge,
    DrawnGroup,
    DrawnName,
    DrawnNode,
    FrameRow,
    FrameTree,
    Ids,
    clipped,
    columns,
    group_svg,
    safe,
    tooltip,
    tree_svg,
)

from multibot_rewrite.pages import svg
from multibot_rewrite.pages.svg import lay_out
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
)

IDS = Ids(
    {"/r/a": "n0", "/b": "n1"},
    {"/r/t": "t0", "/r/s": "t1"},
    {("/tf", "base"): "f0"},
    frozenset({"n0", "t0", "f0"}),
)
HEAD = (
    '<text class="head" x="147" y="16">publishes, serves</text>'
    '<text class="head" x="590" y="16">topics, services, actions</text>'
    '<text class="head" x="1033" y="16">subscribes, calls</text>'
)
A, B = DrawnNode("/r/a", "r", OK), DrawnNode("/b", "", MISSING)


def edge(node: str, role: str, name: str, state: str = OK, kind: str = TOPIC) -> DrawnEdge:
    return DrawnEdge(node, kind, role, name, "x/msg/A", state, False)


def test_a_group_of_two_nodes_and_a_topic() -> None:
    """The faulty line is last; what is linked to has an anchor; who is of another robot is foreign."""
    topic = DrawnName(TOPIC, "/r/t", "r", LEAK, ("x/msg/A", "x/msg/B"))
    ends = (edge("/r/a", PUBLISHES, "/r/t", LEAK), edge("/b", SUBSCRIBES, "/r/t"))
    assert group_svg(DrawnGroup("r", (A, B), (topic,), ends), IDS, "g0-") == (
        '<svg class="graph" viewBox="0 0 1180 78" role="group" aria-label="r: 1 name, 2 nodes">'
        f"{HEAD}"
        '<path class="e ok" data-e="n1 t0" d="M805 57C846 57 846 57 888 57"/>'
        '<path class="e leak" data-e="n0 t0" d="M292 57C333 57 333 57 375 57"/>'
        '<g class="n ok" data-id="n0" id="g0-n0"><rect x="2" y="44" width="290" height="26" rx="5"/>'
        '<text x="11" y="61"><tspan class="dim">/r</tspan>/a</text><title>/r/a</title></g>'
        '<g class="n missing foreign" data-id="n1">'
        '<rect x="888" y="44" width="290" height="26" rx="5"/><text x="897" y="61">/b</text>'
        "<title>/b\nmissing: in the plan, but not in the graph</title></g>"
        '<g class="t leak" data-id="t0" id="g0-t0">'
        '<rect x="375" y="47.5" width="430" height="19" rx="9.5"/>'
        '<text x="385" y="61"><tspan class="dim">/r</tspan>/t</text>'
        "<title>topic /r/t\nx/msg/A and x/msg/B\n"
        "leak: a robot&#x27;s node uses a name of no robot</title></g></svg>"
    )


def test_a_group_without_a_robot_and_without_anchors() -> None:
    made = group_svg(DrawnGroup("", (A,), (), ()), IDS, "")
    assert 'aria-label="shared: 0 names, 1 node"' in made
    assert '<g class="n ok foreign" data-id="n0"><rect' in made


@pytest.mark.parametrize(("kind", "badge"), [(SERVICE, "srv"), (ACTION, "act")])
def test_a_service_or_action_has_square_corners_and_a_badge(kind: str, badge: str) -> None:
    name = DrawnName(kind, "/r/s", "r", OK, ("x/srv/A",))
    made = group_svg(
        DrawnGroup("r", (A,), (name,), (edge("/r/a", SERVES, "/r/s", OK, kind),)), IDS, "g0-"
    )
    assert (
        '<g class="t ok" data-id="t1"><rect x="375" y="47.5" width="430" height="19" rx="2"/>'
        '<text x="385" y="61"><tspan class="dim">/r</tspan>/s</text>'
        f'<text class="badge" x="798" y="61">{badge}</text>'
        f"<title>{kind} /r/s\nx/srv/A</title></g>"
    ) in made


def test_services_without_a_client_are_told_in_one_box() -> None:
    many = DrawnName(SERVICE, "/r/a service", "r", OK, (), ("/r/a/x", "/r/a/y"))
    ends = (edge("/r/a", SERVES, "/r/a service", OK, SERVICE),)
    made = group_svg(DrawnGroup("r", (A,), (many,), ends), IDS, "g0-")
    assert '<text x="385" y="61">2 services without a client</text>' in made
    assert "<title>/r/a/x\n/r/a/y</title>" in made
    # What stands for several has no id.
    assert 'data-e="n0 "' in made and '<g class="t ok"><rect' in made


def test_a_node_on_both_sides_has_one_anchor() -> None:
    names = tuple(DrawnName(TOPIC, it, "r", OK, ()) for it in ("/r/t", "/r/u"))
    ends = (edge("/r/a", PUBLISHES, "/r/t"), edge("/r/a", SUBSCRIBES, "/r/u"))
    made = group_svg(DrawnGroup("r", (A,), names, ends), IDS, "g0-")
    assert (made.count('data-id="n0"'), made.count('id="g0-n0"')) == (2, 1)
    assert 'data-e="n0 "' in made


@pytest.mark.parametrize(
    ("name", "robot", "shown"),
    [
        ("/r/a", "r", '<tspan class="dim">/r</tspan>/a'),
        ("/r/a", "", "/r/a"),
        ("/a/r", "r", '/a<tspan class="dim">/r</tspan>'),
        ("/a_r", "r", '/a<tspan class="dim">_r</tspan>'),
        ("/rest/a", "r", "/rest/a"),
        # The robot's name is all of it.
        ("/r", "r", "/r"),
        ("_r/a", "r", "_r/a"),
        ("/r/<a>", "r", '<tspan class="dim">/r</tspan>/&lt;a&gt;'),
        ("/a&b/r", "r", '/a&amp;b<tspan class="dim">/r</tspan>'),
        # 272 pixels are 37 letters, with those of the robot.
        ("/r/" + "x" * 36, "r", '<tspan class="dim">/r</tspan>/' + "x" * 16 + "…" + "x" * 17),
        ("/" + "x" * 36 + "/r", "r", "/" + "x" * 16 + "…" + "x" * 17 + '<tspan class="dim">/r</tspan>'),
        ("/" + "x" * 36, "r", "/" + "x" * 36),
        ("/" + "x" * 37, "r", "/" + "x" * 17 + "…" + "x" * 18),
    ],
)  # fmt: skip
def test_the_robots_part_of_a_name_is_dim(name: str, robot: str, shown: str) -> None:
    made = group_svg(DrawnGroup(robot, (DrawnNode(name, robot, OK),), (), ()), IDS, "")
    assert f">{shown}</text><title>" in made


def test_a_tree_of_frames() -> None:
    rows = (
        FrameRow("map", -1, 0, "", OK, (), False, False),
        FrameRow("base", 0, 1, "r", CLASH, ("two parents",), True, False),
        FrameRow("base", 1, 2, "r", OK, (), False, True),
    )
    assert tree_svg(FrameTree("/tf", "r", True, rows), ["r"], IDS) == (
        '<svg class="tree" width="270" height="78" viewBox="0 0 270 78">'
        '<path class="branch" d="M12 23V39H22"/><path class="branch" d="M32 49V65H42"/>'
        '<g class="f ok"><rect x="2" y="3" width="44" height="20" rx="4"/>'
        '<rect class="bar" x="2" y="3" width="5" height="20" rx="2"/>'
        '<text x="14" y="17">map</text></g><text class="note" x="54" y="17"></text>'
        '<g class="f clash c0" data-id="f0" id="tf-f0">'
        '<rect x="22" y="29" width="51" height="20" rx="4"/>'
        '<rect class="bar" x="22" y="29" width="5" height="20" rx="2"/>'
        '<text x="34" y="43">base</text></g>'
        '<text class="note bad" x="81" y="43">two parents, static</text>'
        '<g class="f ok c0" data-id="f0"><rect x="42" y="55" width="51" height="20" rx="4"/>'
        '<rect class="bar" x="42" y="55" width="5" height="20" rx="2"/>'
        '<text x="54" y="69">base</text></g><text class="note" x="101" y="69">…</text></svg>'
    )


def test_the_ninth_robot_has_the_colour_of_the_first() -> None:
    row = FrameRow("base", -1, 0, "i", OK, (), False, False)
    made = tree_svg(FrameTree("/tf", "i", True, (row,)), "abcdefghi", IDS)
    assert '<g class="f ok c0"' in made


@pytest.mark.parametrize(
    ("text", "room", "shown"),
    [
        ("abcdef", 6, "abcdef"), ("abcdefg", 6, "ab…efg"), ("abcdefgh", 7, "abc…fgh"),
        ("", 3, ""), ("機械人機", 8, "機械人機"), ("機械人機械", 8, "機…機械"), ("abc", 2, "…c"),
    ],
)  # fmt: skip
def test_a_long_text_is_cut_in_its_middle(text: str, room: int, shown: str) -> None:
    assert clipped(text, room) == shown


def test_east_asian_letters_are_two_columns() -> None:
    assert [columns(it) for it in ("ab", "機", "a機b", "\uff21", "é", "")] == [2, 2, 4, 2, 1, 0]


def test_text_is_safe_between_tags_and_in_quotes() -> None:
    assert safe('<a b="c">&\'\n') == "&lt;a b=&quot;c&quot;&gt;&amp;&#x27;\\n"
    assert tooltip("a", "", "<b>") == "<title>a\n&lt;b&gt;</title>"


def test_every_state_is_explained() -> None:
    assert svg.MEANINGS == {
        "ok": "as planned",
        "leak": "leak: a robot's node uses a name of no robot",
        "cross-talk": "cross-talk: a robot's node uses another robot's name",
        "clash": "conflict: two nodes with one name, types or QoS that do not match",
        "missing": "missing: in the plan, but not in the graph",
        "unexpected": "not in the plan, or with a warning",
    }


# Where the nodes and names of a picture stand.
Column = list[tuple[str, float]]


def placed(*ends: str, nodes: str = "", **states: str) -> tuple[Column, Column, Column, float]:
    """Return columns and height for ``node>name`` and ``name>node``; names have two letters."""
    edges, known = [], dict.fromkeys(nodes)
    for first, second in (it.split(">") for it in ends):
        node, name, role = (
            (second, first, SUBSCRIBES) if len(first) == 2 else (first, second, PUBLISHES)
        )
        edges.append(DrawnEdge(node, TOPIC, role, name, "", states.get(name, OK), False))
        known[node] = None
    names = dict.fromkeys(it.name for it in edges)
    found = lay_out(
        DrawnGroup(
            "", tuple(DrawnNode(it, "", OK) for it in known),
            tuple(DrawnName(TOPIC, it, "", OK, ()) for it in names), tuple(edges),
        )
    )  # fmt: skip
    left, middle, right = ([(it.name, y) for it, y in column] for column in found[:3])
    return left, middle, right, found.height


def order(*ends: str, **states: str) -> str:
    return " ".join(name for name, _ in placed(*ends, **states)[1])


def test_a_name_stands_between_its_nodes_and_idle_nodes_below() -> None:
    found = placed("a>t1", "t1>b", nodes="dc")
    assert found == ([("a", 57), ("c", 91), ("d", 125)], [("t1", 57)], [("b", 57)], 142)


def test_nodes_of_one_name_do_not_overlap() -> None:
    left, names, _, height = placed("a>t1", "b>t1", "c>t1")
    assert (left, names, height) == ([("a", 57), ("b", 91), ("c", 125)], [("t1", 91)], 142)
    assert placed("t1>a", "t1>b", "t1>c")[2:] == ([("a", 57), ("b", 91), ("c", 125)], 142)


def test_a_node_stands_in_the_middle_of_its_names() -> None:
    left, names, right, height = placed("a>t1", "a>t2", "a>t3", "t3>b")
    assert names == [("t1", 52), ("t2", 76), ("t3", 100)]
    assert (left, right, height) == ([("a", 76)], [("b", 95)], 112)


def test_names_that_are_joined_stand_together() -> None:
    assert order("p>aa", "p>cc", "bb>s", "cc>s") == "aa cc bb"


def test_the_worst_names_are_first() -> None:
    states = {"aa": OK, "bb": UNEXPECTED, "cc": MISSING, "dd": CLASH, "ee": LEAK}
    ends = [f"{node}>{name}" for node, name in zip("vwxyz", states, strict=True)]
    assert order(*ends, **states) == "ee dd cc aa bb"


def test_of_a_name_the_worst_end_counts() -> None:
    edges = [
        DrawnEdge("p", TOPIC, PUBLISHES, "bb", "", LEAK, False),
        DrawnEdge("q", TOPIC, SUBSCRIBES, "bb", "", MISSING, False),
        DrawnEdge("p", TOPIC, PUBLISHES, "aa", "", MISSING, False),
    ]
    names = tuple(DrawnName(TOPIC, it, "", OK, ()) for it in ("aa", "bb"))
    group = DrawnGroup("", tuple(DrawnNode(it, "", OK) for it in "pq"), names, tuple(edges))
    assert [it.name for it, _ in lay_out(group).names] == ["bb", "aa"]


def test_who_offers_is_left_and_who_uses_is_right() -> None:
    roles = {"a": PUBLISHES, "b": SERVES, "c": SUBSCRIBES, "d": CALLS}
    edges = tuple(
        DrawnEdge(node, SERVICE, role, "/s", "", OK, False) for node, role in roles.items()
    )
    nodes = tuple(DrawnNode(it, "", OK) for it in roles)
    found = lay_out(DrawnGroup("", nodes, (DrawnName(SERVICE, "/s", "", OK, ()),), edges))
    assert [[it.name for it, _ in column] for column in (found.left, found.right)] == [
        ["a", "b"], ["c", "d"],
    ]  # fmt: skip
