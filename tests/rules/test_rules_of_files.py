# SPDX-License-Identifier: Apache-2.0
"""One table of broken files: ``urdf-lint`` and ``build`` say the same of each, at one place.

Of ``rules/files``: keys, names, rcl_rules, robot_words, ros_names, same_for_all, sections.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest
import yaml
from paths import fixture_text, write_files
from rule_examples import BUILT, RELATED_FILES

from multibot_rewrite.base.findings.finding import Finding, Rule
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.checks.judged_plan import plan_fleet
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.rules.declaration import rules_in
from multibot_rewrite.rules.files.judge import SHARED
from multibot_rewrite.rules.settings import Settings

DESCRIPTION = fixture_text("rules_of_files_description.urdf")
ROVER: Mapping[str, str] = {
    "package.xml": "<package><name>rover</name></package>",
    "urdf/rover.urdf": DESCRIPTION,
}
ROBOTS = ("robot1", "robot2")
EKF = "ekf_filter_node:\n  ros__parameters:\n    {}\n    odom0: odom\n"
AMCL = "amcl:\n  ros__parameters:\n    {}\n"
ARM = "arm_controller:\n  ros__parameters:\n    joints: [{}, right_wheel_joint]\n"
MANAGER = "moveit_simple_controller_manager:\n  controller_names: [a]\n  a:\n    {}\n"
MANAGER += "    action_ns: follow_joint_trajectory\n    type: FollowJointTrajectory\n"
AXES = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Axes
      {}
"""
SCAN = AXES.replace("Axes", "LaserScan")
ROW = """\
- ros_topic_name: scan
  gz_topic_name: scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
  {}
"""
TREE = """\
<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    {}
  </BehaviorTree>
</root>
"""
LUA = """\
options = {{
  map_frame = "map",
  tracking_frame = "{}",
}}
"""
MANAGED = """lifecycle_manager:
  ros__parameters:
    node_names: ["amcl", "{}"]
map_server:
  ros__parameters: {{yaml_filename: /map.yaml}}
amcl:
  ros__parameters: {{alpha1: 0.1}}
"""
MPPI = """controller_server:
  ros__parameters:
    controller_plugins: ["Mppi"]
    Mppi:
      plugin: "nav2_mppi_controller::MPPIController"
      {}
"""
# Kind of a file, its text, and the code, line and column of what is wrong in it. What the nodes make
# of each: robot_localization ros_filter.cpp (frequency, publish_tf), amcl_node.cpp (max_beams is an
# integer), rcl_validate_topic_name, tf2 validateFrameId, rcl_yaml_param_parser, bridge_config.cpp.
BROKEN = {
    "a misspelt parameter": ("params", EKF.format("frequncy: 30.0"), "MB110:3:5"),
    "a text for a switch": ("params", EKF.format('publish_tf: "yes"'), "MB120:3:17"),
    "a fraction of a beam": ("params", AMCL.format("max_beams: 60.5"), "MB120:3:16"),
    "a topic with a digit": ("params", AMCL.format("scan_topic: 1scan"), "MB312:3:17"),
    "a misspelt frame": ("params", AMCL.format("base_frame_id: base_lnik"), "MB853:3:20"),
    "a managed node": ("params", MANAGED.format("map_sever"), "MB894:3:17"),
    "a batch of none": ("params", MPPI.format("batch_size: -1"), "MB125:6:19"),
    "a frame to itself": ("params", AMCL.format("odom_frame_id: map"), "MB894:3:20"),
    "a misspelt joint": ("params", ARM.format("left_whel_joint"), "MB854:3:14"),
    "a slash": ("params", AMCL.format("odom_frame_id: /odom"), "MB301:3:20"),
    "white space": ("params", AMCL.format('odom_frame_id: "odom "'), "MB865:3:20"),
    "a placeholder": ("params", AMCL.format("scan_topic: $(var side)/scan"), "MB105:3:17"),
    "another robot": ("params", AMCL.format("scan_topic: /robot2/scan"), "MB863:3:17"),
    "no value": ("params", AMCL.format("scan_topic:"), "MB868:3:5"),
    "a key twice": ("params", AMCL.format("max_beams: 1\n    max_beams: 2"), "MB859:4:5"),
    "a node's name": ("params", AMCL.format("alpha1: 0.1").replace("amcl", "2d"), "MB312:1:1"),
    "MoveIt's joint": ("moveit", MANAGER.format("joints: [left_whel_joint]"), "MB854:4:14"),
    "MoveIt's frame": (
        "moveit",
        MANAGER.format("joints: [left_wheel_joint]\n    base_frame_id: base_lnik"),
        "MB853:5:20",
    ),
    "RViz's frame": ("rviz", AXES.format("Reference Frame: lidar_lnk"), "MB853:4:24"),
    "RViz's slash": ("rviz", AXES.format("Reference Frame: /lidar_link"), "MB301:4:24"),
    "RViz's topic": ("rviz", SCAN.format("Topic: 1/scan"), "MB312:4:14"),
    "RViz's robot": ("rviz", SCAN.format("Topic: /robot1/scan"), "MB863:4:14"),
    "a bridge's key": ("bridge", ROW.format("lazzy: true"), "MB858:5:3"),
    "a bridge's direction": ("bridge", ROW.format("direction: GZ_TO_ROSS"), "MB855:5:14"),
    "a bridge's frame": ("bridge", ROW.format("frame_id: lidar_lnk"), "MB853:5:13"),
    "a tree's frame": ("tree", TREE.format('<Go global_frame="base_lnik"/>'), "MB853:3:23"),
    "a tree's slash": ("tree", TREE.format('<Go global_frame="/base_link"/>'), "MB301:3:23"),
    "a tree's topic": ("tree", TREE.format('<Go topic_name="2d"/>'), "MB312:3:21"),
    "a tree's robot": ("tree", TREE.format('<Go topic_name="/robot2/scan"/>'), "MB863:3:21"),
    "Lua's frame": ("lua", LUA.format("base_lnik"), "MB853:3:20"),
    "Lua's slash": ("lua", LUA.format("/base_link"), "MB301:3:20"),
    "Lua's space": ("lua", LUA.format("base_link "), "MB865:3:20"),
    "a bridge's topic": ("bridge", ROW.replace("e: scan\n", "e: 2d\n", 1).format(""), "MB312:1:19"),
}


