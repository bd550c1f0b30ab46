# SPDX-License-Identifier: Apache-2.0
"""Input and options that cannot work: one clear line each, the right exit code, and nothing left
behind. Run as a process, because that is where a traceback would show."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from paths import ROBOTS
from postfix_command import TEN, contents, run, run_on_terminal
from refusals import STOPPED, UNUSABLE, check_refusal, robot, xacro

pytestmark = pytest.mark.slow

DEEP = 5_000
BIG = 50 * 2**20
ROVER = (ROBOTS / "rover.urdf").read_text()
LAUGHS = "".join(f'<!ENTITY l{n} "{f"&l{n - 1};" * 10}">' for n in range(1, 10))


# ---------------------------------------------------------------- not readable as XML: exit code 2

UNREADABLE = {
    "not-xml": ("hello, this is text\n", ("in.urdf:1:", "not XML")),
    "binary": (bytes(range(256)), ("in.urdf:1:", "not")),
    "empty": ("", ("in.urdf", "empty", "<robot>")),
    "blank": (" \n\t\n", ("in.urdf", "empty", "<robot>")),
    "truncated": (ROVER[: len(ROVER) // 2], ("in.urdf:", "not well-formed", "correct")),
    "truncated-between-tags": (robot("<link").split("<link")[0], ("in.urdf:", "cut short")),
    "utf-16": (ROVER.encode("utf-16"), ("in.urdf", "UTF-16", "iconv")),
    "utf-16-without-mark": (ROVER.encode("utf-16-le"), ("in.urdf", "UTF-16", "iconv")),
    "latin-1": (
        '<?xml version="1.0" encoding="ISO-8859-1"?><robot name="é"/>'.encode("latin-1"),
        ("in.urdf", "ISO-8859-1", "iconv"),
    ),
    "wrong-bytes": (robot("<!-- é -->").encode("latin-1"), ("in.urdf:3:", "encoding")),
    "doctype": ("<!DOCTYPE robot>\n" + robot("").split("\n", 1)[1], ("in.urdf", "DOCTYPE")),
    "entity": (
        '<!DOCTYPE robot [<!ENTITY x "y">]>\n<robot name="&x;"/>',
        ("in.urdf", "DOCTYPE and entities"),
    ),
    "external-entity": (
        '<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/hostname">]>\n<robot name="a">&x;</robot>',
        ("in.urdf", "DOCTYPE and entities"),
    ),
    "billion-laughs": (
        f'<!DOCTYPE r [<!ENTITY l0 "ha">{LAUGHS}]>\n<robot name="a">&l9;</robot>',
        ("in.urdf", "entit"),
    ),
    "billion-laughs-in-an-attribute": (
        f'<!DOCTYPE r [<!ENTITY l0 "ha">{LAUGHS}]>\n<robot name="&l9;"/>',
        ("in.urdf", "entit"),
    ),
    "unknown-entity": (robot('<link name="&nbsp;"/>'), ("in.urdf:3:", "nbsp", "correct")),
    "deep": (
        robot("<a>" * DEEP + "</a>" * DEEP),
        ("in.urdf:3:", "depth", "never nested this deep"),
    ),
    "version-0.0": (
        '<?xml version="0.0"?>\n<robot name="a"/>',
        ("in.urdf:1:", "0.0", 'write <?xml version="1.0"?>'),
    ),
    "markup-before-declaration": ("<!-- made by hand -->\n" + robot(""), ("in.urdf:2:", "start")),
    "two-roots": (robot("") + "<robot/>", ("in.urdf:5:", "Extra content", "correct")),
    "tag-mismatch": (robot('<link name="a">'), ("in.urdf:4:", "link line 3", "correct")),
    "attribute-twice": (robot('<link name="a" name="b"/>'), ("in.urdf:3:", "redefined", "correct")),
    "mjcf": (
        '<mujoco model="m">\n<worldbody/>\n</mujoco>',
        ("in.urdf:1:", "a model of MuJoCo", "give the robot's URDF or SDF"),
    ),
    "other-root": ("<html/>", ("in.urdf:1:", "<html>", "<robot>")),
}


@pytest.mark.sample(4)
@pytest.mark.parametrize(
    ("data", "words"), [pytest.param(*case, id=name) for name, case in UNREADABLE.items()]
)
def test_unreadable_input(tmp_path: Path, data: str | bytes, words: tuple[str, ...]) -> None:
    content = data.encode() if isinstance(data, str) else data
    (tmp_path / "in.urdf").write_bytes(content)
    result = run(tmp_path, "in.urdf", "robot1", "-o", "out.urdf")
    check_refusal(tmp_path, result, UNUSABLE, words)
    assert contents(tmp_path) == {"in.urdf": content}


@pytest.mark.parametrize("name", ["in.urdf", "in.xacro"])
def test_a_big_file(tmp_path: Path, name: str) -> None:
    with (tmp_path / name).open("wb") as file:
        file.write(b'<robot name="a">')
        file.truncate(BIG)
    result = run(tmp_path, name, "robot1", "-o", "out.urdf")
    check_refusal(tmp_path, result, UNUSABLE, (name, "over the limit"))


def test_no_such_input(tmp_path: Path) -> None:
    for name in ("nothing.urdf", "nothing.xacro", "no/folder.urdf"):
        result = run(tmp_path, name, "robot1", "-o", "out.urdf")
        check_refusal(tmp_path, result, UNUSABLE, (name, "is not there"))


@pytest.mark.parametrize("name", ["folder", "folder.xacro"])
def test_input_is_a_folder(tmp_path: Path, name: str) -> None:
    (tmp_path / name).mkdir()
    result = run(tmp_path, name, "robot1", "-o", "out.urdf")
    check_refusal(tmp_path, result, UNUSABLE, (name, "cannot be read", "directory"))


def test_nothing_on_standard_input(tmp_path: Path) -> None:
    result = run(tmp_path, "-", "robot1", "-o", "out.urdf")
    check_refusal(tmp_path, result, UNUSABLE, ("<stdin>", "empty", "<robot>"))


# ---------------------------------------------------------------- xacro that fails: exit code 2

XACRO_FAILS = {
    "undefined-argument": ('<link name="$(arg arm)"/>', ("in.xacro", "arm", "arm:=VALUE")),
    "undefined-argument-in-python": (
        """<link name="${'$(arg arm)'}"/>""",
        ("in.xacro", "arm", "give it as arm:=VALUE"),
    ),
    "undefined-property": (
        '<link name="${arm}"/>',
        ("in.xacro", "'arm' is not defined", "<xacro:property>"),
    ),
    "missing-include": (
        '<xacro:include filename="arm.xacro"/>',
        ("in.xacro", "arm.xacro", "check the path"),
    ),
    "unknown-macro": ("<xacro:arm/>", ("in.xacro", "xacro:arm", "<xacro:include>")),
    "missing-parameter": (
        '<xacro:macro name="m" params="side"><link name="${side}"/></xacro:macro><xacro:m/>',
        ("in.xacro", "[side]", "all its parameters"),
    ),
    "python-error": ('<link name="${1/0}"/>', ("in.xacro", "division by zero", "1/0")),
    "environment": ('<link name="$(env NOT_SET_AT_ALL)"/>', ("NOT_SET_AT_ALL", "set it")),
    "endless-macro": (
        '<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>',
        ("in.xacro", "leads back to itself"),
    ),
    "deep": ("<a>" * DEEP + "</a>" * DEEP, ("in.xacro", "nested too deep")),
    "not-well-formed": ('<link name="a">', ("in.xacro:4:3", "mismatched tag", "correct")),
    "undeclared-prefix": ("<gz:link/>", ("in.xacro:3:", "unbound prefix", "xmlns:")),
}


@pytest.mark.sample(4)
@pytest.mark.parametrize(
    ("body", "words"), [pytest.param(*case, id=name) for name, case in XACRO_FAILS.items()]
)
def test_xacro_that_fails(tmp_path: Path, body: str, words: tuple[str, ...]) -> None:
    (tmp_path / "in.xacro").write_text(xacro(body))
    result = run(tmp_path, "in.xacro", "robot1", "-o", "out.urdf")
    check_refusal(tmp_path, result, UNUSABLE, words)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        pytest.param(b"", ("in.xacro:1:1", "no element found", "correct"), id="empty"),
        pytest.param(b"text", ("in.xacro:1:1", "correct"), id="not-xml"),
        pytest.param(xacro("").encode("utf-16"), ("in.xacro", "UTF-8"), id="utf-16"),
        pytest.param(
            UNREADABLE["billion-laughs"][0].encode(), ("in.xacro", "entities"), id="laughs"
        ),
    ],
)
def test_a_xacro_file_that_is_none(tmp_path: Path, data: bytes, words: tuple[str, ...]) -> None:
    (tmp_path / "in.xacro").write_bytes(data)
    result = run(tmp_path, "in.xacro", "robot1", "-o", "out.urdf")
    check_refusal(tmp_path, result, UNUSABLE, words)


def test_an_included_file_is_named(tmp_path: Path) -> None:
    (tmp_path / "in.xacro").write_text(xacro('<xacro:include filename="arm.xacro"/>'))
    (tmp_path / "arm.xacro").write_text(xacro('\n<link name="a">'))
    result = run(tmp_path, "in.xacro", "robot1", "-o", "out.urdf")
    words = ("arm.xacro:5:3", "included from in.xacro", "mismatched tag")
    check_refusal(tmp_path, result, UNUSABLE, words)


@pytest.mark.parametrize("sourced", [True, False], ids=["other-workspace", "no-ros"])
def test_a_missing_package(tmp_path: Path, sourced: bool) -> None:
    (tmp_path / "in.xacro").write_text(
        xacro('<xacro:include filename="$(find arm_description)/arm.xacro"/>')
    )
    (tmp_path / "install").mkdir()
    env = {"AMENT_PREFIX_PATH": str(tmp_path / "install") if sourced else ""}
    result = run(tmp_path, "in.xacro", "robot1", "-o", "out.urdf", env=env)
    words = ("arm_description", "workspace" if sourced else "sourced ROS 2")
    check_refusal(tmp_path, result, UNUSABLE, ("in.xacro", *words))


# ---------------------------------------------------------------- content: exit code 1, findings

REFUSED = {
    "xacro-property": (
        robot('<link name="${side}_arm"/>'),
        ("in.urdf:3:", "MB105", "${side}_arm", "run xacro"),
    ),
    "xacro-argument": (
        robot('<link name="$(arg side)_arm"/>'),
        ("in.urdf:3:", "MB105", "$(arg side)_arm", "run xacro"),
    ),
    "xacro-in-a-number": (
        robot('<link name="a"><visual><origin xyz="${x} 0 0"/></visual></link>'),
        ("in.urdf:3:", "MB105", "${x} 0 0", "run xacro"),
    ),
    "duplicate-links": (
        robot('<link name="a"/>\n<link name="a"/>'),
        ("in.urdf:4:1: error: MB201", "'a'", "line 3", "rename one"),
    ),
    "duplicate-joints": (
        robot(
            '<link name="a"/><link name="b"/><link name="c"/>\n'
            '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>\n'
            '<joint name="j" type="fixed"><parent link="a"/><child link="c"/></joint>'
        ),
        ("in.urdf:5:1: error: MB201", "'j'", "line 4", "rename one"),
    ),
}


@pytest.mark.parametrize(
    ("text", "words"), [pytest.param(*case, id=name) for name, case in REFUSED.items()]
)
def test_refused_content(tmp_path: Path, text: str, words: tuple[str, ...]) -> None:
    (tmp_path / "in.urdf").write_text(text)
    words_given = ("in.urdf", *TEN, "-o", "{robot}.urdf")
    check_refusal(tmp_path, run(tmp_path, *words_given), STOPPED, words)
    assert contents(tmp_path) == {"in.urdf": text.encode()}


def test_every_finding_has_its_line(tmp_path: Path) -> None:
    twice = '<link name="a"/>\n<link name="a"/>\n<link name="b"/><link name="b"/>'
    (tmp_path / "in.urdf").write_text(robot(twice))
    result = run_on_terminal(tmp_path, "in.urdf", "robot1", env={"NO_COLOR": "1"})
    assert result.code == STOPPED
    places = [line.split(": ")[0] for line in result.err.splitlines()]
    assert places == ["in.urdf:4:1", "in.urdf:5:17"]


def test_already_rewritten(tmp_path: Path) -> None:
    for robots in (["robot1"], ["robot2", "robot1"]):
        run(tmp_path, "-", "robot1", "-o", "in.urdf", stdin=ROVER.encode())
        result = run(tmp_path, "in.urdf", *robots, "-o", "{robot}.urdf")
        words = ("in.urdf:", "MB106", "already rewritten for robot1", "link 'base", "--undo")
        check_refusal(tmp_path, result, STOPPED, words)
        assert list(contents(tmp_path)) == ["in.urdf"]


@pytest.mark.parametrize(
    "words",
    [
        pytest.param(("robot2",), id="other-robot"),
        pytest.param(("robot1", "--affix", "prefix"), id="other-affix"),
        pytest.param(("robot1", "--separator", "link=_"), id="other-separator"),
    ],
)
def test_strip_with_other_options(tmp_path: Path, words: tuple[str, ...]) -> None:
    run(tmp_path, "-", "robot1", "-o", "in.urdf", stdin=ROVER.encode())
    result = run(tmp_path, "in.urdf", *words, "--undo", "-o", "out.urdf")
    check_refusal(tmp_path, result, STOPPED, ("in.urdf:", "MB107", words[0], "options"))


# ---------------------------------------------------------------- wrong use: exit code 2


@pytest.mark.parametrize(
    ("row", "said"),
    [
        pytest.param("frame uses lnk", ("unknown kind 'lnk'", "link"), id="kind"),
        pytest.param("a//b uses link", ("bad path 'a//b'",), id="path"),
        pytest.param(
            "x uses link\nx uses joint", ("x is in line 2 already", "remove one"), id="twice"
        ),
        pytest.param("colour: red", ("unknown setting 'colour'",), id="setting"),
    ],
)
def test_a_mistake_in_a_definitions_file(tmp_path: Path, row: str, said: tuple[str, ...]) -> None:
    (tmp_path / "my.vocab").write_text(f"[plugin mine]\n{row}\n")
    line = 2 + row.count("\n")
    words = ("-", "robot1", "--definitions", "my.vocab", "-o", "out.urdf")
    result = run(tmp_path, *words, stdin=ROVER.encode())
    check_refusal(tmp_path, result, UNUSABLE, (f"my.vocab:{line}:", *said))


# ---------------------------------------------------------------- outputs that cannot be written


def _below_a_file(folder: Path) -> str:
    (folder / "file").write_text("")
    return str(folder / "file" / "{robot}.urdf")


def _a_folder(folder: Path) -> str:
    (folder / "robot1").mkdir()
    return str(folder / "{robot}")


def _read_only(folder: Path) -> str:
    if not os.path.isdir("/sys/kernel"):
        pytest.skip("no /sys here: the folder that nobody may write to, root included")
    return "/sys/kernel/{robot}.urdf"


@pytest.mark.sample(4)
@pytest.mark.parametrize(
    ("target", "said"),
    [
        pytest.param(_below_a_file, ("not a folder", "choose another"), id="below-a-file"),
        pytest.param(_a_folder, ("it is a folder", "name a file"), id="is-a-folder"),
        pytest.param(_read_only, ("choose another output",), id="read-only"),
    ],
)
@pytest.mark.parametrize("robots", [("robot1",), ("robot1", *TEN)], ids=["one", "many"])
@pytest.mark.parametrize("form", ["description", "changes"])
def test_output_that_cannot_be_written(
    tmp_path: Path,
    form: str,
    robots: tuple[str, ...],
    target: Callable[[Path], str],
    said: tuple[str, ...],
) -> None:
    path = target(tmp_path)
    before = contents(tmp_path)
    if form == "changes":
        path = path.replace("{robot}", "robot1")
    words = ("--output-kind", form, "-o", path)
    result = run(tmp_path, "-", *robots, *words, stdin=ROVER.encode())
    place = path.replace("{robot}", "robot1")
    check_refusal(tmp_path, result, UNUSABLE, (f"{place}: cannot be written", *said))
    assert contents(tmp_path) == before
