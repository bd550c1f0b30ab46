# SPDX-License-Identifier: Apache-2.0
"""A ``.join`` file is a description for every command: rewritten, built, linted, joined."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from lxml import etree
from paths import fixture_text

from multibot_rewrite import InputError, rewrite
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.cli.urdf_lint import main as lint
from multibot_rewrite.description.joining.from_file import listed_in, part_of
from multibot_rewrite.description.joining.part import Part

ARM = '<robot name="arm"><link name="base"/><link name="tool"/>{}</robot>\n'.format(
    '<joint name="end" type="fixed"><parent link="base"/><child link="tool"/></joint>'
)
HAND = (
    '<robot name="hand" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    '<xacro:arg name="n" default="palm"/><link name="$(arg n)"/></robot>\n'
)
LIST = """\
join:
  - {description: parts/arm.urdf}
  - description: parts/hand.urdf.xacro
    arguments: {n: paw}
    prefix: h_
    at: {parent: tool, pose: {x: 0.5, yaw: 1}}
"""
LINKS = ["base", "tool", "h_paw"]
Write = Callable[[str], str]


@pytest.fixture
def write(here: Path) -> Write:
    """Return a function that writes the list of parts and returns its path; the parts are beside it."""
    (here / "parts").mkdir()
    (here / "parts/arm.urdf").write_text(ARM)
    (here / "parts/hand.urdf.xacro").write_text(HAND)

    def written(text: str) -> str:
        (here / "robot.urdf.join").write_text(text)
        return "robot.urdf.join"

    return written


def links(data: bytes) -> list[str | None]:
    return [it.get("name") for it in etree.fromstring(data).iterchildren("link")]


WHOLE = fixture_text("join_file_whole.yaml")


def test_every_key_of_a_list(write: Write) -> None:
    arm = Part(
        "arm.urdf", srdf="a.srdf", controllers=("c.yaml", "d.yaml"), moveit=("m",), rviz="../a.rviz"
    )
    given = {"n": "paw", "wide": "true", "size": "2"}
    pose = (1, 2, 3, 4, 5, 6.5)
    hand = Part("parts/hand.urdf.xacro", "tool", pose, "h_", "paw", given, one_system=True)
    assert listed_in(write(WHOLE)) == ((arm, hand), 20)
    assert listed_in(write(LIST))[1] == 0


def test_a_part_of_a_fleet_file_has_the_same_keys() -> None:
    """There values are checked already, and paths are not of a folder."""
    assert part_of({"description": "a.urdf"}) == Part("a.urdf")
    data = {
        "description": "a.urdf", "at": {"parent": "tool", "pose": {"z": 1}}, "prefix": "a_",
        "name": "arm", "arguments": {"x": True, "y": 2}, "srdf": "a.srdf", "controllers": "c.yaml",
        "one_system": True, "moveit": ["m", "n"], "rviz": "a.rviz",
    }  # fmt: skip
    given, pose = {"x": "true", "y": "2"}, (0, 0, 1, 0, 0, 0)
    assert part_of(data) == Part(
        *("a.urdf", "tool", pose, "a_", "arm", given, "a.srdf", ("c.yaml",), True, ("m", "n")),
        "a.rviz",
    )


@pytest.mark.more
def test_a_build_reads_it(write: Write) -> None:
    fleet = f"description: {write(LIST)}\nlayout: postfix\nrobots: [{{name: a}}, {{name: b}}]\n"
    Path("fleet.yaml").write_text(fleet)
    assert main(["build", "fleet.yaml", "-o", "out", "-q"]) == 0
    assert links(Path("out/b/robot.urdf").read_bytes()) == [f"{it}/b" for it in LINKS]


def test_the_lint_reads_it_and_its_parts_again(
    write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    assert lint([write(LIST), "--select", "MB1,MB2"]) == 0
    capsys.readouterr()
    Path("parts/arm.urdf").write_text(ARM.replace('child link="tool"', 'child link="gone"'))
    assert lint(["robot.urdf.join"]) == 1
    assert "joint 'end' has the child 'gone', which is no link" in capsys.readouterr().out


def test_join_joins_it(write: Write, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["join", write(LIST), "-o", "robot.urdf"]) == 0
    assert links(Path("robot.urdf").read_bytes()) == LINKS
    assert main(["join", "robot.urdf", "--undo", "-o", "again"]) == 0
    assert Path("again/arm.urdf").read_text() == ARM
    capsys.readouterr()
    assert main(["join", "robot.urdf.join", "--at", "tool"]) == 2
    assert "write it into the file" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("old", "new", "wanted"),
    [
        (LIST, "", "there are no parts"),
        ("join:", "parts:", "robot.urdf.join:1: key 'parts' is not known"),
        ("prefix: h_", "prefx: h_", "robot.urdf.join:5: key 'prefx' is not known; did you mean"),
        ("parent: tool", "paren: tool", "robot.urdf.join:6: at has 'paren'"),
        ("parent: tool", "parent: tol", "did you mean 'tool'?"),
        ("x: 0.5", "x: far", "robot.urdf.join:6: pose has x: far"),
        ("x: 0.5", "x: .inf", "robot.urdf.join:6: pose has x: .inf"),
        ("parts/arm.urdf", "parts/no.urdf", "parts/no.urdf: cannot be read"),
        ("parts/arm.urdf", "robot.urdf.join", "robot.urdf.join is a list of parts"),
        ("join:", "join: [", "not valid YAML"),
        (
            "join:",
            "samples: x\njoin:",
            "robot.urdf.join:1: samples is x; write a number such as 100",
        ),
        ("join:", "samples: 9\njoin:", "samples is for an SRDF: give a part its srdf, too"),
        (
            "{description: parts/arm.urdf}",
            "{}",
            "robot.urdf.join:2: a part has no description; name",
        ),
    ],
)
def test_a_wrong_list_is_told_in_one_line(write: Write, old: str, new: str, wanted: str) -> None:
    with pytest.raises(InputError) as found:
        rewrite(write(LIST.replace(old, new)), "robot1")
    assert wanted in str(found.value)
    assert "\n" not in str(found.value)


def test_a_name_that_gets_no_prefix_is_refused(write: Write) -> None:
    plugin = '<gazebo><plugin filename="libmine.so" name="m"><x>$(arg n)</x></plugin></gazebo>'
    hand = Path("parts/hand.urdf.xacro")
    hand.write_text(HAND.replace("</robot>", f"{plugin}</robot>"))
    with pytest.raises(InputError, match=r"a name has no prefix: .*'paw'.*; make the description"):
        rewrite(write(LIST), "robot1")
    assert main(["join", "robot.urdf.join", "-q", "-o", "robot.urdf"]) == 0
