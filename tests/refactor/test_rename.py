# SPDX-License-Identifier: Apache-2.0
"""A name of a package is another one everywhere: files written by hand, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite import InputError, UsageError, rename_symbol
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.description.sources.trace import Piece
from multibot_rewrite.refactor import source_edits
from multibot_rewrite.refactor.source_edits import SourceEdit, ValueEdit, edited, first_difference

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
    comment = f"{package}/r.urdf.xacro:2"
    assert [it.place for it in made.left] == [f"{package}/node.py:1", comment]


def test_lines_that_are_left_are_in_the_order_of_their_paths(package: Path) -> None:
    for name in ("zeta", "beta", "kappa", "alpha"):
        (package / name).mkdir()
        (package / name / "n.py").write_text('F = "base_link"\n')
    made = rename_symbol("base_link", "chassis", str(package))
    inside = [f"{package}/{name}/n.py:1" for name in ("alpha", "beta", "kappa", "zeta")]
    places = [f"{package}/node.py:1", f"{package}/r.urdf.xacro:2", *inside]
    assert [it.place for it in made.left] == places


def test_lines_are_told_of_every_kind_of_text(package: Path) -> None:
    """Code, and what a package of ROS has beside it; a picture has no lines."""
    kinds = {
        *("py", "yaml", "yml", "xml", "rviz", "lua"),
        *("cpp", "hpp", "h", "xacro", "srdf", "md", "rst", "txt"),
    }  # fmt: skip
    (package / "node.py").unlink()
    for kind in (*kinds, "png"):
        (package / f"a.{kind}").write_text("x(base_link) # base_link2 /base_link\n")
    made = rename_symbol("base_link", "chassis", str(package))
    places = (it.place for it in made.left if "r.urdf" not in it.place)
    assert {it.rpartition(".")[2] for it in places} == {f"{it}:1" for it in kinds}


LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    given = {"frame_id": "base_link", "text": "base_link", "odom": f"{1}/base_link"}
    return LaunchDescription([Node(package="a", executable="b", parameters=[GIVEN])])
"""
XML = '<launch><node pkg="a" exec="b"><param name="frame_id" value="base_link"/></node></launch>'


def test_a_literal_parameter_of_a_launch_file_is_renamed(package: Path) -> None:
    """``text`` is no frame, and what is put together is told."""
    (package / "node.py").unlink()
    (package / "launch").mkdir()
    lines = LAUNCH.splitlines(keepends=True)
    given = lines.pop(4).partition("= ")[2].strip()
    old = "".join(lines).replace("GIVEN", given)
    (package / "launch/a.launch.py").write_text(old)
    (package / "launch/a.launch.xml").write_text(XML)
    # One that cannot be read is left.
    (package / "launch/b.launch.xml").write_text(XML.replace("/><", "><"))
    made = rename_symbol("base_link", "chassis", str(package))
    new = {Path(path).name: data.decode() for path, data in made.after.items()}
    assert new["a.launch.xml"] == XML.replace("base_link", "chassis")
    assert new["a.launch.py"] == old.replace('frame_id": "base_link', 'frame_id": "chassis')
    assert [(it.place, it.why) for it in made.left] == [
        (f"{package}/r.urdf.xacro:2", "it names 'base_link'"),
        (f"{package}/launch/a.launch.py:5", "the launch file names 'base_link'"),
        (f"{package}/launch/b.launch.xml:1", "the launch file names 'base_link'"),
    ]


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


P3D = '<plugin name="p" filename="libgazebo_ros_p3d.so"><frame_name>{}</frame_name></plugin>'
SENSOR = (
    '<link name="base"/><gazebo reference="base"><sensor name="s" type="{}">{}</sensor></gazebo>'
)
# What is renamed, of which kind, and the description with ? where the name is.
OF_KIND = [
    ("arm", "joint", '<link name="arm"/><link name="a"/><joint name="?" type="fixed"><parent link='
     '"arm"/><child link="a"/></joint>'),
    ("base", "link", SENSOR.format("imu", "<gz_frame_id>?</gz_frame_id>").replace('"base"', '"?"')
     + f"<gazebo>{P3D.format('?')}</gazebo>"),
    ("ground", "frame", f'<link name="base"/><gazebo>{P3D.format("?")}</gazebo>'),
    ("scan", "topic", SENSOR.format("gpu_lidar", "<topic>?</topic>")),
]  # fmt: skip


