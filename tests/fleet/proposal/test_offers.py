# SPDX-License-Identifier: Apache-2.0
"""What ``inspect`` offers of a xacro's arguments is what ``init`` writes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
import yaml

from multibot_rewrite.cli.multibot import main

ARM = """\
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  ARGUMENTS
  <link name="PREFIXbase"/><link name="PREFIXhand"/>
  <joint name="PREFIXturn" type="continuous">
    <parent link="PREFIXbase"/><child link="PREFIXhand"/>
  </joint>
</robot>
"""


@pytest.mark.more
@pytest.mark.parametrize(
    ("arguments", "prefix"),
    [
        ({"prefix": ""}, "$(arg prefix)"),
        ({"tf_prefix": "", "title": ""}, "$(arg tf_prefix)$(arg title)"),
        ({"title": ""}, "$(arg title)"),
        # As LBR has it: the names of one robot.
        ({"robot_name": "lbr"}, "$(arg robot_name)_"),
    ],
)
def test_the_offer_is_what_is_written(
    arguments: dict[str, str], prefix: str, tmp_path: Path, capsys: Any
) -> None:
    said = "".join(f'<xacro:arg name="{it}" default="{arguments[it]}"/>' for it in arguments)
    file = tmp_path / "arm.urdf.xacro"
    file.write_text(ARM.replace("ARGUMENTS", said).replace("PREFIX", prefix))
    assert main(["inspect", str(file), "--output-kind", "json"]) == 0
    found = json.loads(capsys.readouterr().out)["xacro"]
    offered = dict(it.split(":=") for it in found["for_robots"])
    assert main(["init", str(file), "--yes", "-o", str(tmp_path / "fleet.yaml")]) == 0
    written = yaml.safe_load((tmp_path / "fleet.yaml").read_text())
    assert written.get("arguments", {}) == offered
