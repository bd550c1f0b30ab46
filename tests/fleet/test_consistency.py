"""What is found in files that were made: faults are planted in them; right ones have none."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import pytest
from fleet_folder import PARAMS, SMALL, fleet_folder, mixed
from paths import CORPUS

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.fleet.build import Outputs, make_outputs
from multibot_rewrite.fleet.checks.consistency import consistency
from multibot_rewrite.fleet.checks.doubled_names import doubled, twice
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.fleet.fleet_plan import FleetPlan, plan_fleet
from multibot_rewrite.fleet.outputs.output_values import OutputText, line_in_source, values_in
from multibot_rewrite.fleet.robots.with_start_pose_nodes import with_start_pose_nodes

PARENTS = """\
layout: L2
affix: prefix
description: rover.urdf
robots: [{name: r1}, {name: r2}]
"""


def planned(folder: Path, text: str = SMALL, **files: str) -> FleetPlan:
    return plan_fleet(read_fleet(str(fleet_folder(folder, text, **files)), "", {}))


def written(made: Outputs) -> list[OutputText]:
    return [OutputText(it.path, it.data.decode(), it.sources) for it in made.files]


def looked(plan: FleetPlan, files: Iterable[OutputText]) -> list[Finding]:
    return list(consistency(plan, with_start_pose_nodes(plan), list(files)))


def planted(folder: Path, path: str, old: str, new: str, text: str = SMALL) -> list[Finding]:
    """What is found once ``old`` is ``new`` in one of the files that are made."""
    plan = planned(folder, text)
    files = written(make_outputs(plan))
    assert [it for it in files if it.path == path and old in it.text], path
    changed = [
        it._replace(text=it.text.replace(old, new, 1)) if it.path == path else it for it in files
    ]
    return looked(plan, changed)


@pytest.mark.parametrize("layout", ["L1", "L2", "L3", "L4"])
@pytest.mark.parametrize("affix", ["prefix", "postfix"])
def test_what_is_made_is_right(layout: str, affix: str, tmp_path: Path) -> None:
    plan = planned(tmp_path, mixed(layout, affix))
    assert looked(plan, written(make_outputs(plan))) == []


IMU = """\
<sdf version="1.9"><model name="cart"><link name="base_link"><sensor name="imu" type="imu">
  <topic>imu</topic>
