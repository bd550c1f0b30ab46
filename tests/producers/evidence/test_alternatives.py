# SPDX-License-Identifier: Apache-2.0
"""Controllers of which one at a time can be active: a command interface has one owner at a time."""

from __future__ import annotations

import pytest
from given_parameters import run_given

from multibot_rewrite.planning.records import Given, Run
from multibot_rewrite.producers.evidence.nodes import alternatives
from multibot_rewrite.system.records import Place

HERE = Place("c.yaml", 3)


def controller(name: str, joints: list[str], manager: str = "controller_manager") -> Run:
    """One of a type that is not known, with the usual parameters."""
    commands = ["position"] if joints else []
    words = {"joints": joints, "command_interfaces": commands, "state_interfaces": ["effort"]}
    values = {key: Given(list(its), HERE) for key, its in words.items()}
    return run_given(name, "", "acme/Arm", values, HERE, manager)


ARM, HAND = controller("arm", ["a", "b"]), controller("hand", ["c"])
SERVO, ALL = controller("servo", ["b"]), controller("all", ["a", "b", "c"])


@pytest.mark.parametrize(
    ("given", "others"),
    [
        ([ARM], {}),
        ([ARM, HAND], {}),
        ([ARM, SERVO], {"arm": "servo", "servo": "arm"}),
        ([ARM, HAND, SERVO], {"arm": "servo", "servo": "arm"}),
        ([ARM, HAND, ALL], {"arm": "all", "hand": "all", "all": "arm"}),
        # Two managers have hardware of their own.
        ([ARM, SERVO._replace(host_name="left/controller_manager")], {}),
        # No controllers at all: nodes with such parameters.
        ([ARM._replace(host_name=""), SERVO._replace(host_name="")], {}),
        # It reads joints and commands none.
        ([ARM, controller("reader", [])], {}),
    ],
)
def test_controllers_of_one_joint_exclude_each_other(
    given: list[Run], others: dict[str, str]
) -> None:
    told = {name: f"{other} does not command the same joints" for name, other in others.items()}
    assert alternatives(given, {}) == told


def test_the_same_state_is_for_all() -> None:
    one, other = (
        it._replace(values={**it.values, "command_interfaces": Given([], HERE)})
        for it in (ARM, SERVO)
    )
    assert alternatives([one, other], {}) == {}
