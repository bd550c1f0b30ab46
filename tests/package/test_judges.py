# SPDX-License-Identifier: Apache-2.0
"""Rewrite, lint, remap table, fleet and build name the same things that two robots would share."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

import pytest
from fleet_folder import planned_fleet

from multibot_rewrite import rewrite, rewrite_all
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS, ROS_2
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.checks.judged_plan import make_fleet
from multibot_rewrite.description.readback.meeting import SHARED_CODES
from multibot_rewrite.description.readback.reading import read
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.sources.release_said import release_said
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.rules.settings import Settings

pytestmark = pytest.mark.slow

ROBOTS = ("robot1", "robot2")
# An address has no name: each judge calls it by what opens it.
# MR105 is of the rules that controllers do not get: the table names each rule, a rewrite the plugin.
CODES = tuple(sorted(SHARED_CODES - {"MB412", "MR105"}))
LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")
EVERY = 13
_NAME = re.compile(r"'([^']+)'")


def named(findings: Iterable[Finding]) -> set[str]:
    """Return the names that these findings say are shared."""
    found = [it for it in findings if it.code in CODES]
    quoted = {text for it in found if not it.names for text in _NAME.findall(it.message)[:1]}
    return quoted | {name for it in found for name in it.names}


def verdicts(path: Path, layout: str, folder: Path) -> dict[str, set[str]]:
    """Return what each of the five says; empty where the description is refused."""
    # A fleet is one of ROS 2: where nobody says so, the others may take plugins for those of ROS 1.
    release = release_said("", path.read_bytes(), str(path)).release
    try:
        first, _ = rewrite_all(path, ROBOTS, layout=layout, distro=release)
        table = make_fleet(path, ROBOTS, (), {"layout": layout}, release=release).table
    except MultibotError:
        return {}
    settings = Settings(
        robots=ROBOTS, naming=make_naming(layout), select=CODES, distro=release, ros=ROS_2
    )
    file = folder / "fleet.yaml"
    robots = "\n".join(f"  - {{name: {it}}}" for it in ROBOTS)
    file.write_text(f"layout: {layout}\ndescription: {path}\nrobots:\n{robots}\n")
    plan = planned_fleet(file)
    return {
        "rewrite": named(first.findings),
        "lint": named(lint_file(str(path), settings)),
        "remap": named(table.problems),
        "fleet": named(plan.fleet.table.problems),
        "build": named((*make_outputs(plan).findings, *plan.fleet.table.problems)),
    }


def disagreements(paths: Iterable[Path], folder: Path) -> dict[str, dict[str, set[str]]]:
    wrong = {}
    for path in paths:
        for layout in LAYOUTS:
            found = verdicts(path, layout, folder)
            if len(set(map(frozenset, found.values()))) > 1:
                wrong[f"{path.name} {layout}"] = found
    return wrong


@pytest.mark.deep
def test_five_judges_agree(corpus: dict[str, Path], tmp_path: Path) -> None:
    with_plugins = [it for it in corpus.values() if b"<plugin" in it.read_bytes()]
    assert len(with_plugins[::EVERY]) > 10
    assert disagreements(with_plugins[::EVERY], tmp_path) == {}


@pytest.mark.parametrize("every", [12, pytest.param(1, marks=pytest.mark.deep)])
def test_both_readings_know_the_same_plugins(corpus: dict[str, Path], every: int) -> None:
    definitions = builtin_tree((), NEWEST_LTS).definitions
    wrong = {}
    for name, path in list(corpus.items())[::every]:
        data = path.read_bytes()
        try:
            findings = rewrite(data, "robot_7q").findings if b"<plugin" in data else ()
        except MultibotError:
            continue
        # A plugin that is known by its parameters alone has a section; types of sensors have none. One
        # of Gazebo Classic or ROS 1 is known, whatever release it is for.
        first = sum(
            it.code == "MB902"
            and it.message.startswith("plugin ")
            and "parameters alone" not in it.message
            and "is of Gazebo Classic" not in it.message
            and "is written for ROS 1" not in it.message
            for it in findings
        )
        second = len(read(data, name, definitions).unknown) if b"<plugin" in data else 0
        if first != second:
            wrong[name] = first, second
    assert wrong == {}
