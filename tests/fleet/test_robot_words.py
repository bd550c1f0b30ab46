# SPDX-License-Identifier: Apache-2.0
"""Files that hold the word of a robot already, at their own lines; nothing where it is right."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest
from fleet_folder import SMALL, fleet_folder, mixed, planned_fleet
from paths import CORPUS

from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_file import (
    OutputFile,
    line_in_source,
    path_for,
)


def planned(folder: Path, text: str = SMALL, **files: str) -> FleetPlan:
    return planned_fleet(fleet_folder(folder, text, **files))


def params(value: str) -> str:
    return f"acme:\n  ros__parameters:\n    {value}\n"


def plugin(value: str) -> str:
    key, _, text = value.partition(": ")
    return f"""\
<robot name="rover"><link name="base_link"/><gazebo>
  <plugin name="acme" filename="libacme.so">
    <{key}>{text}</{key}>
  </plugin>
</gazebo></robot>
"""


L1, L4 = SMALL.replace("frames-per-robot", "L1"), SMALL.replace("frames-per-robot", "L4")
L4 = L4.replace("affix: prefix", "affix: postfix")
UNDERSCORES = f"separators: {{link: _}}\n{SMALL}"
# A value that no node or plugin is known to read -> the code of what is wrong with it.
WRONG = {
    "frame-of-another": ("what: robot2/base_link", SMALL, "MB863"),
    "topic-of-another": ("what: /robot2/scan", L1, "MB863"),
    "in-a-list-of-words": ("what: a:=/robot2/scan", L1, "MB863"),
    "postfix-of-another": ("what: base_link/robot2", L4, "MB863"),
    "model-of-another": ("what: /world/w/model/robot2/link", SMALL, "MB863"),
    "twice": ("what: robot1/robot1/odom", SMALL, "MB863"),
    "wrong-separator": ("what: robot1_odom", SMALL, "MB863"),
    "no-separator": ("what: robot1odom", SMALL, "MB863"),
    "no-separator-behind": ("what: base_linkrobot1", L4, "MB863"),
    "slash-for-underscore": ("what: robot1/base_link", UNDERSCORES, "MB863"),
    "own-tf": ("what: /robot1/tf", SMALL, "MB863"),
    "one-tf": ("what: /tf", L1, "MB901"),
}
# What only one of the two has.
IN_PARAMETERS = {
    "frame-prefix": ("frame_prefix: robot1/", SMALL, "MB882"),
    "tf-prefix": ("tf_prefix: rover", SMALL, "MB882"),
}
IN_DESCRIPTION = {
    "bare-odometry": ("odom_frame: odom", SMALL, "MB901"),
    "bare-frame": ("base_frame: base_link", SMALL, "MB901"),
}
OURS = ("MB106", "MB863", "MB901", "MB882")


def found_in(folder: Path, name: str, text: str, **files: str) -> list[tuple[str, int]]:
    found = make_outputs(planned(folder, text, **files)).findings
    return sorted(
        {(it.code, it.line) for it in found if it.file.endswith(name) and it.code in OURS}
    )


@pytest.mark.more
@pytest.mark.sample(4)
@pytest.mark.parametrize("case", [*WRONG, *IN_PARAMETERS])
def test_a_value_of_a_parameter_file_is_told_at_its_line(case: str, tmp_path: Path) -> None:
    value, text, code = {**WRONG, **IN_PARAMETERS}[case]
    assert (code, 3) in found_in(tmp_path, "params.yaml", text, params__yaml=params(value))


@pytest.mark.more
@pytest.mark.sample(4)
@pytest.mark.parametrize("case", [*WRONG, *IN_DESCRIPTION])
def test_a_value_of_a_description_is_told_at_its_line(case: str, tmp_path: Path) -> None:
    value, text, code = {**WRONG, **IN_DESCRIPTION}[case]
    assert (code, 3) in found_in(tmp_path, "rover.urdf", text, rover__urdf=plugin(value))


OWN = """\
layout: frames-per-robot
robots:
  - {name: robot1, description: rover.urdf}
  - {name: robot2, description: own.urdf, related_files: {params: own.yaml}}
