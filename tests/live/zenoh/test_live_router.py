# SPDX-License-Identifier: Apache-2.0
"""A real router and sessions of robots on loopback: what is seen through it, and what is said."""

from __future__ import annotations

import threading
from collections.abc import Generator, Iterator
from contextlib import closing, contextmanager
from itertools import islice
from pathlib import Path

import pytest

pytest.importorskip("zenoh", reason="no zenoh: pip install '.[zenoh]'")

from live_commands import write_plan
from zenoh_robots import STRING, TF_HASH, TF_TYPE, Robot, drive, robot, router

from multibot_rewrite.base.model import InputError
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.producers.ros.request import Request
from multibot_rewrite.producers.zenoh.observe import Router, look, watch
from multibot_rewrite.system.records import CHANGING, System, incomplete

pytestmark = pytest.mark.live
NOWHERE = "tcp/127.0.0.1:1"
BOTH = ("robot1", "robot2")


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    with router() as found:
        yield found


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    return write_plan(tmp_path / "plan.yaml", BOTH)


@contextmanager
def fleet(address: str, domain: int, names: tuple[str, ...] = BOTH) -> Iterator[Robot]:
    """Robots as planned, all in one session."""
    with robot(address, domain) as there:
        for number, name in enumerate(names):
            drive(there, name, number)
        yield there


def seen(address: str, domain: int, **more: tuple[str, ...]) -> System:
    return look(Request(10.0, **more), Router(address, domain))


def watched(address: str, domain: int) -> Generator[System, None, None]:
    with closing(watch(Request(20.0), {domain: Router(address, domain)})) as changes:
        yield from (it for _, it in changes)


def check(plan: Path, address: str, domain: int) -> int:
    return main(["check", str(plan), "--from", address, "--domain", str(domain)])


def codes(snapshot: System) -> set[str]:
    return {it.code for it in snapshot.environment.caveats}


def test_a_fleet_as_planned(plan: Path, address: str, capsys: pytest.CaptureFixture[str]) -> None:
    with fleet(address, 1):
        assert check(plan, address, 1) == 0
    shown = capsys.readouterr()
    assert (
        shown.out,
        "2 robots, 1 node each: all known, all seen; 0 findings: as planned" in shown.err,
    ) == ("", True), shown.err


def test_the_snapshot_is_complete_with_qos_and_hashes(address: str) -> None:
    with fleet(address, 2) as there:
        graph = seen(address, 2)
        session = str(there.session.zid())
    assert [(it.name, it.process) for it in graph.nodes] == [
        ("/robot1/drive", session),
        ("/robot2/drive", session),
    ]
    assert len(graph.ends) == 6
    assert all(it.type_hash.startswith("RIHS01_") for it in graph.ends)
    assert {it.qos.depth for it in graph.ends if it.qos} == {10}
    around = graph.environment
    assert (around.rmw, around.participants, around.caveats) == ("rmw_zenoh_cpp", 1, ())


