# SPDX-License-Identifier: Apache-2.0
"""``fleet.launch.py`` as text: what each record of what is started becomes."""

from __future__ import annotations

import ast

import pytest

from multibot_rewrite.fleet.launch.each_robot import Code, functions
from multibot_rewrite.fleet.launch.launch_python import to_python
from multibot_rewrite.fleet.launch.python_actions import value as python_value
from multibot_rewrite.fleet.launch.starts import CLASSIC, GZ, FleetStarts, RobotStarts
from multibot_rewrite.fleet.outputs.relays import BRIDGE, not_bridged
from multibot_rewrite.spelling.start import File, Start, Text, shell_line

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
FUNCTION = f'''\
def start_r1():
    """Start rover.urdf in /r1."""
    # Not started: x (no program)
    params = [file('r1/p.yaml')]
    return [
        Node(
            package='nav2_amcl',
            executable='amcl',
            namespace='/r1',
            name='amcl',
            arguments=['--flag', 'v', file('x'), '-q'],
            parameters=[
                *params,
                {{'autostart': True, 'node_names': ['a', 'b']}},
                CLOCK,
            ],
            remappings=[
                ('/scan', 'scan'),
            ],
            output='screen',
        ),
        ComposableNodeContainer(
            package='rclcpp_components',
            executable='isolated',
            namespace='/r1',
            name='box',
            parameters=[CLOCK],
            output='screen',
            composable_node_descriptions=[
                ComposableNode(
                    package='p',
                    plugin='P',
                    namespace='/r1',
                    name='c',
                    parameters=[*params, CLOCK],
                    remappings=[
                        ('a', 'b'),
                    ],
                ),
            ],
        ),
        *brought_up(
            LifecycleNode(
                package='slam_toolbox',
                executable='sync',
                parameters=[CLOCK],
                output='screen',
            ),
        ),
        *if_installed(
            '{BRIDGE}',
            {f'"{SAID}"' if "'" in SAID else f"'{SAID}'"},
            [
                Node(
                    package='tf_bridge',
                    executable='b',
                    parameters=[
                        {{'text': text('r1/r.urdf'), 'n': 1.5, "it's": "it's"}},
                        CLOCK,
                    ],
                    output='screen',
                ),
            ],
        ),
        GroupAction(
            [
                Node(
                    package='ros_gz_sim',
                    executable='create',
                    arguments=['-name', 'r1', '-x', '1.0'],
                    parameters=[CLOCK],
                    output='screen',
                ),
            ],
            condition=IfCondition(LaunchConfiguration('simulator')),
        ),
        GroupAction(
            [
                Node(
                    package='rviz2',
                    executable='rviz2',
                    arguments=['-d', file('r1/w.rviz')],
                    parameters=[CLOCK],
                    output='screen',
                ),
            ],
            condition=IfCondition(LaunchConfiguration('rviz')),
        ),
    ]


ROBOTS = {{
    'r1': start_r1,
}}
'''


def fleet(*robots: RobotStarts, **more: object) -> FleetStarts:
    made = FleetStarts("One rover.", (), (), robots, (), True, ())
    return made._replace(**more)  # type: ignore[arg-type]


def argument(name: str, default: str, about: str) -> str:
    space = " " * 12
    words = (f"'{name}',", f"default_value={default},", f"description='{about}',")
    inner = "".join(f"{space}    {it}\n" for it in words)
    return f"{space}DeclareLaunchArgument(\n{inner}{space}),\n"


def described(text: str) -> str:
    return text[text.index("def generate_launch_description") :]


def test_all_that_a_robot_may_run() -> None:
    text = to_python(fleet(FULL))
    assert text[text.index("def start_r1") : text.index("\n\ndef first(count)")] == FUNCTION
    assert "def if_installed(" in text and "def brought_up(" in text


