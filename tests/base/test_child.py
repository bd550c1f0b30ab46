# SPDX-License-Identifier: Apache-2.0
"""Child processes are made in one place, and run nothing of the folder that they are in."""

from __future__ import annotations

import json
import os
import re
import subprocess
from pathlib import Path

import pytest
from paths import ROOT

from multibot_rewrite.base.child import isolated, python
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.lint.config.changed import changed_since

PACKAGE = ROOT / "multibot_rewrite"
# Who may say how a process of Python or git begins.
ONLY = PACKAGE / "base" / "child.py"


@pytest.mark.more
def test_nobody_else_says_how_a_child_of_python_begins() -> None:
    others = [path for path in PACKAGE.rglob("*.py") if path != ONLY]
    said = re.compile(r"\[\s*sys\.executable|\(\s*sys\.executable|\"git\"")
    assert [str(path) for path in others if said.search(path.read_text())] == []


def test_children_run_without_the_garbage_collector(tmp_path: Path) -> None:
    (tmp_path / "short.py").write_text("import gc\nmain = lambda: print(gc.isenabled())\nmain()\n")
    environ = {**os.environ, "PYTHONPATH": str(tmp_path)}
    for command in (python("short"), [*isolated("short")[:-1], json.dumps([str(tmp_path)])]):
        said = subprocess.run(command, env=environ, capture_output=True, text=True, check=True)
        assert set(said.stdout.split()) == {"False"}


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
