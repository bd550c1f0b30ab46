# SPDX-License-Identifier: Apache-2.0
"""Which description ``multibot init`` takes of several, and when it refuses to choose."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Any

import pytest
import yaml
from given_parameters import run_given
from lxml import etree
from small_robots import PACKAGE, init, loads, robot, taken

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.planning.records import Given
from multibot_rewrite.proposal import owners
from multibot_rewrite.proposal.choosing import may_be_partners
from multibot_rewrite.proposal.looking import Looked
from multibot_rewrite.proposal.owners import Fitting, fitting
from multibot_rewrite.proposal.searching import Found
from multibot_rewrite.system.records import NOWHERE


@pytest.fixture
def two(tmp_path: Path) -> Path:
    """Two robots that nothing tells apart."""
    (tmp_path / "digger.urdf").write_text(robot("digger", "dig_left", "dig_right"))
    (tmp_path / "tractor.urdf").write_text(robot("tractor", "pull_left", "pull_right"))
    return tmp_path


@pytest.mark.more
def test_of_two_robots_neither_is_taken(two: Path, capsys: Any) -> None:
    assert init(two) == 2
    said = capsys.readouterr().err
    assert len(said.splitlines()) == 1
    assert "2 descriptions are as likely to be the robot" in said
    assert f"{two}/digger.urdf, {two}/tractor.urdf" in said
    assert f"name one: multibot init {two}/digger.urdf" in said
    assert not (two / "fleet.yaml").exists()


@pytest.mark.more
def test_the_one_that_is_taken_of_two_is_named(two: Path, capsys: Any) -> None:
    """What a launch file loads that starts less may be meant as well; what none loads is not."""
    (two / "a.launch.py").write_text(loads("digger.urdf", drivers=1))
    (two / "b.launch.py").write_text(loads("tractor.urdf", drivers=2))
    (two / "c.urdf").write_text(robot("c", "c_left", "c_right"))
    assert taken(two)["description"] == "tractor.urdf"
    other = f"one of 2 descriptions; for another: multibot init {two}/digger.urdf"
    assert other in capsys.readouterr().err
    assert init(two, str(two / "tractor.urdf"), "--force") == 0
    assert "descriptions" not in capsys.readouterr().err


def test_a_robot_of_ignition_is_for_the_release_that_finds_its_systems(tmp_path: Path) -> None:
    plugin = '<gazebo><plugin filename="ignition-gazebo-imu-system" name="{}"/></gazebo>'
    plugin = plugin.format("ignition::gazebo::systems::Imu")
    inertia = "<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/>"
    body = f"<inertial><mass value='1'/>{inertia}</inertial>"
    text = f'<robot name="digger"><link name="body">{body}</link>{plugin}</robot>'
    (tmp_path / "digger.urdf").write_text(text)
    assert taken(tmp_path)["distro"] == "humble"
    assert "# It loads ignition-gazebo-imu-system\n" in (tmp_path / "fleet.yaml").read_text()


@pytest.mark.more
def test_of_two_files_that_fit_alike_neither_is_taken(two: Path, capsys: Any) -> None:
    """The command that is named is about the same folder, and answers the question."""
    (two / "tractor.urdf").rename(two / "tractor")
    (two / "more").mkdir()
    files = [two / "more" / f"{it} file.yaml" for it in ("a", "b")]
    for it in files:
        it.write_text(f"amcl: {{ros__parameters: {{base_frame_id: {it.name[0]}_base}}}}\n")
    assert init(two / "more", str(two / "digger.urdf")) == 2
    said = capsys.readouterr().err
    assert len(said.splitlines()) == 1
    assert f"{files[0]} (a_base), {files[1]} (b_base)" in said
    command = said.strip().rpartition("name one: multibot init ")[2]
    assert shlex.split(command) == [*map(str, (two / "more", two / "digger.urdf", files[0]))]
    assert taken(two, str(two / "digger.urdf"), str(files[0]))["related_files"]["params"] == [
        "more/a file.yaml"
    ]


@pytest.mark.more
def test_the_one_that_a_launch_file_loads_is_taken(two: Path) -> None:
    (two / "up.launch.py").write_text(loads("tractor.urdf"))
    assert taken(two)["description"] == "tractor.urdf"


@pytest.mark.more
def test_the_one_whose_joints_the_files_have_is_taken(two: Path) -> None:
    values = {"joints": ["pull_left", "pull_right"], "base": "tractor_base"}
    section = {"wheels": {"ros__parameters": values}}
    (two / "wheels.yaml").write_text(yaml.safe_dump(section))
    assert taken(two)["description"] == "tractor.urdf"


def test_of_many_robots_some_are_named(tmp_path: Path, capsys: Any) -> None:
    for at in range(40):
        (tmp_path / f"kind_{at:02}.urdf").write_text(robot(f"kind_{at}", f"j{at}"))
    assert init(tmp_path) == 2
    said = capsys.readouterr().err
    assert len(said.splitlines()) == 1
    assert "40 descriptions" in said and "kind_05.urdf and 34 more" in said


def test_a_part_alone_is_asked_for(tmp_path: Path, capsys: Any) -> None:
    camera = tmp_path / "camera.urdf"
    camera.write_text(robot("camera", "eye").replace("continuous", "fixed"))
    assert init(tmp_path) == 2
    said = capsys.readouterr().err
    assert "nothing in it moves" in said and f"multibot init {camera}" in said
    assert not (tmp_path / "fleet.yaml").exists()
    assert main(["init", str(camera), "--yes", "-o", str(tmp_path / "fleet.yaml")]) == 0


@pytest.mark.more
def test_files_of_one_name_in_two_folders_are_variants(tmp_path: Path, capsys: Any) -> None:
    for name, more in (("one", ()), ("two", ("third",))):
        (tmp_path / name).mkdir()
        (tmp_path / name / "car.urdf").write_text(robot("car", "a", "b", *more))
    (tmp_path / "up.launch.py").write_text("urdf = f'{kind}/car.urdf'\n")
    (tmp_path / "package.xml").write_text(PACKAGE.format("cars"))
    assert init(tmp_path) == 2
    assert "2 descriptions" in capsys.readouterr().err


@pytest.mark.more
def test_a_file_that_includes_another_of_its_name(tmp_path: Path) -> None:
    """As a MoveIt config that adds ros2_control to the robot: that one is the robot."""
    wiki = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    for name in ("car_description", "car_config"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "package.xml").write_text(PACKAGE.format(name))
    part = robot("car", "a").replace("<robot ", f"<robot {wiki} ")
    (tmp_path / "car_description" / "car.urdf.xacro").write_text(part)
    include = '<xacro:include filename="$(find car_description)/car.urdf.xacro"/>'
    whole = f'<robot name="car" {wiki}>{include}</robot>'
    (tmp_path / "car_config" / "car.urdf.xacro").write_text(whole)
    assert taken(tmp_path)["description"] == "car_config/car.urdf.xacro"


@pytest.mark.more
def test_packages_of_a_copy_without_git_are_found(tmp_path: Path) -> None:
    """As in an image or an archive: packages are in folders of their own kind."""
    wiki = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    for name in ("robots/car", "parts/wheels"):
        (tmp_path / name).mkdir(parents=True)
        (tmp_path / name / "package.xml").write_text(PACKAGE.format(Path(name).name))
    (tmp_path / "LICENSE").write_text("")
    mast = '<link name="x"/><joint name="y" type="fixed">'
    mast += '<parent link="car_base"/><child link="x"/></joint>'
    (tmp_path / "parts/wheels/w.xacro").write_text(f"<robot {wiki}>{mast}</robot>")
    text = robot("car", "a", more='<xacro:include filename="$(find wheels)/w.xacro"/>')
    (tmp_path / "robots/car/car.urdf.xacro").write_text(text.replace("<robot ", f"<robot {wiki} "))
    assert taken(tmp_path)["description"] == "robots/car/car.urdf.xacro"


@pytest.mark.more
def test_an_sdf_is_for_the_simulator_and_its_urdf_for_the_rest(tmp_path: Path) -> None:
    (tmp_path / "car.urdf").write_text(robot("car", "a", "b"))
    drive = (
        '<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">'
        "<left_joint>a</left_joint><right_joint>b</right_joint></plugin>"
    )
    sdf = robot("car", "a", "b", more=drive).replace("robot", "model")
    sdf = sdf.replace('<parent link="car_base"/>', "<parent>car_base</parent>")
    for it in ("a", "b"):
        sdf = sdf.replace(f'<child link="{it}_wheel"/>', f"<child>{it}_wheel</child>")
    sdf = sdf.replace('<axis xyz="0 1 0"/>', "<axis><xyz>0 1 0</xyz></axis>")
    (tmp_path / "car.sdf").write_text(
        f'<sdf version="1.9">{sdf.replace("continuous", "revolute")}</sdf>'
    )
    fleet = taken(tmp_path)
    assert (fleet["description"], fleet["simulated"]) == ("car.urdf", "car.sdf")
    assert fleet["simulator"] == "gazebo"


MASS = (
    '<inertial><mass value="1"/>'
    '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
)
MIR = """\
<robot name="mir" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="tf_prefix" default=""/>
  <link name="$(arg tf_prefix)base_link">MASS</link><link name="$(arg tf_prefix)l">MASS</link>
  <joint name="$(arg tf_prefix)left" type="continuous">
    <parent link="$(arg tf_prefix)base_link"/><child link="$(arg tf_prefix)l"/>
    <axis xyz="0 1 0"/>
  </joint>
  <gazebo>
    <plugin name="drive" filename="libgazebo_ros_planar_move.so">
      <ros><remapping>cmd_vel:=$(arg tf_prefix)cmd_vel</remapping></ros>
    </plugin>
  </gazebo>
