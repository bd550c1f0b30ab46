# SPDX-License-Identifier: Apache-2.0
"""Findings in xacro: the place in the source, the calls that led there, the arguments, packages."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

import pytest
from lint_calls import ArgumentSet, Settings, lint_files
from no_workers import lint_in_this_process

from multibot_rewrite.base.findings.finding import NOTE, Finding
from multibot_rewrite.cli.urdf_lint import main
from multibot_rewrite.lint.files.included import included

SPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
TAKES_SIM = '<xacro:arg name="sim" default=""/>'
LOST = '<joint name="j" type="fixed"><parent link="gone"/><child link="a"/></joint>'
MACRO = '<xacro:macro name="arm" params="side">\n  <link name="${side}_arm"/>\n</xacro:macro>'
MANIFEST = "<package><name>%s</name></package>"


@pytest.fixture(autouse=True)
def without_workers(monkeypatch: pytest.MonkeyPatch) -> None:
    lint_in_this_process(monkeypatch)


def xacro(body: str, name: str = "r") -> str:
    return f"<robot{f' name={name!r}' if name else ''} {SPACE}>\n{body}\n</robot>\n"


def write(folder: Path, files: Mapping[str, str | bytes]) -> None:
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())


# Notes: the file was not checked, or is a part that hangs on a link of another.
NOTES = ("MB145", "MB119", "MB202")


def linted(folder: Path, *paths: str, **settings: object) -> list[Finding]:
    """All findings that fail or say that a file was not read, of files named relative to the folder,
    linted from there."""
    before = Path.cwd()
    os.chdir(folder)
    try:
        chosen = Settings(**{"select": ("MB1", "MB2", "MB501"), **settings})  # type: ignore[arg-type]
        return [it for it in lint_files(paths, chosen) if it.level != NOTE or it.code in NOTES]
    finally:
        os.chdir(before)


def places(found: list[Finding]) -> list[tuple[str, str, int, int]]:
    return [(it.code, it.file, it.line, it.column) for it in found]


def one(folder: Path, files: Mapping[str, str | bytes], *paths: str, **options: object) -> Finding:
    write(folder, files)
    (found,) = linted(folder, *(paths or files), **options)
    return found


# ---------------------------------------------------------------- where

PARTS = {
    "plain": ("r.xacro", 'a<!--\n-->\n  <link name="a"/> ' + LOST, 4, 57),
    "umlauts": ("r.xacro", "<link name='äöü'/> <!-- äöü --> " + LOST.replace('"a"', "'äöü'"), 2, 70),
    "if": ("r.xacro", f'<link name="a"/>\n<xacro:if value="1">\n {LOST}\n</xacro:if>', 4, 39),
    "attribute": ("r.xacro", '<link name="a"/>\n<joint name="j"\n type="fixed">\n'
                  '<parent\n  link="gone"/><child link="a"/></joint>', 6, 3),
    "crlf": ("r.xacro", f'<link name="a"/>\r\n\r\n{LOST}', 4, 38),
}  # fmt: skip


@pytest.mark.sample(1)
@pytest.mark.parametrize("case", PARTS)
def test_line_and_column_are_those_of_the_source(tmp_path: Path, case: str) -> None:
    name, body, line, column = PARTS[case]
    found = one(tmp_path, {name: xacro(body)}, select=("MB202",))
    assert (found.file, found.line, found.column, found.calls) == (name, line, column, ())


def test_a_macro_is_told_with_its_calls(tmp_path: Path) -> None:
    files = {
        "robot.xacro": xacro(
            '<xacro:include filename="parts/arms.xacro"/>\n'
            '<link name="base"/>\n<xacro:arms of="base"/>'
        ),
        "parts/arms.xacro": xacro(
            '<xacro:include filename="arm.xacro"/>\n'
            '<xacro:macro name="arms" params="of">\n\n<xacro:arm side="left"/></xacro:macro>',
            "",
        ),
        "parts/arm.xacro": xacro(MACRO, ""),
    }
    found = one(tmp_path, files, select=("MB501",))
    assert places([found]) == [("MB501", "parts/arm.xacro", 3, 9)]
    assert found.calls == ("parts/arms.xacro:5: arm", "robot.xacro:4: arms")


def test_what_a_second_call_repeats_is_one_finding(tmp_path: Path) -> None:
    macro = (
        '<xacro:macro name="m"><link name="a"/>\n<link name="b"/>\n<link name="c"/></xacro:macro>'
    )
    body = f'{macro}\n<xacro:m/>\n<xacro:m/>\n<link name="x"/><link name="x"/>'
    write(tmp_path, {"r.xacro": xacro(body)})
    first, other = linted(tmp_path, "r.xacro", select=("MB201",))
    assert first.message == "link 'a' is declared twice, and so are 2 more from the same call"
    assert (first.line, first.calls) == (2, ("r.xacro:6: m",))
    assert (other.message, other.line) == ("link 'x' is declared twice", 7)


def test_inner_calls_are_the_cause_where_the_outer_one_is_the_same(tmp_path: Path) -> None:
    macros = (
        '<xacro:macro name="wheel" params="n"><link name="w${n}"/><link name="t${n}"/></xacro:macro>'
        '<xacro:macro name="base">\n<xacro:wheel n="1"/>\n<xacro:wheel n="1"/>\n'
        '<xacro:wheel n="2"/>\n<xacro:wheel n="2"/></xacro:macro>'
    )
    write(tmp_path, {"r.xacro": xacro(f"{macros}\n<xacro:base/>")})
    # Two causes, in one place of the macro: reported once, with both counted.
    (found,) = linted(tmp_path, "r.xacro", select=("MB201",))
    assert found.calls[0] == "r.xacro:4: wheel"
    assert "and so is 1 more" in found.message and "and 1 more from other calls" in found.hint


# ---------------------------------------------------------------- arguments

SIM = (
    '<xacro:arg name="sim" default="none"/>\n<link name="a"/>\n'
    "<xacro:if value=\"${'$(arg sim)' == 'gz'}\">" + LOST + "</xacro:if>"
)


def sets(*given: tuple[str, Mapping[str, str]]) -> tuple[ArgumentSet, ...]:
    return tuple(ArgumentSet(pattern, tuple(args.items())) for pattern, args in given)


def test_each_set_of_arguments_is_linted_beside_the_default_one(tmp_path: Path) -> None:
    given = sets(("*", {"sim": "gz"}), ("other*", {"sim": "x"}), ("*", {"sim": "none"}))
    found = one(tmp_path, {"r.xacro": xacro(SIM)}, arguments=given)
    assert (found.code, found.line, found.arguments) == ("MB202", 4, "sim:=gz")


def test_what_all_of_them_have_is_told_once_and_without_arguments(tmp_path: Path) -> None:
    given = sets(("*", {"sim": "gz"}))
    found = one(tmp_path, {"r.xacro": xacro(f'{TAKES_SIM}<link name="a"/>{LOST}')}, arguments=given)
    assert found.arguments == ""


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({}, [("MB145", "")]),
        ({"side": "left"}, []),
        ({"other": "left"}, [("MB145", "other:=left")]),
    ],
)
def test_an_argument_without_default(
    tmp_path: Path, given: Mapping[str, str], expected: list[tuple[str, str]]
) -> None:
    write(tmp_path, {"r.xacro": xacro('<link name="$(arg side)"/>')})
    found = linted(tmp_path, "r.xacro", arguments=sets(("*", given)) if given else ())
    assert [(it.code, it.arguments) for it in found] == expected


@pytest.mark.more
def test_arguments_on_the_command_line_and_in_the_configuration(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(here, {"r.xacro": xacro(SIM)})
    asked = ("--quiet", "--select", "MB202", "--fail-on", "note")
    assert main(["r.xacro", *asked]) == 0
    assert main(["r.xacro", "sim:=gz", *asked]) == 1
    said = capsys.readouterr().out
    assert "which is not declared" in said and said.endswith(" [with sim:=gz]\n")
    (here / "urdf-lint.toml").write_text('[[xacro]]\narguments = {sim = "gz"}\n')
    assert main(["r.xacro", *asked]) == 1
    assert capsys.readouterr().out == said


# ---------------------------------------------------------------- parts and packages


@pytest.mark.sample(1)
@pytest.mark.parametrize("space", ["", "  "])
@pytest.mark.parametrize(
    "part",
    [
        f"<robot {SPACE}>{LOST}<link name='b'/></robot>",
        f"<robot name='p' {SPACE}>{LOST}<link name='b'/></robot>",
        f"<parts {SPACE}><link name='b'/>{LOST}</parts>",
    ],
    ids=["nameless", "named", "other-root"],
)
def test_a_part_is_judged_where_it_is_included(tmp_path: Path, part: str, space: str) -> None:
    """It may use what the whole declares, and its root be called anything."""
    include = f'<xacro:include {space}filename="p.xacro"/>'
    joint = '<joint name="k" type="fixed"><parent link="a"/><child link="b"/></joint>'
    links = '<link name="a"/><link name="gone"/>'
    write(tmp_path, {"r.xacro": xacro(include + joint + links), "p.xacro": part})
    assert linted(tmp_path, "p.xacro", "r.xacro") == []
    assert linted(tmp_path, "p.xacro") != [] or "name" not in part


def packages(tmp_path: Path) -> None:
    """Two packages of one repository, one in another folder, one that does not exist."""
    part = xacro(f"<link name='a'/>{LOST}", "")
    write(
        tmp_path,
        {
            "ws/robot/package.xml": MANIFEST % "robot",
            "ws/robot/urdf/own.xacro": xacro('<xacro:include filename="$(find robot)/p.xacro"/>'),
            "ws/robot/urdf/next.xacro": xacro('<xacro:include filename="$(find parts)/p.xacro"/>'),
            "ws/robot/urdf/far.xacro": xacro('<xacro:include filename="$(find far)/p.xacro"/>'),
            "ws/robot/p.xacro": part,
            "ws/some/deeper/package.xml": MANIFEST % "parts",
            "ws/some/deeper/p.xacro": part,
            "elsewhere/far/package.xml": MANIFEST % "far",
            "elsewhere/far/p.xacro": part,
        },
    )


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("name", "roots", "expected"),
    [
        ("own", (), "ws/robot/p.xacro"),
        ("next", (), "ws/some/deeper/p.xacro"),
        ("far", ("elsewhere",), "elsewhere/far/p.xacro"),
    ],
)
def test_packages_are_found_without_ros(
    tmp_path: Path,
    name: str,
    roots: tuple[str, ...],
    expected: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for variable in ("AMENT_PREFIX_PATH", "ROS_PACKAGE_PATH"):
        monkeypatch.delenv(variable, raising=False)
    packages(tmp_path)
    folders = tuple(str(tmp_path / it) for it in roots)
    (found,) = linted(tmp_path, f"ws/robot/urdf/{name}.xacro", select=("MB202",), readable=folders)
    assert (found.code, found.file) == ("MB202", expected)
    whole = str(tmp_path / f"ws/robot/urdf/{name}.xacro")
    (found,) = linted(tmp_path, whole, select=("MB202",), readable=folders)
    assert found.file == str(tmp_path / expected)
    os.makedirs(tmp_path / "ws" / "here", exist_ok=True)
    (found,) = linted(
        tmp_path / "ws" / "here", f"../robot/urdf/{name}.xacro", select=("MB202",), readable=folders
    )
    above = str(tmp_path / expected) if roots else os.path.join("..", expected[3:])
    assert found.file == above


def test_a_part_whose_name_is_filled_in_is_judged_where_it_is_included(tmp_path: Path) -> None:
    include = '<xacro:include filename="parts/rover_$(arg kind)_parts.xacro"/>'
    write(tmp_path, {"r.xacro": xacro(include)})
    part = xacro('<link name="${name}_part"/>')
    write(tmp_path, {f"parts/rover_{it}_parts.xacro": part for it in ("lidar", "camera")})
    write(tmp_path, {"parts/other.xacro": part})
    parts = {str(tmp_path / f"parts/rover_{it}_parts.xacro") for it in ("lidar", "camera")}
    assert included([str(it) for it in tmp_path.rglob("*.xacro")]) == parts


@pytest.mark.parametrize(
    ("include", "parts"),
    [
        ("parts/arm.xacro", ["parts/arm.xacro"]), ("arm.xacro", ["arm.xacro", "parts/arm.xacro"]),
        ("./parts/../parts/arm.xacro", ["parts/arm.xacro"]),
        ("$(find acme)/parts/arm.xacro", ["parts/arm.xacro"]),
        ("$(arg at)/arm.xacro", ["arm.xacro", "parts/arm.xacro"]),
        # The name of a folder that is filled in is not known.
        ("${kind}_b/arm.xacro", ["arm.xacro", "parts/arm.xacro"]),
        ("${kind}_b/parts/arm.xacro", ["parts/arm.xacro"]),
        # A value may end with a slash; another beginning is another file.
        ("$(arg at)arm.xacro", ["arm.xacro", "parts/arm.xacro"]),
        ("$(arg a)${b}arm.xacro", ["arm.xacro", "parts/arm.xacro"]),
        ("arm_${a}_${b}.xacro", ["arm_x_y.xacro"]), ("${a}_${b}_y.xacro", []),
        ("${a}_x_y.xacro", ["arm_x_y.xacro"]), ("${a}.xacro", []), ("$(arg file)", []),
        ("robot.xacro", []), ("${(a)}/x/gone.xacro", []), ("..", []),
    ],
)  # fmt: skip
def test_which_files_a_filled_in_include_may_mean(
    include: str, parts: list[str], tmp_path: Path
) -> None:
    every = ("arm.xacro", "parts/arm.xacro", "arm_x_y.xacro", "other/myarm.xacro")
    write(tmp_path, dict.fromkeys(every, xacro("")))
    write(tmp_path, {"robot.xacro": xacro(f'<xacro:include filename="{include}"/>')})
    found = included([str(it) for it in tmp_path.rglob("*.xacro")])
    assert found == {str(tmp_path / it) for it in parts}


def test_a_repository_of_one_package_looks_at_no_neighbours(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    packages(tmp_path)
    (tmp_path / "ws" / "robot" / ".git").mkdir()
    (found,) = linted(tmp_path, "ws/robot/urdf/next.xacro")
    assert found.code == "MB119"


def test_messages_hold_no_path_of_this_machine(tmp_path: Path) -> None:
    """So a baseline holds on others."""
    packages(tmp_path)
    body = '<xacro:include filename="$(find robot)/nowhere.xacro"/><link name="a"/>'
    write(tmp_path, {"ws/robot/urdf/own.xacro": xacro(body)})
    (found,) = linted(tmp_path, "ws/robot/urdf/own.xacro")
    assert found.message == "xacro failed: No such file or directory: ws/robot/nowhere.xacro"


@pytest.mark.more
def test_a_configuration_lets_xacro_read_no_folder_but_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It comes with the files; the command line does not."""
    for variable in ("AMENT_PREFIX_PATH", "ROS_PACKAGE_PATH"):
        monkeypatch.delenv(variable, raising=False)
    packages(tmp_path)
    (tmp_path / "ws" / "urdf-lint.toml").write_text('roots = ["../elsewhere", "some"]\n')
    include = f'<xacro:include filename="{tmp_path}/elsewhere/far/p.xacro"/>'
    write(tmp_path, {"ws/robot/urdf/by_path.xacro": xacro(include)})
    monkeypatch.chdir(tmp_path / "ws")
    quiet = ["--quiet", "--select", "MB103,MB202", "--fail-on", "note"]
    for name, said in (
        ("far", "package 'far' is not found"),
        ("by_path", "outside of the folders"),
    ):
        assert main([f"robot/urdf/{name}.xacro", *quiet]) == 1
        assert said in capsys.readouterr().out
        assert main([f"robot/urdf/{name}.xacro", "--roots", "../elsewhere", *quiet]) == 1
        assert "MB202" in capsys.readouterr().out
    assert main(["robot/urdf/next.xacro", *quiet]) == 1
    assert "MB202" in capsys.readouterr().out


