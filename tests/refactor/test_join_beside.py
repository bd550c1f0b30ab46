# SPDX-License-Identifier: Apache-2.0
"""SRDFs and controllers' parameters of joined parts: what they become, by hand; what is refused."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import yaml
from lxml import etree
from paths import fixture_text

from multibot_rewrite import InputError, Part, join, split
from multibot_rewrite.cli.multibot import main

SHAPE = '<collision><geometry><box size="1 1 1"/></geometry></collision>'
ARM = f"""<robot name="arm">
  <link name="base">{SHAPE}</link><link name="hand">{SHAPE}</link><link name="tool"/>
  <joint name="turn" type="continuous"><parent link="base"/><child link="hand"/></joint>
  <joint name="end" type="fixed"><parent link="hand"/><child link="tool"/></joint>
</robot>
"""
GRIPPER = f"""<robot name="gripper">
  <link name="root"/><link name="palm">{SHAPE}</link><link name="finger">{SHAPE}</link>
  <joint name="in" type="fixed"><parent link="root"/><child link="palm"/></joint>
  <joint name="grip" type="continuous"><parent link="palm"/><child link="finger"/></joint>
</robot>
"""
ARM_SRDF = """<robot name="arm">
  <virtual_joint name="stand" type="fixed" parent_frame="world" child_link="base"/>
  <group name="arm"><joint name="stand"/><joint name="turn"/></group>
  <group_state name="home" group="arm"><joint name="turn" value="0"/></group_state>
  <disable_collisions link1="base" link2="hand" reason="Adjacent"/>
</robot>
"""
GRIPPER_SRDF = """<robot name="gripper">
  <virtual_joint name="held" type="floating" parent_frame="world" child_link="root"/>
  <group name="fingers"><joint name="held"/><joint name="grip"/></group>
  <end_effector name="eef" parent_link="palm" group="fingers"/>
  <passive_joint name="grip"/>
  <disable_collisions link1="palm" link2="finger" reason="Adjacent"/>
