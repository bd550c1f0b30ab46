# SPDX-License-Identifier: Apache-2.0
"""``fleet.launch.py``: one command that starts the fleet that was built."""

from __future__ import annotations

import os
from collections.abc import Collection, Sequence

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.releases import facts_of_release
from multibot_rewrite.base.wording import plural
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.launch import launch_actions
from multibot_rewrite.fleet.launch.launch_python import to_python
from multibot_rewrite.fleet.launch.launched_simulator import launched_simulator
from multibot_rewrite.fleet.launch.starts import GZ, RVIZ, FleetStarts, RobotStarts, with_switches
from multibot_rewrite.fleet.outputs import spawn, teleop, world_file
from multibot_rewrite.fleet.outputs.output_file import OutputFile
from multibot_rewrite.fleet.outputs.related_files import launched_values
from multibot_rewrite.fleet.robots.robot_nodes import RVIZ as PROGRAM
from multibot_rewrite.planning.start import File, Start, shell_line
from multibot_rewrite.producers.launch.handed_on import for_robot

LAUNCH = "fleet.launch.py"
# Substitutions of launch that need no argument, and all others.
_SUBSTITUTION = lazy_compile(rb"\$\((?:(find-pkg-share|env) |(\w))")


def launch_file(starts: FleetStarts) -> OutputFile:
    """Return the launch file of a fleet, as a file of the build."""
    return OutputFile(LAUNCH, to_python(starts).encode())


def fleet_starts(
    plan: FleetPlan,
    each: Sequence[FleetPlan],
    files: Sequence[OutputFile],
    bridged: Collection[str],
    shown: Sequence[tuple[str, Start]],
    opens: Sequence[tuple[str, Start]],
) -> FleetStarts:
    """Return what the launch file starts.

    ``each`` is every robot as a fleet of its own, ``files`` what else is built, ``bridged`` the
    topics of bridges, ``shown`` the windows of RViz, each with its robot; ``opens`` are those to
    open."""
    # Whether the launch can replace all substitutions of a file, and there are some.
    found = ((it.path, [known for known, _ in _SUBSTITUTION.findall(it.data)]) for it in files)
    paths = {path: bool(known) and all(known) for path, known in found}
    values = launched_values(plan).values
    texts = {it.path: it.data for it in files}
    robots = [launch_actions.of_robot(one, paths, bridged, values, texts) for one in each]
    environment, robots = _environment(plan, robots)
    simulators = spawn.simulators(plan)
    clocks = {it.spec.name: it.spec.use_sim_time for it in plan.robots}
    first, *others = {*clocks.values()}
    if others:
        robots = [it._replace(clock=clocks[it.name]) for it in robots]
    clock = None if others else first
    source = os.path.basename(plan.file.file) or "a fleet"
    count = plural(len(plan.robots), "robot")
    # A window that shows one robot alone is not opened without it, and has what his launch file gives.
    rviz = {it.name for one in plan.evidence.values() for it in one.nodes if it.kind == PROGRAM}
    given = {
        key[0]: (launch_actions.without_names(it),) for key, it in values.items() if key[1] in rviz
    }
    wired = (
        (name, it._replace(condition=RVIZ, parameters=(*it.parameters, *given.get(name, ()))))
        for name, it in opens
    )
    opened = lists_by_key(wired)
    robots = [it._replace(starts=(*it.starts, *opened.pop(it.name, ()))) for it in robots]
    launched = launched_simulator(plan.file)
    idle = (one for it in plan.robots for one in plan.evidence_of(it).idle)
    made = FleetStarts(
        f"Start {count} of {source}{facts_of_release(plan.file.distro)}.",
        simulators,
        launch_actions.of_all(plan, paths, simulators, values),
        robots,
        [window for own in opened.values() for window in own],
        bool(simulators) or _is_simulated(plan) if clock is None else clock,
        [shell_line(it.start) for one in each for it in teleop.teleops(one)],
        _world(simulators, paths, launched.world),
        plan.file.apart.numbers,
        [window for _, window in shown],
        environment,
        "".join(f"{it} " for it in launched.options),
        launched.headless,
    )
    return with_switches(made, {name for it in idle for name, _ in it.asked})


def _environment(
    plan: FleetPlan, robots: Sequence[RobotStarts]
) -> tuple[dict[str, str], list[RobotStarts]]:
    """Return the environment for all robots' processes, and the robots with their own one."""
    # What starts later is outside its robot's domain: it gets that, too.
    own = {
        it.spec.name: for_robot(plan.evidence_of(it).environment, it.spec.name)
        for it in plan.robots
    }
    first = own[plan.robots[0].spec.name]
    common = [it for it in first if all(it in every for every in own.values())]
    domains = plan.file.apart.numbers
    made = []
    for robot in robots:
        more = dict(it for it in own[robot.name] if it not in common)
        domain = {"ROS_DOMAIN_ID": f"{domains[robot.name]}"} if domains else {}
        starts = []
        for it in robot.starts:
            later = domain if it.process.delay or it.process.event else {}
            starts.append(it._replace(environment={**more, **it.environment, **later}))
        made.append(robot._replace(starts=tuple(starts)))
    return dict(common), made


def _is_simulated(plan: FleetPlan) -> bool:
    """Return whether launch files give nodes the time of an otherwise unknown simulator."""
    robots = (it for it in plan.robots if it.spec.simulator != REAL)
    handed = (it for robot in robots for it in plan.evidence_of(robot).handed_on.values())
    return {it.clock for it in handed if it.clock is not None} == {True}


def _world(simulators: Collection[str], paths: Collection[str], launched: str) -> File | str:
    """Return the world of the build, otherwise that of the launch files, otherwise Gazebo's."""
    if simulators and world_file.FILE in paths:
        return File(world_file.FILE)
    return launched or ("empty.sdf" if GZ in simulators else "")
