# SPDX-License-Identifier: Apache-2.0
"""``multibot check --watch`` beside real nodes that come and go."""

from __future__ import annotations

import os
import pty
import queue
import signal
import subprocess
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import live_fleet
import pytest
from live_commands import COMMAND, domain, node, write_plan
from waiting import wait_until

pytestmark = pytest.mark.live

pytest.importorskip("rclpy", reason="no rclpy: pip install '.[ros]'", exc_type=ImportError)
CHECK = [*COMMAND, "check"]
STRANGER = [{"name": "stranger", "namespace": "robot1", "publishers": [["/robot2/odom", "Empty"]]}]


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    return write_plan(tmp_path / "plan.yaml", ("robot1", "robot2"))


class Watch:
    """A running watch, whose lines are read as they come."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self.process = process
        self.lines: list[str] = []
        self._coming: queue.Queue[str] = queue.Queue()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self._coming.put(line)

    def until(self, text: str, seconds: float = 20) -> str:
        """Return the first line with ``text`` from now on."""
        wait_until(lambda: self._comes(text), seconds)
        return self.lines[-1]

    def _comes(self, text: str) -> bool:
        with suppress(queue.Empty):
            while True:
                self.lines.append(self._coming.get_nowait())
                if text in self.lines[-1]:
                    return True
        return False

    def end(self) -> tuple[int, str]:
        """End it as a user does; exit code and what it said on standard error."""
        self.process.send_signal(signal.SIGINT)
        assert self.process.stderr is not None
        said = self.process.stderr.read()
        return self.process.wait(20), said


@contextmanager
def watching(plan: Path | None, own: int, *more: str) -> Iterator[Watch]:
    process = subprocess.Popen(
        [*CHECK, *[str(plan)] * bool(plan), "--watch", *more],
        env=live_fleet.environ(own),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        yield Watch(process)
    finally:
        process.kill()
        process.wait()


def rated(robot: str, rate: int) -> list[dict[str, object]]:
    """Return a node that is asked for a parameter."""
    return [node(robot, parameters={"rate": rate}, changed={"rate": 2})]


def with_rates(plan: Path) -> Path:
    """Return the plan, in which each node has the rate 2."""
    rates = "".join(f"- {{node: /robot{at}/drive, name: rate, value: '2'}}\n" for at in (1, 2))
    plan.write_text(f"{plan.read_text()}parameters:\n{rates}")
    return plan


def test_a_fleet_that_comes_up_while_it_is_watched(plan: Path) -> None:
    own = domain(70)
    with watching(with_rates(plan), own, "--state") as watch:
        assert "2 robots, 1 node each: all known, 0 of 2 seen; " in watch.until("2 robots")
        with live_fleet.running(own, rated("robot1", 2), rated("robot2", 2)):
            watch.until("2 robots, 1 node each: all known, all seen; 0 findings: still changing")
            watch.until("2 robots, 1 node each: all known, all seen; 0 findings: as planned", 40)
            code, said = watch.end()
    assert code == 0, said
    held = "2 robots, 1 node each: all known, all seen"
    answered = "multibot: 2 of 2 nodes answered --state\n"
    assert said == f"{answered}multibot: {held}; 0 findings: as planned\n"


@pytest.mark.deep
def test_a_parameter_that_changes_is_seen_although_the_graph_does_not(plan: Path) -> None:
    own = domain(74)
    with (
        watching(with_rates(plan), own, "--state") as watch,
        live_fleet.running(own, rated("robot1", 1), rated("robot2", 2)) as (first, _),
    ):
        found = watch.until("  + /robot1/drive: error: MG132 rate is 1, planned is 2", 60)
        assert "/robot2" not in found
        first.send_signal(signal.SIGUSR1)
        watch.until("  - /robot1/drive: error: MG132", 60)
        assert "as planned" in watch.until("2 robots", 60)
        code, said = watch.end()
    assert code == 1, said


@pytest.mark.deep
def test_a_sensor_that_falls_silent_is_seen_although_the_graph_does_not_change() -> None:
    own, kinds = domain(75), {"scan": "LaserScan", "imu": "Imu"}
    sensors = [
        [{"name": it, "namespace": robot, "headers": [[it, f"sensor_msgs/msg/{kind}", it]]}]
        for robot in ("robot1", "robot2")
        for it, kind in kinds.items()
    ]
    topics = [[it, f"sensor_msgs/msg/{kind}"] for it, kind in kinds.items()]
    pilots = [
        [{"name": "pilot", "namespace": robot, "subscriptions": topics}]
        for robot in ("robot1", "robot2")
    ]
    with (
        live_fleet.running(own, *sensors, *pilots) as (_, _, lidar, *_),
        watching(None, own) as watch,
    ):
        watch.until("2 robots, 3 nodes each; 0 findings: nothing wrong seen", 60)
        lidar.send_signal(signal.SIGSTOP)
        found = watch.until(
            "  + /robot2/scan: error: MG326 publishes /robot2/scan, on which no", 60
        )
        assert "/robot1/scan has some" in found
        lidar.send_signal(signal.SIGCONT)
        watch.until("2 robots, 3 nodes each; 0 findings: nothing wrong seen", 60)
        assert watch.end()[0] == 1


@pytest.mark.deep
def test_the_worst_is_remembered_after_it_went(plan: Path) -> None:
    own = domain(71)
    with (
        watching(plan, own) as watch,
        live_fleet.running(own, [node("robot1")], [node("robot2")]),
    ):
        watch.until("2 robots, 1 node each: all known, all seen; ")
        with live_fleet.running(own, STRANGER):
            assert "error" in watch.until("  + /robot1/stranger: error: MG306 uses /robot2/odom")
        watch.until("  - /robot1/stranger: error: MG306 uses /robot2/odom")
        code, said = watch.end()
    assert code == 1, said
    assert said.endswith("not as planned\n")
    assert "Traceback" not in said


@pytest.mark.deep
def test_what_goes_away_is_missing_once_the_graph_is_quiet(plan: Path) -> None:
    own = domain(72)
    with watching(plan, own) as watch, live_fleet.running(own, [node("robot1")]):
        with live_fleet.running(own, [node("robot2")]):
            watch.until("2 robots, 1 node each: all known, all seen; ")
        watch.until("  + robot2: inconclusive: MG109")
        watch.until("  + robot2: error: MG109")
        code, _ = watch.end()
    assert code == 1


@pytest.mark.deep
def test_a_terminal_has_a_screen(plan: Path) -> None:
    own = domain(73)
    leader, follower = pty.openpty()
    command = [*CHECK, str(plan), "--watch", "--timeout", "12"]
    env = {**live_fleet.environ(own), "TERM": "xterm", "COLUMNS": "120"}
    with live_fleet.running(own, [node("robot1")], [node("robot2")]):
        process = subprocess.Popen(command, env=env, stdout=follower, stderr=subprocess.PIPE)
        os.close(follower)
        shown = b"".join(_read(leader))
        assert process.stderr is not None
        said = process.stderr.read().decode()
        process.stderr.close()
        assert process.wait(20) == 0, said
    text = shown.decode()
    assert "2 robots, 1 node each: all known, all seen; 0 findings: as planned" in text
    assert "robot2" in text
    assert "1/1" in text


def _read(leader: int) -> Iterator[bytes]:
    """Yield what comes on the terminal until the other side closes it."""
    while True:
        try:
            data = os.read(leader, 4096)
        except OSError:
            return
        if not data:
            return
        yield data


def test_robots_of_two_domains_are_watched_until_one_leaves(plan: Path) -> None:
    own, other = domain(90), domain(91)
    rows = f"- {{robot: robot1, number: {own}}}\n- {{robot: robot2, number: {other}}}\n"
    plan.write_text(f"{plan.read_text()}domains:\n{rows}")
    with (
        watching(plan, own) as watch,
        live_fleet.running(own, [node("robot1")]),
        live_fleet.running(other, [{"name": "rviz2"}]),
    ):
        with live_fleet.running(other, [node("robot2")]):
            watch.until("2 robots, 1 node each: all known, all seen; 0 findings: as planned", 60)
        assert f"in domain {other}" in watch.until("  + robot2: error: MG109", 60)
        code, said = watch.end()
    assert code == 1 and said.endswith(": not as planned\n")


def test_a_snapshot_is_not_watched(plan: Path, tmp_path: Path) -> None:
    (tmp_path / "graph.json").write_text("{}")
    command = [*CHECK, str(plan), "--watch", "--from", str(tmp_path / "graph.json")]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=20)
    assert done.returncode == 2
    assert "--watch is for the live graph, leave out --from" in done.stderr