def places(findings: list[Finding], file: str, rules: set[str]) -> list[str]:
    ours = (it for it in findings if it.file.endswith(file) and it.code in rules)
    return [f"{it.code}:{it.line}:{it.column}" for it in ours]


def by_both(
    kind: str,
    text: str,
    folder: Path,
    rules: set[str],
    beside: Mapping[str, str] = ROVER,
    distro: str = NEWEST_LTS,
) -> tuple[list[str], list[str]]:
    """Return what the lint and a build say of a file in a package (the rover's, if it has none)."""
    file, key = RELATED_FILES[kind]
    write_files(folder, {**ROVER, **beside, file: text})
    linted = lint_file(
        str(folder / file), Settings(robots=ROBOTS, naming=make_naming("both"), distro=distro)
    )
    robots = [{"name": it, "description": "urdf/rover.urdf"} for it in ROBOTS]
    params = [it for it in beside if it.endswith(".yaml")]
    related_files = {"params": params, key: file} if params else {key: file}
    fleet = {"layout": "both", "robots": robots, "related_files": related_files, "distro": distro}
    (folder / "fleet.yaml").write_text(yaml.safe_dump(fleet))
    built = make_outputs(plan_fleet(read_fleet(str(folder / "fleet.yaml"), "", {}))).findings
    return places(linted, file, rules), places(list(built), file, rules)


EVERY = rules_in("files")
IN_BOTH = [it for it in EVERY if BUILT not in it.options]
CODES = {it.code for it in (*EVERY, *SHARED)}


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize("name", BROKEN)
def test_lint_and_build_say_the_same(name: str, tmp_path: Path) -> None:
    kind, text, expected = BROKEN[name]
    assert by_both(kind, text, tmp_path, CODES) == ([expected], [expected])


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize("rule", IN_BOTH, ids=lambda it: it.code)
def test_an_example_is_found_by_both(rule: Rule, tmp_path: Path) -> None:
    distro = str(rule.options.get("distro", NEWEST_LTS))
    linted, built = by_both(
        rule.formats[0], rule.page.bad, tmp_path, {rule.code}, rule.page.beside, distro
    )
    assert linted == built
    assert [int(it.split(":")[1]) for it in built] == [rule.page.line]


@pytest.mark.parametrize(
    ("distro", "expected"),
    [
        ("humble", ["MB853:6:13"]),
        ("jazzy", ["MB855:1:3", "MB858:2:3", "MB858:4:3", "MB855:5:14"]),
    ],
)
def test_a_bridge_reads_words_of_ignition_on_humble(
    distro: str, expected: list[str], tmp_path: Path
) -> None:
    """ros_gz branch humble reads them (bridge_config.cpp: kIgnTypeName and more), jazzy does not."""
    text = ROW.replace("gz_", "ign_").format("direction: IGN_TO_ROS\n  frame_id: lidar_lnk")
    found = by_both("bridge", text, tmp_path, CODES, distro=distro)
    assert [sorted(it) for it in found] == [sorted(expected)] * 2


