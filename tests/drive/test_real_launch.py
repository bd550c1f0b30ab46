# SPDX-License-Identifier: Apache-2.0
"""The stand-in for launch starts what the real launch starts: the same processes, parameters, rules."""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import fleet
import pytest
from paths import ROOT

pytestmark = [
    pytest.mark.live,
    pytest.mark.slow,
    pytest.mark.skipif(
        not importlib.util.find_spec("launch_ros"),
        reason="launch is the judge of the stand-in; source ROS, or put the sources of ros2/launch, "
        "ros2/launch_ros and osrf/osrf_pycommon on PYTHONPATH",
    ),
]
FLEETS = sorted((ROOT / "examples").glob("*/fleet.yaml"))


def plain(start: dict[str, Any], real: dict[str, Any]) -> str:
    """Return a start as text; of what is included the file's name and the arguments that the
    stand-in has: the real launch passes on all that is set."""
    if "include" not in start:
        return json.dumps(start, sort_keys=True)
    wanted = real.get(Path(start["include"]).name, {})
    given = {key: it for key, it in start["arguments"].items() if key in wanted}
    return json.dumps([Path(start["include"]).name, given], sort_keys=True)


@pytest.mark.parametrize("file", FLEETS, ids=[it.parent.name for it in FLEETS])
def test_the_stand_in_starts_the_same(file: Path, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "multibot_rewrite.cli.multibot", "build", str(file)]
    subprocess.run([*command, "-o", str(tmp_path / "out")], capture_output=True, check=True)
    built = tmp_path / "out" / "fleet.launch.py"
    real, stood_in = (
        fleet.run(fleet.HERE / it, built)["starts"] for it in ("launched.py", "started.py")
    )
    wanted = {Path(it["include"]).name: it["arguments"] for it in stood_in if "include" in it}
    assert stood_in
    assert sorted(plain(it, wanted) for it in real) == sorted(plain(it, wanted) for it in stood_in)
