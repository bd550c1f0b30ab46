# SPDX-License-Identifier: Apache-2.0
"""Child processes are made in one place, and run nothing of the folder that they are in."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from paths import ROOT

from multibot_rewrite.base.child import isolated, python, search_path, variables
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.start.module import safe_path
from multibot_rewrite.lint.config.changed import changed_since

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


def test_an_isolated_child_finds_what_was_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    """It sees no variable, and may have another working directory."""
    monkeypatch.setattr(sys, "pycache_prefix", "compiled")
    assert f"pycache_prefix={os.path.abspath('compiled')}" in isolated("x")
    monkeypatch.setattr(sys, "pycache_prefix", None)
    assert not any("pycache_prefix" in it for it in isolated("x")[:-1])


def test_git_runs_no_program_of_a_repository(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A monitor, a hook, a filter and a pager of ``.git/config``, also of a submodule, and of a remote
    that has what is missing."""
    ran, program, own = tmp_path / "ran", tmp_path / "program", tmp_path / "own"
    program.write_text(f"#!/bin/sh\necho x > {ran}\ncat\n")
    program.chmod(0o755)
    for folder in (own / "sub", own):
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "a.urdf").write_text("<robot/>")
        _git(folder, "init", "-q")
        _git(folder, "add", ".")
        _git(folder, "-c", "user.name=a", "-c", "user.email=a@b", "commit", "-qm", "x")
    for folder in (own, own / "sub"):
        name = f"filter.{folder.name}"
        for key in ("core.fsmonitor", f"{name}.clean", f"{name}.smudge", "core.pager"):
            _git(folder, "config", key, str(program))
        (folder / ".gitattributes").write_text(f"* filter={folder.name}\n")
        (folder / "a.urdf").write_text("<robot></robot>")
    monkeypatch.chdir(own)
    assert changed_since("HEAD", ["a.urdf", "sub/a.urdf"]) == ["a.urdf", "sub/a.urdf"]
    assert not ran.exists()
    tree = _git(own, "rev-parse", "HEAD^{tree}").strip()
    (own / ".git" / "objects" / tree[:2] / tree[2:]).unlink()
    remote = {"url": f"{own}", "uploadpack": str(program), "promisor": "true"}
    settings = {f"remote.away.{key}": value for key, value in remote.items()}
    for key, value in (settings | {"extensions.partialClone": "away"}).items():
        _git(own, "config", key, value)
    with pytest.raises(UsageError):
        changed_since("HEAD", ["a.urdf"])
    assert not ran.exists()


def _git(folder: Path, *words: str) -> str:
    return subprocess.run(
        ["git", "-C", folder, *words], check=True, capture_output=True, text=True
    ).stdout
