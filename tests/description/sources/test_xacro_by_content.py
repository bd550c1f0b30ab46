# SPDX-License-Identifier: Apache-2.0
"""A xacro is one by what is in it: turtlebot3's descriptions end in .urdf and have arguments."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.base.model import InputError
from multibot_rewrite.checks.judged_plan import plan_fleet
from multibot_rewrite.description.sources.read import has_xacro, is_xacro
from multibot_rewrite.fleet.file.fleet_file import read_fleet

SPACE = 'xmlns:xacro="http://ros.org/wiki/xacro"'
TURTLEBOT = f"""\
<robot name="waffle" {SPACE}>
  <xacro:arg name="namespace" default=""/>
  <xacro:property name="namespace" value="$(arg namespace)"/>
  <link name="${{namespace}}base_link"/>
</robot>
"""


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (TURTLEBOT, True),
        (f'<robot {SPACE.replace("xacro=", "x=")}><x:arg name="a"/></robot>', True),
        (f"<robot {SPACE}><link/></robot>", False),
        (f'<robot {SPACE}><!-- <xacro:arg name="a"/> --><link/></robot>', False),
        ('<robot xmlns:v="http://vendor"><v:arg/></robot>', False),
        ("<robot><link name='xacro'/></robot>", False),
        ("", False),
    ],
)
def test_what_is_a_xacro(text: str, found: bool, tmp_path: Path) -> None:
    (tmp_path / "r.urdf").write_text(text)
    assert has_xacro(text.encode()) is found
    assert is_xacro(str(tmp_path / "r.urdf")) is found
    assert is_xacro(str(tmp_path / "there_is_none.urdf")) is False
    assert is_xacro("any.xacro") is True


@pytest.mark.more
def test_where_nodes_name_frames_no_argument_may_name_links(tmp_path: Path) -> None:
    (tmp_path / "r.urdf").write_text(TURTLEBOT)
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(
        "layout: LAYOUT\naffix: prefix\ndescription: r.urdf\n"
        'arguments: {namespace: "{robot}/"}\nrobots: [{name: r1}, {name: r2}]\n'
    )
    text = fleet.read_text()
    fleet.write_text(text.replace("LAYOUT", "frame-prefix"))
    with pytest.raises(InputError, match=r"namespace:=\{robot\}/ .* 'r1/base_link'.*once more"):
        plan_fleet(read_fleet(str(fleet), "", {}))
    fleet.write_text(text.replace("LAYOUT", "L2"))
    plan = plan_fleet(read_fleet(str(fleet), "", {}))
    assert b'"r1/base_link"' in plan.robots[0].description
