# SPDX-License-Identifier: Apache-2.0
"""Fleet files drawn by chance, as the pages of the keys have them and as a newcomer writes them.

What a draw may hold comes from docs/fleet-file.md and the schema, never from what happens to build.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping
from itertools import combinations
from math import dist
from typing import NamedTuple

from drawn_keys import (
    add_keys,
    has_no_adapter,
    has_no_certificates,
    has_no_such_world,
    in_other_layout,
    in_other_style,
    is_bringup,
    maybe,
    parts,
    shares_no_such_node,
    started_for_each,
)
from drawn_spellings import Data, spelled
from hypothesis import strategies as st
from paths import fixture_text

from multibot_rewrite.base.releases import RELEASES

MASS = (
    '<inertial><mass value="1"/>'
    '<inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>'
)
SHAPE = '<geometry><box size="0.4 0.3 0.2"/></geometry>'
LINK = (
    '<link name="{}">' + MASS + f"<visual>{SHAPE}</visual><collision>{SHAPE}</collision></link>\n"
)


def link(name: str) -> str:
    return LINK.format(name)


def joint(name: str, kind: str, parent: str, child: str) -> str:
    limit = '<limit lower="-1" upper="1" effort="1" velocity="1"/>' if kind == "revolute" else ""
    axis = "" if kind == "fixed" else '<axis xyz="0 1 0"/>'
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f"{axis}{limit}</joint>\n"
    )


BASE = (
    *(link(it) for it in ("base_link", "left_wheel", "right_wheel", "lidar_link")),
    joint("left_wheel_joint", "continuous", "base_link", "left_wheel"),
    joint("right_wheel_joint", "continuous", "base_link", "right_wheel"),
    joint("lidar_joint", "fixed", "base_link", "lidar_link"),
)
GZ_LIDAR = """\
<gazebo reference="lidar_link"><sensor name="lidar" type="gpu_lidar"><topic>scan</topic>
  <gz_frame_id>lidar_link</gz_frame_id><update_rate>10</update_rate></sensor></gazebo>
"""
GZ_DRIVE = """\
<gazebo><plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
  <left_joint>left_wheel_joint</left_joint><right_joint>right_wheel_joint</right_joint>
  <wheel_separation>0.4</wheel_separation><wheel_radius>0.1</wheel_radius>
  <topic>cmd_vel</topic><odom_topic>odom</odom_topic><tf_topic>tf</tf_topic>
  <frame_id>odom</frame_id><child_frame_id>base_link</child_frame_id>
</plugin></gazebo>
"""
CLASSIC_DRIVE = """\
<gazebo><plugin name="drive" filename="libgazebo_ros_diff_drive.so">
  <left_joint>left_wheel_joint</left_joint><right_joint>right_wheel_joint</right_joint>
  <publish_odom>true</publish_odom><publish_odom_tf>true</publish_odom_tf>
  <odometry_frame>odom</odometry_frame><robot_base_frame>base_link</robot_base_frame>
</plugin></gazebo>
"""
BARROW = (
    *(link(it) for it in ("base_link", "wheel")),
    joint("axle", "continuous", "base_link", "wheel"),
)
ARM = (
    *(link(it) for it in ("base_link", "upper_arm", "forearm", "tool")),
    joint("shoulder", "revolute", "base_link", "upper_arm"),
    joint("elbow", "revolute", "upper_arm", "forearm"),
    joint("tool_joint", "fixed", "forearm", "tool"),
)
TOWER = (
    *(link(it) for it in ("tower", "camera_link")),
    joint("pan", "revolute", "tower", "camera_link"),
)
CONTROL = """\
<ros2_control name="arm" type="system">
  <hardware><plugin>HARDWARE</plugin></hardware>
  <joint name="shoulder"><command_interface name="position"/><state_interface name="position"/></joint>
  <joint name="elbow"><command_interface name="position"/><state_interface name="position"/></joint>
</ros2_control>
"""
GZ_CONTROL = """\
<gazebo><plugin filename="gz_ros2_control-system" name="gz_ros2_control::GazeboSimROS2ControlPlugin">
  <parameters>controllers.yaml</parameters></plugin></gazebo>
"""
SDF_LINK = (
    '<link name="{0}"><inertial><mass>1</mass></inertial><collision name="{0}_box"><geometry>'
    "<box><size>0.4 0.3 0.2</size></box></geometry></collision>{1}</link>\n"
)
SDF_JOINT = (
    '<joint name="{}_joint" type="{}"><parent>base_link</parent><child>{}</child>{}</joint>\n'
)
SDF_AXIS = "<axis><xyz>0 1 0</xyz></axis>"
SDF = (
    *(SDF_LINK.format(it, "") for it in ("base_link", "left_wheel", "right_wheel")),
    SDF_LINK.format("lidar_link", GZ_LIDAR.partition(">")[2].rpartition("</gazebo>")[0]),
    *(SDF_JOINT.format(it, "revolute", it, SDF_AXIS) for it in ("left_wheel", "right_wheel")),
    SDF_JOINT.format("lidar", "fixed", "lidar_link", ""),
    GZ_DRIVE.removeprefix("<gazebo>").replace("</gazebo>", ""),
)
XACRO_HEAD = """\
  <xacro:arg name="mast" default="low"/><xacro:arg name="prefix" default=""/>
  <xacro:property name="p" value="$(arg prefix)"/>
