# SPDX-License-Identifier: Apache-2.0
"""Measure the checking of a live graph, with real nodes on this machine, in one run.

python benchmarks/bench_graph.py            print the table
python benchmarks/bench_graph.py --write    and put it into docs/contributing/measurements.md

Needs rclpy and zenoh (pip install '.[test]').
"""

from __future__ import annotations

import os
import platform
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "support"))
import live_fleet  # the nodes of the tests
import zenoh_robots  # and its sessions
from one_page import write_section
from plans import planned_end

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.knowledge.node_library import nodes_of_set
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.planning.plan import to_yaml
from multibot_rewrite.planning.table import build_table
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.json import from_json, from_yaml, to_json
from multibot_rewrite.system.records import (
    PUBLISHES,
    SUBSCRIBES,
    TOPIC,
    End,
    Environment,
    Node,
    Robot,
    System,
)

COMMAND = [sys.executable, "-m", "multibot_rewrite.cli.multibot", "check"]
TYPES = ("String", "Empty")
LIVE_RUNS = 3
# Long enough for processes to find one another.
DISCOVERED_SECONDS = 5


class Size(NamedTuple):
    """A fleet: so many robots, nodes a robot, topics a node, each published and subscribed."""

    robots: int
    nodes: int
    topics: int
    processes: int

    def __str__(self) -> str:
        nodes = f" x {self.nodes} nodes" if self.nodes > 1 else ""
        return f"{self.robots} robots{nodes} x {self.topics} topics"


SMALL, LARGE = Size(10, 5, 8, 10), Size(100, 1, 20, 5)
# Robots as they come, with seconds and CPU that a check without a plan may take.
ROBOTS = (
    (Size(2, 6, 2, 2), "3", "0.6"),
    (Size(10, 6, 2, 10), "4", "1.2"),
    (Size(50, 6, 2, 10), "10", "4"),
)


class Row(NamedTuple):
    """One line of the table; ``value`` is a median of waiting times or memory, or the least CPU time,
    as ``taken`` says; ``spread`` is least and most."""

    what: str
    fleet: str
    taken: str
    value: float
    spread: str
    unit: str
    goal: str


def waited(what: str, fleet: object, values: Sequence[float], unit: str, goal: str) -> Row:
    value = statistics.median(values)
    return Row(what, str(fleet), "median", value, spread(values), unit, goal)


def computed(what: str, fleet: object, values: Sequence[float], unit: str, goal: str) -> Row:
    """CPU time: what other processes add to it is no cost of ours, so the least counts."""
    return Row(what, str(fleet), "least CPU", min(values), spread(values), unit, goal)


def spread(values: Sequence[float]) -> str:
    return f"{min(values):.3g} to {max(values):.3g}" if len(values) > 1 else ""


def ends(size: Size) -> Iterator[End]:
    """Every endpoint of a fleet: a topic has its publisher and its subscription in one node."""
    for robot in range(size.robots):
        for node in range(size.nodes):
            for topic in range(size.topics):
                name = f"n{node}_t{topic}"
                full = f"/robot{robot}/{name}"
                type_ = f"std_msgs/msg/{TYPES[topic % 2]}"
                for role in (PUBLISHES, SUBSCRIBES):
                    yield planned_end(f"/robot{robot}/node{node}", TOPIC, role, full, type_, name)


def plan_of(size: Size) -> System:
    names = [f"robot{robot}" for robot in range(size.robots)]
    return System(
        tuple(Node(f"/{it}/node{at}", robot=it) for it in names for at in range(size.nodes)),
        tuple(ends(size)),
        robots=tuple(Robot(it, (), f"/{it}/tf") for it in names),
        layout="both",
        shared_topics=("/clock",),
        shared_frames=("map",),
        ignored_nodes=("/early*",),
    )


