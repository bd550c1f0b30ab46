# SPDX-License-Identifier: Apache-2.0
"""Arguments of a xacro with a robot's name, on the command lines that take NAME:=VALUE."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from lxml import etree
from paths import FIXTURES

from multibot_rewrite.cli import multibot, urdf_lint, urdf_postfix

pytestmark = pytest.mark.slow

XACROS = FIXTURES / "xacros"
ARM, BASE = str(XACROS / "arm.urdf.xacro"), str(XACROS / "base.urdf.xacro")
PREFIX = "tf_prefix:={robot}_"
# One robot's frame lacks the argument: a finding for each robot.
MISSED = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="p" default=""/>
  <link name="$(arg p)base_link"/>
  <gazebo>
    <plugin name="drive" filename="libgazebo_ros_diff_drive.so">
      <robot_base_frame>base_link</robot_base_frame>
    </plugin>
  </gazebo>
</robot>
"""


def links(path: Path) -> list[str]:
    return [str(it.get("name")) for it in etree.parse(path).getroot().findall("link")]


def test_a_file_for_each_robot_and_a_summary(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    out = str(tmp_path / "{robot}.urdf")
    words = [ARM, "left", "right", PREFIX, "-o", out, "--affix", "prefix", "--separator", "_"]
    assert urdf_postfix.main(words) == 0
    for robot in ("left", "right"):
        own = [f"{robot}_{it}" for it in ("base_link", "tool0", "gripper", "camera_link")]
        assert links(tmp_path / f"{robot}.urdf") == own
    said = capfd.readouterr().err
    assert "2 robots: renamed 1 link, 1 joint, " in said
    assert ", 6 names set by tf_prefix; added 1 element. Verified" in said


def test_changes_of_every_robot_are_its_own(tmp_path: Path) -> None:
    changes = tmp_path / "changes.json"
    words = [ARM, "left", "right", PREFIX, "--output-kind", "changes"]
    assert urdf_postfix.main([*words, "-o", str(changes)]) == 0
    made = json.loads(changes.read_text())["robots"]
    for robot in ("left", "right"):
        renamed = {(it["old"], it["new"]) for it in made[robot] if it["kind"] == "link"}
        assert renamed == {("camera_link", f"camera_link/{robot}")}


def test_a_diff_is_against_the_robots_own_expansion(capfd: pytest.CaptureFixture[str]) -> None:
    assert urdf_postfix.main([ARM, "left", "right", PREFIX, "--diff"]) == 0
    out = capfd.readouterr().out
    removed = [it for it in out.splitlines() if it.startswith("-") and "<link" in it]
    assert removed == ['-  <link name="camera_link"/>'] * 2
    assert "right_tool0" in out
    assert "-      <parent link" not in out


def test_findings_of_every_robot_are_reported(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "r.urdf.xacro"
    path.write_text(MISSED)
    words = [str(path), "left", "right", "p:={robot}_", "-o", str(tmp_path / "{robot}.urdf")]
    assert urdf_postfix.main([*words, "--layout", "both", "--format", "json", "-v"]) == 0
    found = json.loads(capfd.readouterr().out)["findings"]
    messages = [it["message"] for it in found if it["code"] == "MB143"]
    assert len(messages) == 2
    assert all(f"'{name}_base_link'" in " ".join(messages) for name in ("left", "right"))
    assert urdf_postfix.main([*words, "--layout", "both", "--fail-on", "warning"]) == 1


@pytest.mark.sample(1)
@pytest.mark.parametrize("options", [[], ["--affix", "prefix", "--separator", "_"]])
def test_strip_with_the_xacro(tmp_path: Path, options: list[str]) -> None:
    made, back, plain = (str(tmp_path / name) for name in ("left.urdf", "back.urdf", "plain.urdf"))
    assert urdf_postfix.main([ARM, "left", PREFIX, "-o", made, *options]) == 0
    undo = ["left", "--undo", "--xacro", ARM, PREFIX, *options]
    assert urdf_postfix.main([made, *undo, "-o", back]) == 0
    names = ["left_base_link", "left_tool0", "left_gripper", "camera_link"]
    assert links(Path(back)) == names
    assert urdf_postfix.main([back, "left", "-o", plain, *options, "--force"]) == 0


@pytest.mark.parametrize(
    ("run", "words", "said"),
    [
        (urdf_postfix.main, [ARM, "left", "tf_prefix:={tf}_"], "unknown placeholder {tf}, only"),
        (urdf_postfix.main, [ARM, "left", "--xacro", ARM], "--xacro goes with --undo"),
        (
            urdf_postfix.main,
            [ARM, "left", "right", "tf_prefix:=left_", "-o", "{robot}.urdf"],
            "write tf_prefix:={robot}_",
        ),
        (urdf_postfix.main, ["--why", f"{ARM}:3", "tf_prefix:={tf}"], "placeholder {tf}, only"),
        (multibot.main, ["inspect", ARM, PREFIX], "no robot is named to fill it in for"),
        (multibot.main, ["inspect", "--suggest", ARM, PREFIX], "no robot is named"),
        (
            multibot.main,
            ["plan", "--output-kind=table", ARM, "left", "right", "tf_prefix:={tf}"],
            "placeholder {tf}",
        ),
        (multibot.main, ["plan", ARM, "left", "tf_prefix:={tf}"], "unknown placeholder {tf}"),
        (urdf_lint.main, [ARM, PREFIX], "no robot is named to fill it in for"),
    ],
)
def test_wrong_use_is_one_line(
    run: Callable[[list[str]], int],
    words: list[str],
    said: str,
    capfd: pytest.CaptureFixture[str],
    here: Path,
) -> None:
    assert run(words) == 2
    out, err = capfd.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert said in err
    assert list(here.iterdir()) == []


def test_lint_fills_in_its_first_robot(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "r.urdf.xacro"
    path.write_text(MISSED.replace(">base_link<", ">nowhere<").replace('_link"/>', '__link"/>'))
    words = [str(path), "p:={robot}_", "--robots", "left,right", "--format", "json"]
    assert urdf_lint.main([*words, "--select", "MB4,MB5"]) in (0, 1)
    found = json.loads(capfd.readouterr().out)["findings"]
    assert {it["arguments"] for it in found} <= {"", "p:=left_"}
    assert urdf_lint.main([ARM, PREFIX, "--robots", "left,right", "--select", "MB43,MB106"]) == 0
