# SPDX-License-Identifier: Apache-2.0
"""One file beside a description is rewritten without a fleet, by the library and the command."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from paths import CORPUS

from multibot_rewrite import InputError, UsageError, rewrite_file, rewrite_files
from multibot_rewrite.cli.urdf_postfix import main

ROVER = """\
<robot name="rover">
  <link name="base_link"/><link name="base_footprint"/><link name="base_scan"/>
  <joint name="a" type="fixed"><parent link="base_link"/><child link="base_scan"/></joint>
  <joint name="b" type="fixed"><parent link="base_link"/><child link="base_footprint"/></joint>
  <link name="w"/>
  <joint name="wheel" type="continuous"><parent link="base_link"/><child link="w"/></joint>
</robot>
"""
NAV = "amcl:\n  ros__parameters:\n    base_frame_id: base_footprint\n    scan_topic: scan\n"
ROW = "- {}: {}\n  ros_type_name: rosgraph_msgs/msg/Clock\n  gz_type_name: gz.msgs.Clock\n"
TREE = '<root BTCPP_format="4"><BehaviorTree ID="M"><X {}/></BehaviorTree></root>'
MOVEIT = "joint_limits:\n  {}: {{max_velocity: 1.0}}\n"
VIEW = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Axes
      Reference Frame: {}
  Global Options: {{Fixed Frame: map}}
"""
# Kind of a file, its text for one robot, and what it has for robot1 in frames-per-robot.
FILES = {
    "params": (NAV, "base_frame_id: robot1/base_footprint"),
    "params in braces": (
        "{amcl: {ros__parameters: {base_frame_id: base_link}}}",
        "robot1/base_link",
    ),
    "moveit": (MOVEIT.format("wheel"), "robot1_wheel: {max_velocity: 1.0}"),
    "moveit by a value": (
        "controller_list:\n  - {name: a, joints: [wheel]}\n",
        "joints: [robot1_wheel]",
    ),
    "bridge": (ROW.format("topic_name", "scan"), "topic_name: /robot1/scan"),
    "bridge of a model": (ROW.format("topic_name", "/model/x/odometry"), "/model/robot1/odometry"),
    "rviz": (VIEW.format("base_scan"), "Reference Frame: robot1/base_scan"),
    "tree": (TREE.format('robot_base_frame="base_link"'), 'robot_base_frame="robot1/base_link"'),
    "lua": (
        'options = {\n  tracking_frame = "base_link",\n}\n',
        'tracking_frame = "robot1/base_link"',
    ),
}
BOTH = {"layout": "both", "affix": "prefix"}


@pytest.mark.parametrize("name", FILES)
def test_a_file_is_told_by_its_text(name: str) -> None:
    text, line = FILES[name]
    policy = {"layout": "frames-per-robot", "affix": "prefix"}
    made = rewrite_file(text.encode(), "robot1", urdf=ROVER, **policy)
    assert made.kind == name.partition(" ")[0]
    assert line in made.text
    assert made.findings == () and made.not_verified == ()


HINT = "name a description, parameters, a tree, or a file of RViz, MoveIt, ros_gz_bridge or Lua"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (b"a: b\n", f"f.yaml:1:1: it is none of the files that are rewritten; {HINT}"),
        (b" \n", "f.yaml: the file is empty; a robot description starts with <robot>"),
        (b"robots: [a]\n", ""),
        (b"\x00", ""),
    ],
)
def test_what_is_no_such_file_is_refused(text: bytes, said: str) -> None:
    with pytest.raises(InputError) as found:
        rewrite_file(text, "robot1", urdf=ROVER, file="f.yaml")
    assert said in ("", str(found.value)) and str(found.value).startswith("f.yaml")


