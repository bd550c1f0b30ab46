# SPDX-License-Identifier: Apache-2.0
"""Edits that overlap, levels of a configuration, and what some rules make an exception for."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import Edit
from multibot_rewrite.cli.urdf_lint import main
from multibot_rewrite.lint import fix as fixing
from multibot_rewrite.rules.settings import Settings

# What is replaced in ``fixing``: how it lints a text.
LINT = "lint_data"

# Edits that overlap.

LINK = b'<robot name="r"><link name="abcdef"/></robot>'
AT = LINK.index(b"abcdef")
Fix = Callable[..., bytes]


def edit(first: int, last: int, text: bytes) -> Edit:
    """Return the edit that replaces the letters ``first`` to ``last`` of the link's name."""
    return Edit(AT + first, AT + last, text, None)


@pytest.fixture
def fixed(monkeypatch: pytest.MonkeyPatch) -> Fix:
    """Return the link's name after edits of rules that do not exist: what overlaps is found in
    the input alone, so that nothing of it is made in a later round."""

    def run(*edits: Edit) -> bytes:
        def lint(path: str, data: bytes, _: Settings) -> list[Finding]:
            found = edits if data == LINK else ()
            return [Finding("MB142", "note", "m", "", path, 1, 1, edits=(it,)) for it in found]

        monkeypatch.setattr(fixing, LINT, lint)
        text, left = fixing.fix("r.urdf", LINK, Settings())
        assert left == []
        before, after = LINK[:AT], LINK[AT + len(b"abcdef") :]
        assert text.startswith(before) and text.endswith(after)
        return text[len(before) : -len(after)]

    return run


@pytest.mark.parametrize(
    ("edits", "name"),
    [
        pytest.param([edit(0, 1, b"x"), edit(3, 4, b"y")], b"xbcyef", id="apart"),
        pytest.param([edit(3, 4, b"y"), edit(0, 1, b"x")], b"xbcyef", id="the later one first"),
        pytest.param([edit(0, 2, b"x"), edit(2, 4, b"y")], b"xyef", id="side by side"),
        pytest.param([edit(0, 3, b"x"), edit(2, 5, b"y")], b"xdef", id="the end of the first"),
        pytest.param([edit(0, 5, b"x"), edit(1, 2, b"y")], b"xf", id="one in the other"),
        pytest.param([edit(1, 2, b"y"), edit(1, 4, b"x")], b"aycdef", id="from one place"),
        pytest.param([edit(1, 4, b"x"), edit(1, 2, b"y")], b"aycdef", id="in whatever order"),
        pytest.param([edit(1, 3, b"x"), edit(1, 3, b"x")], b"axdef", id="one edit twice"),
        pytest.param(
            [edit(0, 2, b"x"), edit(1, 4, b"y"), edit(3, 6, b"z")], b"xcz", id="a chain of three"
        ),
    ],
)
def test_of_edits_that_overlap_the_first_is_made(
    fixed: Fix, edits: list[Edit], name: bytes
) -> None:
    assert fixed(*edits) == name


# Levels of a configuration, as the command prints them.

TWO_ROOTS = '<robot name="r"><link name="a"/><link name="b"/></robot>'
IDLE = '<robot name="r">\n  <!-- urdf-lint: ignore MB511 -->\n  <link name="a"/>\n</robot>'
TEXTS = {"MB501": TWO_ROOTS, "MB002": IDLE, "MB101": "<robot"}


def linted(folder: Path, levels: str, text: str, *options: str) -> int:
    """Lint a text beside a configuration; gives the exit code."""
    (folder / "urdf-lint.toml").write_text(f"[levels]\n{levels}\n")
    (folder / "r.urdf").write_text(text)
    config = str(folder / "urdf-lint.toml")
    return main([str(folder / "r.urdf"), "--config", config, "--format", "json", *options])


def levels_in(printed: object) -> list[tuple[str, str]]:
    """Code and level of every finding, wherever they are in the JSON."""
    if isinstance(printed, list):
        return [it for inner in printed for it in levels_in(inner)]
    if not isinstance(printed, dict):
        return []
    own = [(printed["code"], printed["level"])] if {"code", "level"} <= printed.keys() else []
    return own + [it for inner in printed.values() for it in levels_in(inner)]


@pytest.mark.sample(1)
@pytest.mark.parametrize("code", TEXTS)
@pytest.mark.parametrize(("level", "exit_code"), [("note", 0), ("warning", 1), ("error", 1)])
def test_a_level_of_the_configuration_is_the_findings(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], code: str, level: str, exit_code: int
) -> None:
    """The exit code follows it, too: warnings and worse make it 1. (The comment of the
    second text suppresses MB511, so it is unused only if MB511 is on.)"""
    assert (
        linted(tmp_path, f'{code} = "{level}"', TEXTS[code], "--select", f"{code},MB511")
        == exit_code
    )
    assert levels_in(json.loads(capsys.readouterr().out)) == [(code, level)]


