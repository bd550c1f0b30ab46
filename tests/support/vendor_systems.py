# SPDX-License-Identifier: Apache-2.0
"""What vendors' launch files start, against what a plan has: by their own files, and by launch files.

    python tests/support/vendor_systems.py [SYSTEM ...]      print each node
    python tests/support/vendor_systems.py --write  write the figures into docs/contributing/vendors.md

MULTIBOT_SOURCES names a folder with checkouts of the repositories that ``vendors/*.yaml`` names, under
these names. Needs launch and launch_ros. The judge is ``launch_recorder.py``: the real launch with
programs that do nothing.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import yaml
from fleet_folder import planned_fleet
from paths import fixture_text
from vendor_rows import parameter_rows
from vendor_sources import WITHOUT, install, packages_below, sources_folder

from multibot_rewrite.fleet.fleet import Fleet, expected
from multibot_rewrite.system.records import RUNS, System

HERE = Path(__file__).parent
PAGE = HERE.parent.parent / "docs" / "contributing" / "vendors.md"
RECORDER = HERE / "launch_recorder.py"
ROBOT, OTHER = "robot1", "robot2"
HEAD = fixture_text("vendor_systems_head.txt")
# Of the spawner: options with a value.
_VALUED = (
    *("-c", "--controller-manager", "-p", "--param-file", "-n", "--namespace", "-t"),
    *("--controller-type", "--controller-manager-timeout", "--switch-timeout"),
    *("--service-call-timeout", "--controller-ros-args"),
)
_PASSING = (
    *("create", "spawn_entity.py", "gz_spawn_model", "generate_description", "generate_launch"),
    *("generate_param", "generate_semantic_description", "wait_for_robot_description"),
)


class Vendors(NamedTuple):
    """The systems, what their nodes are called in their code, and what is only a stand-in."""

    systems: Mapping[str, Mapping[str, Any]]
    named: Mapping[str, Mapping[str, Any]]
    empty: Mapping[str, list[str]]
    sources: Mapping[str, str]


class Started(NamedTuple):
    """A node that runs, by the judge; ``by`` is package and executable, or what starts it, and
    ``parameters`` are those that are true."""

    name: str
    by: str
    rules: tuple[tuple[str, str], ...] = ()
    parameters: tuple[str, ...] = ()


class Outcome(NamedTuple):
    """A system: the nodes that its launch files start, its plan without and with them, and the
    fleet of the latter."""

    name: str
    before: str
    started: Mapping[str, Started]
    own: System
    launched: System
    fleet: Fleet


def read_vendors() -> Vendors:
    """All systems of ``vendors/*.yaml``."""
    parts = [
        yaml.load(it.read_bytes(), yaml.CSafeLoader) for it in sorted(HERE.glob("vendors/*.yaml"))
    ]
    merged: dict[str, dict[str, Any]] = {key: {} for key in Vendors._fields}
    for part in parts:
        for system in part["systems"].values():
            system.setdefault("uses", list(part["sources"]))
        for key, rows in part.items():
            merged[key] |= rows or {}
    return Vendors(**merged)


def filled(value: Any, words: Mapping[str, str]) -> Any:
    """Return a value with ``{sources}``, ``{work}`` and ``{robot}`` replaced in every text."""
    if isinstance(value, str):
        for word, text in words.items():
            value = value.replace(f"{{{word}}}", text)
        return value
    if isinstance(value, dict):
        return {filled(key, words): filled(it, words) for key, it in value.items()}
    return [filled(it, words) for it in value] if isinstance(value, list) else value


def prepare(system: Mapping[str, Any], words: Mapping[str, str]) -> None:
    """Write the files of a robot, and run the vendor's generators for it."""
    for path, text in filled(system.get("files", {}), words).items():
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        Path(path).write_text(text)
    for path, source in filled(system.get("links", {}), words).items():
        if not Path(path).exists():
            Path(path).symlink_to(source)
    for command in filled(system.get("prepare", []), words):
        subprocess.run([sys.executable, *command.split()], check=True, stdout=subprocess.DEVNULL)


def started(system: Mapping[str, Any], vendors: Vendors, words: Mapping[str, str]) -> list[Started]:
    """Return the nodes of one robot, by the real launch."""
    rows = [row for line in filled(system["launch"], words) for row in _recorded(line)]
    below = filled(system.get("below", ""), words)
    nodes = [it for row in rows for it in started_by(row, vendors.named)]
    found = [_below(it, below) for it in nodes]
    also = filled(system.get("simulator", {}), words)
    return [*found, *(Started(f"/{words['robot']}/{name}", by) for name, by in also.items())]


def _recorded(line: str) -> list[dict[str, Any]]:
    command = [sys.executable, str(RECORDER), *line.split()]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    # The world that Nav2 makes is looked for at the end; the program that makes it did not run.
    bad = [it for it in done.stderr.splitlines() if "Caught" in it and "/nav2_" not in it]
    if bad:
        raise SystemExit(f"{line}\n{bad[0]}")
    *_, rows = done.stdout.rpartition("\n[")
    found: list[dict[str, Any]] = json.loads(f"[{rows.lstrip('[')}")
    return found


def started_by(row: Mapping[str, Any], named: Mapping[str, Mapping[str, Any]]) -> Iterator[Started]:
    """Yield the nodes of a program: it may have several, and a spawner has its controllers."""
    by = f"{row['package']}/{row['executable']}"
    if not row["package"] or row["executable"] in _PASSING:
        return
    namespace = f"/{row['namespace'].strip('/')}".rstrip("/")
    if row["executable"] == "spawner":
        home = _home(row["own"], namespace)
        yield from (Started(f"{home}/{it}", by) for it in _positional(row["own"]))
        return
    names = named.get(by, {}).get("nodes", [""])
    own = row["name"] or names[0]
    if not own:
        raise SystemExit(f"{by} has no name in its launch file: add it to named, with its source")
    rules = tuple((old, new) for old, new in row["rules"])
    for name in (own, *names[1:]):
        full = f"{namespace}/{name}"
        values = parameter_rows((it["text"] for it in row.get("values", ())), full)
        yield Started(full, by, rules, tuple(key for key, it in values.items() if it == "True"))


def _below(it: Started, namespace: str) -> Started:
    """Return the node in a namespace; one RViz serves all robots."""
    alone = not namespace or it.by.startswith("rviz2/")
    return it if alone else it._replace(name=f"/{namespace}{it.name}")


def _home(words: list[str], namespace: str) -> str:
    """Return the namespace of the controller manager that a spawner is told: controllers run in
    it. A relative name is below that of the spawner, which is an option, too (spawner.py)."""
    given = dict(pairwise(words))
    manager = given.get("-c") or given.get("--controller-manager") or "controller_manager"
    own = given.get("-n") or given.get("--namespace") or namespace
    above = "" if manager.startswith("/") else f"/{own.strip('/')}"
    return f"{above}/{manager.strip('/')}".rpartition("/")[0].replace("//", "/").rstrip("/")


def _positional(words: Iterable[str]) -> Iterator[str]:
    rest = iter(words)
    for word in rest:
        if word in _VALUED:
            next(rest, None)
        elif not word.startswith("-"):
            yield word


def planned(system: Mapping[str, Any], words: Mapping[str, str], launch: bool) -> Fleet:
    """Return the plan of two robots by the vendor's files, with its launch files or without."""
    work = Path(words["work"])
    robots = []
    for robot in (ROBOT, OTHER):
        mine = {**words, "robot": robot}
        entry = {"name": robot, **filled(system.get("robot", {}), mine)}
        robots.append(entry | ({"launch": filled(system["launch"], mine)} if launch else {}))
    fleet = {"layout": "tf-per-robot", "distro": system["release"], "robots": robots}
    file = work / "fleet.yaml"
    file.write_text(yaml.safe_dump({**fleet, **filled(system["fleet"], words)}, sort_keys=False))
    return planned_fleet(file, trust=True).fleet


def missing(system: Mapping[str, Any], folder: Path) -> list[str]:
    """Return the checkouts that a system needs and that are not there."""
    return [it for it in system["uses"] if not (folder / it).is_dir()]


def outcome(name: str, vendors: Vendors, folder: Path) -> Outcome:
    """Run the judge and both plans of a system."""
    system = vendors.systems[name]
    used = (packages_below(folder / it) for it in reversed(system["uses"]))
    packages = {name: path for found in used for name, path in found.items()}
    with tempfile.TemporaryDirectory() as work:
        environment = install(packages, Path(work) / "prefix", vendors.empty)
        before = dict(os.environ)
        os.environ.update(
            environment, ROS_DISTRO=system["release"], **system.get("environment", {})
        )
        try:
            words = {"sources": str(folder), "work": work, "robot": ROBOT}
            for robot in (ROBOT, OTHER):
                prepare(system, {**words, "robot": robot})
            nodes = {it.name: it for it in started(system, vendors, words)}
            own, launched = (planned(system, words, launch) for launch in (False, True))
        finally:
            os.environ.clear()
            os.environ.update(before)
    plans = (expected(own), expected(launched))
    return Outcome(name, str(system.get("before", "")), nodes, *plans, launched)


def nodes_of(plan: System) -> dict[str, bool]:
    """Return a plan's nodes of the first robot and of all, and whether each has to run."""
    own = {it.name: it.sure == RUNS for it in plan.nodes if it.robot == ROBOT}
    return {**own, **{it.name: False for it in plan.nodes if not it.robot}}


def wrong(plan: System, there: Mapping[str, Started]) -> list[str]:
    """Nodes that have to run by the plan, and that nothing starts."""
    return [it for it, runs in nodes_of(plan).items() if runs and it not in there]


def with_topics(plan: System, there: Mapping[str, Started]) -> list[str]:
    """Nodes that run, and whose topics, services and actions the plan has."""
    known = {it.node for it in plan.ends}
    return [it for it in nodes_of(plan) if it in there and it in known]


def page(outcomes: Iterable[Outcome]) -> str:
    """Return the page: a row a system."""
    return "\n".join([HEAD, *map(_row, outcomes), ""])


def _row(it: Outcome) -> str:
    there = it.started
    cells = [it.name, len(there), it.before or "-"]
    for plan in (it.own, it.launched):
        named = [name for name in nodes_of(plan) if name in there]
        cells += [len(named), len(with_topics(plan, there)), len(wrong(plan, there))]
    return f"| {' | '.join(map(str, cells))} |"


def _table(it: Outcome) -> Iterator[str]:
    plans = [
        (
            nodes_of(plan),
            {
                it.name: f"node set {it.node_set}" if it.node_set else str(it.place)
                for it in plan.nodes
            },
        )
        for plan in (it.own, it.launched)
    ]
    yield from ("", f"## {it.name}", "")
    yield "| node | started by | by its files | by its launch files | topics |"
    yield "|---|---|---|---|---|"
    for name, node in sorted(it.started.items()):
        cells = [
            _short(origins.get(name, "added")) if name in there else "" for there, origins in plans
        ]
        topics = "known" if name in with_topics(it.launched, it.started) else ""
        yield f"| `{name}` | {node.by} | {cells[0]} | {cells[1]} | {topics} |"
    for word, plan in (("files", it.own), ("launch files", it.launched)):
        bad = wrong(plan, it.started)
        yield from [f"\nWrong by its {word}: {', '.join(bad)}."] if bad else []


def _short(origin: str) -> str:
    """Return a place without the folders above its file."""
    return origin.rpartition("/")[2]


def main(words: list[str]) -> int:
    """Print the nodes of some systems, or write the figures of all."""
    folder = sources_folder()
    if folder is None:
        print(WITHOUT, file=sys.stderr)
        return 2
    vendors = read_vendors()
    names = [it for it in words if not it.startswith("--")] or list(vendors.systems)
    lacking = {it for name in names for it in missing(vendors.systems[name], folder)}
    if lacking:
        print(f"{folder} lacks {', '.join(sorted(lacking))}", file=sys.stderr)
        return 2
    found = [outcome(it, vendors, folder) for it in names]
    if "--write" in words:
        PAGE.write_text(page(found))
    else:
        print("\n".join([page(found), *(line for it in found for line in _table(it))]))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
