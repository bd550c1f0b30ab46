# SPDX-License-Identifier: Apache-2.0
"""The RViz configs of a fleet, its own or made from the plan, and what opens the windows.

Sources: classes and properties ``rviz.yaml``; a map is latched (nav2_map_server map_server.cpp),
so is a description (robot_state_publisher.cpp); drivers send scans and clouds best effort (REP
2003)."""

import os
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

from multibot_rewrite.base.findings.finding import WARNING, Finding, declare
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.naming import LAYOUTS, PREFIX, TF_TOPICS, make_naming
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.moveit_parameters import (
    FILE,
    cell_window,
    has_moveit,
    parameters_path,
)
from multibot_rewrite.fleet.outputs.output_file import (
    FilesToCheck,
    OutputFile,
    ReadFile,
    name_among,
    own_yaml,
    path_for,
)
from multibot_rewrite.fleet.robots.robot_groups import split_per_robot
from multibot_rewrite.fleet.robots.robot_nodes import RVIZ
from multibot_rewrite.fleet.robots.start_poses import world_of
from multibot_rewrite.planning.shown import Shown, shown_by_robot, world_of_plan
from multibot_rewrite.planning.start import File, Start
from multibot_rewrite.related_files.names.node_topics import fleet_topics
from multibot_rewrite.related_files.rviz.display_groups import leaves
from multibot_rewrite.related_files.rviz.read_config import (
    TF_PREFIX,
    TOPIC,
    RvizRobot,
    palette,
    read_config,
    rviz_data,
)
from multibot_rewrite.related_files.rviz.rewrite import RvizText, read_for, rewrite_rviz
from multibot_rewrite.related_files.rviz.window_checks import ONE_TF_TOPIC
from multibot_rewrite.related_files.yaml_text import YamlText, found_at, quoted
from multibot_rewrite.system.records import Robot, System

_BEST_EFFORT = {"Reliability Policy": "Best Effort"}
_LATCHED = {"Durability Policy": "Transient Local"}
_QOS = {"LaserScan": _BEST_EFFORT, "PointCloud2": _BEST_EFFORT, "Map": _LATCHED}
# Those with a colour; some take it only without one for each point.
_FLAT = ("LaserScan", "PointCloud2")
_COLOURED = (*_FLAT, "Range", "Path", "Polygon", "PoseArray")
# Costmaps hide the map below them, and each other.
_MAP = "map"
_TOOLS = {"SetInitialPose": "initialpose", "SetGoal": "goal_pose"}


def windows_of_plan(plan: System, relayed: bool) -> tuple[RvizText, ...]:
    """Return a config for each robot if each has its own tf topic, otherwise one for all."""
    layout = next(it for it in LAYOUTS if plan.layout in (it.name, it.short))
    robots, shared = shown_by_robot(plan)
    lines = [_robot_displays(it, at, layout.at_run_time) for at, it in enumerate(robots)]
    if len({it.tf_topic for it in plan.robots}) == 1 or (relayed and layout.frames):
        own = [*_displays_of(shared, ""), *lines]
        return (RvizText("", _config_text(own, robots, world_of_plan(plan))),)
    made = []
    for it, group in zip(robots, lines, strict=True):
        # The frame that the robot's frames hang on.
        own_frames = {*it.robot.frames, *it.robot.other_frames}
        parents = (edge.parent for edge in plan.edges if edge.child in own_frames)
        root = next(parents, next(iter(it.robot.frames), ""))
        text = _config_text([*_displays_of(shared, ""), group], [it], root)
        remaps = _tf_topics(it.robot, layout.namespaced)
        space = f"/{it.robot.space}" if layout.namespaced else ""
        made.append(RvizText(it.robot.name, text, space, remaps))
    return tuple(made)


def _tf_topics(robot: Robot, namespaced: bool) -> tuple[tuple[str, str], ...]:
    """Return the rules (from, to) for both topics of tf."""
    # The robot's name may have ``tf`` in it, or be it: the topic is the last part of a name in a
    # namespace, else the first one of that name.
    tf, static = TF_TOPICS
    parts = robot.tf_topic.split("/")
    places = [at for at, it in enumerate(parts) if it == tf]
    if places:
        parts[places[-1 if namespaced else 0]] = static
    other = "/".join(parts) if places else f"/{static}{robot.tf_topic.removeprefix(f'/{tf}')}"
    return (f"/{tf}", robot.tf_topic), (f"/{static}", other)


def _robot_displays(shown: Shown, at: int, prefixed: bool) -> dict[str, Any]:
    """Return the displays of a robot, in its colour."""
    robot = shown.robot
    model = {
        **_of_topic("RobotModel", "RobotModel", {**_LATCHED, "Value": shown.description}, True),
        "Description Source": "Topic",
        "TF Prefix": (robot.tag or robot.name) if prefixed else "",
    }
    model["Description Topic"] = model.pop("Topic")
    colour = "; ".join(map(str, palette(at)))
    displays = [model, *_displays_of(shown, colour)]
    return {"Class": "rviz_common/Group", "Name": robot.name, "Enabled": True, "Displays": displays}


