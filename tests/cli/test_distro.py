# SPDX-License-Identifier: Apache-2.0
"""``--distro`` of the commands about descriptions: the option, the configuration, or ROS_DISTRO."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite import system_of_description
from multibot_rewrite.cli import multibot, urdf_lint, urdf_postfix

MODEL = """<sdf version="1.12"><model name="rover" namespace="fleet"><link name="base"/>
<plugin filename="gz-sim-diff-drive-system" name="d"><topic>cmd_vel</topic></plugin></model></sdf>
"""
URDF = (
    '<robot name="r"><link name="base"/><gazebo>\n<model name="m" namespace="n"/></gazebo></robot>'
)


@pytest.fixture(autouse=True)
def folder(here: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    (here / "m.sdf").write_text(MODEL)
    (here / "m.urdf").write_text(URDF)
    return here


def test_a_release_that_is_not_known(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        urdf_postfix.main(["m.sdf", "robot1", "--distro", "jazy"])
    assert "did you mean 'jazzy'" in capsys.readouterr().err


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("config", "variable", "words", "found"),
    [
        ("", "", (), True),
        ("", "rolling", (), False),
        ('distro = "jazzy"', "rolling", (), True),
        ('distro = "rolling"', "", (), False),
        ('distro = "rolling"', "", ("--distro", "kilted"), True),
    ],
)
def test_the_lint_reads_option_configuration_and_variable(
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    config: str,
    variable: str,
    words: tuple[str, ...],
    found: bool,
) -> None:
    (folder / "urdf-lint.toml").write_text(config)
    if variable:
        monkeypatch.setenv("ROS_DISTRO", variable)
    urdf_lint.main(["m.urdf", "--select", "MB419", *words])
    assert ("MB419" in capsys.readouterr().out) == found


def test_a_configuration_names_a_release_that_is_known(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "urdf-lint.toml").write_text('distro = "noetic"')
    assert urdf_lint.main(["m.urdf"]) == 2
    assert "distro is 'noetic', use one of humble, " in capsys.readouterr().err


def test_a_definitions_is_checked_for_its_release(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "my.vocab").write_text("[element arm]\nat: nowhere\nreleases: humble\n")
    words = ["inspect", "robot", "--definitions", "my.vocab", "--distro"]
    assert multibot.main([*words, "humble"]) == 2
    assert "there is no [element nowhere]" in capsys.readouterr().err
    assert multibot.main([*words, "jazzy"]) == 0


CLASSIC = (
    '<robot name="r"><link name="base"><inertial><mass value="1"/>'
    '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link><gazebo>'
    '<plugin name="p" filename="libgazebo_ros_p3d.so"><body_name>base</body_name></plugin>'
    "</gazebo></robot>"
)


def test_a_rewrite_says_which_release_it_is_for_and_why(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "c.urdf").write_text(CLASSIC)
    urdf_postfix.main(["c.urdf", "robot1", "-o", "o.urdf"])
    assert "(ROS 2 humble: it loads libgazebo_ros_p3d.so)" in capsys.readouterr().err
    # ROS 1 alone has gazebo_ros_control (gazebo_ros_pkgs, branches noetic-devel and ros2).
    control = '<plugin name="q" filename="libgazebo_ros_control.so"/></gazebo>'
    (folder / "one.urdf").write_text(CLASSIC.replace("</gazebo>", control))
    urdf_postfix.main(["one.urdf", "robot1", "-o", "o.urdf"])
    assert "erified (ROS 1: " in capsys.readouterr().err
    monkeypatch.setenv("ROS_DISTRO", "noetic")
    assert urdf_postfix.main(["c.urdf", "robot1", "-o", "o.urdf"]) == 0
    said = capsys.readouterr().err
    assert "warning: ROS_DISTRO is 'noetic', which is not known" in said
    assert "(ROS 2 humble: it loads" in said
    assert urdf_postfix.main(["o.urdf", "robot1", "--undo", "-o", "back.urdf"]) == 0
    assert (folder / "back.urdf").read_text() == CLASSIC
    monkeypatch.setenv("ROS_DISTRO", "iron")
    urdf_postfix.main(["c.urdf", "robot1", "-o", "o.urdf"])
    assert "(ROS 2 jazzy: ROS_DISTRO)" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("variable", "options", "release"),
    [("", [], "humble"), ("jazzy", [], "jazzy"), ("foxy", ["--distro", "rolling"], "rolling")],
)
def test_a_plan_is_for_the_release_of_the_rewrite(
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    variable: str,
    options: list[str],
    release: str,
) -> None:
    (folder / "c.urdf").write_text(CLASSIC)
    if variable:
        monkeypatch.setenv("ROS_DISTRO", variable)
    urdf_postfix.main(["c.urdf", "robot1", "-o", "o.urdf", *options])
    assert f"(ROS 2 {release}" in capsys.readouterr().err
    multibot.main(["plan", "c.urdf", "robot1", *options])
    planned = capsys.readouterr()
    assert f"\nrelease: {release}\n" in planned.out
    assert "warning: ROS_DISTRO" not in planned.err
    assert (
        system_of_description("c.urdf", ["robot1"], distro=options[-1] if options else "").release
        == release
    )


def test_a_plan_names_a_release_that_is_not_known(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "c.urdf").write_text(CLASSIC)
    monkeypatch.setenv("ROS_DISTRO", "noetic")
    assert multibot.main(["plan", "c.urdf", "robot1"]) == 0
    assert "warning: ROS_DISTRO is 'noetic', which is not known" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("line", "options", "variable", "said"),
    [
        ("distro: jazzy", "", "lyrical", "jazzy: the fleet file says so"),
        ("distro: jazzy", "--distro kilted", "lyrical", "kilted: --distro"),
        ("", "", "lyrical", "lyrical: ROS_DISTRO"),
        ("", "", "", "humble: c.urdf loads libgazebo_ros_p3d.so"),
    ],
)
def test_a_build_says_which_release_it_is_for_and_why(
    folder: Path,
    line: str,
    options: str,
    variable: str,
    said: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    (folder / "c.urdf").write_text(CLASSIC)
    (folder / "plain.urdf").write_text('<robot name="r"><link name="base"/></robot>')
    robots = "[{name: a, description: c.urdf}, {name: b, description: plain.urdf}]"
    (folder / "fleet.yaml").write_text(f"layout: postfix\nrobots: {robots}\n{line}\n")
    monkeypatch.setenv("ROS_DISTRO", variable)
    assert multibot.main(["build", "fleet.yaml", "-o", "out", *options.split()]) == 0
    assert f"(ROS 2 {said})" in capsys.readouterr().err


def test_the_lint_goes_on_with_a_release_that_is_not_known(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "c.urdf").write_text(CLASSIC)
    monkeypatch.setenv("ROS_DISTRO", "noetic")
    assert urdf_lint.main(["c.urdf"]) in (0, 1)
    assert "warning: ROS_DISTRO is 'noetic'" in capsys.readouterr().err
