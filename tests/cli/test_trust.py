# SPDX-License-Identifier: Apache-2.0
"""Every command that reads a xacro file expands it behind the fences, and ``--trust`` lifts them."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from paths import FIXTURES

from multibot_rewrite import InputError, explain, load_fleet, rewrite, rewrite_all
from multibot_rewrite.cli import multibot, urdf_lint, urdf_postfix
from multibot_rewrite.cli.declared.commands import COMMANDS, PROGRAMS

HOSTILE = (FIXTURES / "hostile" / "lambda_system.xacro").read_text()
# As a description that can be rewritten once its command has run.
ROBOT = HOSTILE.replace('<link name="${', '<link name="base${').replace(
    'name="target" default=""', 'name="target" default="TARGET"'
)
FLEET = "description: r.urdf.xacro\nrobots:\n  - {name: robot1}\n  - {name: robot2}\n"
PATH = "r.urdf.xacro"
# What is run -> its exit code for a file that is not trusted.
COMMAND_LINES: dict[str, tuple[Callable[[Sequence[str]], int], list[str], int]] = {
    "urdf-postfix": (urdf_postfix.main, [PATH, "robot1", "-o", "out.urdf"], 2),
    "urdf-postfix --why": (urdf_postfix.main, ["--why", f"{PATH}:10"], 2),
    "urdf-lint": (urdf_lint.main, [PATH, "--select", "MB103"], 1),
    "inspect": (multibot.main, ["inspect", PATH], 2),
    "build": (multibot.main, ["build", "fleet.yaml", "-o", "out"], 2),
    "check": (multibot.main, ["check", "fleet.yaml", "--from", "graph.json"], 2),
    "check-launch": (multibot.main, ["check-launch", "r.launch.py", "--plan", "fleet.yaml"], 2),
    "init": (multibot.main, ["init", PATH, "-o", "-"], 2),
    "plan": (multibot.main, ["plan", PATH, "robot1", "--node-set", "nav2"], 2),
    "plan of a fleet": (multibot.main, ["plan", "fleet.yaml"], 2),
    "plan --output-kind": (
        multibot.main,
        ["plan", "--output-kind=table", PATH, "robot1", "--node-set", "nav2"],
        2,
    ),
    "rehearse": (multibot.main, ["rehearse", PATH, "robot1", "--node-set", "nav2"], 2),
    "view": (multibot.main, ["view", PATH, "-o", "-"], 2),
    "adopt": (multibot.main, ["adopt", "."], 2),
    "join": (multibot.main, ["join", PATH, PATH, "--at", "base"], 2),
    "rename": (multibot.main, ["rename", "a", "b", "."], 2),
    "inspect --suggest": (multibot.main, ["inspect", "--suggest", PATH], 2),
}
# Those that read no description.
OTHERS = {"snapshot", "completion"}


@pytest.fixture
def target(here: Path) -> Path:
    """Return what the hostile file in the working directory writes where it is let."""
    found = here / "taken"
    (here / PATH).write_text(ROBOT.replace("TARGET", str(found)))
    (here / "fleet.yaml").write_text(FLEET)
    (here / "graph.json").write_text("{}")
    return found


def test_every_command_is_here() -> None:
    tried = {name.split()[0] for name in COMMAND_LINES}
    assert tried | OTHERS == {*COMMANDS, *PROGRAMS}


@pytest.mark.sample(1)
@pytest.mark.parametrize("name", COMMAND_LINES)
def test_a_command_is_bounded(name: str, target: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main, words, code = COMMAND_LINES[name]
    before = sorted(os.listdir())
    assert main([*words, "--quiet"]) == code
    assert sorted(os.listdir()) == before
    out, err = capsys.readouterr()
    lines = [line for line in (out + err).splitlines() if "xacro failed" in line]
    assert len(lines) == 1, out + err
    assert "refused: os.system" in lines[0]
    assert "--trust" in lines[0]


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(set(COMMAND_LINES) - {"rehearse", "check"}))
def test_trust_lifts_the_bounds(name: str, target: Path) -> None:
    main, words, _ = COMMAND_LINES[name]
    main([*words, "--quiet", "--trust"])
    assert target.read_text() == "taken\n"


@pytest.mark.more
def test_the_library_is_bounded(target: Path) -> None:
    calls: list[Callable[[], object]] = [
        lambda: rewrite(PATH, "robot1"),
        lambda: rewrite_all(PATH, ["robot1", "robot2"]),
        lambda: explain(PATH, 1),
        lambda: load_fleet("fleet.yaml"),
        lambda: rewrite("<robot/>", "robot1", urdf=PATH),
    ]
    for call in calls:
        with pytest.raises(InputError, match=r"refused: os\.system.* --trust"):
            call()
    assert not target.exists()


@pytest.mark.sample(1)
@pytest.mark.parametrize("call", ["rewrite", "load_fleet"])
def test_trust_of_the_library(target: Path, call: str) -> None:
    if call == "rewrite":
        rewrite(PATH, "robot1", trust=True)
    else:
        load_fleet("fleet.yaml", trust=True)
    assert target.read_text() == "taken\n"


def test_no_file_gives_trust(target: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Neither a configuration nor a fleet file may lift the bounds: they come from the same people."""
    Path("urdf-lint.toml").write_text("trust = true\n")
    assert urdf_lint.main([PATH]) == 2
    assert "unknown key 'trust'" in capsys.readouterr().err
    Path("fleet.yaml").write_text(FLEET + "trust: true\n")
    assert multibot.main(["plan", "fleet.yaml"]) == 2
    assert not target.exists()
