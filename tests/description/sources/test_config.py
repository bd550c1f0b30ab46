# SPDX-License-Identifier: Apache-2.0
"""``[tool.multibot-rewrite]``: found above the input, read by commands only, mistakes named."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from multibot_rewrite import UsageError
from multibot_rewrite.base.config import configured_definitions
from multibot_rewrite.cli.urdf_postfix import main

TABLE = '[tool.multibot-rewrite]\ndefinitions = ["data/mine.vocab"]\n'
SECTION = "[plugin mine]\nopens: nothing\nmy_frame uses link frame\n"
ROBOT = (
    '<robot name="a">\n<link name="base"/>\n<gazebo><plugin name="p" filename="libmine.so">'
    "<my_frame>base</my_frame></plugin></gazebo>\n</robot>\n"
)


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """Return a project with one definition file and a robot two folders down."""
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "mine.vocab").write_text(SECTION)
    (tmp_path / "pyproject.toml").write_text(TABLE)
    (tmp_path / "robots" / "crane").mkdir(parents=True)
    (tmp_path / "robots" / "crane" / "in.urdf").write_text(ROBOT)
    return tmp_path


def complaint(project: Path, text: str | bytes) -> str:
    """Return what is said about such a pyproject.toml, without its name."""
    path = project / "pyproject.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(UsageError) as caught:
        configured_definitions(str(project / "robots" / "crane" / "in.urdf"))
    message = str(caught.value)
    assert message.startswith(f"{path}:")
    assert "\n" not in message
    return message.removeprefix(f"{path}:").strip()


@pytest.mark.parametrize(
    "text",
    [
        pytest.param(
            '[tool]\nmultibot-rewrite = {definitions = ["data/mine.vocab"]}\n', id="inline"
        ),
        pytest.param(
            '[tool . "multibot-rewrite"]\ndefinitions = ["data/mine.vocab"]\n', id="quoted"
        ),
        pytest.param('tool.multibot-rewrite.definitions = ["data/mine.vocab"]\n', id="dotted"),
        pytest.param(f'[project]\nname = "é"\n\n{TABLE}'.replace("\n", "\r\n"), id="crlf"),
    ],
)
def test_every_spelling_of_the_table_is_seen(project: Path, text: str) -> None:
    (project / "pyproject.toml").write_text(text, encoding="utf-8", newline="")
    assert len(configured_definitions(str(project / "in.urdf"))) == 1


@pytest.mark.parametrize(
    ("text", "words"),
    [
        pytest.param("[tool.multibot-rewrite]\nx = \n", "2:5: broken TOML", id="broken"),
        pytest.param("a = 1\n[tool.multibot-rewrite\n", "2:", id="no-bracket"),
        pytest.param(TABLE + TABLE, "broken TOML", id="table-twice"),
        pytest.param(b"# multibot-rewrite\na = '\xff'\n", "2: it is not UTF-8", id="latin-1"),
        pytest.param(
            "[tool.multibot-rewrite]\nvocab = []\n",
            "unknown key 'vocab', use definitions",
            id="key",
        ),
        pytest.param(
            TABLE.replace("-", "_"), "write [tool.multibot-rewrite]", id="underscore-in-the-name"
        ),
        pytest.param("[tool]\nmultibot-rewrite = 3\n", "is a number, write a table", id="no-table"),
        pytest.param("[[tool.multibot-rewrite]]\n", "is a list, write a table", id="tables"),
        *(
            pytest.param(
                f"[tool.multibot-rewrite]\ndefinitions = {value}\n",
                f"definitions is {what}",
                id=what,
            )
            for value, what in (
                ('"data/mine.vocab"', "a string"),
                ("true", "a boolean"),
                ("1.5", "a number"),
                ("{a = 1}", "a table"),
                ("1979-05-27", "a date"),
            )
        ),
        pytest.param(
            '[tool.multibot-rewrite]\ndefinitions = ["data/mine.vocab", 3]\n',
            "definitions holds a number, write paths in quotes",
            id="list-of-others",
        ),
        *(
            pytest.param(TABLE.replace("data/mine.vocab", path), f"no file {path!r}", id=name)
            for path, name in (("data/none.vocab", "missing"), ("data", "folder"), ("", "empty"))
        ),
    ],
)
def test_a_wrong_table_is_one_line(project: Path, text: str | bytes, words: str) -> None:
    assert words in complaint(project, text)


def test_a_wrong_table_stops_the_command(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (project / "pyproject.toml").write_text("[tool.multibot-rewrite]\nx = 1\n")
    (project / "in.urdf").write_text("<robot/>")
    assert main([str(project / "in.urdf"), "robot1"]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"urdf-postfix: {project / 'pyproject.toml'}: ")
    assert err.count("\n") == 1


@pytest.mark.parametrize("text", [None, '[project]\nname = "x"\n'], ids=["no-file", "no-table"])
def test_a_project_without_the_table_pays_no_parser(tmp_path: Path, text: str | None) -> None:
    if text is not None:
        (tmp_path / "pyproject.toml").write_text(text)
    code = (
        "import sys; from multibot_rewrite.base.config import configured_definitions as c;"
        f"assert c({str(tmp_path / 'in.urdf')!r}) == (); print('tomllib' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "False\n"


class TomlDecodeError(ValueError):
    """That of toml 0.10.2, which Ubuntu 22.04 has for Python 3.10."""


def without_parsers(monkeypatch: pytest.MonkeyPatch, other: object) -> None:
    for name in ("tomllib", "tomli"):
        monkeypatch.setitem(sys.modules, name, None)
    monkeypatch.setitem(sys.modules, "toml", other)


def test_the_parser_of_ubuntu_22_04_is_taken_where_python_has_none(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def fails(_: str) -> None:
        raise TomlDecodeError("Empty value is invalid (line 2 column 1 char 8)")

    told = {"tool": {"multibot-rewrite": {"definitions": ["a.vocab"]}}}
    (tmp_path / "pyproject.toml").write_text(TABLE)
    (tmp_path / "a.vocab").write_text("")
    parser = SimpleNamespace(loads=lambda _: told, TomlDecodeError=TomlDecodeError)
    without_parsers(monkeypatch, parser)
    assert configured_definitions(str(tmp_path)) == (str(tmp_path / "a.vocab"),)
    parser.loads = fails
    with pytest.raises(UsageError, match=r"toml:2:1: broken TOML, correct it: Empty value is"):
        configured_definitions(str(tmp_path))


def test_a_python_without_any_parser_is_told_what_to_install(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "pyproject.toml").write_text(TABLE)
    without_parsers(monkeypatch, None)
    with pytest.raises(UsageError, match=r"pip install tomli, or sudo apt install python3-toml"):
        configured_definitions(str(tmp_path))
