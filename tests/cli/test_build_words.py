# SPDX-License-Identifier: Apache-2.0
"""What ``build`` and ``inspect CODE`` say and refuse, without a fleet."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from refusals import said

from multibot_rewrite.cli import build, inspect
from multibot_rewrite.fleet.outputs.manifest import OutputChanges
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
    assert build._report_stale(options(), stale) == 1
    told = capsys.readouterr()
    assert told.out == "a: stale\nb: stale\nc: left over\n"
    assert told.err == "multibot: 3 files of out differ from what f.yaml makes\n"
    assert build._report_stale(options(), changes(remove=("c",))) == 1
    assert capsys.readouterr().err == "multibot: 1 file of out differ from what f.yaml makes\n"
    assert build._report_stale(options(), changes()) == 0
    assert capsys.readouterr().err == "multibot: out is up to date\n"


def test_rules_are_explained_each_once(capfd: pytest.CaptureFixture[str]) -> None:
    given = options(output=None, output_kind="table")
    assert inspect.explain(given, ["MG101,MB101", "MG101"]) == 0
    text = capfd.readouterr().out
    assert text.startswith("MG101 ") and text.count("\nMB101 ") == 1 and text.count("Why: ") == 2
    rows = inspect.rule_grid().rows
    assert any(tuple(it[:2]) == ("MG101", "error") for it in rows) and rows == sorted(rows)
    for word, hint in (("", "see multibot inspect"), ("MG1019", "did you mean 'MG101'?")):
        assert said(partial(inspect.explain, given), [word]) == (
            f"no rule has the code {word!r}, and none begins with it; {hint}"
        )