</robot>
"""


@pytest.mark.more
def test_an_argument_that_would_name_the_robot_twice_stays_empty(
    tmp_path: Path, capsys: Any
) -> None:
    """As MiR's: the namespace names the topics already."""
    (tmp_path / "mir.urdf.xacro").write_text(MIR.replace("MASS", MASS))
    fleet = taken(tmp_path, "--distro", "humble")
    assert fleet["arguments"] == {"tf_prefix": ""}
    assert fleet["layout"] == "frames-per-robot"
    file = tmp_path / "fleet.yaml"
    file.write_text(file.read_text().replace("tf_prefix: ''", "tf_prefix: '{robot}_'"))
    assert main(["build", str(file), "-o", str(tmp_path / "out")]) == 1
    said = capsys.readouterr().err
    assert "MG407 /robot1/robot1_cmd_vel has the name of robot 'robot1' twice" in said
    assert "write tf_prefix: '' under arguments" in said


RVIZ = """\
Visualization Manager:
  Class: ""
  Displays:
    - Class: rviz_default_plugins/RobotModel
      Name: RobotModel
      Links:
        All Links Enabled: true
        {}_base:
          Alpha: 1
        {}_wheel:
          Alpha: 1
"""


@pytest.mark.more
def test_rviz_and_srdf_of_another_robot_are_not_taken(two: Path) -> None:
    """Not even where no description of that robot is there: of its names none is known."""
    (two / "tractor.urdf").unlink()
    (two / "a.rviz").write_text(RVIZ.format("other", "other"))
    (two / "z.rviz").write_text(RVIZ.format("digger", "dig_left"))
    group = '<group name="g"><joint name="{}"/></group>'
    for name, joint in (("a", "elbow"), ("z", "dig_left")):
        (two / f"{name}.srdf").write_text(f'<robot name="digger">{group.format(joint)}</robot>')
    fleet = taken(two)
    assert (fleet["related_files"]["rviz"], fleet["srdf"]) == ("z.rviz", "z.srdf")
    assert "#   a.rviz: of its links and joints 0 in a hundred" in (two / "fleet.yaml").read_text()


