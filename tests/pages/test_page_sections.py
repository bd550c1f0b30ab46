"""Where the line of a finding leads on a page."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.pages.page_sections import link_to

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
