# SPDX-License-Identifier: Apache-2.0
"""A xacro is expanded with the same arguments once, for who says that no file changes meanwhile."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources import expand as module
from multibot_rewrite.description.sources.expand import expand, expand_traced, kept_expansions

WIKI = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "a.xacro"
    path.write_text(f'<robot {WIKI} name="a"><link name="$(arg x)"/></robot>')
    return path


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The arguments of each process that expands."""
    calls: list[Any] = []
    real = module.converse

    def converse(arguments: Any, *rest: Any, **named: Any) -> Any:
        calls.append(dict(arguments))
        return real(arguments, *rest, **named)

    monkeypatch.setattr(module, "converse", converse)
    return calls


def test_the_same_is_expanded_once_in_the_block_alone(file: Path, counted: list[Any]) -> None:
    with kept_expansions():
        assert b'"1"' in expand(str(file), {"x": "1"}) == expand(str(file), {"x": "1"})
        assert b'"2"' in expand(str(file), {"x": "2"})
        assert counted == [{"x": "1"}, {"x": "2"}]
        traced = [expand_traced(str(file), file.read_bytes(), {"x": "1"}) for _ in range(2)]
        assert traced[0] is traced[1] and len(counted) == 3
        other = file.read_bytes().replace(b"link", b"joint")
        assert b"<joint" in expand_traced(str(file), other, {"x": "1"}).data
    file.write_text(file.read_text().replace("link", "gripper"))
    assert b"<gripper" in expand(str(file), {"x": "1"}), "a later block reads the file again"
    with kept_expansions():
        assert b"<gripper" in expand(str(file), {"x": "1"})


def test_what_fails_fails_again_with_the_same_words(file: Path, counted: list[Any]) -> None:
    said = []
    with kept_expansions():
        for _ in range(2):
            with pytest.raises(InputError) as error:
                expand(str(file), {})
            said.append(str(error.value))
    assert said[0] == said[1] and "give it as x:=VALUE" in said[0] and len(counted) == 1
