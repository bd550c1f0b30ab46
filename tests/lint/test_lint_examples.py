# SPDX-License-Identifier: Apache-2.0
"""A rule asks one question of many places: each has its broken and its healthy example here."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml
from paths import FIXTURES
from rule_examples import found

from multibot_rewrite.lint import catalogue

EXAMPLES: list[dict[str, Any]] = yaml.load(
    (FIXTURES / "lint" / "examples.yaml").read_bytes(), yaml.CSafeLoader
)


@pytest.mark.sample(1)
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda it: f"{it['code']}-{it['name']}")
def test_an_example_is_found_in_its_line_and_level(example: dict[str, Any], tmp_path: Path) -> None:
    rule = catalogue.rules()[example["code"]]._replace(
        formats=tuple(example.get("formats", ("urdf",))),
        options=example.get("options", {}),
    )
    beside = example.get("beside", {})
    (it,) = found(rule, example["bad"], tmp_path, beside)
    assert (it.line, it.level) == (example["line"], example["level"])
    (tmp_path / "good").mkdir()
    assert found(rule, example["good"], tmp_path / "good", beside) == []
