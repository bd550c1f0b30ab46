"""Trees of transforms: two that nodes of a robot send are apart; a driver may join the description."""

from __future__ import annotations

from pathlib import Path

import pytest
from closed_robot import FILES

from multibot_rewrite.closure.frames import Sender, tree_gaps
from multibot_rewrite.fleets.closing import closing
from multibot_rewrite.fleets.fleet_file import read_fleet
from multibot_rewrite.fleets.fleet_plan import plan_fleet
from multibot_rewrite.graph.transforms import Edge
from multibot_rewrite.system.records import Place


def edge(text: str) -> Edge:
    parent, child = text.split(">")
    return Edge(parent, child, False)


@pytest.mark.parametrize(
    ("description", "senders", "apart"),
    [
        ("base>lidar", {"slam": "map>odom", "ekf": "odom>base"}, []),
        ("base>lidar", {"slam": "map>odom", "ekf": "odom2>base"}, ["ekf"]),
        ("base>lidar", {"slam": "map>odom"}, []),
        ("base>lidar base>mast mast>head", {"slam": "map>odom", "head": "head>eye"}, []),
        ("base>mast", {"slam": "map>odom", "ekf": "odom2>base", "eye": "mast>eye"}, ["ekf", "eye"]),
        ("odom>base", {"slam": "map>odom", "arm": "base>hand"}, []),
        ("", {"a": "x>y", "b": "y>z", "c": "p>q"}, ["c"]),
        ("", {"a": "x>y", "b": "p>q", "c": "q>y"}, []),
    ],
)
def test_nodes_whose_transforms_are_apart(
    description: str, senders: dict[str, str], apart: list[str]
) -> None:
    made = [Sender(node, (edge(text),), None) for node, text in senders.items()]
    gaps = tree_gaps([edge(it) for it in description.split()], made)
    assert [it.node for it in gaps] == apart


def test_both_places_are_told() -> None:
    slam, ekf = Place("slam.yaml", 3), Place("ekf.yaml", 5)
    senders = [
        Sender("still", (), Place("still.yaml", 1)),
        Sender("slam", (edge("map>odom"),), slam),
        Sender("ekf", (edge("odom2>base"), edge("base>mast")), ekf),
    ]
    (gap,) = tree_gaps([], senders)
    assert (gap.kind, gap.name, gap.place) == ("tree", "odom2 -> base", ekf)
    assert (gap.near, gap.near_place) == ("map -> odom", slam)


def test_a_tree_that_the_rewrite_has_cut_is_an_error(tmp_path: Path) -> None:
    for name, text in FILES.items():
        (tmp_path / name).write_text(text)
    plan = plan_fleet(read_fleet(str(tmp_path / "fleet.yaml"), "", {}))
    key = ("robot1", "ekf_filter_node")
    assert plan.fleet.edges[key]
    for cut, levels in (([edge("x>y")], ["error"]), (plan.fleet.edges[key], [])):
        fleet = plan.fleet._replace(edges={**plan.fleet.edges, key: cut})
        found = [it.level for it in closing(plan, fleet, []) if it.code == "MF817"]
        assert found == levels
