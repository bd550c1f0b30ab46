# SPDX-License-Identifier: Apache-2.0
"""The generator of fleets draws every key that a fleet file may have."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import pytest
from drawn_builds import drawn_by
from drawn_fleets import Data, fleets
from parsed import PACKAGE

SCHEMA = json.loads((PACKAGE / "fleet" / "fleet.schema.json").read_text())
COUNT, SEED = 600, 52


def schema_keys(part: Any, above: str = "") -> Iterator[str]:
    """Each key of a fleet file with the keys above it; what may stand at the fleet and at a robot has
    one name."""
    if "$ref" in part:
        part = SCHEMA["$defs"][part["$ref"].rpartition("/")[2]]
    for key, value in part.get("properties", {}).items():
        yield f"{above}{key}"
        yield from schema_keys(value, f"{above}{key}.")
    if "items" in part:
        yield from schema_keys(part["items"], above)


def keys_of(value: Any, above: str = "") -> Iterator[str]:
    """Each key of a fleet file that was drawn, with the keys above it."""
    for key, it in value.items() if isinstance(value, dict) else ():
        yield f"{above}{key}"
        yield from keys_of(it, f"{above}{key}.")
    for it in value if isinstance(value, list) else ():
        yield from keys_of(it, above)


# What no drawn fleet has, and where it is tested.
NOT_DRAWN = {
    *("join.arguments", "join.srdf", "join.controllers", "join.moveit", "join.rviz"),
    *("join.one_system",),  # tests/fleet/test_joined_robots.py
}


def either(key: str) -> str:
    """Return a key that a robot has, or all have from the fleet; places are drawn by their axes."""
    return key.removeprefix("robots.").partition("pose.")[0].partition("step.")[0]


@pytest.mark.slow
def test_each_key_is_drawn() -> None:
    wanted = {either(it) for it in schema_keys(SCHEMA)}
    found = {either(it) for one in drawn_by(fleets(), COUNT, SEED) for it in keys(one.written)}
    assert wanted - found == NOT_DRAWN


def keys(written: dict[str, Data]) -> Iterator[str]:
    for it in written.values():
        yield from keys_of(it)
