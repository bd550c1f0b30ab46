# SPDX-License-Identifier: Apache-2.0
"""The files of a cell: the URDF and SRDF of all arms, the parameters of their one move_group, and one
window of RViz, whose MotionPlanning reads the parameters of its process.

Controllers stay in the namespaces of their arms, and so does the name by which move_group asks for
their actions (moveit2 2.12.4 action_based_controller_handle.h, ``getActionName``).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import yaml

from multibot_rewrite.base.findings.finding import WARNING, declare
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import NAMESPACE
from multibot_rewrite.base.releases import ROS_2
from multibot_rewrite.companions.engine import splices_of
from multibot_rewrite.companions.joined import PartMoveit, joined_moveit
from multibot_rewrite.companions.moveit.file_kind import NAMES, OF_SERVO, SIMPLE, entries, file_kind
from multibot_rewrite.companions.names.rename_map import spell
from multibot_rewrite.companions.rviz.read_config import every, fixed_frame, read_config, targets
from multibot_rewrite.companions.rviz.rewrite import RvizText
from multibot_rewrite.companions.yaml_text import YamlText, read_yaml, replaced, spliced
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.fleet.file.cell_file import MOVE_GROUP, Cell
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.moveit_parameters import (
    FILE,
    PROGRAMS,
    parameter_file,
    parameters_from,
)
from multibot_rewrite.fleet.outputs.output_file import FilesAndFindings, OutputFile, path_for
from multibot_rewrite.fleet.robots.joined_robots import Arm, joined_arms
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.start_poses import world_of
from multibot_rewrite.spelling.start import File, Start, shell_line

_MANAGER = "moveit_controller_manager"
_DESCRIPTION = "robot_description"
_ONE_MANAGER = "Ros2ControlManager"
DISAGREE = declare("MF836", "arms-of-a-cell-disagree", WARNING, formats=("fleet",))


def cell_outputs(plan: FleetPlan, files: Iterable[OutputFile]) -> FilesAndFindings:
    """Yield the files of a fleet's cell, if it has one, made from the ``files`` of its robots.
    Raises InputError where the arms cannot be joined."""
    cell = plan.file.cell
    if cell is None:
        return
    made = {it.path: it.data for it in files}
    tree = builtin_tree(plan.file.vocabulary, plan.file.distro, ROS_2)
    world = world_of(plan.file, plan.fleet.naming)
    arms = [
        Arm(spec.name, spec.tag, it.description, it.srdf, spec.pose, f"{spec.file}:{spec.line}")
        for it in plan.robots
        for spec in [it.spec]
    ]
    joined = joined_arms(cell, world, arms, tree)
    moveit = [(it, robot) for robot in plan.robots for it in _moveit(plan, robot, made)]
    planning = joined_moveit(it for it, _ in moveit)
    robot_of = {it.file: robot for it, robot in moveit}
    for file, what in planning.notes:
        spec, hint = robot_of[file].spec, "give all arms of the cell one value"
        message = f"{spec.name!r}: {what}"
        yield DISAGREE.finding(message, hint, file=spec.file, line=spec.line)
    texts = {name: data.decode() for name, data in planning.files.items()}
    urdf, srdf = (joined[it].decode() for it in (".urdf", ".srdf"))
    values = {_DESCRIPTION: urdf, **parameters_from(srdf, texts, plan.file.distro)}
    specs = [robot.spec for robot in plan.robots]
    files_of = ((it.description, it.srdf, *it.companions.get("moveit", ())) for it in specs)
    sources = tuple(it for its in files_of for it in its)
    for ending, data in joined.items():
        yield OutputFile(f"{cell.name}/{cell.name}{ending}", data, sources)
    yield OutputFile(parameters_path(cell), parameter_file(values), sources)


def parameters_path(cell: Cell) -> str:
    """Return the path of the parameters of a cell's move_group."""
    return f"{cell.name}/{FILE}"


def cell_commands(plan: FleetPlan) -> Iterator[str]:
    """Yield the section of ``commands.md`` that starts the cell."""
    if cell := plan.file.cell:
        line = shell_line(Start(*PROGRAMS[MOVE_GROUP], parameters=(File(parameters_path(cell)),)))
        yield f"\n## {cell.name}\n\nOne move_group for all arms.\n\n```sh\n{line}\n```\n"


def _moveit(
    plan: FleetPlan, robot: RewrittenRobot, made: Mapping[str, bytes]
) -> Iterator[PartMoveit]:
    """Yield an arm's MoveIt files as a move_group for all needs them; servo runs for each arm."""
    for it in robot.spec.companions.get("moveit", ()):
        path = path_for(robot, it)
        document = read_yaml(made[path], path)
        kind = file_kind(document)
        found = next((it for key, it in entries(document.root) if key.value == _MANAGER), None)
        if found is not None and str(found.value).endswith(f"/{_ONE_MANAGER}"):
            place = f"{robot.spec.file}:{robot.spec.line}: cell: {robot.spec.name!r}"
            what = f"{_MANAGER} is {_ONE_MANAGER}, which asks one controller manager"
            raise InputError(f"{place}: {what}; write {SIMPLE}")
        if plan.fleet.naming.topics == NAMESPACE:
            _into_namespace(document.root, robot.spec.namespace)
        if kind != OF_SERVO:
            yield PartMoveit(path, kind, document)


def _into_namespace(node: yaml.Node | None, namespace: str) -> None:
    """Put the namespace before the names of controllers, where a file lists them."""
    found = {str(key.value): value for key, value in entries(node)}
    listed = found[NAMES].value if NAMES in found else ()
    names = {it.value for it in listed}
    for it in (*listed, *(key for key, _ in entries(node) if key.value in names)):
        it.value = f"{namespace}/{it.value}"
    if SIMPLE in found:
        _into_namespace(found[SIMPLE], namespace)


_GROUP = "group"


def cell_window(
    document: YamlText, cell: Cell, first: RewrittenRobot, world: str
) -> RvizText | None:
    """Return the window, seen from ``world``; it starts with the cell's first group, or with that
    of the ``first`` arm. None for a config without planning groups; raises as ``read_config``."""
    config = read_config(document)
    shown = (place for it in every(config.displays) for place in it.places)
    groups = [it for it in shown if it.kind == _GROUP]
    if not groups:
        return None
    own = spell(first.names, _GROUP, groups[0].slot.value)
    group = next(iter(cell.groups), own)
    splices = [*splices_of(document.text, document.file, ((it, group) for it in groups))]
    for it in (fixed_frame(config), *targets(config)):
        if isinstance(it, yaml.ScalarNode) and it.value not in ("", "<Fixed Frame>"):
            splices.append(replaced(it, world))
    return RvizText(cell.name, spliced(document, splices))
