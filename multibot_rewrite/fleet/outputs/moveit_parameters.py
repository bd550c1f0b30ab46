# SPDX-License-Identifier: Apache-2.0
"""``NAME/moveit_parameters.yaml`` for each robot's move_group, and the files of a cell.

They replace what MoveItConfigsBuilder makes in a launch file, so move_group, servo_node and
rviz2 can be started with them. Source: moveit2 4d8410635 moveit_configs_utils/moveit_configs.py
(``to_dict``), moveit_configs_builder.py, and its default_configs/ompl_planning.yaml of each
release. Controllers stay in the namespaces of their arms, and so does the name by which
move_group asks for their actions (moveit2 2.12.4 action_based_controller_handle.h,
``getActionName``)."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import yaml

from multibot_rewrite.base.bounded import load_own_yaml, load_yaml
from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, declare
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import NAMESPACE
from multibot_rewrite.base.releases import ROS_2, has_release
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.fleet.file.domains import MOVE_GROUP, Cell
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_file import (
    FilesAndFindings,
    OutputFile,
    expanded_name,
    own_yaml,
    path_for,
)
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot
from multibot_rewrite.fleet.robots.start_poses import world_of
from multibot_rewrite.planning.start import File, Start, shell_line
from multibot_rewrite.planning.ways import started
from multibot_rewrite.related_files.engine import splices_of
from multibot_rewrite.related_files.moveit.file_kind import (
    ABOVE,
    EMPTY,
    NAMES,
    OF_SERVO,
    PLANNING,
    SIMPLE,
    entries,
    file_kind,
    pipeline_of,
)
from multibot_rewrite.related_files.names.rename_map import spell
from multibot_rewrite.related_files.rviz.read_config import every, fixed_frame, read_config, targets
from multibot_rewrite.related_files.rviz.rewrite import RvizText
from multibot_rewrite.related_files.yaml_text import YamlText, read_yaml, replaced, spliced

if TYPE_CHECKING:
    from multibot_rewrite.related_files.joined import PartMoveit

FILE = "moveit_parameters.yaml"
# Package and executable of the nodes that take it, by their names in the node set.
_MOVE_GROUP = "move_group"
PROGRAMS = {
    _MOVE_GROUP: ("moveit_ros_move_group", "move_group"),
    "servo_node": ("moveit_servo", "servo_node"),
}
_MANAGER = f"{SIMPLE}/MoveItSimpleControllerManager"
SEMANTIC = "robot_description_semantic"
# Files that are none of move_group's.
_OF_OTHERS = (OF_SERVO, "initial_positions", EMPTY)
_OMPL = "ompl"


def has_moveit(robot: RewrittenRobot) -> bool:
    """Return whether the robot has an SRDF and files of MoveIt."""
    return bool(robot.srdf and robot.spec.related_files.get("moveit"))


def moveit_commands(plan: FleetPlan) -> Iterator[Start]:
    """Yield what a user starts for the one robot of a plan: move_group and servo_node."""
    (robot,) = plan.robots
    servo = any(
        file_kind(own_yaml(robot.spec, it)) == OF_SERVO
        for it in robot.spec.related_files.get("moveit", ())
    )
    nodes = PROGRAMS if servo else (_MOVE_GROUP,)
    for it in started(plan.fleet.table) if has_moveit(robot) else ():
        if it.node.node in nodes:
            names, files = (it.node.namespace, it.node.other_name), (File(path_for(robot, FILE)),)
            yield Start(*PROGRAMS[it.node.node], *names, files, it.rules)


def moveit_parameters(plan: FleetPlan, files: Iterable[OutputFile]) -> Iterator[OutputFile]:
    """Yield the file of each robot that has an SRDF and MoveIt files, made from ``files``."""
    made = {it.path: it.data for it in files}
    for robot in filter(has_moveit, plan.robots):
        values = parameters_of(robot, made, plan.file.distro)
        sources = (robot.spec.srdf, *robot.spec.related_files["moveit"])
        yield OutputFile(path_for(robot, FILE), parameter_file(values), sources)


def parameters_of(
    robot: RewrittenRobot, made: Mapping[str, bytes], release: str
) -> Mapping[str, Any]:
    """Return the parameters of a robot's MoveIt, by its files that were ``made``, by path."""
    paths = robot.spec.related_files.get("moveit", ())
    texts = {it: made[path_for(robot, it)].decode() for it in paths}
    srdf = made[path_for(robot, expanded_name(robot.spec.srdf))].decode()
    return parameters_from(srdf, texts, release)


def parameter_file(values: Mapping[str, Any]) -> bytes:
    """Return a file that any node takes."""
    data = {"/**": {"ros__parameters": values}}
    dumper = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
    return str(yaml.dump(data, None, dumper, sort_keys=False)).encode()


def parameters_from(srdf: str, texts: Mapping[str, str], release: str) -> Mapping[str, Any]:
    """Return the parameters of MoveIt's nodes, from an SRDF and from MoveIt files by path."""
    found: dict[str, Any] = {SEMANTIC: srdf, "publish_robot_description_semantic": True}
    pipelines: list[str] = []
    for path, text in texts.items():
        kind, data = (
            file_kind(read_yaml(text.encode(), path)),
            _without_nulls(load_yaml(text, path)) or {},
        )
        if kind == PLANNING and (name := pipeline_of(path)):
            pipelines.append(name)
            found.setdefault(name, {}).update(_with_plugins(name, data, release))
        elif kind == "controllers" and NAMES in data:
            found |= {"moveit_controller_manager": _MANAGER, SIMPLE: data}
        elif above := ABOVE.get(kind, ""):
            found.setdefault(above, {}).update(data.get(above, data))
        elif kind != "initial_positions":
            found.update(data)
    if not pipelines:
        pipelines, found[_OMPL] = [_OMPL], _with_plugins(_OMPL, {}, release)
    first = _OMPL if _OMPL in pipelines else pipelines[0]
    return found | {"planning_pipelines": pipelines, "default_planning_pipeline": first}


