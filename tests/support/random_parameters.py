# SPDX-License-Identifier: Apache-2.0
"""Random parameter files of known nodes, and fleets that have them."""

from __future__ import annotations

import random
from pathlib import Path

from fleet_folder import planned_fleet
from rule_examples import DESCRIPTION

from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts

LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")
TOPICS = ("scan", "/scan", "front/scan", "/front/points", "odom", "/odom", "data")
FRAMES = ("base_link", "lidar_link", "odom", "map", "wheel")
NODE_SETS = ("", "nav2", "localization, slam_toolbox", "robot_localization")
RELEASE = "jazzy"


def has_plain_names(node: NodeFacts) -> bool:
    """Return whether a node has its own process, and parameters with topics as rcl resolves them."""
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
    folder: Path, text: str, layout: str, affix: str, node_set: str
) -> tuple[FleetPlan, dict[str, str]]:
    (folder / "robot.urdf").write_text(DESCRIPTION)
    (folder / "p.yaml").write_text(text)
    (folder / "fleet.yaml").write_text(
        f"layout: {layout}\naffix: {affix}\ndistro: {RELEASE}\ndescription: robot.urdf\n"
        f"node_sets: [{node_set}]\nrelated_files: {{params: p.yaml}}\n"
        "robots: [{name: robot1}, {name: robot2}]\n"
    )
    plan = planned_fleet(folder / "fleet.yaml")
    return plan, {it.path: it.data.decode() for it in make_outputs(plan).files}
