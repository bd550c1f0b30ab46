# SPDX-License-Identifier: Apache-2.0
"""The calls that launch files and scripts make: sources, errors, fleets, the list of changes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from multibot_rewrite import (
    DefinitionsError,
    InputError,
    MultibotError,
    RewriteRefused,
    UsageError,
    rewrite,
    rewrite_all,
    strip,
)
from multibot_rewrite.base.naming import LAYOUTS

SMALL = """\
<robot name="rover">
  <link name="base"/>
  <link name="mast"/>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="mast"/></joint>
</robot>
"""
SMALL_R1 = """\
<robot name="rover_r1">
  <link name="base/r1"/>
  <link name="mast/r1"/>
  <joint name="lift_r1" type="prismatic"><parent link="base/r1"/><child link="mast/r1"/></joint>
</robot>
"""
DRIVE = """\
<robot name="rover">
  <link name="base"/>
  <gazebo>
    <plugin name="drive" filename="libgazebo_ros_diff_drive.so"/>
  </gazebo>
</robot>
"""
IMU = """\
<robot name="rover">
  <link name="base"/>
  <gazebo>
    <plugin name="{}" filename="libgazebo_ros_imu_sensor.so">
      <ros><namespace>/front</namespace></ros>
    </plugin>
  </gazebo>
