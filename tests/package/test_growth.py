# SPDX-License-Identifier: Apache-2.0
"""What a description is large in, it may be large in: twice as much costs twice as much."""

from __future__ import annotations

import fnmatch
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from counted_steps import growth, steps
from fleet_folder import fleet_folder
from graph_cases import GRAPHS as SAVED
from graph_examples import read_example, read_looks, read_system
from growing import GROWING, description
from growing_files import FLEETS, GRAPHS, LAUNCHED, copies, graph_of, launch_file, message, written
from launched_here import read_here
from made_bags import TEXT, Made, write
from paths import ROOT
from rosbags.rosbag2 import Reader

from multibot_rewrite import MultibotError, load_fleet, rewrite, rewrite_file
from multibot_rewrite.base import nearest
from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.grouping import chain_ends
from multibot_rewrite.base.nearest import HINTED, Guesses
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.description.checks import audit, references
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.lint.check import lint_data
from multibot_rewrite.producers.bags.read import _recording
from multibot_rewrite.producers.evidence import parameter_files
from multibot_rewrite.producers.launch import bridges, handed_on
from multibot_rewrite.producers.snapshot_file import read_snapshot
from multibot_rewrite.rules.check import RULES, check, judge
from multibot_rewrite.rules.settings import Settings
from multibot_rewrite.rules.system import causes

SMALL, LARGE = 100, 400
REMEMBERED = (
    nearest._cached_nearest,
    causes.letters,
    parameter_files._sections,
    handed_on.document_of,
    handed_on.has_sections,
    bridges.rows_of_text,
    fnmatch._compile_pattern,  # type: ignore[attr-defined]
)
# As much may be made once, and found again by halving.
SLACK = 1.15
MANY = """
layout: tf-per-robot
distro: jazzy
node_sets: nav2
description: {}
robots: [{}]
"""
ONE_LAYOUT = """
layout: frames-per-robot
distro: jazzy
simulator: none
description: robot.urdf
robots: [{name: robot1}, {name: robot2}]
"""


def forget() -> None:
    """Clear the caches: what was remembered before would make the small one cheaper alone."""
    re.purge()
    for remembered in REMEMBERED:
        remembered.cache_clear()


def rewritten(data: bytes) -> None:
    try:
        rewrite(data, "robot1")
    except MultibotError:
        # What is refused is read as far as that.
        return


def linted(data: bytes) -> None:
    lint_data("robot.urdf", data, Settings())


@pytest.mark.sample(6)
@pytest.mark.slow
@pytest.mark.parametrize("work", [rewritten, linted])
@pytest.mark.parametrize("what", GROWING)
def test_cost_grows_with_the_number(what: str, work: Callable[[bytes], None]) -> None:
    def prepared(count: int) -> Callable[[], None]:
        data = description(what, count)
        forget()
        return lambda: work(data)

    assert growth(prepared, SMALL, LARGE) < SLACK


@pytest.mark.slow
def test_cost_of_a_fleet_grows_with_the_links_in_a_chain(tmp_path: Path) -> None:
    """The tree of each robot was looked through once for each of its joints."""

    def prepared(count: int) -> Callable[[], object]:
        urdf = description("links in a chain", count).decode()
        path = fleet_folder(tmp_path, ONE_LAYOUT, robot__urdf=urdf)
        command = ["build", str(path), "-o", str(tmp_path / "out"), "--quiet"]
        return lambda: main(command)

    assert prepared(SMALL)() == 0
    assert growth(prepared, SMALL, LARGE) < SLACK


@pytest.mark.slow
@pytest.mark.sample(2)
@pytest.mark.parametrize(("name", "bound"), [("robot{}", 1.015), ("robot_{}", 1.06)])
def test_each_further_robot_costs_the_same(name: str, bound: float, tmp_path: Path) -> None:
    """The nodes, topics and bridges of all robots were looked through once for each of them. Of names
    within each other (robot and robot_1) all robots are read back, and some names are compared."""
    rover = ROOT / "examples" / "launch_tutorial" / "rover.urdf"

    def cost(count: int) -> int:
        folder = tmp_path / str(count)
        folder.mkdir()
        names = [name.format(at) for at in range(1, count)]
        rows = ", ".join(
            f"{{name: {it}, pose: {{y: {at}}}}}" for at, it in enumerate(["robot", *names])
        )
        path = fleet_folder(folder, MANY.format(rover, rows))
        return steps(lambda: main(["build", str(path), "-o", str(tmp_path / "out"), "--quiet"]))

    cost(4)
    few, more, most = map(cost, (10, 20, 30))
    assert (most - more) / (more - few) < bound


@pytest.mark.parametrize("turned", [False, True])
def test_what_chains_end_at_costs_a_step_for_each_name(turned: bool) -> None:
    def prepared(count: int) -> Callable[[], object]:
        pairs = [(f"l{at}", f"l{at + 1}") for at in range(count)]
        chain = dict(pairs[::-1] if turned else pairs)
        return lambda: chain_ends(chain)

    assert growth(prepared, SMALL, LARGE) < SLACK


