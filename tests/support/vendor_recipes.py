# SPDX-License-Identifier: Apache-2.0
"""Recipes for vendors' robots: what is built from their own files, and which difference is right.

``vendors/recipes/*.yaml`` has them; ``vendor_pages.py`` writes their pages. A difference from what the
vendor's launch files make of two robots is *better* if the recipe says why, else it is *wrong*.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import yaml
from fleet_folder import planned_fleet
from vendor_compare import Built, Compared, Difference, compare
from vendor_live import Looked, Said, look
from vendor_sources import install, packages_below
from vendor_systems import RECORDER, Vendors, filled, prepare

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.fleet.fleet import expected

HERE = Path(__file__).parent
ROBOTS = ("robot1", "robot2", "robot3")


class Recipe(NamedTuple):
    """A robot: the system of ``vendors/*.yaml`` that it is (with other ``launch`` files, if it has
    them), the ``window`` of RViz that the vendor opens, what its fleet file has besides, the layouts
    (the vendor's first), which differences are ``better``, and which findings are ``right``,
    each with the reason. ``wrong`` and ``false`` (of each build) are how many others there are;
    ``before`` is what was false in the vendor's layout before the package knew these robots. ``shape``
    is that of the vendor's launch files, if they take any."""

    title: str
    system: str
    about: str
    layouts: tuple[str, ...]
    launch: tuple[str, ...] = ()
    window: Mapping[str, str] = {}
    fleet: Mapping[str, Any] = {}
    robot: Mapping[str, Any] = {}
    better: tuple[Mapping[str, str], ...] = ()
    right: tuple[Mapping[str, str], ...] = ()
    wrong: int = 0
    before: str = ""
    shape: str = ""
    false: tuple[int, ...] = (0, 0, 0, 0)


def read_recipes() -> dict[str, Recipe]:
    """All recipes by the names of their pages."""
    found = {
        it.stem: yaml.load(it.read_bytes(), yaml.CSafeLoader)
        for it in HERE.glob("vendors/recipes/*.yaml")
    }
    return {name: Recipe(**found[name]) for name in sorted(found)}


@contextmanager
def workspace(system: Mapping[str, Any], vendors: Vendors, folder: Path) -> Iterator[Path]:
    """Yield a folder in which the packages of a system are found as installed ones."""
    used = (packages_below(folder / it) for it in reversed(system["uses"]))
    packages = {name: path for found in used for name, path in found.items()}
    before = dict(os.environ)
    with tempfile.TemporaryDirectory() as work:
        environment = install(packages, Path(work) / "prefix", vendors.empty)
        commands = Path(work) / "commands"
        commands.mkdir()
        (commands / "ros2").touch(0o755)
        path = os.pathsep.join((str(Path(sys.executable).parent), str(commands), before["PATH"]))
        more = {"ROS_DISTRO": system["release"], "PATH": path, **system.get("environment", {})}
        os.environ.update(environment, **more)
        try:
            yield Path(work)
        finally:
            os.environ.clear()
            os.environ.update(before)


def words_for(folder: Path, work: Path, robot: str) -> dict[str, str]:
    """Return what stands for ``{sources}``, ``{work}`` and ``{robot}`` of a robot."""
    return {"sources": str(folder), "work": str(work), "robot": robot}


def fleet_text(recipe: Recipe, system: Mapping[str, Any], layout: str, count: int) -> str:
    """Return the fleet file of a recipe, with its words not yet filled in."""
    robots = []
    for number in range(1, count + 1):
        mine = {**system.get("robot", {}), **recipe.robot, "launch": system["launch"]}
        name = f"robot{number}"
        robots.append({"name": name, **filled(mine, {"robot": name})})
    keys = {"layout": layout, "affix": "prefix", "distro": system["release"]}
    rest = {**system["fleet"], **recipe.fleet}
    if recipe.window:
        rest["related_files"] = {**rest.get("related_files", {}), "rviz": recipe.window["config"]}
    fleet = {**keys, **{key: it for key, it in rest.items() if key not in ("layout", "affix")}}
    return yaml.safe_dump({**fleet, "robots": robots}, sort_keys=False, width=110)


def build(text: str, words: Mapping[str, str], layout: str, count: int) -> Built:
    """All that a recipe makes in a layout, or why it is refused."""
    robots = tuple(f"robot{it}" for it in range(1, count + 1))
    file = Path(words["work"]) / "fleet.yaml"
    places = {it: words[it] for it in ("sources", "work")}
    file.write_text(str(filled(text, places)))
    try:
        plan = planned_fleet(file, trust=True)
        return Built(layout, robots, plan.fleet, expected(plan.fleet), make_outputs(plan))
    except (InputError, UsageError) as problem:
        return Built(layout, robots, None, None, None, str(problem))


def recorded(system: Mapping[str, Any], words: Mapping[str, str]) -> list[dict[str, Any]]:
    """Return the programs of a robot, by the real launch with real descriptions."""
    rows: list[dict[str, Any]] = []
    for line in filled(system["launch"], words):
        command = [sys.executable, str(RECORDER), "--xacro", *line.split()]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        *_, last = done.stdout.rpartition("\n[")
        rows += json.loads(f"[{last.lstrip('[')}")
    return rows


def judged(recipe: Recipe, found: Compared) -> Compared:
    """Return the differences with the reasons of the recipe."""
    return found._replace(
        differences=tuple(it._replace(reason=_reason(recipe, it)) for it in found.differences)
    )


def _reason(recipe: Recipe, it: Difference) -> str:
    for rule in recipe.better:
        if re.search(rule["where"], it.where) and re.search(rule.get("ours", ""), it.ours):
            return rule["reason"]
    return ""


def false_findings(recipe: Recipe, built: Built) -> list[Finding]:
    """Return the warnings and errors of a build that the recipe does not call true."""
    return [it for it in built.findings if not is_true(recipe, it)]


def is_true(recipe: Recipe, it: Finding | Said) -> bool:
    """Return whether the recipe says so."""
    rules = (rule for rule in recipe.right if rule["code"] == it.code)
    return any(re.search(rule.get("says", ""), it.message) for rule in rules)


class Outcome(NamedTuple):
    """A recipe: what is built in each layout with two robots and with three, and what differs from
    the vendor's two robots in the vendor's layout; ``looked`` is what rehearsals of each say."""

    recipe: Recipe
    text: str
    built: tuple[Built, ...]
    compared: Compared
    looked: tuple[Looked, ...] = ()


def outcome(recipe: Recipe, vendors: Vendors, folder: Path, live: bool = False) -> Outcome:
    """Make a recipe in all its layouts, and run the vendor's launch files for two robots; ``live``
    rehearses each."""
    system = dict(vendors.systems[recipe.system])
    opened = [recipe.window["launch"]] if recipe.window else []
    system["launch"] = [*(recipe.launch or system["launch"]), *opened]
    with workspace(system, vendors, folder) as work:
        # "/" is the namespace of a robot that is alone.
        for robot in ("/", *ROBOTS):
            prepare(system, words_for(folder, work, robot))
        words = words_for(folder, work, "")
        built: list[Built] = []
        looked: list[Looked] = []
        for layout, count in product(recipe.layouts, (2, 3)):
            made = build(fleet_text(recipe, system, layout, count), words, layout, count)
            built.append(made)
            looked += [rehearsed(made, work)] if live else []
        found = [
            compare(built[0], it, recorded(system, words_for(folder, work, it)), vendors)
            for it in ROBOTS[:2]
        ]
        both = Compared(
            sum(it.equal for it in found), tuple(row for it in found for row in it.differences)
        )
        text = fleet_text(recipe, system, recipe.layouts[0], 2)
        return Outcome(recipe, text, tuple(built), judged(recipe, both), tuple(looked))


def rehearsed(built: Built, work: Path) -> Looked:
    """Return what a rehearsal says of the fleet file that was built last."""
    if built.outputs is None:
        return Looked((), ())
    files = {it.path: it.data for it in built.outputs.files}
    return look(work / "fleet.yaml", files, built.robots)