</sensor></link></model></sdf>
"""


@pytest.mark.parametrize("affix", ["prefix", "postfix"])
def test_a_topic_that_is_called_as_a_sensor_is_right(affix: str, tmp_path: Path) -> None:
    """robot1/imu is the topic; the sensor of that name is robot1_imu."""
    path = tmp_path / "cart.sdf"
    path.write_text(IMU)
    robots = f"robots: [{{name: robot1, description: {path}}}]"
    plan = planned(tmp_path, f"layout: frames-per-robot\naffix: {affix}\n{robots}\n")
    files = written(make_outputs(plan))
    assert any("<topic>robot1/imu</topic>" in it.text for it in files)
    assert [it for it in looked(plan, files) if it.code == "MF604"] == []
    wrong = [
        it._replace(text=it.text.replace("<topic>robot1/imu", "<topic>robot1-imu")) for it in files
    ]
    assert [it.code for it in looked(plan, wrong)] == ["MF604"]


L1, L4 = SMALL.replace("frames-per-robot", "L1"), SMALL.replace("frames-per-robot", "L4")
L4 = L4.replace("affix: prefix", "affix: postfix")
UNDERSCORES = f"separators: {{link: _}}\n{SMALL}"
PLANTED = {
    "frame-of-another": ("robot1/params.yaml", "robot1/base_link", "robot2/base_link", SMALL, "MF602"),
    "topic-of-another": ("robot1/params.yaml", "/robot1/amcl", "/robot2/amcl", SMALL, "MF602"),
    "in-the-second": ("robot2/params.yaml", "robot2/odom", "robot1/odom", SMALL, "MF602"),
    "link-of-another": ("robot2/rover.urdf", 'e="robot2/base_l', 'e="robot1/base_l', SMALL, "MF602"),
    "joint-of-another": ("robot2/rover.urdf", "robot2_lidar", "robot1_lidar", SMALL, "MF602"),
    "postfix-of-another": ("robot1/params.yaml", "base_link/robot1", "base_link/robot2", L4, "MF602"),
    "namespace-of-another": ("robot1/params.yaml", "/robot1/amcl", "/robot2/amcl", L1, "MF602"),
    "prefix-twice": ("robot1/params.yaml", "robot1/odom", "robot1/robot1/odom", SMALL, "MF603"),
    "postfix-twice": ("robot1/params.yaml", "odom/robot1", "odom/robot1/robot1", L4, "MF603"),
    "namespace-twice": ("robot1/params.yaml", "/robot1/amcl", "/robot1/robot1/amcl", L1, "MF603"),
    "link-twice": ("robot1/rover.urdf", "robot1/lidar", "robot1/robot1/lidar", SMALL, "MF603"),
    "joint-twice": ("robot1/rover.urdf", "robot1_lidar", "robot1_robot1_lidar", SMALL, "MF603"),
    "in-the-file-of-all": ("one_robot.rviz", "/robot1/scan", "/robot1/robot1/scan", SMALL, "MF603"),
    "frame-prefix": (
        "robot1/params.yaml",
        "    base_frame_id",
        "    frame_prefix: robot1/\n    base_frame_id",
        SMALL,
        "MF603",
    ),
    "tf-frame-prefix": (
        "robot1/params.yaml",
        "    base_frame_id",
        "    tf_frame_prefix_enable: true\n    base_frame_id",
        SMALL,
        "MF603",
    ),
    "no-separator": ("robot1/params.yaml", "robot1/odom", "robot1odom", SMALL, "MF604"),
    "wrong-separator": ("robot1/params.yaml", "robot1/odom", "robot1_odom", SMALL, "MF604"),
    "slash-for-underscore": ("robot1/params.yaml", "robot1_base", "robot1/base", UNDERSCORES, "MF604"),
    "no-separator-behind": ("robot1/params.yaml", "base_link/robot1", "base_linkrobot1", L4, "MF604"),
    "bare-frame": ("robot1/params.yaml", "robot1/base_link", "base_link", SMALL, "MF605"),
    "bare-odometry": ("robot1/params.yaml", "robot1/odom", "odom", SMALL, "MF605"),
    "one-tf": ("robot1/params.yaml", "scan_topic: scan", "tf_topic: /tf", L1, "MF606"),
    "own-tf": ("robot1/params.yaml", "scan_topic: scan", "tf_topic: /robot1/tf", SMALL, "MF606"),
}  # fmt: skip


@pytest.mark.parametrize("case", PLANTED)
def test_a_fault_in_a_file_is_found_with_its_line(case: str, tmp_path: Path) -> None:
    path, old, new, text, code = PLANTED[case]
    found = planted(tmp_path, path, old, new, text)
    assert [it.code for it in found] == [code], found
    key = new.removeprefix("    ").partition(":")[0] if "\n" in new else ""
    assert (key or new.split()[-1].strip('e="')) in found[0].message
    source = "one_robot.rviz" if path.endswith("rviz") else path.partition("/")[2]
    assert Path(found[0].file).name == source
    assert found[0].line > 1
    assert "multibot" not in found[0].message
    assert found[0].hint


@pytest.mark.parametrize(
    ("old", "new"),
    [
        pytest.param("# its base", "# robot2/base_link, robot1odom", id="comment"),
        pytest.param("scan_topic: scan", "map_file: /maps/robot2/site.yaml", id="file"),
        pytest.param("scan_topic: scan", "url: package://robot2/meshes/a.stl", id="package"),
        pytest.param("scan_topic: scan", "x: $(find-pkg-share robot2)/params", id="substitution"),
        pytest.param("scan_topic: scan", "scan_topic: robot1_front/scan", id="another-word"),
        pytest.param("scan_topic: scan", "plugin: base_link", id="no-frame"),
        pytest.param("scan_topic: scan", "odom_topic: odom", id="topic"),
    ],
)
def test_what_is_no_fault(old: str, new: str, tmp_path: Path) -> None:
    assert planted(tmp_path, "robot1/params.yaml", old, new) == []


def test_many_lines_of_one_fault_are_one_finding(tmp_path: Path) -> None:
    plan = planned(tmp_path)
    files = [
        it._replace(text=it.text.replace("robot1/", "robot2/")) if it.path == "robot1/params.yaml"
        else it for it in written(make_outputs(plan))
    ]  # fmt: skip
    (found,) = looked(plan, files)
    assert "the same in 2 more lines" in found.message


def test_what_a_companion_reported_is_not_reported_again(tmp_path: Path) -> None:
    params = PARAMS.replace("scan_topic: scan", "scan_topic: /robot2/scan")
    made = make_outputs(planned(tmp_path, SMALL, params__yaml=params))
    assert [it.code for it in made.findings if it.level == "error"] == ["MB863"]


def test_the_line_is_that_of_the_source_behind_inserted_ones(tmp_path: Path) -> None:
    source = tmp_path / "a.yaml"
    source.write_text("a: 1\nb: 2\nc: 3\n")
    file = OutputText("r/a.yaml", "new: 0\na: 1\nb: r2\nmore: 1\nc: 3\n", (str(source),))
    lines = [line_in_source(file, at)[1] for at in (2, 3, 5)]
    assert lines == [1, 2, 3]


def test_values_of_each_format() -> None:
    yaml_ = OutputText("a.yaml", "a: {b: [1, x]}\n'c': \"d\"\n", ())
    assert [tuple(it) for it in values_in(yaml_)] == [
        ("a", "a", True, 1), ("b", "b", True, 1), ("1", "b", False, 1), ("x", "b", False, 1),
        ("c", "c", True, 2), ("d", "c", False, 2),
    ]  # fmt: skip
    xml = OutputText("a.urdf", '<a>\n<b c="d">e</b></a>', ())
    assert [tuple(it) for it in values_in(xml)] == [("d", "c", False, 2), ("e", "b", False, 2)]
    assert [it.text for it in values_in(OutputText("a.md", "one\ntwo\n", ()))] == ["one", "two"]
    assert list(values_in(OutputText("a.yaml", "# nothing\n", ()))) == []


@pytest.mark.parametrize(
    ("token", "word"),
    [
        ("r1/r1/a", "r1"), ("a/r1/r1", "r1"), ("r1_r1_a", "r1"), ("x/r1_r1", "r1"),
        ("r1/a/r1", ""), ("r11/r11", ""), ("ar1/r1b", ""), ("r1/r12", ""), ("r1", ""),
    ],
)  # fmt: skip
def test_twice_in_a_name(token: str, word: str) -> None:
    assert twice(token, ("r1",)) == word


@pytest.mark.parametrize(
    ("token", "word"),
    [
        ("robot1_robot1_lamp", "robot1"), ("robot1/robot1_lamp", "robot1"), ("robot1/lamp", ""),
        ("left/left_scan", ""), ("left_left_scan", ""), ("left/left/scan", "left"),
        ("left_left_base_link", "left"), ("/left/left_base_link", "left"), ("left/left_wheel", ""),
    ],
)  # fmt: skip
def test_a_name_that_holds_its_robot_once_too_often(token: str, word: str) -> None:
    words, right, bare = ("robot1", "left"), {"left/left_wheel", "robot1/robot1"}, {"base_link"}
    assert doubled(token, words, right, {*bare, "wheel"}) == word
    assert doubled("/robot1/robot1", words, right, bare) == ""


def test_a_robot_whose_link_is_called_like_it_is_no_fault(tmp_path: Path) -> None:
    rover = '<robot name="x"><link name="robot1"/></robot>'
    plan = planned(tmp_path, PARENTS.replace("r1", "robot1"), rover__urdf=rover)
    made = make_outputs(plan)
    assert "robot1/robot1" in next(it.data for it in made.files if "robot1/" in it.path).decode()
    assert looked(plan, written(made)) == []


NAMED_ROBOT1 = '<robot name="x"><link name="robot1"/><link name="base_link"/></robot>'


def test_a_link_called_like_its_robot_hides_no_fault(tmp_path: Path) -> None:
    plan = planned(tmp_path, PARENTS.replace("r1", "robot1"), rover__urdf=NAMED_ROBOT1)
    files = written(make_outputs(plan))
    wrong = [
        it._replace(text=it.text.replace("robot1/base_link", "robot1/robot1/base_link"))
        for it in files
    ]
    assert [it.code for it in looked(plan, wrong)] == ["MF603"]


PARTS = """\
<robot name="rover">
  <link name="base_link"/>
  <link name="left_wheel"/>
  <joint name="axle" type="fixed"><parent link="base_link"/><child link="left_wheel"/></joint>
  <gazebo reference="base_link">
    <sensor name="lidar" type="gpu_lidar"><topic>left_scan</topic></sensor>
  </gazebo>