</robot>
"""
# By hand: the second virtual joint and its uses are gone; hand and palm meet, as MoveIt's Setup
# Assistant has it, since tool and root have no shape.
JOINED_SRDF = fixture_text("join_beside_joined_srdf.urdf")
CONTROLLERS = fixture_text("join_beside_controllers.yaml")


def parts(prefix: str = "g_") -> list[Part]:
    return [
        Part(ARM, srdf=ARM_SRDF),
        Part(GRIPPER, "tool", prefix=prefix, srdf=GRIPPER_SRDF),
    ]


def files(
    folder: Path, first: str = "follow", second: str = "follow", rate: int = 100
) -> list[str]:
    made = []
    for name, controller, joint, hertz in (("a", first, "turn", 100), ("b", second, "grip", rate)):
        path = folder / f"{name}.yaml"
        path.write_text(CONTROLLERS.format(name=controller, joint=joint, rate=hertz))
        made.append(str(path))
    return made


def test_one_srdf_has_what_the_parts_have_and_the_pair_that_meets() -> None:
    made = join(parts())
    assert made.srdf.decode() == JOINED_SRDF
    assert made.notes == (
        "SRDF: 3 pairs of links of two parts are checked for collisions; "
        "MoveIt's Setup Assistant finds those that never touch",
    )


def test_a_group_of_two_parts_and_what_is_no_srdf_are_refused() -> None:
    first, second = parts("")
    both = ARM_SRDF.replace('"arm"', '"fingers"')
    with pytest.raises(
        InputError, match="group 'fingers' is in <text>, too; give the part a prefix"
    ):
        join([first._replace(srdf=both), second])
    with pytest.raises(InputError, match="name an SRDF"):
        join([first._replace(srdf="<sdf/>"), second])


def test_one_controller_manager_has_the_controllers_of_both(tmp_path: Path) -> None:
    arm, gripper = parts()
    one, other = files(tmp_path)
    made = join([arm._replace(controllers=[one]), gripper._replace(controllers=[other])])
    trajectory = {"type": "joint_trajectory_controller/JointTrajectoryController"}
    assert yaml.safe_load(made.controllers) == {
        "controller_manager": {
            "ros__parameters": {
                "update_rate": 100,
                "joint_state_broadcaster": {
                    "type": "joint_state_broadcaster/JointStateBroadcaster"
                },
                "follow": trajectory,
                "g_follow": trajectory,
            }
        },
        "follow": {"ros__parameters": {"joints": ["turn"], "constraints": {"goal_time": "1e-3"}}},
        "/g_follow": {
            "ros__parameters": {"joints": ["g_grip"], "constraints": {"goal_time": "1e-3"}}
        },
    }
    # PyYAML takes it for a text, rcl for a number: in quotes it would be a text for both.
    assert b"goal_time: 1e-3" in made.controllers
    assert made.controllers.startswith(b"# joined by multibot from a.yaml, b.yaml\n")


def test_of_two_lists_each_item_is_there_once_and_a_long_one_stays_a_line(tmp_path: Path) -> None:
    arm, gripper = parts()
    one, other = files(tmp_path)
    long = [f"state_{at}" for at in range(200)]
    for path, items in ((one, long), (other, ["more", "state_7"])):
        rate = f"update_rate: 100\n    hardware_unconfigured: [{', '.join(items)}]"
        Path(path).write_text(Path(path).read_text().replace("update_rate: 100", rate))
    made = join([arm._replace(controllers=[one]), gripper._replace(controllers=[other])])
    text = ", ".join([*long, "more"])
    assert f"    hardware_unconfigured: [{text}]\n" in made.controllers.decode()


def test_controllers_that_meet_are_refused_and_other_values_told(tmp_path: Path) -> None:
    arm, gripper = parts("")
    one, other = files(tmp_path)
    with pytest.raises(InputError, match=r"controller 'follow' is in .*a.yaml, too; give the part"):
        join([arm._replace(controllers=[one]), gripper._replace(controllers=[other])])
    one, other = files(tmp_path, second="grip", rate=500)
    made = join([arm._replace(controllers=[one]), gripper._replace(controllers=[other])])
    assert f"{other}: controller_manager.update_rate is 500, before it 100, which is taken" in (
        made.notes
    )


@pytest.mark.parametrize(
    ("said", "becomes"),
    [
        ("joints: [grip]", {"joints": ["g_grip"]}),
        ("interfaces: [effort]", {"interfaces": ["effort"]}),
    ],
)
def test_a_broadcaster_of_some_joints_is_of_its_part(
    said: str, becomes: dict[str, list[str]], tmp_path: Path
) -> None:
    """joint_state_broadcaster.cpp: without both it takes all joints."""
    arm, gripper = parts()
    one, other = files(tmp_path)
    own = f"\njoint_state_broadcaster: {{ros__parameters: {{{said}}}}}\n"
    Path(other).write_text(Path(other).read_text() + own)
    made = join([arm._replace(controllers=[one]), gripper._replace(controllers=[other])])
    found = yaml.safe_load(made.controllers)
    assert becomes.items() <= found["/g_joint_state_broadcaster"]["ros__parameters"].items()
    assert {"joint_state_broadcaster", "g_joint_state_broadcaster"} <= set(
        found["controller_manager"]["ros__parameters"]
    )


def test_the_command_writes_them_beside_the_description(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name, text in (("arm", ARM), ("gripper", GRIPPER)):
        Path(f"{name}.urdf").write_text(text)
    Path("arm.srdf").write_text(ARM_SRDF)
    Path("gripper.srdf").write_text(GRIPPER_SRDF)
    one, other = files(Path())
    arm = f"{{description: arm.urdf, srdf: arm.srdf, controllers: [{one}], rviz: arm.rviz}}"
    gripper = "{description: gripper.urdf, at: {parent: tool}, prefix: g_, srdf: gripper.srdf"
    Path("all.join").write_text(f"join: [{arm}, {gripper}, controllers: [{other}]}}]\n")
    Path("arm.rviz").write_text(ARM_RVIZ)
    words = ["join", "all.join"]
    assert main(words) == 2
    assert "name the description with -o" in capsys.readouterr().err
    assert main([*words, "-o", "out/robot.urdf"]) == 0
    assert sorted(it.name for it in Path("out").iterdir()) == [
        "robot.rviz",
        "robot.srdf",
        "robot.urdf",
        "robot_controllers.yaml",
    ]
    assert Path("out/robot.srdf").read_text() == JOINED_SRDF
    # Beside arm.urdf it would be written over a file that is read.
    assert main([*words, "-o", "arm.urdf"]) == 2
    given = ["join", "arm.urdf", "gripper.urdf", "--at", "tool", "--prefix", "g_"]
    assert main([*given, "-o", "arm.urdf"]) == 2
    assert main([*words, "-o", "gripper"]) == 2
    assert Path("gripper.srdf").read_text() == GRIPPER_SRDF


ROBOT_MODEL = """\
    - Class: rviz_default_plugins/RobotModel
      Description Topic:
        Value: /robot_description
      Links:
        {link}:
          Alpha: 1
      Name: Robot
"""
# Displays of an arm and of a gripper, and what is shown of both.
ARM_RVIZ = f"""\
Visualization Manager:
  Displays:
{ROBOT_MODEL.format(link="hand")}\
  Global Options:
    Fixed Frame: base
"""
FINGERS = """\
- Class: rviz_default_plugins/Axes
  Name: Palm
  Reference Frame: palm
