# SPDX-License-Identifier: Apache-2.0
"""A vendor's launch files with the files that a build made for them: what its nodes get then."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import yaml
from vendor_recipes import Recipe, fleet_text, recorded, words_for, workspace
from vendor_rows import description_rows, load, parameter_rows
from vendor_systems import Vendors, filled, prepare, started_by

from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.checks.judged_plan import plan_fleet
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.fleet.outputs.shape_outputs import vendor_commands
from multibot_rewrite.fleet.robots.robot_groups import split_per_robot

ROBOT, MARK = "robot2", "made"


class Taken(NamedTuple):
    """What the build says of a node's parameters, or of the description, and what the node gets from
    the vendor's launch."""

    ours: Mapping[str, str]
    gets: Mapping[str, str]

    @property
    def is_ours(self) -> bool:
        """Is it what was built, and not the vendor's own?"""
        return any(MARK in key for key in self.gets)

    @property
    def differences(self) -> dict[str, tuple[str, str]]:
        """What the build says and the node gets otherwise."""
        both = {key: (it, self.gets.get(key, "-")) for key, it in self.ours.items()}
        return {key: it for key, it in both.items() if it[0] != it[1]}


def taken(
    recipe: Recipe, shape: str, simulator: str, vendors: Vendors, folder: Path
) -> tuple[list[str], dict[str, Taken]]:
    """Return the vendor's commands for a robot that a build with a shape writes, and what its
    nodes, by their full names, get when they run."""
    system = vendors.systems[recipe.system]
    with workspace(system, vendors, folder) as work:
        for robot in ("/", "robot1", ROBOT):
            prepare(system, words_for(folder, work, robot))
        text = str(filled(fleet_text(recipe, system, recipe.layouts[0], 2), _places(folder, work)))
        (work / "fleet.yaml").write_text(text)
        plain = _built(work, "", simulator)[0]
        files, commands = _built(work, shape, simulator)
        out = work / "out"
        for path, data in files.items():
            (out / path).parent.mkdir(parents=True, exist_ok=True)
            (out / path).write_text(_marked(path, data.decode()))
        rows = [row for it in commands for row in _run(it.replace("$PWD", str(out)), folder)]
        return commands, dict(_compared(plain, rows, vendors, " ".join(commands)))


def _marked(path: str, text: str) -> str:
    """Return a description or a parameter file that can be told from the vendor's own."""
    if text.lstrip().startswith("<"):
        return text.replace("<robot ", f'<robot {MARK}="here" ', 1)
    if "ros__parameters" not in text or not path.endswith(".yaml"):
        return text
    content = load(text)
    _mark(content)
    return str(yaml.safe_dump(content))


def _mark(content: Any) -> None:
    for key, value in content.items() if isinstance(content, dict) else ():
        if key == "ros__parameters":
            value[MARK] = "here"
        _mark(value)


def _places(folder: Path, work: Path) -> dict[str, str]:
    return {"sources": str(folder), "work": str(work)}


def _built(work: Path, shape: str, simulator: str) -> tuple[dict[str, bytes], list[str]]:
    file = read_fleet(str(work / "fleet.yaml"), "", {})
    robots = tuple(it._replace(simulator=simulator) for it in file.robots)
    plan = plan_fleet(file._replace(robots=robots, shape=shape), trust=True)
    outputs = make_outputs(plan)
    own = next(it for it in split_per_robot(plan) if it.robots[0].spec.name == ROBOT)
    return {it.path: it.data for it in outputs.files}, list(vendor_commands(own))


def _run(line: str, folder: Path) -> list[dict[str, Any]]:
    """Return the programs that a command starts; one that generates files is run."""
    words = shlex.split(line)
    own = dict(it.split("=", 1) for it in words if "=" in it.partition(":=")[0])
    _, verb, *words = words[len(own) :]
    if verb == "run":
        (program,) = folder.glob(f"*/{words[0]}/{words[0]}/*/{words[1]}")
        subprocess.run([sys.executable, str(program), *words[2:]], check=True, capture_output=True)
        return []
    if not words[0].startswith("/"):
        share = Path(os.environ["AMENT_PREFIX_PATH"].split(os.pathsep)[0]) / "share"
        words = [str(share / words[0] / "launch" / words[1]), *words[2:]]
    before = dict(os.environ)
    os.environ.update(own)
    try:
        return recorded({"launch": [" ".join(words)]}, {})
    finally:
        os.environ.clear()
        os.environ.update(before)


def _compared(
    plain: Mapping[str, bytes], rows: list[dict[str, Any]], vendors: Vendors, commands: str
) -> Iterator[tuple[str, Taken]]:
    own = {path: data.decode() for path, data in plain.items() if path.startswith(f"{ROBOT}/")}
    given = {path: it for path, it in own.items() if path in commands} or own
    params = [it for it in given.values() if "ros__parameters" in it and not it.startswith("<")]
    (urdf,) = (it for path, it in own.items() if path.endswith(".urdf"))
    for row in rows:
        if row["executable"] == "spawner":
            continue
        texts = [it["text"] for it in row.get("values", ())]
        for it in started_by(row, vendors.named):
            gets = parameter_rows(texts, it.name)
            if "robot_description" in gets:
                text = description_rows(gets.pop("robot_description"), ROBOT)
                yield f"{it.name} description", Taken(description_rows(urdf, ROBOT), text)
            yield it.name, Taken(parameter_rows(params, it.name), gets)