def test_a_robot_without_more_has_no_more() -> None:
    text = to_python(fleet(BARE))
    assert text.startswith(
        '"""\nOne rover.\n\nPlain launch and launch_ros: read it, edit it, or include it from another'
        " launch file.\n\n    ros2 launch fleet.launch.py\n"
        '    ros2 launch fleet.launch.py robots:=r1\n"""\n\n'
        "from pathlib import Path\n\nfrom launch import LaunchDescription\n"
        "from launch.actions import (\n"
        "    DeclareLaunchArgument,\n    OpaqueFunction,\n)\n"
        "from launch.substitutions import LaunchConfiguration\nfrom launch_ros.actions import Node\n"
        "from launch_ros.parameter_descriptions import ParameterValue\n\nFOLDER = "
    )
    assert "def if_installed(" not in text and "def brought_up(" not in text
    assert described(text) == (
        "def generate_launch_description():\n"
        '    """Start robot by robot."""\n'
        "    return LaunchDescription(\n        [\n"
        + argument("robots", "''", "only these: robot1,robot2, or so many: 2")
        + argument("use_sim_time", "'true'", "whether all nodes use /clock")
        + "            OpaqueFunction(function=chosen),\n        ]\n    )\n"
    )


@pytest.mark.parametrize(("simulator", "package"), [(GZ, "ros_gz_sim"), (CLASSIC, "gazebo_ros")])
def test_a_fleet_in_a_simulator(simulator: str, package: str) -> None:
    """A bridge of the simulator is of no use without it; other nodes of all robots run anyway."""
    bridge = Start("ros_gz_bridge", "parameter_bridge", condition="simulator")
    shared = (bridge, Start("nav2_map_server", "map_server"))
    window = Start("rviz2", "rviz2", condition="rviz")
    made = fleet(
        BARE, simulators=(simulator,), shared=shared, windows=(window,), use_sim_time=False,
        world=File("w.sdf"),
    )  # fmt: skip
    text = described(to_python(made))
    assert argument("use_sim_time", "'false'", "whether all nodes use /clock") in text
    assert argument("rviz", "'true'", "whether to open RViz") in text
    about = "whether to start the simulator and to spawn the robots in it"
    assert argument("simulator", "'true'", about) in text
    assert argument("headless", "'false'", "whether the simulator has no window") in text
    assert argument("world", "file('w.sdf')", "the world of the simulator") in text
    assert f"[FindPackageShare('{package}'), 'launch'" in text
    order = [package, "parameter_bridge", "map_server", "function=chosen", "rviz2"]
    places = [text.index(it) for it in order]
    assert places == sorted(places)
    groups = [
        it.partition("condition=")[2].partition("\n")[0] for it in text.split("GroupAction(")[1:]
    ]
    assert groups == [
        "IfCondition(LaunchConfiguration('simulator')),", "IfCondition(LaunchConfiguration('rviz')),",
    ]  # fmt: skip


def test_what_is_imported_is_what_is_used() -> None:
    for made in (fleet(BARE), fleet(FULL), fleet(FULL, BARE._replace(name="r2"), simulators=(GZ,))):
        tree = ast.parse(to_python(made))
        imported = {
            it.name
            for node in ast.walk(tree)
            if isinstance(node, ast.ImportFrom)
            for it in node.names
        }
        used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
        assert imported <= used
        defined = {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}
        capital = {it for it in used if it[:1].isupper() and not it.isupper()}
        assert capital - imported - defined <= {"RuntimeError"}


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


def test_long_lists_are_several_lines() -> None:
    words = tuple(f"--word-{at}" for at in "abcdefgh")
    names = ["long_name_of_a_node"] * 4
    start = Start("p", "e", arguments=words, parameters=({"a": 1, "names": names},))
    text = to_python(fleet(BARE._replace(starts=(start,))))
    lines = "".join(f"                '{it}',\n" for it in words)
    assert f"            arguments=[\n{lines}            ],\n" in text
    inner = "                        'long_name_of_a_node',\n" * 4
    assert (
        "            parameters=[\n                {\n                    'a': 1,\n"
        f"                    'names': [\n{inner}                    ],\n"
        "                },\n                CLOCK,\n            ],\n"
    ) in text


