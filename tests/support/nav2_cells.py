# SPDX-License-Identifier: Apache-2.0
"""Nav2 for two robots in the real launch, and the graph and parameters that come of it.

    python tests/support/nav2_cells.py [WORD ...]     the table; only cells that have these words
    python tests/support/nav2_cells.py --write [WORD ...]     write these into docs/contributing/nav2.md

MULTIBOT_SOURCES names a folder with sources by release: RELEASE/*navigation2*, RELEASE/*slam_toolbox*.
Needs launch, launch_ros, nav2_common's sources and rclpy. launch decides what is started and with
which words and files (``launch_recorder.py``); nodes with exactly these are started with the real rcl
(``nav2_stand_ins.py``), and the graph is compared with the plan that ``multibot build`` wrote.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

from named_ends import named_ends
from paths import fixture_text
from vendor_sources import VARIABLE, install, packages_below, sources_folder

from multibot_rewrite import load_fleet
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.outputs.built_states import with_built
from multibot_rewrite.knowledge.node_sets import load_nodes
from multibot_rewrite.library.loaded_fleet import LoadedFleet
from multibot_rewrite.live.rehearsal import isolated_environment, with_substitutes
from multibot_rewrite.planning.plan import read_plan
from multibot_rewrite.producers.ros.child import ask, observe, running
from multibot_rewrite.producers.ros.request import Request
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.parameters import Answer, questions, with_answers
from multibot_rewrite.system.records import SIM_TIME, System

HERE = Path(__file__).parent
ROOT = HERE.parent.parent
PAGE = ROOT / "docs" / "contributing" / "nav2.md"
RECORDER, STAND_INS = HERE / "launch_recorder.py", HERE / "nav2_stand_ins.py"
LAUNCH = ROOT / "share" / "launch" / "nav2.launch.py"
ROBOTS = ("robot1", "robot2")
START, END = "<!-- cells -->", "<!-- end of cells -->"
OWN, BRINGUP = "nav2.launch.py", "nav2_bringup"
BRIDGE = "tf_namespace_bridge"
LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")
# So long has the graph to be quiet.
LOOK_SECONDS, ASK_SECONDS = 40.0, 30.0
# A busy machine answers late.
TIMES = 4
FLEET = fixture_text("nav2_cells_fleet.yaml")
ROVER = """\
<robot name="rover">
  <link name="base_footprint"/> <link name="base_link"/> <link name="base_scan"/>
  <joint name="base" type="fixed"><parent link="base_footprint"/><child link="base_link"/></joint>
  <joint name="scan" type="fixed"><parent link="base_link"/><child link="base_scan"/></joint>
