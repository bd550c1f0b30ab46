# SPDX-License-Identifier: Apache-2.0
"""What is open in the robots of a fleet, by a build and by a plan."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from fleet_folder import planned_fleet
from paths import write_files

from multibot_rewrite.base.findings.finding import ERROR, NOTE, Finding
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.checks.closed_plan import closed_plan

# What a build tells of the odometry of these robots in some layouts, and is no gap.
BESIDE = ("MB105", "MF7", "MB4", "MR")


def found(
    folder: Path, files: dict[str, str], layout: str = "frames-per-robot"
) -> tuple[list[Finding], list[Finding]]:
    """Return what a build says, and what a plan says."""
    write_files(folder, files)
    fleet = folder / "fleet.yaml"
    fleet.write_text(f"layout: {layout}\n{files['fleet.yaml']}")
    plan = planned_fleet(fleet)
    problems = plan.fleet.table.problems
    built = {*problems, *make_outputs(plan).findings}
    planned = {*problems, *closed_plan(plan).gaps}
    return _gaps(built), _gaps(planned)


def _gaps(every: Iterable[Finding]) -> list[Finding]:
    told = (it for it in every if it.level == ERROR or not it.code.startswith(BESIDE))
    return [it for it in told if it.level != NOTE]
