# SPDX-License-Identifier: Apache-2.0
"""What every refusal of ``urdf-postfix`` looks like, and small robots to refuse."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from postfix_command import Result, temporaries

from multibot_rewrite.base.model import UsageError

STOPPED, UNUSABLE = 1, 2
XACRO = "http://www.ros.org/wiki/xacro"
# What a line must not hold, whatever went wrong: this is for developers.
NOISE = ("Traceback", "Errno", "<class", "0x", "XML_PARSE_HUGE")


def robot(body: str, attributes: str = "") -> str:
    """Return a robot of four lines; ``body`` is the third."""
    return f'<?xml version="1.0"?>\n<robot name="bot"{attributes}>\n{body}\n</robot>\n'


def xacro(body: str) -> str:
    """Return the same for xacro."""
    return robot(body, f' xmlns:xacro="{XACRO}"')


def check_refusal(folder: Path, result: Result, code: int, words: Sequence[str]) -> None:
    """One line that holds every word; nothing on standard output, nothing in the folder."""
    assert result.err.count("\n") == 1, result.err
    for word in words:
        assert word in result.err
    for word in NOISE:
        assert word not in result.err
    assert result.code == code
    assert result.out == b""
    assert not (folder / "out.urdf").exists()
    assert temporaries(folder) == []


def said(call: Callable[..., object], *given: object) -> str:
    """Return what a call says that refuses what it is given."""
    with pytest.raises(UsageError) as caught:
        call(*given)
    return str(caught.value)