</robot>
"""
SIDES = """\
layout: LAYOUT
affix: prefix
separators: {link: _}
description: rover.urdf
robots: [{name: left}, {name: right}]
companions: {params: params.yaml}
"""
OWN_SCAN = "collision_monitor:\n  ros__parameters: {scan: {type: scan, topic: /left_scan}}\n"


@pytest.mark.parametrize("layout", ["L1", "L2", "L3", "L4"])
def test_a_part_called_like_its_robot_is_no_fault(layout: str, tmp_path: Path) -> None:
    text = SIDES.replace("LAYOUT", layout)
    plan = planned(tmp_path, text, rover__urdf=PARTS, params__yaml=OWN_SCAN)
    made = make_outputs(plan)
    params = next(it.data.decode() for it in made.files if it.path == "left/params.yaml")
    assert "/left/left_scan" in params
    assert [it for it in made.findings if it.code in ("MB106", "MF603")] == []


@pytest.mark.parametrize(
    "name", ["left_left_base_link", "left/left_base_link", "left/left/lamp", "/left/left/lamp"]
)
def test_a_robot_called_like_a_part_twice_in_a_name(name: str, tmp_path: Path) -> None:
    params = f"{OWN_SCAN}acme: {{ros__parameters: {{it: WRONG}}}}\n"
    text = SIDES.replace("LAYOUT", "L2")
    plan = planned(tmp_path, text, rover__urdf=PARTS, params__yaml=params)
    files = written(make_outputs(plan))
    wrong = [
        it._replace(text=it.text.replace("WRONG", name if it.path.startswith("left") else "x"))
        for it in files
    ]
    assert [it.code for it in looked(plan, wrong)] == ["MF603"]


def test_an_author_s_own_prefix_in_a_parameter_is_an_error(tmp_path: Path) -> None:
    """The parameter's own finding is a warning: it names no frame."""
    params = "amcl: {ros__parameters: {base_frame_id: left_base_link}}\n"
    text = SIDES.replace("LAYOUT", "L2")
    made = make_outputs(planned(tmp_path, text, rover__urdf=PARTS, params__yaml=params))
    levels = {it.code: it.level for it in made.findings}
    assert (levels["MF603"], levels["MB853"]) == ("error", "warning")


