# SPDX-License-Identifier: Apache-2.0
"""Rules MB1 about files: what cannot be read, and at which place; encodings, materials, fixes."""

from __future__ import annotations

from pathlib import Path

import pytest
from lint_calls import Settings, fix, lint_data, lint_file, lint_files

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING

XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
ONE = Settings(select=("MB1",))


def codes(source: str | bytes, *select: str) -> list[str]:
    data = source if isinstance(source, bytes) else source.encode()
    found = lint_data("robot.urdf", data, Settings(select=select or ("MB1",)))
    return [it.code for it in found]


def looks(*materials: str, before: str = "") -> str:
    """Links that look like these materials, in this order."""
    body = "".join(
        f'<link name="l{at}"><visual><geometry><sphere radius="1"/></geometry>{it}</visual></link>'
        for at, it in enumerate(materials)
    )
    return f'<robot name="r">{before}{body}</robot>'


RED = '<material name="m"><color rgba="1 0 0 1"/></material>'
GREEN = '<material name="m"><color rgba="0 1 0 1"/></material>'
NAME = '<material name="m"/>'


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        (looks(NAME), ["MB131"]),
        (looks(NAME, NAME), ["MB131", "MB131"]),
        (looks(RED, NAME), []),
        # urdfdom reads links in order: the later one does not help the earlier one.
        (looks(NAME, RED), ["MB131"]),
        (looks(NAME).replace("</robot>", RED + "</robot>"), []),
        (looks('<material name="m"><texture filename="t.png"/></material>', NAME), []),
        (looks('<material name="m"><color/></material>'), ["MB131"]),
        (looks('<material name="m"><ambient>1 0 0 1</ambient></material>'), ["MB131"]),
        # Without a name nothing is looked up.
        (looks('<material name=""/>', '<material name=""><color rgba="0 0 0 1"/></material>'), []),
        (looks(before=NAME), ["MB131"]),
        (looks(NAME, before=NAME), ["MB131"]),
        (looks(before='<material name="m"><texture filename="t.png"/></material>'), []),
        (looks(GREEN, before=RED), ["MB132"]),
        (looks(GREEN, RED, GREEN), ["MB132"]),
        (looks(RED, RED.replace("1 0 0 1", " 1.0 0 0.0 1")), []),
        (looks(RED.replace("1 0 0 1", "x")), ["MB120"]),
        (looks(before=RED.replace("1 0 0 1", "1 0 0")), ["MB120"]),
        # Materials of Gazebo are scripts of its own.
        (
            '<robot name="r"><gazebo reference="a"><material>Gazebo/Red</material></gazebo></robot>',
            [],
        ),
        (
            '<robot name="r"><gazebo><visual><material name="m"/></visual></gazebo></robot>',
            [],
        ),
        ('<robot name="r"><material/></robot>', ["MB115"]),
        ('<robot name="r"><material name="m"><colour/></material></robot>', ["MB110"]),
    ],
)
def test_materials(source: str, expected: list[str]) -> None:
    assert codes(source) == expected


ROBOT = b'<robot name="r"><link name="a"/></robot>'


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        (ROBOT, []),
        (b'<?xml version="1.0"?>' + ROBOT, []),
        (b"<?xml version='1.0' encoding='utf-8' standalone='yes'?>" + ROBOT, []),
        (b'<?xml version="1.0" encoding="US-ASCII"?>' + ROBOT, []),
        (b'<?xml version="1.1" encoding="utf-8"?>' + ROBOT, ["MB140"]),
        (b'<?xml version="1.1" encoding="latin1"?>' + ROBOT, ["MB140", "MB140"]),
        (b'<?xml version="1.0" encoding="gb2312"?>' + ROBOT, ["MB140"]),
        (b'<?xml version="0.0"?>' + ROBOT, ["MB101"]),
        (b'<?xml version="1.0" encoding="latin1"?><robot name="\xe4"/>', ["MB101"]),
        (b"\xef\xbb\xbf" + ROBOT, ["MB141"]),
        (b'\xef\xbb\xbf<?xml version="1.1"?>' + ROBOT, ["MB140", "MB141"]),
        (b'<robot name="r" xmlns:a="u" xmlns:b="v"><b:x/></robot>', ["MB142"]),
        (b'<robot name="r" xmlns:a="u"><link name="l" a:ignore="1"/></robot>', []),
        # A declaration further down, or of the default namespace, is not a prefix of the root.
        (b'<robot name="r"><gazebo xmlns:a="u"/></robot>', []),
        (b"<robot name='r' note='xmlns:a=\"u\"'/>", ["MB111"]),
        (b"", ["MB101"]),
        (b"<mujoco/>", ["MB101"]),
        (b"<robot name='r'><link name='a'></robot>", ["MB101"]),
        (b"<!DOCTYPE robot><robot name='r'/>", ["MB101"]),
    ],
)
def test_encodings(source: bytes, expected: list[str]) -> None:
    assert codes(source) == expected