"""


def _robot(name: str, *parts: str, xacro: bool = False) -> str:
    space = ' xmlns:xacro="http://www.ros.org/wiki/xacro"' if xacro else ""
    return f'<robot name="{name}"{space}>\n{"".join(parts)}</robot>\n'


def _model(*parts: str) -> str:
    return f'<sdf version="1.9"><model name="ROBOT">\n{"".join(parts)}</model></sdf>\n'


def _with_argument(text: str) -> str:
    """Return a rover whose mast is chosen by an argument, and whose links an argument prefixes."""
    head, _, body = text.partition("\n")
    for it in ("base_link", "left_wheel", "right_wheel", "lidar_link", "lidar_joint"):
        body = body.replace(f'"{it}"', f'"${{p}}{it}"').replace(f">{it}<", f">${{p}}{it}<")
    body = body.replace('"left_wheel_joint"', '"${p}left_wheel_joint"')
    body = body.replace('"right_wheel_joint"', '"${p}right_wheel_joint"')
    body = body.replace(">left_wheel_joint<", ">${p}left_wheel_joint<")
    body = body.replace(">right_wheel_joint<", ">${p}right_wheel_joint<")
    tail = (
        '<link name="${p}$(arg mast)_mast"/>'
        '<joint name="${p}mast_joint" type="fixed"><parent link="${p}base_link"/>'
        '<child link="${p}$(arg mast)_mast"/></joint>\n</robot>'
    )
    return f"{head}\n{XACRO_HEAD}{body.replace('</robot>', tail)}"


def _joined(text: str, *parts: str) -> str:
    """Return a robot with another one on it, whose names begin with up_."""
    other = re.sub(r'(?:name|link)="(?=\w)', r"\g<0>up_", "".join(parts))
    return text.replace("</robot>", f"{other}</robot>")


MOBILE, MANIPULATOR = "mobile", "arm"
GZ, CLASSIC, NONE = "gz", "classic", ""


class Kind(NamedTuple):
    """A sort of robot: its description (a robot element called ROBOT) with the ending of its file, what
    it is, the simulator that its plugins are for, and the releases that have these."""

    text: str
    ending: str
    what: str
    simulator: str
    releases: tuple[str, ...] = RELEASES


KINDS = {
    "gz rover": Kind(_robot("ROBOT", *BASE, GZ_LIDAR, GZ_DRIVE), ".urdf", MOBILE, GZ),
    "plain cart": Kind(_robot("ROBOT", *BASE), ".urdf", MOBILE, NONE),
    # Behind arm_left its wheel is called as the left one of others is behind arm.
    "tower": Kind(_robot("ROBOT", *TOWER), ".urdf", MOBILE, NONE),
    "barrow": Kind(
        _robot("ROBOT", *BARROW),
        ".urdf", MOBILE, NONE,
    ),
    "sdf rover": Kind(_model(*SDF), ".sdf", MOBILE, GZ),
    "xacro rover": Kind(
        _with_argument(_robot("ROBOT", *BASE, GZ_LIDAR, GZ_DRIVE, xacro=True)),
        ".urdf.xacro", MOBILE, GZ,
    ),
    "classic rover": Kind(
        _robot("ROBOT", *BASE, CLASSIC_DRIVE), ".urdf", MOBILE, CLASSIC, ("humble",)
    ),
    "arm": Kind(
        _robot("ROBOT", *ARM, CONTROL.replace("HARDWARE", "mock_components/GenericSystem")),
        ".urdf", MANIPULATOR, NONE,
    ),
    "joined cart": Kind(_joined(_robot("ROBOT", *BASE), *BARROW), "", MOBILE, NONE),
    "joined rover": Kind(_joined(_robot("ROBOT", *BASE, GZ_LIDAR, GZ_DRIVE), *TOWER), "", MOBILE, GZ),
    "gz arm": Kind(
        _robot(
            "ROBOT", *ARM, CONTROL.replace("HARDWARE", "gz_ros2_control/GazeboSimSystem"), GZ_CONTROL
        ),
        ".urdf", MANIPULATOR, GZ, RELEASES[1:],
    ),
}  # fmt: skip
# The kinds with nodes of ROS in the process of the simulator.
IN_SIMULATOR = ("gz arm", "classic rover")
# The robots that these are joined of.
JOINED = {"joined cart": ("plain cart", "barrow"), "joined rover": ("gz rover", "tower")}
SRDF = """\
<robot name="ROBOT"><group name="arm"><joint name="shoulder"/><joint name="elbow"/></group></robot>
"""
NAV_PARAMS = """\
amcl:
  ros__parameters:
    base_frame_id: base_link  # its base
    odom_frame_id: odom
    scan_topic: scan
