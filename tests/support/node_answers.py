# SPDX-License-Identifier: Apache-2.0
"""What a node answers, in short."""

from __future__ import annotations

from collections.abc import Iterable

from multibot_rewrite.system.parameters import Answer, parameter_text
from multibot_rewrite.system.records import SIM_TIME, Controller, Parameter


def told(
    node: str,
    lifecycle: str = "",
    sim_time: bool | None = None,
    controllers: Iterable[tuple[str, str, tuple[str, ...]]] = (),
    parameters: Iterable[tuple[str, str]] = (),
) -> Answer:
    """Return an answer; ``controllers``: names, states, claims; ``parameters``: names, texts of
    values."""
    timed = [] if sim_time is None else [(SIM_TIME, parameter_text(sim_time))]
    return Answer(
        node,
        lifecycle,
        tuple(Parameter(node, *it) for it in (*timed, *parameters)),
        tuple(Controller(node, *it) for it in controllers),
    )
