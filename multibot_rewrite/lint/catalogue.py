# SPDX-License-Identifier: Apache-2.0
"""Every rule of every command by its code: for ``multibot inspect``, reports and pages."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib import import_module

from multibot_rewrite.base.findings.finding import Rule

# The modules, by folder, that declare rules beside those of ``rules``.
HOMES = {
    "related_files.params": "rewrite shared_defaults values",
    "related_files.rviz": "window_checks",
    "description.checks": "references robots",
    "description.steps": "plan",
    "checks": "across_domains lacking meeting of_robots",
    "fleet.file": "simulator_switch",
    "fleet.launch": "launched_files",
    "fleet.outputs": "bridge_outputs controller_files moveit_parameters params_style rviz_outputs"
    " spawn world_file",
    "fleet.robots": "joined_robots rewritten_robots robot_nodes simulators start_poses",
    "producers.evidence": "nodes",
    "producers.launch": "findings",
    "planning": "way_checks",
}


@cache
def rules() -> Mapping[str, Rule]:
    """Return all rules in the order of their codes; imports every module that declares one."""
    from multibot_rewrite.lint.registry import RULES

    # A lint has some with examples of its own.
    by_code = {it.code: it for it in sorted((*RULES.values(), *declared()), key=lambda it: it.code)}
    names = {(it.code, it.name) for it in (*RULES.values(), *by_code.values())}
    assert len(names) == len(by_code), "two rules have one code"
    return by_code


@cache
def declared() -> tuple[Rule, ...]:
    """Return the rules of commands other than the lint, in the order of the codes, each code once."""
    from multibot_rewrite.lint.registry import RULES
    from multibot_rewrite.rules import check
    from multibot_rewrite.rules.launch import judge

    modules = [
        import_module(f"multibot_rewrite.{folder}.{name}")
        for folder, names in HOMES.items()
        for name in names.split()
    ]
    found = [it for one in modules for it in vars(one).values() if isinstance(it, Rule)]
    every = (*judge.RULES, *check.RULES.values(), *found)
    own = (it for it in every if it.code not in RULES or not it.code.startswith("MB"))
    return tuple(sorted({it.code: it for it in own}.values(), key=lambda it: it.code))
