# SPDX-License-Identifier: Apache-2.0
"""Circles of transforms: found by hand for small trees, and in one pass for long chains."""

from __future__ import annotations

from counted_steps import steps

from multibot_rewrite.rules.system.transforms import _circles


def test_a_long_chain_takes_a_pass() -> None:
    """With a pass for each frame this would be a hundred times as much."""

    def chain(length: int) -> dict[str, set[str]]:
        return {str(at): {str(at + 1)} for at in range(length)}

    assert [*_circles(chain(60_000))] == []
    assert steps(lambda: [*_circles(chain(2000))]) < 11 * steps(lambda: [*_circles(chain(200))])
