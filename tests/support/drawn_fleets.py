# SPDX-License-Identifier: Apache-2.0
"""Fleet files drawn by chance, as the pages of the keys have them and as a newcomer writes them.

What a draw may hold comes from docs/fleet-file.md and the schema, never from what happens to build.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from hypothesis import strategies as st

from multibot_rewrite.base.releases import RELEASES

Data = dict[str, Any]

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
ARM = (
    *(link(it) for it in ("base_link", "upper_arm", "forearm", "tool")),
    joint("shoulder", "revolute", "base_link", "upper_arm"),
    joint("elbow", "revolute", "upper_arm", "forearm"),
    joint("tool_joint", "fixed", "forearm", "tool"),
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
XACRO_HEAD = """\
  <xacro:arg name="mast" default="low"/><xacro:arg name="prefix" default=""/>
  <xacro:property name="p" value="$(arg prefix)"/>
"""


def _robot(name: str, *parts: str, xacro: bool = False) -> str:
    space = ' xmlns:xacro="http://www.ros.org/wiki/xacro"' if xacro else ""
    return f'<robot name="{name}"{space}>\n{"".join(parts)}</robot>\n'


def _with_argument(text: str) -> str:
    """A rover whose mast is chosen by an argument, and whose links an argument prefixes."""
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


MOBILE, MANIPULATOR = "mobile", "arm"


class Kind(NamedTuple):
    """A sort of robot: the text of its description for a robot element called so, its ending, what it
    is, and the releases that have its plugins."""

    text: str
    ending: str
    what: str
    releases: tuple[str, ...] = RELEASES


KINDS = {
    "gz rover": Kind(_robot("ROBOT", *BASE, GZ_LIDAR, GZ_DRIVE), ".urdf", MOBILE),
    "plain cart": Kind(_robot("ROBOT", *BASE), ".urdf", MOBILE),
    "xacro rover": Kind(
        _with_argument(_robot("ROBOT", *BASE, GZ_LIDAR, GZ_DRIVE, xacro=True)),
        ".urdf.xacro",
        MOBILE,
    ),
    "classic rover": Kind(_robot("ROBOT", *BASE, CLASSIC_DRIVE), ".urdf", MOBILE, ("humble",)),
    "arm": Kind(
        _robot("ROBOT", *ARM, CONTROL.replace("HARDWARE", "mock_components/GenericSystem")),
        ".urdf",
        MANIPULATOR,
    ),
    "gz arm": Kind(
        _robot(
            "ROBOT",
            *ARM,
            CONTROL.replace("HARDWARE", "gz_ros2_control/GazeboSimSystem"),
            GZ_CONTROL.replace("controllers.yaml", "$(find my_arm)/controllers.yaml"),
        ),
        ".urdf",
        MANIPULATOR,
        ("jazzy", "kilted", "lyrical", "rolling"),
    ),
}
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
CONTROLLERS = """\
controller_manager:
  ros__parameters:
    update_rate: 50
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
arm_controller:
  ros__parameters:
    joints: [shoulder, elbow]
    command_interfaces: [position]
    state_interfaces: [position]
"""
RVIZ = """\
Visualization Manager:
  Class: ""
  Displays:
    - {Class: rviz_default_plugins/LaserScan, Name: scan, Topic: {Value: /scan}}
    - {Class: rviz_default_plugins/RobotModel, Name: model, Description Topic: {Value: /robot_description}}
  Global Options:
    Fixed Frame: map
