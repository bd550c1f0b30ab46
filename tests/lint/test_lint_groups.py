# SPDX-License-Identifier: Apache-2.0
"""The groups of rules are complete, and what rules share of one document stays with it."""

from __future__ import annotations

import subprocess
import sys
from importlib import import_module
from pathlib import Path
from pkgutil import walk_packages

import pytest

from multibot_rewrite.base.findings.finding import URDF, Rule
from multibot_rewrite.lint.groups import GROUPS, active_rules, rules_of
from multibot_rewrite.lint.registry import RULES
from multibot_rewrite.rules import description as rules, files
from multibot_rewrite.rules.settings import Settings

MESHES = b"""<robot name="r"><link name="a"><visual><geometry><mesh filename="a.stl"/></geometry>
</visual></link></robot>"""


def test_every_rule_is_in_its_group() -> None:
    homes = {rule.code: group.start for group in GROUPS for rule in rules_of(group)}
    assert homes == {code: code[:3] if code.startswith("MB") else "MB4" for code in RULES}


def test_no_rule_of_a_format_is_left_out() -> None:
    """Groups without rules for a URDF are not even loaded for one."""
    formats = {it for rule in RULES.values() for it in rule.formats} - {"rewrite"}
    assert URDF in formats
    for format_ in formats:
        active = [it.code for it in active_rules(Settings(robots=("robot1",)), format_)]
        assert active == [code for code, it in RULES.items() if format_ in it.formats]


@pytest.mark.slow
def test_a_lint_of_a_urdf_loads_nothing_for_other_files(tmp_path: Path) -> None:
    file = tmp_path / "a.urdf"
    file.write_bytes(MESHES)
    program = (
        "import sys; from multibot_rewrite.cli.urdf_lint import main; "
        "main([sys.argv[1], '--trust']); print(*sys.modules)"
    )
    command = [sys.executable, "-c", program, str(file)]
    run = subprocess.run(command, capture_output=True, text=True, check=True, cwd=tmp_path)
    others = (
        *(
            "lint.registry",
            "rules.description.srdf",
            "rules.description.multirobot.meeting",
            "lint.cache.cache",
            "lint.config.directives",
        ),
        *(
            "description.sources.access",
            "description.rewriters.patterns",
            "planning.bridged_topics",
        ),
    )
    loaded = set(run.stdout.splitlines()[-1].split())
    assert "multibot_rewrite.rules.description.meshes" in loaded
    assert loaded & {"tomllib", *(f"multibot_rewrite.{it}" for it in others)} == set()


def test_no_file_of_rules_is_left_out_of_its_group() -> None:
    rooms = (rules, files)
    names = [it.name for room in rooms for it in walk_packages(room.__path__, f"{room.__name__}.")]
    written = (vars(import_module(name)).values() for name in names)
    declared = {it.code for values in written for it in values if isinstance(it, Rule)}
    assert declared == set(RULES)
