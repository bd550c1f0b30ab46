# SPDX-License-Identifier: Apache-2.0
"""``fleet.launch.py`` as text: what each record of what is started becomes."""

from __future__ import annotations

import pytest
from paths import fixture_text

from multibot_rewrite.fleet.launch.each_robot import functions
from multibot_rewrite.fleet.launch.launch_python import to_python
from multibot_rewrite.fleet.launch.starts import FleetStarts, RobotStarts
from multibot_rewrite.fleet.outputs.relays import BRIDGE, not_bridged
from multibot_rewrite.planning.start import File, Start, Text

PARAMS = File("r1/p.yaml")
FULL = RobotStarts(
    "r1", "rover.urdf", "/r1", (PARAMS,),
    (
        Start(
            "nav2_amcl", "amcl", "/r1", "amcl",
            (PARAMS, {"autostart": True, "node_names": ["a", "b"]}), (("/scan", "scan"),),
            ("--flag", "v", File("x"), "-q"),
        ),
        Start(
            "rclcpp_components", "isolated", "/r1", "box",
            components=(Start("p", "", "/r1", "c", (PARAMS,), (("a", "b"),), plugin="P"),),
        ),
        Start("slam_toolbox", "sync", brought_up=True),
        Start("tf_bridge", "b", needs=BRIDGE,
              parameters=({"text": Text("r1/r.urdf"), "n": 1.5, "it's": "it's"},)),
        Start("ros_gz_sim", "create", arguments=("-name", "r1", "-x", "1.0"), condition="simulator"),
        Start("rviz2", "rviz2", arguments=("-d", File("r1/w.rviz")), condition="rviz"),
    ),
    (("x", "no program"), ("y", "")),
    not_bridged("r1"),
)  # fmt: skip
BARE = RobotStarts("r1", "rover.urdf", "", (), (Start("p", "e"),))
SAID = not_bridged("r1")
QUOTED = f'"{SAID}"' if "'" in SAID else f"'{SAID}'"
FUNCTION = (
    fixture_text("launch_python_function.txt")
    .replace("BRIDGE", f"'{BRIDGE}'")
    .replace("SAID", QUOTED)
)


def fleet(*robots: RobotStarts, **more: object) -> FleetStarts:
    made = FleetStarts("One rover.", (), (), robots, (), True, ())
    return made._replace(**more)  # type: ignore[arg-type]


def test_all_that_a_robot_may_run() -> None:
    text = to_python(fleet(FULL))
    assert text[text.index("def start_r1") : text.index("\n\ndef first(count)")] == FUNCTION
    assert "def if_installed(" in text and "def brought_up(" in text


def test_lines_to_drive_are_in_the_head() -> None:
    long = "ros2 run a b " + " ".join(f"word{at:02}" for at in range(15))
    head = to_python(fleet(BARE, driving=("ros2 run a b", long))).split('"""')[1]
    assert head.endswith(
        "\nIn other terminals, to drive:\n\n    ros2 run a b\n"
        "    ros2 run a b word00 word01 word02 word03 word04 word05 word06 word07 word08 word09"
        " word10 \\\n"
        "        word11 word12 word13 word14\n"
    )
    many = to_python(fleet(BARE, driving=("drive r1",) * 5)).split('"""')[1]
    assert many.count("drive r1") == 1
    assert many.endswith("\n\nThe other robots likewise: with their names in the place of r1.\n")
    assert to_python(fleet(BARE, driving=("drive r1",) * 4)).count("    drive r1\n") == 4


# ---------------------------------------------------------------- robots that start the same


def robot(name: str, *starts: Start, kind: str = "rover.urdf") -> RobotStarts:
    return RobotStarts(name, kind, f"namespace /{name}", (), starts)


def given(name: str, *words: str, **named: str) -> RobotStarts:
    return robot(name, Start("p", "e", arguments=words, **named))  # type: ignore[arg-type]


def test_no_two_functions_have_one_title() -> None:
    """Robots may be called like the function of a kind, or like its second one."""
    others = [robot(it, Start("p", it)) for it in ("rover", "rover_2", "rover-2")]
    titles = [it.title for it in functions([given("a", "a"), given("b", "b"), *others])]
    assert titles == ["start_rover", "start_rover_2", "start_rover_2_2", "start_rover_2_3"]


@pytest.mark.parametrize(
    ("words", "name"),
    [
        (("-y", "{}"), "y"), (("--yaw", "{}"), "yaw"), (("-R", "{}"), "roll"),
        (("-P", "{}"), "pitch"), (("-Y", "{}"), "yaw"), (("--roll", "{}"), "roll"),
        (("-name", "{}"), "model"), (("--Long-Flag", "{}"), "long_flag"), (("{}",), "arguments"),
        # What the functions of a launch file need is not hidden, and no word of Python is taken.
        (("-file", "{}"), "value"), (("-text", "{}"), "value"), (("--from", "{}"), "value"),
        (("--params", "{}"), "value"),
    ],
)  # fmt: skip
def test_a_parameter_is_called_by_what_is_before_it(words: tuple[str, ...], name: str) -> None:
    (made,) = functions([
        given(it, *(one.format(text) for one in words)) for it, text in (("a", "v"), ("b", "w"))
    ])  # fmt: skip
    assert made.parameters == (name,)
    assert made.calls == {"a": ("'v'",), "b": ("'w'",)}


@pytest.mark.parametrize(("count", "alike"), [(12, True), (13, False)])
def test_robots_that_differ_much_are_not_one_kind(count: int, alike: bool) -> None:
    both = [given(it, *(f"{it}v{at}" for at in range(count))) for it in ("a", "b")]
    assert (len(functions(both)) == 1) is alike