"""


@pytest.mark.parametrize(
    ("robot", "files"), [("robot2", set()), ("robot1", {"own.yaml", "own.urdf"})]
)
def test_a_file_of_one_robot_may_name_it(robot: str, files: set[str], tmp_path: Path) -> None:
    (tmp_path / "own.yaml").write_text(params(f"what: {robot}/odom"))
    (tmp_path / "own.urdf").write_text(plugin(f"what: {robot}/odom"))
    found = make_outputs(planned(tmp_path, OWN)).findings
    assert {Path(it.file).name for it in found if it.code == "MB863"} == files


@pytest.mark.more
@pytest.mark.sample(3)
@pytest.mark.parametrize("layout", ["L1", "L2", "L3", "L4"])
@pytest.mark.parametrize("affix", ["prefix", "postfix"])
def test_nothing_is_said_of_a_right_fleet(layout: str, affix: str, tmp_path: Path) -> None:
    found = make_outputs(planned(tmp_path, mixed(layout, affix))).findings
    assert [str(it) for it in found if it.code in OURS] == []


NAMED_ROBOT1 = '<robot name="x"><link name="robot1"/><link name="base_link"/></robot>'


@pytest.mark.more
def test_a_link_called_like_its_robot_hides_no_fault(tmp_path: Path) -> None:
    files = {"rover__urdf": NAMED_ROBOT1, "params__yaml": params("what: robot1/base_link")}
    assert ("MB863", 3) in found_in(tmp_path, "params.yaml", SMALL, **files)


def test_the_line_is_that_of_the_source_behind_inserted_ones(tmp_path: Path) -> None:
    source = tmp_path / "a.yaml"
    source.write_text("a: 1\nb: 2\nc: 3\n")
    file = OutputFile("r/a.yaml", b"new: 0\na: 1\nb: r2\nmore: 1\nc: 3\n", (str(source),))
    found = [line_in_source(file, at) for at in (1, 2, 3, 4, 5, 6)]
    assert found == [(str(source), at) for at in (1, 1, 2, 2, 3, 1)]
    gone = OutputFile("r/b.yaml", b"a: 1\nb: 2\n", (str(tmp_path / "b.yaml"), str(source)))
    assert line_in_source(gone, 2) == (str(tmp_path / "b.yaml"), 1)
    # Of lines that took the place of fewer, the last one.
    fewer = OutputFile("r/a.yaml", b"a: 1\nx\ny\nz\nc: 3\n", (str(source),))
    assert [line_in_source(fewer, at)[1] for at in (2, 3, 4, 5)] == [2, 2, 2, 3]


ALIKE = {
    "params": ("w/a/nav/p.yaml", "w/b/nav/p.yaml", "w/c/p.yaml", "w/q.yaml"),
    "rviz": ("w/r.rviz",),
}


@pytest.mark.parametrize(
    ("source", "path"),
    [
        ("w/q.yaml", "r/q.yaml"), ("w/a/nav/p.yaml", "r/a/nav/p.yaml"),
        ("w/b/nav/p.yaml", "r/b/nav/p.yaml"), ("w/c/p.yaml", "r/c/p.yaml"),
        # It is none of the robot's files, and one that its vendor wants elsewhere.
        ("w/z/p.yaml", "r/p.yaml"), ("w/r.rviz", "r/config/r.rviz"),
    ],
)  # fmt: skip
def test_files_of_one_name_are_in_as_many_folders_as_tell_them_apart(
    source: str, path: str
) -> None:
    places = (("r.rviz", "config/r.rviz"),)
    robot = SimpleNamespace(spec=SimpleNamespace(name="r", related_files=ALIKE, places=places))
    assert path_for(robot, source) == path  # type: ignore[arg-type]


@pytest.mark.more
@pytest.mark.sample(4)
@pytest.mark.parametrize("layout", ["L2", "L1", "L3", "L4"])
def test_nothing_is_found_in_what_real_files_become(layout: str, tmp_path: Path) -> None:
    params = sorted((CORPUS / "nav2_params").rglob("*.yaml"))
    urdfs = sorted((CORPUS / "urdf").rglob("*.urdf"))
    if not params or not urdfs:
        pytest.skip(f"no corpus of real files: looked in {CORPUS}")
    looked_at, told = 0, []
    for at, file in enumerate(params[:: len(params) // 12]):
        text = f"layout: {layout}\naffix: prefix\nnode_sets: nav2\ndescription: {urdfs[at * 80]}\n"
        text += f"related_files: {{params: {file}}}\nrobots: [{{name: rob_a}}, {{name: rob_b}}]\n"
        try:
            made = make_outputs(planned(tmp_path, text))
        except MultibotError:
            continue
        looked_at += 1
        told += [it for it in made.findings if it.code in ("MB863", "MB882")]
    assert looked_at > 3
    assert told == []
