# SPDX-License-Identifier: Apache-2.0
"""YAML files for people to edit name a schema that is beside them, whichever command begins them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from paths import ROBOTS

from multibot_rewrite.base import editors
from multibot_rewrite.cli.multibot import main

END = """{{"kind": "topic", "role": "{}", "name": "/{}/chat", "type": "a/msg/B", "type_hash": "",
 "qos": null, "process": "", "node": "/{}/talker"}}"""
NODES = ", ".join(f'{{"name": "/{it}/talker", "process": ""}}' for it in ("r1", "r2"))
ENDS = ", ".join(END.format("publishes", it, it) for it in ("r1", "r2"))
GRAPH = (
    f'{{"schema": 2, "nodes": [{NODES}], "ends": [{ENDS}], "environment": {{"settled": "quiet"}}}}'
)
COMMANDS = {
    "init": (["init", "{urdf}", "--yes", "-o", "{new}/a.yaml"], {"a.yaml": editors.FLEET}),
    "plan": (["plan", "{urdf}", "--robots", "a,b", "-o", "{new}/a.yaml"], {"a.yaml": editors.PLAN}),
    "plan in JSON": (["plan", "{urdf}", "--robots", "a,b", "-o", "{new}/a.json"], {"a.json": ""}),
    "nodes": (
        ["snapshot", "--output-kind", "nodes", "--from", "{graph}", "-o", "{new}/a.yaml"],
        {"a.yaml": editors.NODES},
    ),
    "suggestion": (
        ["check", "--from", "{graph}", "--suggest", "{new}"],
        {
            "fleet.yaml": editors.FLEET, "nodes.yaml": editors.NODES, "plan.yaml": editors.PLAN,
            "robot.urdf": "",
        },
    ),
}  # fmt: skip


@pytest.mark.parametrize("command", COMMANDS)
def test_the_schema_is_beside_the_file(command: str, tmp_path: Path, capsys: Any) -> None:
    words, wanted = COMMANDS[command]
    (tmp_path / "graph.json").write_text(GRAPH)
    # Alone: beside it ``init`` reads each launch file of the repository.
    (tmp_path / "rover.urdf").write_bytes((ROBOTS / "rover.urdf").read_bytes())
    paths = {
        "urdf": tmp_path / "rover.urdf",
        "graph": tmp_path / "graph.json",
        "new": tmp_path / "new",
    }
    assert main([it.format(**paths) for it in words]) in (0, 1, 3), capsys.readouterr().err
    schemas = {editors.schema_name(it): it for it in wanted.values() if it}
    assert {it.name for it in (tmp_path / "new").iterdir()} == {*wanted, *schemas}
    for name, schema in schemas.items():
        assert (tmp_path / "new" / name).read_bytes() == editors.schema_text(schema)
    for name, schema in wanted.items():
        first = (tmp_path / "new" / name).read_text().partition("\n")[0]
        line = f"# yaml-language-server: $schema={editors.schema_name(schema)}"
        assert (first == line) == bool(schema)
        assert str(tmp_path) not in first