"""
CONTROLLERS = fixture_text("drawn_fleets_controllers.yaml")
MOVEIT = {
    "kinematics": """\
arm:
  kinematics_solver: kdl_kinematics_plugin/KDLKinematicsPlugin
  kinematics_solver_timeout: 0.05
""",
    "joint_limits": """\
joint_limits:
  shoulder: {has_acceleration_limits: true, max_acceleration: 2.0}
""",
    "moveit_controllers": """\
moveit_controller_manager: moveit_simple_controller_manager/MoveItSimpleControllerManager
moveit_simple_controller_manager:
  controller_names: [arm_controller]
  arm_controller:
    type: FollowJointTrajectory
    action_ns: follow_joint_trajectory
    default: true
    joints: [shoulder, elbow]
""",
}
BRIDGE = """\
- {ros_topic_name: scan, gz_topic_name: scan, ros_type_name: sensor_msgs/msg/LaserScan,
   gz_type_name: gz.msgs.LaserScan, direction: GZ_TO_ROS}
- {ros_topic_name: cmd_vel, gz_topic_name: cmd_vel, ros_type_name: geometry_msgs/msg/Twist,
   gz_type_name: gz.msgs.Twist, direction: ROS_TO_GZ}
"""
RVIZ = """\
Visualization Manager:
  Class: ""
  Displays:
    - {Class: rviz_default_plugins/LaserScan, Name: scan, Topic: {Value: /scan}}
    - {Class: rviz_default_plugins/TF, Name: TF}
  Global Options:
    Fixed Frame: map
"""

# Robots are called as one likes: like each other's parts, their files, frames, topics, words of YAML,
# Python or this package.
NAMES = (
    *(
        "r1",
        "r2",
        "robot1",
        "robot2",
        "robot10",
        "r",
        "r1_a",
        "r1_b",
        "a",
        "robot",
        "rover",
        "scout",
    ),
    *(
        "burger",
        "waffle",
        "arm",
        "left",
        "right",
        "left_arm",
        "arm_left",
        "map",
        "base_link",
        "scan",
        "gz",
    ),
    *("name", "odom", "tf", "cmd_vel", "lidar_link", "clock", "bridge", "rviz", "launch", "world"),
    *("start", "sim", "params", "plan", "no", "null", "true", "off", "file", "model", "Robot1"),
    *("base", "wheel", "joint", "link", "shared_nodes", "site", "self", "None", "partial"),
)
# Of these layouts docs/nav2.md has a way to show all robots in one RViz.
RELAYED = ("both", "postfix", "tf-per-robot")
STEMS = ("robot", "r", "arm", "robot_", "scan", "base_link")
LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix", "frame-prefix")
NODE_SETS = {
    MOBILE: (
        *([], ["nav2"], ["localization"], ["slam_toolbox"], ["nav2_slam"], ["robot_localization"]),
        *(["teleop"], ["nav2_composed"], ["navigation"], ["localization", "teleop"]),
    ),
    MANIPULATOR: ([], ["ros2_control"], ["ros2_control", "moveit"], ["moveit"]),
}
OWN = ("namespace", "tag", "model")


class DrawnFleet(NamedTuple):
    """What a fleet file says, each robot with its keys; the files that it names; the kind of each of
    its robots; and the fleet files as they are written, by path, if not as ``data`` is."""

    data: Data
    files: Mapping[str, str]
    kinds: tuple[str, ...]
    written: Mapping[str, Data] = {}


# ---------------------------------------------------------------- fleets that build


@st.composite
def fleets(draw: st.DrawFn) -> DrawnFleet:
    """Return a fleet that its pages allow, but for what chance brings together."""
    is_cell = maybe(draw, 1)
    release = draw(st.sampled_from(RELEASES))
    layout = "frames-per-robot" if is_cell else draw(st.sampled_from(LAYOUTS))
    at_run_time = layout == "frame-prefix"
    side = "prefix" if at_run_time else draw(st.sampled_from(("prefix", "postfix")))
    data: Data = {"layout": layout, "distro": release, "affix": side}
    if maybe(draw, 2) and not at_run_time:
        data["separators"] = {"link": draw(st.sampled_from(("_", "-")))}
    if maybe(draw, 2):
        data["simulator"] = draw(st.sampled_from(("none", "gazebo")))
    data |= {key: True for key in ("sros2", "fill_arguments") if maybe(draw, 1)}
    if maybe(draw, 1):
        data["use_sim_time"] = draw(st.booleans())
    if maybe(draw, 1) and layout in RELAYED:
        data["relayed"] = True
    if maybe(draw, 1):
        data["zenoh"] = {"router": "tcp/10.0.0.1:7447"}
    numbered = draw(st.sampled_from(STEMS)) if maybe(draw, 2) else ""
    names = draw(st.lists(st.sampled_from(NAMES), min_size=2, max_size=4, unique=True))
    names = [f"{numbered}{at + 1}" for at, _ in enumerate(names)] if numbered else names
    known = _kinds(draw, release, data.get("simulator", ""))
    kinds = [draw(st.sampled_from(known))] * len(names)
    if is_cell:
        kinds = ["arm"] * len(names)
    elif draw(st.booleans()) and not numbered:
        kinds = [draw(st.sampled_from(known)) for _ in names]
    making = _Making(draw, data, {}, {})
    own = draw(
        st.sampled_from(((), ("tag",), ("namespace",), ("model",), OWN) if not numbered else ((),))
    )
    words = {key: _own_words(draw, key, names, layout) for key in own}
    posed = maybe(draw, 8) or is_cell
    data["robots"] = [
        _robot_row(making, name, kinds[at], {key: it[at] for key, it in words.items()})
        | ({"pose": _pose(draw, at)} if posed else {})
        for at, name in enumerate(names)
    ]
    if is_cell:
        _make_cell(making)
    if numbered:
        data["robots"] = [*_alike(draw, data["robots"][0], names)]
    if maybe(draw, 1) and {*kinds}.isdisjoint(IN_SIMULATOR):
        data["domains"] = {name: 11 + at for at, name in enumerate(names)}
        data |= {"crossing": ["robot_description"]} if draw(st.booleans()) else {}
    add_keys(draw, data, making.files)
    return DrawnFleet(data, making.files, tuple(kinds), spelled(draw, data))


def _make_cell(making: _Making) -> None:
    """Let one move_group plan for all robots, which are arms."""
    draw, data = making.draw, making.data
    data |= {"cell": {"name": "workcell"} if maybe(draw) else {}}
    groups = []
    for row in data["robots"]:
        row["node_sets"] = draw(st.sampled_from((["moveit"], ["ros2_control", "moveit"])))
        row["srdf"] = _written(making, "arm", ".srdf", SRDF.replace("ROBOT", "arm"), row["name"])
        tag = row.get(data["affix"], row["name"])
        groups.append(f"{tag}_arm" if data["affix"] == "prefix" else f"arm_{tag}")
    if draw(st.booleans()):
        data["cell"]["groups"] = {"all_arms": groups}


def _alike(draw: st.DrawFn, row: Data, names: list[str]) -> Iterator[Data]:
    """Robots that have what the first has, but for their names and places."""
    step = draw(st.sampled_from(({"x": 3}, {"y": -2.5}, {"x": 1.5, "yaw": 0.5})))
    first = row.get("pose", {})
    for at, name in enumerate(names):
        pose = {key: first.get(key, 0) + at * step.get(key, 0) for key in {**first, **step}}
        yield {**row, "name": name} | ({"pose": pose} if first else {})


class _Making(NamedTuple):
    """A fleet that is made; ``shared`` is what robots of one sort have from the first of them."""

    draw: st.DrawFn
    data: Data
    files: dict[str, str]
    shared: Data


def _kinds(draw: st.DrawFn, release: str, simulator: str) -> list[str]:
    """Return the kinds of one simulator; a simulator's hardware is on no real robot."""
    left = GZ if maybe(draw, 2) else CLASSIC
    known = [
        it for it, kind in KINDS.items() if kind.simulator != left and release in kind.releases
    ]
    return [it for it in known if it != "gz arm" or simulator != "none"]