def _displays_of(shown: Shown, colour: str) -> Iterator[dict[str, Any]]:
    kinds = rviz_data()["shown"]
    for topic in sorted(shown.of_type(kinds)):
        kind = kinds[shown.sent[topic]]
        enabled = kind != "Map" or shown.is_called(topic, _MAP)
        made = _of_topic(kind, topic, {**_QOS.get(kind, {}), "Value": topic}, enabled)
        if colour and kind in _COLOURED:
            made |= {"Color": colour}
        if colour and kind in _FLAT:
            made |= {"Color Transformer": "FlatColor"}
        yield made


def _of_topic(kind: str, name: str, topic: dict[str, str], enabled: bool) -> dict[str, Any]:
    """Return the display of a topic."""
    kind = f"rviz_default_plugins/{kind}"
    return {"Class": kind, "Name": name, "Enabled": enabled, "Topic": topic}


def _config_text(displays: Sequence[dict[str, Any]], robots: Sequence[Shown], frame: str) -> str:
    clicked = [
        {"Class": f"rviz_default_plugins/{kind}", "Topic": {"Value": topic}}
        for it in robots
        for kind, word in _TOOLS.items()
        if (topic := it.clicked(word))
    ]
    usual = [{"Class": f"rviz_default_plugins/{it}"} for it in ("MoveCamera", "Select")]
    first = [_plain_display("Grid"), _plain_display("TF")]
    config = {
        "Panels": [{"Class": "rviz_common/Displays", "Name": "Displays"}],
        "Visualization Manager": {
            "Class": "",
            "Displays": [*first, *displays],
            "Global Options": {"Fixed Frame": frame},
            "Tools": [*usual, *clicked],
            "Views": {"Current": {"Class": "rviz_default_plugins/Orbit", "Distance": 10}},
        },
    }
    return "".join(f"{line}\n" for line in _yaml_lines(config))


def _plain_display(kind: str) -> dict[str, Any]:
    return {"Class": f"rviz_default_plugins/{kind}", "Name": kind, "Enabled": True}


def _yaml_lines(value: Any) -> Iterator[str]:
    """Yield a mapping as lines of YAML. PyYAML takes longer than the rest of a build."""
    for key, there in value.items():
        if isinstance(there, dict):
            yield f"{key}:"
            yield from (f"  {it}" for it in _yaml_lines(there))
        elif isinstance(there, list):
            yield f"{key}:" if there else f"{key}: []"
            for one in there:
                first, *rest = _yaml_lines(one)
                yield from (f"  - {first}", *(f"    {it}" for it in rest))
        else:
            text = str(there).lower() if isinstance(there, bool | int) else quoted(there)
            yield f"{key}: {text}"


# The window for all robots where a bridge puts their names before the frames on their way to ``/tf``.
# Links have bare names and frames the robot's, as with robot_state_publisher's ``frame_prefix``; those
# in
# headers of messages stay bare. Source: tf_namespace_bridge src/tf_namespace_bridge.cpp; rviz_common
# src/rviz_common/transformation (displays of messages look their header's frame up in tf).
AT_RUN_TIME = "frame-prefix"

BARE_HEADERS = declare("MF216", "rviz-bridged-messages", WARNING, formats=("fleet",))


def bridged_window(
    document: YamlText, robots: Sequence[RvizRobot], world: str
) -> tuple[RvizText, tuple[Finding, ...]]:
    """Return the config for all robots, and its limits as findings; raises as ``rewrite_rviz``."""
    shared = [world] if world else []
    naming = make_naming(layout=AT_RUN_TIME, affix=PREFIX, shared_frames=shared)
    bridged = []
    for it in robots:
        own = it.topics.robot
        names = it.names._replace(naming=naming, robot=own)
        bridged.append(it._replace(names=names, tf_prefix=own))
    texts, _ = rewrite_rviz(document, bridged, world=world)
    shown = next(it for it in texts if not it.robot)
    return shown, tuple(_empty_displays(document))


def _empty_displays(document: YamlText) -> Iterator[Finding]:
    shown = ((it, {at.kind for at in it.places}) for it in leaves(read_config(document).displays))
    found = [it for it, kinds in shown if TOPIC in kinds and TF_PREFIX not in kinds]
    if found:
        names = ", ".join(it.name or it.cls for it in found)
        message = (
            f"the window for all robots shows nothing of {names}: "
            "frames in headers are without the robot's name"
        )
        hint = "each robot has a window for it; or take layout both"
        yield found_at(document, found[0].node, BARE_HEADERS, message, hint)


# What stands for the config of a fleet that names none: a path of no file.
USUAL = "/fleet.rviz"