@pytest.mark.parametrize(("old", "kind", "inside"), OF_KIND, ids=[it[1] for it in OF_KIND])
def test_what_is_called_so_and_is_of_the_kind_is_renamed(
    tmp_path: Path, old: str, kind: str, inside: str
) -> None:
    text = f'<robot name="r" {SPACE}>{inside}</robot>'
    (tmp_path / "r.urdf.xacro").write_text(text.replace("?", old))
    made = rename_symbol(old, "another", str(tmp_path), kind=kind)
    assert next(iter(made.after.values())).decode() == text.replace("?", "another")


def test_an_srdf_follows_its_urdf(tmp_path: Path) -> None:
    (tmp_path / "r.urdf").write_text('<robot name="r"><link name="a"/></robot>')
    srdf = '<robot name="r"><group name="a"><link name="a"/></group></robot>'
    (tmp_path / "r.srdf").write_text(srdf)
    made = rename_symbol("a", "b", str(tmp_path))
    assert made.after[str(tmp_path / "r.srdf")].decode() == srdf.replace(
        '<link name="a"', '<link name="b"'
    )


@pytest.mark.parametrize(
    ("old", "new", "kind", "said"),
    [
        ("base_lin", "x", "link", "has a link 'base_lin'; did you mean 'base_link'?"),
        ("base_link", "left_wheel", "link", "has a link 'left_wheel'; give another"),
        ("base_link", "base_link", "link", "has this name already; give another"),
        ("base_link", "a b", "link", "'a b' is no name of a link"),
        ("base_link", "x", "wheel", "kind 'wheel' is not known"),
    ],
)
def test_wrong_names_are_refused(package: Path, old: str, new: str, kind: str, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        rename_symbol(old, new, str(package), kind=kind)
    with pytest.raises(UsageError, match="no xacro has the argument 'size'; leave it out"):
        rename_symbol("base_link", "x", str(package), xacro_args={"size": "1"})


@pytest.mark.more
def test_the_command_writes_all_or_shows_it(
    package: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(package)
    words = ["rename", "base_link", "chassis", "."]
    assert main([*words, "--diff", "--color", "never", "-v"]) == 0
    shown = capsys.readouterr()
    assert '-  <xacro:property name="root" value="base_link"/>' in shown.out
    assert "link base_link -> chassis: 3 places in 2 files; verified" in shown.err
    assert "left as they are: 2 lines with 'base_link'" in shown.err
    assert "  node.py:1: its code names 'base_link'\n" in shown.err
    assert (package / "r.urdf.xacro").read_text() == ROBOT
    assert main(words) == 0
    assert "base_frame_id: chassis" in (package / "controllers.yaml").read_text()
    assert 'value="chassis"' in (package / "r.urdf.xacro").read_text()


DRIVEN = """<robot name="r"><link name="base"/><gazebo>
<plugin name="d" filename="libgazebo_ros_diff_drive.so"><ros><remapping>cmd_vel:=go</remapping>
<remapping>odom:=wheels</remapping></ros><odometry_frame>odom</odometry_frame>
<robot_base_frame>base</robot_base_frame></plugin></gazebo><gazebo reference="arm"/></robot>
"""


BESIDE = {
    "r.srdf": '<robot name="r"><group name="g"><link name="palm"/></group></robot>',
    "other.urdf": '<robot name="other"><link name="palm"/></robot>',
    "own.yaml": "drive:\n  ros__parameters:\n    base_frame_id: palm\n",
    "own.rviz": "Visualization Manager:\n  Global Options:\n    Fixed Frame: palm\n",
    "joint_limits.yaml": "joint_limits:\n  wrist: {has_velocity_limits: true}\n",
}


@pytest.mark.parametrize(
    ("name", "new", "kind", "said"),
    [
        ("r.urdf", "arm", "link", "uses the link 'arm'"),
        ("r.urdf", "wheels", "topic", "has a topic 'wheels'"),
        ("r.urdf", "base", "frame", "has a link 'base'"),
        ("r.urdf", "odom", "link", "has a frame 'odom'"),
        ("r.srdf", "palm", "link", "uses the link 'palm'"),
        ("other.urdf", "palm", "frame", "has a link 'palm'"),
        ("own.yaml", "palm", "link", ":3 uses the link 'palm'"),
        ("own.rviz", "palm", "frame", ":3 uses the frame 'palm'"),
        ("joint_limits.yaml", "wrist", "joint", ":2 uses the joint 'wrist'"),
        ("own.yaml", "palm", "joint", ""),
        ("joint_limits.yaml", "wrist", "link", ""),
        ("own.yaml", "pal", "link", ""),
    ],
)
def test_a_name_that_a_file_of_the_folder_uses_is_taken(
    tmp_path: Path, name: str, new: str, kind: str, said: str
) -> None:
    joint = (
        '<link name="hub"/><joint name="j" type="fixed"><parent link="base"/><child link="hub"/>'
    )
    (tmp_path / "r.urdf").write_text(DRIVEN.replace("</robot>", f"{joint}</joint></robot>"))
    if name in BESIDE:
        (tmp_path / name).write_text(BESIDE[name])
    old = {"link": "base", "joint": "j", "frame": "odom", "topic": "go"}[kind]
    if said:
        with pytest.raises(UsageError) as found:
            rename_symbol(old, new, str(tmp_path), kind=kind)
        assert f"{tmp_path / name}{'' if said[0] == ':' else ' '}{said}; give" in str(found.value)
    else:
        made = rename_symbol(old, new, str(tmp_path), kind=kind)
        assert [Path(it).name for it in made.after] == ["r.urdf"]


@pytest.mark.parametrize(
    ("touched", "why"),
    [
        ([], "an expression makes it"),
        ([Piece("a", "expression")], "an expression makes it"),
        ([Piece("a", "given argument")], "it is a given argument"),
        ([Piece("a", "literal"), Piece("b", "property")], "it is put together from 'a' and 'b'"),
    ],
)
def test_why_no_edit_makes_a_change(touched: list[Piece], why: str) -> None:
    assert source_edits._why_not_edited(touched) == why


@pytest.mark.parametrize(
    ("start", "end", "new", "left"),
    [
        (0, 4, "abcd", (4, 4, "")), (0, 4, "xbcd", (0, 1, "x")), (0, 4, "abcx", (3, 4, "x")),
        (0, 4, "ab", (2, 4, "")), (0, 4, "cd", (0, 2, "")), (0, 2, "abab", (2, 2, "ab")),
        (1, 1, "x", (1, 1, "x")),
    ],
)  # fmt: skip
def test_only_what_differs_is_changed(
    start: int, end: int, new: str, left: tuple[int, int, str]
) -> None:
    assert source_edits._changed_part(ValueEdit(0, "name", "abcd", start, end, new)) == left


def test_edits_are_made_in_their_order_and_do_not_meet() -> None:
    """One edit may begin where another ends; the same one twice is one."""
    edits = [SourceEdit("b", 2, 3, b"2"), SourceEdit("a", 0, 1, b""), SourceEdit("b", 0, 2, b"01")]
    sources = {"a": b"abc", "b": b"abcd", "c": b"abc"}
    assert edited(sources, [*edits, edits[0]]) == {"a": b"bc", "b": b"012d"}
    with pytest.raises(ValueError, match="1"):
        edited(sources, [*edits, SourceEdit("b", 1, 2, b"x")])


@pytest.mark.parametrize(
    ("made", "wanted", "line"),
    [
        (b"a\n b\nc", b"a\n x\nd", "b"), (b"a", b"a", ""), (b"a", None, ""), (b"\xff", b"a", "\ufffd"),
    ],
)  # fmt: skip
def test_the_first_line_that_is_not_the_wanted_one(
    made: bytes, wanted: bytes | None, line: str
) -> None:
    assert first_difference(made, wanted) == line
