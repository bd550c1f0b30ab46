# SPDX-License-Identifier: Apache-2.0
"""Frames of a plan that no description declares: what messages, plugins and parameters may name."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.knowledge.records import FrameParameter, NodeFacts
from multibot_rewrite.spelling.plan import expect
from multibot_rewrite.spelling.table import build_table


def others(layout: str, *defaults: str) -> set[str]:
    """Of robot1, which has base_link alone and a node with frames that are called so by default."""
    naming = make_naming(layout)
    frames = tuple(FrameParameter(f"f{at}", default=it) for at, it in enumerate(defaults))
    facts = [NodeFacts("scanner", "acme", (), frames=frames)]
    table = build_table(["robot1"], facts, naming, release=NEWEST_LTS)
    (robot,) = expect(table, naming, {"robot1": ["base_link"]}).robots
    return {*robot.other_frames}


@pytest.mark.parametrize(
    ("default", "planned"),
    [
        ("laser", True),
        # tf2 takes no slash in front.
        ("/laser", True),
        # It is that of another parameter, or there is none.
        ("<laser>", False),
        ("", False),
    ],
)
def test_a_default_frame_of_a_node_may_come(default: str, planned: bool) -> None:
    assert others("tf-per-robot", default) - others("tf-per-robot") == (
        {"laser"} if planned else set()
    )
    assert others("postfix", default) - others("postfix") == (
        {"laser/robot1"} if planned else set()
    )