</robot>
"""
NODES = fixture_text("nav2_cells_nodes.yaml")
DRIVER = "driver:\n  ros__parameters: {odom_frame: odom, base_frame: base_footprint}\n"
# What runs besides Nav2 on each robot.
BESIDE = fixture_text("nav2_cells_beside.txt")
PROGRAMS = {
    "opennav_docking": "docking_server",
    "opennav_following": "following_server",
    "map_saver_server": "map_saver",
    "sync_slam_toolbox_node": "slam_toolbox",
    "component_container": "nav2_container",
    "component_container_isolated": "nav2_container",
    "relay": "tf_relay",
    "static_transform_publisher": "bridged_world",
}
PLUGINS = {
    "MapServer": "map_server",
    "AmclNode": "amcl",
    "ControllerServer": "controller_server",
    "SmootherServer": "smoother_server",
    "PlannerServer": "planner_server",
    "RouteServer": "route_server",
    "BehaviorServer": "behavior_server",
    "BtNavigator": "bt_navigator",
    "WaypointFollower": "waypoint_follower",
    "VelocitySmoother": "velocity_smoother",
    "CollisionMonitor": "collision_monitor",
    "DockingServer": "docking_server",
    "FollowingServer": "following_server",
    "LifecycleManager": "lifecycle_manager",
}
# The names that their code gives to nodes, where it is not that of the program.
CODE = {"docking_server": "docking_server", "tf_relay": "relay"}


class Cell(NamedTuple):
    """One way to start Nav2."""

    launch: str
    release: str
    layout: str
    composed: bool
    slam: bool
    more: str = ""

    @property
    def words(self) -> list[str]:
        """It as a row of the table."""
        how = "composed" if self.composed else "processes"
        where = "SLAM" if self.slam else "localisation"
        more = ", relayed" if self.more else ""
        return [self.launch, self.release, f"{self.layout}{more}", how, where]

    @property
    def node_set(self) -> str:
        """The node set of the fleet file."""
        return f"nav2{'_slam' if self.slam else ''}{'_composed' if self.composed else ''}"


class Outcome(NamedTuple):
    """What came of a cell: planned nodes in the graph, compared parameters and those of the plan,
    findings."""

    nodes: int
    parameters: int
    planned: int
    findings: tuple[Finding, ...]

    @property
    def wrong(self) -> int:
        """Findings about parameters."""
        return sum(it.code in ("MG511", "MG132", "MG133") for it in self.findings)


def cells() -> Iterator[Cell]:
    """All that the table has."""
    both = (False, True)
    for release in ("jazzy", "kilted"):
        for layout, composed, slam in product(("tf-per-robot", "both"), both, both):
            yield Cell(BRINGUP, release, layout, composed, slam)
    for release in ("jazzy", "kilted", "lyrical"):
        for layout, composed, slam in product(LAYOUTS, both, both):
            yield Cell(OWN, release, layout, composed, slam)
    for layout in ("tf-per-robot", "both", "postfix"):
        yield Cell(OWN, "jazzy", layout, True, False, "relayed: true")


def written(cell: Cell, folder: Path, sources: Path) -> LoadedFleet:
    """Return the fleet of a cell, built: with the parameter file that nav2_bringup has itself."""
    nav2, slam = (
        next((sources / cell.release).glob(it)) for it in ("*navigation2*", "*slam_tool*")
    )
    params = (nav2 / "nav2_bringup/params/nav2_params.yaml").read_text()
    mapper = (slam / "config/mapper_params_online_sync.yaml").read_text()
    if not cell.slam:
        mapper = ""
    (folder / "params.yaml").write_text(f"{params}\n{mapper}\n{DRIVER}")
    (folder / "rover.urdf").write_text(ROVER)
    (folder / "nodes.yaml").write_text(NODES)
    style = "params_style: bringup" if cell.launch == BRINGUP else ""
    affix = "postfix" if cell.layout == "postfix" else "prefix"
    more = f"{style}\n{cell.more}"
    words = {"node_set": cell.node_set, "affix": affix, "more": more}
    text = FLEET.format(**cell._asdict() | words)
    (folder / "fleet.yaml").write_text(text)
    return load_fleet(folder / "fleet.yaml")


def launch_file(cell: Cell, folder: Path, sources: Path) -> Path:
    """Both robots as somebody would start them."""
    file, given = str(LAUNCH), [{"fleet": "fleet.yaml", "map": "map.yaml"}]
    if cell.launch == BRINGUP:
        nav2 = next((sources / cell.release).glob("*navigation2*"))
        file = str(nav2 / "nav2_bringup/launch/bringup_launch.py")
        given = [dict(_for_bringup(cell, robot, folder)) for robot in ROBOTS]
    path = folder / "all.launch.py"
    place = "place()," if cell.launch == BRINGUP else ""
    text = BESIDE.replace("{file!r}", repr(file)).replace("{given!r}", repr(given))
    path.write_text(text.replace("{place}", place))
    return path


def _for_bringup(cell: Cell, robot: str, folder: Path) -> Iterator[tuple[str, str]]:
    yield "namespace", robot
    if cell.release in ("humble", "jazzy"):
        yield "use_namespace", "True"
    else:
        yield from (("use_keepout_zones", "False"), ("use_speed_zones", "False"))
    yield "params_file", str(folder / "out" / robot / "params.yaml")
    yield from (("map", "map.yaml"), ("slam", str(cell.slam)))
    yield "use_composition", str(cell.composed)


def recorded(file: Path, environ: Mapping[str, str]) -> list[dict[str, Any]]:
    """Return what launch starts, with its words and files."""
    command = [sys.executable, str(RECORDER), file.name]
    done = subprocess.run(
        command, cwd=file.parent, env={**environ}, capture_output=True, text=True, check=True
    )
    assert "Caught" not in done.stderr, done.stderr
    rows: list[dict[str, Any]] = json.loads("[" + f"\n{done.stdout}".rpartition("\n[")[2])
    return rows


def processes(fleet: LoadedFleet, rows: list[dict[str, Any]], folder: Path) -> list[Any]:
    """Yield the order for the stand-ins: each process with its words, its nodes and those in them."""
    facts = {it.name: it for it in fleet.plan.fleet.facts}
    ends: dict[str, list[Any]] = {}
    for it in named_ends(fleet.planned.table):
        if it.robot == ROBOTS[0] and not it.endpoint.when:
            ends.setdefault(it.node, []).append(it.endpoint)
    names = {it.node: it.full_name for it in fleet.planned.table.runs if it.robot == ROBOTS[0]}
    known = load_nodes(fleet.plan.file.distro)

    def node(name: str, code: str, words: list[str], parameters: Any, below: str = "") -> Any:
        own = facts.get(name) or known.get(name)
        frames = {it.parameter: it.default for it in own.frames} if own else {}
        sends = [
            [[k, frames[k]] for k in (it.parent, it.child)] for it in (own.sends if own else ())
        ]
        manager = name.startswith("lifecycle_manager")
        found = [
            [
                *(it.kind, it.role or "publishes", it.name, it.type, it.parameter),
                *(it.helper, it.by, it.above),
            ]
            for it in ends.get(names.get(name, ""), ())
            if "relay" not in name and name != BRIDGE and not (manager and it.role == "calls")
        ]
        return {
            **{"name": code, "words": words, "parameters": parameters, "below": below},
            **{"sends": sends, "manager": manager, "endpoints": found},
        }

    def with_hosted(name: str, code: str, words: list[str], parameters: Any) -> Iterator[Any]:
        yield node(name, code, words, parameters)
        inside = _handed_on(words) if has_release("lyrical+", fleet.plan.file.distro) else []
        for it in facts.values():
            if it.host == name:
                above, _, own = it.name.rpartition("/")
                yield node(it.name, own, inside, [], above)

    made = []
    for number, row in enumerate(rows):
        if "container" in row:
            continue
        name = PROGRAMS.get(row["executable"], row["executable"])
        code = CODE.get(name, name)
        if name == "lifecycle_manager":
            name = row["name"].partition("_robot")[0]
        words = [_kept(word, row["params"], folder / f"file{number}") for word in row["words"]]
        nodes = [*with_hosted(name, code, [], [])]
        inside = [it for it in rows if it.get("container", "").strip("/") == _full(row)]
        for it in inside if name == "nav2_container" else ():
            kind = PLUGINS[it["executable"].rpartition("::")[2]]
            called = it["name"].partition("_robot")[0] if kind.startswith("lifec") else kind
            given = [f"__node:={it['name']}"] if it["name"] else []
            given += [f"__ns:={it['namespace']}"] if it["namespace"] else []
            rules = [*given, *(":=".join(pair) for pair in it["rules"])]
            own = [word for rule in rules for word in ("-r", rule)]
            nodes += with_hosted(called, kind, own, it["parameters"])
        made.append({"program": row["executable"], "words": words, "nodes": nodes})
    return made


def _handed_on(words: list[str]) -> list[str]:
    """Return what a costmap gets of its parent's arguments: nav2_costmap_2d 1.5.1
    costmap_2d_ros.cpp (getChildNodeOptions) replaces name and namespace."""
    rules = (it for it in words if it != "-r" and not it.startswith(("__node:=", "__ns:=")))
    return [word for rule in rules for word in ("-r", rule)]


def _full(row: Mapping[str, Any]) -> str:
    return f"{row['namespace'].strip('/')}/{row['name']}".strip("/")


def _kept(word: str, texts: Mapping[str, str], path: Path) -> str:
    """Return a word; a file that was there for the launch is there again."""
    if word not in texts:
        return word
    kept = path.with_name(f"{path.name}_{list(texts).index(word)}.yaml")
    kept.write_text(texts[word])
    return str(kept)


def outcome(cell: Cell, folder: Path, sources: Path) -> Outcome:
    """Build, launch, look, compare."""
    fleet = written(cell, folder, sources)
    out = folder / "out"
    code = main(["build", str(folder / "fleet.yaml"), "-o", str(out), "-q"])
    assert code == 0, f"build ended with {code}"
    packages = packages_below(sources / cell.release)
    around = install(packages, folder / "prefix", {"my_driver": [], BRIDGE: []})
    environ = {**os.environ, **around, "RECORDER_QUIET": "1.5"}
    rows = recorded(launch_file(cell, folder, sources), environ)
    order = json.dumps(processes(fleet, rows, folder))
    return looked_at(order, out)


def looked_at(order: str, out: Path) -> Outcome:
    """Return the graph of the stand-ins against the plan."""
    # With LOCALHOST the 33rd process and those after it are not found.
    environ = {**isolated_environment(None), "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}
    with running(str(STAND_INS.stem), order, {**environ, "PYTHONPATH": _path(environ)}) as child:
        replaced = json.loads(child.next_message() or b"{}")
        plan = with_built(read_plan((out / "plan.yaml").read_bytes(), "plan.yaml"), str(out))
        plan = with_substitutes(plan, replaced)
        graph = observe(Request(LOOK_SECONDS, substitutes=True), environ)
        asked: dict[str, list[str]] = {}
        for it in plan.parameters:
            asked.setdefault(it.node, []).append(it.name)
        graph = with_answers(graph, answers(graph, asked, environ))
    found = tuple(it for it in check(plan, graph) if it.level != "note")
    nodes = {it.name for it in plan.nodes if it.robot} & {it.name for it in graph.nodes}
    answered = Counter(it.node for it in graph.parameters if it.name != SIM_TIME)
    compared = sum(answered[node] for node in asked)
    wanted = sum(len(own) for node, own in asked.items() if node in nodes)
    return Outcome(len(nodes), compared, wanted, found)


def answers(
    graph: System, asked: Mapping[str, list[str]], environ: Mapping[str, str]
) -> tuple[Answer, ...]:
    """Return what nodes say of the parameters that they are asked for."""
    wanted = sum(len(own) for own in asked.values())
    for _ in range(TIMES):
        states = ask(list(questions(graph, asked)), ASK_SECONDS, environ)
        if sum(len(it.parameters) for it in states if it.node in asked) >= wanted:
            break
    return tuple(states)


def _path(environ: Mapping[str, str]) -> str:
    return os.pathsep.join((str(HERE), environ.get("PYTHONPATH", "")))


def rows_of(chosen: list[str], page: str) -> Iterator[str]:
    """Yield the rows of the table: the chosen ones anew, others as they are in the page."""
    rows = (line for line in page.splitlines() if line.startswith("| nav2"))
    kept = {tuple(line.strip("| ").split(" | ")[:5]): line for line in rows}
    sources = sources_folder()
    if sources is None:
        raise SystemExit(f"set {VARIABLE} to a folder with sources by release")
    yield "| launch file | release | layout | Nav2 | | nodes | parameters | wrong |"
    yield "|---|---|---|---|---|--:|--:|--:|"
    for cell in cells():
        if not set(chosen) <= set(cell.words):
            if before := kept.get(tuple(cell.words)):
                yield before
            continue
        with tempfile.TemporaryDirectory() as folder:
            made = outcome(cell, Path(folder), sources)
        assert made.parameters == made.planned, f"{made.parameters} of {made.planned} answered"
        counts = (made.nodes, made.parameters, len(made.findings) + made.wrong)
        for it in made.findings[:12] if "--write" not in sys.argv else ():
            print("   ", it.code, it.level, it.robot, it.node, it.message[:200], file=sys.stderr)
        yield f"| {' | '.join((*cell.words, *map(str, counts)))} |"


if __name__ == "__main__":
    lines = []
    words, write = [it for it in sys.argv[1:] if it != "--write"], "--write" in sys.argv
    for line in rows_of(words, PAGE.read_text() if write else ""):
        print(line, flush=True)
        lines.append(line)
    if write:
        before, _, rest = PAGE.read_text().partition(START)
        after = rest.partition(END)[2]
        PAGE.write_text("\n".join((f"{before}{START}", "", *lines, "", f"{END}{after}")))