def test_a_line_for_a_shell() -> None:
    start = Start(
        "p", "e", "/r 1", "n", (File("x.yaml"), {"a": "b"}), (("/scan", "scan"),), ("-f", File("y"))
    )
    assert shell_line(start) == (
        "ros2 run p e -f y --ros-args -r '__ns:=/r 1' -r __node:=n -r /scan:=scan "
        "--params-file x.yaml -p a:=b"
    )
    line = shell_line(Start("p", "e", parameters=(File("x.yaml"),)))
    assert line == "ros2 run p e --ros-args --params-file x.yaml"


# ---------------------------------------------------------------- robots that start the same


def robot(name: str, *starts: Start, kind: str = "rover.urdf") -> RobotStarts:
    return RobotStarts(name, kind, f"namespace /{name}", (), starts)


def given(name: str, *words: str, **named: str) -> RobotStarts:
    return robot(name, Start("p", "e", arguments=words, **named))  # type: ignore[arg-type]


def test_what_differs_is_a_parameter() -> None:
    both = [
        given(it, it, f"/{it}/a", "-x", x, "-name", model, namespace=f"of_{it}x")
        for it, x, model in (("r1", "1.0", "m1"), ("r2", "2.5", "m2"))
    ]
    (made,) = functions(both)
    (start,) = made.starts.starts
    assert made.title == "start" and made.parameters == ("namespace", "x", "model")
    assert start.namespace == Code("namespace")
    assert start.arguments == (
        Code("name"), Code("f'/{name}/a'"), "-x", Code("str(x)"), "-name", Code("model")
    )  # fmt: skip
    assert made.calls == {"r1": ("'of_r1x'", "1.0", "'m1'"), "r2": ("'of_r2x'", "2.5", "'m2'")}
    text = to_python(fleet(*both))
    assert "def start(name, namespace, x, model):\n" in text
    assert "    'r2': partial(start, 'r2', namespace='of_r2x', x=2.5, model='m2'),\n" in text


@pytest.mark.parametrize("name", ["e", "gz", "p", "x", "name", "screen"])
def test_a_text_of_all_robots_is_nobodys_name(name: str) -> None:
    """A robot may be called like a program, a flag's word or a value that all robots have."""
    both = [given(it, "gz", "name", "x/e", "screen", f"/{it}/p") for it in (name, "other")]
    (made,) = functions(both)
    assert made.starts.starts[0].arguments == ("gz", "name", "x/e", "screen", Code("f'/{name}/p'"))


def test_one_robot_is_called_like_its_file() -> None:
    (made,) = functions([given(it, f"{it}/rover.urdf") for it in ("rover", "scout")])
    assert made.starts.starts[0].arguments == (Code("f'{name}/rover.urdf'"),)
    assert made.parameters == ()


def test_a_name_with_more_behind_it_that_differs_is_no_template() -> None:
    (made,) = functions([given("r1", "-name", "r1_red"), given("r2", "-name", "r2_blue")])
    assert made.calls == {"r1": ("'r1_red'",), "r2": ("'r2_blue'",)}
    (made,) = functions([given("r1", "-name", "r1_red"), given("r2", "-name", "r2_red")])
    assert made.starts.starts[0].arguments == ("-name", Code("f'{name}_red'"))


@pytest.mark.parametrize(
    "text", ["{name}", "a{0}", "it's", 'a "b"', "a\\b", "\n", "\U0001f916", "\\N{x}", "\udc80"]
)
def test_any_text_is_printed_as_it_is(text: str) -> None:
    for it in ("r1", "r2"):
        (made,) = functions([given(one, f"{text}/{one}/{text}") for one in (it, "z")])
        (word,) = made.starts.starts[0].arguments
        assert isinstance(word, Code)
        assert eval(word, {"name": it}) == f"{text}/{it}/{text}"
    assert eval(python_value(text)) == text


