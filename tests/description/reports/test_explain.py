# SPDX-License-Identifier: Apache-2.0
"""``--why FILE:LINE``: which rewriter claims a value, why, and what it becomes."""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import FIXTURES, fixture_text

from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.cli.urdf_postfix import main
from multibot_rewrite.description.library import explain

ROVER = FIXTURES / "robots" / "rover.urdf"
ROBOT = fixture_text("explain_robot.urdf")
SRDF = '<robot name="rover">\n<group name="all">\n<link name="base"/>\n</group></robot>'


@pytest.mark.parametrize(
    ("line", "path", "options", "words"),
    [
        pytest.param(8, "odometry_frame", {}, "a shared frame", id="shared-frame"),
        pytest.param(
            5, "gazebo@reference", {}, "not declared, so it is not renamed", id="dangling"
        ),
        pytest.param(9, "robot_base_frame", {"layout": "L1"}, "does not rename links", id="layout"),
    ],
)
def test_a_value_that_stays_says_why(line: int, path: str, options: dict, words: str) -> None:
    found = {item.path: item for item in explain(ROBOT, line, **options)}
    (item,) = (item for name, item in found.items() if name.endswith(path))
    assert words in item.reason
    assert item.new == item.value


def test_an_empty_element_that_is_filled_says_what_empty_means() -> None:
    text = ROBOT.replace("</plugin>", "\n<ros>\n<namespace/></ros></plugin>", 1)
    line = next(at for at, row in enumerate(text.split("\n"), 1) if "<namespace/>" in row)
    (item,) = explain(text, line, layout="L1")
    assert (item.path.rpartition("]/")[2], item.column) == ("ros/namespace", 1)
    assert item.inserted == ("<namespace>/robot1</namespace>",)
    assert "read as '/'" in item.reason
    assert not [
        it for at in range(line) for it in explain(text, at, layout="L1") if "filled" in it.reason
    ]


def test_an_srdf_is_explained_beside_its_urdf() -> None:
    (item,) = explain(SRDF, 3, urdf=ROBOT)
    assert (item.reason, item.new) == ("link 'base', declared at line 2 of the URDF", "base/robot1")
    with pytest.raises(InputError, match="with its URDF"):
        explain(SRDF, 3)


@pytest.mark.slow
def test_every_claim_of_a_real_robot_is_explained_at_its_line() -> None:
    text = ROVER.read_text()
    for number in range(1, text.count("\n") + 1):
        for item in explain(text, number):
            assert item.line == number
            assert item.inserted or item.value.strip() in text.split("\n")[number - 1]


# Line of ROBOT -> words of each kind of value: as it is, kept, of nobody, and what is put in.
PRINTED = {
    4: ("kept by [element joint] ", ": an enumeration: revolute, fixed"),
    7: ("] gets for bob: ", "    <remapping>cmd_vel:=cmd_vel/bob</remapping>"),
    8: ("claimed by [plugin gazebo_ros_diff_drive] ", "  stays as it is"),
    11: ("  value: 'laser'\n  claimed by no rewriter: it holds the name 'laser'",),
}


def test_the_command_prints_each_kind_of_value(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "r.urdf").write_text(ROBOT)
    for line, words in PRINTED.items():
        assert main(["--why", f"{tmp_path}/r.urdf:{line}", "bob"]) == 0
        out = capsys.readouterr().out
        assert [it for it in words if it not in out] == [], out
    assert "claimed by" not in out.replace("claimed by no rewriter", "")


@pytest.mark.parametrize(
    ("place", "words"),
    [
        pytest.param("{}", "write FILE:LINE", id="no-line"),
        pytest.param("{}:x", "write FILE:LINE", id="no-number"),
        pytest.param(":3", "write FILE:LINE", id="no-file"),
        pytest.param("{}:99999", "no value starts on this line", id="past-the-end"),
        pytest.param("{}.gone:1", "cannot be read", id="no-such-file"),
    ],
)
def test_bad_places_are_one_line(
    place: str, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "a.urdf").write_text(ROBOT)
    assert main(["--why", place.format(tmp_path / "a.urdf")]) == 2
    err = capsys.readouterr().err
    assert words in err
    assert err.count("\n") == 1


def test_a_robot_name_is_checked() -> None:
    with pytest.raises(UsageError):
        explain(ROBOT, 2, "1st")


def test_a_line_of_a_xacro_says_which_pieces_make_its_names(tmp_path: Path) -> None:
    path = tmp_path / "r.urdf.xacro"
    path.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '<xacro:arg name="p" default=""/>\n'
        '<xacro:macro name="wheel" params="side">\n'
        '<link name="$(arg p)${side}_wheel${1 + 1}"/>\n'
        "</xacro:macro>\n"
        '<xacro:wheel side="left"/><xacro:wheel side="right"/>\n'
        "</robot>"
    )
    found = explain(str(path), 4, xacro_args={"p": "my_"})
    assert [(it.line, it.column, it.value, it.new) for it in found] == [
        (4, 1, "my_left_wheel2", "my_left_wheel2/robot1"),
        (4, 1, "my_right_wheel2", "my_right_wheel2/robot1"),
    ]
    assert found[1].made_of == (
        "'my_' (argument p that was given)",
        f"'right' (parameter, {path}:6:46)",
        f"'_wheel' (literal, {path}:4:28)",
        f"'2' (${{1 + 1}}, {path}:4:34)",
    )
    assert [(it.line, it.column, it.value) for it in explain(str(path), 6)] == [
        (6, 20, "left_wheel2"),
        (6, 46, "right_wheel2"),
    ]
    assert explain(str(path), 5) == []


def test_a_line_of_a_file_that_others_include_is_told_in_one_of_them(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    head, (part, whole, other) = (
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n',
        (tmp_path / name for name in ("a.xacro", "b.xacro", "c.xacro")),
    )
    part.write_text(
        f'{head}<xacro:property name="end" value="tip"/>\n'
        '<xacro:macro name="arm" params="p">\n<link name="${p}${end}"/>\n</xacro:macro>\n</robot>'
    )
    include = '<xacro:include filename="a.xacro"/>\n'
    other.write_text(f"{head}{include}<link name='tip'/></robot>")
    whole.write_text(f'{head}{include}<xacro:arm p="my_"/></robot>')
    for line, column in ((2, 35), (4, 1)):
        (it,) = explain(str(part), line)
        assert (it.line, it.column, it.value, it.within) == (line, column, "my_tip", str(whole))
    assert explain(str(whole), 3)[0].within == ""
    assert main(["--why", f"{part}:4"]) == 0
    assert capsys.readouterr().out.startswith(f"{part}:4:1: robot/link@name, of {whole}\n")
    assert explain(str(part), 3) == []
    whole.write_text(f"{head}{include}<xacro:gone/></robot>")
    other.write_text(f"{head}{include}<xacro:gone/></robot>")
    assert explain(str(part), 4) == []