def graph_of(plan: System) -> System:
    """Return the graph exactly as planned."""
    around = Environment(0, "LOCALHOST", (), "rmw_fastrtps_cpp", "", False, 5, "quiet", 3.5, ())
    nodes = tuple(Node(it.name, "") for it in plan.nodes)
    found = (End(w.kind, w.role, w.name, w.type, "", w.node, None, "") for w in plan.ends)
    return System(nodes, tuple(found), (), around)


def specs(size: Size) -> list[list[dict[str, Any]]]:
    """Return the fleet for ``live_fleet``, dealt to its processes."""
    hands: list[list[dict[str, Any]]] = [[] for _ in range(size.processes)]
    for robot in range(size.robots):
        for node in range(size.nodes):
            names = [[f"n{node}_t{at}", TYPES[at % 2]] for at in range(size.topics)]
            spec = {"name": f"node{node}", "namespace": f"robot{robot}"}
            hands[robot % size.processes].append(
                {**spec, "publishers": names, "subscriptions": names}
            )
    return hands


@contextmanager
def plan_file(size: Size) -> Iterator[str]:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "plan.json")
        path.write_bytes(to_json(plan_of(size)))
        yield str(path)


class Ended(NamedTuple):
    """What a command took, its children included: CPU seconds, peak memory of one process."""

    code: int
    seconds: float
    cpu: float
    peak: float


def ended(process: subprocess.Popen[str], began: float) -> Ended:
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    cpu = usage.ru_utime + usage.ru_stime
    return Ended(process.returncode, time.monotonic() - began, cpu, usage.ru_maxrss / 1024)


def fresh(size: Size, domain: int, *plan: str) -> list[Ended]:
    """Time checks that are started when the fleet is up and known to all."""
    with live_fleet.running(domain, *specs(size)):
        time.sleep(DISCOVERED_SECONDS)
        results = []
        for _ in range(LIVE_RUNS):
            began = time.monotonic()
            process = subprocess.Popen(
                [*COMMAND, *plan, "--timeout", "60"],
                env=as_installed(live_fleet.environ(domain)), stderr=subprocess.PIPE, text=True,
            )  # fmt: skip
            assert process.stderr is not None
            said = process.stderr.read()
            results.append(ended(process, began))
            assert results[-1].code == 0, said
    return results