def test_a_description_is_asked_for_only_where_names_rest_on_it() -> None:
    with pytest.raises(UsageError, match="frame 'base_footprint'; give the robot's description"):
        rewrite_file(NAV.encode(), "robot1", layout="both")
    bare = rewrite_file(NAV.encode(), "robot1", layout="tf-per-robot")
    assert "base_frame_id: base_footprint" in bare.text and bare.text.startswith("/robot1/amcl:")
    everybodys = rewrite_file(
        NAV.replace("base_footprint", "map").encode(), "robot1", layout="both"
    )
    assert "base_frame_id: map" in everybodys.text
    row = rewrite_file(ROW.format("topic_name", "scan").encode(), "robot1", layout="both")
    assert "/robot1/scan" in row.text


def test_a_name_that_stays_is_not_called_proved() -> None:
    """rcl reads a block with its line break: the frame is not that of the robot."""
    block = NAV.replace("base_frame_id: base_footprint", "base_frame_id: |\n      base_footprint")
    made = rewrite_file(block.encode(), "robot1", urdf=ROVER, layout="both")
    assert made.not_verified == ("1 frame in no description", "1 name in a block of text")


def test_the_command_writes_a_file_for_each(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "rover.urdf").write_text(ROVER)
    (tmp_path / "nav.yaml").write_text(NAV)
    out = str(tmp_path / "{robot}.yaml")
    given = [
        str(tmp_path / "nav.yaml"),
        "a",
        "b",
        "--urdf",
        str(tmp_path / "rover.urdf"),
        "-o",
        out,
    ]
    assert main([*given, "--layout", "both", "--affix", "prefix"]) == 0
    assert "2 robots: rewrote a parameter file. Verified" in capsys.readouterr().err
    for robot in "ab":
        section = yaml.safe_load((tmp_path / f"{robot}.yaml").read_text())[f"/{robot}/amcl"]
        assert section["ros__parameters"]["base_frame_id"] == f"{robot}/base_footprint"


@pytest.mark.parametrize("option", ["--undo", "--output-kind=changes"])
def test_options_of_descriptions_are_refused(
    option: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "nav.yaml").write_text(NAV)
    assert main([str(tmp_path / "nav.yaml"), "a", option]) == 2
    assert "is for descriptions" in capsys.readouterr().err


def test_why_and_a_missing_output_speak_of_the_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """``--why`` read it as XML, and the hint of several robots named a URDF."""
    (tmp_path / "nav.yaml").write_text(NAV)
    assert main(["--why", f"{tmp_path / 'nav.yaml'}:3"]) == 2
    assert "--why is for descriptions" in capsys.readouterr().err
    assert main([str(tmp_path / "nav.yaml"), "a", "b"]) == 2
    assert "-o 'out/{robot}.yaml'" in capsys.readouterr().err


def test_a_robots_name_in_it_stops(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "nav.yaml").write_text(NAV.replace("scan\n", "/a/scan\n"))
    assert main([str(tmp_path / "nav.yaml"), "a", "--layout", "tf-per-robot"]) == 1
    assert "MB863" in capsys.readouterr().err


FOLDERS = {
    "nav2_params": "params",
    "localization_params": "params",
    "ros_gz_bridge": "bridge",
    "rviz": "rviz",
    "moveit": "moveit",
}


@pytest.mark.more
@pytest.mark.sample(4)
@pytest.mark.parametrize("folder", FOLDERS)
def test_real_files_are_rewritten_or_refused_with_a_reason(folder: str) -> None:
    paths = [it for it in sorted((CORPUS / folder).rglob("*")) if it.suffix in (".yaml", ".rviz")]
    if not paths:
        pytest.skip(f"no public files in {CORPUS / folder}")
    kinds = []
    for path in paths[::12]:
        try:
            one, other = rewrite_files(path, ["zorba", "quux"], urdf=ROVER, **BOTH)
        except InputError as error:
            assert str(error).startswith(str(path))
            continue
        kinds.append(one.kind)
        read = yaml.safe_load(one.text) if one.kind not in ("rviz", "moveit") else True
        assert read is not None or not one.text.strip()
        assert one.text.replace("zorba", "quux") == other.text or one.kind in ("bridge", "rviz")
    usual = max(set(kinds), key=kinds.count)
    assert usual == FOLDERS[folder] and len(kinds) > len(paths[::12]) / 4