@pytest.mark.parametrize(
    ("source", "fixed"),
    [
        (b"\xef\xbb\xbf" + ROBOT, ROBOT),
        (
            b'<?xml version="1.1" encoding="latin1"?>' + ROBOT,
            b'<?xml version="1.0" encoding="UTF-8"?>' + ROBOT,
        ),
        (
            b'<robot name="r"\n  xmlns:xacro="http://www.ros.org/wiki/xacro"  xmlns:b=\'v\'>'
            b"<b:x/></robot>",
            b"<robot name=\"r\"  xmlns:b='v'><b:x/></robot>",
        ),
        (b'<robot xmlns:xacro="x" name="r"/>', b'<robot name="r"/>'),
    ],
)
def test_fixes_take_away_what_is_not_used(source: bytes, fixed: bytes) -> None:
    assert fix("robot.urdf", source, ONE)[0] == fixed


@pytest.mark.slow
@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ('<link name="a"/>\n<xacro:include filename="x"/>', (2, 1)),
        ('<link name="a"/>\n  <link name="${x}"/><link name="${y}"/>', (2, 3)),
        ('<link name="ä"/><link name="$(arg x)"/>', (1, 17)),
        ("<!-- ${x} $(arg y) -->", None),
        ('<link name="$100"/>', None),
    ],
)
def test_leftover_xacro_is_told_once(body: str, expected: tuple[int, int] | None) -> None:
    source = f"<robot name='r' {XACRO}>\n{body}</robot>"
    found = lint_data("r.urdf", source.encode(), Settings(select=("MB105",)))
    assert [(it.line - 1, it.column) for it in found] == ([expected] if expected else [])


def test_faults_of_an_expansion_are_told_in_the_source(tmp_path: Path) -> None:
    file = tmp_path / "r.urdf.xacro"
    body = '<xacro:macro name="m" params="n">\n<link name="${n}"><inertail/></link></xacro:macro>'
    file.write_text(f'<robot name="r" {XACRO}>{body}<xacro:m n="a"/><xacro:m n="b"/></robot>')
    found = lint_file(str(file), ONE)
    assert {(it.code, it.line, it.column) for it in found} == {("MB110", 2, 19)}
    assert all(it.calls and not it.edits for it in found)


def test_what_is_no_utf_8_is_an_error_where_python_reads_it(tmp_path: Path) -> None:
    """A launch file opens a URDF as text; Gazebo opens its own files, and TinyXML-2 reads any bytes."""
    levels = {"a.urdf": ERROR, "a.world": WARNING, "a.sdf": WARNING}
    for name, level in levels.items():
        text = ROBOT if name.endswith("urdf") else b'<sdf version="1.9"><world name="w"/></sdf>'
        (tmp_path / name).write_bytes(b"<!-- \xb0 -->" + text)
        (found,) = lint_file(str(tmp_path / name), Settings(select=("MB101",)))
        assert (found.code, found.level) == ("MB101", level), name


@pytest.mark.parametrize(
    ("a", "b", "codes"),
    [
        ("b", "a", ["MB103", "MB103"]),
        ("$(find r)/b", "$(find r)/a", ["MB103", "MB103"]),
        ("b", "b", ["MB103", "MB103"]),
        # A file of that name elsewhere, and a comment.
        ("b", "x/a", []),
        ("b", "<!-- a", []),
    ],
)
def test_files_that_include_each_other_are_no_parts(
    tmp_path: Path, a: str, b: str, codes: list[str]
) -> None:
    """Each was taken for a part of the other, and nothing was said."""
    (tmp_path / "x").mkdir()
    (tmp_path / "package.xml").write_text("<package><name>r</name></package>")
    files = [tmp_path / f"{name}.xacro" for name in ("a", "b", "x/a")]
    for path, other in zip(files, (a, b, ""), strict=True):
        _, start, name = other.rpartition("<!-- ")
        include = f"<xacro:include filename='{name}.xacro'/>{' -->' * bool(start)}" * bool(name)
        path.write_text(f"<robot name='r' {XACRO}>{start}{include}<link name='l'/></robot>")
    found = lint_files([*map(str, files)], Settings(select=("MB103",)), jobs=1)
    assert [it.code for it in found] == codes


@pytest.mark.parametrize(
    ("file", "text", "line"),
    [
        ("model.sdf", '<sdf version="1.9">\n<model name="{{ name }}"/></sdf>', 2),
        ("robot.urdf", '<robot name="r">\n{% for it in legs %}<link/>{% endfor %}</robot>', 2),
        ("nav.yaml", "amcl:\n  ros__parameters:\n    alpha1: {{ alpha }}\n", 3),
        # A part of a file, which CMake fills in, or Jinja where it says so alone.
        ("part.sdf.in", '<link name="@NAME@"/>\n<joint name="j"/>', 1),
        ("part.sdf.jinja", '{# of a wing #}<link name="a"/><link name="b"/>', 1),
        # Of xacro, in a comment, of one brace.
        ("r.xacro", f'<robot name="r" {XACRO}><link name="${{{{1: 2}}[1]}}"/></robot>', 0),
        ("robot.urdf", '<robot name="r"><!-- {{ a }} --><link name="a"/></robot>', 0),
        ("nav.yaml", "# {{ a }}\namcl:\n  ros__parameters: {alpha1: 0.2}\n", 0),
    ],
)
def test_a_template_is_judged_when_it_is_filled_in(
    tmp_path: Path, file: str, text: str, line: int
) -> None:
    path = tmp_path / file
    path.write_text(text)
    found = [(it.code, it.level, it.line) for it in lint_file(str(path), Settings())]
    assert [it for it in found if it[0] == "MB105"] == [("MB105", NOTE, line)][: bool(line)]
    assert not line or len(found) == 1
