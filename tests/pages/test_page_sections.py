"""Where the line of a finding leads on a page, and in which order findings stand."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, Finding
from multibot_rewrite.pages.page import to_html
from multibot_rewrite.pages.page_sections import link_to
from multibot_rewrite.pages.scene import make_scene
from multibot_rewrite.system.records import Robot, System

SECTIONS = {"": ("all", {"n1"}), "robot1": ("one", {"n1", "n2"}), "robot2": ("two", {"n1", "n3"})}


# The robot's own section first, another that has it otherwise, and at last the head of its own.
@pytest.mark.parametrize(
    ("robot", "targets", "link"),
    [
        ("robot1", ["n1"], "#one-n1"), ("robot2", ["n1"], "#two-n1"), ("", ["n1"], "#all-n1"),
        ("robot1", ["n3"], "#two-n3"), ("robot3", ["n2"], "#one-n2"), ("robot3", ["n1"], "#all-n1"),
        ("robot1", ["n9", "n3"], "#two-n3"), ("robot2", ["n9"], "#two"), ("robot3", [], "#all"),
        ("robot1", ["f4", "n1"], "#tf-f4"),
    ],
)  # fmt: skip
def test_a_finding_leads_to_its_robot(robot: str, targets: list[str], link: str) -> None:
    finding = Finding("MG301", "error", "it", robot=robot)
    assert link_to(finding, targets, SECTIONS) == link


def test_errors_are_above_what_is_not_certain_and_the_head_says_the_count_and_the_rows() -> None:
    """Codes are sorted the other way round: MG101 is inconclusive, MG301 an error."""
    robots = tuple(Robot(it, (), f"/{it}/tf") for it in ("robot1", "robot2"))
    plan = System(robots=robots, layout="tf-per-robot")
    found = [
        Finding("MG101", INCONCLUSIVE, "missing", node=f"/{it.name}/amcl", robot=it.name)
        for it in robots
    ]
    found.append(Finding("MG301", ERROR, "twice", robot="robot1"))
    scene = make_scene(plan, System(), found)
    assert [it.finding.level for it in scene.rows] == [ERROR, INCONCLUSIVE]
    assert "<li>1 error, 2 inconclusive in 2 rows</li>" in to_html(scene).decode()