@pytest.mark.parametrize(
    ("levels", "level"),
    [
        ('MB = "note"', "note"),
        ('MB5 = "note"\nMB501 = "error"', "error"),
        ('MB501 = "note"\nMB5 = "warning"', "note"),
        ('MB6 = "note"', "error"),
    ],
)
def test_the_longest_beginning_of_a_code_gives_the_level(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], levels: str, level: str
) -> None:
    linted(tmp_path, levels, TWO_ROOTS, "--select", "MB501")
    assert levels_in(json.loads(capsys.readouterr().out)) == [("MB501", level)]


@pytest.mark.more
def test_what_fails_a_lint_is_asked_of_the_configurations_level(tmp_path: Path) -> None:
    for level, at, above in (("note", "note", "warning"), ("warning", "warning", "error")):
        given = (tmp_path, f'MB501 = "{level}"', TWO_ROOTS, "--select", "MB501", "--fail-on")
        assert (linted(*given, at), linted(*given, above)) == (1, 0)


# Exceptions of rules.


def lines(
    folder: Path, capsys: pytest.CaptureFixture[str], code: str, body: str, *options: str
) -> list[int]:
    """Return the lines of a robot in which a rule finds something."""
    file = folder / "r.urdf"
    file.write_text(f'<robot name="r">\n{body}</robot>\n')
    capsys.readouterr()
    main([str(file), "--select", code, *options])
    out = capsys.readouterr().out
    found = (line.removeprefix(f"{file}:") for line in out.splitlines() if f" {code} " in line)
    return [int(line.partition(":")[0]) for line in found]


def inertia(ixx: float, iyy: float, izz: float) -> str:
    """Return a link of 1 kg."""
    moments = f'ixx="{ixx}" iyy="{iyy}" izz="{izz}"'
    inside = f'<mass value="1"/>\n<inertia {moments} ixy="0" ixz="0" iyz="0"/>'
    return f'<link name="a">\n<inertial>{inside}</inertial></link>\n'


@pytest.mark.sample(1)
@pytest.mark.parametrize("long", range(3), ids=("ixx", "iyy", "izz"))
def test_each_axis_of_an_inertia_is_looked_at(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], long: int
) -> None:
    """A disc of 1 kg: 6 m about its own axis, 4.2 m about the two others, 5 m being too much."""
    moments = [18.0, 18.0, 18.0]
    assert lines(tmp_path, capsys, "MB608", inertia(*moments)) == []
    moments[long] = 36.0
    assert lines(tmp_path, capsys, "MB608", inertia(*moments)) == [4]


def joint(name: str, inside: str = "", limit: str = 'lower="-1" upper="1"') -> str:
    """Return a revolute joint on one line, without strength."""
    ends = '<parent link="a"/><child link="b"/><axis xyz="0 0 1"/>'
    zero = f'<limit {limit} effort="0" velocity="0"/>'
    return f'<joint name="{name}" type="revolute">{ends}{zero}{inside}</joint>\n'


LINKS = '<link name="a"/><link name="b"/>\n'


@pytest.mark.parametrize(
    ("body", "found"),
    [
        pytest.param(joint("j"), [3], id="a joint that moves by itself"),
        pytest.param(joint("j", '<mimic joint="k"/>'), [], id="one that follows another"),
        pytest.param(joint("j", limit='lower="0" upper="0"'), [], id="one that cannot move"),
        pytest.param(joint("j", '<mimic joint="k"/>') + joint("k"), [4], id="only the follower"),
    ],
)
def test_what_follows_or_stands_still_needs_no_strength(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], body: str, found: list[int]
) -> None:
    assert lines(tmp_path, capsys, "MB515", LINKS + body) == found


# Switches of plugins, as their readers take them.


def plugin(file: str, *switches: tuple[str, str]) -> str:
    inside = "".join(f"<{name}>{value}</{name}>" for name, value in switches)
    return f'<gazebo>\n<plugin name="p" filename="{file}">{inside}</plugin></gazebo>\n'


# Off unless the file switches it on, and the other way round.
DRIVE, PLANAR = "libgazebo_ros_diff_drive.so", "libgazebo_ros_planar_move.so"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("file", "value", "on"),
    [
        (DRIVE, "1", True),
        (DRIVE, "true", True),
        (DRIVE, "True", True),
        (DRIVE, " 1 ", True),
        (DRIVE, "0", False),
        (DRIVE, "false", False),
        (DRIVE, None, False),
        (PLANAR, "1", True),
        (PLANAR, "true", True),
        (PLANAR, "0", False),
        (PLANAR, "False", False),
        (PLANAR, None, True),
    ],
)
def test_a_switch_is_on_where_its_reader_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], file: str, value: str | None, on: bool
) -> None:
    """sdformat reads true, 1, false and 0 in whatever letters (Param.cc, ValueFromStringImpl)."""
    given = [] if value is None else [("publish_odom_tf", value)]
    body = LINKS + plugin(file, *given)
    assert lines(tmp_path, capsys, "MB408", body) == ([4] if on else [])
