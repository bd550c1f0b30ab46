# SPDX-License-Identifier: Apache-2.0
"""One RViz config for robots: groups, tools, views, frames, colours, and what is said about it."""

from __future__ import annotations

from collections import defaultdict
from typing import Any

import pytest
import yaml
from hypothesis import given, strategies as st
from paths import fixture_text
from rviz_robots import robots_of

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.related_files.rviz.read_config import palette, read_colour, rviz_data
from multibot_rewrite.related_files.rviz.rewrite import (
    RvizText,
    read_for,
    rewrite_rviz,
    start_command,
)
from multibot_rewrite.related_files.yaml_text import read_yaml
from multibot_rewrite.rules.files.judge import judged_once

ROBOTS = ("robot1", "robot2")
DECLARED = {"link": dict.fromkeys(("base_link", "base_scan", "wheel")), "joint": {"hip": None}}
CONFIG = fixture_text("rviz_config.yaml")


def declared(**more: dict[str, Any]) -> Any:
    return defaultdict(dict, {**DECLARED, **more})


def make(
    text: str = CONFIG, layout: str = "L2", **more: Any
) -> tuple[tuple[RvizText, ...], tuple[Finding, ...]]:
    options = {key: more.pop(key) for key in ("world", "relayed") if key in more}
    robots = robots_of(declared(), layout, ROBOTS, **more)
    document = read_yaml(text.encode(), "one.rviz")
    made, found = rewrite_rviz(document, robots, **options)
    file = read_for(document, robots, NEWEST_LTS)._replace(robots=frozenset(ROBOTS))
    return made, (*found, *judged_once(file))


def shown(text: str = CONFIG, layout: str = "L2", **more: Any) -> dict[str, Any]:
    return yaml.safe_load(make(text, layout, **more)[0][0].text)


def manager(**more: Any) -> dict[str, Any]:
    return shown(**more)["Visualization Manager"]


def codes(text: str = CONFIG, layout: str = "L2", **more: Any) -> list[str]:
    return [finding.code for finding in make(text, layout, **more)[1]]


def config(display: str, more: str = "") -> str:
    rows = "".join(f"      {line}\n" for line in display.strip().splitlines())
    head = "Visualization Manager:\n  Displays:\n    - Name: it\n"
    return f"{head}{rows}{more}  Global Options:\n    Fixed Frame: map\n"


def group(number: int) -> dict[str, Any]:
    return manager()["Displays"][number - 1 - len(ROBOTS)]


