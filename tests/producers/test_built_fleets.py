"""The built launch file of every example: nothing is wrong with what it starts, and all is planned."""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import ROOT

from multibot_rewrite.cli.multibot import main

EXAMPLES = sorted((ROOT / "examples").rglob("fleet*.yaml"))


@pytest.mark.sample(4)
@pytest.mark.slow
@pytest.mark.parametrize("fleet", EXAMPLES, ids=lambda it: f"{it.parent.name}-{it.stem}")
def test_an_example_starts_as_planned(fleet: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert main(["build", str(fleet), "-o", str(out), "-q", "--trust"]) == 0
    launched = ["check-launch", str(out / "fleet.launch.py")]
    assert main(launched) == 0
    assert main([*launched, "--plan", str(out / "plan.yaml")]) == 0


def test_the_examples_are_there() -> None:
    assert len(EXAMPLES) > 7
