"""Every rule of every command by its code: for ``multibot explain``, reports and the generated pages.

``python -m multibot_rewrite.catalogue > docs/findings.md`` makes the page of what is not a rule of
``urdf-lint``.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from functools import cache
from importlib import import_module

from multibot_rewrite.findings.rule import Rule
from multibot_rewrite.findings.rule_docs import Group, page
from multibot_rewrite.record import NamedTuple

HEAD = """\
# Findings

Made by `python -m multibot_rewrite.catalogue > docs/findings.md`; `multibot explain CODE` prints one.
An *error* stops the job, a *warning* does so with `--fail-on warning`, a *note* never does. Examples
are tested: the first has the finding, the last does not. The rules that `urdf-lint` has as well are on
[their own page](lint-rules.md).
"""
PAIR_INTRO = """\
`multibot check` and `multibot rehearse` find these: they compare a plan with what runs or was recorded.
A line of an example begins with `planned:` (in the plan), `running:` (in the system) or `as planned:`
(in both). Whole fleets with a fault each, and the lines that are printed, are in `fixtures/graphs`.

Where the view of the system may be incomplete, a finding about something missing is *inconclusive*
instead of an error.

Not reported: further topics of a node below its robot's name; operator topics without a publisher;
tools (RViz, rqt, ros2 CLI, rosbag2, bridges, teleop, containers, Gazebo's own nodes); frames below a
declared link whose names begin like the link's (`camera_link` has `camera_depth_frame`).
"""

SYSTEM_INTRO = """\
All commands find these, with a plan and without: `multibot doctor`, `check`, `check-launch` and
`rehearse`, of a running system, a launch file or a recording. With a plan more of them are found, each
with its cause; what the plan has is meant. All lines of an example begin with `running:`; the robots
are `robot1`, `robot2`.
"""
BUILT_INTRO = """\
`multibot build` checks all files once more before it writes them. Each kind of mistake is reported once
for a file, with the number of lines.
"""


class Home(NamedTuple):
    """Rules whose codes begin with ``start``, and the modules (below the package) that declare them.

    ``intro`` is the Markdown above them.
    """

    start: str
    title: str
    modules: tuple[str, ...]
    intro: str = ""


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
            "companions.params.slashes",
            "companions.params.release_checks",
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
            "companions.rviz.name_checks",
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
            "fleets.bridge_checks",
            "fleets.bridge_merge",
            "fleets.bridge_outputs",
            "fleets.bridge_types",
        ),
    ),
    Home(
        "MF6",
        "what was built",
        ("fleets.consistency", "fleets.value_checks", "fleets.tf_conflicts"),
        BUILT_INTRO,
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
            "evidence.launch_findings",
            "evidence.spawner_managers",
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
            "fleets.closing_topics",
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
        PAIR_INTRO,
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
        ),
        SYSTEM_INTRO,
    ),
    Home(
        "MG4",
        "any system: tf",
        ("rules.system.transforms", "rules.system.tf_topics", "rules.system.frame_ids"),
    ),
    Home("MG5", "any system: time and states", ("rules.system.clocks", "rules.system.states")),
    Home("MR1", "remap tables", ("remap.table_checks", "remap.way_checks")),
)


@cache
def rules() -> Mapping[str, Rule]:
    """All rules by code, in the order of the codes; imports every module that declares one."""
    from multibot_rewrite.lint.registry import RULES

    found = [*RULES.values(), *(it for home in HOMES for it in _declared(home))]
    by_code = {it.code: it for it in sorted(found, key=lambda it: it.code)}
    assert len(by_code) == len(found), "two rules have one code"
    return by_code


def _declared(home: Home) -> Iterator[Rule]:
    for name in home.modules:
        module = import_module(f"{__package__}.{name}")
        found = (it for it in vars(module).values() if isinstance(it, Rule))
        yield from (it for it in found if it.code.startswith(home.start))


def findings_page() -> str:
    """The page of the rules that only other commands than ``urdf-lint`` have."""
    groups = (
        Group(it.start, it.title, tuple(sorted(_declared(it), key=lambda it: it.code)), it.intro)
        for it in HOMES
    )
    return page(HEAD, groups)


if __name__ == "__main__":
    sys.stdout.write(findings_page())
