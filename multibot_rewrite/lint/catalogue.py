# SPDX-License-Identifier: Apache-2.0
"""Every rule of every command by its code: for ``multibot inspect``, reports and pages."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib import import_module

from multibot_rewrite.base.findings.finding import Rule

# The modules (below the package) that declare rules beside those of ``rules``.
HOMES = (
    *("description.steps.plan", "description.checks.robots", "description.checks.arguments"),
    *("companions.params.rewrite", "companions.params.values", "companions.params.shared_defaults"),
    *("companions.params.bringup_style", "companions.rviz.window_checks"),
    *("companions.rviz.of_plan", "fleet.outputs.bridge_outputs", "fleet.robots.start_poses"),
    *("fleet.outputs.spawn", "fleet.checks.of_robots", "fleet.outputs.controller_files"),
    *("producers.evidence.nodes", "producers.launch.findings", "fleet.launch.launched_files"),
    *("fleet.launch.launched_prefix", "fleet.file.filled_arguments", "fleet.robots.simulators"),
    *("fleet.checks.lacking", "fleet.checks.named_twice", "fleet.robots.joined_robots"),
    *("fleet.checks.across_domains", "fleet.checks.shared_names", "fleet.robots.rewritten_robots"),
    *("fleet.outputs.given_world", "fleet.robots.robot_nodes", "fleet.outputs.params_style"),
    *("fleet.outputs.cell_outputs", "fleet.outputs.moveit_parameters", "spelling.table_checks"),
    "spelling.way_checks",
)


@cache
def rules() -> Mapping[str, Rule]:
    """All rules by code, in the order of the codes; imports every module that declares one."""
    from multibot_rewrite.lint.registry import RULES

    # A lint has some with examples of its own.
    by_code = {it.code: it for it in sorted((*RULES.values(), *declared()), key=lambda it: it.code)}
    names = {(it.code, it.name) for it in (*RULES.values(), *by_code.values())}
    assert len(names) == len(by_code), "two rules have one code"
    return by_code


@cache
def declared() -> tuple[Rule, ...]:
    """The rules of commands other than the lint, in the order of the codes. Of two with one code, which
    differ in their examples, it is that of the module which declares it."""
    from multibot_rewrite.lint.registry import RULES
    from multibot_rewrite.rules import check
    from multibot_rewrite.rules.launch import judge

    modules = [import_module(f"multibot_rewrite.{name}") for name in HOMES]
    found = [it for one in modules for it in vars(one).values() if isinstance(it, Rule)]
    every = (*judge.RULES, *check.RULES.values(), *found)
    own = (it for it in every if it.code not in RULES or not it.code.startswith("MB"))
    return tuple(sorted({it.code: it for it in own}.values(), key=lambda it: it.code))