# ---------------------------------------------------------------- parents


def test_two_nodes_that_send_one_frame(tmp_path: Path) -> None:
    params = (
        "amcl: {ros__parameters: {odom_frame_id: odom}}\n"
        "slam_toolbox:\n  ros__parameters: {odom_frame: odom, map_frame: map}\n"
    )
    text = f"stack: [localization, nav2_slam]\ncompanions: {{params: params.yaml}}\n{PARENTS}"
    plan = planned(tmp_path, text, params__yaml=params)
    found = [it for it in make_outputs(plan).findings if it.code == "MG408"]
    assert len(found) == 1
    assert found[0].message == "several nodes send map -> r1/odom on /tf"
    assert "/r1/amcl, /r1/slam_toolbox" in found[0].hint
    assert (Path(found[0].file).name, found[0].line) == ("params.yaml", 2)


FILTER = (
    "ekf_filter_node:\n  ros__parameters: {odom_frame: odom, base_link_frame: lidar_link, MORE}\n"
)


@pytest.mark.parametrize(
    ("more", "said"),
    [
        pytest.param("world_frame: odom", ["r1/base_link and r1/odom"], id="two-parents"),
        pytest.param("world_frame: odom, publish_tf: false", [], id="switched-off"),
        pytest.param("world_frame: map, map_frame: map", [], id="filters-the-map"),
    ],
)
def test_what_a_parameter_file_says_is_sent(more: str, said: list[str], tmp_path: Path) -> None:
    text = f"stack: robot_localization\ncompanions: {{params: params.yaml}}\n{PARENTS}"
    plan = planned(tmp_path, text, params__yaml=FILTER.replace("MORE", more))
    found = [it for it in make_outputs(plan).findings if it.code == "MG401"]
    assert [said[0] in it.message for it in found] == [True] * len(said)


