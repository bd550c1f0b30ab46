"""The pages say what the program does: generated ones are current, shown commands run."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from paths import ROOT

from multibot_rewrite.catalogue import findings_page
from multibot_rewrite.lint.__main__ import rules_page
from multibot_rewrite.rewriters.vocabulary.__main__ import page

README = (ROOT / "README.md").read_text()
COMMANDS = re.findall(
    r"^    (urdf-postfix fixtures.*|urdf-lint .*|multibot .*)$", README, re.MULTILINE
)
MODULES = {
    "urdf-lint": "multibot_rewrite.cli.urdf_lint",
    "urdf-postfix": "multibot_rewrite.cli.urdf_postfix",
    "multibot": "multibot_rewrite.cli.multibot",
}


def test_the_page_of_plugins_is_current() -> None:
    assert (ROOT / "docs" / "plugins.md").read_text() == page()


def test_the_page_of_rules_is_current() -> None:
    assert (ROOT / "docs" / "lint-rules.md").read_text() == rules_page()


def test_the_readme_shows_commands() -> None:
    assert len(COMMANDS) >= 3
    assert {line.split()[0] for line in COMMANDS} == set(MODULES)


@pytest.mark.slow
@pytest.mark.parametrize("line", COMMANDS)
def test_a_command_of_the_readme_runs(line: str, tmp_path: Path) -> None:
    words = shlex.split(line.replace("out/", f"{tmp_path}/"))
    command = [sys.executable, "-m", MODULES[words[0]], *words[1:]]
    result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr


def test_the_readme_diff_is_what_the_command_prints() -> None:
    shown = re.search(r"```diff\n(.*?)```", README, re.DOTALL)
    assert shown is not None
    command = [sys.executable, "-m", "multibot_rewrite.cli.urdf_postfix"]
    arguments = ["fixtures/robots/rover.urdf", "robot1", "--diff"]
    printed = subprocess.run(
        command + arguments, cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout.splitlines()
    missing = [line for line in shown[1].splitlines() if line[:1] in "+-" and line not in printed]
    assert missing == []


def test_the_readme_findings_are_what_the_command_prints() -> None:
    shown = re.search(r"\$ (urdf-lint .*)\n((?:fixtures.*\n)+)", README)
    assert shown is not None
    command = [sys.executable, "-m", MODULES["urdf-lint"], *shlex.split(shown[1])[1:]]
    result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    printed = [line for line in result.stdout.splitlines() if "note:" not in line]
    assert (result.returncode, printed) == (1, shown[2].splitlines())


def test_the_readme_python_example_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    (code,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    exec(compile(code, "README.md", "exec"), {})


def test_the_page_of_findings_is_current() -> None:
    assert (ROOT / "docs" / "findings.md").read_text() == findings_page()