DISPLAYS, FIXED = (
    "Visualization Manager.Displays",
    "Visualization Manager.Global Options.Fixed Frame",
)
OF_ONE, OF_TWO = f"{DISPLAYS}.3.Displays", f"{DISPLAYS}.4.Displays"
NO_COLOUR = CONFIG.replace("Color Transformer: FlatColor", "Color Transformer: Intensity")
PLAN = config("Class: rviz_default_plugins/Path\nTopic: /plan")
STATE = "Window Geometry:\n  QMainWindow State: 000000ff\n"
MODEL = config("Class: rviz_default_plugins/RobotModel\nTF Prefix: tb3\nDescription Topic: /d")
ODOMETRY = "Class: rviz_default_plugins/Odometry\nTopic: /odom"
FIXED_COVARIANCE = config(f"{ODOMETRY}\nCovariance:\n  Orientation:\n    Frame: Fixed")


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("how", "path", "value"),
    [
        # Absolute and relative topics become the robots'.
        ({}, f"{OF_TWO}.0.Topic", {"Depth": 5, "Value": "/robot2/scan"}),
        ({}, f"{OF_TWO}.1.Displays.0.Topic.Value", "/robot2/eye/image"),
        ({}, f"{OF_TWO}.2.Description Topic.Value", "/robot2/robot_description"),
        ({"layout": "L1"}, f"{DISPLAYS}.1.Topic.Value", "/robot1/scan"),
        ({"layout": "L4"}, f"{DISPLAYS}.1.Topic.Value", "/scan/robot1"),
        # A rewritten description keeps the prefix of tf empty, one with bare links gets one.
        ({}, f"{OF_ONE}.2.TF Prefix", ""),
        ({"tf_prefix": "robot1"}, f"{OF_TWO}.2.TF Prefix", "robot1"),
        ({"text": MODEL}, f"{DISPLAYS}.0.Displays.0.TF Prefix", ""),
        # Links, frames and the tree.
        ({}, f"{OF_ONE}.2.Links.robot1/base_link", {"Alpha": 1}),
        ({}, f"{DISPLAYS}.1.Frames", {"All Enabled": False, "map": {"Value": True},
         "robot1/base_link": {"Value": True}, "robot2/base_link": {"Value": True}}),
        ({}, f"{DISPLAYS}.1.Tree", {}),
        ({"layout": "L1"}, f"{DISPLAYS}.2.Frames.base_link", {"Value": True}),
        ({"text": FIXED_COVARIANCE},
         f"{DISPLAYS}.0.Displays.0.Covariance.Orientation.Frame", "Fixed"),
        # The fixed frame of one robot gives way to the shared one.
        ({}, FIXED, "map"),
        ({"world": "world"}, FIXED, "world"),
        ({"text": CONFIG.replace("Fixed Frame: odom", "Fixed Frame: world")}, FIXED, "world"),
        ({"layout": "L1"}, FIXED, "odom"),
        ({"layout": "L4"}, FIXED, "odom/robot1"),
        # Windows and paths follow the names.
        ({}, "Window Geometry", {"robot1 Eye": {"collapsed": False},
         "robot2 Eye": {"collapsed": False}, "Width": 1200}),
        ({}, "Panels.0.Property Tree Widget.Expanded", ["/Global Options1", "/TF1/Frames1"]),
        ({}, "Panels.1.SyncSource", "robot1 Eye"),
        # Where no window changes their state stays.
        ({"text": PLAN + STATE}, "Window Geometry.QMainWindow State", "000000ff"),
        # The window of one robot in its namespace keeps its panels.
        ({"layout": "L1"}, "Panels.1.Name", "Navigation 2"),
        ({"layout": "L1"}, "Panels.2.Name", "Time"),
        ({"layout": "L4"}, "Panels.1.Name", "Time"),
        # Colours tell robots apart; one that means something stays.
        ({}, f"{OF_ONE}.0.Color", "230; 159; 0"),
        ({}, f"{OF_TWO}.0.Color", "86; 180; 233"),
        ({"colour": "#102030"}, f"{OF_TWO}.0.Color", "16; 32; 48"),
        ({"text": NO_COLOUR}, f"{OF_TWO}.0.Color", "255; 0; 0"),
        ({"layout": "L1", "colour": "#102030"}, f"{DISPLAYS}.1.Color", "16; 32; 48"),
        ({"layout": "L1", "colour": ""}, f"{DISPLAYS}.1.Color", "255; 0; 0"),
    ],
)  # fmt: skip
def test_what_is_shown(how: dict[str, Any], path: str, value: object) -> None:
    found = shown(**how)
    for word in path.split("."):
        found = found[int(word) if isinstance(found, list) else word]
    assert found == value
    if isinstance(value, dict) and "map" in value:
        assert [*found] == ["All Enabled", "robot1/base_link", "robot2/base_link", "map"]


@pytest.mark.parametrize(
    ("how", "code", "is_said"),
    [
        ({"text": MODEL}, "MB882", True),
        ({}, "MF201", True),
        ({"text": CONFIG.replace("Fixed Frame: odom", "Fixed Frame: world")}, "MF201", False),
        # One tf topic is nothing to tell.
        ({}, "MF203", False),
        ({"relayed": True}, "MF203", False),
    ],
)
def test_what_is_said(how: dict[str, Any], code: str, is_said: bool) -> None:
    assert (code in codes(**how)) == is_said