</robot>
"""
TWICE = SMALL.replace("mast", "base")


@pytest.fixture
def path(tmp_path: Path) -> Path:
    file = tmp_path / "rover.urdf"
    file.write_text(SMALL)
    return file


# ---------------------------------------------------------------- sources


@pytest.mark.parametrize(
    "source",
    [
        pytest.param(lambda path: path, id="pathlike"),
        pytest.param(str, id="path"),
        pytest.param(lambda path: SMALL, id="text"),
        pytest.param(lambda path: SMALL.encode(), id="bytes"),
    ],
)
def test_any_source_gives_the_same(
    path: Path, source: Callable[[Path], str | bytes | Path]
) -> None:
    result = rewrite(source(path), "r1")
    assert (result.text, result.data) == (SMALL_R1, SMALL_R1.encode())
    assert (result.robot, result.findings) == ("r1", ())


@pytest.mark.parametrize("head", ["\n \t", "\ufeff", "\ufeff\r\n", "<!-- a comment -->"])
def test_text_may_have_something_before_its_root(head: str) -> None:
    assert rewrite(head + SMALL, "r1").text == head + SMALL_R1


@pytest.mark.more
def test_a_xacro_file_is_expanded(tmp_path: Path) -> None:
    file = tmp_path / "rover.urdf.xacro"
    head = '<robot name="rover" xmlns:xacro="http://ros.org/wiki/xacro">'
    head += '<xacro:arg name="m" default="mast"/>'
    body = SMALL.partition(">")[2].replace('"mast"', '"$(arg m)"')
    file.write_text(head + body)
    assert 'link name="mast/r1"' in rewrite(file, "r1").text
    assert 'link name="pole/r1"' in rewrite(file, "r1", xacro_args={"m": "pole"}).text


def test_xacro_arguments_need_a_xacro_file(path: Path) -> None:
    with pytest.raises(UsageError, match="it is no xacro; leave out"):
        rewrite(path, "r1", xacro_args={"m": "pole"})


@pytest.mark.parametrize(
    ("source", "options", "start"),
    [
        pytest.param(b"<robot>", {}, "<bytes>:", id="bytes"),
        pytest.param("<robot>", {}, "<text>:", id="text"),
        pytest.param("<robot>", {"file": "my.urdf"}, "my.urdf:", id="named"),
        pytest.param("no.urdf", {}, "no.urdf: cannot be read: No such file", id="missing"),
        pytest.param("no.xacro", {}, "no.xacro: cannot be read: No such file", id="missing-xacro"),
        pytest.param(Path(), {}, ".: cannot be read: Is a directory", id="folder"),
        pytest.param("x" * 5000, {}, "x", id="long"),
        pytest.param("a\0b", {}, "", id="nul-in-path"),
        pytest.param('<robot name="\udc80"/>', {}, "<text>:", id="half-a-character"),
    ],
)
def test_what_cannot_be_read_is_named(
    source: str | bytes | Path, options: dict[str, object], start: str
) -> None:
    with pytest.raises(InputError) as caught:
        rewrite(source, "r1", **options)
    assert str(caught.value).startswith(start)


# ---------------------------------------------------------------- errors


@pytest.mark.parametrize(
    ("source", "robot", "options", "error"),
    [
        pytest.param(SMALL, "robot-1", {}, UsageError, id="robot"),
        pytest.param(SMALL, "r1", {"layout": "L9"}, UsageError, id="layout"),
        pytest.param(SMALL, "r1", {"affix": "infix"}, UsageError, id="affix"),
        pytest.param(SMALL, "r1", {"topics": "none"}, UsageError, id="topics"),
        pytest.param(SMALL, "r1", {"separators": {"leg": "_"}}, UsageError, id="kind"),
        pytest.param(SMALL, "r1", {"separators": {"link": "x"}}, UsageError, id="separator"),
        pytest.param(
            SMALL, "r1", {"definitions": ["no.vocab"]}, DefinitionsError, id="definitions"
        ),
        pytest.param("<html/>", "r1", {}, InputError, id="root"),
        pytest.param(SMALL_R1, "r1", {}, RewriteRefused, id="rewritten"),
        pytest.param(TWICE, "r1", {}, RewriteRefused, id="name-twice"),
    ],
)
def test_errors_are_those_the_docstring_names(
    source: str, robot: str, options: dict[str, object], error: type[MultibotError]
) -> None:
    with pytest.raises(error):
        rewrite(source, robot, **options)


def test_a_refusal_carries_its_findings() -> None:
    with pytest.raises(RewriteRefused) as caught:
        rewrite(TWICE, "r1", file="my.urdf")
    (finding,) = caught.value.findings
    place = (finding.code, finding.level, finding.file, finding.line, finding.column)
    assert place == ("MB201", "error", "my.urdf", 3, 3)
    assert str(caught.value) == str(finding)
    assert str(finding).startswith("my.urdf:3:3: error: MB201 link 'base' is declared twice")


def test_findings_are_warnings_in_order() -> None:
    text = SMALL.replace('link="base"', 'link="bsae"').replace("</robot>", "<x y='mast'/></robot>")
    findings = rewrite(text, "r1").findings
    assert [(f.code, f.level, f.line) for f in findings] == [
        ("MB202", "warning", 4),
        ("MB901", "warning", 5),
    ]
    assert "did you mean 'base'?" in str(findings[0])


# ---------------------------------------------------------------- fleets


@pytest.mark.sample(1)
@pytest.mark.parametrize("layout", [layout.name for layout in LAYOUTS])
@pytest.mark.parametrize("source", [SMALL, DRIVE, IMU.format("imu")], ids=["small", "drive", "imu"])
def test_a_fleet_is_as_many_single_calls(source: str, layout: str) -> None:
    fleet = ["r1", "r2", "a", "a_much_longer_name"]
    results = list(rewrite_all(source, fleet, layout=layout))
    single = [rewrite(source, robot, layout=layout) for robot in fleet]
    assert [item.robot for item in results] == fleet
    assert [item.data for item in results] == [item.data for item in single]
    assert [item.changes for item in results] == [item.changes for item in single]


def test_no_robots_make_no_results() -> None:
    assert list(rewrite_all(SMALL, [])) == []


def test_a_fleet_of_one_name_twice_is_refused() -> None:
    with pytest.raises(UsageError, match="'b' is given twice"):
        rewrite_all(SMALL, ["a", "b", "c", "b"])


def test_one_bad_name_stops_the_fleet() -> None:
    with pytest.raises(UsageError, match="'r-2'"):
        rewrite_all(SMALL, ["r1", "r-2"])


def test_a_fleet_is_refused_before_its_first_result() -> None:
    with pytest.raises(RewriteRefused, match="already rewritten for r1"):
        next(rewrite_all(SMALL_R1, ["r2", "r1"]))


SENSOR = """\
<robot name="r"><link name="base"/>
<gazebo reference="base"><sensor name="s" type="ray"><topic>{}</topic></sensor></gazebo>
<gazebo reference="base"><sensor name="t" type="ray"><topic>{}</topic></sensor></gazebo></robot>"""
FRAMES = """\
<robot name="r"><link name="base"/>
<gazebo><plugin name="p" filename="libgazebo_ros_p3d.so"><frame_name>{}</frame_name></plugin>
<plugin name="q" filename="libgazebo_ros_p3d.so"><frame_name>{}</frame_name></plugin>
</gazebo></robot>"""
LINKS = '<robot name="r"><link name="{}"/><link name="{}"/></robot>'
JOINTS = '<robot name="r"><joint name="{}" type="fixed"/><joint name="{}" type="fixed"/></robot>'
NODES = """\
<robot name="r"><link name="base"/>
<gazebo><plugin name="{}" filename="libgazebo_ros_imu_sensor.so"/>
<plugin name="{}" filename="libgazebo_ros_imu_sensor.so"/></gazebo></robot>"""


@pytest.mark.parametrize(
    ("source", "separators"),
    [
        pytest.param(LINKS, {"link": "_"}, id="links"),
        pytest.param(JOINTS, {}, id="joints"),
        pytest.param(NODES, {}, id="nodes"),
        pytest.param(SENSOR, {"topic": "_"}, id="topics"),
        pytest.param(FRAMES, {"frame": "_"}, id="frames"),
    ],
)
def test_robots_whose_names_would_meet_are_refused(source: str, separators: dict[str, str]) -> None:
    text = source.format("arm", "arm_left")
    with pytest.raises(
        RewriteRefused, match=r"MB421 left_b and b would both have the \w+ 'arm_left_b'"
    ):
        next(rewrite_all(text, ["left_b", "b"], separators=separators))


@pytest.mark.parametrize("source", [LINKS, JOINTS, NODES, SENSOR, FRAMES])
def test_robots_whose_names_do_not_meet_are_not_refused(source: str) -> None:
    text = source.format("arm", "leg_left")
    assert len(list(rewrite_all(text, ["left_b", "b"]))) == 2


# ---------------------------------------------------------------- changes


def test_changes_are_listed_in_source_order() -> None:
    assert [tuple(change) for change in rewrite(SMALL, "r1").changes] == [
        (1, 1, "model", "robot@name", "rover", "rover_r1", "element robot"),
        (2, 3, "link", "robot/link@name", "base", "base/r1", "element link"),
        (3, 3, "link", "robot/link@name", "mast", "mast/r1", "element link"),
        (4, 3, "joint", "robot/joint@name", "lift", "lift_r1", "element joint"),
        (4, 39, "link", "robot/joint/parent@link", "base", "base/r1", "element joint"),
        (4, 60, "link", "robot/joint/child@link", "mast", "mast/r1", "element joint"),
    ]


def test_changes_tell_what_was_inserted() -> None:
    changes = rewrite(DRIVE, "r1").changes
    inserted = [(c.line, c.kind, c.old, c.new) for c in changes if c.rule == "inserted"]
    assert sorted(inserted) == [
        (4, "frame", "base_footprint", "base_footprint/r1"),
        (4, "frame", "odom", "odom/r1"),
        (4, "topic", "/tf", "tf/r1"),
        (4, "topic", "cmd_vel", "cmd_vel/r1"),
        (4, "topic", "odom", "odom/r1"),
    ]
    assert {c.path for c in changes if c.rule == "inserted"} == {"robot/gazebo/plugin"}
    assert [c.new for c in changes if c.path.endswith("/plugin@name")] == ["drive_r1"]


def test_nothing_changes_where_only_tf_is_per_robot() -> None:
    result = rewrite(SMALL, "r1", layout="L1")
    assert (result.text, result.changes) == (SMALL, [])


# ---------------------------------------------------------------- once more, and back


@pytest.mark.parametrize(
    ("source", "layouts"),
    [
        pytest.param(SMALL, ("L2", "L3", "L4"), id="small"),
        pytest.param(DRIVE, ("L1", "L2", "L3", "L4"), id="inserted"),
        pytest.param(IMU.format("imu"), ("L1", "L2", "L3", "L4"), id="namespace"),
    ],
)
def test_a_rewritten_file_is_refused(source: str, layouts: tuple[str, ...]) -> None:
    for layout in layouts:
        once = rewrite(source, "r1", layout=layout)
        assert once.changes
        with pytest.raises(RewriteRefused, match=r"MB106 .*already rewritten for r1"):
            rewrite(once.data, "r1", layout=layout)


def test_a_name_that_ends_like_the_robot_is_spelled_twice_only_with_again() -> None:
    text = SMALL.replace('"mast"', '"base/r1"')
    with pytest.raises(RewriteRefused, match="MB106"):
        rewrite(text, "r1")
    assert 'name="base/r1/r1"' in rewrite(text, "r1", again=True).text


def test_a_file_for_another_robot_may_be_rewritten() -> None:
    assert 'name="base/r1/r2"' in rewrite(SMALL_R1, "r2").text


@pytest.mark.parametrize("source", [SMALL, IMU.format("imu")], ids=["small", "imu"])
def test_again_spells_twice_and_strips_twice(source: str) -> None:
    once = rewrite(source, "r1")
    twice = rewrite(once.data, "r1", again=True)
    assert strip(twice.data, "r1") == once.data
    assert strip(once.data, "r1") == source.encode()


@pytest.mark.parametrize("layout", [layout.short for layout in LAYOUTS])
def test_again_is_refused_where_text_was_inserted(layout: str) -> None:
    """Two layers of inserted text could not be told apart."""
    once = rewrite(DRIVE, "r1", layout=layout)
    with pytest.raises(RewriteRefused) as caught:
        rewrite(once.data, "r1", layout=layout, again=True)
    assert [finding.code for finding in caught.value.findings if finding.level == "error"] == [
        "MB106"
    ]


@pytest.mark.parametrize("source", [SMALL, DRIVE, IMU.format("imu")], ids=["small", "drive", "imu"])
@pytest.mark.parametrize(
    ("layout", "side"),
    [
        (layout.short, side)
        for layout in LAYOUTS
        for side in ("postfix", "prefix")
        if side == "prefix" or not layout.at_run_time
    ],
)
def test_strip_gives_the_source_back(source: str, layout: str, side: str) -> None:
    result = rewrite(source, "r1", layout=layout, affix=side)
    assert strip(result.text, "r1", layout=layout, affix=side) == source.encode()


def test_strip_reads_files_too(path: Path) -> None:
    path.write_text(SMALL_R1)
    assert strip(path, "r1") == strip(str(path), "r1") == SMALL.encode()


@pytest.mark.parametrize(
    ("source", "made_with", "taken_with"),
    [
        pytest.param(SMALL, {}, {"affix": "prefix"}, id="affix"),
        pytest.param(SMALL, {}, {"separators": {"link": "_"}}, id="separator"),
        pytest.param(DRIVE, {}, {"layout": "L2"}, id="layout"),
        pytest.param(DRIVE, {"layout": "L3"}, {"layout": "L2"}, id="layout-close"),
        pytest.param(IMU.format("imu"), {"layout": "L4"}, {"layout": "L1"}, id="layout-bare"),
        pytest.param(DRIVE, {}, {"topics": "prefix"}, id="topics"),
        pytest.param(DRIVE, {}, {"shared_topics": ["cmd_vel"]}, id="shared"),
    ],
)
def test_strip_with_other_options_is_refused(
    source: str, made_with: dict[str, object], taken_with: dict[str, object]
) -> None:
    data = rewrite(source, "r1", **made_with).data
    with pytest.raises(RewriteRefused, match=r"MB10[78] "):
        strip(data, "r1", **taken_with)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("data", "robot", "error"),
    [
        pytest.param(SMALL_R1, "r2", RewriteRefused, id="another-robot"),
        pytest.param(SMALL, "r1", RewriteRefused, id="never-rewritten"),
        pytest.param(SMALL_R1.replace("mast/r1", "mast", 1), "r1", RewriteRefused, id="half"),
        pytest.param(SMALL_R1, "r-1", UsageError, id="bad-name"),
        pytest.param("<robot", "r1", InputError, id="not-xml"),
        pytest.param("no.urdf", "r1", InputError, id="missing"),
    ],
)
def test_strip_of_something_else_is_refused(
    data: str, robot: str, error: type[MultibotError]
) -> None:
    with pytest.raises(error):
        strip(data, robot)
