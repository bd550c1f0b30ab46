# SPDX-License-Identifier: Apache-2.0
"""The quick yes or no about a fleet file, held against jsonschema."""

from __future__ import annotations

import copy
import random
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml

from multibot_rewrite.fleet.file.checked_yaml import is_valid
from multibot_rewrite.fleet.file.fleet_data import schema

ROOT = Path(__file__).parents[2]
FLEETS = [
    *sorted(ROOT.glob("examples/*/fleet.yaml")),
    *sorted(ROOT.glob("fixtures/recipes/*.yaml")),
]
ODD = (
    *(None, True, 0, 1, -1, 1.0, 2.5, 256, 10_001, float("inf")),
    *("", "a", "1a", "a/b", "/", "none", "prefix", "humble", "tcp/10.0.0.1:7447"),
    *([], [1], ["a"], [""], ["a", 1], [0, 255, 1], [0, 255, 1, 2], {}, {"name": "a"}, {"a": 1}),
)  # fmt: skip


def places(data: Any) -> Iterator[tuple[Any, Any]]:
    """Every value with what holds it."""
    keys = data if isinstance(data, dict) else range(len(data)) if isinstance(data, list) else ()
    for key in keys:
        yield data, key
        yield from places(data[key])


def changed(data: Any, chance: random.Random) -> Any:
    """The data with one value that is odd, away, or under a key of another place."""
    result = copy.deepcopy(data)
    holder, key = chance.choice(list(places(result)))
    if isinstance(holder, dict) and chance.random() < 0.4:
        keys = [*schema()["properties"], *schema()["$defs"]["robot"]["properties"], "x", 1]
        holder[chance.choice(keys)] = (
            holder.pop(key) if chance.random() < 0.5 else chance.choice(ODD)
        )
    elif chance.random() < 0.1:
        del holder[key]
    else:
        holder[key] = chance.choice(ODD)
    return result


def whole() -> Any:
    """Data that has every key of the schema."""
    robot = {"name": "r1", "namespace": "/a/b", "model": "m.1", "count": 2, "colour": [1, 2, 3]}
    robot |= {"arguments": {"a": 1}, "pose": {"x": 1}, "step": {"y": 0.5}, "stack": []}
    zenoh = {"router": "tcp/10.0.0.1:7447", "keystore": "/keys", "operators": "rviz", "domain": 3}
    return {"robots": [robot], "layout": "both", "zenoh": zenoh, "companions": {"params": ["a"]}}


WORDS: list[dict[str, Any]] = [
    *({"type": it} for it in ("array", "object", "string", "boolean", "number", "integer")),
    {"type": ["string", "integer"]}, {"enum": ["a", "none"]}, {"required": ["a"]}, {"pattern": "^1"},
    {"minLength": 1}, {"minLength": 2}, {"minItems": 1}, {"maxItems": 2}, {"maxItems": 3},
    {"minimum": 0}, {"minimum": 1}, {"maximum": 1}, {"maximum": 256}, {"items": {"type": "string"}},
    {"properties": {"a": {"type": "string"}}}, {"additionalProperties": {"type": "string"}},
    {"properties": {"a": {}}, "additionalProperties": False}, {"$ref": "#/$defs/word"},
    {"oneOf": [{"type": "string"}, {"minLength": 2}]}, {"items": {"$ref": "#/$defs/word"}},
]  # fmt: skip


@pytest.mark.parametrize("words", WORDS, ids=str)
def test_each_word_of_a_schema_says_what_jsonschema_says(words: dict[str, Any]) -> None:
    defs = {"word": {"type": "string", "minLength": 1}}
    judge = jsonschema.Draft202012Validator({**words, "$defs": defs})
    for it in (*ODD, [1, 2, 3], {"a": "b"}, {"a": "b", "c": "d"}):
        assert is_valid(it, words, defs) is judge.is_valid(it), it


@pytest.mark.parametrize("path", FLEETS, ids=lambda it: f"{it.parent.name}/{it.stem}")
def test_fleets_of_the_pages_are_judged_as_by_jsonschema(path: Path) -> None:
    data = yaml.safe_load(path.read_text())
    expected = jsonschema.Draft202012Validator(schema()).is_valid(data)
    assert is_valid(data, schema(), schema()["$defs"]) is expected


@pytest.mark.more
@pytest.mark.sample(4)
@pytest.mark.parametrize("seed", range(4))
def test_as_jsonschema_says(seed: int) -> None:
    chance, judge = random.Random(seed), jsonschema.Draft202012Validator(schema())
    fleets = [yaml.safe_load((ROOT / f"examples/{it}/fleet.yaml").read_text()) for it in
              ("mixed_fleet", "two_arms_moveit", "namespace_and_prefix")]  # fmt: skip
    said = []
    for _ in range(400):
        data = changed(chance.choice([whole(), *fleets]), chance)
        said.append(judge.is_valid(data))
        assert is_valid(data, schema(), schema()["$defs"]) is said[-1], data
    assert 50 < sum(said) < 350


WORD = {"type": "string"}
SMALL: list[dict[str, Any]] = [
    *({"type": it} for it in ("array", "object", "string", "boolean", "number", "integer")),
    {"type": ["string", "integer"]}, {"enum": ["a", "both"]}, {"required": ["name"]},
    {"pattern": "^[a-z]"}, *({"minLength": it} for it in (1, 2)),
    *({word: it} for word in ("minItems", "maxItems") for it in (1, 2, 3)),
    *({word: it} for word in ("minimum", "maximum") for it in (0, 1, 2)),
    {"items": WORD}, {"properties": {"name": WORD}}, {"properties": {"name": {"type": "number"}}},
    {"properties": {"name": WORD}, "additionalProperties": False}, {"additionalProperties": WORD},
    {"oneOf": [WORD, {"type": "array"}]}, {"oneOf": [{"type": "number"}, {"minimum": 1}]},
    {"$ref": "#/$defs/a"}, {"title": "t", "description": "d", "$comment": "c"},
]  # fmt: skip


def test_each_keyword_as_jsonschema_says() -> None:
    for it in SMALL:
        whole_ = {**it, "$defs": {"a": {"minLength": 2}}}
        judge = jsonschema.Draft202012Validator(whole_)
        for data in ODD:
            assert is_valid(data, whole_, whole_["$defs"]) is judge.is_valid(data), (it, data)


def test_every_keyword_of_the_schema_has_a_rule() -> None:
    with pytest.raises(KeyError):
        is_valid("a", {"format": "date"}, {})
    assert is_valid(whole(), schema(), schema()["$defs"])
