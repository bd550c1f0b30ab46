# SPDX-License-Identifier: Apache-2.0
"""Results and errors are copied and pickled, and read in another process."""

from __future__ import annotations

import copy
import pickle
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from public_calls import DOUBTFUL, FLEET, PARAMS, ROVER, SMALL, TWICE

from multibot_rewrite import (
    InputError,
    LoadedFleet,
    MultibotError,
    RewriteRefused,
    UsageError,
    explain,
    load_fleet,
    rewrite,
    rewrite_all,
)
from multibot_rewrite.fleet.robots.node_names import NodeNames


@pytest.fixture
def fleet(tmp_path: Path) -> LoadedFleet:
    (tmp_path / "rover.urdf").write_bytes(ROVER.read_bytes())
    (tmp_path / "params.yaml").write_text(PARAMS)
    (tmp_path / "fleet.yaml").write_text(FLEET)
    return load_fleet(tmp_path / "fleet.yaml")


COPIES: list[Callable[[Any], Any]] = [
    copy.copy,
    copy.deepcopy,
    lambda it: pickle.loads(pickle.dumps(it)),
    lambda it: pickle.loads(pickle.dumps(it, protocol=pickle.HIGHEST_PROTOCOL)),
]
COPY_IDS = ["copy", "deepcopy", "pickle", "newest"]


@pytest.mark.sample(1)
@pytest.mark.parametrize("again", COPIES, ids=COPY_IDS)
@pytest.mark.parametrize("source", [SMALL, DOUBTFUL, ROVER], ids=["small", "finding", "rover"])
def test_a_rewrite_can_be_copied(again: Callable[[Any], Any], source: str | Path) -> None:
    first = rewrite(source, "r1", layout="both", separators={"link": "_"})
    other = again(first)
    assert other == first
    assert hash(other) == hash(first)
    assert (other.text, other.findings) == (first.text, first.findings)
    assert other.changes == first.changes != []
    assert other != rewrite(source, "r2", layout="both", separators={"link": "_"})
    assert other.prepared == first.prepared != rewrite(source, "r1").prepared
    assert first.prepared != source


def test_an_srdf_is_copied_with_its_urdf() -> None:
    srdf = '<robot name="rover"><disable_collisions link1="base" link2="base" reason="x"/></robot>'
    first = rewrite(srdf, "r1", urdf=SMALL)
    assert pickle.loads(pickle.dumps(first)).changes == first.changes != []


def test_robots_of_one_pickle_share_what_they_were_made_from() -> None:
    one, two = pickle.loads(pickle.dumps(list(rewrite_all(ROVER, ["r1", "r2"]))))
    assert one.template is two.template


@pytest.mark.parametrize("again", COPIES, ids=COPY_IDS)
def test_explanations_can_be_copied(again: Callable[[Any], Any]) -> None:
    found = explain(ROVER, 8)
    assert found
    assert again(found) == found


@pytest.mark.parametrize("again", COPIES, ids=COPY_IDS)
@pytest.mark.parametrize(
    ("call", "error"),
    [
        (lambda: rewrite(TWICE, "r1"), RewriteRefused),
        (lambda: rewrite(SMALL, "r 1"), UsageError),
        (lambda: rewrite("<robot", "r1"), InputError),
    ],
)
def test_errors_can_be_copied(
    call: Callable[[], object], error: type[MultibotError], again: Callable[[Any], Any]
) -> None:
    with pytest.raises(error) as caught:
        call()
    other = again(caught.value)
    assert type(other) is error
    assert str(other) == str(caught.value) != ""
    assert getattr(other, "findings", None) == getattr(caught.value, "findings", None)


def seen(fleet: LoadedFleet) -> list[object]:
    """Return what a launch script reads of a fleet."""
    return [fleet.file, fleet.findings, *(of_robot for it in fleet.robots for of_robot in (
        it.name, it.model, it.namespace, it.tag, it.pose, it.description, it.srdf,
        it.frame("base_link"), it.topic("scan"), it.tf_remappings, it.spawn_arguments,
        it.transform_arguments, it.teleop_arguments, it.node("amcl", "params.yaml"),
    ))]  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("again", COPIES, ids=COPY_IDS)
def test_a_fleet_can_be_copied(again: Callable[[Any], Any], fleet: LoadedFleet) -> None:
    before = seen(fleet)
    other = again(fleet)
    assert other is not fleet
    assert seen(other) == before == seen(fleet)
    assert {path: it.data for path, it in other.files.items()} == {
        path: it.data for path, it in fleet.files.items()
    }


@pytest.mark.slow
@pytest.mark.parametrize("again", COPIES, ids=COPY_IDS)
def test_a_robot_of_a_fleet_can_be_copied(again: Callable[[Any], Any], fleet: LoadedFleet) -> None:
    robot, whole = again((fleet.robots[1], fleet))
    assert (robot.name, robot.description) == ("robot2", fleet.robots[1].description)
    assert robot is whole.robots[1]
    assert again(robot).node("amcl", "params.yaml") == robot.node("amcl", "params.yaml")


@pytest.mark.more
def test_the_descriptions_go_along_with_a_copy(fleet: LoadedFleet, tmp_path: Path) -> None:
    data, text = pickle.dumps(fleet), fleet.robots[0].description
    (tmp_path / "rover.urdf").unlink()
    (tmp_path / "fleet.yaml").unlink()
    assert pickle.loads(data).robots[0].description == text
    assert copy.deepcopy(fleet).robots[0].description == text


def test_the_names_of_nodes_can_be_copied(fleet: LoadedFleet) -> None:
    table: NodeNames = fleet.robots[0].table
    assert pickle.loads(pickle.dumps(table)) == table
    assert copy.deepcopy(table).for_node("amcl") == table.for_node("amcl")


FRESH = """\
import pickle, sys
one, refused, fleet = pickle.load(open(sys.argv[1], "rb"))
print(one.text, end="\\0")
print(len(one.changes), refused.findings[0].code, end="\\0")
print(fleet.robot("robot2").description, end="\\0")
print(fleet.robots[0].node("amcl", "params.yaml"), end="")
"""


@pytest.mark.slow
def test_a_fresh_process_reads_the_pickles(fleet: LoadedFleet, tmp_path: Path) -> None:
    one = rewrite(ROVER, "r1")
    with pytest.raises(RewriteRefused) as caught:
        rewrite(TWICE, "r1")
    file = tmp_path / "results.pickle"
    file.write_bytes(pickle.dumps((one, caught.value, fleet)))
    command = [sys.executable, "-c", FRESH, file]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    text, counts, description, node = done.stdout.split("\0")
    assert done.stderr == ""
    assert text == one.text
    assert counts == f"{len(one.changes)} MB201"
    assert description == fleet.robots[1].description
    assert node == str(fleet.robots[0].node("amcl", "params.yaml"))
