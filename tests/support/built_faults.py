# SPDX-License-Identifier: Apache-2.0
"""Seeded faults put into the files of a built fleet, and what its read-back says of them."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from fault_changes import Fault
from fleet_folder import planned_fleet
from paths import ROOT

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.checks.build import Outputs, make_outputs
from multibot_rewrite.checks.read_back import read_back
from multibot_rewrite.fleet.fleet_plan import FleetPlan

LAUNCH, OUT = "fleet.launch.py", "/anywhere/out"
EXAMPLE = ROOT / "examples" / "namespace_and_prefix"
FLEET = f"""\
layout: tf-per-robot
distro: jazzy
description: {EXAMPLE}/hexbase.urdf.xacro
node_sets: [nav2]
robots: [{{name: robot1, pose: {{x: 1}}}}, {{name: robot2, pose: {{x: 2}}}}]
related_files: {{params: {EXAMPLE}/nav2_params.yaml, bridge: {EXAMPLE}/bridge.yaml}}
"""
# A file and its text -> the text with a fault.
Edit = Callable[[str, str], str]


@cache
def fleet() -> tuple[FleetPlan, Outputs]:
    """Two robots with Nav2, as `build` makes them."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "fleet.yaml"
        file.write_text(FLEET)
        plan = planned_fleet(file, around=os.environ, trust=True)
        return plan, make_outputs(plan, OUT)


def read(edit: Edit) -> list[Finding]:
    """Return what is found of the files with a fault in them."""
    plan, made = fleet()
    return read_back(plan, edited(made, edit), OUT)


def edited(made: Outputs, edit: Edit) -> Outputs:
    """Return the outputs of a build with other texts in their files."""
    own = {it.path: it.data.decode() for it in made.files}
    own[LAUNCH] = unrolled(own[LAUNCH])
    texts = {path: edit(path, text) for path, text in own.items()}
    assert texts != own, "nothing was changed"
    files = (it._replace(data=texts[it.path].encode()) for it in made.files)
    return made._replace(files=tuple(files))


_CALL = re.compile(r"^    '(\w+)': partial\((\w+), '\w+'(.*)\),$", re.M)
_TEXT = re.compile(r'"""[\s\S]*?"""|(f?)\'([^\'\n]*)\'|"[^"\n]*"')


def unrolled(text: str) -> str:
    """Return the launch file with a function for each robot: a fault can be put into one alone."""
    calls = [it.groups() for it in _CALL.finditer(text)]
    for title in {it[1] for it in calls}:
        function = re.search(rf"(?ms)^def {title}\(.*?^    \]\n", text)
        assert function
        own = [_for_one(function[0], robot, given) for robot, name, given in calls if name == title]
        text = text.replace(function[0], "\n\n".join(own))
    text = _CALL.sub(r"    '\1': start_\1,", text)
    return _TEXT.sub(_double_quoted, text)


def _double_quoted(it: re.Match[str]) -> str:
    if it[2] is None or '"' in it[2]:
        return it[0]
    return f'{it[1] if "{" in it[2] else ""}"{it[2]}"'


def _for_one(function: str, robot: str, given: str) -> str:
    """Return the function of one robot, with its values."""
    body = function.partition("\n")[2].replace("{name}", robot)
    body = re.sub(r"\bname(?=[,)])", f"'{robot}'", body)
    for key, value in re.findall(r", (\w+)=([^,]+)", given):
        body = body.replace(f"str({key})", f"'{value}'")
        body = re.sub(rf"\b{key},", f"{value},", body)
    return f"def start_{robot}():\n{body}"


@cache
def in_a_build(fault: Fault) -> tuple[str, ...]:
    """Return the codes that the build has for a fault."""
    return tuple(sorted({it.code for it in read(BUILT[fault.name])}))


def in_file(path: str, old: str, new: str) -> Edit:
    """Another word in one file, where it is first."""
    return lambda it, text: text.replace(old, new, 1) if it == path else text


def in_launch(change: Callable[[str], str]) -> Edit:
    return lambda path, text: change(text) if path == LAUNCH else text


def node(robot: str, name: str, change: Callable[[str], str]) -> Edit:
    """Another text of one node of a robot in the launch file."""

    def edit(text: str) -> str:
        robots = re.split(r"(?=^def start_)", text, flags=re.M)
        return "".join(
            _changed(it) if it.startswith(f"def start_{robot}(") else it for it in robots
        )

    def _changed(text: str) -> str:
        blocks = re.split(r"(?=^        Node\($)", text, flags=re.M)
        return "".join(change(it) if f'name="{name}",' in it else it for it in blocks)

    return in_launch(edit)


def rules(*pairs: tuple[str, str]) -> Callable[[str], str]:
    """Return a node with these rules before its own."""
    lines = "".join(f'                ("{old}", "{new}"),\n' for old, new in pairs)

    def change(text: str) -> str:
        if "remappings=[\n" in text:
            return text.replace("remappings=[\n", f"remappings=[\n{lines}", 1)
        return text.replace(
            "            output=", f"            remappings=[\n{lines}],\n            output=", 1
        )

    return change


def without(pattern: str) -> Callable[[str], str]:
    """Return a text without the rules of which a name is like this."""
    return lambda text: re.sub(rf' *\("{pattern}", "[^"]*"\),\n', "", text)


