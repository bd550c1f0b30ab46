# SPDX-License-Identifier: Apache-2.0
"""An option that selects something says so where nothing is selected: exit 2, nothing is written."""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import FIXTURES

from multibot_rewrite.cli import multibot, urdf_lint, urdf_postfix

ROVER = FIXTURES / "robots" / "rover.urdf"
PROGRAMS = {
    "multibot": multibot.main,
    "urdf-lint": urdf_lint.main,
    "urdf-postfix": urdf_postfix.main,
}
PARAMS = """\
amcl:
  ros__parameters: {base_frame_id: base_link, global_frame_id: hall, scan_topic: scan}
"""
FLEET = """\
layout: frames-per-robot
description: rover.urdf
shared_topics: [%s]
shared_frames: [%s]
robots:
  - {name: robot1, pose: {x: 0}}
  - {name: robot2, pose: {x: 2}}
"""
SNAPSHOT = """\
{"schema": 2, "nodes": [{"name": "/robot1/driver"}],
 "environment": {"domain": 67, "rmw": "rmw_fastrtps_cpp"}}
"""


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "rover.urdf").write_bytes(ROVER.read_bytes())
    (tmp_path / "params.yaml").write_text(PARAMS)
    (tmp_path / "fleet.yaml").write_text(FLEET % ("/clock", "map"))
    (tmp_path / "graph.json").write_text(SNAPSHOT)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(line: str) -> int:
    program, *words = line.split()
    try:
        return PROGRAMS[program](words)
    except SystemExit as end:
        return int(str(end.code))


REWRITE = "urdf-postfix rover.urdf robot1 -o out/r.urdf"
BESIDE = "urdf-postfix params.yaml robot1 --urdf rover.urdf -o out/p.yaml"


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (
            f"{REWRITE} --shared scan",
            "no frame 'scan'; topics are written with a slash: --shared /sc",
        ),
        (
            f"{REWRITE} --shared /nosuch",
            "has no topic '/nosuch'; its topics are ",
        ),
        (f"{REWRITE} --shared map,/scann", "no topic '/scann'; did you mean '/scan'?"),
        (f"{REWRITE} --shared base_lnk", "no frame 'base_lnk'; did you mean 'base_link'?"),
        (f"{REWRITE} --shared /base_link", "frames have no slash: --shared base_link"),
        # A topic that no text has: the default of a plugin.
        (f"{REWRITE} --shared cmd_vel", "topics are written with a slash: --shared /cmd_vel"),
        (f"{REWRITE} robot2 --shared /nosuch -o out/", "no topic '/nosuch'"),
        (f"{BESIDE} --shared scan", "topics are written with a slash: --shared /scan"),
        (f"{BESIDE} --shared hal", "no frame 'hal'"),
        ("urdf-lint rover.urdf --shared /nosuch", "no topic '/nosuch'"),
        ("urdf-lint . --robots a,b --shared base_lnk", "no frame 'base_lnk'"),
        (
            "multibot view fleet.yaml --shared scan -o out/v.html",
            "a fleet file has its own, leave out",
        ),
        *(
            (f"{command} --select {code}", f"--select: no rule has the code '{code}'")
            for code in ("MB9999", "XX")
            for command in (
                REWRITE,
                BESIDE,
                "urdf-lint rover.urdf",
                "multibot build",
                "multibot plan fleet.yaml",
                "multibot check --from graph.json",
                "multibot check fleet.yaml --from graph.json",
                "multibot view fleet.yaml",
                "multibot view rover.urdf r1",
                "multibot rehearse fleet.yaml",
                "multibot check-launch rover.urdf",
            )
        ),
        ("urdf-lint rover.urdf --ignore MB9999", "--ignore: no rule has the code 'MB9999'"),
        ("urdf-lint rover.urdf --target foo", "use one of mjcf"),
        ("urdf-lint rover.urdf --roots nosuch", "argument --roots: 'nosuch' is no folder"),
        ("multibot plan rover.urdf r1 --roots nosuch", "argument --roots: 'nosuch' is no folder"),
        ("urdf-lint rover.urdf sim:=gz", "rover.urdf is no xacro: leave out NAME:=VALUE"),
        ("urdf-lint rover.urdf --urdf rover.urdf", "--urdf is for an SRDF or a related file"),
        (
            "multibot check --from graph.json --domain 5",
            "graph.json is a graph of domain 67; leave it out",
        ),
        ("multibot check fleet.yaml --from graph.json --domain 5", "is a graph of domain 67"),
        ("multibot plan rover.urdf r1 --node-set nosuch", "node set 'nosuch' is not known"),
        (
            "multibot snapshot --from graph.json --output-kind nodes --node /nosuch",
            "no node has this name",
        ),
        ("multibot rename nosuch new .", "no description has a link 'nosuch'"),
    ],
)
def test_what_matches_nothing_is_an_error_of_the_call(
    line: str, said: str, here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(line) == 2
    err = capsys.readouterr().err
    assert said in err and len([it for it in err.splitlines() if "warning" not in it]) == 1
    assert not (here / "out").exists() or not any((here / "out").iterdir())


@pytest.mark.parametrize(
    "line",
    [
        *(
            f"{REWRITE} --shared {it}"
            for it in ("/scan", "base_link", "/cmd_vel", "odom", "map,/clock")
        ),
        # What stays in this layout is there all the same.
        f"{REWRITE} --shared base_link --layout tf-per-robot",
        *(f"{BESIDE} --shared {it}" for it in ("/scan", "hall")),
        "urdf-lint rover.urdf --robots a,b --shared /scan,base_link",
        "urdf-lint rover.urdf params.yaml --robots a,b --shared hall --fail-on error",
        "urdf-lint params.yaml rover.urdf --urdf rover.urdf --fail-on error",
        "multibot check --from graph.json --domain 67",
    ],
)
def test_what_matches_something_is_taken(line: str, here: Path) -> None:
    assert run(line) == 0


@pytest.mark.parametrize(
    ("topics", "frames", "said"),
    [
        ("/cmd_vell", "map", "3:1: warning: MF838 /cmd_vell * did you mean '/cmd_vel'?"),
        (
            "/base_link",
            "map",
            "3:1: warning: MF838 /base_link * it is a frame: write it below shared_frames",
        ),
        (
            "/clock",
            "scan",
            "4:1: warning: MF838 scan * it is a topic: write it below shared_topics",
        ),
        # A node that is not known may have it.
        (
            "/fleet_state",
            "map",
            "3:1: note: MF838 /fleet_state * correct it, unless a node that is not known",
        ),
        ("/cmd_vel", "base_link", ""),
    ],
)
@pytest.mark.parametrize("command", ["build -o out", "plan fleet.yaml -o out/p.yaml"])
def test_a_name_of_a_fleet_file_that_nothing_has(
    topics: str,
    frames: str,
    said: str,
    command: str,
    here: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Not an error: the fleet has more than is known of it."""
    (here / "fleet.yaml").write_text(FLEET % (topics, frames))
    run(f"multibot {command} --select MF838")
    lines = [it for it in capsys.readouterr().err.splitlines() if "MF838" in it]
    begin, _, end = said.partition(" * ")
    assert len(lines) == bool(said)
    assert all(it.startswith(f"fleet.yaml:{begin}") and end in it for it in lines)


def test_the_names_of_a_call_without_a_fleet_file(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("multibot plan rover.urdf r1 r2 --shared scan,/cmd_vel -o out/p.yaml") == 0
    assert "warning: MF838 scan is to be shared" in capsys.readouterr().err