def first(size: Size, plan: str, domain: int, known: bool) -> float:
    """Seconds from the last endpoint of a fleet to its presence on the screen of a running check, which
    says "as planned" some seconds later.

    ``known`` tells that its processes have been there for a while.
    """
    hands = specs(size)
    for at, hand in enumerate(hands):
        hand.insert(0, {"name": f"early{at}", "wait": DISCOVERED_SECONDS if known else 0})
    process = subprocess.Popen(
        [*COMMAND, plan, "--watch"],
        env=as_installed(live_fleet.environ(domain)), stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    seen: list[float] = []
    verdict = threading.Event()
    began = threading.Event()

    def read() -> None:
        assert process.stdout is not None
        for line in process.stdout:
            began.set()
            if ", all seen; " in line:
                seen.append(time.monotonic())
                if "0 findings: as planned" in line:
                    verdict.set()

    reader = threading.Thread(target=read, daemon=True)
    reader.start()
    began.wait(30)
    with live_fleet.running(domain, *hands):
        last = time.monotonic()
        verdict.wait(60)
        process.send_signal(2)
        assert process.stderr is not None
        said = process.stderr.read()
        process.wait()
    assert process.returncode == 0, said
    return seen[0] - last


def live() -> Iterator[Row]:
    domain = 1 + os.getpid() % 90
    for at, (size, presence) in enumerate(((SMALL, "0.5"), (LARGE, "1"))):
        with plan_file(size) as plan:
            early = [first(size, plan, domain + at, True) for _ in range(LIVE_RUNS)]
            yield waited("check that runs already: all present", size, early, "s", presence)
            early = [first(size, plan, domain + at, False) for _ in range(LIVE_RUNS)]
            yield waited("the same, processes just started", size, early, "s", "")
    with plan_file(LARGE) as plan:
        late = fresh(LARGE, domain + 5, plan)
    yield waited("fresh check: verdict", LARGE, [it.seconds for it in late], "s", "6")
    yield computed("its CPU", LARGE, [it.cpu for it in late], "s", "1.2")
    yield waited("its peak memory", LARGE, [it.peak for it in late], "MiB", "120")
    for at, (size, seconds, cpu) in enumerate(ROBOTS):
        late = fresh(size, domain + 6 + at)
        yield waited("check without a plan", size, [it.seconds for it in late], "s", seconds)
        yield computed("its CPU", size, [it.cpu for it in late], "s", cpu)


def through_router() -> Iterator[Row]:
    """Yield a check that asks a Zenoh router, with a session in place of the robots."""
    domain = 42
    with (
        plan_file(LARGE) as plan,
        zenoh_robots.router() as address,
        zenoh_robots.robot(address, domain) as there,
    ):
        hold(there)
        command = [*COMMAND, plan, "--from", address, "--domain", str(domain)]
        results = [_as_planned(command) for _ in range(LIVE_RUNS + 2)]
    took = [it.seconds for it in results]
    yield waited("fresh check through a Zenoh router: verdict", LARGE, took, "s", "0.5")
    yield computed("its CPU", LARGE, [it.cpu for it in results], "s", "0.5")


def hold(there: zenoh_robots.Robot) -> None:
    """Announce the nodes and topics of the large fleet by tokens."""
    types = [f"std_msgs::msg::dds_::{it}_" for it in TYPES]
    for at in range(LARGE.robots):
        space = f"/robot{at}"
        there.node(at, space, "node0")
        for topic in range(LARGE.topics):
            for kind in ("MP", "MS"):
                there.end(at, space, "node0", kind, f"{space}/n0_t{topic}", types[topic % 2])


def timed(job: Callable[[], object], runs: int = 7) -> list[float]:
    """Milliseconds of CPU of each run."""
    result = []
    for _ in range(runs):
        began = time.process_time()
        job()
        result.append(1000 * (time.process_time() - began))
    return result


def pure() -> Iterator[Row]:
    least = []
    for robots, goal in ((100, "50"), (1000, "1000"), (2000, "")):
        size = Size(robots, 1, 20, 1)
        plan = plan_of(size)
        graph = graph_of(plan)
        assert check(plan, graph) == []
        values = timed(lambda plan=plan, graph=graph: check(plan, graph))  # type: ignore[misc]
        least.append(min(values))
        yield computed("comparison alone", size, values, "ms", goal)
        if robots == 100:
            yaml, json = to_yaml(plan).encode(), to_json(graph)
            of_yaml = timed(lambda y=yaml: from_yaml(y, ""))  # type: ignore[misc]
            yield computed("reading the plan, YAML", size, of_yaml, "ms", "")
            data = to_json(plan)
            of_json = timed(lambda j=data: from_json(j, ""))  # type: ignore[misc]
            yield computed("reading the plan, JSON", size, of_json, "ms", "")
            yield computed("YAML against JSON", size, [min(of_yaml) / min(of_json)], "x", "10")
            values = timed(lambda j=json: from_json(j, ""))  # type: ignore[misc]
            yield computed("reading a snapshot", size, values, "ms", "")
    yield computed(
        "2,000 robots against 1,000", "comparison", [least[2] / least[1]], "x", "2 is linear"
    )


def by_command() -> Iterator[Row]:
    """Time checks of saved snapshots, both files from the disk."""
    least = {}
    for robots, nodes, topics in ((5_000, 1, 20), (10_000, 1, 20), (10_000, 20, 1)):
        size = Size(robots, nodes, topics, 1)
        results = saved(size)
        least[size] = min(it.cpu for it in results)
        goals = ("10", "1000") if robots == 10_000 else ("", "")
        yield computed("check --from", size, [it.cpu for it in results], "s", goals[0])
        yield waited("its peak memory", size, [it.peak for it in results], "MiB", goals[1])
    half, whole, _ = least.values()
    yield computed(
        "10,000 robots against 5,000", "check --from", [whole / half], "x", "2 is linear"
    )


def saved(size: Size) -> list[Ended]:
    plan = plan_of(size)
    with tempfile.TemporaryDirectory() as folder:
        files = Path(folder, "plan.json"), Path(folder, "graph.json")
        files[0].write_bytes(to_json(plan))
        files[1].write_bytes(to_json(graph_of(plan)))
        del plan
        command = [*COMMAND, str(files[0]), "--from", str(files[1])]
        return [_as_planned(command) for _ in range(3)]


def _as_planned(command: Sequence[str]) -> Ended:
    """Return what a command takes that ends with "as planned"."""
    began = time.monotonic()
    process = subprocess.Popen(
        command, stderr=subprocess.PIPE, text=True, env=as_installed(os.environ)
    )
    assert process.stderr is not None
    said = process.stderr.read()
    result = ended(process, began)
    assert result.code == 0, said
    return result


def as_installed(environ: Mapping[str, str]) -> dict[str, str]:
    """Without the variable that has Python compile every module again."""
    return {name: it for name, it in environ.items() if name != "PYTHONDONTWRITEBYTECODE"}


def tables() -> Iterator[Row]:
    nodes = nodes_of_set(built_in(NEWEST_LTS), "nav2")
    names = [f"robot{at}" for at in range(1000)]
    for layout in ("frames-per-robot", "postfix"):
        naming = make_naming(layout)
        values = timed(partial(build_table, names, nodes, naming, release=NEWEST_LTS), 3)
        yield computed(f"remap tables of nav2, {layout}", "1000 robots", values, "ms", "1000")


def table(rows: Sequence[Row]) -> str:
    lines = [
        "| what | fleet | taken as | value | least to most | goal |",
        "|---|---|---|--:|--:|--:|",
    ]
    for it in rows:
        value = f"{it.value:.3g} {it.unit}"
        goal = f"{it.goal} {it.unit}" if it.goal and it.unit != "x" else it.goal
        lines.append(f"| {it.what} | {it.fleet} | {it.taken} | {value} | {it.spread} | {goal} |")
    return "\n".join(lines) + "\n"


def busy(load: float) -> str:
    """Return a note on a run next to the work of others."""
    if load < (os.cpu_count() or 1):
        return ""
    return (
        f"The machine was busy with other work (load {load:.1f} before the run), so waiting times,\n"
        "and CPU times a little, are longer than they are alone.\n"
    )


def main() -> None:
    load = os.getloadavg()[0]
    # First, while this process is small: a child starts with its parent's peak of memory.
    seen = [*live(), *by_command()]
    text = table([*seen, *through_router(), *pure(), *tables()])
    print(text)
    if "--write" in sys.argv:
        where = f"CPython {platform.python_version()}, {os.cpu_count()} cores, Fast DDS, loopback"
        head = (
            "# Benchmark of the live checks\n\n"
            "Made by `python benchmarks/bench_graph.py --write` in one run:\n"
            "waiting times and memory are medians, CPU times the least of all runs.\n"
            f"{where}; a shared machine, so a digit more or less is noise.\n{busy(load)}\n"
        )
        write_section(head + text + NOTE)


NOTE = """
The time until everything is present counts from the last endpoint that was made. A process that has
just started is found by others after up to 3 s, whoever looks; hence the second row.

Nodes are rclpy's with their parameter services and run on the same cores as the check: 10 processes
for the small fleet and where there is no plan (2 for two robots), 5 for the large one. A verdict needs
3.5 s without change, since a participant is announced every 3 s, or 1.5 s where all that run here are
known; what is planned is shown as present before that. CPU and memory are those of the command with
its child that looks, interpreter start included. A plan is read as JSON here.

Every check here ends with "as planned", and so does each that is watched, as soon as nothing has
changed for 3.5 s. A Zenoh router knows all tokens when it is asked, so nothing is waited for; where
robots send tf, half a second is added, in which it is heard.
"""


if __name__ == "__main__":
    main()
