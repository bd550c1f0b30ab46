"""Every rule of every command by its code: for ``multibot explain``, reports and pages."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from importlib import import_module

from multibot_rewrite.findings.rule import Rule
from multibot_rewrite.record import NamedTuple


class Home(NamedTuple):
    """Rules whose codes begin with ``start``, and the modules (below the package) that declare them."""

    start: str
    title: str
    modules: tuple[str, ...]


HOMES: tuple[Home, ...] = (
    Home("MB1", "rewriting a description", ("steps.plan", "checks.robots", "checks.arguments")),
    Home(
        "MF1",
        "parameter files",
        (
            "companions.params.sections",
            "companions.params.section_checks",
            "companions.params.robot_names",
            "companions.params.values",
            "companions.params.name_checks",
            "companions.params.unknown_parameters",
            "companions.params.shared_defaults",
            "companions.params.bringup_style",
            "companions.params.calibrations",
        ),
    ),
    Home(
        "MF2",
        "RViz",
        (
            "companions.rviz.window_checks",
            "companions.rviz.bridged",
            "companions.rviz.display_checks",
        ),
    ),
    Home(
        "MF3",
        "MoveIt",
        ("companions.moveit.checks", "companions.moveit.controller_manager"),
    ),
    Home("MF4", "behavior trees and Lua", ("companions.behavior_tree.checks", "companions.lua")),
    Home(
        "MF5",
        "bridges",
        (
            "companions.bridge_checks",
            "fleets.bridge_merge",
            "fleets.bridge_outputs",
        ),
    ),
    Home(
        "MF6",
        "what was built",
        ("fleets.consistency", "fleets.value_checks"),
    ),
    Home(
        "MF7",
        "start poses and spawning",
        (
            "fleets.start_pose_rules",
            "fleets.spawn",
            "fleets.two_descriptions",
            "fleets.controller_files",
        ),
    ),
    Home(
        "MF8",
        "what a robot's files say of its nodes",
        (
            "evidence.nodes",
            "producers.launch.findings",
            "producers.launch.spawner_managers",
            "fleets.launched_files",
            "fleets.loaded_files",
            "fleets.yarp_files",
            "fleets.launched_prefix",
            "fleets.filled_arguments",
            "fleets.simulators",
            "fleets.shared_nodes",
            "fleets.params_style",
            "fleets.closing",
            "fleets.closing_bridges",
            "fleets.closing_controllers",
            "fleets.closing_semantics",
            "fleets.srdf_of_another",
            "fleets.devices",
            "fleets.apart",
            "fleets.cell_outputs",
            "fleets.moveit_frames",
        ),
    ),
    Home(
        "MG1",
        "not as planned: nodes, names, states",
        (
            "rules.pair.nodes",
            "rules.pair.endpoints",
            "rules.pair.demands",
            "rules.pair.in_enclaves",
            "rules.pair.planned_states",
        ),
    ),
    Home("MG2", "not as planned: frames", ("rules.pair.frame_names", "rules.pair.frames_heard")),
    Home(
        "MG3",
        "any system: nodes, names, commands, data",
        (
            "rules.system.nodes",
            "rules.system.names",
            "rules.system.matching",
            "rules.system.commands",
            "rules.system.relays",
            "rules.system.sharing",
            "rules.system.equal_robots",
            "rules.system.unsent",
        ),
    ),
    Home(
        "MG4",
        "any system: tf",
        ("rules.system.transforms", "rules.system.tf_topics", "rules.system.frame_ids"),
    ),
    Home(
        "MG5",
        "any system: time and states",
        ("rules.system.clocks", "rules.system.states", "rules.system.interfaces"),
    ),
    Home("MR1", "remap tables", ("remap.table_checks", "remap.way_checks")),
)


@cache
def rules() -> Mapping[str, Rule]:
    """All rules by code, in the order of the codes; imports every module that declares one."""
    from multibot_rewrite.lint.registry import RULES

    found = [*RULES.values(), *(it for home in HOMES for it in declared(home))]
    by_code = {it.code: it for it in sorted(found, key=lambda it: it.code)}
    assert len(by_code) == len(found), "two rules have one code"
    return by_code


def declared(home: Home) -> Iterator[Rule]:
    """The rules of its modules."""
    for name in home.modules:
        module = import_module(f"{__package__}.{name}")
        found = (it for it in vars(module).values() if isinstance(it, Rule))
        yield from (it for it in found if it.code.startswith(home.start))
