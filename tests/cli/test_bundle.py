"""The compiled modules in one file: what is out of date, damaged or not the reader's is not used."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from paths import ROOT

from multibot_rewrite.cli.bundle import Bundle
from multibot_rewrite.cli.urdf_lint import main

PACKAGE = "multibot_rewrite"
# The command, and where its modules came from.
PROGRAM = """
import atexit, sys
from multibot_rewrite.cli.bundle import Bundle
from multibot_rewrite.cli.urdf_lint import main
def told():
    ours = {n: type(m.__loader__).__name__ for n, m in sys.modules.items() if n.startswith("multi")}
    print(*(f"{n}={kind}" for n, kind in ours.items()), file=sys.stderr)
atexit.register(told)
main()
"""
ROBOT = '<robot name="r"><link name="a"/><link name="a"/></robot>'
# Loaded before there is a bundle to ask.
FIRST = {PACKAGE, *(f"{PACKAGE}.{it}" for it in ("cli", "version", "cli.urdf_lint", "cli.bundle"))}


class Copy:
    """A copy of the package, whose sources may be changed."""

    def __init__(self, folder: Path) -> None:
        self.package = folder / PACKAGE
        shutil.copytree(ROOT / PACKAGE, self.package, ignore=shutil.ignore_patterns("__pycache__"))
        self.robot = folder / "robot.urdf"
        self.robot.write_text(ROBOT)

    def lint(self, *options: str, **environment: str) -> tuple[str, set[str]]:
        """What a lint prints, and the modules that came from the bundle."""
        kept = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
        command = [sys.executable, "-c", PROGRAM, str(self.robot), "--no-cache", "-q", *options]
        run = subprocess.run(
            command,
            cwd=self.package.parent,
            env={**kept, **environment},
            capture_output=True,
            text=True,
            check=False,
        )
        told = dict(it.split("=") for it in run.stderr.split())
        assert run.returncode == 1, run.stderr
        assert told.keys() > FIRST
        return run.stdout, {it for it, kind in told.items() if kind == "_Loader"}

    @property
    def bundle(self) -> Path:
        (found,) = self.package.glob("cli/__pycache__/bundle.*.modules")
        return found

    def change(self, module: str, old: str, new: str) -> None:
        path = self.package / module
        text = path.read_text()
        assert old in text
        path.write_text(text.replace(old, new))


@pytest.fixture(scope="module")
def linted(tmp_path_factory: pytest.TempPathFactory) -> Copy:
    """A copy that has its bundle; a test leaves it so."""
    copy = Copy(tmp_path_factory.mktemp("package"))
    _, bundled = copy.lint()
    assert bundled == set()
    return copy


def test_the_second_run_takes_all_modules_from_one_file(linted: Copy) -> None:
    before = linted.bundle.stat().st_ino
    text, bundled = linted.lint()
    assert "MB201" in text
    assert {f"{PACKAGE}.lint.rules", f"{PACKAGE}.lint.rules.references.duplicates"} < bundled
    # Nothing was missing, so nothing was written.
    assert linted.bundle.stat().st_ino == before
    assert {it.suffix for it in linted.bundle.parent.iterdir()} == {".pyc", ".modules"}


def test_a_changed_source_counts_at_once(linted: Copy) -> None:
    module = f"{PACKAGE}.lint.rules.references.duplicates"
    linted.change("lint/rules/references/duplicates.py", "is declared twice", "is there twice")
    text, bundled = linted.lint()
    assert "is there twice" in text
    assert module not in bundled
    text, again = linted.lint()
    assert "is there twice" in text
    assert again == {*bundled, module}


def test_a_module_that_is_gone_is_gone(linted: Copy) -> None:
    """Its code is still in the bundle."""
    home, away = linted.package / "plural.py", linted.package / "plural.txt"
    home.rename(away)
    program = f"import {PACKAGE}.cli.bundle as b; b.use_bundle(); import {PACKAGE}.plural"
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=linted.package.parent,
        capture_output=True,
        text=True,
        check=False,
    )
    away.rename(home)
    assert f"No module named '{PACKAGE}.plural'" in done.stderr


def test_modules_of_another_task_are_added(linted: Copy) -> None:
    linted.lint("--format", "json")
    _, bundled = linted.lint("--format", "json")
    assert f"{PACKAGE}.lint.registry" in bundled
    assert f"{PACKAGE}.findings.formats.text" not in bundled
    assert f"{PACKAGE}.findings.formats.text" in linted.lint()[1]


@pytest.mark.parametrize("data", [b"", b"0", b"00000008", b"zzzzzzzz", b"0000ffff" + bytes(99)])
def test_a_damaged_file_has_nothing(data: bytes, tmp_path: Path) -> None:
    path = tmp_path / "bundle.modules"
    path.write_bytes(data)
    assert Bundle(str(path)).find_spec(f"{PACKAGE}.plural") is None


def test_a_damaged_file_is_replaced(linted: Copy) -> None:
    linted.bundle.write_bytes(linted.bundle.read_bytes()[:100])
    text, bundled = linted.lint()
    assert ("MB201" in text, bundled) == (True, set())
    assert linted.lint()[1] != set()


def test_a_package_that_was_moved_has_no_bundle_yet(linted: Copy, tmp_path: Path) -> None:
    """Its code names the files of the old place."""
    shutil.copytree(linted.package, tmp_path / PACKAGE)
    moved = Copy.__new__(Copy)
    moved.package, moved.robot = tmp_path / PACKAGE, linted.robot
    assert moved.lint()[1] == set()
    assert moved.lint()[1] != set()


def test_nothing_is_written_where_python_writes_nothing(linted: Copy) -> None:
    linted.bundle.unlink()
    linted.lint(PYTHONDONTWRITEBYTECODE="1")
    assert list(linted.package.glob("cli/__pycache__/bundle.*.modules*")) == []
    linted.lint()
    assert linted.bundle


def test_what_cannot_be_written_is_not_told(linted: Copy) -> None:
    path = linted.bundle
    path.unlink()
    path.mkdir()
    text, bundled = linted.lint()
    assert ("MB201" in text, bundled) == (True, set())
    assert {it.suffix for it in path.parent.iterdir()} == {".pyc", ".modules"}
    path.rmdir()
    linted.lint()


def test_a_call_from_a_program_leaves_its_imports_alone(tmp_path: Path) -> None:
    before = list(sys.meta_path)
    main([str(tmp_path / "no.urdf")])
    assert sys.meta_path == before


def test_a_source_of_the_same_size_and_another_time_is_read(linted: Copy) -> None:
    path, name = linted.package / "lint/check.py", f"{PACKAGE}.lint.check"
    assert name in linted.lint()[1]
    os.utime(path, ns=(0, path.stat().st_mtime_ns + 10**9))
    assert name not in linted.lint()[1]
