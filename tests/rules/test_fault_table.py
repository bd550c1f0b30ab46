# SPDX-License-Identifier: Apache-2.0
"""Healthy and broken systems through every source: silent, or one code for a fault wherever it is met.

The faults come from thought (``graph_faults.py``), what a source lacks from its format.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from built_faults import BUILT, OUT, fleet, in_a_build, read_back
from fault_changes import Fault
from fault_sources import NODES, SOURCES, recording, written
from graph_calls import (
    ABSENCE,
    check,
    diagnose,
    from_yaml,
    guess_robots,
    seen_plan,
    to_json,
    to_yaml,
)
from graph_faults import FAULTS, MORE_NEEDS, NEEDS, needed
from graph_faults_page import LACKS, PLANS, cell, lines, planned_cell
from healthy_systems import OF_EACH_RELEASE, SYSTEMS, plan, slam_with_filters, started
from healthy_twins import TWINS, sent_twice_alike
from paths import ROOT
from vendor_graphs import RELEASES, VENDORS

from multibot_rewrite.base.findings.finding import NOTE, WARNING
from multibot_rewrite.base.findings.selection import grouped as by_robots
from multibot_rewrite.cli import multibot
from multibot_rewrite.producers.bags.read import RecordedTopic
from multibot_rewrite.producers.bags.recording import as_snapshot

NAMED = {it.name: it for it in FAULTS}


@pytest.mark.sample(3)
@pytest.mark.parametrize("source", SOURCES)
@pytest.mark.parametrize("name", SYSTEMS)
def test_a_healthy_system_has_no_finding(name: str, source: str) -> None:
    read = SOURCES[source].read(SYSTEMS[name]())
    assert [str(it) for it in diagnose(read).findings] == []


@pytest.mark.more
@pytest.mark.parametrize("name", TWINS)
def test_what_looks_like_a_fault_and_is_none_has_no_finding(name: str) -> None:
    graph = SOURCES["file"].read(TWINS[name]())
    seen = diagnose(graph)
    assert [str(it) for it in seen.findings] == []
    assert [str(it) for it in check(seen_plan(seen), graph)] == []


@pytest.mark.slow
@pytest.mark.sample(6)
@pytest.mark.parametrize("release", ["humble", "jazzy", "kilted", "lyrical", "rolling"])
@pytest.mark.parametrize("what", OF_EACH_RELEASE, ids=lambda it: f"{it[0][0]}-{it[1]}")
def test_what_stands_as_planned_has_no_finding_in_any_release(
    what: tuple[tuple[str, ...], str, tuple[str, ...]], release: str
) -> None:
    graph = started(*what, release)
    assert [str(it) for it in diagnose(graph).findings] == []
    assert [str(it) for it in check(plan(*what, release), graph)] == []


@pytest.mark.slow
@pytest.mark.parametrize("release", ["humble", "jazzy", "kilted", "lyrical", "rolling"])
def test_slam_with_filters_has_no_finding_in_any_release(release: str) -> None:
    graph = slam_with_filters(release)
    assert [str(it) for it in diagnose(graph).findings] == []


@pytest.mark.slow
@pytest.mark.sample(4)
@pytest.mark.parametrize("release", RELEASES)
@pytest.mark.parametrize("name", VENDORS)
def test_a_vendors_robots_have_no_finding_in_any_release(name: str, release: str) -> None:
    graph = VENDORS[name](release)
    seen = diagnose(graph)
    assert [str(it) for it in seen.findings] == []
    planned = from_yaml(to_yaml(seen_plan(seen)).encode(), "plan.yaml")
    assert [str(it) for it in check(planned, graph)] == []


def test_the_tf_of_a_hidden_base_is_not_its_robots() -> None:
    seen = diagnose(VENDORS["TurtleBot 4"]("jazzy"))
    assert {it.tf_topic for it in seen_plan(seen).robots} == {"/robot1/tf", "/robot2/tf"}


@pytest.mark.parametrize("name", ["parts of a robot", "arms on a base", "one robot"])
def test_parts_are_no_robots(name: str) -> None:
    assert guess_robots({**SYSTEMS, **TWINS}[name]()) == ()


def test_a_static_transform_that_is_sent_twice_alike_is_a_note() -> None:
    (found,) = diagnose(sent_twice_alike()).findings
    assert (found.code, found.level) == ("MG408", NOTE)
    assert "/static_transform_publisher_x" in found.hint


def test_a_tool_that_reads_too_late_is_a_note_beside_the_nodes_of_the_robot() -> None:
    fault = NAMED["a map that is read without transient_local"]
    found = [it for it in diagnose(fault.change(fault.system())).findings if it.code == "MG309"]
    assert {it.node: it.level for it in found} == {
        "/robot1/amcl": WARNING,
        "/foxglove_bridge": NOTE,
    }


@pytest.mark.more
def test_every_finding_says_what_it_is_about() -> None:
    """Of all faults, each with its code: a robot, a node or a name, and a remedy for itself."""
    for fault in FAULTS:
        before = fault.system()
        after = fault.change(before)
        found = diagnose(after).findings
        codes = {it.code for it in found}
        plan = seen_plan(diagnose(before))
        # What a finding explains is no change of its own.
        changed = check(plan, after, before=before)
        names = {it.name: it.name for it in plan.robots}
        alone, *others = (len(by_robots(it, names)) for it in (found, check(plan, after), changed))
        # With a plan one cause is no more lines than without.
        assert 0 < min(others) <= max(others) <= max(1, alone), fault.name
        assert changed and "MG130" not in {it.code for it in changed}, fault.name
        assert {fault.code} <= codes <= {fault.code, *fault.also}, fault.name
        for it in found:
            assert it.robot or it.node or it.names, it
            assert it.message and not it.message.startswith(" "), it


@pytest.mark.sample(8)
@pytest.mark.parametrize("source", SOURCES)
@pytest.mark.parametrize("name", NAMED)
def test_a_fault_has_its_code_and_cause_in_every_source(name: str, source: str) -> None:
    """Where the source lacks what the fault rests on, it is not made up either."""
    fault = NAMED[name]
    seen = cell(fault, source)
    lacks = {*needed(fault)} & {*SOURCES[source].lacks}
    assert (fault.code in seen.codes) is not bool(lacks), seen
    # A finding of a recording cannot name the node.
    assert seen.cause or lacks or NODES in SOURCES[source].lacks
    # One fault is not ten findings.
    assert {*seen.codes} <= {fault.code, *fault.also}


@pytest.mark.sample(4)
@pytest.mark.parametrize(
    "fault", [it for it in FAULTS if it.system in PLANS], ids=lambda it: it.name
)
def test_with_its_plan_it_is_the_same_or_what_the_plan_has_and_is_not_there(fault: Fault) -> None:
    found = planned_cell(fault)
    assert found
    lost = fault.code in ABSENCE and LACKS & {*found.codes}
    assert fault.code in found.codes or lost, found


@pytest.mark.sample(16)
@pytest.mark.slow
@pytest.mark.parametrize("name", BUILT)
def test_a_build_reads_it_back(name: str) -> None:
    fault = NAMED[name]
    planned = planned_cell(fault)
    assert planned
    own = {fault.code} if fault.code in planned.codes else {*planned.codes} - LACKS
    codes = {*in_a_build(fault)}
    assert own <= codes or (fault.code in ABSENCE and LACKS & codes), codes


@pytest.mark.slow
def test_a_whole_fleet_is_silent_when_it_is_read_back() -> None:
    plan, made = fleet()
    assert [str(it) for it in read_back(plan, made, OUT)] == []


def test_there_are_faults_enough_and_no_need_without_a_fault() -> None:
    assert len(NAMED) == len(FAULTS) >= 60
    assert NEEDS.keys() == {it.code for it in FAULTS}
    assert NAMED.keys() >= {*MORE_NEEDS, *BUILT}


@pytest.mark.sample(8)
@pytest.mark.slow
@pytest.mark.parametrize("at", range(0, len(FAULTS), 40))
def test_a_bag_that_is_written_is_the_recording(at: int, tmp_path: Path) -> None:
    """The columns of the table rest on records; this is the file."""
    bags = pytest.importorskip("multibot_rewrite.producers.bags.read")
    pytest.importorskip("rosbags")
    fault = FAULTS[at]
    graph = fault.change(fault.system())
    found = bags.read_bag(str(written(tmp_path / "bag", graph)))
    known = {it.name for it in found.topics}
    wanted = recording(graph)._replace(caveats=found.caveats)
    topics = [_topic(it) for it in wanted.topics if it.name in known]
    assert topics == [_topic(it) for it in found.topics]
    assert {it[:4] for it in wanted.transforms} == {it[:4] for it in found.transforms}
    codes = [{it.code for it in diagnose(as_snapshot(one)).findings} for one in (wanted, found)]
    assert codes[0] == codes[1]


def _topic(it: RecordedTopic) -> tuple[object, ...]:
    """Its name, type, frames that are not empty, and senders."""
    return it.name, it.type, tuple(filter(None, it.frames)), len(it.qos)


@pytest.mark.slow
@pytest.mark.parametrize("at", range(0, len(FAULTS), 8))
def test_the_command_ends_with_the_level_of_the_fault(
    at: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    fault, file = FAULTS[at], tmp_path / "graph.json"
    file.write_bytes(to_json(fault.change(fault.system())))
    assert multibot.main(["check", "--from", str(file)]) == int(fault.level == "error")
    assert fault.code in capsys.readouterr().out


@pytest.mark.deep
def test_the_page_is_that_of_today() -> None:
    page = (ROOT / "docs" / "contributing" / "measurements.md").read_text()
    assert "#" + "\n".join(lines()).strip() in page