@pytest.mark.more
def test_a_model_that_a_world_has_is_launched_too(tmp_path: Path, capsys: Any) -> None:
    """As one that a launch file puts into a simulator itself: both may be meant."""
    for name in ("cart", "dog"):
        (tmp_path / name).mkdir()
        joint = (
            '<joint name="{0}_j" type="revolute"><parent>{0}</parent><child>{0}_w</child></joint>'
        )
        parts = f'<link name="{name}"/><link name="{name}_w"/>{joint.format(name)}'
        model = f'<sdf version="1.9"><model name="{name}">{parts}</model></sdf>'
        (tmp_path / name / "model.sdf").write_text(model)
    (tmp_path / "dog.launch.py").write_text(loads("dog/model.sdf"))
    plays = loads().replace("[*map(given", "[given('yard.world'), *map(given")
    start = 'if name.endswith("world"):\n        return ExecuteProcess(cmd=["gz", "sim", path])'
    plays = plays.replace("    if name", f"    {start}\n    if name", 1)
    (tmp_path / "cart.launch.py").write_text(f"from launch.actions import ExecuteProcess\n{plays}")
    (tmp_path / "yard.world").write_text(
        '<sdf version="1.9"><world name="w"><include><uri>model://cart</uri></include></world></sdf>'
    )
    assert init(tmp_path, "--simulator", "none") == 2
    assert "2 descriptions" in capsys.readouterr().err