def move_group_parameters(description: str, srdf: str, texts: Mapping[str, str]) -> dict[str, Any]:
    """Return move_group's parameters as ``to_dict`` of moveit_configs_utils; raises InputError."""
    found: dict[str, Any] = {"robot_description": description}
    if srdf:
        found[SEMANTIC] = srdf
    for path, text in texts.items():
        kind, data = file_kind(read_yaml(text.encode(), path)), load_yaml(text, path)
        if kind in _OF_OTHERS:
            continue
        # Planners are below the first word of their file: ompl_planning.yaml.
        name = os.path.basename(path).partition("_")[0] if kind == PLANNING else ABOVE.get(kind)
        below = found.setdefault(name, {}) if name else found
        below.update(data)
    return found


def _with_plugins(name: str, data: Mapping[str, Any], release: str) -> Mapping[str, Any]:
    """Return a pipeline with the plugins that its file leaves to the launch file."""
    if name != _OMPL or "planning_plugins" in data or "planning_plugin" in data:
        return data
    of_release = "humble" if has_release("<=humble", release) else "usual"
    return {**load_own_yaml(__file__, "moveit_planning.yaml")[of_release], **data}


def _without_nulls(value: Any) -> Any:
    """Return a value as rcl takes it: without null, and without lists of several types."""
    if isinstance(value, dict):
        items = ((str(key), _without_nulls(it)) for key, it in value.items())
        return {key: it for key, it in items if it is not None and it not in ([], {})}
    if not isinstance(value, list):
        return value
    types = {type(it) for it in value}
    if types == {int, float}:
        return [float(it) for it in value]
    # rcl takes lists of one type, launch_ros refuses others, too.
    return value if len(types) == 1 and not types & {dict, list} else None


_PACKAGES = ("moveit_ros_move_group", "moveit_servo", "moveit_ros_planning")
# moveit2 2.12.4 planning_scene_monitor.cpp (``getUpdatedFrameTransforms``: every frame of tf is
# looked up from the root link or the virtual joint's parent, by its name in the URDF and SRDF),
# current_state_monitor.cpp (a moving virtual joint: the same of its child),
# planning_scene_display.cpp (``calculateOffsetPosition``). No parameter puts a prefix before them.
PREFIXED_LATER = declare("MF837", "moveit-with-frame-prefix", ERROR, formats=("fleet",))


def moveit_frames(plan: FleetPlan) -> Iterator[Finding]:
    """Yield the robots whose MoveIt would look for frames that tf does not have."""
    if not plan.fleet.naming.layout.at_run_time:
        return
    those = {it.name for it in plan.fleet.facts if it.package in _PACKAGES}
    running = {it.robot: it.node for it in reversed(plan.fleet.table.runs) if it.node in those}
    for robot in plan.robots:
        if node := running.get(robot.spec.namespace):
            root = next(iter(robot.links), "")
            what = "looks for the links of the URDF in tf, which has"
            message = f"{node} of {robot.spec.name!r} {what} {root!r}"
            hint = "take layout frames-per-robot with affix: prefix"
            yield at_robot(PREFIXED_LATER, robot, message, hint)


_CELL_MANAGER = "moveit_controller_manager"
_DESCRIPTION = "robot_description"
_ONE_MANAGER = "Ros2ControlManager"
DISAGREE = declare("MF836", "arms-of-a-cell-disagree", WARNING, formats=("fleet",))


def cell_outputs(plan: FleetPlan, files: Iterable[OutputFile]) -> FilesAndFindings:
    """Yield the files of a fleet's cell from those of its robots; raises InputError."""
    cell = plan.file.cell
    if cell is None:
        return
    from multibot_rewrite.fleet.robots.joined_robots import Arm, joined_arms  # few have a cell
    from multibot_rewrite.related_files.joined import joined_moveit

    made = {it.path: it.data for it in files}
    tree = builtin_tree(plan.file.definitions, plan.file.distro, ROS_2)
    world = world_of(plan.file, plan.fleet.naming)
    arms = [
        Arm(spec.name, spec.tag, it.description, it.srdf, spec.pose, f"{spec.file}:{spec.line}")
        for it in plan.robots
        for spec in [it.spec]
    ]
    joined = joined_arms(cell, world, arms, tree)
    moveit = [(it, robot) for robot in plan.robots for it in _moveit_of_arm(plan, robot, made)]
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
    files_of = ((it.description, it.srdf, *it.related_files.get("moveit", ())) for it in specs)
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


def _moveit_of_arm(
    plan: FleetPlan, robot: RewrittenRobot, made: Mapping[str, bytes]
) -> Iterator[PartMoveit]:
    """Yield an arm's MoveIt files as a move_group for all needs them; servo runs for each arm."""
    from multibot_rewrite.related_files.joined import PartMoveit

    for it in robot.spec.related_files.get("moveit", ()):
        path = path_for(robot, it)
        document = read_yaml(made[path], path)
        kind = file_kind(document)
        found = next((it for key, it in entries(document.root) if key.value == _CELL_MANAGER), None)
        if found is not None and str(found.value).endswith(f"/{_ONE_MANAGER}"):
            place = f"{robot.spec.file}:{robot.spec.line}: cell: {robot.spec.name!r}"
            what = f"{_CELL_MANAGER} is {_ONE_MANAGER}, which asks one controller manager"
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
    """Return the window of a cell in ``world``; None for a config without planning groups."""
    # It starts with the cell's first group, or with that of the ``first`` arm.
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