def _own_words(draw: st.DrawFn, key: str, names: list[str], layout: str) -> list[str]:
    """Return a word for each robot: of its own, with its name in it, or another robot's name."""
    if maybe(draw, 2):
        return [*names[1:], names[0]]
    forms = ["{}_x", "x_{}", "w{at}", "{}{at}"]
    forms += ["site/{}", "/fleet/site{at}/{}"] if key == "namespace" and layout != "postfix" else []
    forms += ["{}-1", "{}.m", "m/{}", "{}_red"] if key == "model" else []
    texts = [draw(st.sampled_from(forms)).format(it, at=at) for at, it in enumerate(names)]
    return texts if len({*texts}) == len(texts) else names


def _robot_row(making: _Making, name: str, kind: str, words: Mapping[str, str]) -> Data:
    draw, data, _, shared = making
    its = KINDS[kind]
    row: Data = {"name": name}
    row |= {data["affix"] if key == "tag" else key: word for key, word in words.items()}
    row |= _described(making, kind, name)
    if kind == "gz rover" and maybe(draw, 1):
        model = KINDS["sdf rover"].text.replace("ROBOT", "rover")
        row["simulated"] = _written(making, "model", ".sdf", model, name)
    if its.ending.endswith("xacro") and draw(st.booleans()):
        row["arguments"] = {"mast": draw(st.sampled_from(("low", "high")))}
    if maybe(draw, 2):
        row["colour"] = draw(st.sampled_from(("red", "#00ff00", [0, 170, 255])))
    if maybe(draw, 1) and kind != "gz arm":
        row["simulator"] = draw(st.sampled_from(("none", "gazebo")))
    node_sets = [
        it for it in NODE_SETS[its.what] if data["layout"] != "frame-prefix" or "moveit" not in it
    ]
    for key, made in (
        ("node_sets", lambda: draw(st.sampled_from(node_sets))),
        ("related_files", lambda: _related_files(making, kind, name)),
    ):
        value = made() if (key, kind) not in shared or maybe(draw, 2) else shared[key, kind]
        shared.setdefault((key, kind), value)
        row |= {key: value} if value else {}
    if "moveit" in row.get("node_sets", ()):
        row["srdf"] = _written(making, "arm", ".srdf", SRDF.replace("ROBOT", "arm"), name)
    return row


