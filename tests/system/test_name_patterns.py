# SPDX-License-Identifier: Apache-2.0
"""Names that are made at run time: a plan has a ``*`` in place of one, which stands for one or more
characters of a segment."""

from __future__ import annotations

import pytest

from multibot_rewrite.system.patterns import fitted
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, TOPIC, End, Node, System


def end(node: str, name: str, role: str = PUBLISHES) -> End:
    return End(TOPIC, role, name, "std_msgs/msg/String", "", node, None, "")


def system(nodes: tuple[str, ...], *ends: End) -> System:
    return System(nodes=tuple(Node(it, "") for it in nodes), ends=ends)


def names(it: System) -> tuple[list[str], list[tuple[str, str]]]:
    return sorted(node.name for node in it.nodes), [(one.node, one.name) for one in it.ends]


@pytest.mark.parametrize(
    ("planned", "seen", "fits"),
    [
        ("/tf_*", "/tf_4711", True),
        ("/tf_*", "/tf_a/b", False),
        ("/tf_*", "/tf_", False),
        ("/*_impl_*", "/a_impl_b", True),
        ("/tf.*", "/tfx1", False),
        ("/plain", "/plain", True),
        ("/plain", "/plain1", False),
    ],
)
def test_a_node_has_the_name_of_the_pattern_that_it_fits(
    planned: str, seen: str, fits: bool
) -> None:
    plan, graph = system((planned,), end(planned, "/t")), system((seen,), end(seen, "/t"))
    wanted = planned if fits else seen
    assert names(fitted(plan, graph)[1]) == ([wanted], [(wanted, "/t")])


def test_two_nodes_of_a_pattern_are_one_and_others_stay() -> None:
    plan = system(("/tf_*", "/a"), end("/tf_*", "/tf", SUBSCRIBES))
    seen = ("/tf_1", "/tf_2", "/a", "/b")
    graph = system(seen, *(end(it, "/tf", SUBSCRIBES) for it in ("/tf_1", "/tf_2", "/b")))
    assert names(fitted(plan, graph)[1]) == (
        ["/a", "/b", "/tf_*"],
        [("/tf_*", "/tf"), ("/b", "/tf")],
    )


@pytest.mark.parametrize(
    ("seen", "wanted"),
    [
        ([end("/a", "/t_1"), end("/a", "/t_2")], ["/t_1", "/t_2"]),
        # What nothing fits stays, and is missing: another node's, role's or segment's is no fit.
        ([], ["/t_*"]),
        ([end("/b", "/t_1")], ["/t_*"]),
        ([end("/a", "/t_1", SUBSCRIBES)], ["/t_*"]),
        ([end("/a", "/t_1/x")], ["/t_*"]),
        ([end("/a", "/t_1"), end("/a", "/t_1")], ["/t_1"]),
    ],
)
def test_what_runs_stands_in_place_of_a_pattern(seen: list[End], wanted: list[str]) -> None:
    plan = system(("/a",), end("/a", "/plain"), end("/a", "/t_*"))
    made, graph = fitted(plan, system(("/a", "/b"), *seen))
    assert [it.name for it in made.ends] == ["/plain", *wanted]
    assert graph.ends == tuple(seen)
