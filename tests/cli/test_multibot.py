# SPDX-License-Identifier: Apache-2.0
"""``multibot`` as a person meets it: what it prints, writes and returns."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from paths import ROBOTS, ROOT

import multibot_rewrite
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.cli.tables import Grid, render
from multibot_rewrite.description.library import rewrite
from multibot_rewrite.description.rewriters.lookup import look_up
from multibot_rewrite.description.rewriters.plugin_definitions import TYPES, load_definitions
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.lint import catalogue

COMMAND = (sys.executable, "-m", "multibot_rewrite.cli.multibot")


class Result(NamedTuple):
    """What one run left behind."""

    code: int
    out: str
    err: str


@pytest.fixture
def folder(here: Path) -> Path:
    """Return an empty working directory; files of one name differ from test to test."""
    builtin_tree.cache_clear()
    load_definitions.cache_clear()
    return here


class Multibot:
    """Runs the command inside this process, which is quicker."""

    def __init__(self, capture: pytest.CaptureFixture[str]) -> None:
        self.capture = capture

    def __call__(self, *words: str) -> Result:
        try:
            code = main(words)
        except SystemExit as end:
            code = int(str(end.code))
        return Result(code, *self.capture.readouterr())

    def json(self, *words: str) -> Any:
        result = self(*words, "--output-kind", "json")
        return json.loads(result.out)


@pytest.fixture
def multibot(folder: Path, capsys: pytest.CaptureFixture[str]) -> Multibot:
    return Multibot(capsys)


def robot(body: str) -> str:
    joint = '<joint name="hip" type="fixed"><parent link="base"/><child link="arm"/></joint>'
    return f'<robot name="r"><link name="base"/><link name="arm"/>{joint}{body}</robot>'


def plugin(library: str, body: str = "") -> str:
    return f'<gazebo><plugin name="p" filename="{library}">{body}</plugin></gazebo>'


ROVER = str(ROBOTS / "rover.urdf")
ARM = str(ROOT / "fixtures/xacros/arm.urdf.xacro")
LAUNCH = str(ROOT / "examples/launch_tutorial/three.launch.xml")
KNOWN = plugin("libgazebo_ros_diff_drive.so")
ACME = plugin("libacme.so", "<x>hip</x><x>arm</x><list>hip arm</list>")


def write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


# ---------------------------------------------------------------- the command itself


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "multibot: no COMMAND given, use one of adopt, build"),
        (("--quiet", "check"), "write the command first, for example: multibot adopt --quiet"),
        (("--undo",), "write the command first, for example: multibot build --undo"),
        (
            ("--output-kind=json",),
            "write the command first, for example: multibot inspect --output-kind=json",
        ),
        (("--nothing",), "write the command first, for example: multibot check"),
        (("coverage", "a"), "there is no command 'coverage'; use urdf-lint PATH..."),
        (("rewrite", "a"), "there is no command 'rewrite'; use urdf-postfix INPUT ROBOT..."),
        (("inspect", "x", "--suggest", "a"), "--suggest goes with --definitions only"),
        (("inspect", "--output-kind", "json", "--suggest", "a"), "--suggest goes with"),
        (("inspect", "a", "b"), "a: there is no such file or folder"),
        (("inspect", "no.urdf"), "no.urdf: there is no such file or folder"),
        (("inspect", "--suggest", "no.urdf"), "no.urdf: cannot be read: No such file"),
        (("inspect", "--definitions", "no"), "no: cannot be read: No such file"),
        (("inspect", "no"), "'no' is not known: no plugin, node, class, element, sensor type"),
        (("inspect", "amc"), "the nearest known: amcl"),
        (("inspect", "dwb_critics::GoalDistCritc"), "nearest known: dwb_critics::GoalDistCritic"),
        (("inspect", "MX1"), "multibot: no rule has the code 'MX1', and none begins with it; "),
        (("build", ROVER, "-o", "x"), "rover.urdf: a description; use multibot init, which makes"),
        (
            ("check", ROVER),
            "rover.urdf: a description; use multibot init, which makes a fleet file",
        ),
        (("check", LAUNCH), ".launch.xml: a launch file; use multibot check-launch, or"),
        (("inspect", "."), ". is no xacro; urdf-lint . shows what is unknown in it"),
        (("inspect", ROVER), "rover.urdf shows what is unknown in it"),
        (("inspect", ARM, ARM), "the arguments of one xacro file are shown; leave it out"),
        (("inspect", "name:=a"), "name:=a is an argument of a xacro file; name the file"),
        (("inspect", ROVER, "name:=a"), "is no xacro: leave out NAME:=VALUE"),
    ],
)
def test_wrong_use_is_one_line(multibot: Multibot, words: tuple[str, ...], said: str) -> None:
    result = multibot(*words)
    assert (result.code, result.out) == (2, "")
    assert result.err.startswith("multibot")
    assert said in result.err
    assert result.err.count("\n") == 1


def test_the_version(multibot: Multibot) -> None:
    for word in ("-V", "--version"):
        assert multibot(word).out == f"multibot {multibot_rewrite.__version__}\n"


@pytest.mark.slow
def test_urdf_postfix_does_not_pay_for_it() -> None:
    code = "import sys, multibot_rewrite.cli.urdf_postfix; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    there = {name for name in done.stdout.split() if name.startswith("multibot_rewrite")}
    assert "multibot_rewrite.cli.urdf_postfix" in there
    late = (".suggest", ".multibot", ".xacro_arguments", ".tables", ".lookup")
    assert not {name for name in there if name.endswith(late)}
    assert "rich" not in done.stdout.split()


@pytest.fixture
def two(folder: Path) -> Path:
    """Two robots: three plugins known, two not; four mentions exact, two inside."""
    write(folder / "a.urdf", robot(KNOWN + KNOWN + ACME))
    write(folder / "b.urdf", robot(KNOWN + ACME))
    return folder


def test_the_definitions_of_the_project_counts(multibot: Multibot, two: Path) -> None:
    write(two / "acme.vocab", "[plugin acme]\nx uses joint link\n")
    write(two / "pyproject.toml", '[tool.multibot-rewrite]\ndefinitions = ["acme.vocab"]\n')
    assert "x     uses  joint link" in multibot("inspect", "libacme.so").out


# ---------------------------------------------------------------- what it looks like


def test_brackets_and_colons_are_shown_as_they_are() -> None:
    text = render(["[bold]x[/bold] :smile:", Grid(("path",), [("plugin[red]:car:",)])])
    assert text == "[bold]x[/bold] :smile:\npath\nplugin[red]:car:\n"


# ---------------------------------------------------------------- definitions


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "heading"),
    [
        ("libgazebo_ros_diff_drive.so", "plugin gazebo_ros_diff_drive (ROS 2)"),
        ("gazebo_ros_diff_drive", "plugin gazebo_ros_diff_drive (ROS 1)"),
        ("/opt/ros/humble/lib/libgazebo_ros_diff_drive.so", "plugin gazebo_ros_diff_drive (ROS 2)"),
        ("ignition-gazebo-imu-system", "plugin gz-sim-imu-system"),
        ("libignition-gazebo6-imu-system.so", "plugin gz-sim-imu-system"),
        ("gz::sim::systems::Imu", "plugin gz-sim-imu-system"),
        ("ignition::gazebo::systems::Imu", "plugin gz-sim-imu-system"),
        (
            "topic_based_ros2_control/TopicBasedSystem",
            "hardware topic_based_ros2_control/TopicBasedSystem",
        ),
        ("joint", "element joint"),
        ("depth_camera", "sensor depth_camera"),
        ("ros_settings", "block ros_settings"),
    ],
)
def test_everything_known_of_a_name_in_any_spelling(
    multibot: Multibot, name: str, heading: str
) -> None:
    result = multibot("inspect", name)
    assert (result.code, result.err) == (0, "")
    assert f"{heading}  " in result.out


def test_what_is_shown_of_a_plugin(multibot: Multibot) -> None:
    out = multibot("inspect", "libgazebo_ros_diff_drive.so").out
    assert "  only a remap moves: odom /tf cmd_vel\n" in out
    words = [line.split() for line in out.splitlines()]
    (row,) = (w for w in words if w[:4] == ["odometry_frame", "uses", "frame", "odom"])
    assert row[-1].startswith("classic_ros2.vocab:")
    (shared,) = (w for w in words if w[0:1] == ["ros/remapping"])
    assert shared[1:4] == ["uses", "topic", "remap"]
    assert shared[-3].startswith("urdf.vocab:") and shared[-2:] == ["[block", "ros_settings]"]


@pytest.mark.slow
def test_every_row_names_the_line_it_stands_in(multibot: Multibot) -> None:
    """The file and line of each row of the whole plugin definitions, held against the files."""
    home = (
        Path(multibot_rewrite.__file__).parent / "description" / "rewriters" / "plugin_definitions"
    )
    rows = [row for section in multibot.json("inspect")["sections"] for row in section["rows"]]
    assert len(rows) > 500
    texts = {path.name: path.read_text().split("\n") for path in home.glob("*.vocab")}
    wrong = [
        row
        for row in rows
        if texts[row["file"]][row["line"] - 1].split()[:2] != [row["path"], row["role"]]
    ]
    assert wrong == []


def test_a_row_of_a_users_file_names_that_file(multibot: Multibot, folder: Path) -> None:
    write(folder / "my.vocab", "# mine\n[plugin gazebo_ros_diff_drive]\nnew_joint uses joint # n\n")
    out = multibot("inspect", "gazebo_ros_diff_drive", "--definitions", "my.vocab").out
    assert [line.split()[-1] for line in out.splitlines() if line.startswith("new_joint")] == [
        "my.vocab:3",
        "my.vocab:3",
    ]


def test_a_default_that_is_never_inserted_is_marked(multibot: Multibot, folder: Path) -> None:
    write(folder / "my.vocab", "[plugin acme]\ninsert: no\nx uses topic default=go\n")
    words = ("inspect", "libacme.so", "--definitions", "my.vocab")
    assert "go (not inserted)" in multibot(*words).out
    (section,) = multibot.json(*words)["sections"]
    (row,) = section["rows"]
    assert (row["default"], row["inserted"]) == ("go", False)


@pytest.mark.slow
def test_the_list_has_every_section(multibot: Multibot) -> None:
    sections = load_definitions((), "").sections(*TYPES)
    listed, codes = (it.splitlines() for it in multibot("inspect").out.split("\n\n"))
    assert len(listed) == len(sections) + 1
    assert {it.split()[0] for it in codes[1:]} == catalogue.rules().keys()
    table = [it for it in multibot.json("inspect")["sections"] if it["type"] == "hardware"]
    assert {section["type"] for section in table} == {"hardware"}
    assert len(table) == len(load_definitions((), NEWEST_LTS).sections("hardware"))


def test_the_type_narrows_a_name(multibot: Multibot) -> None:
    assert "element ros2_control" in multibot("inspect", "ros2_control").out


def test_an_element_is_found_by_its_tag_the_exact_name_first() -> None:
    found = look_up(load_definitions((), NEWEST_LTS), "sensor", ["element"])
    names = [section.names[0] for section in found]
    assert names[0] == "sensor"
    assert {"robot.sensor", "link.sensor"} <= set(names)


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("name", "near"),
    [
        ("libgazebo_ros_dif_drive.so", "gazebo_ros_diff_drive"),
        ("GAZEBO_ROS_DIFF_DRIVE", "gazebo_ros_diff_drive"),
        ("ignition-gazebo-imu-sistem", "gz-sim-imu-system"),
        ("TopicBasedSystem", "topic_based_ros2_control/TopicBasedSystem"),
    ],
)
def test_an_unknown_name_gets_the_nearest(multibot: Multibot, name: str, near: str) -> None:
    result = multibot("inspect", name)
    assert (result.code, result.out) == (2, "")
    assert f"{name!r} is not known: no plugin" in result.err and near in result.err
    assert result.err.count("\n") == 1


def test_a_name_like_nothing_is_told_where_to_look(multibot: Multibot) -> None:
    assert "; multibot inspect lists all\n" in multibot("inspect", "§§§§").err


# ---------------------------------------------------------------- definitions --suggest


@pytest.mark.more
def test_a_suggestion_can_be_used_as_it_is(multibot: Multibot, two: Path) -> None:
    result = multibot("inspect", "--suggest", "a.urdf")
    assert (result.code, result.err) == (0, "")
    write(two / "new.vocab", result.out)
    plain, done = (rewrite(str(two / "a.urdf"), "r1", definitions=it) for it in ([], ["new.vocab"]))
    assert [sum(it.code == "MB901" for it in one.findings) for one in (plain, done)] == [3, 0]
    assert "<x>hip_r1</x><x>arm/r1</x><list>hip_r1 arm/r1</list>" in done.text


def test_nothing_unknown_is_only_a_comment(multibot: Multibot, two: Path) -> None:
    write(two / "c.urdf", robot(KNOWN))
    result = multibot("inspect", "--suggest", "c.urdf")
    assert result.code == 0
    assert (
        result.err
        == "multibot: c.urdf: everything it loads is known, there is nothing to suggest\n"
    )
    assert result.out.startswith("# ") and result.out.count("\n") == 1


@pytest.mark.more
def test_a_suggestion_leaves_out_what_a_given_file_knows(multibot: Multibot, two: Path) -> None:
    write(two / "acme.vocab", "[plugin acme]\nx uses joint link\n")
    result = multibot("inspect", "--suggest", "a.urdf", "--definitions", "acme.vocab")
    assert "[plugin" not in result.out


def test_the_fixture_robots_need_no_suggestion(multibot: Multibot) -> None:
    for path in sorted(ROBOTS.glob("*.urdf")):
        assert "[" not in multibot("inspect", "--suggest", str(path)).out


def test_a_class_of_a_plugin_is_known(capsys: pytest.CaptureFixture[str]) -> None:
    """dwb_critics/default_critics.xml registers it, trajectory_critic.hpp has scale."""
    assert main(["inspect", "dwb_critics::GoalDistCritic"]) == 0
    told = capsys.readouterr().out
    assert "dwb_critics::GoalDistCritic  a plugin of dwb_core::TrajectoryCritic, in all" in told
    assert "\nscale " in told
