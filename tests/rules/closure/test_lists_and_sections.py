"""Lists without parameters, sections of no controller: each step alone."""

from __future__ import annotations

from closed_robot import FILES

from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.companions.yaml_text import read_yaml
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.knowledge.stacks import load_nodes
from multibot_rewrite.producers.evidence.parameter_files import given_nodes
from multibot_rewrite.producers.evidence.records import GivenNode
from multibot_rewrite.rules.closure.lists import list_gaps
from multibot_rewrite.rules.closure.undeclared import undeclared_gaps


def given(text: str) -> list[GivenNode]:
    return given_nodes([read_yaml(text.encode(), "p.yaml")], load_known_nodes("", NEWEST_LTS))


def listed(rest: str) -> list[tuple[str, str]]:
    found = list_gaps(given(f"node:\n  ros__parameters: {{{rest}}}\n"))
    return [(it.name, it.near) for it in found]


def test_a_listed_name_without_parameters_and_the_one_that_has_them() -> None:
    assert listed("sources: [frnt], front: {a: 1}") == [("frnt in sources", "front")]
    assert listed("layer: {sources: frnt, front: {a: 1}}") == [("frnt in layer.sources", "front")]


def test_what_is_listed_elsewhere_is_not_meant() -> None:
    assert listed("sources: [frnt], others: [front], front: {a: 1}") == []


def test_names_that_differ_in_a_number_are_two() -> None:
    assert listed("sources: [front1], front2: {a: 1}") == []


def test_parameters_on_another_level_are_not_meant() -> None:
    assert listed("sources: [frnt], more: {front: {a: 1}}") == []


def undeclared(text: str) -> list[tuple[str, str]]:
    found = undeclared_gaps(given(text), load_nodes(NEWEST_LTS))
    return [(it.name, it.near) for it in found]


CONTROLLERS = FILES["controllers.yaml"]


def test_a_section_that_nobody_declares() -> None:
    assert undeclared(CONTROLLERS) == []
    renamed = CONTROLLERS.replace("base_controller:\n  ros", "base_controler:\n  ros")
    assert undeclared(renamed) == [("base_controler", "base_controller")]


def test_a_section_with_its_own_type_is_declared_by_it() -> None:
    own = "spare: {ros__parameters: {type: diff_drive_controller/DiffDriveController}}\n"
    assert undeclared(CONTROLLERS + own) == []
