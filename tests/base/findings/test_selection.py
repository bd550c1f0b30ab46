# SPDX-License-Identifier: Apache-2.0
"""Which findings are on and which make a command fail."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, NOTE, WARNING, Finding
from multibot_rewrite.base.findings.selection import Selection, fails, is_on


@pytest.mark.parametrize(
    ("select", "ignore", "code", "on"),
    [
        (("M",), (), "MG102", True),
        (("MB",), (), "MG102", False),
        (("M",), ("MG1",), "MG102", False),
        (("M", "MG102"), ("MG1",), "MG102", True),
        (("MG1",), ("MG102",), "MG102", False),
        (("MG102",), ("MG102",), "MG102", False),
        (("MF", "MG2"), (), "MG102", False),
    ],
)
def test_the_longer_code_decides(
    select: tuple[str, ...], ignore: tuple[str, ...], code: str, on: bool
) -> None:
    assert is_on(Selection(select, ignore), code) is on


@pytest.mark.parametrize(
    ("level", "fail_on", "failed"),
    [
        (ERROR, ERROR, True),
        (WARNING, ERROR, False),
        (WARNING, WARNING, True),
        (NOTE, WARNING, False),
        (NOTE, NOTE, True),
        (INCONCLUSIVE, NOTE, False),
    ],
)
def test_a_level_or_worse_fails(level: str, fail_on: str, failed: bool) -> None:
    assert fails([Finding("MG101", level, "x")], fail_on) is failed