@pytest.mark.more
def test_the_robot_is_found_behind_many_things(tmp_path: Path) -> None:
    for at in range(70):
        thing = '<sdf version="1.9"><model name="t"><link name="t"/></model></sdf>'
        (tmp_path / f"a{at}.sdf").write_text(thing)
    (tmp_path / "zebra.urdf").write_text(robot("zebra", "z1", "z2"))
    (tmp_path / "up.launch.py").write_text(loads("zebra.urdf"))
    assert taken(tmp_path)["description"] == "zebra.urdf"


@pytest.mark.more
def test_srdfs_and_moveit_files_are_known_by_what_macros_make(tmp_path: Path) -> None:
    """As xarm_moveit_config: an SRDF of macros has no name in its text, one makes two robots, one
    has the macros alone; each arm has a folder of MoveIt's files with the same names."""
    space = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    body = robot("${p}digger", "${p}dig").partition(">")[2]
    head = f'<robot name="digger" {space}><xacro:arg name="prefix" default=""/>'
    given = '<xacro:property name="p" value="$(arg prefix)"/>'
    (tmp_path / "digger.urdf.xacro").write_text(f"{head}{given}{body}")
    (tmp_path / "macro.srdf.xacro").write_text(
        f'<robot name="m" {space}><xacro:macro name="arm" params="p"><group name="${{p}}arm">'
        '<joint name="${p}dig"/></group></xacro:macro></robot>'
    )
    include = '<xacro:include filename="macro.srdf.xacro"/>'
    calls = '<xacro:arm p="L_"/><xacro:arm p="R_"/>'
    (tmp_path / "both.srdf.xacro").write_text(f'<robot name="b" {space}>{include}{calls}</robot>')
    call = f'{include}<xacro:arm p="$(arg prefix)"/></robot>'
    (tmp_path / "one.srdf.xacro").write_text(f"{head}{call}")
    for name, joint in (("a", "pull"), ("b", "dig")):
        (tmp_path / name).mkdir()
        limits = f"joint_limits: {{{joint}: {{has_velocity_limits: true, max_velocity: 1.0}}}}\n"
        (tmp_path / name / "joint_limits.yaml").write_text(limits)
    fleet = taken(tmp_path)
    assert fleet["srdf"] == "one.srdf.xacro"
    assert fleet["related_files"]["moveit"] in ("b/joint_limits.yaml", ["b/joint_limits.yaml"])


@pytest.mark.more
def test_the_arguments_of_the_srdf_alone_are_given(tmp_path: Path) -> None:
    """What has no value anywhere is not made up: then the SRDF is not taken."""
    (tmp_path / "arm.urdf.xacro").write_text(robot("arm", "turn"))
    text = (
        '<robot name="$(arg name)"><group name="$(arg {})_all"><joint name="turn"/></group></robot>'
    )
    srdf = tmp_path / "arm.srdf.xacro"
    srdf.write_text(text.format("name"))
    fleet = taken(tmp_path)
    assert fleet["srdf"] == "arm.srdf.xacro"
    assert fleet["arguments"] == {"name": "arm"}
    srdf.write_text(text.format("side"))
    fleet = taken(tmp_path, "--force")
    assert "srdf" not in fleet
    assert "arguments" not in fleet


