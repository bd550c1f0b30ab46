# SPDX-License-Identifier: Apache-2.0
"""The pages say what the program does: the commands that they show run."""

from __future__ import annotations

import re
from importlib.util import find_spec
from pathlib import Path

import live_commands
import page_commands
import pytest
from paths import ROOT

README = (ROOT / "README.md").read_text()
REWRITE = (ROOT / "docs" / "rewrite.md").read_text()
REMAP = (ROOT / "docs" / "plan.md").read_text()
PROGRAMS = ("urdf-lint", "urdf-postfix", "multibot")
COMMANDS = re.findall(
    r"^    (urdf-postfix (?:fixtures|--why).*|urdf-lint .*|multibot .*)$",
    README + REWRITE,
    re.MULTILINE,
)
# Writes the fleet file that the next commands read.
FIRST = "multibot init examples/launch_tutorial/rover.urdf -n 2 -o rovers.yaml"
(START,) = re.findall(
    r"^(multibot init .*)$", (ROOT / "docs" / "index.md").read_text(), re.MULTILINE
)
TRANSCRIPTS = page_commands.sections(README + REMAP)


def readers_folder(folder: Path, **more: str) -> page_commands.Reader:
    """Return a clone of the repository."""
    return page_commands.reader(folder, live_commands.domain(90), **more)


def test_the_readme_shows_commands() -> None:
    assert {line.split()[0] for line in COMMANDS} == set(PROGRAMS)


# The pages of the examples have it too, and it is rehearsed with them.
AGAIN = "multibot rehearse examples/"


@pytest.mark.slow
@pytest.mark.parametrize(
    "line",
    [
        pytest.param(it, marks=[pytest.mark.deep] if it.startswith(AGAIN) else [])
        for it in (*COMMANDS, START)
    ],
)
def test_a_command_of_the_readme_runs(line: str, tmp_path: Path) -> None:
    if line.startswith(page_commands.LIVE) and not page_commands.has_ros():
        pytest.skip("no rclpy: pip install '.[ros]'")
    if line.startswith("multibot view") and not find_spec("trimesh"):
        pytest.skip("no trimesh: pip install '.[view]'")
    reader = readers_folder(tmp_path)
    for one in (FIRST, line) if "rovers.yaml" in line and line != FIRST else (line,):
        done = reader.run(one)
        assert done.returncode == 0, done.stdout


def test_every_command_with_a_prompt_is_a_transcript() -> None:
    found = [it.command for commands in TRANSCRIPTS.values() for it in commands]
    assert found == re.findall(r"^\$ (.*)$", README + REMAP, re.MULTILINE)
    assert {it.split()[0] for it in found} == {"urdf-lint", "multibot", "grep"}


@pytest.mark.slow
@pytest.mark.live
@pytest.mark.parametrize(
    "heading",
    [
        pytest.param(it, marks=[pytest.mark.deep] if page_commands.is_live(commands) else [])
        for it, commands in TRANSCRIPTS.items()
    ],
)
def test_a_transcript_of_the_readme_is_the_whole_output(
    heading: str, tmp_path: Path, tf2: dict[str, str]
) -> None:
    there = readers_folder(tmp_path, **tf2)
    there.run("cp examples/launch_tutorial/rover.urdf .")
    for it in TRANSCRIPTS[heading]:
        if page_commands.is_live([it]) and not page_commands.has_ros():
            pytest.skip("no rclpy: pip install '.[ros]'")
        done = there.run(it.command)
        printed = tuple(line.rstrip() for line in done.stdout.splitlines())
        assert (done.returncode, printed) == (it.code, it.lines), it.command


@pytest.mark.slow
def test_the_readme_shows_what_its_first_command_prints(tmp_path: Path) -> None:
    (command,) = re.findall(r"^    python3 .*/bin/(urdf-postfix .*)$", README, re.MULTILINE)
    (shown,) = re.findall(r"^    (urdf-postfix: .*)$", README, re.MULTILINE)
    done = readers_folder(tmp_path).run(command)
    assert (done.returncode, done.stdout) == (0, f"{shown}\n")
    assert {it.name for it in (tmp_path / "out").iterdir()} == {"robot1.urdf", "robot2.urdf"}


@pytest.mark.slow
def test_the_readme_diff_is_what_the_command_prints(tmp_path: Path) -> None:
    """Lines are left out of it, none is changed or moved."""
    (command,) = re.findall(r"`(urdf-postfix [^`]* --diff)`", README)
    (shown,) = re.findall(r"```diff\n(.*?)```", README, re.DOTALL)
    printed = iter(readers_folder(tmp_path).run(command).stdout.splitlines())
    missing = [line for line in shown.splitlines() if line not in printed]
    assert missing == []


def test_the_python_example_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    page = ROOT / "docs" / "api.md"
    code, *_ = re.findall(r"```python\n(.*?)```", page.read_text(), re.DOTALL)
    exec(compile(code, page, "exec"), {})


def test_the_readme_is_short() -> None:
    assert len(README.split()) < 900
