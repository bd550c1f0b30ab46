# SPDX-License-Identifier: Apache-2.0
"""Shell completions and manual pages: kept in share/, and what the declared options make of them."""

from __future__ import annotations

import runpy
import shutil
import subprocess

import pytest
from paths import ROOT

SHARE = ROOT / "share"
FOLDERS = ("bash-completion", "fish", "zsh", "man")


@pytest.mark.parametrize("folder", FOLDERS)
def test_the_files_are_what_the_options_make(folder: str) -> None:
    pytest.importorskip("shtab", reason="no shtab: pip install '.[test]'")
    pytest.importorskip("argparse_manpage", reason="no argparse-manpage: pip install '.[test]'")
    every = runpy.run_path(str(SHARE / "make.py"))["made"]()
    made = {name: text for name, text in every.items() if name.startswith(folder)}
    paths = [path for path in (SHARE / folder).rglob("*") if path.is_file()]
    kept = {str(path.relative_to(SHARE)): path.read_text() for path in paths}
    stale = [name for name in {*made, *kept} if made.get(name) != kept.get(name)]
    assert stale == [], "run python share/make.py"


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        (["multibot", "sna"], "snapshot"),
        (["multibot", "plan", "--layo"], "--layout"),
        (["multibot", "plan", "--layout", "frames"], "frames-per-robot"),
        (["multibot", "check", "--format", "sa"], "sarif"),
        (["multibot", "plan", "--node-set", "slam_t"], "slam_toolbox"),
        (["urdf-postfix", "--in-p"], "--in-place"),
        (["urdf-lint", "--fail-on", "w"], "warning"),
    ],
)
def test_bash_offers_what_fits(words: list[str], offered: str) -> None:
    if not shutil.which("bash"):
        pytest.skip("no bash here")
    program, *_, word = words
    script = (
        f"source {SHARE}/bash-completion/completions/{program}; COMP_WORDS=({' '.join(words)});"
        f" COMP_CWORD={len(words) - 1}; _shtab_{program.replace('-', '_')} {program} {word}"
        f" {words[-2]}; echo ${{COMPREPLY[@]}}"
    )
    done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.split() == [offered]
