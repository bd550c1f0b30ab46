# SPDX-License-Identifier: Apache-2.0
"""The system_model.yaml of play_launch."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite import InputError
from multibot_rewrite.producers.launch.child import launch_graph
from multibot_rewrite.producers.launch.records import LaunchGraph, LaunchOrder

MODEL = """\
meta: {version: 1}
structure:
  scopes: {}
  nodes:
    /robot1/amcl:
      pkg: nav2_amcl
      plugin: nav2_amcl::AmclNode
      container: /robot1/box
      remaps: [{from: scan, to: front/scan}]
      params: {use_sim_time: true, a: 1}
      params_files: ["amcl: {ros__parameters: {a: 1}}"]
    /robot1/box: {pkg: rclcpp_components, exec: component_container, node_name: box, is_container: true}
    /driver: {pkg: acme, exec: driver, args: [--fast]}
    /tool: {exec: ./tool.sh}
"""


def read(folder: Path, text: str) -> LaunchGraph:
    file = folder / "system_model.yaml"
    file.write_text(text)
    return launch_graph(LaunchOrder(str(file)))


def test_a_process_without_a_package_is_a_note(tmp_path: Path) -> None:
    (note,) = read(tmp_path, MODEL).notes
    assert note.place.line == 14
    assert "/tool" in note.message


@pytest.mark.parametrize(
    "text", ["structure:\n", "structure: {nodes: {}}\n", "structure:\n  nodes: [a]\n"]
)
def test_one_without_nodes_is_refused(text: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="structure has no nodes"):
        read(tmp_path, text)


@pytest.mark.parametrize("node", ["/a: 1", "a: {pkg: b}"])
def test_what_is_no_node_is_refused_with_its_line(node: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"yaml:3: node /?a needs its full name and keys"):
        read(tmp_path, f"structure:\n  nodes:\n    {node}\n")