def test_what_chains_end_at() -> None:
    tree = {"b": "a", "d": "c", "c": "b", "x": "y"}
    assert chain_ends(tree) == {"b": "a", "c": "a", "d": "a", "x": "y"}
    circle = {"a": "b", "b": "c", "c": "b", "d": "a", "e": "f"}
    assert chain_ends(circle) == {"a": "", "b": "", "c": "", "d": "", "e": "f"}
    assert chain_ends({"a": "a"}) == {"a": ""}


@pytest.mark.slow
def test_cost_grows_with_the_number_of_sections() -> None:
    """Of a parameter file: each node once looked through the sections of all others."""

    def prepared(count: int) -> Callable[[], None]:
        nodes = (f"n{at}:\n  ros__parameters:\n    frame_id: f{at}\n" for at in range(count))
        data = "".join(nodes).encode()
        return lambda: lint_data("params.yaml", data, Settings()) and None

    assert growth(prepared, SMALL, 2 * LARGE) < SLACK


RELATED = {
    "bridge.yaml": (
        "",
        "- {ros_topic_name: s#, gz_topic_name: s#, ros_type_name: sensor_msgs/msg/LaserScan,"
        " gz_type_name: gz.msgs.LaserScan, direction: GZ_TO_ROS}\n",
        "",
    ),
    "params.yaml": ("", "n#:\n  ros__parameters:\n    topic: s#\n", ""),
    "a.rviz": (
        "Visualization Manager:\n  Displays:\n",
        "    - {Class: rviz_default_plugins/LaserScan, Name: d#, Topic: {Value: /s#}}\n",
        "",
    ),
    "tree.xml": (
        '<root BTCPP_format="4"><BehaviorTree ID="M"><Sequence>',
        '<Spin spin_dist="1.57" server_name="spin#"/>\n',
        "</Sequence></BehaviorTree></root>",
    ),
    "arm.srdf": (
        '<robot name="a">',
        '<disable_collisions link1="l#" link2="m#" reason="Never"/>\n',
        "</robot>",
    ),
}


def related(name: str, count: int) -> str:
    before, each, after = RELATED[name]
    return before + "".join(each.replace("#", str(at)) for at in range(count)) + after


@pytest.mark.slow
@pytest.mark.parametrize("name", RELATED)
def test_linting_a_related_file_costs_what_is_in_it(name: str) -> None:
    def prepared(count: int) -> Callable[[], None]:
        data = related(name, count).encode()
        return lambda: lint_data(name, data, Settings()) and None

    assert growth(prepared, SMALL, LARGE) < SLACK


@pytest.mark.slow
@pytest.mark.parametrize("name", [it for it in RELATED if it != "arm.srdf"])
def test_rewriting_a_related_file_costs_what_is_in_it(name: str, tmp_path: Path) -> None:
    def prepared(count: int) -> Callable[[], object]:
        path = tmp_path / str(count) / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(related(name, count))
        return lambda: rewrite_file(str(path), "robot1")

    assert growth(prepared, SMALL, LARGE) < SLACK


@pytest.mark.slow
def test_a_fleet_costs_what_its_robots_do(tmp_path: Path) -> None:
    (tmp_path / "rover.urdf").write_bytes(description("links in a chain", 5))

    def prepared(count: int) -> Callable[[], object]:
        path = tmp_path / f"{count}.yaml"
        robots = (f"  - {{name: robot{at}, description: rover.urdf}}\n" for at in range(count))
        path.write_text(f"node_sets: nav2\nrobots:\n{''.join(robots)}")
        return lambda: load_fleet(str(path))

    assert growth(prepared, 10, 40) < SLACK


