# SPDX-License-Identifier: Apache-2.0
"""What a node needs that may not run: nothing is open because of it."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.fleet.build import make_outputs
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.fleet.fleet_plan import plan_fleet

NODES = """\
nodes:
  eye: {package: own, subscribes: {light: std_msgs/msg/String}}
stacks:
  own: {about: x, nodes: [{node: eye, when: WHEN}]}
"""
ROBOT = '<robot name="r"><link name="base_link"/></robot>'
FLEET = """\
description: r.urdf
nodes: nodes.yaml
stack: own
robots: [{name: robot1}, {name: robot2}]
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("when", "section", "told"),
    [('""', "", True), ("dark", "", False), ("dark", "eye", True)],
)
def test_an_optional_node_needs_nothing_until_it_has_parameters(
    when: str, section: str, told: bool, tmp_path: Path
) -> None:
    fleet = FLEET
    if section:
        (tmp_path / "p.yaml").write_text(f"{section}:\n  ros__parameters: {{rate: 5}}\n")
        fleet += "companions: {params: p.yaml}\n"
    for name, text in (("nodes.yaml", NODES.replace("WHEN", when)), ("r.urdf", ROBOT)):
        (tmp_path / name).write_text(text)
    (tmp_path / "fleet.yaml").write_text(fleet)
    plan = plan_fleet(read_fleet(str(tmp_path / "fleet.yaml"), "jazzy", {}))
    found = [it.message for it in make_outputs(plan).findings if it.code == "MG316"]
    assert bool(found) is told
    assert not told or "light" in found[0]


@pytest.mark.slow
@pytest.mark.parametrize(("other", "meant"), [("start_motors", True), ("request_update", False)])
def test_a_common_type_alone_makes_no_two_names_alike(
    other: str, meant: bool, tmp_path: Path
) -> None:
    nodes = f"""\
nodes:
  a: {{package: own, calls: {{robot/base/start_motor: std_srvs/srv/Empty}}}}
  b: {{package: own, serves: {{robot/base/{other}: std_srvs/srv/Empty}}}}
stacks:
  own: {{about: x, nodes: [a, b]}}
"""
    for name, text in (("nodes.yaml", nodes), ("r.urdf", ROBOT), ("fleet.yaml", FLEET)):
        (tmp_path / name).write_text(text)
    plan = plan_fleet(read_fleet(str(tmp_path / "fleet.yaml"), "jazzy", {}))
    found = [it.code for it in make_outputs(plan).findings if "start_motor" in it.message]
    assert found == ["MG304" if meant else "MG316"]