def _described(making: _Making, kind: str, name: str) -> Data:
    """Return what a robot is described by: a file, or the parts that it is joined of."""
    if kind not in JOINED:
        return {"description": _description(making, kind, name)}
    base, other = (_description(making, it, name) for it in JOINED[kind])
    at = making.draw(st.sampled_from(("base_link", "lidar_link")))
    return {"join": parts(base, other, at, making.draw)}


def _description(making: _Making, kind: str, name: str) -> str:
    """Return the path of a description: called by its kind, like its robot, or like all others."""
    draw, its, stem = making.draw, KINDS[kind], kind.replace(" ", "_")
    path = draw(st.sampled_from((stem, stem, name, f"{name}_description/robot", f"urdf/{stem}")))
    title = draw(st.sampled_from((stem, name, "robot"))).replace("world", "rover")
    # A file that is there already is the first robot's.
    path = (
        f"{path}{its.ending}"
        if f"{path}{its.ending}" not in making.files
        else f"{stem}{its.ending}"
    )
    making.files.setdefault(path, its.text.replace("ROBOT", title))
    if "controllers.yaml" in its.text:
        making.files[os.path.join(os.path.dirname(path), "controllers.yaml")] = CONTROLLERS
    return path


def _written(making: _Making, stem: str, ending: str, text: str, name: str) -> str:
    paths = (stem, name, f"config/{stem}", f"my_{name}", f"{name}/{stem}", f"{stem}_{name}")
    path = f"{making.draw(st.sampled_from(paths))}{ending}"
    if making.files.setdefault(path, text) != text:
        path = f"{stem}_of_{name}{ending}"
        making.files[path] = text
    return path


def _related_files(making: _Making, kind: str, name: str) -> Data:
    draw, what = making.draw, KINDS[kind].what
    found: Data = {}
    if draw(st.booleans()) and kind != "gz arm":
        text = NAV_PARAMS if what == MOBILE else CONTROLLERS
        found["params"] = [_written(making, f"{what}_params", ".yaml", text, name)]
    if maybe(draw, 2) and what == MOBILE:
        given = {"amcl": {"base_frame_id": "base_link", "scan_topic": "scan"}}
        found["params"] = [*found.get("params", ()), given]
    if what == MANIPULATOR and draw(st.booleans()):
        found["moveit"] = [_written(making, it, ".yaml", text, name) for it, text in MOVEIT.items()]
    if kind == "gz rover" and maybe(draw, 2):
        found["bridge"] = [_written(making, "bridge", ".yaml", BRIDGE, name)]
    if maybe(draw, 2):
        found["rviz"] = _written(making, "one", ".rviz", RVIZ, name)
    return found


def _pose(draw: st.DrawFn, at: int) -> Data:
    pose: Data = {"x": 3 * at + draw(st.sampled_from((0, 0.0, 0.5, 1e-05)))}
    pose |= {"y": draw(st.sampled_from((-1, 0.25, 10)))} if maybe(draw) else {}
    pose |= (
        draw(st.sampled_from(({"z": 0.05}, {"roll": 0.1, "pitch": -0.2}))) if maybe(draw, 1) else {}
    )
    return pose | ({"yaw": draw(st.sampled_from((1.57, -3.14, 0)))} if maybe(draw) else {})


# ---------------------------------------------------------------- causes of errors


def rows(fleet: DrawnFleet) -> Iterator[tuple[Data, str, str]]:
    """Each robot with its kind, and what ``simulator`` says of it."""
    for row, kind in zip(fleet.data["robots"], fleet.kinds, strict=True):
        yield row, kind, row.get("simulator", fleet.data.get("simulator", ""))


def simulated(fleet: DrawnFleet) -> list[tuple[Data, str]]:
    """Return the robots that are simulated: hardware of ros2_control alone is a real robot's."""
    return [(row, kind) for row, kind, it in rows(fleet) if it != "none" and (kind != "arm" or it)]


def _share_a_word(fleet: DrawnFleet) -> bool:
    side = fleet.data["affix"]
    every = [
        [row["name"] for row in fleet.data["robots"]],
        *([row.get(key, row["name"]).strip("/") for row in fleet.data["robots"]]
          for key in ("namespace", side, "model")),
        [str(sorted(row["pose"].items())) for row in fleet.data["robots"] if "pose" in row],
    ]  # fmt: skip
    return any(len({*own}) < len(own) for own in every)


def _stand_in_each_other(fleet: DrawnFleet) -> bool:
    """Return whether robots overlap: boxes of half a metre; robots all at the origin do not count."""
    poses = [row.get("pose", {}) for row, _ in simulated(fleet)]
    places = [tuple(it.get(axis, 0) for axis in "xyz") for it in poses]
    moved = any(any(it) for it in places)
    return moved and any(dist(*pair) < 0.2 for pair in combinations(places, 2))