GZ_DRIVE = """<robot name="rover"><link name="base_link"/><gazebo>
<plugin name="gz::sim::systems::DiffDrive" filename="gz-sim-diff-drive-system"/></gazebo></robot>"""


@pytest.mark.parametrize(
    ("more", "frames"),
    [("", ["r1/base_link"]), (", publish_tf: false", []), (", base_link_frame: mast", [])],
)
def test_the_drive_of_the_simulator_and_a_filter(
    more: str, frames: list[str], tmp_path: Path
) -> None:
    params = f"ekf_filter_node:\n  ros__parameters: {{odom_frame: odom, world_frame: odom{more}}}\n"
    text = f"stack: robot_localization\ncompanions: {{params: params.yaml}}\n{PARENTS}"
    plan = planned(tmp_path, text, params__yaml=params, rover__urdf=GZ_DRIVE)
    found = [it for it in make_outputs(plan).findings if it.code == "MG408"]
    assert [it.names[0] for it in found if "/r1/ros_gz_bridge" in it.hint] == frames


def test_two_robots_that_send_a_shared_frame_on_one_topic(tmp_path: Path) -> None:
    text = f"stack: nav2\nshared_frames: [map, odom]\n{PARENTS}"
    (found,) = [it for it in make_outputs(planned(tmp_path, text)).findings if it.code == "MG408"]
    assert (found.message, found.level) == ("several nodes send map -> odom on /tf", "error")
    assert "/r1/amcl, /r2/amcl" in found.hint
    apart = text.replace("layout: L2", "layout: L3")
    assert not [it for it in make_outputs(planned(tmp_path, apart)).findings if it.code == "MG408"]


# ---------------------------------------------------------------- real files


@pytest.mark.parametrize("layout", ["L1", "L2", "L3", "L4"])
def test_nothing_is_found_in_what_real_files_become(layout: str, tmp_path: Path) -> None:
    params = sorted((CORPUS / "nav2_params").rglob("*.yaml"))
    urdfs = sorted((CORPUS / "urdf").rglob("*.urdf"))
    if not params or not urdfs:
        pytest.skip(f"no corpus of real files: looked in {CORPUS}")
    looked_at, told = 0, []
    for at, file in enumerate(params[:: len(params) // 12]):
        text = f"layout: {layout}\naffix: prefix\nstack: nav2\ndescription: {urdfs[at * 80]}\n"
        text += f"companions: {{params: {file}}}\nrobots: [{{name: rob_a}}, {{name: rob_b}}]\n"
        try:
            made = make_outputs(planned(tmp_path, text))
        except MultibotError:
            continue
        looked_at += 1
        told += [it for it in made.findings if it.code.startswith("MF6")]
    assert looked_at > 3
    assert told == []