def test_a_comment_silences_both(tmp_path: Path) -> None:
    kind, text, _ = BROKEN["a misspelt parameter"]
    text = text.replace("30.0", "30.0  # urdf-lint: ignore MB110 - ours")
    assert by_both(kind, text, tmp_path, CODES) == ([], [])


def parameters(node: str, text: str) -> str:
    return f"{node}:\n  ros__parameters: {{{text}}}\n"


NO_NAME = "is not a valid ROS name:"
LETTERS = "is not a letter, a digit, or one of _ / ~ { }"
FOR_ONE = "includes the robot name robot2, so the file is for that robot only"
SAME = "is the same for all robots"
CALIBRATION = "2 note every robot reads the calibration '{}a.yaml'; real cameras have one each"
BELOW = "has a namespace; it is placed below each robot's namespace"


@pytest.mark.parametrize(
    ("code", "text", "said"),
    [
        (
            "MB312",
            parameters("a/my-node", "a: 1"),
            f"1 warning node 'a/my-node' {NO_NAME} 'my-node': character 3, '-', is not a letter, a"
            " digit or an underscore",
        ),
        (
            "MB312",
            parameters("amcl", "scan_topic: my-scan"),
            f"2 warning topic 'my-scan' {NO_NAME} character 3, '-', {LETTERS}",
        ),
        ("MB312", parameters("amcl", "scan_topic: scan"), ""),
        ("MB312", parameters('"${ns}/amcl"', "scan_topic: scan"), ""),
        ("MB883", parameters("rover/amcl", "a: 1"), f"1 warning section rover/amcl {BELOW}"),
        (
            "MB883",
            parameters("rover:\n  amcl", "a: 1").replace("\n  ros", "\n    ros"),
            f"1 warning section rover/amcl {BELOW}",
        ),
        ("MB883", parameters("amcl", "a: 1"), ""),
        ("MB883", parameters('"**/amcl"', "a: 1"), ""),
        ("MB883", parameters("local_costmap/local_costmap", "a: 1"), ""),
        (
            "MB883",
            parameters("rover/**", "a: 1"),
            "1 error section rover/** is for one robot only: its name includes a namespace",
        ),
        (
            "MG503",
            "".join(parameters(it, f"use_sim_time: {it != 'a'}".lower()) for it in "abc"),
            "2 warning use_sim_time is false for a, and true for b",
        ),
        (
            "MG503",
            "".join(parameters(it, f"use_sim_time: {it == 'a'}".lower()) for it in "abc"),
            "2 warning use_sim_time is true for a, and false for b",
        ),
        # What a known parameter holds is a name elsewhere, too.
        *(
            (
                "MB901",
                parameters("amcl", f"{key}: {value}") + parameters("other", f"acme: {value}"),
                f"4 note {value!r} is a {kind} of the robot, but its use here is not known" * known,
            )
            for key, value, kind, known in (
                ("scan_topic", "/scan", "topic", True),
                ("base_frame_id", "base", "frame", True),
                ("odom_frame_id", "odom", "frame", True),
                ("scan_topic", "scan", "topic", False),
                ("global_frame_id", "map", "frame", False),
            )
        ),
        # What each robot has of its own.
        *(
            ("MB412", parameters(node, f"{key}: {value}"), f"2 {level} {key} {value} {SAME}")
            for node, key, value, level in (
                ("x", "serial_port", "/dev/ttyUSB0", "note"),
                ("x", "ip_address", "192.168.0.5", "warning"),
                ("x", "port", "8080", "note"),
                ("foxglove_bridge", "port", "8765", "warning"),
            )
        ),
        *(
            (
                "MB412",
                parameters("camera", f"camera_info_url: '{it}a.yaml'"),
                CALIBRATION.format(it),
            )
            for it in ("file:///", "package://a/")
        ),
        *(
            ("MB412", parameters("camera", f"camera_info_url: '{it}a.yaml'"), "")
            for it in ("flash:///", "file://${ROS_HOME}/", "file:///<robot_namespace>/")
        ),
        ("MB412", parameters("x", "ip_address: 127.0.0.1"), ""),
        ("MB412", parameters("x", "port: 80"), ""),
        (
            "MB881",
            parameters("foxglove_bridge", 'topic_whitelist: ["/scan.*"]'),
            "2 warning names in topic_whitelist '/scan.*' are not rewritten",
        ),
        ("MB881", parameters("foxglove_bridge", 'topic_whitelist: [".*"]'), ""),
        (
            "MB867",
            parameters("amcl", "alpha1: 0.1") + parameters("/**", "alpha1: 0.2, alpha2: 0.3"),
            "4 warning alpha1 of amcl is overridden by the later section **",
        ),
        (
            "MB867",
            "".join(parameters(it, "alpha1: 0.1") for it in ("/**", "amcl", "/**/amcl")),
            "6 warning alpha1 of amcl is overridden by the later section **/amcl",
        ),
        ("MB867", parameters("amcl", "alpha1: 0.1") + parameters("/**", "alpha2: 0.2"), ""),
        ("MB867", parameters("amcl", "alpha1: 0.1") + parameters("/**/ekf", "alpha1: 0.2"), ""),
        (
            "MB866",
            parameters("amcl", "alpha1: 0.1") + parameters("amcl", "alpha2: 0.2"),
            "3 warning section amcl is repeated; the first is in line 1",
        ),
        (
            "MB859",
            parameters("amcl", "alpha1: 0.1, alpha1: 0.2"),
            "2 warning 'alpha1' is set twice; the later value counts",
        ),
        (
            "MB877",
            parameters("collision_monitor", "observation_sources: [frnt], front: {topic: a}"),
            "2 warning collision_monitor has frnt in observation_sources, without parameters",
        ),
        # Another number is another one.
        (
            "MB877",
            parameters("collision_monitor", "observation_sources: [front2], front: {topic: a}"),
            "",
        ),
        ("MB863", parameters("x", "t: /robot2/scan"), f"2 error /robot2/scan {FOR_ONE}"),
        ("MB863", parameters("x", "t: /scan/robot2"), f"2 error /scan/robot2 {FOR_ONE}"),
        ("MB863", parameters("x", "t: /model/robot2/y"), f"2 error /model/robot2/y {FOR_ONE}"),
        ("MB863", parameters("x", "t: /robot20/scan"), ""),
        (
            "MB110",
            parameters("amcl", "max_particels: 20"),
            "2 warning amcl has no parameter 'max_particels'",
        ),
        (
            "MB120",
            parameters("amcl", 'max_particles: "3"'),
            "2 error amcl: max_particles is a string, not an int",
        ),
        # The code of a costmap is in a namespace of its name: this one may be read by nobody.
        (
            "MB120",
            parameters("local_costmap", 'width: "3"'),
            "2 warning local_costmap: width is a string, not an int",
        ),
        (
            "MB120",
            parameters("local_costmap/local_costmap", 'width: "3"'),
            "2 error local_costmap/local_costmap: width is a string, not an int",
        ),
    ],
)
def test_what_is_said_of_a_parameter_file(code: str, text: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_text(text)
    found = lint_file(str(tmp_path / "a.yaml"), Settings(select=(code,), robots=ROBOTS))
    assert [f"{it.line} {it.level} {it.message}" for it in found] == [said] * bool(said)


ONE_FILE = "5:25 Description File '/a.urdf' is one description file, shown for every robot;"
PATTERN = "4:27 Filter (whitelist) 'base.*' is a pattern for frames and stays unchanged;"
TWICE = "4:18 TF Prefix '{}' adds a prefix to frames that already have the robot's name: it is"
A_FILE = "Description Source: File\n      Description File: /a.urdf"


@pytest.mark.parametrize(
    ("layout", "display", "row", "said"),
    [
        ("both", "RobotModel", A_FILE, f"{ONE_FILE} set Description Source to Topic"),
        # Each robot has its links alike.
        ("tf-per-robot", "RobotModel", A_FILE, f"{ONE_FILE} fine if all robots look the same"),
        ("both", "RobotModel", A_FILE.replace("File\n", "Topic\n"), ""),
        ("both", "TF", "Filter (whitelist): base.*", f"{PATTERN} make it match the robots' frames"),
        ("tf-per-robot", "TF", "Filter (whitelist): base.*", ""),
        (
            "both",
            "RobotModel",
            "TF Prefix: rover",
            f"{TWICE.format('rover')} emptied; nothing to do; RViz would add the prefix a second time",
        ),
        ("tf-per-robot", "RobotModel", "TF Prefix: rover", ""),
    ],
)
def test_what_is_said_of_a_display(
    layout: str, display: str, row: str, said: str, tmp_path: Path
) -> None:
    (tmp_path / "a.rviz").write_text(AXES.replace("Axes", display).format(row))
    codes = ("MB881", "MB882")
    settings = Settings(select=codes, robots=ROBOTS, naming=make_naming(layout))
    found = lint_file(str(tmp_path / "a.rviz"), settings)
    assert [f"{it.line}:{it.column} {it.message}; {it.hint}" for it in found] == [said] * bool(said)
    assert {it.level for it in found} <= {"warning"}
