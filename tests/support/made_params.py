# SPDX-License-Identifier: Apache-2.0
"""Parameter files of two robots' fleets, rewritten: what becomes of a section."""

from __future__ import annotations

from collections.abc import Iterable

from beside import findings_of

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.knowledge.node_sets import load_node_set
from multibot_rewrite.related_files.context import Context, fill_template, make_context
from multibot_rewrite.related_files.params.rewrite import rewrite_params
from multibot_rewrite.related_files.yaml_text import read_yaml

LINKS = ("base_link", "base_footprint", "laser", "tool0")
JOINTS = ("left_wheel", "right_wheel", "shoulder", "elbow")
SENSORS = ("imu_sensor",)
DECLARED = {
    "link": dict.fromkeys(LINKS),
    "joint": dict.fromkeys(JOINTS),
    "sensor": dict.fromkeys(SENSORS),
    "model": {},
    "group": {},
    "frame": {},
}
L1, L2, L3, L4 = ("L1", "prefix"), ("L2", "prefix"), ("L3", "prefix"), ("L4", "postfix")


def setting(policy: tuple[str, str] = L2, distro: str = "jazzy", **more: object) -> Context:
    layout, affix = policy
    naming = make_naming(layout=layout, affix=affix, **more)  # type: ignore[arg-type]
    node_sets = ("nav2", "ros2_control", "slam_toolbox")
    facts = [node for it in node_sets for node in load_node_set(it, distro)]
    return make_context(DECLARED, naming, dict.fromkeys(facts), distro)  # type: ignore[arg-type]


def made(
    text: str, policy: tuple[str, str] = L2, distro: str = "jazzy", **more: object
) -> tuple[str, tuple[Finding, ...]]:
    """Return the file for robot1 (in the graph) and r1 (in frames), and what is told about it."""
    related_file = rewrite_params(
        read_yaml(text.encode(), "p.yaml"), setting(policy, distro), **more
    )  # type: ignore[arg-type]
    return fill_template(related_file.template, "robot1", "r1"), findings_of(related_file)


def codes(findings: Iterable[Finding]) -> list[str]:
    return [it.code for it in findings]


def section(node: str, *lines: str) -> str:
    below = "".join(f"    {line}\n" for line in lines)
    return f"{node}:\n  ros__parameters:\n{below}"