- Class: rviz_default_plugins/Image
  Name: Camera
  Topic:
    Value: /camera
"""
PALM = ROBOT_MODEL.format(link="palm").replace("/robot", "robot")
GRIPPER_RVIZ = f"""\
Visualization Manager:
  Displays:
{PALM}{"".join(f"    {it}" for it in FINGERS.splitlines(True))}\
  Global Options:
    Fixed Frame: root
"""
GROUP = f"""\
    - Class: rviz_common/Group
      Displays:
{"".join(f"        {it}" for it in FINGERS.replace("palm", "g_palm").splitlines(True))}\
      Enabled: true
      Name: g
"""


EMPTY = "Visualization Manager:\n  Displays: []\n  Global Options:\n    Fixed Frame: base\n"
SAME = GRIPPER_RVIZ[: GRIPPER_RVIZ.index("    - Class: rviz_default_plugins/Axes")]


@pytest.mark.parametrize(
    ("first", "second", "becomes"),
    [
        (ARM_RVIZ, GRIPPER_RVIZ, ARM_RVIZ.replace("  Global", f"{GROUP}  Global")),
        (ARM_RVIZ, f"{SAME}  Global Options:\n    Fixed Frame: root\n", ARM_RVIZ),
        (EMPTY, GRIPPER_RVIZ, EMPTY),
    ],
    ids=["a group", "the same", "no place for them"],
)
def test_one_window_shows_all_parts(first: str, second: str, becomes: str, tmp_path: Path) -> None:
    """One robot has one description: its display is there once."""
    one, other = tmp_path / "arm.rviz", tmp_path / "gripper.rviz"
    one.write_text(first)
    other.write_text(second)
    arm, gripper = parts()
    gripper = gripper._replace(rviz=str(other))
    made = join([arm._replace(rviz=str(one)), gripper])
    assert made.rviz.decode() == becomes
    what = "it shows no more" if becomes == first else "its displays are in the group g"
    told = f"{other}: {what}; tools, panels and views are those of {one}"
    assert [it for it in made.notes if "rviz" in it] == [told]
    if second == GRIPPER_RVIZ:
        alone = GRIPPER_RVIZ.replace("palm", "g_palm").replace(": root", ": g_root")
        assert join([arm, gripper]).rviz.decode() == alone


@pytest.mark.parametrize(
    ("display", "again"),
    [
        ("Image\n  Topic:\n    Value: camera", False),
        ("Image\n  Topic:\n    Value: /other", True),
        ("Axes\n  Reference Frame: palm", True),
        ("Axes\n  Reference Frame: hand", False),
        ("Grid\n  Reference Frame: hand", True),
    ],
)
def test_a_display_is_told_by_class_topic_and_frame(
    display: str, again: bool, tmp_path: Path
) -> None:
    shown = ["Image\n  Topic:\n    Value: /camera", "Axes\n  Reference Frame: hand"]
    for name, displays in (("one", shown), ("other", [display])):
        text = "".join(f"- Class: rviz_default_plugins/{it}\n" for it in displays)
        inside = "".join(f"    {it}" for it in text.splitlines(True))
        head, rest = "Visualization Manager:\n  Displays:\n", "  Global Options: {Fixed Frame: a}\n"
        (tmp_path / f"{name}.rviz").write_text(f"{head}{inside}{rest}")
    arm, gripper = (
        it._replace(rviz=str(tmp_path / f"{name}.rviz"), prefix="", srdf=None)
        for it, name in zip(parts(), ("one", "other"), strict=True)
    )
    made = join([arm, gripper._replace(name="g")])
    assert (b"rviz_common/Group" in made.rviz) == again


SYSTEM = (
    '<ros2_control name="s" type="system"><hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin>'
    '</hardware><joint name="{}"><command_interface name="position"/></joint></ros2_control>'
    '<gazebo><plugin filename="libgz_ros2_control-system.so" '
    'name="gz_ros2_control::GazeboSimROS2ControlPlugin"><parameters> {} </parameters></plugin></gazebo>'
    "</robot>"
)


def test_what_refers_to_files_refers_to_the_new_ones(tmp_path: Path) -> None:
    """One plugin with one file of all controllers; meshes by paths from the new folder."""
    given = []
    for name, text, joint in (("arm", ARM, "turn"), ("hand", GRIPPER, "grip")):
        (tmp_path / name).mkdir()
        path, controllers = tmp_path / name / f"{name}.urdf", tmp_path / name / "c.yaml"
        mesh = text.replace('<box size="1 1 1"/>', '<mesh filename="m/a&amp;b.stl"/>', 1)
        path.write_text(mesh.replace("</robot>", SYSTEM.format(joint, controllers)))
        controllers.write_text(f"{name}:\n  ros__parameters: {{joints: [{joint}]}}\n")
        at = "arm_tool" if given else ""
        given.append(Part(str(path), at, prefix=f"{name}_", controllers=[str(controllers)]))
    made = join(given, output=str(tmp_path / "o/robot.urdf"))
    root = etree.fromstring(made.data)
    files = [(it.text or "").strip() for it in root.iter("parameters")]
    assert files == [str(tmp_path / "o/robot_controllers.yaml")]
    meshes = [it.get("filename") for it in root.iter("mesh")]
    assert meshes == ["../arm/m/a&b.stl", "../hand/m/a&b.stl"]
    assert split(made.data) == {
        Path(str(it.description)).stem: Path(str(it.description)).read_bytes() for it in given
    }
    # What else was edited by hand stays as it is.
    larger = made.data.replace(b'"../hand/m/a&amp;b.stl"', b'"../hand/m/a&amp;b.stl" scale="2 2 2"')
    assert b'<mesh filename="m/a&amp;b.stl" scale="2 2 2"/>' in split(larger)["hand"]
    gone = made.data.replace(b'<mesh filename="../hand/m/a&amp;b.stl"/>', b"")
    with pytest.raises(InputError, match="followed a comment 'multibot was' was edited by hand"):
        split(gone)
    plain = etree.fromstring(join(given).data).iter("parameters")
    assert [(it.text or "").strip() for it in plain] == [
        str(tmp_path / "arm/c.yaml"),
        str(tmp_path / "hand/c.yaml"),
    ]


def test_paths_of_a_text_and_of_what_is_joined_already_stay(tmp_path: Path) -> None:
    text = ARM.replace('<box size="1 1 1"/>', '<mesh filename="m/a.stl"/>', 1)
    for name in ("arm", "hand"):
        (tmp_path / f"{name}.urdf").write_text(text)
    parts = [Part(str(tmp_path / "arm.urdf")), Part(text, "tool", prefix="b_", name="b")]
    made = join(parts, output=str(tmp_path / "o/two.urdf"))
    (tmp_path / "o").mkdir()
    (tmp_path / "o/two.urdf").write_bytes(made.data)
    more = Part(str(tmp_path / "hand.urdf"), "b_tool", prefix="c_")
    whole = join(
        [Part(str(tmp_path / "o/two.urdf")), more], output=str(tmp_path / "p/q/three.urdf")
    )
    meshes = [it.get("filename") for it in etree.fromstring(whole.data).iter("mesh")]
    assert meshes == ["../m/a.stl", "m/a.stl", "../../m/a.stl"]
    assert [it for it in whole.notes if "two.urdf: '../m/a.stl' is looked up from the folder" in it]
    assert set(split(whole.data).values()) == {text.encode()}


def test_both_parts_move_by_what_the_joined_controllers_command(tmp_path: Path) -> None:
    """Each joint of the one controllers' file is driven by a system of the description, and turns."""
    mujoco = pytest.importorskip("mujoco")
    inertia = (
        '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
    )
    parts = []
    for name, text, joint in (("arm", ARM, "turn"), ("hand", GRIPPER, "grip")):
        path = tmp_path / f"{name}.yaml"
        path.write_text(f"{name}:\n  ros__parameters: {{joints: [{joint}]}}\n")
        solid = re.sub(r'(<link name="\w+")(?:/>|>)', rf"\1>{inertia}</inertial>@", text)
        # Without shapes: these are all in one place and would hold each other.
        solid = solid.replace(f"@{SHAPE}", "@").replace("@</link>", "@").replace("@", "</link>")
        whole = solid.replace("</robot>", SYSTEM.format(joint, path))
        at = "arm_tool" if parts else ""
        parts.append(Part(whole, at, prefix=f"{name}_", controllers=[str(path)]))
    made = join(parts, output=str(tmp_path / "robot.urdf"))
    sections = yaml.safe_load(made.controllers)
    commanded = {it for one in sections.values() for it in one["ros__parameters"].get("joints", ())}
    root = etree.fromstring(made.data)
    assert commanded == {it.get("name") for it in root.iterfind("ros2_control/joint")}
    files = [(it.text or "").strip() for it in root.iter("parameters")]
    assert files == [str(tmp_path / "robot_controllers.yaml")]
    for it in (*root.findall("gazebo"), *root.findall("ros2_control")):
        root.remove(it)
    model = mujoco.MjModel.from_xml_string(etree.tostring(root).decode())
    state = mujoco.MjData(model)
    joints = [state.joint(it) for it in sorted(commanded)]
    for it, torque in zip(joints, (2.0, 1.0), strict=True):
        it.qfrc_applied[:] = torque
    for _ in range(20):
        mujoco.mj_step(model, state)
    assert all(abs(it.qpos[0]) > 1e-6 for it in joints)