def _missing(fleet: DrawnFleet) -> bool:
    return any(it not in fleet.files for row in fleet.data["robots"] for it in described_by(row))


def described_by(row: Data) -> list[str]:
    """Return the files that a robot is described by."""
    own = [row["description"]] if "description" in row else []
    return [*own, *(it["description"] for it in row.get("join", ()))]


def _links(fleet: DrawnFleet) -> list[set[str]]:
    """Return the links of each robot, as they are called in the whole fleet."""
    data, found = fleet.data, []
    between = data.get("separators", {}).get("link", "/")
    for row, kind, _ in rows(fleet):
        own = re.findall(r'<link name="(\w+)"', KINDS[kind].text.replace("${p}", ""))
        tag = row.get(data["affix"], row["name"])
        is_first = data["affix"] == "prefix"
        found.append({f"{tag}{between}{it}" if is_first else f"{it}{between}{tag}" for it in own})
    return found


def _meet(fleet: DrawnFleet) -> bool:
    """Two robots have a frame of one name, where all frames are in one tree or renamed."""
    is_alone = fleet.data["layout"] == "tf-per-robot"
    return not is_alone and any(one & other for one, other in combinations(_links(fleet), 2))


class Cause(NamedTuple):
    """A reason for an error in the input: how it is put into a fleet, and whether a fleet has it."""

    put: Callable[[Data, DrawnFleet], object]
    holds: Callable[[DrawnFleet], bool]


def _first(data: Data) -> Data:
    row: Data = data["robots"][0]
    return row


def _with(key: str, value: object) -> Callable[[Data, DrawnFleet], object]:
    return lambda data, _: _first(data).update({key: value})


def _same(key: str) -> Callable[[Data, DrawnFleet], object]:
    """Return the cause by which the first two robots get one value."""

    def put(data: Data, fleet: DrawnFleet) -> None:
        name = data["affix"] if key == "tag" else key
        for row in data["robots"][:2]:
            row[name] = {"x": 7} if key == "pose" else "same"

    return put


def _part_somewhere_else(data: Data) -> None:
    row = _first(data)
    row.pop("description", None)
    row.pop("simulated", None)
    row.pop("arguments", None)
    at = {"parent": "nosuch_link"}
    row["join"] = [
        {"description": "plain_cart.urdf"},
        {"description": "barrow.urdf", "prefix": "p_", "at": at},
    ]


def _keep_groups(data: Data) -> None:
    for key in ("domains", "crossing", "relayed", "shape", "params_style"):
        data.pop(key, None)
    data |= {"layout": "frames-per-robot", "cell": {}, "groups": "keep"}
    for at, row in enumerate(data["robots"]):
        row |= {
            "description": "arm.urdf",
            "srdf": "arm.srdf",
            "node_sets": ["moveit"],
            "pose": {"x": at},
        }