def test_what_is_wrong_is_found(
    plan: Path, address: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with fleet(address, 3, ("robot1",)) as there:
        there.node(7, "/robot2", "drive")
        there.end(7, "/robot2", "drive", "MS", "/cmd_vel", STRING)
        assert check(plan, address, 3) == 1
    shown = capsys.readouterr().out
    assert "/robot2/drive: error: MG320 should subscribe to topic" in shown
    assert "it subscribes to /cmd_vel instead" in shown


def test_another_version_of_a_type_is_found_and_other_qos_is_none(
    plan: Path, address: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """In Zenoh the hash is a part of the key, and QoS keeps nobody from hearing."""
    with fleet(address, 4) as there:
        there.node(8, "/", "rviz2")
        best_effort, reliable = "2::,10:,:,:,,", "1::,10:,:,:,,"
        there.end(8, "/", "rviz2", "MP", "/robot1/cmd_vel", STRING, qos=best_effort)
        there.end(8, "/", "rviz2", "MS", "/robot1/odom", STRING, qos=reliable)
        assert check(plan, address, 4) == 0
        main(["check", "--from", address, "--domain", "4"])
        there.end(8, "/", "rviz2", "MS", "/robot2/odom", STRING, hash=TF_HASH)
        assert check(plan, address, 4) == 0
    shown = capsys.readouterr().out
    assert "MG307" not in shown
    assert "/rviz2: warning: MG306 uses another version of std_msgs/msg/String" in shown


def test_tf_is_heard_latched_and_not(address: str) -> None:
    with fleet(address, 5) as there:
        for topic, qos in (("/tf", "::,:,:,:,,"), ("/robot1/tf_static", ":1:,1:,:,:,,")):
            there.end(0, "/robot1", "drive", "MP", topic, TF_TYPE, hash=TF_HASH, qos=qos)
        static = there.sends("/robot1/tf_static", ("base", "laser"), ("base", "imu"), latched=True)
        with static, there.sends("/tf", ("odom", "base")):
            graph = seen(address, 5)
    found = {(it.topic, it.parent, it.child, it.static) for it in graph.edges}
    assert found == {
        ("/tf", "odom", "base", False),
        ("/robot1/tf_static", "base", "laser", True),
        ("/robot1/tf_static", "base", "imu", True),
    }
    assert {it.publishers for it in graph.edges} == {("/robot1/drive",)}
    assert not incomplete(graph)


def test_a_slow_sender_of_tf_is_waited_for(address: str) -> None:
    """Each publisher is told by its gid, so a fast one does not end the look for a slow one."""
    with fleet(address, 14) as there:
        for number, name in ((0, "robot1"), (1, "robot2")):
            there.end(number, f"/{name}", "drive", "MP", "/tf", TF_TYPE, hash=TF_HASH)
        fast = there.sends("/tf", ("odom", "base"), gid=b"1")
        with fast, there.sends("/tf", ("map", "odom"), gid=b"2", period=1.0):
            graph = seen(address, 14)
    assert {(it.parent, it.child) for it in graph.edges} == {("odom", "base"), ("map", "odom")}


@pytest.mark.deep
def test_tf_that_nobody_hears_is_said(address: str) -> None:
    with fleet(address, 6) as there:
        there.end(0, "/robot1", "drive", "MP", "/tf", TF_TYPE, hash=TF_HASH)
        graph = seen(address, 6)
        assert [it.code for it in incomplete(graph)] == ["frames-not-heard"]


def test_a_token_of_another_kind_is_left_out_and_named(address: str) -> None:
    with fleet(address, 7) as there:
        there.hold(f"@ros2_lv/7/{there.session.zid()}/0/99/XX/%/%robot1/drive")
        graph = seen(address, 7)
    (caveat,) = graph.environment.caveats
    assert (caveat.code, caveat.incomplete) == ("strange-token", False)
    assert "/XX/" in caveat.message
    assert len(graph.nodes) == 2


def test_another_domain_is_named(
    plan: Path, address: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with fleet(address, 8):
        assert check(plan, address, 9) == 3
    assert "knows no node of domain 9; it has nodes of domain 8" in capsys.readouterr().err


def test_a_missing_router_is_inconclusive(plan: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Not "the robots are missing": nobody was asked."""
    command = ["check", str(plan), "--from", NOWHERE, "--timeout", "0.3"]
    assert main(command) == 3
    shown = capsys.readouterr()
    assert f"no Zenoh router answers at {NOWHERE}" in shown.err
    assert "error:" not in shown.out
    assert main(["snapshot", "--from", NOWHERE, "--timeout", "0.3"]) == 3


def test_expected_nodes_are_waited_for(address: str) -> None:
    with fleet(address, 10):
        graph = seen(address, 10, expected=("/robot1/drive",))
        assert graph.environment.settled == "expected"
        late = look(Request(0.2, ("/robot3/drive",)), Router(address, 10))
    assert (late.environment.settled, codes(late)) == ("timeout", {"expected-not-seen"})


def test_watching_shows_what_comes_and_goes(address: str) -> None:
    graphs = watched(address, 11)
    try:
        with fleet(address, 11, ("robot1",)) as there:
            first = next(it for it in graphs if it.nodes)
            drive(there, "robot2", 1)
            both = next(it for it in graphs if len(it.nodes) == 2)
            there.end(0, "/robot1", "drive", "MP", "/tf", TF_TYPE, hash=TF_HASH)
            with there.sends("/tf", ("odom", "base")):
                moving = next(it for it in graphs if it.edges)
        gone = next(it for it in graphs if not it.nodes)
    finally:
        graphs.close()
    assert [it.name for it in first.nodes] == ["/robot1/drive"]
    assert len(both.ends) >= 3
    assert [(it.parent, it.child) for it in moving.edges] == [("odom", "base")]
    assert not gone.edges and "no-router" not in codes(gone)


def test_several_domains_are_watched_side_by_side(
    address: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """What leaves one of them is told with its number, and the other is still there."""
    with fleet(address, 16, ("robot1",)):
        changes = watch(Request(20.0), {it: Router(address, it) for it in (16, 17)})
        with fleet(address, 17, ("robot2",)):
            nodes = {at: it.nodes for at, it in islice(changes, 2)}
            words = ["check", "--watch", "--from", address, "--domain", "16,17"]
            assert main([*words, "--timeout", "1"]) == 0
        gone = next(it for it in changes if not it[1].nodes)
        changes.close()
    assert [it.name for own in nodes.values() for it in own] == ["/robot1/drive", "/robot2/drive"]
    assert (*nodes, gone[0]) == (16, 17, 17)
    assert "2 robots, 1 node each; " in capsys.readouterr().out


def test_a_router_that_ends_is_no_robot_that_left() -> None:
    with router() as address, fleet(address, 12):
        graphs = watched(address, 12)
        next(it for it in graphs if it.environment.settled != CHANGING and len(it.nodes) == 2)
    lost = next(it for it in graphs if "no-router" in codes(it))
    graphs.close()
    assert incomplete(lost)


def test_a_session_configuration_is_a_router(tmp_path: Path, address: str) -> None:
    file = tmp_path / "session.json5"
    file.write_text(f"// as a robot has it\n{{ connect: {{ endpoints: ['{address}'] }} }}\n")
    with fleet(address, 13):
        assert len(seen(str(file), 13).nodes) == 2
    file.write_text("{ connect: 3 }")
    with pytest.raises(InputError, match=r"session\.json5: no session configuration of Zenoh"):
        seen(str(file), 13)


@pytest.mark.deep
def test_a_graph_that_goes_on_changing_is_shown_as_changing(address: str) -> None:
    with fleet(address, 15) as there:
        graphs = watched(address, 15)
        next(graphs)
        stop = threading.Event()

        def change() -> None:
            number = 100
            while not stop.wait(0.02):
                there.node(number, "/", f"node{number}")
                number += 1

        thread = threading.Thread(target=change)
        thread.start()
        changing = next(it for it in graphs if it.environment.settled == CHANGING)
        stop.set()
        thread.join()
        quiet = next(it for it in graphs if it.environment.settled != CHANGING)
        graphs.close()
    assert len(quiet.nodes) >= len(changing.nodes) > 2
