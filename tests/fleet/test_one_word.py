# SPDX-License-Identifier: Apache-2.0
"""Two steps cannot say two things of one node: what nodes make of the written parameter files is what
the plan has, for random files. What a node does with a parameter is asked of rcl's rules, not of the
build."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
from named_ends import named_ends
from random_parameters import LAYOUTS, NODE_SETS, RELEASE, is_plain, planned, random_file

from multibot_rewrite.base.rosnames import bind, parse_remap, resolve_bound
from multibot_rewrite.fleet.fleet import expected
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.knowledge.parameters import built_in_nodes
from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.evidence.filling import filled
from multibot_rewrite.producers.evidence.parameter_files import given_nodes
from multibot_rewrite.related_files.yaml_text import read_yaml
from multibot_rewrite.system.records import Robot


def written(files: dict[str, str], node: Run) -> Run | None:
    """Return what the robot's file sets for a node under its full name."""
    file = f"{node.robot}/p.yaml"
    known = built_in_nodes(RELEASE)
    own = f"{node.full_name}:\n  ros__parameters: {{}}\n"
    documents = [read_yaml(text.encode(), file) for text in (own, files[file])]
    found = given_nodes(documents, known)
    return next((it for it in found if f"/{it.node}" == node.full_name), None)


def differences(plan: FleetPlan, files: dict[str, str]) -> Iterator[str]:
    """Names that a node has by its written file and rules, and not in the plan."""
    table, robots = plan.fleet.table, expected(plan.fleet).robots
    for node in (it for it in table.runs if it.robot and not it.written):
        given = written(files, node)
        rules = (parse_remap(f"{old}:={new}") for old, new in node.rules)
        bound = bind(node.name, node.namespace, filter(None, rules))
        for it in named_ends(table):
            parameter = it.endpoint.parameter
            if it.node != node.full_name or not is_plain(it.endpoint) or not given:
                continue
            if parameter in given.values:
                value = str(given.values[parameter].value)
                name = resolve_bound(value, it.endpoint.kind, bound)
                if name != it.name:
                    yield f"{it.node} {parameter}: {value} is {name}, planned {it.name}"
        yield from _frames(node, given, robots)


def _frames(node: Run, given: Run | None, robots: Sequence[Robot]) -> Iterator[str]:
    """Frames that a node sends by its written file, and the plan does not know of."""
    facts = built_in(RELEASE).nodes.get(given.fact.known) if given else None
    if facts is None or given is None:
        return
    made = filled(facts, given)
    frames = {it.parameter: it.default for it in made.frames if it.given}
    sent = {frames.get(end, "") for it in made.sends for end in (it.parent, it.child)}
    robot = next(it for it in robots if it.name == node.robot)
    there = {*robot.frames, *robot.other_frames, "map", "world", ""}
    yield from (f"{node.full_name} sends {it}, not planned" for it in sent - there)


@pytest.mark.more
@pytest.mark.sample(4)
@pytest.mark.parametrize("seed", range(20))
def test_the_written_files_say_what_the_plan_says(seed: int, tmp_path: Path) -> None:
    draw = random.Random(seed)
    layout, affix = LAYOUTS[seed % 4], draw.choice(("prefix", "postfix"))
    text = random_file(draw)
    node_set = draw.choice(NODE_SETS)
    assert [*differences(*planned(tmp_path, text, layout, affix, node_set))] == [], (node_set, text)
