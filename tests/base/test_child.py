"""Child processes are made in one place, and run nothing of the folder that they are in."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from paths import ROOT

from multibot_rewrite.base.child import git, isolated, python, search_path, variables
from multibot_rewrite.base.start.module import safe_path

PACKAGE = ROOT / "multibot_rewrite"
# Who may say how a process of Python or git begins.
ONLY = PACKAGE / "base" / "child.py"


def _planted(folder: Path, *names: str) -> Path:
    """Modules that tell when they are run."""
    for name in names:
        (folder / name).write_text("open('ran', 'w').close()\nraise SystemExit(9)\n")
    return folder / "ran"


@pytest.mark.more
def test_nobody_else_says_how_a_child_of_python_begins() -> None:
    others = [path for path in PACKAGE.rglob("*.py") if path != ONLY]
    said = re.compile(r"\[\s*sys\.executable|\(\s*sys\.executable|\"git\"")
    assert [str(path) for path in others if said.search(path.read_text())] == []


def test_modules_of_the_current_folder_are_not_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ran = _planted(tmp_path, "rclpy.py", "yaml.py", "multibot_rewrite.py", "lxml.py", "json.py")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", os.pathsep)
    command = python("multibot_rewrite.cli.urdf_lint", "--version")
    done = subprocess.run(command, env=variables(), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert not ran.exists()


def test_a_path_of_search_has_no_current_folder(tmp_path: Path) -> None:
    here = str(tmp_path)
    found = safe_path(["", ".", here, "/opt/ros", str(ROOT)], here)
    assert found == ["/opt/ros", str(ROOT)]
    assert safe_path(["/opt/ros"], here) == [str(ROOT), "/opt/ros"]
    assert os.getcwd() not in search_path() or os.getcwd() == str(ROOT)


def test_relative_parts_of_a_variable_are_left_out() -> None:
    given = {"PYTHONPATH": os.pathsep.join(("", "here", "/opt/ros")), "A": "b"}
    assert variables(given) == {"PYTHONPATH": "/opt/ros", "A": "b"}


def test_an_isolated_child_keeps_that_no_bytecode_is_written(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    assert "-B" in isolated("x")
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    assert "-B" not in isolated("x")


def test_git_runs_no_program_of_a_repository(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A monitor, a hook, a filter and a pager of ``.git/config``."""
    monkeypatch.chdir(tmp_path)
    ran = tmp_path / "ran"
    program = tmp_path / "program"
    program.write_text(f"#!/bin/sh\necho x > {ran}\ncat\n")
    program.chmod(0o755)
    own = ("-c", "user.name=a", "-c", "user.email=a@b")
    for words in (["init", "-q"], ["add", "program"], [*own, "commit", "-qm", "x"]):
        subprocess.run(["git", *words], check=True, capture_output=True)
    for key in ("core.fsmonitor", "filter.x.clean", "filter.x.smudge", "core.pager"):
        subprocess.run(["git", "config", key, str(program)], check=True)
    (tmp_path / ".gitattributes").write_text("* filter=x\n")
    program.write_text(program.read_text() + "# more\n")
    listed = git("diff", "--name-only", "-z", "--no-ext-diff", "HEAD", "--")
    assert b"program" in listed
    assert b".gitattributes" in git("ls-files", "-z", "--others", "--exclude-standard")
    assert not ran.exists()