# Causes that are in keys of the fleet file alone.
FLEET_CAUSES: dict[str, tuple[Callable[[Data], object], Callable[[Data], bool]]] = {
    "poses in no shared frame": (lambda data: data.update(world="nosuch_frame"), has_no_such_world),
    "a shared node that no robot has": (
        lambda data: data.update(shared_nodes=["nosuch"]),
        shares_no_such_node,
    ),
    "a shared node that nav2_bringup starts for each": (
        lambda data: (
            data.update(layout="both", params_style="bringup", shared_nodes=["map_server"]),
            data.pop("shape", None),
            _first(data).update(node_sets=["nav2"]),
        ),
        started_for_each,
    ),
    "a vendor that starts another layout": (
        lambda data: data.update(
            layout="frames-per-robot",
            **{"shape": "nav2"} if "shape" in data else {"params_style": "bringup"},
        ),
        in_other_layout,
    ),
    "a vendor that takes another style": (
        lambda data: data.update(layout="tf-per-robot", shape="nav2", params_style="full"),
        in_other_style,
    ),
    "an adapter that finds no robot": (
        lambda data: (
            data.update(free_fleet={"router": "tcp/10.0.0.1:7447", "map": "L1"}),
            _first(data).pop("node_sets", None),
        ),
        has_no_adapter,
    ),
    "groups of one name in a cell": (
        _keep_groups,
        lambda data: "cell" in data and data.get("groups") == "keep",
    ),
    "a cell of arms that have no SRDF": (
        lambda data: (
            data.update(layout="frames-per-robot", cell={}),
            _first(data).pop("srdf", None),
        ),
        lambda data: (
            "cell" in data and any("srdf" not in {**data, **row} for row in data["robots"])
        ),
    ),
    "operators without a keystore": (
        lambda data: data.update(zenoh={"router": "tcp/10.0.0.1:7447", "operators": ["/boss"]}),
        has_no_certificates,
    ),
    "a description and parts": (
        lambda data: _first(data).update(
            description="plain_cart.urdf",
            join=[
                {"description": "plain_cart.urdf", "name": "both"},
                {"description": "barrow.urdf", "prefix": "p_", "at": {"parent": "base_link"}},
            ],
        ),
        lambda data: any("join" in row and "description" in row for row in data["robots"]),
    ),
    "a part that is fixed to no link": (
        _part_somewhere_else,
        lambda data: any(
            it.get("at", {}).get("parent") == "nosuch_link"
            for row in data["robots"]
            for it in row.get("join", ())
        ),
    ),
}
CAUSES = {
    "robots share a name": Cause(_same("name"), _share_a_word),
    "robots share a namespace": Cause(_same("namespace"), _share_a_word),
    "robots share a prefix or postfix": Cause(_same("tag"), _share_a_word),
    "robots share a model": Cause(_same("model"), _share_a_word),
    "robots share a pose": Cause(_same("pose"), _share_a_word),
    "names meet: arm and left_wheel, arm_left and wheel": Cause(
        lambda data, _: (
            data.update(layout="both", affix="prefix", separators={"link": "_"}),
            [row.pop("postfix", None) for row in data["robots"]],
            data["robots"][0].update(name="arm", prefix="arm", description="plain_cart.urdf"),
            data["robots"][1].update(name="arm_left", prefix="arm_left", description="barrow.urdf"),
        ),
        _meet,
    ),
    "a word for the other side": Cause(
        lambda data, _: _first(data).update(
            {"postfix" if data["affix"] == "prefix" else "prefix": "other"}
        ),
        lambda fleet: any(
            ("postfix" if fleet.data["affix"] == "prefix" else "prefix") in row
            for row in fleet.data["robots"]
        ),
    ),
    "levels where names get no namespace": Cause(
        lambda data, _: (data.update(layout="postfix"), _first(data).update(namespace="a/b")),
        lambda fleet: (
            fleet.data["layout"] == "postfix"
            and any("/" in row.get("namespace", "").strip("/") for row in fleet.data["robots"])
        ),
    ),
    "a postfix at run time": Cause(
        lambda data, _: data.update(layout="frame-prefix", affix="postfix"),
        lambda fleet: (fleet.data["layout"], fleet.data["affix"]) == ("frame-prefix", "postfix"),
    ),
    "a file that is not there": Cause(_with("description", "nosuch.urdf"), _missing),
    "an unknown key": Cause(
        _with("nmae", "x"), lambda fleet: any("nmae" in it for it in fleet.data["robots"])
    ),
    "an unknown node set": Cause(
        _with("node_sets", ["nav3"]),
        lambda fleet: any("nav3" in it.get("node_sets", ()) for it in fleet.data["robots"]),
    ),
    "arguments without a xacro": Cause(
        _with("arguments", {"mast": "low"}),
        lambda fleet: any(
            "arguments" in row and kind != "xacro rover" for row, kind, _ in rows(fleet)
        ),
    ),
    **{
        name: Cause(lambda data, _, put=put: put(data), lambda fleet, it=holds: it(fleet.data))
        for name, (put, holds) in FLEET_CAUSES.items()
    },
    # A namespace of its own has them not, and its name is in no name of ROS then.
    "two underscores": Cause(
        lambda data, _: (_first(data).update(name="r__1"), _first(data).pop("namespace", None)),
        lambda fleet: any(
            "__" in row.get("namespace", row["name"]) for row in fleet.data["robots"]
        ),
    ),
    "a step without a count": Cause(
        _with("step", {"x": 1}), lambda fleet: any("step" in row for row in fleet.data["robots"])
    ),
    "a robot without its domain": Cause(
        lambda data, _: data.update(domains={data["robots"][0]["name"]: 5}),
        lambda fleet: any(
            row["name"] not in fleet.data.get("domains", {row["name"]: 0})
            for row in fleet.data["robots"]
        ),
    ),
    "a topic that no robot has crosses": Cause(
        lambda data, _: data.update(
            domains={row["name"]: at for at, row in enumerate(data["robots"])}, crossing=["nosuch"]
        ),
        lambda fleet: "nosuch" in fleet.data.get("crossing", ()),
    ),
    "robots stand in each other": Cause(
        lambda data, _: [
            row.update(pose={"x": 5 + at / 100}, simulator="gazebo")
            for at, row in enumerate(data["robots"])
        ],
        _stand_in_each_other,
    ),
    "MoveIt where links get their prefix at run time": Cause(
        lambda data, fleet: (
            data.update(layout="frame-prefix", affix="prefix"),
            data.pop("separators", None),
            [row.pop("postfix", None) for row in data["robots"]],
            _first(data).update(node_sets=["moveit"], description="arm.urdf", srdf="arm.srdf"),
        ),
        lambda fleet: (
            fleet.data["layout"] == "frame-prefix"
            and any("moveit" in row.get("node_sets", ()) for row in fleet.data["robots"])
        ),
    ),
    "hardware of a simulator on a real robot": Cause(
        lambda data, _: _first(data).update(
            description="gz_arm.urdf", simulator="none", node_sets=["ros2_control"]
        ),
        lambda fleet: any(
            (kind, it) == ("gz arm", "none") and "ros2_control" in row.get("node_sets", ())
            for row, kind, it in rows(fleet)
        ),
    ),
    "two simulators": Cause(
        lambda data, _: (
            data.update(distro="humble", simulator="gazebo"),
            [row.pop("simulator", None) for row in data["robots"]],
            data["robots"][0].update(description="classic_rover.urdf"),
            data["robots"][1].update(description="gz_rover.urdf"),
        ),
        lambda fleet: {CLASSIC, GZ} <= {KINDS[kind].simulator for _, kind in simulated(fleet)},
    ),
    "a description called world": Cause(
        lambda data, _: (
            data.update(layout="tf-per-robot"),
            _first(data).update(description="world.urdf", simulator="gazebo"),
        ),
        lambda fleet: (
            fleet.data["layout"] in ("tf-per-robot", "frame-prefix")
            and any(
                '<robot name="world"' in fleet.files.get(path, "")
                for row, _ in simulated(fleet)
                for path in described_by(row)
            )
        ),
    ),
    # A start pose is given to no robot that maps: slam_toolbox says where it is. nav2_bringup takes one
    # file of a robot, which has the pose as well: no other is written.
    "a parameter file is called as one that is written": Cause(
        lambda data, _: _first(data).update(
            related_files={"params": ["start_pose.yaml"]}, pose={"x": -9}
        ),
        lambda fleet: any(
            "pose" in row
            and "start_pose.yaml" in row.get("related_files", {}).get("params", ())
            and {"slam_toolbox", "nav2_slam"}.isdisjoint(row.get("node_sets", ()))
            and not is_bringup(fleet.data)
            for row in fleet.data["robots"]
        ),
    ),
    "simulated time without a simulator": Cause(
        lambda data, _: (
            data.update(use_sim_time=True, simulator="none"),
            [row.pop("simulator", None) for row in data["robots"]],
        ),
        lambda fleet: fleet.data.get("use_sim_time") is True and not simulated(fleet),
    ),
    # Its controller manager reads the simulator's clock, whatever the file says. The drive of Classic
    # reads none, and no node of ROS sends one there.
    "the machine's time beside the simulator's": Cause(
        lambda data, _: (
            data.update(use_sim_time=False),
            _first(data).update(description="gz_arm.urdf", simulator="gazebo"),
        ),
        lambda fleet: (
            fleet.data.get("use_sim_time") is False
            and any(kind == "gz arm" for _, kind in simulated(fleet))
        ),
    ),
    "a node in the simulator has another domain": Cause(
        lambda data, _: (
            data.update(domains={row["name"]: 7 + at for at, row in enumerate(data["robots"])}),
            _first(data).update(description="gz_arm.urdf", simulator="gazebo"),
        ),
        lambda fleet: (
            "domains" in fleet.data and any(kind in IN_SIMULATOR for _, kind in simulated(fleet))
        ),
    ),
}


