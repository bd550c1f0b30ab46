# SPDX-License-Identifier: Apache-2.0
"""Templates of interfaces, and the parameters that fill them: what each makes is said here by hand."""

from __future__ import annotations

import pytest

from multibot_rewrite.knowledge.records import Claim
from multibot_rewrite.planning.records import Given
from multibot_rewrite.producers.evidence.hardware import claimed
from multibot_rewrite.system.records import Place

JOINTS, KINDS = Place("c.yaml", 3), Place("c.yaml", 4)
VALUES = {
    "joints": Given(["left", "right"], JOINTS),
    "kinds": Given(["velocity", "effort"], KINDS),
    "name": Given("imu", KINDS),
    "empty": Given("", KINDS),
    "none": Given([], KINDS),
    "use": Given(False, KINDS),
}


def made(template: str, condition: str = "") -> list[str]:
    return [it.name for it in claimed((Claim("state", template, condition),), VALUES)]


@pytest.mark.parametrize(
    ("template", "names"),
    [
        ("fixed/name", ["fixed/name"]),
        ("<joints>/<kinds>", ["left/velocity", "left/effort", "right/velocity", "right/effort"]),
        ("<name>/orientation.x", ["imu/orientation.x"]),
        ("<missing|name>/x", ["imu/x"]),
        ("<empty|none|name>/x", ["imu/x"]),
        ("<name|joints>/x", ["imu/x"]),
        ("<missing>/x", []),
        ("<missing=a,b>/x", ["a/x", "b/x"]),
        ("<name=a,b>/x", ["imu/x"]),
        ("<empty=>x", ["x"]),
        ("pin[0..2]", ["pin0", "pin1", "pin2"]),
        ("<joints>/[1..1]", ["left/1", "right/1"]),
    ],
)
def test_what_a_template_makes(template: str, names: list[str]) -> None:
    assert made(template) == names


def test_a_condition_that_does_not_hold() -> None:
    assert made("<name>/x", "use = false") == ["imu/x"]
    assert made("<name>/x", "use = true") == []


def test_the_place_is_that_of_the_first_parameter() -> None:
    both, fixed, default = claimed(
        (
            Claim("state", "<name>/<joints=x>", ""),
            Claim("state", "fixed", ""),
            Claim("state", "<missing=a>", ""),
        ),
        {**VALUES, "joints": Given(["left"], JOINTS)},
    )
    assert (both.place, fixed.place, default.place) == (KINDS, None, None)


def test_each_is_there_once_and_by_its_kind() -> None:
    claims = (
        Claim("command", "<name>/x", ""),
        Claim("state", "<name>/x", ""),
        Claim("state", "imu/x", ""),
    )
    found = [(it.kind, it.name, it.place) for it in claimed(claims, VALUES)]
    assert found == [("command", "imu/x", KINDS), ("state", "imu/x", KINDS)]
