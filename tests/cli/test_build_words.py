# SPDX-License-Identifier: Apache-2.0
"""What ``build`` and ``inspect CODE`` say and refuse, without a fleet."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from refusals import said

from multibot_rewrite.cli import build, inspect
from multibot_rewrite.fleet.manifest import OutputChanges
from multibot_rewrite.fleet.outputs.output_file import OutputFile


def options(**given: Any) -> argparse.Namespace:
    usual = {
        "quiet": False,
        "verbose": False,
        "program": "multibot",
        "output": "out",
        "fleet": "f.yaml",
    }
    return argparse.Namespace(**{**usual, **given})


def changes(**given: Any) -> OutputChanges:
    return OutputChanges(*((),) * len(OutputChanges._fields))._replace(**given)


def test_a_build_goes_into_a_folder_and_not_over_its_input(tmp_path: Path) -> None:
    file = tmp_path / "a.yaml"
    file.write_text("")
    assert said(build._check_folder, str(file)) == f"{file}: it is a file; name a folder"
    build._check_folder(str(tmp_path))
    build._check_folder(str(tmp_path / "new"))
    made = [OutputFile("a.yaml", b"", ())]
    assert said(build._check_inputs, str(tmp_path), made, [str(file)]) == (
        f"{file} is a file that is read; choose another folder for --output"
    )
    build._check_inputs(str(tmp_path), [OutputFile("b.yaml", b"", ())], [str(file)])


def test_what_a_check_of_a_build_says(capsys: pytest.CaptureFixture[str]) -> None:
    stale = changes(write=("a", "b"), remove=("c",))
    assert build._stale(options(), stale) == 1
    told = capsys.readouterr()
    assert told.out == "a: stale\nb: stale\nc: left over\n"
    assert told.err == "multibot: 3 files of out differ from what f.yaml makes\n"
    assert build._stale(options(), changes(remove=("c",))) == 1
    assert capsys.readouterr().err == "multibot: 1 file of out differ from what f.yaml makes\n"
    assert build._stale(options(), changes()) == 0
    assert capsys.readouterr().err == "multibot: out is up to date\n"


def test_files_that_are_there_are_known_by_their_hashes(tmp_path: Path) -> None:
    """sha256 of nothing and of "a", as sha256sum has them."""
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "a").write_bytes(b"a")
    found = build._there(str(tmp_path), ["sub/a", "sub", "gone"])
    assert list(found) == ["sub/a"]
    assert "ca978112ca1bbdcafac231b39a23dc4da786eff8147c4e72b9807785afee48bb" in found["sub/a"]
    assert build._known(str(tmp_path)) == {}


def test_rules_are_explained_each_once(capfd: pytest.CaptureFixture[str]) -> None:
    given = options(output=None, form="table")
    assert inspect.explain(given, ["MG101,MB101", "MG101"]) == 0
    text = capfd.readouterr().out
    assert text.startswith("MG101 ") and text.count("\nMB101 ") == 1 and text.count("Why: ") == 2
    rows = inspect.rule_grid().rows
    assert any(tuple(it[:2]) == ("MG101", "error") for it in rows) and rows == sorted(rows)
    for word, hint in (("", "see multibot inspect"), ("MG1019", "did you mean 'MG101'?")):
        assert said(partial(inspect.explain, given), [word]) == (
            f"no rule has the code {word!r}, and none begins with it; {hint}"
        )


def test_what_is_taken_for_a_code() -> None:
    """Plugins and elements of the vocabulary are not: no name of it is a letter behind an M."""
    assert all(map(inspect.are_codes, (["MG101"], ["mb2"], ["MB"], ["MB20X"], ["x,MB202"])))
    assert not any(map(inspect.are_codes, ([], [""], ["M"], ["mimic"], ["libMB202.so"])))
    assert inspect.is_name("undeclared-link") and not inspect.is_name("camera")


def test_the_files_that_a_build_was_made_from(tmp_path: Path) -> None:
    """Those of the fleet file and of what is written, interfaces of nodes, and the parts of a joined
    robot; not what a robot's arguments were filled in for, if it does not read it itself."""
    a, b, c, d, e, f, g = (str(tmp_path / it) for it in "abcdefg")
    for path in (a, b, c, d, e, f, g):
        Path(path).write_text(path)

    def robot(parts: tuple[str, ...], files: tuple[str, ...], *filled: str) -> SimpleNamespace:
        return SimpleNamespace(parts=parts, files=files, filled=[(it, b"") for it in filled])

    robots = [robot((), (c,), b, c), robot(("p",), (d,)), robot((), (g,))]
    facts = [SimpleNamespace(interface=e), SimpleNamespace(interface="")]
    plan: Any = SimpleNamespace(
        file=SimpleNamespace(files={a: "", b: "", c: ""}, robots=robots),
        fleet=SimpleNamespace(facts=facts),
    )
    files: Any = [SimpleNamespace(sources=(f,))]
    assert build._read(plan, files) == {it: it.encode() for it in (a, c, d, e, f)}