@st.composite
def faulty(draw: st.DrawFn, cause: str) -> DrawnFleet:
    """Return a fleet with a cause put into it."""
    fleet = draw(fleets())
    data: Data = {**fleet.data, "robots": [dict(row) for row in fleet.data["robots"]]}
    CAUSES[cause].put(data, fleet)
    made = with_kinds(fleet, data)
    return made._replace(written=spelled(draw, data))


def with_kinds(fleet: DrawnFleet, data: Data) -> DrawnFleet:
    """Return the fleet with the files that a cause has named, and the kinds that robots then are of."""
    named = {f"{kind.replace(' ', '_')}{it.ending}": kind for kind, it in KINDS.items()}
    named["world.urdf"] = "gz rover"
    files, kinds = {**fleet.files}, []
    for row, before, kind in zip(data["robots"], fleet.data["robots"], fleet.kinds, strict=True):
        path, old = row.get("description"), before.get("description")
        # A cause that names a description has no parts in mind.
        if path and path != old and "both" not in row.get("join", [{}])[0].get("name", ""):
            row.pop("join", None)
        kinds.append(named.get(path, kind) if path != old else kind)
        if path != old and path in named:
            files[path] = KINDS[named[path]].text.replace("ROBOT", path.partition(".")[0])
            row.pop("arguments", None)
    plain = {f"{it.replace(' ', '_')}.urdf": KINDS[it].text for it in ("plain cart", "barrow")}
    files |= {path: text.replace("ROBOT", "r") for path, text in plain.items() if path not in files}
    files |= {"controllers.yaml": CONTROLLERS, "arm.srdf": SRDF.replace("ROBOT", "arm")}
    files |= {"start_pose.yaml": NAV_PARAMS}
    return DrawnFleet(data, files, tuple(kinds))


def causes_of(fleet: DrawnFleet) -> list[str]:
    """Return the causes that a fleet has."""
    return [name for name, it in CAUSES.items() if it.holds(fleet)]


# One of eight has a cause put into it.
drawn = st.integers(0, 7).flatmap(
    lambda it: st.sampled_from(sorted(CAUSES)).flatmap(faulty) if it == 7 else fleets()
)
