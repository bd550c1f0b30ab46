# SPDX-License-Identifier: Apache-2.0
"""Robots that are called like frames and topics that all share: the same wherever they are named."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from multibot_rewrite import RewriteRefused, rewrite_all

ROBOT = '<robot name="r"><link name="{}"/>{}</robot>'


def refusals(text: str, robots: Sequence[str], **options: object) -> set[tuple[str, str]]:
    """Codes and messages of a call that is refused; empty for one that is not."""
    try:
        list(rewrite_all(text, robots, **options))  # type: ignore[arg-type]
    except RewriteRefused as error:
        return {(it.code, it.message) for it in error.findings if it.level == "error"}
    return set()


@pytest.mark.parametrize("order", [("world", "r2"), ("r2", "world")])
def test_a_name_that_becomes_a_shared_frame_is_refused(order: Sequence[str]) -> None:
    message = "link '/' would become '//world' for world, which is shared"
    assert refusals(ROBOT.format("/", ""), order) == {("MB420", message)}
    assert refusals(ROBOT.format("/", ""), ["r2"]) == set()
