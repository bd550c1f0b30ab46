# SPDX-License-Identifier: Apache-2.0
"""What adopt cannot read or change is one line, with the place and what to do; nothing is written."""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import write_files

from multibot_rewrite import adopt
from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.cli.multibot import main

SPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'


def robot(inside: str, name: str = ' name="r"') -> str:
    return f'<robot{name} {SPACE}><link name="base"/>{inside}</robot>'


TAKEN = "".join(
    f'<xacro:arg name="{it}" default="x"/>'
    for it in ("prefix", "robot_prefix", "tf_prefix", "name_prefix")
)
# The files of a package -> what the line says, of what and what to do.
REFUSED = {
    "a macro that calls itself": (
        {"r.urdf.xacro": robot('<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>')},
        ("in the macro 'm' that line 1", "leads back to itself"),
    ),
    "an include that is not there": (
        {"r.urdf.xacro": robot('<xacro:include filename="none.xacro"/>')},
        ("none.xacro", "check the path"),
    ),
    "a package that is not there": (
        {"r.urdf.xacro": robot('<xacro:include filename="$(find nowhere)/a.xacro"/>')},
        ("package 'nowhere' is not found", "source"),
    ),
    "text that is no XML": (
        {"r.urdf.xacro": '<robot name="r"><link'},
        ("unclosed token", "correct the XML"),
    ),
    "entities": (
        {
            "r.urdf.xacro": '<!DOCTYPE r [<!ENTITY a "b">]><robot name="r"><link name="&a;"/></robot>'
        },
        ("entities are not accepted", "expand them"),
    ),
    "every name of the argument in use": (
        {"r.urdf.xacro": robot(TAKEN)},
        ("are all taken by its xacro arguments or properties: rename one",),
    ),
    "a file of macros": (
        {"r.xacro": robot("").replace('<link name="base"/>', '<xacro:macro name="m"/>')},
        ("r.xacro: it has no link; it defines macros; give the file that has the robot",),
    ),
    "an empty file": ({"r.urdf.xacro": ""}, ("there is no description of a robot",)),
    "an SDF alone": (
        {"m.sdf": '<sdf version="1.9"><model name="m"><link name="l"/></model></sdf>'},
        ("there is no description of a robot",),
    ),
}


@pytest.mark.sample(3)
@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_is_one_line(
    case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files, said = REFUSED[case]
    write_files(tmp_path, files)
    assert main(["adopt", str(tmp_path), "--in-place"]) == 2
    out, line = capsys.readouterr()
    assert (out, line.count("\n")) == ("", 1)
    for it in said:
        assert it in line
    assert {it.name: it.read_text() for it in tmp_path.iterdir()} == files


def test_a_name_that_python_makes_gets_the_prefix_where_it_is_used(tmp_path: Path) -> None:
    made_by = "<xacro:macro name='m' params='n'>{}</xacro:macro><xacro:m n='1'/>"
    link = "<link name=\"{}${{'_'.join(['arm', str(n)])}}\"/>"
    path = tmp_path / "r.urdf.xacro"
    path.write_text(robot(made_by.format(link.format(""))))
    made = adopt(str(tmp_path))
    assert link.format("${prefix}") in made.after[str(path)].decode()
    assert made.left == ()


def test_one_bad_description_of_two_is_told_and_the_other_adopted(tmp_path: Path) -> None:
    (tmp_path / "r.urdf.xacro").write_text(robot(""))
    bad = tmp_path / "bad.urdf.xacro"
    bad.write_text(robot('<xacro:include filename="bad.urdf.xacro"/>'))
    made = adopt(str(tmp_path))
    assert (made.verified, list(made.unread)) == ((str(tmp_path / "r.urdf.xacro"),), [str(bad)])


def test_a_folder_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(MultibotError, match="there is no such file or folder"):
        adopt(str(tmp_path / "none"))
