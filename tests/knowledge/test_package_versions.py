# SPDX-License-Identifier: Apache-2.0
"""Facts have the version of their package, a release maps to versions, and what was read has a day.

Versions and days: ros/rosdistro, and the changelogs of the packages on docs.ros.org.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.releases import CAME, RELEASES
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.cli.urdf_lint import main as main_lint
from multibot_rewrite.knowledge.conditions import chosen_type
from multibot_rewrite.knowledge.node_sets import built_in, every_release, older_node
from multibot_rewrite.knowledge.packages import by_version, number, older, packages, versions_of
from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, TOPIC, End, Node, System

TWIST = "geometry_msgs/msg/Twist"


@pytest.mark.parametrize(
    ("words", "releases"),
    [
        # 4.3.0 came with Jazzy, 4.4.0 with Kilted; Humble stayed at 4.3.0.
        ("twist_mux 4.4.0+", "jazzy 4.4.0+, kilted, lyrical, rolling"),
        ("humble, twist_mux 4.5.1+", "humble, lyrical, rolling"),
        ("teleop_twist_keyboard 2.4.0+", "humble 2.4.0+, jazzy, kilted, lyrical, rolling"),
        ("jazzy 1.3.9+, kilted+", "jazzy 1.3.9+, kilted+"),
    ],
)
def test_a_version_stands_for_the_releases_that_have_it(words: str, releases: str) -> None:
    assert by_version(words) == releases


def test_every_package_of_a_known_node_is_in_the_table() -> None:
    used = {it.package for it in every_release().nodes.values() if it.package}
    assert used <= packages().keys()
    for name, package in packages().items():
        assert package.versions.keys() <= {*RELEASES}, name
        for it in package.versions.values():
            assert it.commit or not it.date, name
            assert not it.first or number(it.first) <= number(it.now), name


@pytest.mark.parametrize(
    ("package", "release", "is_older"),
    [
        ("slam_toolbox", "humble", False),  # 2.6.10 read
        ("slam_toolbox", "lyrical", True),  # of 2025-06
        ("twist_mux", "lyrical", False),
        ("controller_manager", "jazzy", False),  # an earlier version, read after Jazzy came
        ("nav2_amcl", "lyrical", False),
        ("acme_driver", "lyrical", False),
    ],
)
def test_what_was_read_before_a_release_is_older(
    package: str, release: str, is_older: bool
) -> None:
    assert bool(older(package, release)) == is_older
    if is_older:
        assert versions_of(package)[release].date < CAME[release]


def test_a_node_is_as_old_as_its_package() -> None:
    said = "slam_toolbox 2.9.0 of 2025-06-09 was read, lyrical has 2.10.0"
    assert older_node("slam_toolbox", "lyrical") == said
    assert older_node("amcl", "lyrical") == older_node("", "lyrical") == ""
    assert older_node("slam_toolbox", "") == ""


@pytest.mark.parametrize(
    ("node", "name", "parameter", "value", "stamped"),
    [
        # twist_mux 4.4.0: "TwistStamped Support"; Humble's 4.3.0 reads no use_stamped.
        ("twist_mux", "cmd_vel_out", "use_stamped", None, "jazzy kilted lyrical rolling"),
        ("twist_mux", "cmd_vel_out", "use_stamped", True, "jazzy kilted lyrical rolling"),
        ("twist_mux", "cmd_vel_out", "use_stamped", False, ""),
        # key_teleop 1.8.0: "Default to TwistStamped"; Humble has 1.7.0.
        ("key_teleop", "key_vel", "twist_stamped_enabled", None, "jazzy kilted lyrical rolling"),
        ("key_teleop", "key_vel", "twist_stamped_enabled", True, " ".join(RELEASES)),
        # robot_localization 3.9.2: "Switching stamped control to default true".
        ("ekf_filter_node", "cmd_vel", "stamped_control", None, "kilted lyrical rolling"),
        ("ekf_filter_node", "cmd_vel", "stamped_control", True, " ".join(RELEASES)),
    ],
)
def test_stamped_by_version(
    node: str, name: str, parameter: str, value: object, stamped: str
) -> None:
    for release in RELEASES:
        (end,) = (it for it in built_in(release).nodes[node].endpoints if it.name == name)
        type_ = chosen_type(end.types, {parameter: value}.get) or end.type
        assert type_ == (f"{TWIST}Stamped" if release in stamped.split() else TWIST), release


def test_slam_of_several_robots_shares_its_scans() -> None:
    ends = {
        release: {it.name: it for it in built_in(release).nodes["slam_toolbox"].endpoints}
        for release in ("kilted", "lyrical")
    }
    assert "/localized_scan" not in ends["kilted"]
    assert ends["lyrical"]["/localized_scan"].when == (
        "program: decentralized_multirobot_slam_toolbox_node and version: slam_toolbox 2.10.0"
    )


def test_inspect_shows_versions_and_days(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", "slam_toolbox", "--distro", "lyrical"]) == 0
    lines = [" ".join(it.split()) for it in capsys.readouterr().out.splitlines()]
    assert "lyrical 2.10.0 b4d30ce 2.9.0 2025-06-09 older than the release" in lines
    assert not any("humble" in it for it in lines)
    assert main(["inspect", "twist_mux", "--output-kind", "json"]) == 0
    (node,) = json.loads(capsys.readouterr().out)["nodes"]
    assert node["versions"]["humble"]["now"] == "4.3.0"
    assert main(["inspect", "twist_mux"]) == 0
    assert "TwistStamped if use_stamped is not false" in capsys.readouterr().out


@pytest.mark.parametrize(("release", "level"), [("humble", ERROR), ("lyrical", NOTE)])
def test_what_hangs_on_an_older_source_is_a_note(release: Any, level: str) -> None:
    def end(role: str, node: str, type_: str) -> End:
        return End(TOPIC, role, "/map", type_, node=node)

    system = System(
        (Node("/slam_toolbox", known="slam_toolbox"), Node("/own")),
        (end(PUBLISHES, "/slam_toolbox", "nav_msgs/msg/OccupancyGrid"),
         end(SUBSCRIBES, "/own", "nav_msgs/msg/Path")),
        release=release,
    )  # fmt: skip
    (found,) = (it for it in diagnose(system).findings if it.code == "MG306")
    assert found.level == level
    assert ("slam_toolbox 2.9.0 of 2025-06-09 was read" in found.hint) == (level == NOTE)


@pytest.mark.parametrize(("release", "level"), [("humble", WARNING), ("lyrical", NOTE)])
def test_a_parameter_that_an_older_source_lacks_is_a_note(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], release: str, level: str
) -> None:
    path = tmp_path / "slam.yaml"
    path.write_text("slam_toolbox:\n  ros__parameters:\n    minimum_travel_distanc: 0.5\n")
    assert main_lint([str(path), "--distro", release, "--format", "json"]) in (0, 1)
    found = json.loads(capsys.readouterr().out)["findings"]
    assert [it["level"] for it in found if "minimum_tra" in it["message"]] == [level]
