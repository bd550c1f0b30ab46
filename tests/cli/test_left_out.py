# SPDX-License-Identifier: Apache-2.0
"""What commands leave out of folders: what a build made, and what colcon or git ignores."""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from multibot_rewrite.cli import urdf_lint
from multibot_rewrite.description.sources import included_by
from multibot_rewrite.proposal.searching import search
from multibot_rewrite.refactor.named_elsewhere import files_below

ROBOT = '<robot name="{}"><link name="base"/><link name="lost"/></robot>'
GIT = (
    "git",
    "-c",
    "user.name=t",
    "-c",
    "user.email=t@example.org",
    "-c",
    "init.defaultBranch=main",
)
FILES = (
    "src/arm/a.urdf", "build/arm/b.urdf", "install/arm/c.urdf", "log/d.urdf", "old/e.urdf",
    "old/deep/f.urdf", "other/g.urdf", "src/arm/gen/h.urdf", "src/arm/i.tmp.urdf",
    "src/arm/kept.tmp.urdf",
)  # fmt: skip
SOURCES = ["src/arm/a.urdf", "src/arm/kept.tmp.urdf"]


@pytest.fixture
def workspace(here: Path) -> Path:
    """Return a workspace that was built, of which git ignores some files, one of them tracked."""
    for name in FILES:
        (here / name).parent.mkdir(parents=True, exist_ok=True)
        (here / name).write_text(ROBOT.format(Path(name).stem.replace(".", "_")))
    (here / "old" / "COLCON_IGNORE").touch()
    (here / "other" / "AMENT_IGNORE").touch()
    (here / "src" / "arm" / ".gitignore").write_text("gen/\n*.tmp.urdf\n")
    run(here, "init", "-q")
    run(here, "add", "-f", "src/arm/a.urdf", "src/arm/kept.tmp.urdf")
    run(here, "commit", "-qm", "first")
    return here


def run(folder: Path, *words: str) -> None:
    subprocess.run([*GIT, *words], cwd=folder, check=True)


Linted = Callable[..., tuple[list[str], str]]


@pytest.fixture
def linted(capsys: pytest.CaptureFixture[str]) -> Linted:
    """Return the files that a lint finds something in, and what it says on standard error."""

    def lint(*words: str) -> tuple[list[str], str]:
        assert urdf_lint.main([*words, "--select", "MB501"]) in (0, 1)
        out, err = capsys.readouterr()
        return sorted(line.partition(":")[0] for line in out.splitlines()), err

    return lint


def test_a_built_workspace_is_linted_in_its_sources(workspace: Path, linted: Linted) -> None:
    found, said = linted(".")
    assert found == SOURCES
    assert said.startswith(
        "urdf-lint: left out: 5 folders (./build, ./install, ./log and 2 more) and 2 files that git"
        " ignores; --no-default-excludes reads them\n"
    )
    assert linted(".", "--no-default-excludes")[0] == sorted(FILES)
    assert "left out" not in linted(".", "--no-default-excludes")[1]
    assert linted(".", "-q")[1] == ""


@pytest.mark.parametrize(
    ("named", "found"),
    [
        (["build"], ["build/arm/b.urdf"]),
        (["old"], ["old/deep/f.urdf", "old/e.urdf"]),
        (["src/arm/gen"], ["src/arm/gen/h.urdf"]),
        (["src/arm/i.tmp.urdf"], ["src/arm/i.tmp.urdf"]),
        (["src/arm/gen", "src"], [*SOURCES[:1], "src/arm/gen/h.urdf", *SOURCES[1:]]),
        (["src/arm/i.tmp.urdf", "src"], [*SOURCES[:1], "src/arm/i.tmp.urdf", *SOURCES[1:]]),
    ],
)
def test_what_is_named_is_linted(
    workspace: Path, linted: Linted, named: Sequence[str], found: list[str]
) -> None:
    assert linted(*named)[0] == found


def test_nothing_left_to_read_says_what_was_left_out(
    workspace: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (workspace / "only" / "build").mkdir(parents=True)
    (workspace / "only" / "build" / "a.urdf").write_text(ROBOT.format("a"))
    assert urdf_lint.main(["only"]) == 2
    assert capsys.readouterr().err.endswith(
        "there; left out: 1 folder (only/build); --no-default-excludes reads them\n"
    )


def test_without_git_nothing_is_ignored(
    workspace: Path, linted: Linted, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(workspace))
    assert "src/arm/gen/h.urdf" in linted("src")[0]


def test_the_other_commands_leave_the_same_folders_out(workspace: Path) -> None:
    """init, rename and adopt, and the search for what includes a xacro."""
    looked = [it for it in FILES if it.startswith("src/")]
    assert sorted(files_below(".", (".urdf",))) == looked
    assert sorted(search(["."]).every) == looked
    for name in ("build/p.xacro", "old/p.xacro", "src/p.xacro"):
        (workspace / name).write_text("<robot/>")
    assert included_by._xacro_files(".") == ["src/p.xacro"]
