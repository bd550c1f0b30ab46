# SPDX-License-Identifier: Apache-2.0
"""Where the nodes and names of a picture stand."""

from __future__ import annotations

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
)

from multibot_rewrite.pages.svg import lay_out
from multibot_rewrite.system.records import CALLS, PUBLISHES, SERVES, SERVICE, SUBSCRIBES, TOPIC

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
