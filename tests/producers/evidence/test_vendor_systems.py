# SPDX-License-Identifier: Apache-2.0
"""Vendors' robots as their launch files start them: no node of the plan is wrong, and no finding false.

With MULTIBOT_SOURCES=FOLDER, which holds the checkouts that ``tests/support/vendors/*.yaml`` names, and
with launch and launch_ros; skipped without. The rest are tests of the judge.
"""

from __future__ import annotations

import pytest
from vendor_health import findings, kind_of, two
from vendor_sources import VARIABLE, WITHOUT, sources_folder
from vendor_systems import (
    Started,
    filled,
    missing,
    nodes_of,
    outcome,
    read_vendors,
    started_by,
    wrong,
)

from multibot_rewrite.launch import missing as without_launch

VENDORS = read_vendors()


@pytest.mark.deep
@pytest.mark.parametrize("name", [it for it in VENDORS.systems if "named" in VENDORS.systems[it]])
def test_a_vendors_system_is_as_planned(name: str) -> None:
    folder, system = sources_folder(), VENDORS.systems[name]
    if folder is None or without_launch():
        pytest.skip(without_launch() or WITHOUT)
    if missing(system, folder):
        pytest.skip(f"{VARIABLE} lacks {', '.join(missing(system, folder))}")
    found = outcome(name, VENDORS, folder)
    named = [len(nodes_of(it).keys() & found.started.keys()) for it in (found.own, found.launched)]
    assert named == system["named"]
    assert [wrong(it, found.started) for it in (found.own, found.launched)] == [[], []]
    said = findings(found, system["release"], system.get("kinds", {}))
    assert [f"{it.code} {it.node}: {it.message}" for it in said] == []


def row(program: str, name: str = "", *own: str) -> dict[str, object]:
    package, executable = program.split("/")
    here = {"name": name, "namespace": "/robot1", "rules": [["/tf", "tf"]], "own": own}
    return {"package": package, "executable": executable, **here}


def test_a_program_has_the_nodes_of_its_code() -> None:
    named = {"acme/driver": {"nodes": ["driver", "driver/map"], "source": "acme src/driver.cpp:3"}}
    found = list(started_by(row("acme/driver"), named))
    assert [it.name for it in found] == ["/robot1/driver", "/robot1/driver/map"]
    assert found[0].rules == (("/tf", "tf"),)
    (other,) = started_by(row("acme/other", "front"), named)
    assert other.name == "/robot1/front"
    with pytest.raises(SystemExit, match="acme/other has no name"):
        list(started_by(row("acme/other"), named))


def test_a_spawner_starts_its_controllers_and_no_node() -> None:
    words = ("a", "b", "-c", "manager", "--activate-as-group", "--param-file", "p.yaml")
    found = list(started_by(row("controller_manager/spawner", "", *words), {}))
    assert [it.name for it in found] == ["/robot1/a", "/robot1/b"]


def test_the_second_robot_is_started_as_the_first() -> None:
    one = Started("/robot1/driver", "acme/driver", (("scan", "/robot1/scan"),))
    both = list(two([one, Started("/rviz2", "rviz2/rviz2")]))
    assert [it.name for it in both] == ["/robot1/driver", "/robot2/driver", "/rviz2"]
    assert both[1].rules == (("scan", "/robot2/scan"),)


def test_the_sources_of_a_node_are_found_by_its_name_or_program() -> None:
    amcl = Started("/robot1/amcl", "nav2_amcl/nav2_amcl::AmclNode")
    assert kind_of(amcl, "amcl", "jazzy", {}) == "amcl"
    drive = Started("/robot1/drive", "controller_manager/spawner")
    assert kind_of(drive, "drive", "jazzy", {}) == ""
    assert kind_of(drive, "drive", "jazzy", {"drive": "diff_drive_controller"}) != ""
    assert kind_of(amcl, "amcl", "jazzy", {"amcl": "none"}) == ""


def test_words_are_filled_at_any_depth() -> None:
    found = filled({"a": ["{work}/x", {"{robot}": 1}]}, {"work": "/w", "robot": "r"})
    assert found == {"a": ["/w/x", {"r": 1}]}
