# SPDX-License-Identifier: Apache-2.0
"""Lists without parameters, sections of no controller: in a file alone."""

from __future__ import annotations

from pathlib import Path

import pytest
from closed_robot import FILES

from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.rules.settings import Settings


def linted(text: str, folder: Path, code: str) -> list[tuple[int, str]]:
    (folder / "p.yaml").write_text(text)
    found = lint_file(str(folder / "p.yaml"), Settings(select=(code,)))
    return [(it.line, it.hint.split("(")[0].strip()) for it in found]


@pytest.mark.parametrize(
    ("rest", "meant"),
    [
        ("sources: [frnt], front: {a: 1}", "front"),
        ("layer: {sources: frnt, front: {a: 1}}", "front"),
        # What is listed elsewhere is not meant, nor what differs in a number or is on another level.
        ("sources: [frnt], others: [front], front: {a: 1}", ""),
        ("sources: [front1], front2: {a: 1}", ""),
        ("sources: [frnt], more: {front: {a: 1}}", ""),
        # A name with a dot has its parameters below two names.
        ("file: front_a.pcd, front_a.pcd: {a: 1}, front_b.pcd: {a: 1}", ""),
    ],
)
def test_a_listed_name_without_parameters(rest: str, meant: str, tmp_path: Path) -> None:
    found = linted(f"node:\n  ros__parameters: {{{rest}}}\n", tmp_path, "MB877")
    assert found == ([(2, f"did you mean {meant}")] if meant else [])


CONTROLLERS = FILES["controllers.yaml"]


def test_a_section_that_nobody_declares(tmp_path: Path) -> None:
    assert linted(CONTROLLERS, tmp_path, "MB878") == []
    renamed = CONTROLLERS.replace("base_controller:\n  ros", "base_controler:\n  ros")
    assert linted(renamed, tmp_path, "MB878") == [(7, "did you mean base_controller")]
