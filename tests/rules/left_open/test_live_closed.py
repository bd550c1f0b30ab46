# SPDX-License-Identifier: Apache-2.0
"""The plan that follows from a robot's own files, on a real graph: nothing is missing or too much."""

from __future__ import annotations

from pathlib import Path

import pytest
from closed_robot import FILES
from paths import write_files

from multibot_rewrite.cli.multibot import main

pytestmark = pytest.mark.live


@pytest.mark.deep
@pytest.mark.parametrize(
    "layout", ["postfix", pytest.param("frames-per-robot", marks=pytest.mark.deep)]
)
def test_the_plan_of_a_robot_s_own_files_holds(
    layout: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_files(tmp_path, FILES)
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(f"layout: {layout}\n{FILES['fleet.yaml']}")
    assert main(["rehearse", str(fleet), "--select", "MG"]) == 0
    err = capsys.readouterr().err
    assert "2 robots, " in err and ", all seen; 0 findings: as planned" in err
