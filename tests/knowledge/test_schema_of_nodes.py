# SPDX-License-Identifier: Apache-2.0
"""The schema that editors read: it takes what the reader takes, and knows no other key."""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import Path

import jsonschema
import pytest
import yaml
from paths import ROOT

from multibot_rewrite.base import editors
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.knowledge.node_library import extend
from multibot_rewrite.knowledge.node_sets import built_in
from tools.schemas.nodes import schema

PACKAGE = files("multibot_rewrite.knowledge")
OURS = sorted(Path(str(PACKAGE)).joinpath("nodes").glob("*.yaml"))
PAGE = (ROOT / "docs" / "node-sets.md").read_text().partition("```yaml\n")[2].partition("```")[0]


def wrong(text: str) -> list[str]:
    found = jsonschema.Draft202012Validator(schema()).iter_errors(yaml.safe_load(text))
    return [it.message for it in found]


def test_the_file_is_what_the_reader_takes() -> None:
    text = (files("multibot_rewrite") / editors.NODES).read_text()
    command = "python -m tools.schemas.nodes > multibot_rewrite/" + editors.NODES
    assert json.loads(text) == schema(), command


@pytest.mark.more
@pytest.mark.sample(3)
@pytest.mark.parametrize("path", OURS, ids=lambda it: it.stem)
def test_our_own_files_follow_it(path: Path) -> None:
    assert wrong(path.read_text()) == []


def test_the_example_of_the_page_follows_it() -> None:
    assert wrong(PAGE) == []


@pytest.mark.parametrize(
    "text",
    [
        "knots: {}",
        "nodes: {a: {package: p, publish: {}}}",
        "nodes: {a: {package: p, publishes: {scan: {typ: sensor_msgs/msg/LaserScan}}}}",
        "nodes: {a: {package: p, params: {f: frames}}}",
        "node_sets: {s: {about: x, node: []}}",
        "node_sets: {s: {nodes: [{node: amcl, known: x}]}}",
    ],
)
def test_what_the_reader_rejects_is_marked(text: str) -> None:
    assert wrong(text)
    with pytest.raises(UsageError):
        extend(built_in("jazzy"), text, "mine.yaml")
