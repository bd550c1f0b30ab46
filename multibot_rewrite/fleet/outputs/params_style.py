# SPDX-License-Identifier: Apache-2.0
"""How a build writes parameter files: with full names of nodes, or as nav2_bringup takes them.

What nav2_bringup starts is below a namespace, with the rules ``/tf:=tf`` and ``/tf_static:=tf_static``
for all nodes and the container; no argument says otherwise. Source: nav2_bringup
launch/bringup_launch.py, localization_launch.py, navigation_launch.py and slam_launch.py of humble
(1.1.20), jazzy (1.3.13), kilted (1.4.2), lyrical (1.5.1) and rolling (a3a97043e).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from types import MappingProxyType

from multibot_rewrite.base.findings.finding import NOTE, Finding, declare
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import NAMESPACE, TF_TOPICS, make_naming
from multibot_rewrite.fleet.file.fleet_file import BRINGUP, FleetFile
from multibot_rewrite.fleet.file.robot_spec import RobotSpec
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_file import FilesAndFindings, OutputFile, path_for
from multibot_rewrite.fleet.outputs.shape_outputs import taken_as_they_are
from multibot_rewrite.fleet.robots.robot_nodes import nodes_of_sets
from multibot_rewrite.fleet.robots.start_poses import start_poses
from multibot_rewrite.knowledge.node_sets import load_node_set
from multibot_rewrite.related_files.params.shared_defaults import for_bringup
from multibot_rewrite.related_files.yaml_text import read_yaml

# The node sets that are nav2_bringup's launch files.
_NODE_SETS = ("nav2_composed", "nav2_slam")
# What its launch files replace in parameter files, from Kilted on -> the node that makes it true.
ZONES = MappingProxyType(
    {
        "KEEPOUT_ZONE_ENABLED": "keepout_filter_mask_server",
        "SPEED_ZONE_ENABLED": "speed_filter_mask_server",
    }
)
_TF = frozenset(f"/{it}" for it in TF_TOPICS)
_INSTEAD = "take layout tf-per-robot or both, or start Nav2 with nav2.launch.py of multibot_rewrite"

NO_RULE = declare("MF829", "rule-not-of-bringup", NOTE, formats=("fleet",))


def check_style(file: FleetFile) -> None:
    """Raise UsageError for parameter files in the style of nav2_bringup that it cannot start."""
    if file.params_style != BRINGUP:
        return
    naming = make_naming(**file.policy)
    layout, place = naming.layout, f"{file.file}: params_style {BRINGUP}"
    if naming.topics != NAMESPACE or not layout.tf_per_robot:
        why = "it always starts Nav2 in the robot's namespace and remaps /tf to tf there"
        what = f"nav2_bringup cannot start layout {layout.name}"
        raise UsageError(f"{place}: {what}: {why}; {_INSTEAD}")
    started = {it.name for node_set in _NODE_SETS for it in load_node_set(node_set, file.distro)}
    for name in (it for it in file.shared_nodes if it in started):
        hint = f"remove {name} from shared_nodes, or start Nav2 with nav2.launch.py of multibot_rewrite"
        raise UsageError(f"{place}: nav2_bringup starts {name} for each robot; {hint}")


def in_style(plan: FleetPlan, files: Sequence[OutputFile]) -> FilesAndFindings:
    """Yield the files of a fleet in the style that it asks for."""
    robots = {
        path_for(robot, source): robot.spec
        for robot in plan.robots
        for source in robot.spec.related_files.get("params", ())
    }
    bringup = plan.file.params_style == BRINGUP
    poses = start_poses(plan).initial if bringup else ()
    as_they_are = taken_as_they_are(plan)
    for it in files:
        if it.path not in robots:
            yield it
        elif bringup and it.path not in as_they_are:
            document = read_yaml(it.data, it.path)._replace(file=it.sources[0])
            own = robots[it.path].namespace
            more = {pose.node: dict(pose.values) for pose in poses if pose.robot == own}
            text, findings = for_bringup(document, own, more)
            yield it._replace(data=text.encode())
            yield from findings
        else:
            yield _with_zones(it, robots[it.path], plan.file)
    if bringup:
        yield from _without_rule(plan)


def _with_zones(it: OutputFile, spec: RobotSpec, file: FleetFile) -> OutputFile:
    """Return the file with true or false for zones, as nav2_bringup's launch files fill it."""
    if not any(word.encode() in it.data for word in ZONES):
        return it
    runs = {node.name for node in nodes_of_sets(spec, file)}
    data = it.data
    for word, server in ZONES.items():
        data = data.replace(word.encode(), b"true" if server in runs else b"false")
    return it._replace(data=data)


def _without_rule(plan: FleetPlan) -> Iterator[Finding]:
    """Yield a finding on absolute names of Nav2 that no rule and no parameter changes."""
    first = plan.robots[0].spec.namespace
    started = {
        it.name for node_set in _NODE_SETS for it in load_node_set(node_set, plan.file.distro)
    }
    left = [
        f"{end.name} of {run.node}"
        for run, end, name in plan.fleet.table.ends
        if run.robot == first and run.node in started
        if end.name.startswith("/") and end.name != name and end.name not in _TF
        if not end.parameter and not end.fixed
    ]
    if left:
        message = f"nav2_bringup gives no remap rule for {', '.join(dict.fromkeys(left))}"
        hint = (
            "all robots share them; if you use one, start Nav2 with nav2.launch.py of this package"
        )
        yield NO_RULE.finding(message, hint, file=plan.file.file, line=1)