def test_controllers_that_cmake_installs_from_elsewhere_are_there(tmp_path: Path) -> None:
    control = (
        '<link name="a"/><gazebo><plugin name="gz_ros2_control::GazeboSimROS2ControlPlugin" '
        'filename="gz_ros2_control-system"><parameters>$(find robot)/config/%s.yaml</parameters>'
        "</plugin></gazebo>"
    )
    write(
        tmp_path,
        {
            "robot/package.xml": MANIFEST % "robot",
            "robot/config/other.yaml": "",
            "robot/bringup/config/there.yaml": "",
            "robot/urdf/a.xacro": xacro(control % "there"),
            "robot/urdf/b.xacro": xacro(control % "gone"),
        },
    )
    found = linted(tmp_path, "robot/urdf/a.xacro", "robot/urdf/b.xacro", select=("MB234",))
    assert [(it.code, it.file) for it in found] == [("MB234", "robot/urdf/b.xacro")]


LACKS = {
    "r.urdf": (f'<link name="a"/><link name="base"/>{LOST}', "error"),
    "r.xacro": (f'<link name="a"/><link name="base"/>{LOST}', "warning"),
    "part.xacro": (f'<link name="a"/>{LOST}', "note"),
    "part.urdf": (f'<link name="a"/>{LOST}', "warning"),
}


@pytest.mark.parametrize("name", LACKS)
def test_what_a_file_lacks_is_as_bad_as_it_is_certain(name: str, tmp_path: Path) -> None:
    body, level = LACKS[name]
    assert one(tmp_path, {name: xacro(body)}, name, select=("MB202",)).level == level


@pytest.mark.parametrize(("file", "level"), [("other.xacro", "warning"), ("r.urdf", "warning")])
def test_a_name_that_nothing_makes_stops_no_more_than_that_file(
    file: str, level: str, tmp_path: Path
) -> None:
    found = one(tmp_path, {file: xacro("<xacro:m/>", "r"), "x/a.urdf": xacro("")}, file)
    assert (found.code, found.level) == ("MB103", level)


def test_a_value_that_an_argument_gives_is_no_error(tmp_path: Path) -> None:
    argument = '<xacro:arg name="m" default="-1"/><xacro:property name="p" value="$(arg m)"/>'
    for value, level in (("-1", "error"), ("$(arg m)", "warning"), ("${p}", "warning")):
        link = f'<link name="a"><inertial><mass value="{value}"/></inertial></link>'
        found = one(tmp_path, {"r.xacro": xacro(argument + link)}, select=("MB125",))
        assert found.level == level