@pytest.mark.parametrize(
    ("tool", "written"),
    [
        ("{Class: GOAL}", "{Class: GOAL, Topic: /robot1/goal_pose}"),
        ("{Class: GOAL,}", "{Class: GOAL, Topic: /robot1/goal_pose,}"),
        ("{Class: GOAL , }", "{Class: GOAL, Topic: /robot1/goal_pose , }"),
        ("{Class: GOAL, Name: ,}", "{Class: GOAL, Name: , Topic: /robot1/goal_pose,}"),
        (
            "{Class: 'GOAL',  # go\n     }",
            "{Class: 'GOAL', Topic: /robot1/goal_pose,  # go\n     }",
        ),
        ("{Class: GOAL  # a, b\n     }", "{Class: GOAL, Topic: /robot1/goal_pose  # a, b\n     }"),
    ],
)
def test_a_tool_in_braces_gets_its_topic(tool: str, written: str) -> None:
    tool, written = (it.replace("GOAL", "rviz_default_plugins/SetGoal") for it in (tool, written))
    text = f"Visualization Manager:\n  Tools:\n    - {tool}\n"
    made = make(text)[0][0].text
    assert f"    - {written}\n" in made
    topics = [it["Topic"] for it in yaml.safe_load(made)["Visualization Manager"]["Tools"]]
    assert topics == ["/robot1/goal_pose", "/robot2/goal_pose"]


def test_saved_views_are_there_for_each_robot() -> None:
    listed = (
        "Saved:\n      - Class: c\n        Name: near\n        Target Frame: base_scan\n"
        "      - Class: c\n        Name: far\n        Target Frame: <Fixed Frame>"
    )
    text = CONFIG.replace("Saved: ~", listed).replace(
        "Target Frame: base_link", "Target Frame: map"
    )
    saved = [(view["Name"], view["Target Frame"]) for view in manager(text=text)["Views"]["Saved"]]
    assert saved == [
        ("robot1 near", "robot1/base_scan"),
        ("robot2 near", "robot2/base_scan"),
        ("far", "<Fixed Frame>"),
    ]


@pytest.mark.parametrize(
    ("given_", "colour"),
    [
        ("red", (255, 0, 0)),
        ("#0a0B0c", (10, 11, 12)),
        ((1, 2, 3), (1, 2, 3)),
        ("Teal", (0, 128, 128)),
    ],
)
def test_colours_as_people_write_them(given_: Any, colour: tuple[int, ...]) -> None:
    assert read_colour(given_) == colour


@pytest.mark.parametrize("wrong", ["#12345", "#1234567", "#12 345", "rad", "", "12; 3; 4"])
def test_a_colour_that_is_none(wrong: str) -> None:
    with pytest.raises(InputError, match="is not known"):
        read_colour(wrong)


def test_a_thousand_colours_are_all_different() -> None:
    assert len({palette(at) for at in range(1000)}) >= 950
    assert len({palette(at) for at in range(30)}) == 30


def test_rules_of_an_rviz_of_its_own_come_behind_those_of_tf() -> None:
    rules = (("__node", "rviz_1"), ("/tf", "/x"), ("/scan", "/robot1/scan"))
    tf = (("/tf", "/robot1/tf"), ("/tf_static", "/robot1/tf_static"))
    assert make(layout="L1", rules=rules)[0][0].remaps == (*tf, rules[0], rules[2])


def test_how_the_window_of_one_robot_is_started() -> None:
    bare, posted = make(layout="L1")[0][0], make(layout="L4")[0][1]
    assert start_command(bare, "a.rviz") == [
        *("rviz2", "-d", "a.rviz", "--ros-args", "-r", "__ns:=/robot1"),
        *("-r", "/tf:=/robot1/tf", "-r", "/tf_static:=/robot1/tf_static"),
    ]
    assert start_command(posted, "b.rviz") == [
        *("rviz2", "-d", "b.rviz", "--ros-args"),
        *("-r", "/tf:=/tf/robot2", "-r", "/tf_static:=/tf_static/robot2"),
    ]
    assert start_command(make()[0][0], "c.rviz") == ["rviz2", "-d", "c.rviz"]


NO_RVIZ = "name the node set rviz_moveit or rviz_nav2: each robot gets an rviz2 with its rules"
RULE_OF_EACH = (
    "its topics are absolute: delete it here, and open it in an rviz2 that has a rule for each of"
    " them, one for each robot"
)
FRAME = (
    "Fixed Frame: odom", "MF201", "Fixed Frame 'odom' differs from robot to robot; it is 'map' now",
    "publish a transform from it to each robot, see pose:",
)  # fmt: skip
VIEW = (
    "Target Frame: base_link", "MF213",
    "the view follows 'base_link'; it now follows robot 'robot1'", "each robot has a saved view",
)  # fmt: skip
RELAY = (
    'Class: ""', "MF203", "one window shows all robots only if each robot's tf is relayed to /tf",
    "ros2 run topic_tools relay /tf/robot1 /tf, and the same for tf_static",
)  # fmt: skip


