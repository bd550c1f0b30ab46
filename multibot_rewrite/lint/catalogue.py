# SPDX-License-Identifier: Apache-2.0
"""Every rule of every command by its code: for ``multibot inspect``, reports and pages."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from importlib import import_module

from multibot_rewrite.base.findings.rule import Rule
from multibot_rewrite.base.record import NamedTuple


class Home(NamedTuple):
    """Rules whose codes begin with ``start``, and the modules (below the package) that declare them."""

    start: str
    modules: tuple[str, ...]


HOMES: tuple[Home, ...] = (
    Home(
        "MB1",
        ("description.steps.plan", "description.checks.robots", "description.checks.arguments"),
    ),
    Home(
        "MF1",
        (
            "companions.params.rewrite",
            "companions.params.values",
            "companions.params.shared_defaults",
            "companions.params.bringup_style",
        ),
    ),
    Home(
        "MF2",
        (
            "companions.rviz.window_checks",
            "companions.rviz.of_plan",
        ),
    ),
    Home("MF5", ("fleet.outputs.bridge_outputs",)),
    Home(
        "MF7",
        (
            "fleet.robots.start_poses",
            "fleet.outputs.spawn",
            "fleet.checks.of_robots",
            "fleet.outputs.controller_files",
        ),
    ),
    Home(
        "MF8",
        (
            "producers.evidence.nodes",
            "producers.launch.findings",
            "fleet.launch.launched_files",
            "fleet.outputs.controller_files",
            "fleet.launch.launched_prefix",
            "fleet.file.filled_arguments",
            "fleet.robots.simulators",
            "fleet.checks.nothing_moves",
            "fleet.checks.lacking",
            "fleet.checks.other_manager",
            "fleet.checks.of_robots",
            "fleet.robots.joined_robots",
            "fleet.robots.world_systems",
            "fleet.checks.across_domains",
            "fleet.checks.shared_names",
            "fleet.robots.own_ports",
            "fleet.outputs.given_world",
            "fleet.robots.robot_nodes",
            "fleet.outputs.params_style",
            "fleet.outputs.cell_outputs",
            "fleet.outputs.moveit_parameters",
        ),
    ),
    Home(
        "MG1",
        (
            "rules.system.planned_nodes",
            "rules.system.planned_ends",
            "rules.system.demands",
            "rules.system.enclaves",
            "rules.system.planned_states",
        ),
    ),
    Home("MG2", ("rules.system.planned_frames",)),
    Home(
        "MG3",
        (
            "rules.system.nodes",
            "rules.system.names",
            "rules.system.matching",
            "rules.system.commands",
            "rules.system.relays",
            "rules.system.sharing",
            "rules.system.equal_robots",
            "rules.system.likes",
            "rules.system.differing",
            "rules.system.unsent",
        ),
    ),
    Home(
        "MG4",
        (
            "rules.system.transforms",
            "rules.system.tf_topics",
            "rules.system.tf_pieces",
            "rules.system.frame_ids",
            "rules.system.lookups",
            "rules.system.localized",
            "rules.system.refused",
            "rules.system.stamps",
        ),
    ),
    Home(
        "MG5",
        ("rules.system.clocks", "rules.system.states", "rules.system.interfaces"),
    ),
    Home(
        "MG7",
        (
            "rules.launch.ending",
            "rules.launch.models",
            "rules.launch.rows",
            "rules.launch.started",
            "rules.launch.words",
        ),
    ),
    Home("MR1", ("spelling.table_checks", "spelling.way_checks")),
)


@cache
def rules() -> Mapping[str, Rule]:
    """All rules by code, in the order of the codes; imports every module that declares one."""
    from multibot_rewrite.lint.registry import RULES

    # A lint has some with examples of its own.
    found = [*RULES.values(), *(it for home in HOMES for it in declared(home))]
    by_code = {it.code: it for it in sorted(found, key=lambda it: it.code)}
    assert len({(it.code, it.name) for it in found}) == len(by_code), "two rules have one code"
    return by_code


def declared(home: Home) -> Iterator[Rule]:
    """The rules of its modules, once each: some modules import one of another."""
    modules = [import_module(f"multibot_rewrite.{name}") for name in home.modules]
    found = [it for one in modules for it in vars(one).values() if isinstance(it, Rule)]
    yield from {id(it): it for it in found if it.code.startswith(home.start)}.values()