class RvizOutput(NamedTuple):
    """The windows of the RViz config ``source``; ``name`` is that for several robots."""

    source: str
    windows: tuple[RvizText, ...]
    findings: tuple[Finding | ReadFile, ...]
    name: str

    def path(self, window: RvizText) -> str:
        """Return where the config of a window goes."""
        return f"{window.robot}/{os.path.basename(self.source)}" if window.robot else self.name


def rviz_outputs(plan: FleetPlan, each: Iterable[FleetPlan]) -> Iterator[RvizOutput]:
    """Yield the windows of each config; raises InputError if one cannot be rewritten."""
    robots_of = lists_by_key(
        (path, it) for it in plan.robots for path in it.spec.related_files.get("rviz", ())
    )
    own = {it.robots[0].spec.name: it for it in each}
    world = world_of(plan.file, plan.fleet.naming)
    for path, robots in robots_of.items():
        document = own_yaml(robots[0].spec, path)
        shown = [_as_rviz_robot(own[robot.spec.name]) for robot in robots]
        relayed = plan.file.relayed
        texts, found = rewrite_rviz(document, shown, world=world, relayed=relayed)
        if plan.file.cell:
            made = cell_window(document, plan.file.cell, robots[0], world)
            texts = (*(it for it in texts if not (it.robot and made)), *filter(None, [made]))
        if relayed and not plan.fleet.naming.layout.frames:
            window, bare = bridged_window(document, shown, world)
            texts, found = (window, *texts), (*found, *bare)
        done = ONE_TF_TOPIC.code if relayed else ""
        left = tuple(it for it in found if it.code != done)
        read = ReadFile(read_for(document, shown, plan.file.distro), tuple(robots))
        name = name_among(path, robots_of).replace("/", "_")
        yield RvizOutput(path, texts, (*left, read), name)


def usual_windows(plan: FleetPlan, planned: System) -> list[RvizOutput]:
    """Return the windows of a fleet that names no config of RViz."""
    made = windows_of_plan(planned, plan.file.relayed)
    return [RvizOutput(USUAL, made, (), os.path.basename(USUAL))] if plan.robots else []


def robot_windows(plan: FleetPlan, each: bool) -> list[tuple[str, RvizText]]:
    """Return windows with file names; ``each``: one for each robot. Raises as ``rviz_outputs``."""
    apart = list(split_per_robot(plan))
    made = [rviz_outputs(one, [one]) for one in apart] if each else [rviz_outputs(plan, apart)]
    found = (it for outputs in made for it in outputs)
    return [(os.path.basename(it.source), window) for it in found for window in it.windows]


def _as_rviz_robot(plan: FleetPlan) -> RvizRobot:
    """Return the one robot of a plan as RViz shows it."""
    (robot,) = plan.robots
    spec = robot.spec
    names = robot.names._replace(robot=spec.tag)
    topics = robot.topics._replace(robot=spec.namespace)
    known = fleet_topics(plan.fleet.table, plan.fleet.facts, spec.namespace)
    # The name and the rules of an rviz2 that the robot's node sets start.
    own = next((it for it in plan.fleet.table.runs if it.robot and it.node == RVIZ), None)
    rules = own.rules if own else ()
    if own and not plan.fleet.naming.layout.namespaced:
        rules = (("__node", own.name), *rules)
    prefix = spec.tag if names.naming.layout.at_run_time else ""
    apart = RVIZ in plan.file.own_nodes
    return RvizRobot(spec.name, names, topics, spec.colour, known, prefix, rules, apart)


def rviz_files(configs: Iterable[RvizOutput]) -> FilesToCheck:
    """Yield the files of the windows, and the findings."""
    for config in configs:
        yield from config.findings
        read = () if config.source == USUAL else (config.source,)
        yield from (OutputFile(config.path(it), it.text.encode(), read) for it in config.windows)


def window_start(window: RvizText, file: str, parameters: str = "") -> Start:
    """Return what opens a window whose config is a ``file``."""
    given = (File(parameters),) if parameters else ()
    return Start(RVIZ, RVIZ, window.namespace, "", given, window.remaps, ("-d", File(file)))


def opened_of(plan: FleetPlan, configs: Iterable[RvizOutput]) -> list[RvizOutput]:
    """Return the windows that open by themselves."""
    # A launch file that starts RViz opens one for a robot: so the one for all is left out.
    if not any(it.spec.launch for it in plan.robots):
        return [*configs]
    of_robots = ((it, tuple(one for one in it.windows if one.robot)) for it in configs)
    return [it._replace(windows=own or it.windows) for it, own in of_robots]


def windows(plan: FleetPlan, configs: Iterable[RvizOutput]) -> list[tuple[str, Start]]:
    """Return (robot, what opens it) for each window, with "" for one of all robots."""
    given = {it.spec.name: path_for(it, FILE) for it in plan.robots if has_moveit(it)}
    if cell := plan.file.cell:
        given[cell.name] = parameters_path(cell)
    return [
        (it.robot, window_start(it, config.path(it), given.get(it.robot, "")))
        for config in configs
        for it in config.windows
    ]
