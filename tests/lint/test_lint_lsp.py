# SPDX-License-Identifier: Apache-2.0
"""``urdf-lint --lsp`` as an editor sees it: a real client, and texts that are on no disk."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path, PosixPath

import pytest
from editor import Editor, applied, codes, edited

from multibot_rewrite.cli.multibot import main as multibot
from multibot_rewrite.cli.urdf_lint import main as urdf_lint

MANIFEST = "<package format='3'><name>rover_description</name></package>\n"
LINKS = '  <link name="base_link"/>\n  <link name="wheel"/>\n'
JOINT = """\
  <joint name="spin" type="continuous">
    <parent link="base_link"/><child link="wheel"/><axis xyz="0 0 1"/>
  </joint>
"""
URDF = f'<?xml version="1.0"?>\n<robot name="rover">\n{LINKS}{JOINT}</robot>\n'
MACRO = """\
<robot name="rover" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="wheel" params="side">
    <link name="${side}_wheel"/>
    <joint name="${side}_spin" type="fixed">
      <parent link="base_link"/><child link="${side}_wheel"/>
    </joint>
  </xacro:macro>
  <link name="base_link"/>
  <xacro:wheel side="left"/>
  <xacro:wheel side="right"/>
</robot>
"""
SDF = """\
<sdf version="1.9"><model name="m">
  <link name="base_link"/><link name="wheel"/>
  <joint name="j" type="fixed">
    <parent>base_link</parent>
    <child>wheel</child>
  </joint>
</model></sdf>
"""
SRDF = """\
<robot name="rover">
  <group name="all">
    <joint name="spin"/>
    <link name="base_link"/>
    <link name="wheel"/>
  </group>
</robot>
"""
PARAMS = """\
behavior_server:
  ros__parameters:
    local_costmap_topic: local_costmap/costmap_raw
    robot_base_frame: base_link
"""
FLEET = """\
description: urdf/rover.urdf
layout: tf-per-robot
robots:
  - name: one
  - name: two