# Node, parameter, value -> is it a name that the robot has not? It has base_link, turn, /front/scan.
NAMES = (
    ("amcl", "base_frame_id", "base_link", False), ("amcl", "base_frame_id", "chassis", True),
    ("amcl", "odom_frame_id", "odom", False), ("amcl", "base_frame_id", "$(var tf)base", False),
    ("amcl", "scan_topic", "front/scan", False), ("amcl", "scan_topic", "/rear/scan", True),
    ("amcl", "scan_topic", "scan", False), ("amcl", "laser_model_type", "beam", False),
    ("joint_trajectory_controller", "joints", ["turn"], False),
    ("joint_trajectory_controller", "joints", ["turn", "lift"], True),
    # A body in the world that the node itself makes.
    ("static_transform_publisher", "child_frame_id", "camera", False), ("driver", "base", "x", False),
)  # fmt: skip


def test_names_in_parameters_are_held_against_the_description() -> None:
    known = load_known_nodes("", "jazzy")
    text = (
        '<robot name="r"><link name="base_link"/><joint name="turn"/><gazebo><topic>/front/scan'
        "</topic></gazebo></robot>"
    )
    looked = Looked("r.urdf", root=etree.fromstring(text))
    for node, name, value, strange in NAMES:
        given = run_given(node, node, "", {name: Given(value, NOWHERE)}, NOWHERE)  # type: ignore[arg-type]
        found = fitting(looked, "p.yaml", [given], known, ())
        assert (found.nodes, bool(found.strange)) == ({node}, strange), (name, value)


def test_partners_are_of_the_other_kind_and_called_alike_or_launched_together(
    tmp_path: Path,
) -> None:
    launch = tmp_path / "a.launch.py"
    launch.write_text(loads("car.urdf.xacro", "van/model.sdf"))
    names = (
        "bus.urdf",
        "bus/model.sdf",
        "car.sdf",
        "car.urdf.xacro",
        "car/model.sdf",
        "van/model.sdf",
    )
    every = tuple(str(tmp_path / it) for it in names)
    for it in every:
        Path(it).parent.mkdir(exist_ok=True)
        Path(it).write_text('<robot name="r"><link name="a"/></robot>')
    found = Found(every=every, launch=(str(launch),))
    for path, partners in (
        ("car.urdf.xacro", ["car.sdf", "car/model.sdf", "van/model.sdf"]),
        ("bus.urdf", ["bus/model.sdf"]),
        ("car.sdf", ["car.urdf.xacro"]),
        ("truck.sdf", []),
    ):
        there = [str(tmp_path / it) for it in partners]
        assert [*may_be_partners(str(tmp_path / path), found)] == there, path


# Which names are a robot's, and how well a file goes with it; by hand.


@pytest.mark.parametrize(
    ("given", "names", "plain"),
    [
        ("{robot}_", {"robot1_base", "robot1/x", "y", "robot1_"}, {"base", "x", "y", "robot1_"}),
        ("{robot}", {"robot1_base", "robot1base"}, {"base", "robot1base"}),
        ("tool_", {"tool_base", "robot1_base"}, {"tool_base", "robot1_base"}),
    ],
)  # fmt: skip
def test_names_are_known_without_what_arguments_put_in_front(
    given: str, names: set[str], plain: set[str]
) -> None:
    robot = Looked("a.urdf.xacro", arguments=(("prefix", given),))
    assert owners._without_prefixes(robot, frozenset(names)) == plain


def fit(names: str) -> Fitting:
    return Fitting("p.yaml", frozenset({"amcl"}), frozenset(names))


def test_a_file_with_clearly_more_strange_names_is_no_rival() -> None:
    assert owners._is_rival(fit("abcd"), fit("ab"))
    assert not owners._is_rival(fit("abcde"), fit("ab"))


@pytest.mark.parametrize(("names", "shown"), [("ba", "a, b"), ("cab", "a, b ..."), ("a", "a")])
def test_of_many_strange_names_two_are_shown(names: str, shown: str) -> None:
    assert owners._first_names(names) == shown