def alone(line: str, title: str, hint: str) -> tuple[str, ...]:
    """Return what is said of an item that works for one process."""
    why = "it works only for the robot whose namespace rviz2 runs in"
    return line, "MF202", f"{title} is left out: {why}", hint


PANEL = alone(
    "- Class: slam_toolbox::SlamToolboxPlugin",
    "slam_toolbox::SlamToolboxPlugin 'Slam'",
    RULE_OF_EACH,
)
GOAL = alone("- Class: nav2_rviz_plugins/GoalTool", "nav2_rviz_plugins/GoalTool", NO_RVIZ)
OTHERS = (
    alone("- Class: nav2_rviz_plugins/Navigation 2", "nav2_rviz_plugins/Navigation 2 'Navigation 2'",
          NO_RVIZ),
    PANEL,
    alone("- Class: moveit_rviz_plugin/MotionPlanning", "moveit_rviz_plugin/MotionPlanning 'Plan'",
          NO_RVIZ),
)  # fmt: skip


@pytest.mark.parametrize(
    ("layout", "relayed", "said"),
    [
        ("L2", False, (PANEL, FRAME, VIEW)),
        ("L4", True, (*OTHERS[:2], RELAY, OTHERS[2], FRAME, GOAL, VIEW)),
    ],
)  # fmt: skip
def test_what_is_said_of_a_window_for_all(
    layout: str, relayed: bool, said: tuple[tuple[str, ...], ...]
) -> None:
    """Whole, in the order of the file."""
    found = [it for it in make(layout=layout, relayed=relayed)[1] if it.code.startswith("MF2")]
    lines = CONFIG.splitlines()
    assert [(lines[it.line - 1].strip(), it.code, it.message, it.hint) for it in found] == [*said]


def test_what_is_said_of_a_camera_and_of_windows_of_their_own() -> None:
    hidden = config("Class: rviz_default_plugins/Camera\nTopic: /i\nVisibility:\n  it: false")
    (reset,) = (it for it in make(hidden)[1] if it.code == "MF212")
    assert (reset.line, reset.message, reset.hint) == (
        6,
        "Visibility of 'it' is reset: the displays are in groups now",
        "choose the displays again in rviz2",
    )
    assert manager(text=hidden)["Displays"][0]["Displays"][0]["Visibility"] == {}
    # An image has no window of another robot in its own.
    assert "MF212" not in codes(hidden, "L1")
    path = hidden.replace("Camera", "Path")
    assert "MF212" not in codes(path)
    (each,) = (it for it in make(path, "L1")[1] if it.code.startswith("MF2"))
    assert (each.line, each.code, each.message, each.hint) == (
        2,
        "MF203",
        "one rviz2 reads one tf topic, but in layout tf-per-robot each robot has its own",
        "each robot gets its own config; for one window write layout: frames-per-robot, or"
        " relayed: true, in the fleet file",
    )