def more(robot: str, words: str) -> Edit:
    """One node more in a robot's part of the launch file."""
    begin = re.compile(rf"(?s)(def start_{robot}\(.*?    return \[\n)")
    return in_launch(lambda text: begin.sub(rf"\1        Node({words}),\n", text, count=1))


def both(*edits: Edit) -> Edit:
    def edit(path: str, text: str) -> str:
        for one in edits:
            text = one(path, text)
        return text

    return edit


def each(name: str, change: Callable[[str], str]) -> Edit:
    return both(node("robot1", name, change), node("robot2", name, change))


TELEOP = 'package="teleop_twist_keyboard", executable="teleop_twist_keyboard"'
STATIC = 'package="tf2_ros", executable="static_transform_publisher", namespace="/robot1", '
BUILT: Mapping[str, Edit] = {
    "nobody passed /tf:=tf: both trees on /tf": in_launch(without(r"(?:\w+:)?/tf(?:_static)?")),
    "one robot_state_publisher lacks /tf:=tf": node(
        "robot2", "robot_state_publisher", without("/tf(?:_static)?")
    ),
    "bt_navigator listens to /tf": node("robot1", "bt_navigator", without("/tf")),
    "robot2's amcl sends tf to robot1": node("robot2", "amcl", rules(("/tf", "/robot1/tf"))),
    "a static map -> odom beside amcl": more(
        "robot1",
        f'{STATIC}name="static_transform_publisher_x", remappings=[("/tf_static", "tf_static")],'
        ' arguments=["--frame-id", "map", "--child-frame-id", "odom"]',
    ),
    "the EKF sends the controller's odometry as well": more(
        "robot1",
        'package="robot_localization", executable="ekf_node", name="ekf_node", namespace="/robot1",'
        ' remappings=[("/tf", "tf"), ("/tf_static", "tf_static")], parameters=[CLOCK,'
        ' {"odom_frame": "odom", "base_link_frame": "base_footprint", "world_frame": "odom"}]',
    ),
    "robot2's teleop drives robot1": more(
        "robot2", f'{TELEOP}, namespace="/robot2", remappings=[("cmd_vel", "/robot1/cmd_vel")]'
    ),
    "both robots obey /goal_pose": each("bt_navigator", rules(("goal_pose", "/goal_pose"))),
    "both amcl take /initialpose": each("amcl", rules(("initialpose", "/initialpose"))),
    "amcl has an absolute scan topic": node("robot2", "amcl", rules(("scan", "/scan"))),
    "stamped velocities on one side": node(
        "robot1",
        "collision_monitor",
        lambda it: it.replace("*params,", '*params, {"enable_stamped_cmd_vel": True},'),
    ),
    "both lidars on /scan": lambda path, text: (
        re.sub(r"/robot\d/scan", "/scan", text) if path.endswith("bridge.yaml") else text
    ),
    "both map servers on /map": both(
        each("map_server", rules(("map", "/map"))), each("amcl", rules(("map", "/map")))
    ),
    "map_server beside SLAM": more(
        "robot1",
        'package="slam_toolbox", executable="async_slam_toolbox_node", name="slam_toolbox",'
        ' namespace="/robot1", parameters=[CLOCK], remappings=[("/tf", "tf"), ("/map", "map")]',
    ),
    "robot2's amcl reads robot1's scan": node("robot2", "amcl", rules(("scan", "/robot1/scan"))),
    "amcl started twice": node("robot1", "amcl", lambda it: it + it),
    "a second lifecycle manager": more(
        "robot1",
        'package="nav2_lifecycle_manager", executable="lifecycle_manager", namespace="/robot1",'
        ' name="lifecycle_manager_2", parameters=[{"node_names": ["amcl"]}, CLOCK]',
    ),
    "a clock bridge for each robot": both(
        *(
            more(
                it,
                f'package="ros_gz_bridge", executable="parameter_bridge", namespace="/{it}",'
                ' arguments=["/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock"]',
            )
            for it in ("robot1", "robot2")
        )
    ),
    "a costmap's relative scan": in_file(
        "robot2/nav2_params.yaml", "topic: /robot2/scan", "topic: scan"
    ),
    "a costmap's source misspelled": in_file(
        "robot2/nav2_params.yaml", "topic: /robot2/scan", "topic: /robot2/scann"
    ),
    "the namespace twice: /robot2/robot2/scan": in_file(
        "robot2/nav2_params.yaml", "scan_topic: scan", "scan_topic: robot2/scan"
    ),
    "the namespace twice in a costmap": in_file(
        "robot2/nav2_params.yaml", "topic: /robot2/scan", "topic: robot2/scan"
    ),
    "a lifecycle manager in the root": node(
        "robot2",
        "lifecycle_manager_navigation",
        lambda it: it.replace('            namespace="/robot2",\n', ""),
    ),
    "amcl is not on simulated time": node(
        "robot1", "amcl", lambda it: it.replace("CLOCK]", 'CLOCK, {"use_sim_time": False}]')
    ),
    "the controller sends past collision_monitor": node(
        "robot2", "controller_server", without("cmd_vel")
    ),
}
