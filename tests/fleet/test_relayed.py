# SPDX-License-Identifier: Apache-2.0
"""``relayed``: each robot's tf on /tf as well, as nodes of the plan.

Expected are the parameters of topic_tools relay_node.cpp (input_topic, output_topic) and one node of
each topic for each robot; and what tf_namespace_bridge.cpp does: it subscribes to tf and tf_static in
its namespace, publishes on /tf and /tf_static, and puts ``robot1/`` before both frames.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from graph_cases import as_planned, sent
from paths import ROBOTS
from plans import own

from multibot_rewrite import UsageError, compare, load_fleet
from multibot_rewrite.base.findings.finding import NOTE
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.fleet import expected
from multibot_rewrite.library.loaded_fleet import LoadedFleet
from multibot_rewrite.planning.bridged_topics import TF_TYPE
from multibot_rewrite.system.records import PUBLISHES, TOPIC, End, System

RVIZ = "Visualization Manager:\n  Displays: []\n  Global Options: {Fixed Frame: map}\n"

DISPLAYS = """\
Displays:
    - {Class: rviz_default_plugins/RobotModel, Name: models, TF Prefix: ''}
    - {Class: rviz_default_plugins/LaserScan, Name: scan, Topic: {Value: /scan}}"""


def fleet(folder: Path, layout: str) -> LoadedFleet:
    (folder / "one.rviz").write_text(RVIZ)
    text = (
        f"layout: {layout}\nrelayed: true\nnode_sets: robot_state_publisher\n"
        "robots:\n"
        f"  - {{name: robot1, description: {ROBOTS / 'rover.urdf'}}}\n"
        f"  - {{name: robot2, description: {ROBOTS / 'rover.urdf'}}}\n"
        "related_files: {rviz: one.rviz}\n"
    )
    (folder / "fleet.yaml").write_text(text)
    return load_fleet(folder / "fleet.yaml")


def relayed(plan: System) -> System:
    """Return the graph as planned, with what the relays send."""
    graph = as_planned(plan)
    copies = (it._replace(topic="/tf_static" if it.static else "/tf") for it in graph.edges)
    return sent(graph._replace(edges=(*graph.edges, *copies)))


@pytest.mark.parametrize("layout", ["both", "postfix", "tf-per-robot"])
def test_what_relays_send_is_no_gap_of_their_robot(tmp_path: Path, layout: str) -> None:
    assert "MG405" not in {it.code for it in fleet(tmp_path, layout).made.findings}


@pytest.mark.parametrize("layout", ["both", "postfix"])
def test_a_relayed_graph_is_as_planned_and_a_leak_is_none(tmp_path: Path, layout: str) -> None:
    plan = expected(fleet(tmp_path, layout).plan.fleet)
    graph = relayed(plan)
    assert [it for it in compare(plan, graph) if it.level != NOTE] == []
    state = next(it for it in own(plan, plan.robots[0].name) if "robot_state" in it)
    leak = End(TOPIC, PUBLISHES, "/tf", TF_TYPE, "", state, None, "")
    spoiled = sent(graph._replace(ends=(*graph.ends, leak)))
    assert {"MG405"} <= {it.code for it in compare(plan, spoiled)}


@pytest.mark.more
def test_the_build_starts_them_and_opens_one_window(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    fleet(tmp_path, "both")
    out = tmp_path / "out"
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(out), "-q"]) == 0
    assert "MF203" not in capsys.readouterr().err
    commands = (out / "commands.md").read_text()
    own = "-r __ns:=/robot1 -r __node:=tf_static_relay -p input_topic:=/robot1/tf_static"
    assert f"ros2 run topic_tools relay --ros-args {own} -p output_topic:=/tf_static\n" in commands
    assert commands.count("rviz2 -d") == 1
    assert (out / "one.rviz").exists()


@pytest.mark.parametrize("layout", ["both", "postfix"])
def test_simulated_time_without_a_clock_is_refused_beside_relays(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], layout: str
) -> None:
    fleet(tmp_path, layout)
    with (tmp_path / "fleet.yaml").open("a") as file:
        file.write("use_sim_time: true\nsimulator: none\n")
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "out")]) == 1
    assert "MG501" in capsys.readouterr().err


def test_a_layout_that_has_nothing_to_relay_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="has one /tf for all robots; remove relayed"):
        fleet(tmp_path, "frames-per-robot")


def test_the_bridge_reads_tf_in_its_namespace_only(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="remove topics, or take layout both"):
        fleet(tmp_path, "tf-per-robot\ntopics: postfix")


@pytest.mark.more
def test_the_build_bridges_them_and_opens_one_window_for_all(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    fleet(tmp_path, "tf-per-robot")
    (tmp_path / "one.rviz").write_text(RVIZ.replace("Displays: []", DISPLAYS))
    out = tmp_path / "out"
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(out), "-q"]) == 0
    said = capsys.readouterr().err
    assert "one.rviz:4:7: warning: MF216 the window for all robots shows nothing of scan" in said
    commands = (out / "commands.md").read_text()
    own = "-r __ns:=/robot1 -r __node:=tf_namespace_bridge"
    assert f"ros2 run tf_namespace_bridge tf_namespace_bridge --ros-args {own}\n" in commands
    assert commands.count("rviz2 -d") == 3
    # RViz puts TF Prefix and a slash before each link (rviz_default_plugins tf_link_updater.cpp).
    shown = (out / "one.rviz").read_text()
    assert "TF Prefix: 'robot1'" in shown and "Fixed Frame: map" in shown
    assert "TF Prefix: ''" in (out / "robot1" / "one.rviz").read_text()
