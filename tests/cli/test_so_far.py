# SPDX-License-Identifier: Apache-2.0
"""What a terminal shows while a graph is looked at, and what is said where the time was over."""

from __future__ import annotations

import fault_changes
import pytest
from graph_examples import read_system

from multibot_rewrite.cli.live import so_far
from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.producers.ros import assemble, observe
from multibot_rewrite.producers.ros.request import Request
from multibot_rewrite.rules.check import ABSENCE
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, TOPIC, End, System


def judge(seen: System) -> object:
    return diagnose(seen).findings


def test_what_contradicts_is_shown_and_what_is_missing_is_not() -> None:
    seen = fault_changes.nav()
    twice = seen._replace(nodes=(*seen.nodes, seen.nodes[0]._replace(process="other")))
    said = so_far(twice, judge)  # type: ignore[arg-type]
    assert "; MG301 " in said and "more finding" not in said
    missing = read_system(
        "running: /robot1/amcl subscribes /clock rosgraph_msgs/msg/Clock\n"
    ).system
    assert "MG501" in {it.code for it in diagnose(missing).findings} & ABSENCE
    assert so_far(missing, judge) == "1 node so far, nothing wrong seen"  # type: ignore[arg-type]


def ends_of(topic: str, asked: bool) -> list[End]:
    qos = fault_changes.nav().ends[0].qos if asked else None
    one = End(TOPIC, PUBLISHES, topic, "t/msg/T", "", "/a", qos, "")
    return [one, one._replace(role=SUBSCRIBES, node="/b")]


def test_what_was_not_asked_in_time_is_named() -> None:
    (caveat,) = assemble.cut_short(["/a", "/b"], ends_of("/scan", False))
    assert caveat.incomplete
    assert "(/scan)" in caveat.message
    (caveat,) = assemble.not_heard(["/robot1/tf"])
    assert "on /robot1/tf;" in caveat.message


@pytest.mark.parametrize(
    ("before", "after", "last"),
    [
        ((["/a"], []), (["/a", "/b"], []), ("/b",)),
        ((["/a", "/b"], []), (["/a"], []), ("/b",)),
        ((["/a"], []), (["/a"], ends_of("/x", False)), ("/x",)),
    ],
)
def test_what_changed_last_is_known(
    before: tuple[list[str], list[End]], after: tuple[list[str], list[End]], last: tuple[str, ...]
) -> None:
    times = observe._ChangeTimes()
    for at, view in enumerate((before, after, after)):
        times.update(float(at), view, Request(9.0))
    assert times.last == last
