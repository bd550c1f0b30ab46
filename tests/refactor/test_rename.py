# SPDX-License-Identifier: Apache-2.0
"""A name of a package is another one everywhere: files written by hand, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite import InputError, UsageError, rename_symbol
from multibot_rewrite.cli.multibot import main

SPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
ROBOT = f"""<robot name="r" {SPACE}>
  <!-- base_link is the root -->
  <xacro:property name="root" value="base_link"/>
  <link name="${{root}}"/>
  <xacro:macro name="wheel" params="side parent">
    <link name="${{side}}_wheel"/>
    <joint name="${{side}}_joint" type="continuous">
      <parent link="${{parent}}"/>
      <child link="${{side}}_wheel"/>
    </joint>
  </xacro:macro>
  <xacro:wheel side="left" parent="base_link"/>
  <xacro:wheel side="right" parent="${{root}}"/>
</robot>
"""
CONTROLLERS = """drive:
  ros__parameters:
    type: diff_drive_controller/DiffDriveController
    left_wheel_names: [left_joint]
    right_wheel_names: [right_joint]
    base_frame_id: base_link  # the root
"""


@pytest.fixture
def package(tmp_path: Path) -> Path:
    (tmp_path / "r.urdf.xacro").write_text(ROBOT)
    (tmp_path / "controllers.yaml").write_text(CONTROLLERS)
    (tmp_path / "node.py").write_text('FRAME = "base_link"\nOTHER = "base_link_2"\n')
    return tmp_path


@pytest.mark.parametrize("mark", ["", "\ufeff"], ids=["plain", "byte order mark"])
def test_a_link_is_renamed_where_it_is_made_and_in_the_files_beside(
    package: Path, mark: str
) -> None:
    (package / "controllers.yaml").write_text(mark + CONTROLLERS)
    made = rename_symbol("base_link", "chassis", str(package))
    robot = ROBOT.replace('value="base_link"', 'value="chassis"').replace(
        'parent="base_link"', 'parent="chassis"'
    )
    assert {Path(path).name: data.decode() for path, data in made.after.items()} == {
        "r.urdf.xacro": robot,
        "controllers.yaml": mark + CONTROLLERS.replace("base_link", "chassis"),
    }
    assert made.places == 3
    assert made.mentions == (f"{package}/node.py:1",)


def test_lines_that_are_left_are_in_the_order_of_their_paths(package: Path) -> None:
    for name in ("zeta", "beta", "kappa", "alpha"):
        (package / name).mkdir()
        (package / name / "n.py").write_text('F = "base_link"\n')
    made = rename_symbol("base_link", "chassis", str(package))
    inside = [f"{package}/{name}/n.py:1" for name in ("alpha", "beta", "kappa", "zeta")]
    assert list(made.mentions) == [f"{package}/node.py:1", *inside]


def test_an_srdf_alone_declares_no_link(tmp_path: Path) -> None:
    (tmp_path / "r.srdf").write_text(
        '<robot name="r"><group name="g"><link name="a"/></group></robot>'
    )
    with pytest.raises(UsageError, match="no description has a link 'a'"):
        rename_symbol("a", "b", str(tmp_path))


def test_what_is_the_same_in_old_and_new_stays(package: Path) -> None:
    """Only ``left`` of ``left_wheel`` is in the call; it makes the joint, too."""
    with pytest.raises(InputError, match=r"makes others, too: .*name=\"front_joint\""):
        rename_symbol("left_wheel", "front_wheel", str(package))
    # Only the end of it, which is in the macro; with one letter more and one less.
    robot = ROBOT.replace('  <xacro:wheel side="right" parent="${root}"/>\n', "")
    for new in ("tire", "wheels", "whee"):
        (package / "r.urdf.xacro").write_text(robot)
        made = rename_symbol("left_wheel", f"left_{new}", str(package))
        (text,) = made.after.values()
        assert text.decode() == robot.replace("}_wheel", f"}}_{new}")


def test_a_name_that_pieces_make_is_refused_with_its_place(package: Path) -> None:
    with pytest.raises(
        InputError, match=r"r.urdf.xacro:12:\d+: 'left_wheel' .* from 'left' and '_wheel'"
    ):
        rename_symbol("left_wheel", "drive", str(package))


def test_a_joint_is_none_of_the_links_that_are_called_so(tmp_path: Path) -> None:
    text = (
        '<robot name="r"><link name="arm"/><link name="a"/><joint name="arm" type="fixed">'
        '<parent link="arm"/><child link="a"/></joint></robot>'
    )
    (tmp_path / "r.urdf").write_text(text)
    made = rename_symbol("arm", "elbow", str(tmp_path), kind="joint")
    assert next(iter(made.after.values())).decode() == text.replace(
        'joint name="arm"', 'joint name="elbow"'
    )


def test_an_srdf_follows_its_urdf(tmp_path: Path) -> None:
    (tmp_path / "r.urdf").write_text('<robot name="r"><link name="a"/></robot>')
    srdf = '<robot name="r"><group name="a"><link name="a"/></group></robot>'
    (tmp_path / "r.srdf").write_text(srdf)
    made = rename_symbol("a", "b", str(tmp_path))
    assert made.after[str(tmp_path / "r.srdf")].decode() == srdf.replace(
        '<link name="a"', '<link name="b"'
    )


def test_a_frame_with_the_name_of_a_link_follows_it(tmp_path: Path) -> None:
    text = (
        '<robot name="r"><link name="base"/><gazebo reference="base">'
        '<sensor name="s" type="imu"><gz_frame_id>base</gz_frame_id></sensor></gazebo><gazebo>'
        '<plugin name="p" filename="libgazebo_ros_p3d.so"><frame_name>base</frame_name></plugin>'
        "</gazebo></robot>"
    )
    (tmp_path / "r.urdf").write_text(text)
    made = rename_symbol("base", "chassis", str(tmp_path))
    assert next(iter(made.after.values())).decode() == text.replace('"base"', '"chassis"').replace(
        ">base<", ">chassis<"
    )


def test_a_frame_is_renamed(tmp_path: Path) -> None:
    text = (
        '<robot name="r"><link name="base"/><gazebo>'
        '<plugin name="p" filename="libgazebo_ros_p3d.so"><frame_name>ground</frame_name></plugin>'
        "</gazebo></robot>"
    )
    (tmp_path / "r.urdf").write_text(text)
    made = rename_symbol("ground", "floor", str(tmp_path), kind="frame")
    assert next(iter(made.after.values())).decode() == text.replace(">ground<", ">floor<")


def test_a_topic_is_renamed(tmp_path: Path) -> None:
    text = (
        f'<robot name="r" {SPACE}><link name="base"/><gazebo reference="base">'
        '<sensor name="s" type="gpu_lidar"><topic>scan</topic></sensor></gazebo></robot>'
    )
    (tmp_path / "r.urdf.xacro").write_text(text)
    made = rename_symbol("scan", "front_scan", str(tmp_path), kind="topic")
    assert next(iter(made.after.values())).decode() == text.replace(">scan<", ">front_scan<")


@pytest.mark.parametrize(
    ("old", "new", "kind", "said"),
    [
        ("base_lin", "x", "link", "has a link 'base_lin'; did you mean 'base_link'?"),
        ("base_link", "left_wheel", "link", "has a link 'left_wheel' already"),
        ("base_link", "base_link", "link", "is called so already"),
        ("base_link", "a b", "link", "'a b' is no name of a link"),
        ("base_link", "x", "wheel", "kind 'wheel' is not known"),
    ],
)
def test_wrong_names_are_refused(package: Path, old: str, new: str, kind: str, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        rename_symbol(old, new, str(package), kind=kind)


@pytest.mark.more
def test_the_command_writes_all_or_shows_it(
    package: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(package)
    words = ["rename", "base_link", "chassis", "."]
    assert main([*words, "--diff", "--color", "never", "-v"]) == 0
    shown = capsys.readouterr()
    assert '-  <xacro:property name="root" value="base_link"/>' in shown.out
    assert "link base_link -> chassis: 3 places in 2 files; proved" in shown.err
    assert "left as they are: 1 line with 'base_link'" in shown.err
    assert "  node.py:1\n" in shown.err
    assert (package / "r.urdf.xacro").read_text() == ROBOT
    assert main(words) == 0
    assert "base_frame_id: chassis" in (package / "controllers.yaml").read_text()
    assert 'value="chassis"' in (package / "r.urdf.xacro").read_text()


DRIVEN = """<robot name="r"><link name="base"/><gazebo>
<plugin name="d" filename="libgazebo_ros_diff_drive.so"><ros><remapping>cmd_vel:=go</remapping>
<remapping>odom:=wheels</remapping></ros><odometry_frame>odom</odometry_frame>
<robot_base_frame>base</robot_base_frame></plugin></gazebo><gazebo reference="arm"/></robot>
"""


@pytest.mark.parametrize(
    ("old", "new", "kind", "taken"),
    [
        ("go", "wheels", "topic", "topic"),
        ("odom", "base", "frame", "link"),
        ("base", "odom", "link", "frame"),
    ],
)
def test_a_name_that_is_only_used_is_taken_too(
    tmp_path: Path, old: str, new: str, kind: str, taken: str
) -> None:
    (tmp_path / "r.urdf").write_text(DRIVEN)
    with pytest.raises(UsageError, match=f"r.urdf has a {taken} '{new}' already"):
        rename_symbol(old, new, str(tmp_path), kind=kind)


def test_a_link_that_is_missed_and_a_name_of_another_robot_are_free(tmp_path: Path) -> None:
    (tmp_path / "r.urdf").write_text(DRIVEN)
    (tmp_path / "other.urdf").write_text('<robot name="other"><link name="palm"/></robot>')
    for new in ("arm", "palm"):
        made = rename_symbol("base", new, str(tmp_path))
        assert [Path(it).name for it in made.after] == ["r.urdf"]