def test_robots_that_start_other_things_have_functions_of_their_own() -> None:
    two, managed = (Start("p", "e"), Start("p", "e")), Start("p", "e", brought_up=True)
    found = functions([
        given("a", "a"), given("b", "b"), robot("c", *two, kind="my arm.urdf"),
        robot("d", *two, kind="my arm.urdf"), robot("e", Start("p", "f")),
        robot("f", managed), robot("g", managed),
    ])  # fmt: skip
    assert [(it.title, [*it.calls]) for it in found] == [
        ("start_rover", ["a", "b"]), ("start_my_arm", ["c", "d"]), ("start_e", ["e"]),
        ("start_rover_2", ["f", "g"]),
    ]  # fmt: skip


def test_no_two_functions_have_one_title() -> None:
    """Robots may be called like the function of a kind, or like its second one."""
    others = [robot(it, Start("p", it)) for it in ("rover", "rover_2", "rover-2")]
    titles = [it.title for it in functions([given("a", "a"), given("b", "b"), *others])]
    assert titles == ["start_rover", "start_rover_2", "start_rover_2_2", "start_rover_2_3"]


def test_a_value_of_another_type_is_another_kind() -> None:
    def start(name: str, value: object) -> RobotStarts:
        return robot(name, Start("p", "e", parameters=({"a": value},)))

    assert len(functions([start("a", 1), start("b", 1.0)])) == 2
    assert len(functions([start("a", 1), start("b", True)])) == 2
    assert len(functions([start("a", File("f")), start("b", Text("f"))])) == 2
    assert len(functions([start("a", File("f")), start("b", File("g"))])) == 1


def test_a_key_may_have_the_name_of_the_robot() -> None:
    (made,) = functions([
        robot(it, Start("p", "e", parameters=({f"{it}.type": "T"},))) for it in ("a", "b")
    ])  # fmt: skip
    assert made.starts.starts[0].parameters == ({Code("f'{name}.type'"): "T"},)


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


def test_a_parameter_is_called_by_its_keyword_or_key() -> None:
    def start(name: str, it: str) -> RobotStarts:
        values = ({"some.key": it, "1": it + it}, File(it * 3))
        return robot(name, Start("p", "e", it * 4, it * 5, values, ((it * 6, it * 7),)))

    (made,) = functions([start("r1", "v"), start("r2", "w")])
    assert made.parameters == (
        *("namespace", "node_name", "some_key", "value", "parameters", "remappings"),
        "remappings_2",
    )


def test_two_values_of_one_name_are_numbered_and_equal_ones_are_one() -> None:
    (made,) = functions([
        given("a", "-x", "1.0", "-x", "2.0", "-x", "1.0"),
        given("b", "-x", "3.0", "-x", "4.0", "-x", "3.0"),
    ])  # fmt: skip
    assert made.parameters == ("x", "x_2")
    codes = [it for it in made.starts.starts[0].arguments if isinstance(it, Code)]
    assert codes == [Code("str(x)"), Code("str(x_2)"), Code("str(x)")]
    # 1 and 1.0 are other texts than the numbers give, and there is no literal of these two.
    for text in ("1", "nan", "inf"):
        (made,) = functions([given("a", "-x", text), given("b", "-x", "2.0")])
        assert made.calls["a"] == (f"'{text}'",)


@pytest.mark.parametrize(("count", "alike"), [(12, True), (13, False)])
def test_robots_that_differ_much_are_not_one_kind(count: int, alike: bool) -> None:
    both = [given(it, *(f"{it}v{at}" for at in range(count))) for it in ("a", "b")]
    assert (len(functions(both)) == 1) is alike


def test_a_file_name_ends_no_docstring_and_no_comment() -> None:
    odd = 'a"""\n\\b.urdf'
    text = to_python(fleet(FULL._replace(description=odd, left=(("x", odd),))))
    assert ast.parse(text).body
    quotes = "'" * 3
    assert f"Start a{quotes} /b.urdf in" in text and f"# Not started: x (a{quotes} /b.urdf)" in text
