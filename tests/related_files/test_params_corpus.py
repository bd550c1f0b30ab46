# SPDX-License-Identifier: Apache-2.0
"""Every real parameter file is rewritten as far as names go, or refused for a reason on record."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from params_corpus import (
    FOLDERS,
    REFUSALS,
    ROBOT,
    files,
    problems,
    run,
)
from paths import CORPUS
from real_robots import spread

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.related_files.yaml_text import read_yaml

LEAST = 500


@pytest.fixture(scope="module")
def corpus_params() -> dict[str, Path]:
    found = files()
    if not found:
        pytest.skip(f"no corpus of parameter files: looked for {CORPUS}/{{{','.join(FOLDERS)}}}")
    return found


@pytest.mark.slow
def test_a_sample_of_real_files(corpus_params: dict[str, Path]) -> None:
    wrong, refused, _ = run(spread(corpus_params, 40))
    on_record = json.loads(REFUSALS.read_text())
    assert wrong == []
    for why, names in refused.items():
        assert set(names) <= set(on_record.get(why, [])), why


@pytest.mark.deep
def test_all_real_files(corpus_params: dict[str, Path]) -> None:
    assert len(corpus_params) >= LEAST
    wrong, refused, _ = run(corpus_params)
    assert wrong == []
    assert refused == json.loads(REFUSALS.read_text())


@pytest.mark.more
def test_the_reasons_are_true(corpus_params: dict[str, Path]) -> None:
    for why, names in json.loads(REFUSALS.read_text()).items():
        for name in names:
            text = corpus_params[name].read_text(errors="replace")
            bare = re.sub(r"#.*", "", text)
            assert bare.count("ros__parameters") == 0 or not why.startswith("not a ROS 2"), name
            assert re.search(r"[&*]\w", bare) or "anchors" not in why, name
            assert ROBOT in text or why != "MB863", name


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("a: 1\n", "a: 2\n"),
        ("a: x\n", "a: robot1/y\n"),
        ("a: x # c\n", "a: x\n"),
        ("a: x\n", "b: x\n"),
    ],
)
def test_the_check_sees_damage(old: str, new: str) -> None:
    document = read_yaml(old.encode(), "x")
    assert list(problems(document, new, make_naming(layout="L2", affix="prefix")))
