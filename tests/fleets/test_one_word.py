"""Two steps cannot say two things of one node: what nodes make of the written parameter files is what
the plan has, for random files. What a node does with a parameter is asked of rcl's rules, not of the
build."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
from rule_examples import DESCRIPTION

from multibot_rewrite.companions.params.known_nodes import built_in_nodes
from multibot_rewrite.companions.yaml_text import read_yaml
from multibot_rewrite.evidence.filling import filled
from multibot_rewrite.evidence.parameter_files import given_nodes
from multibot_rewrite.evidence.records import GivenNode
from multibot_rewrite.fleets.build import make_outputs
from multibot_rewrite.fleets.fleet import expected
from multibot_rewrite.fleets.fleet_file import read_fleet
from multibot_rewrite.fleets.fleet_plan import FleetPlan, plan_fleet
from multibot_rewrite.graph.expectation import PlannedRobot
from multibot_rewrite.remap.records import Endpoint, NodeFacts, NodeTable
from multibot_rewrite.remap.stacks import built_in
from multibot_rewrite.rosnames import bind, parse_remap, resolve_bound

LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")
TOPICS = ("scan", "/scan", "front/scan", "/front/points", "odom", "/odom", "data")
FRAMES = ("base_link", "lidar_link", "odom", "map", "wheel")
STACKS = ("", "nav2", "localization, slam_toolbox", "robot_localization")
RELEASE = "jazzy"


def has_plain_names(node: NodeFacts) -> bool:
    """A process of its own, whose parameters name topics that rcl resolves as they stand."""
    named = [it for it in node.endpoints if it.parameter]
    return not (node.host or node.shared or "/" in node.name) and any(map(is_plain, named))


def is_plain(it: Endpoint) -> bool:
    words = (it.name, it.parameter, it.condition)
    made = it.name.endswith(("_updates", "_metadata"))
    return not (made or it.above or any(mark in word for mark in "<N*" for word in words))


NODES = tuple(it for it in built_in(RELEASE).nodes.values() if has_plain_names(it))


def random_file(draw: random.Random) -> str:
    texts = []
    for node in draw.sample(NODES, 4):
        named = {it.parameter: draw.choice(TOPICS) for it in node.endpoints if is_plain(it)}
        framed = {
            it.parameter: draw.choice(FRAMES) for it in node.frames if "*" not in it.parameter
        }
        chosen = {k: v for k, v in (named | framed).items() if k and draw.random() < 0.7}
        body = ", ".join(f"{name}: {value}" for name, value in chosen.items())
        key = draw.choice((f"{node.name}:", f"/{node.name}:", f"/**/{node.name}:"))
        texts.append(f"{key}\n  ros__parameters: {{{body}}}\n")
    return "".join(texts)


def planned(
    folder: Path, text: str, layout: str, affix: str, stack: str
) -> tuple[FleetPlan, dict[str, str]]:
    (folder / "robot.urdf").write_text(DESCRIPTION)
    (folder / "p.yaml").write_text(text)
    (folder / "fleet.yaml").write_text(
        f"layout: {layout}\naffix: {affix}\ndistro: {RELEASE}\ndescription: robot.urdf\n"
        f"stack: [{stack}]\ncompanions: {{params: p.yaml}}\n"
        "robots: [{name: robot1}, {name: robot2}]\n"
    )
    plan = plan_fleet(read_fleet(str(folder / "fleet.yaml"), "", {}))
    return plan, {it.path: it.data.decode() for it in make_outputs(plan).files}


def written(files: dict[str, str], node: NodeTable) -> GivenNode | None:
    """What the robot's file sets for a node under its full name."""
    file = f"{node.robot}/p.yaml"
    known = built_in_nodes(RELEASE)
    own = f"{node.full_name}:\n  ros__parameters: {{}}\n"
    documents = [read_yaml(text.encode(), file) for text in (own, files[file])]
    found = given_nodes(documents, known)
    return next((it for it in found if f"/{it.name}" == node.full_name), None)


def differences(plan: FleetPlan, files: dict[str, str]) -> Iterator[str]:
    """Names that a node has by its written file and rules, and not in the plan."""
    table, robots = plan.fleet.table, expected(plan.fleet).robots
    for node in (it for it in table.nodes if it.robot and not it.home.written):
        given = written(files, node)
        rules = (parse_remap(f"{it.source}:={it.target}") for it in node.rules)
        bound = bind(node.name, node.namespace, filter(None, rules))
        for it in table.names:
            parameter = it.endpoint.parameter
            if it.node != node.full_name or not is_plain(it.endpoint) or not given:
                continue
            if parameter in given.values:
                value = str(given.values[parameter].value)
                name = resolve_bound(value, it.endpoint.kind, bound)
                if name != it.name:
                    yield f"{it.node} {parameter}: {value} is {name}, planned {it.name}"
        yield from _frames(node, given, robots)


def _frames(
    node: NodeTable, given: GivenNode | None, robots: Sequence[PlannedRobot]
) -> Iterator[str]:
    """Frames that a node sends by its written file, and the plan does not know of."""
    facts = built_in(RELEASE).nodes.get(given.known) if given else None
    if facts is None or given is None:
        return
    made = filled(facts, given)
    frames = {it.parameter: it.default for it in made.frames if it.given}
    sent = {frames.get(end, "") for it in made.sends for end in (it.parent, it.child)}
    robot = next(it for it in robots if it.name == node.robot)
    there = {*robot.frames, *robot.other_frames, "map", "world", ""}
    yield from (f"{node.full_name} sends {it}, not planned" for it in sent - there)


@pytest.mark.parametrize("seed", range(20))
def test_the_written_files_say_what_the_plan_says(seed: int, tmp_path: Path) -> None:
    draw = random.Random(seed)
    layout, affix = LAYOUTS[seed % 4], draw.choice(("prefix", "postfix"))
    text = random_file(draw)
    stack = draw.choice(STACKS)
    assert [*differences(*planned(tmp_path, text, layout, affix, stack))] == [], (stack, text)
