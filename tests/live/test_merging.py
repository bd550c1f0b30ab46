# SPDX-License-Identifier: Apache-2.0
"""Several looks at one system are joined: what any of them has seen is there, once."""

from __future__ import annotations

from itertools import permutations
from pathlib import Path

import pytest
from graph_cases import as_planned, environment, read_plan
from live_commands import write_plan
from looks import ONE, QOS, TWO, end, look, node
from plans import own

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.system.json import from_json, to_json
from multibot_rewrite.system.merging import Look, merged
from multibot_rewrite.system.records import Caveat, Edge, System


def join(*looks: System) -> System:
    return merged([Look(f"{name}.json", it) for name, it in zip("abcd", looks, strict=False)])


def test_a_node_whose_process_one_look_does_not_know_is_one_node() -> None:
    for first, second in permutations((look(node("robot1")), look(node("robot1", ONE)))):
        both = join(first, second)
        assert both.nodes == (node("robot1", ONE),)
        assert {it.process for it in both.ends} == {ONE}


def test_the_look_that_knows_more_of_an_endpoint_counts() -> None:
    plain = end("robot1", "/robot1/odom", ONE)
    full = plain._replace(qos=QOS, type_hash="RIHS01_ab")
    looks = (look(node("robot1", ONE), ends=(plain,)), look(node("robot1", ONE), ends=(full,)))
    for first, second in permutations(looks):
        assert join(first, second).ends == (full,)


def test_frames_are_joined_with_all_their_publishers() -> None:
    def heard(static: bool, *publishers: str) -> System:
        frame = Edge("base", "odom", "/tf", static, publishers)
        return look(node("robot1", ONE))._replace(edges=(frame,))

    (frame,) = join(heard(False, "/robot1/drive"), heard(True, "/robot2/drive")).edges
    assert frame == Edge("base", "odom", "/tf", True, ("/robot1/drive", "/robot2/drive"))


def test_what_was_around_the_looks_is_that_of_all() -> None:
    one = {"range": "SUBNET", "static_peers": ("a", "b"), "rmw": "rmw_fastrtps_cpp", "seconds": 9.0}
    two = {"range": "LOCALHOST", "static_peers": ("b", "c"), "rmw": "rmw_cyclonedds_cpp"}
    looks = (look(**one, super_client=True), look(**two, discovery_server="s", settled="timeout"))
    for both in (join(*looks).environment, join(*looks, looks[0]).environment):
        assert both._replace(caveats=()) == environment()._replace(
            range="SUBNET, LOCALHOST",
            static_peers=("a", "b", "c"),
            rmw="rmw_fastrtps_cpp, rmw_cyclonedds_cpp",
            discovery_server="s",
            super_client=False,
            participants=0,
            settled="timeout",
            seconds=9.0,
        )


def test_two_domains_are_refused() -> None:
    with pytest.raises(UsageError, match=r"a\.json is of domain 0, b\.json of 7"):
        join(look(node("robot1")), look(node("robot2"), domain=7))


def test_zenoh_and_dds_are_refused() -> None:
    with pytest.raises(UsageError, match="their nodes never see each other"):
        join(look(node("robot1")), look(node("robot2"), rmw="rmw_zenoh_cpp"))


def test_what_one_look_doubts_stays_in_doubt_with_its_file() -> None:
    unsettled = Caveat("not-settled", True, "still changing")
    both = join(look(node("robot1", ONE)), look(node("robot2", TWO), caveats=(unsettled,)))
    assert Caveat("not-settled", True, "b.json: still changing") in both.environment.caveats
    assert both.environment.caveats[0].message == "made of 2 snapshots: a.json, b.json"


def test_what_another_look_has_seen_is_no_doubt_any_more() -> None:
    bare = Caveat("nodes-without-endpoints", True, "nodes without any endpoint: /robot1/drive")
    blind = System((node("robot1"),), (), (), environment(bare))
    both = join(blind, look(node("robot1", ONE)))
    assert not any(it.incomplete for it in both.environment.caveats)


def test_the_command_joins_and_check_takes_all(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A healthy fleet cut in two by its network: each half alone lacks a robot, both are whole."""
    monkeypatch.chdir(Path(__file__).parents[2])
    plan = read_plan("frames-per-robot")
    whole = as_planned(plan)
    files = []
    for robot in plan.robots:
        mine = set(own(plan, robot.name))
        half = whole._replace(
            nodes=tuple(it for it in whole.nodes if it.name in mine),
            ends=tuple(it for it in whole.ends if it.node in mine),
            edges=tuple(it for it in whole.edges if mine.intersection(it.publishers)),
        )
        files.append(tmp_path / f"{robot.name}.json")
        files[-1].write_bytes(to_json(half))
    file = "fixtures/graphs/plan.yaml"
    assert main(["check", file, "--from", str(files[0])]) == 1
    assert "MG109" in capsys.readouterr().out
    twice = [word for it in files for word in ("--from", str(it))]
    assert main(["check", file, *twice]) == 0
    target = tmp_path / "all.json"
    assert (
        main(
            [
                "snapshot",
                *(it for path in files for it in ("--from", str(path))),
                "-o",
                str(target),
            ]
        )
        == 0
    )
    assert main(["check", file, "--from", str(target)]) == 0
    joined = from_json(target.read_bytes(), "all.json")
    assert len(joined.nodes) == len(whole.nodes)
    assert len(joined.ends) == len(whole.ends)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["snapshot", "--from", "gone.json"], "gone.json"),
        (["snapshot", "--from", "a.json", "--expect", "/x"], "leave out --from"),
        (["snapshot", "--from", "a.json", "-o", "a.json"], "a.json is a file that is read"),
        (["snapshot", "--from", "a.json", "--from", "tcp/h:1"], "two sources"),
        (["check", "plan.yaml", "--from", "a.json", "--from", "tcp/h:1"], "two sources"),
        (["snapshot", "--from", "h:7447"], "write PROTOCOL/HOST:PORT"),
        (["snapshot", "--from", ""], "the name is empty"),
        (["snapshot", "--from", "tcp/h"], "write PROTOCOL/HOST:PORT"),
        (
            ["snapshot", "--output-kind", "nodes", "--from", "a.json", "--from", "tcp/h:1"],
            "two sources",
        ),
    ],
)
def test_wrong_use_is_one_line(
    arguments: list[str],
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("a.json").write_bytes(to_json(look(node("robot1"))))
    write_plan(Path("plan.yaml"), ("robot1",))
    try:
        code = main(arguments)
    except SystemExit as ended:
        code = int(str(ended.code))
    shown = capsys.readouterr().err
    assert (code, len(shown.splitlines())) == (2, 1)
    assert said in shown