"""


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    # Editors write a blank and another alphabet otherwise in the address of a file.
    folder = tmp_path_factory.mktemp("lsp") / "my rovér" / "rover_description"
    for name, text in (
        ("package.xml", MANIFEST),
        ("urdf/rover.urdf", URDF),
        ("config/rover.srdf", SRDF),
        ("config/nav2.yaml", PARAMS),
        ("fleet.yaml", FLEET),
    ):
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder


@pytest.fixture(scope="module")
def editor(package: Path) -> Iterator[Editor]:
    with edited(package, "--distro", "jazzy") as made:
        yield made


@pytest.mark.parametrize(
    ("name", "text", "right", "wrong", "code", "line"),
    [
        ("urdf/rover.urdf", URDF, 'child link="wheel"', 'child link="whel"', "MB202", 6),
        (
            "urdf/wheels.urdf.xacro",
            MACRO,
            'parent link="base_link"',
            'parent link="base"',
            "MB202",
            5,
        ),
        ("urdf/wheels.urdf.xacro", MACRO, "</xacro:macro>", "", "MB101", 11),
        ("models/m.sdf", SDF, "<child>wheel", "<child>whel", "MB219", 5),
        ("config/rover.srdf", SRDF, 'joint name="spin"', 'joint name="spn"', "MB804", 3),
        ("config/nav2.yaml", PARAMS, "local_costmap_topic", "costmap_topic", "MB870", 3),
        ("fleet.yaml", FLEET, "layout: tf", "layuot: tf", "MB101", 2),
        ("fleet.yaml", FLEET, "rover.urdf", "rovr.urdf", "MB101", 1),
    ],
)
def test_a_fault_is_shown_while_it_is_there(
    editor: Editor,
    package: Path,
    name: str,
    text: str,
    right: str,
    wrong: str,
    code: str,
    line: int,
) -> None:
    path = package / name
    assert right in text
    on_disk = path.read_text() if path.exists() else None
    assert code not in codes(editor.open(path, text))
    shown = editor.change(path, text.replace(right, wrong))
    assert [(it.code, it.range.start.line + 1) for it in shown].count((code, line)) == 1
    assert code not in codes(editor.change(path, text))
    assert editor.close(path) == []
    assert (path.read_text() if path.exists() else None) == on_disk


def test_a_file_of_no_known_kind_has_no_findings(editor: Editor, package: Path) -> None:
    for name, text in (("ci.yaml", "on: [push]\n"), ("launch/a.xml", "<launch/>\n")):
        assert editor.open(package / name, text) == []
        editor.close(package / name)


def test_an_older_text_of_a_file_is_not_the_file(editor: Editor, package: Path) -> None:
    """VS Code opens it beside the file, to compare them."""

    class OfGit(PosixPath):
        def as_uri(self) -> str:
            return f"git:{super().as_uri().removeprefix('file://')}?%7B%7D"

    path, wrong = (
        package / "urdf" / "rover.urdf",
        URDF.replace('child link="wheel"', 'child link="w"'),
    )
    assert "MB202" not in codes(editor.open(path, URDF))
    assert editor.open(OfGit(path), wrong) == []
    assert "MB202" not in codes(editor.change(path, URDF))
    for it in (path, OfGit(path)):
        editor.close(it)


def test_columns_are_those_of_the_editor(editor: Editor, package: Path) -> None:
    """A character beyond the basic plane counts twice in UTF-16; U+2028 ends no line there."""
    path = package / "urdf" / "wide.urdf"
    line = '<!-- 🤖é --><parent link="a"/><child link="c"/>'
    links = '<robot name="r">\n<link name="a"/><link name="b"/>\n<joint name="j" type="fixed">'
    text = f"<!-- \u2028 -->\n{links}{line}</joint></robot>\n"
    (found,) = [it for it in editor.open(path, text) if it.code == "MB202"]
    row = text.split("\n")[found.range.start.line].encode("utf-16-le")
    start, end = (2 * it.character for it in (found.range.start, found.range.end))
    assert row[start:end].decode("utf-16-le") == 'link="c"'
    editor.close(path)


def test_a_fault_of_an_included_file_is_shown_in_it_as_it_is_open(
    editor: Editor, package: Path
) -> None:
    part, whole = package / "urdf" / "part.xacro", package / "urdf" / "whole.urdf.xacro"
    head = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
    text = head + '<link name="a"/>\n<link name="b"/>\n</robot>\n'
    part.write_text(text)
    whole.write_text(
        head + '<xacro:include filename="part.xacro"/>\n<joint name="j" type="fixed">\n'
        '<parent link="a"/><child link="b"/></joint>\n</robot>\n'
    )
    assert "MB202" not in codes(editor.open(whole, whole.read_text()))
    # Not on the disk: the link is called otherwise.
    editor.open(part, text.replace('name="b"', 'name="c" nam="c"'))
    editor.save(part)
    assert "MB202" in codes(editor.until(whole, "MB202"))
    assert {it.range.start.line for it in editor.shown[part.as_uri()]} >= {2}
    # Its findings are explained in it, not at the same line of this file.
    assert editor.hover(whole, whole.read_text(), "fixed") == ""
    editor.close(whole)
    editor.close(part)


def test_hover_is_inspect(
    editor: Editor, package: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = package / "urdf" / "gz.urdf"
    plugin = '<gazebo><plugin filename="gz-sim-diff-drive-system" name="p"/></gazebo>'
    text = URDF.replace("</robot>", f"{plugin}\n<!-- MB202 --></robot>")
    text = text.replace('"wheel"/><ax', '"whel"/><ax')
    editor.open(path, text)
    for word, name in (
        ("gz-sim-diff-drive-system", "gz-sim-diff-drive-system"),
        ("<|joint", "joint"),
        ("</|joint", "joint"),
        ("MB202", "MB202"),
    ):
        assert multibot(["inspect", name, "--distro", "jazzy"]) == 0
        told = capsys.readouterr().out.strip()
        assert told and told in editor.hover(path, text, word), name
    assert multibot(["inspect", "MB202"]) == 0
    assert capsys.readouterr().out.strip() in editor.hover(path, text, "whel")
    assert editor.hover(path, text, "<|?xml") == ""
    editor.close(path)


def test_a_quick_fix_is_that_of_the_command(editor: Editor, package: Path, tmp_path: Path) -> None:
    text = URDF.replace("<robot", '<robot xmlns:x="urn:x" xmlns:y="urn:y"').replace(
        "<link name", "<!-- urdf-lint: ignore MB501 -->\n  <link name", 1
    )
    path, on_disk = package / "urdf" / "odd.urdf", tmp_path / "odd.urdf"
    shown = editor.open(path, text)
    on_disk.write_text(text)
    urdf_lint([str(on_disk), "--fix", "--quiet"])
    (every,) = editor.actions(path, 1, "source.fixAll")
    assert applied(every.edit, {path: text}) == {"odd.urdf": on_disk.read_text()}
    line = next(it.range.start.line + 1 for it in shown if it.code == "MB002")
    (one,) = editor.actions(path, line, "quickfix")
    assert one.edit == every.edit
    assert editor.actions(path, 5, "quickfix") == []
    assert editor.actions(path, 4, "refactor") == []
    editor.close(path)


PLACES = {
    ("nav2.yaml", 4, "base_link"),
    ("rover.srdf", 4, "base_link"),
    ("rover.urdf", 3, "base_link"),
    ("rover.urdf", 6, "base_link"),
}


@pytest.mark.parametrize(
    ("name", "text", "word"),
    [
        ("urdf/rover.urdf", URDF, 'parent link="|base_link'),
        ("urdf/rover.urdf", URDF, '<link name="base_lin|k'),
        ("config/nav2.yaml", PARAMS, "frame: |base_link"),
    ],
)
def test_a_link_is_found_from_each_of_its_places(
    editor: Editor, package: Path, name: str, text: str, word: str
) -> None:
    for other in ("whole.urdf.xacro", "part.xacro"):
        (package / "urdf" / other).unlink(missing_ok=True)
    assert set(editor.references(package / name, text, word)) == PLACES
    used = editor.references(package / name, text, word, every=False)
    assert set(used) == PLACES - {("rover.urdf", 3, "base_link")}
    assert editor.definition(package / name, text, word) == [("rover.urdf", 3, "base_link")]


def test_a_file_that_begins_with_a_mark_has_its_names_where_they_are(
    editor: Editor, package: Path
) -> None:
    """A byte order mark is a character of the editor's text and none of YAML's."""
    path, text = package / "config" / "marked.yaml", f"\ufeff{PARAMS}"
    path.write_text(text)
    found = editor.references(path, text, "frame: |base_link")
    path.unlink()
    assert ("marked.yaml", 4, "base_link") in found


def test_a_file_without_a_description_in_its_package_is_of_those_around_it(
    editor: Editor, tmp_path: Path
) -> None:
    for name, text in (("rover_description/r.urdf", URDF), ("rover_nav/nav2.yaml", PARAMS)):
        folder = (tmp_path / name).parent
        folder.mkdir()
        (folder / "package.xml").write_text(MANIFEST.replace("rover_description", folder.name))
        (tmp_path / name).write_text(text)
    place = editor.definition(tmp_path / "rover_nav" / "nav2.yaml", PARAMS, "frame: |base_link")
    assert place == [("r.urdf", 3, "base_link")]


def test_levels_are_those_of_the_editor(editor: Editor, package: Path) -> None:
    path = package / "urdf" / "levels.urdf"
    text = URDF.replace('child link="wheel"', 'child link="whel"')
    text = text.replace("<robot", '<robot xmlns:x="urn:x"')
    shown = {it.code: it.severity for it in editor.open(path, text)}
    assert (shown["MB202"], shown["MB142"]) == (1, 3)
    (empty,) = editor.change(path, "")
    assert (empty.code, empty.range.start.line, empty.range.start.character) == ("MB101", 0, 0)
    editor.close(path)
    fleet = FLEET.replace("layout: tf-per-robot", "layout: tf-per-robot\nstack: nav2")
    found = editor.open(package / "fleet.yaml", fleet)
    assert ("MG316", 3) in [(it.code, it.severity) for it in found]
    assert {it.source for it in found} == {"urdf-lint"}
    editor.close(package / "fleet.yaml")


def test_a_file_is_one_under_each_of_its_names(editor: Editor, package: Path) -> None:
    """The editor has the file open behind a link; another file includes it by its path."""
    (package / "link").symlink_to("urdf")
    part, whole = package / "link" / "parts.xacro", package / "urdf" / "all.urdf.xacro"
    head = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
    part.write_text(head + '<link name="a"/>\n</robot>\n')
    text = head + '<xacro:include filename="parts.xacro"/>\n<joint name="j" type="fixed">\n'
    text += '<parent link="a"/><child link="b"/></joint>\n</robot>\n'
    assert "MB202" in codes(editor.open(whole, text))
    editor.open(part, head + '<link name="a"/>\n<link name="b" nam="b"/>\n</robot>\n')
    assert "MB202" not in codes(editor.change(whole, text + "\n"))
    assert 2 in {it.range.start.line for it in editor.shown[part.as_uri()]}
    for it in (whole, part):
        editor.close(it)


def test_a_joint_of_an_srdf_is_that_of_the_urdf(editor: Editor, package: Path) -> None:
    path = package / "config" / "rover.srdf"
    assert editor.definition(path, SRDF, 'joint name="|spin') == [("rover.urdf", 5, "spin")]
    found = editor.references(path, SRDF, 'joint name="|spin')
    assert found == [("rover.srdf", 3, "spin"), ("rover.urdf", 5, "spin")]
    assert editor.definition(path, SRDF, "gr|oup name") == []


def test_names_in_xacro_are_found_where_they_are_written(editor: Editor, tmp_path: Path) -> None:
    path = tmp_path / "wheels.urdf.xacro"
    path.write_text(MACRO)
    assert editor.definition(path, MACRO, 'parent link="|base_link') == [
        ("wheels.urdf.xacro", 8, "base_link")
    ]
    (tmp_path / "other.urdf").write_text(URDF)  # has a link of that name, too
    assert [it[0] for it in editor.definition(path, MACRO, 'link name="|base_link')] == [path.name]
    # Put together of an argument: the tag that makes it.
    ((_, line, text),) = editor.definition(path, MACRO, 'child link="${side}|_wheel')
    assert (line, text) == (3, '<link name="${side}_wheel"/>')


def test_rename_is_that_of_the_command(editor: Editor, tmp_path: Path) -> None:
    package, other = tmp_path / "one" / "rover_description", tmp_path / "two"
    for folder in (package, other):
        for name, text in (("package.xml", MANIFEST), ("r.urdf", URDF), ("r.srdf", SRDF)):
            folder.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text)
    assert multibot(["rename", "spin", "turn", str(other), "--kind", "joint", "--quiet"]) == 0
    made = editor.rename(package / "r.srdf", SRDF, 'joint name="|spin', "turn")
    assert made == {name: (other / name).read_text() for name in ("r.urdf", "r.srdf")}
    # As it is in the editor, and not yet on the disk; a file's own line ends are the editor's affair.
    (package / "r.srdf").write_bytes(SRDF.replace("\n", "\r\n").encode())
    text = URDF.replace('link name="wheel"', 'link name="wheel"  ')
    editor.open(package / "r.urdf", text)
    made = editor.rename(package / "r.urdf", text, 'child link="|wheel', "tyre")
    assert made == {
        n: it.replace('"wheel"', '"tyre"') for n, it in (("r.urdf", text), ("r.srdf", SRDF))
    }
    # One that is there: the reason, and no edit.
    assert editor.rename(package / "r.urdf", text, 'child link="|wheel', "base_link") == {}
    assert "has a link 'base_link'" in editor.messages[-1]
    editor.close(package / "r.urdf")


def test_what_takes_long_blocks_nothing_and_is_stopped(editor: Editor, package: Path) -> None:
    path = package / "urdf" / "long.urdf.xacro"
    long = "${[0 for i in range(10**5) for j in range(10**5)][0]}"
    text = MACRO.replace('name="rover"', f'name="rover{long}"')
    editor.open(path, text, wait=False)
    # Longer than the server waits for the next key.
    assert all(editor.hover(package / "urdf" / "rover.urdf", URDF, "<|joint") for _ in range(5))
    assert editor.times[path.as_uri()] == 0
    assert "MB101" not in codes(editor.change(path, text, text, MACRO))
    assert editor.times[path.as_uri()] == 1
    editor.close(path)


def test_a_quick_fix_of_a_large_file_blocks_nothing(editor: Editor, package: Path) -> None:
    """The same line 30,000 times: each may be each of the others."""
    path, comments = package / "urdf" / "large.urdf", "<!-- a -->\n" * 30_000
    text = URDF.replace("<robot", '<robot xmlns:x="urn:x"').replace(
        "</robot>", f"{comments}</robot>"
    )
    editor.open(path, text)
    (every,) = editor.actions(path, 1, "source.fixAll")
    assert every.edit and every.edit.changes and len(every.edit.changes[path.as_uri()]) == 1
    editor.close(path)


def test_a_process_that_dies_ends_no_server(editor: Editor, package: Path) -> None:
    def children(pid: int) -> list[int]:
        return [int(it) for it in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]

    path, server = package / "urdf" / "killed.urdf", editor.client._server
    assert server and "MB202" not in codes(editor.open(path, URDF))
    for pid in [pid for own in children(server.pid) for pid in (*children(own), own)]:
        with suppress(ProcessLookupError):  # one that has answered is being ended
            os.kill(pid, signal.SIGKILL)
    assert editor.hover(path, URDF, "<|joint") == ""  # the process that waited for it is gone
    wrong = URDF.replace('child link="wheel"', 'child link="whel"')
    assert "MB202" in codes(editor.change(path, wrong))
    editor.close(path)


def test_typing_shows_the_last_text_once(editor: Editor, package: Path) -> None:
    path = package / "urdf" / "typed.urdf"
    editor.open(path, URDF)
    before = editor.times[path.as_uri()]
    texts = [
        URDF.replace('child link="wheel', f'child link="{"wheel"[:size]}') for size in range(1, 5)
    ]
    (found,) = [it for it in editor.change(path, *texts) if it.code == "MB202"]
    assert "'whee'" in found.message
    assert editor.times[path.as_uri()] == before + 1
    editor.close(path)


def test_configuration_and_options_hold(package: Path, tmp_path: Path) -> None:
    wrong = URDF.replace('child link="wheel"', 'child link="whel"')
    (tmp_path / "urdf-lint.toml").write_text('ignore = ["MB610"]\nexclude = ["left/*"]\n')
    with edited(tmp_path, "--select", "MB2,MB6") as editor:
        assert codes(editor.open(tmp_path / "a.urdf", wrong)) == ["MB202"]
        assert editor.open(tmp_path / "left" / "a.urdf", wrong) == []
        (tmp_path / "urdf-lint.toml").write_text('ignore = ["MB610"]\nbaseline = "known.json"\n')
        (tmp_path / "b.urdf").write_text(wrong)
        urdf_lint([str(tmp_path / "b.urdf"), "--write-baseline", str(tmp_path / "known.json")])
        assert codes(editor.open(tmp_path / "b.urdf", wrong)) == []
        (tmp_path / "urdf-lint.toml").write_text('ignor = ["MB610"]\n')
        (found,) = editor.change(tmp_path / "a.urdf", URDF)
        assert "urdf-lint.toml: unknown key 'ignor'" in found.message


def test_without_the_extra_it_says_what_installs_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delitem(sys.modules, "multibot_rewrite.cli.lsp", raising=False)
    monkeypatch.setitem(sys.modules, "pygls.lsp.server", None)
    assert urdf_lint(["--lsp"]) == 4
    (line,) = capsys.readouterr().err.splitlines()
    assert "pip install 'multibot_rewrite[lsp]'" in line


def test_an_editor_that_goes_away_ends_the_server() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "multibot_rewrite.cli.urdf_lint", "--lsp"],
        stdin=subprocess.DEVNULL, capture_output=True, timeout=60, check=False,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
    )  # fmt: skip
    assert (done.returncode, done.stdout) == (0, b"")