"""

# Plain words that a newcomer may call a robot, some of which mean something elsewhere.
NAMES = (
    *(
        "r1",
        "r2",
        "r",
        "r1_a",
        "r1_b",
        "a",
        "robot1",
        "robot2",
        "robot10",
        "robot",
        "rover",
        "scout",
    ),
    *("burger", "waffle", "arm", "left", "right", "left_arm", "map", "base_link", "scan", "gz"),
    *("name", "world", "odom", "tf", "cmd_vel", "lidar_link", "clock", "bridge", "rviz", "launch"),
    *("start", "sim", "params", "plan", "no", "null", "true", "off", "file", "model", "Robot1"),
    *("base", "wheel", "joint", "link", "shared_nodes", "site", "self", "None", "partial"),
)
WORDS = (*("alpha", "beta", "p1", "p2", "red", "blue", "site_a", "fleet_1"), *NAMES)
LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix", "frame-prefix")
MOBILE_STACKS = (
    *([], ["nav2"], ["localization"], ["slam_toolbox"], ["nav2_slam"], ["robot_localization"]),
    *(["teleop"], ["nav2_composed"], ["navigation"], ["nav2", "robot_localization"]),
)
ARM_STACKS = ([], ["ros2_control"], ["ros2_control", "moveit"], ["moveit"])


class DrawnFleet(NamedTuple):
    """A fleet as data, the files that it names, and what was done to it on purpose."""

    data: Data
    files: Mapping[str, str]
    kinds: tuple[str, ...] = ()


def maybe(draw: st.DrawFn, of_ten: int = 3) -> bool:
    """True so many times of ten; what is left out is simpler."""
    return draw(st.integers(0, 9)) >= 10 - of_ten


@st.composite
def fleets(draw: st.DrawFn) -> DrawnFleet:
    """A fleet that its pages allow."""
    release = draw(st.sampled_from(RELEASES))
    layout = draw(st.sampled_from(LAYOUTS))
    data: Data = {"layout": layout, "distro": release}
    side = "prefix" if layout == "frame-prefix" else draw(st.sampled_from(("prefix", "postfix")))
    if layout != "frame-prefix" or draw(st.booleans()):
        data["affix"] = side
    if maybe(draw, 2) and layout != "frame-prefix":
        data["separators"] = {"link": draw(st.sampled_from(("_", "-")))}
    if maybe(draw, 2):
        data["simulator"] = draw(st.sampled_from(("none", "gazebo")))
    if maybe(draw, 1):
        data["use_sim_time"] = draw(st.booleans())
    if maybe(draw, 1):
        data["sros2"] = True
    if maybe(draw, 1):
        data["zenoh"] = {"router": "tcp/10.0.0.1:7447"}
    names = draw(st.lists(st.sampled_from(NAMES), min_size=2, max_size=4, unique=True))
    files: dict[str, str] = {}
    kinds = _kinds(draw, release, data.get("simulator", ""))
    posed = maybe(draw, 8)
    first = draw(st.sampled_from(kinds))
    alike = draw(st.booleans())
    robots, used = [], []
    namespaced = layout != "postfix"
    free = {key: list(WORDS) for key in ("namespace", "tag", "model")}
    tag = draw(
        st.sampled_from(((), (side,), ("namespace",), ("model",), (side, "namespace", "model")))
    )
    # Robots of one kind have the files of one, unless they differ in them.
    shared: Data = {}
    for at, name in enumerate(names):
        kind = first if alike else draw(st.sampled_from(kinds))
        used.append(kind)
        robot: Data = {"name": name}
        for key in tag:
            robot[key] = _own_word(draw, key, name, at, namespaced)
        robot["description"] = _described(draw, kind, name, files, names)
        if KINDS[kind].ending.endswith("xacro") and maybe(draw, 5):
            robot["arguments"] = {"mast": draw(st.sampled_from(("low", "high", name)))}
        if posed:
            robot["pose"] = _pose(draw, at)
        if maybe(draw, 2):
            robot["colour"] = draw(st.sampled_from(("red", "#00ff00", [0, 170, at])))
        what = KINDS[kind].what
        stacks = MOBILE_STACKS if what == MOBILE else ARM_STACKS
        if layout == "frame-prefix":
            stacks = [it for it in stacks if "moveit" not in it]
        key = f"stack {what}"
        own = key not in shared or maybe(draw, 2)
        stack = draw(st.sampled_from(stacks)) if own else shared[key]
        shared.setdefault(key, stack)
        if stack:
            robot["stack"] = stack[0] if len(stack) == 1 else list(stack)
        if "moveit" in stack:
            robot["srdf"] = _written(
                draw, files, "arm", ".srdf", SRDF.replace("ROBOT", "arm"), name
            )
        key = f"companions {what}"
        own = key not in shared or maybe(draw, 2)
        given = _companions(draw, what, files, name) if own else shared[key]
        shared.setdefault(key, given)
        if given:
            robot["companions"] = dict(given)
        if maybe(draw, 1) and kind != "gz arm":
            robot["simulator"] = draw(st.sampled_from(("none", "gazebo")))
        robots.append(robot)
    data["robots"] = robots
    _domains(draw, data, names)
    return DrawnFleet(data, files, tuple(used))


def _kinds(draw: st.DrawFn, release: str, simulator: str) -> list[str]:
    """The kinds of robots of one simulator."""
    family = (
        ("classic rover", "plain cart", "arm")
        if maybe(draw, 2)
        else tuple(KINDS)[:3] + tuple(KINDS)[4:]
    )
    known = [it for it in family if release in KINDS[it].releases]
    return [it for it in known if it != "gz arm" or simulator != "none"]


def _own_word(draw: st.DrawFn, key: str, name: str, at: int, namespaced: bool) -> str:
    forms = [f"{name}_x", f"w{at}", f"x_{name}", f"{name}{at}"]
    if key == "namespace" and namespaced:
        forms += [f"site/{name}", f"/site/{name}", f"fleet_{at}/site/{name}"]
    if key == "model":
        forms += [f"{name}-1", f"{name}.m", f"m/{name}", f"{name}_red"]
    return draw(st.sampled_from(forms))


def _described(
    draw: st.DrawFn, kind: str, name: str, files: dict[str, str], names: list[str]
) -> str:
    its = KINDS[kind]
    stem = kind.replace(" ", "_")
    form = draw(st.integers(0, 5))
    path = {3: f"{name}", 4: f"{name}_description/robot", 5: f"urdf/{stem}"}.get(form, stem)
    title = {2: name, 3: name}.get(form, stem)
    path = f"{path}{its.ending}"
    files.setdefault(path, its.text.replace("ROBOT", title))
    return path


def _written(
    draw: st.DrawFn, files: dict[str, str], stem: str, ending: str, text: str, name: str
) -> str:
    path = draw(st.sampled_from((stem, f"config/{stem}", name, f"{name}/{stem}", f"{stem}_{name}")))
    files.setdefault(f"{path}{ending}", text)
    return f"{path}{ending}"


def _companions(draw: st.DrawFn, what: str, files: dict[str, str], name: str) -> Data:
    found: Data = {}
    if maybe(draw, 5):
        text = NAV_PARAMS if what == MOBILE else CONTROLLERS
        found["params"] = _written(draw, files, f"{what}_params", ".yaml", text, name)
    if maybe(draw, 2):
        found["rviz"] = _written(draw, files, "one", ".rviz", RVIZ, name)
    return found


def _pose(draw: st.DrawFn, at: int) -> Data:
    pose: Data = {"x": 3 * at + draw(st.sampled_from((0, 0.0, 0.5, 1e-05)))}
    if maybe(draw):
        pose["y"] = draw(st.sampled_from((-1, 0.25, 10)))
    if maybe(draw):
        pose["yaw"] = draw(st.sampled_from((1.57, -3.14, 0)))
    return pose


def _domains(draw: st.DrawFn, data: Data, names: list[str]) -> None:
    if maybe(draw, 1):
        data["domains"] = {name: 11 + at for at, name in enumerate(names)}
        if maybe(draw, 5):
            data["crossing"] = ["odom"]