@pytest.mark.parametrize(
    ("display", "code"),
    [
        ("Class: acme/Show\nTopic: /t", "MB891"),
        ("Class: acme/Show\nBody: base_link", "MB901"),
        ("Class: rviz_default_plugins/Axes\nReference Frame: base_lin", "MB853"),
        ("Class: rviz_default_plugins/TF\nFilter (whitelist): ^base", "MB881"),
        (
            "Class: rviz_default_plugins/RobotModel\nDescription Source: File\nDescription File: a",
            "MB881",
        ),
        ("Class: rviz_default_plugins/Image\nImage Topic: /i", "MB872"),
        ("Class: rviz_default_plugins/Path\nTopic: /a/<name>/b", "MB105"),
        ("Class: rviz_default_plugins/Camera\nTopic: /i\nVisibility:\n  it: false", "MF212"),
        (
            "Class: rviz_default_plugins/RobotModel\nDescription Topic:\n  Durability Policy: Volatile",
            "MB873",
        ),
        ("Class: rviz_default_plugins/Path\nTopic: /robot1/plan", "MB863"),
    ],
)
def test_findings(display: str, code: str) -> None:
    assert code in codes(config(display))


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("rviz_default_plugins/Odometry\nCovariance:\n  Orientation:\n    Frame: Local", "Local"),
        ("rviz_default_plugins/Axes\nReference Frame: <Fixed Frame>", "<Fixed Frame>"),
        ('rviz_default_plugins/Path\nTopic: ""', '""'),
        ("rviz_default_plugins/Path\nTopic: ~", "~"),
        ("rviz_default_plugins/Path\nTopic: $(var topic)", "$(var topic)"),
        ("rviz_default_plugins/MarkerArray\nNamespaces:\n  base_link: true", "base_link"),
        ("rviz_default_plugins/Axes\nReference Frame: map", "map"),
        ("rviz_default_plugins/Path\nTopic: /clock", "/clock"),
        ("rviz_default_plugins/Path\nTopic: ~/private", "~/private"),
        ("rviz_default_plugins/RobotModel\nUpdate Interval: 1e-9", "1e-9"),
        ("rviz_default_plugins/Camera\nTopic:\n  Value: ~/i", "~/i"),
        ("rviz_default_plugins/Camera\nTopic: ~/i\nVisibility: {}", "{}"),
    ],
)
def test_what_is_no_name_stays(path: str, value: str) -> None:
    text = config(f"Class: {path}")
    made = make(text)[0][0].text
    assert made == text and value in made and codes(text) == ["MB105"] * ("$(var" in text)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("Panels: []\n", "it has no 'Visualization Manager'"),
        ("", "it has no 'Visualization Manager'"),
        ("[General]\nkey=1\n", "not valid YAML"),
        ("Visualization Manager:\n  Displays:\n    - Class: rviz/Grid\n", "a ROS 1 config"),
        (
            "Visualization Manager:\n  Displays: [{Class: rviz_default_plugins/Grid}]\n",
            "in brackets",
        ),
        ("Visualization Manager:\n  Displays:\n    - &a\n      Class: x\n    - *a\n", "anchor"),
    ],
)
def test_refusals_name_place_and_remedy(text: str, why: str) -> None:
    with pytest.raises(InputError, match=why) as caught:
        make(text)
    assert str(caught.value).startswith("one.rviz") and ";" in str(caught.value)


def test_no_robot_is_an_error() -> None:
    with pytest.raises(UsageError):
        rewrite_rviz(read_yaml(CONFIG.encode(), "one.rviz"), [])


def test_known_classes_have_known_words() -> None:
    words = {word for names in rviz_data()["displays"].values() for word in names.values()}
    words |= set(rviz_data()["any"].values())
    assert words <= {
        *(
            "topic",
            "namespace",
            "frame",
            "link",
            "joint",
            "group",
            "colour",
            "flat_colour",
            "tf_prefix",
        ),
        *("regex", "file", "siblings", "keep"),
    }
    assert set(rviz_data()["flags"].values()) == {"dock", "shared", "process", "absolute"}


TOKEN = st.from_regex(r"[a-z][a-z0-9]{0,5}", fullmatch=True)


@pytest.mark.slow
@given(
    st.lists(st.tuples(TOKEN, st.sampled_from(["Path", "Axes", "Grid", "Image"])), max_size=6),
    st.sampled_from(["L1", "L2", "L3", "L4"]),
    st.integers(0, 3),
)
def test_each_display_is_once_or_with_each_robot(
    drawn: list[tuple[str, str]], layout: str, pad: int
) -> None:
    gap = " " * pad
    rows = ["Visualization Manager:\n", " Displays:\n"]
    for name, cls in drawn:
        place = "Topic" if cls in ("Path", "Image") else "Reference Frame"
        rows += [f" {gap}- Class: rviz_default_plugins/{cls}\n", f" {gap}  {place}: {name}\n"]
    made, _ = make("".join(rows), layout)
    for one in made:
        listed = yaml.safe_load(one.text)["Visualization Manager"]["Displays"] or []
        groups = [it for it in listed if it["Class"] == "rviz_common/Group"]
        singles = len(listed) - len(groups)
        assert all(len(it["Displays"]) + singles == len(drawn) for it in groups) or not groups
        if not groups:
            assert singles == len(drawn)
