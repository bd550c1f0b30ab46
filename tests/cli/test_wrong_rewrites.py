# SPDX-License-Identifier: Apache-2.0
"""What urdf-postfix is not asked for: each wrong use is one line, and no file changes."""

from __future__ import annotations

import io
import shlex
from pathlib import Path
from typing import Any

import pytest
from paths import ROBOTS
from postfix_command import contents

from multibot_rewrite.cli import urdf_postfix

ROVER = (ROBOTS / "rover.urdf").read_bytes()
# What stands after urdf-postfix -> what its one line has.
WRONG = (
    ("", ("no INPUT and no ROBOT given; see urdf-postfix --help",)),
    ("'' a", ("the name of the input is empty",)),
    ("r.urdf", ("no robot name given; for example: urdf-postfix r.urdf robot1\n",)),
    ("r.urdf --undo", ("for example: urdf-postfix r.urdf robot1 --undo\n",)),
    ("r.urdf a:=b", ("no robot name given",)),
    ("robot1 robot2 r.urdf", ("the file comes first: urdf-postfix r.urdf robot1 robot2\n",)),
    # Names of robots.
    ("r.urdf robot-1", ("'robot-1'", "'-'", "'robot_1'")),
    ("r.urdf 1st", ("'1st'", "digit '1'", "'robot_1st'")),
    ("r.urdf ''", ("''", "empty", "'robot1'")),
    ("r.urdf a/b", ("'a/b'", "'/'", "'a_b'")),
    ("r.urdf a::b", ("'a::b'", "':'", "'a_b'")),
    ("r.urdf 'a b'", ("'a b'", "' '", "'a_b'")),
    ("r.urdf größe", ("'ö'", "'gr_e'")),
    (f"r.urdf {'r' * 300}", ("300 characters", "245")),
    ("r.urdf a b a -o {robot}", ("'a'", "twice")),
    ("r.urdf a b-2 -o {robot}", ("'b-2'", "'b_2'")),
    # Options of the naming.
    ("r.urdf r --layout per-robot", ("'per-robot'", "tf-per-robot")),
    ("r.urdf r --affix postfx", ("'postfx'", "did you mean 'postfix'")),
    ("r.urdf r --topics global", ("'global'", "namespace")),
    ("r.urdf r --separator lnk=_", ("'lnk'", "'link'")),
    ("r.urdf r --separator link=%", ("link='%'", "use one of /")),
    ("r.urdf r --separator link=", ("link=''", "use one of /")),
    ("r.urdf r --separator link", ("KIND=SEP", "link=_")),
    ("r.urdf r --bogus", ("--bogus", "--help")),
    ("r.urdf r --lay L1", ("--lay", "--help")),
    ("r.urdf r --layout", ("--layout", "expected one")),
    # What exclude each other.
    *((f"r.urdf a b {it}", ("--undo and --in-place take one robot at a time\n",))
      for it in ("--undo -o {robot}", "--in-place")),
    ("r.urdf a --format json",
     ("--format json prints the findings; name a file for the result with -o\n",)),
    ("r.urdf a -o x --in-place", ("give --output or --in-place, not both\n",)),
    *((f"r.urdf a --diff {it}",
       ("--diff prints to standard output: leave out --output and --in-place\n",))
      for it in ("-o x", "--in-place")),
    ("r.urdf a --xacro r.xacro",
     ("--xacro goes with --undo; to rewrite a xacro, name it as the INPUT\n",)),
    *((f"r.urdf a --output-kind changes --{it}",
       (f"--output-kind changes lists what a rewrite changes: leave out --{it}\n",))
      for it in ("undo", "in-place", "diff")),
    *((f"{it} a --in-place", ("--in-place needs a URDF file, not standard input or xacro\n",))
      for it in ("-", "r.xacro", "r.urdf.xacro")),
    *((f"{it} x:=1", (f"{name} is no xacro: leave out NAME:=VALUE\n",))
      for it, name in (("r.urdf a", "r.urdf"), ("- a", "<stdin>"), ("r.urdf a --undo", "r.urdf"))),
    # Where the result goes.
    ("r.urdf a -o ''", ("-o/--output: the name is empty",)),
    ("r.urdf a -o {name}.urdf", ("unknown placeholder {name}, only {robot} is filled in\n",)),
    ("r.urdf a b -o {robot}/{n}", ("unknown placeholder {n}, only {robot} is filled in\n",)),
    ("r.urdf a --output-kind changes -o {robot}.json",
     ("--output {robot}.json: unknown placeholder {robot}, one file serves all robots\n",)),
    ("r.urdf a b -o o", ("several robots need one file each", "{robot}")),
    *((f"{it} a b", (f"several robots need one file each: -o out/, or -o 'out/{{robot}}{end}'\n",))
      for it, end in (("r.urdf", ".urdf"), ("r.sdf", ".sdf"), ("-", ".urdf"))),
    ("one.rviz a b -o two.rviz",
     ("-o 'out/{robot}.rviz'; multibot build writes one for all robots\n",)),
    # Files of plugin definitions.
    ("r.urdf a --definitions my.vocab", ("my.vocab", "is not there")),
    ("r.urdf a --definitions .", (".", "cannot be read")),
    ("r.urdf a --definitions r.urdf", ("r.urdf:1:", "[section]")),
)  # fmt: skip


@pytest.mark.parametrize(("line", "words"), WRONG, ids=[it[:60] for it, _ in WRONG])
def test_a_rewrite_that_cannot_be_meant(
    line: str, words: tuple[str, ...], here: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(ROVER)))
    for name in ("r.urdf", "r.sdf", "r.xacro", "r.urdf.xacro", "one.rviz"):
        Path(name).write_bytes(ROVER)
    before = contents(here)
    try:
        code = urdf_postfix.main(shlex.split(line))
    except SystemExit as end:
        code = int(str(end.code))
    told = capsys.readouterr()
    assert (code, told.out, told.err.count("\n")) == (2, "", 1)
    assert told.err.startswith("urdf-postfix: ")
    assert [it for it in words if it not in told.err] == []
    assert contents(here) == before
