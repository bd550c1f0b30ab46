# SPDX-License-Identifier: Apache-2.0
"""--select, --ignore, --fail-on and --format on every command that reports findings."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest
from graph_cases import as_planned, without_node
from junitparser import JUnitXml
from paths import FIXTURES

from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding
from multibot_rewrite.base.findings.formats import FORMATS
from multibot_rewrite.cli import multibot, urdf_lint, urdf_postfix
from multibot_rewrite.cli.report import About, report_findings_too
from multibot_rewrite.system.json import from_yaml, to_json

ROVER = str(FIXTURES / "robots" / "rover.urdf")
SIBLINGS = str(FIXTURES / "robots" / "siblings.urdf")
TWENTY = [f"robot{number}" for number in range(1, 21)]
Said = Callable[..., tuple[int, str, str]]


@pytest.fixture
def said(capsys: pytest.CaptureFixture[str]) -> Said:
    """Run one of the three programs; return exit code, standard output, standard error."""
    programs = {"urdf-postfix": urdf_postfix.main, "urdf-lint": urdf_lint.main}

    def run(*words: str) -> tuple[int, str, str]:
        capsys.readouterr()
        code = programs.get(words[0], multibot.main)(words[1:])
        return code, *capsys.readouterr()

    return run


@pytest.fixture
def fleet(tmp_path: Path) -> Path:
    """Return a fleet file whose description has a warning."""
    path = tmp_path / "fleet.yaml"
    path.write_text(f"robots:\n  - {{name: robot1, description: {SIBLINGS}}}\n")
    return path


@pytest.fixture
def check(tmp_path: Path, said: Said) -> list[str]:
    """Return a check of twenty robots, each without its robot_state_publisher."""
    plan, graph = tmp_path / "plan.yaml", tmp_path / "graph.json"
    words = ["plan", ROVER, *TWENTY, "--node-set", "robot_state", "--layout", "L2", "-o", str(plan)]
    assert said("multibot", *words)[0] == 0
    wanted = from_yaml(plan.read_bytes(), "plan")
    found = as_planned(wanted)
    for robot in TWENTY:
        found = without_node(found, f"/{robot}/robot_state_publisher")
    graph.write_bytes(to_json(found))
    return ["multibot", "check", str(plan), "--from", str(graph)]


def codes(text: str) -> list[str]:
    return [it["code"] for it in json.loads(text)["findings"]]


def commands(tmp_path: Path, fleet: Path) -> dict[str, list[str]]:
    """Return a command line of each kind with findings, its result in a file."""
    out = str(tmp_path / "out")
    return {
        "urdf-postfix": ["urdf-postfix", SIBLINGS, "robot1", "-o", out],
        "build": ["multibot", "build", str(fleet), "-o", out],
        "urdf-lint": ["urdf-lint", SIBLINGS, "--robots", "robot1"],
    }


@pytest.mark.slow
@pytest.mark.parametrize("name", ["urdf-postfix", "build", "urdf-lint"])
def test_a_description_s_findings(name: str, tmp_path: Path, fleet: Path, said: Said) -> None:
    words = commands(tmp_path, fleet)[name]
    _, out, _ = said(*words, "--format", "json")
    assert "MB405" in codes(out)
    assert codes(said(*words, "--format", "json", "--select", "MB405")[1]) == ["MB405"]
    assert "MB405" not in codes(said(*words, "--format", "json", "--ignore", "MB4,MB1")[1])
    only = ("--select", "MB405", "--ignore", "MB4")
    assert codes(said(*words, "--format", "json", *only)[1]) == ["MB405"]
    assert said(*words, "--fail-on", "warning", "--select", "MB405")[0] == 1
    assert said(*words, "--fail-on", "error", "--select", "MB405")[0] == 0
    # What no known node sends is noted of a fleet alone.
    all_of_it = "MB,MG316" if name == "build" else "MB"
    assert said(*words, "--fail-on", "note", "--ignore", all_of_it)[0] == 0


@pytest.mark.more
@pytest.mark.parametrize("name", ["urdf-postfix", "build"])
def test_nothing_is_written_at_the_level_of_fail_on(
    name: str, tmp_path: Path, fleet: Path, said: Said
) -> None:
    code, out, err = said(*commands(tmp_path, fleet)[name], "--fail-on", "warning")
    assert (code, out) == (1, "")
    assert "nothing was written" in err
    assert not (tmp_path / "out").exists()


@pytest.mark.sample(1)
@pytest.mark.parametrize("form", FORMATS)
@pytest.mark.parametrize("name", ["urdf-postfix", "build", "urdf-lint"])
def test_every_format_tells_the_finding(
    form: str, name: str, tmp_path: Path, fleet: Path, said: Said
) -> None:
    _, out, err = said(*commands(tmp_path, fleet)[name], "--format", form)
    text = err if form == "text" and name != "urdf-lint" else out
    assert text.count("MB405") >= 1


# ---------------------------------------------------------------- tables and graphs


@pytest.mark.slow
def test_twenty_robots_are_one_finding_in_every_format(check: Sequence[str], said: Said) -> None:
    only = ("--select", "MG101", "--format")
    (finding,) = json.loads(said(*check, *only, "json")[1])["findings"]
    assert (finding["robot"], finding["robots"]) == ("robot1", TWENTY)
    assert said(*check, *only, "github")[1].count("::error ") == 1
    assert len(json.loads(said(*check, *only, "gitlab")[1])) == 1
    (run,) = json.loads(said(*check, *only, "sarif")[1])["runs"]
    assert [it["ruleId"] for it in run["results"]] == ["MG101"]
    cases = [case for suite in JUnitXml.fromstring(junit(check, said)) for case in suite]
    assert len(cases) == 1
    assert said(*check, *only, "markdown")[1].count("and 18 more") == 1


def junit(check: Sequence[str], said: Said) -> bytes:
    return said(*check, "--select", "MG101", "--format", "junit")[1].encode()


@pytest.mark.slow
def test_a_report_of_a_check_goes_to_a_file(
    check: Sequence[str], tmp_path: Path, said: Said
) -> None:
    target = tmp_path / "ci" / "check.xml"
    code, out, _ = said(*check, "--format", "junit", "-o", str(target))
    assert (code, out) == (1, "")
    suites: Any = JUnitXml.fromstring(target.read_bytes())
    assert suites.failures > 0


def test_many_warnings_of_one_matter_are_one_line_with_their_number(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """All are there with --verbose and in JSON; of a few each is said."""
    for count, lines in ((48, 1), (4, 4)):
        links = "".join(f'<link name="finger_{it}"/>' for it in range(count))
        parts = "".join(f'\n<grasp part="finger_{it}"/>' for it in range(count))
        file = tmp_path / "hand.urdf"
        file.write_text(f'<robot name="hand">{links}\n<custom>{parts}</custom></robot>')
        command = [str(file), "left", "-o", str(tmp_path / "out.urdf")]
        urdf_postfix.main(command)
        said = [it for it in capsys.readouterr().err.splitlines() if "MB901" in it]
        assert len(said) == lines
        assert (f"{count - 1} more of this kind in the file, at lines 4, 5" in said[0]) == (
            lines == 1
        )
        urdf_postfix.main([*command, "--verbose", "--force"])
        assert capsys.readouterr().err.count("MB901") == count
        urdf_postfix.main([*command, "--format", "json", "--force"])
        assert capsys.readouterr().out.count('"MB901"') == count


def test_of_many_notes_three_are_told_and_the_lines_of_the_rest(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Warnings with remedies of their own are told each, and so is what has no line."""
    notes = [Finding("MR901", NOTE, f"note {at}", file="a.yaml", line=at) for at in range(1, 7)]
    others = [
        Finding("MR902", WARNING, f"word {at}", f"do {at}", "a.yaml", at) for at in range(1, 7)
    ]
    options = argparse.Namespace(
        format="text", verbose=False, quiet=False, color="never", fail_on="error",
        program="multibot", command="build",
    )  # fmt: skip
    found = [*notes, notes[0]._replace(message="of the file", line=0), *others]
    report_findings_too(options, found, About(["a.yaml"], {}))
    said = capsys.readouterr().err
    told = [it for it in range(1, 7) if f"note {it}" in said]
    assert told == [1, 2, 3] and "of the file" in said
    assert "there are 3 more such notes in the file, at lines 4, 5, 6" in said
    assert [it for it in range(1, 7) if f"word {it}" in said] == [*range(1, 7)]
