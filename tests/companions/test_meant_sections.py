# SPDX-License-Identifier: Apache-2.0
"""Sections that have the name of a node which reads the file, and another namespace."""

from __future__ import annotations

import pytest

from multibot_rewrite.companions.params.sections import meant_for, raw_sections
from multibot_rewrite.companions.yaml_text import read_yaml

NODES = ("/robot1/amcl", "/robot2/amcl", "/robot1/costmap/costmap")


@pytest.mark.parametrize(
    ("paths", "meant"),
    [
        (("amcl",), "amcl"),
        (("/other/amcl",), "/other/amcl"),
        (("amcl", "/**"), "amcl"),
        # rcl_yaml_param_parser: wildcards match any namespace.
        (("/**/amcl",), ""),
        (("/*/amcl",), ""),
        (("/**",), ""),
        (("robot1/amcl",), ""),
        (("/robot1/amcl", "/other/amcl"), ""),
        # That of the other robot is for a node that runs.
        (("/robot2/amcl",), ""),
        (("controller", "costmap/costmap"), ""),
    ],
)
def test_a_section_that_gives_its_node_nothing(paths: tuple[str, ...], meant: str) -> None:
    text = "".join(f"{it}:\n  ros__parameters: {{a: 1}}\n" for it in paths)
    found = meant_for(raw_sections(read_yaml(text.encode(), "f.yaml")), "/robot1/amcl", NODES)
    assert (found.path if found else "").strip("/") == meant.strip("/")
