# SPDX-License-Identifier: Apache-2.0
"""Looks at healthy systems of real nodes on a machine that is kept busy: none may tell an error.

python tests/support/loaded_looks.py [SYSTEMS] [SEED] [BURNERS]

Three looks at each of so many systems, which a seed draws: node sets, layout, release and robots
differ. Their nodes send transforms, scans, odometry and IMU data while BURNERS processes compute.
"""

from __future__ import annotations

import random
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from tempfile import gettempdir
from typing import Any

import healthy_systems
import live_commands
import live_fleet
import live_graphs
import tf2_build
from healthy_systems import ODOMETRY, OF_EACH_RELEASE, SCAN, SYSTEMS, started

from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.system.records import Edge, System

LOOKS = 3
IMU = "sensor_msgs/msg/Imu"
FINDING = re.compile(r": (error|warning|inconclusive|note): (M[A-Z]\d{3}) ")
# What a machine that is too busy may come to: nothing wrong, or not known.
FINE = (0, 3)
WORD = re.compile(r"[a-z]+\d*")
# Whose frames a message of this type has.
SENSORS = {
    SCAN: re.compile("lidar|laser|scan"),
    IMU: re.compile("imu"),
    # Not its child.
    ODOMETRY: re.compile("odom.* "),
}


def drawn(count: int, seed: int) -> Iterator[tuple[str, System]]:
    """Yield the name and graph of so many healthy systems, no two alike."""
    cells = [(sets, at, who, it) for sets, at, who in OF_EACH_RELEASE for it in RELEASES]
    named: list[Any] = [*SYSTEMS, *cells]
    for it in random.Random(seed).sample(named, count):
        if isinstance(it, str):
            yield it, SYSTEMS[it]()
        else:
            sets, layout, robots, release = it
            graph = started(sets, layout, robots, release)
            yield f"{','.join(sets)} {layout} {release}", with_numbers(graph)


def with_numbers(graph: System) -> System:
    """Return the graph with a number where a node's name is known only when it runs."""
    return healthy_systems.respelled(graph, lambda name: name.replace("*", "94231"))


def specs(graph: System) -> list[list[dict[str, Any]]]:
    """Return the processes that play the graph: sensors send data in their frames, and who reads
    /clock goes by it."""
    played = live_graphs.processes(graph)
    for node in (one for process in played for one in process):
        frames = {it[0]: _frame(graph, it[0], it[1]) for it in node["publishers"]}
        rows = [(it, frames[it[0]]) for it in node["publishers"]]
        node["headers"] = [[it[0], it[1], frame, *it[2:]] for it, frame in rows if frame]
        node["publishers"] = [it for it, frame in rows if not frame]
        if any(it[1] == live_fleet.CLOCK for it in node["subscriptions"]):
            node["arguments"] = ["--ros-args", "-p", "use_sim_time:=true"]
    return played


def _frame(graph: System, topic: str, type_: str) -> str:
    """Return the frame of what is sent there, the one with most of the topic's words; or empty."""
    pattern, words = SENSORS.get(type_), {*WORD.findall(topic)}
    edges = [it for it in graph.edges if pattern and pattern.search(_frames(it, type_))]
    edges.sort(key=lambda it: len(words & {*WORD.findall(it.child), *WORD.findall(it.topic)}))
    return _frames(edges[-1], type_) if edges else ""


def _frames(edge: Edge, type_: str) -> str:
    return f"{edge.parent} {edge.child}" if type_ == ODOMETRY else edge.child


@contextmanager
def burning(count: int) -> Iterator[None]:
    """Keep so many processors busy inside the block."""
    with ExitStack() as stack:
        for _ in range(count):
            burner = subprocess.Popen([sys.executable, "-c", "while True: pass"])
            stack.callback(burner.wait)
            stack.callback(burner.kill)
        yield


def main(words: Iterable[str]) -> int:
    """Print each look with its findings; return 1 if one of them told an error."""
    count, seed, burners = (*map(int, words), *(20, 54, 2)[len([*words]) :])
    cache = Path(gettempdir(), "multibot_tf2")
    cache.mkdir(exist_ok=True)
    more, codes, wrong = tf2_build.build(cache), Counter[int](), 0
    for at, (name, graph) in enumerate(drawn(count, seed)):
        domain = live_commands.domain(at)
        env = {**live_fleet.environ(domain), **more}
        # Nodes that get no processor may not end in time, and are killed then.
        ended = suppress(subprocess.TimeoutExpired)
        with ended, burning(burners), live_fleet.running(domain, *specs(graph), **more):
            for _ in range(LOOKS):
                done = live_commands.multibot("check", env=env)
                codes[done.returncode] += 1
                wrong += done.returncode not in FINE
                found = [" ".join(it) for it in FINDING.findall(done.stdout)]
                last = done.stderr.splitlines()[-1:]
                print(name, done.returncode, found, *last, sep=" | ", flush=True)
                if done.returncode not in FINE:
                    print(done.stdout, done.stderr, sep="\n", flush=True)
    print(
        f"{sum(codes.values())} looks at {count} systems; exit codes {dict(codes)}; {wrong} wrong"
    )
    return int(wrong > 0)


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