def test_the_format_of_a_root_is_asked_for_once(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[object] = []
    ask = Tree.format_of

    def noted(*words: object) -> str:
        asked.append(words)
        return ask(*words)  # type: ignore[arg-type]

    monkeypatch.setattr(Tree, "format_of", noted)
    rewritten(description("mentions", 3))
    few = len(asked)
    rewritten(description("mentions", 99))
    assert len(asked) == 2 * few


@pytest.mark.parametrize(
    ("what", "module"), [("unknown plugins", audit), ("undeclared references", references)]
)
def test_only_the_first_unknown_names_are_compared(
    what: str, module: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    looked: list[str] = []
    monkeypatch.setattr(
        "multibot_rewrite.base.nearest.nearest", lambda name, *_: looked.append(name) or ""
    )
    rewritten(description(what, 3 * HINTED))
    assert len(looked) == HINTED


def test_a_name_is_compared_once_and_among_so_many() -> None:
    guesses = Guesses()
    assert guesses.hint("basse", ["base"]) == "did you mean 'base'?"
    assert guesses.hint("basse", []) == "did you mean 'base'?"
    assert guesses.nearest("z9", (f"z{at}" for at in range(10**9, 10**9 + 10**6))) == ""


@pytest.mark.parametrize("text", ["a\nbé\n😀x\n", "x" * 9_000 + "é" * 9_000 + "\nab", "\r\n\n", ""])
def test_lines_and_columns_count_as_a_person_does(text: str) -> None:
    source = text.encode()
    for at in [*range(min(len(text), 40)), len(text) // 2, len(text) - 1, len(text)]:
        before = text[: max(at, 0)]
        there = before.count("\n") + 1, len(before.rpartition("\n")[2]) + 1
        assert locate(source, len(before.encode())) == there


@pytest.mark.parametrize("ends", ["\n", " "])
def test_a_place_is_found_from_the_block_it_is_in(
    ends: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    read: list[int] = []
    count = "multibot_rewrite.base.findings.finding._count_characters"
    monkeypatch.setattr(count, lambda text: read.append(len(text)) or len(text))
    source = (("x" * 40 + ends) * 20_000).encode()
    locate(source, 0)
    read.clear()
    for at in range(0, len(source), 1_000):
        locate(source, at)
    assert max(read) <= 4096


def done(words: list[str]) -> None:
    """Run a command that reads what it is given, whatever it finds."""
    assert main(words) in (0, 1, 3)


@pytest.mark.sample(8)
@pytest.mark.slow
@pytest.mark.parametrize("what", LAUNCHED)
def test_checking_a_launch_file_costs_what_is_in_it(
    what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    read_here(monkeypatch, tmp_path)

    def prepared(count: int) -> Callable[[], None]:
        files = LAUNCHED[what](count)
        path = written(tmp_path / f"of_{count}", files) / launch_file(files)
        forget()
        return lambda: done(["check-launch", str(path), "--distro", "jazzy"])

    assert growth(prepared, SMALL // 2, LARGE // 2) < SLACK


@pytest.mark.sample(4)
@pytest.mark.slow
@pytest.mark.parametrize("plan", [[], [str(ROOT / SAVED / "plan.yaml")]], ids=["alone", "planned"])
@pytest.mark.parametrize("what", GRAPHS)
def test_checking_a_graph_costs_what_is_in_it(what: str, plan: list[str], tmp_path: Path) -> None:
    def prepared(count: int) -> Callable[[], None]:
        path = graph_of(what, count, tmp_path)
        forget()
        return lambda: done(["check", *plan, "--from", str(path), "--distro", "jazzy"])

    assert growth(prepared, SMALL, LARGE) < SLACK


# Of many names without a robot each may be meant by each: they are held against one another.
COMPARED = {"MG329", "MG401", "MG418"}
OF_ROBOTS = sorted(
    (code, kind)
    for code, it in RULES.items()
    for kind in ("bad", "good")
    if code not in COMPARED and "robot" in getattr(it.page, kind)
)


@pytest.mark.sample(12)
@pytest.mark.slow
@pytest.mark.parametrize(("code", "kind"), OF_ROBOTS)
def test_what_is_wrong_with_each_robot_costs_what_the_robots_do(code: str, kind: str) -> None:
    """Each rule once looked at all robots for each of them."""
    example = getattr(RULES[code].page, kind)

    def prepared(count: int) -> Callable[[], object]:
        forget()
        text = copies(example, count)
        if "planned: " in text:
            pair = read_example(text)
            return lambda: check(*pair)
        if "as before: " in text:
            before, graph = read_looks(text)
            return lambda: check(before, graph, before=before)
        seen = read_system(text)
        return lambda: judge(seen)

    assert growth(prepared, 15, 60) < SLACK


@pytest.mark.sample(4)
@pytest.mark.slow
@pytest.mark.parametrize("what", FLEETS)
def test_building_a_fleet_costs_what_is_in_its_files(what: str, tmp_path: Path) -> None:
    def prepared(count: int) -> Callable[[], None]:
        files = {**FLEETS[what](count)}
        folder = tmp_path / str(count)
        folder.mkdir(exist_ok=True)
        path = fleet_folder(folder, files.pop("fleet"), **files)
        return lambda: done(["build", str(path), "-o", f"{folder}/out", "--quiet"])

    assert growth(prepared, 40, 160) < SLACK


@pytest.mark.slow
def test_reading_a_bag_costs_what_its_topics_do(tmp_path: Path) -> None:
    def prepared(count: int) -> Callable[[], object]:
        path = tmp_path / str(count)
        if not path.exists():
            write(path, [Made(f"/t{at}", TEXT, 1) for at in range(count)])

        def read() -> None:
            with Reader(path) as reader:
                assert len(_recording(reader).topics) == count

        return read

    assert growth(prepared, 10, 40) < SLACK


@pytest.mark.slow
def test_reading_a_message_of_a_graph_costs_what_is_in_it(tmp_path: Path) -> None:
    def prepared(count: int) -> Callable[[], object]:
        path = tmp_path / f"{count}.yaml"
        path.write_text(message(count))
        return lambda: read_snapshot(str(path))

    assert growth(prepared, SMALL, LARGE) < SLACK
