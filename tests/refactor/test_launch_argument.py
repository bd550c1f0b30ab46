# SPDX-License-Identifier: Apache-2.0
"""Launch files as people write them, and what they are with the argument; read back by hand."""

from __future__ import annotations

import pytest

from multibot_rewrite.refactor.launch_argument import Space, literal_parameters, with_argument

HEAD = """from launch import LaunchDescription
from launch.substitutions import Command
from launch_ros.actions import Node
"""
DECLARED = 'DeclareLaunchArgument("prefix", default_value=""),'
MORE = """
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
"""
GIVEN = ', " prefix:=", LaunchConfiguration("prefix")'
PYTHON = {
    "one line": (
        '\ntext = Command(["xacro ", "r.urdf.xacro"])\n'
        "def generate_launch_description():\n    return LaunchDescription([Node()])\n",
        f'\ntext = Command(["xacro ", "r.urdf.xacro"{GIVEN}])\n'
        "def generate_launch_description():\n"
        f"    return LaunchDescription([{DECLARED} Node()])\n",
    ),
    "an action on each line, and a comma at the end": (
        '\ntext = Command([\n    FindExecutable(name="xacro"),\n    " ",\n    "r.urdf.xacro",\n])\n'
        "def generate_launch_description():\n    return LaunchDescription([\n        Node(),\n    ])\n",
        '\ntext = Command([\n    FindExecutable(name="xacro"),\n    " ",\n'
        f'    "r.urdf.xacro"{GIVEN},\n])\n'
        "def generate_launch_description():\n"
        f"    return LaunchDescription([\n        {DECLARED}\n        Node(),\n    ])\n",
    ),
    "names of a module": (
        '\ntext = launch.substitutions.Command(["xacro", " ", "r.urdf.xacro"])\n'
        "x = launch.LaunchDescription([Node()])\n",
        f'\ntext = launch.substitutions.Command(["xacro", " ", "r.urdf.xacro"{GIVEN}])\n'
        f"x = launch.LaunchDescription([{DECLARED} Node()])\n",
    ),
}
LEFT = {
    "a program of its own": 'text = xacro.process_file("r.urdf.xacro").toxml()\n',
    "no literal list": 'ld.add_action(Node())\nt = Command(["xacro ", "r.urdf.xacro"])\n',
    "the first line that has it": 'p = "r.urdf.xacro"\ntext = xacro.process_file(p)\n',
    "words in one text": 't = Command("xacro r.urdf.xacro")\nx = LaunchDescription([Node()])\n',
    "no action": 't = Command(["xacro ", "r.urdf.xacro"])\nx = LaunchDescription([])\n',
    "another program": 't = Command(["cat ", "r.urdf.xacro"])\nx = LaunchDescription([Node()])\n',
    "no word": 't = Command([])\np = "r.urdf.xacro"\nx = LaunchDescription([Node()])\n',
}


def changed(source: str, path: str = "a.launch.py") -> str | None:
    names = ["other.urdf.xacro", "r.urdf.xacro"]
    data = with_argument(path, source.encode(), "prefix", names).data
    return None if data is None else data.decode()


@pytest.mark.parametrize("case", PYTHON)
def test_a_python_launch_file_takes_it(case: str) -> None:
    before, after = PYTHON[case]
    assert changed(HEAD + before) == HEAD[:-1] + MORE + after


@pytest.mark.parametrize("case", LEFT)
def test_what_runs_xacro_otherwise_is_left_with_its_line(case: str) -> None:
    made = with_argument("a.launch.py", f"{HEAD}{LEFT[case]}".encode(), "prefix", ["r.urdf.xacro"])
    line = 4 + (case in ("no literal list", "no word"))
    assert made.data is None
    assert [(it.place, it.why) for it in made.left] == [
        (f"a.launch.py:{line}", "give its xacro the argument by hand")
    ]


def test_another_robots_launch_file_is_nothing_of_ours() -> None:
    source = f'{HEAD}text = Command(["xacro ", "other.xacro"])\n'
    assert with_argument("a.launch.py", source.encode(), "prefix", ["r.urdf.xacro"]).data is None


def test_a_file_that_is_no_python_is_left() -> None:
    made = with_argument("a.launch.py", b"def (: r.urdf.xacro", "prefix", ["r.urdf.xacro"])
    assert (made.data, made.left[0].why) == (None, "it is no Python")


XML = """<launch>
  <node pkg="robot_state_publisher" exec="robot_state_publisher">
    <param name="robot_description" value="$(command 'xacro $(find-pkg-share p)/r.urdf.xacro')"/>
  </node>
</launch>
"""


def test_an_xml_launch_file_takes_it() -> None:
    wanted = XML.replace("<launch>", '<launch>\n  <arg name="prefix" default=""/>').replace(
        "r.urdf.xacro'", "r.urdf.xacro prefix:=$(var prefix)'"
    )
    assert changed(XML, "a.launch.xml") == wanted


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("<launch>", '<launch>\n  <arg name="prefix" default="x"/>', 4),
        ("command", "eval", 3),
        ("<launch>", "<group>", 3),
    ],
)
def test_an_xml_launch_file_that_cannot_take_it_is_left(old: str, new: str, line: int) -> None:
    made = with_argument("a.launch.xml", XML.replace(old, new).encode(), "prefix", ["r.urdf.xacro"])
    why = "give its xacro the argument by hand"
    assert (made.data, made.left) == (None, ((f"a.launch.xml:{line}", why),))


@pytest.mark.parametrize(
    ("more", "filled"),
    [("", True), ('  <let name="file" value="c.yaml"/>\n', False), (None, False)],
)
def test_an_xml_launch_file_fills_in_a_parameter_file(more: str | None, filled: bool) -> None:
    """One that is named elsewhere too is read as it is there."""
    given = '  <node pkg="p" exec="e">\n    <param from="$(find-pkg-share p)/c.yaml"/>\n  </node>\n'
    source = XML.replace("</launch>", f"{'' if more is None else given + more}</launch>")
    made = with_argument("a.launch.xml", source.encode(), "prefix", ["r.urdf.xacro"], ["c.yaml"])
    assert (made.filled, made.left, made.spaced) == (("c.yaml",) * filled, (), False)
    assert made.data and (b'/c.yaml" allow_substs="true"/>' in made.data) == filled


# What stands before the actions, the parameters of a node, and what they become (# for the file).
GIVEN_FILES = {
    "there": ("", "[join(d, 'c.yaml'), 5]", "[#join(d, 'c.yaml')#, 5]"),
    "by a name": ("c = d + '/c.yaml'\n", "[c]", "[#c#]"),
    "there and by a name": ("c = d + '/c.yaml'\n", "[c, '/d/c.yaml']", "[#c#, #'/d/c.yaml'#]"),
    "by a name that is used twice": ("c = '/d/c.yaml'\nprint(c)\n", "[c]", ""),
    "by two names": ("c = e = '/d/c.yaml'\n", "[c]", ""),
    "by an attribute": ("d.e = '/d/c.yaml'\n", "[d.e]", ""),
    "named elsewhere, too": ("print('c.yaml')\n", "['/d/c.yaml']", ""),
    "in a value": ("", "[{'file': 'c.yaml'}]", ""),
    "no list": ("", "'c.yaml'", ""),
    "another one": ("", "['/d/cc.yaml', 'd.yaml']", ""),
    "another name": ("c = '/d/c.yaml'\ne = 'e.yaml'\n", "[e]", ""),
}


@pytest.mark.parametrize("case", GIVEN_FILES)
def test_a_python_launch_file_fills_in_what_it_gives_nodes_alone(case: str) -> None:
    """launch_ros ParameterFile(..., allow_substs=True), around each item."""
    before, given, wanted = GIVEN_FILES[case]
    node = "Node(respawn_delay=2.0, parameters={})"
    command = 't = Command(["xacro ", "r.urdf.xacro"])'
    source = f"{HEAD}{before}{command}\nx = LaunchDescription([{node.format(given)}])\n"
    made = with_argument("a.launch.py", source.encode(), "prefix", ["r.urdf.xacro"], ["c.yaml"])
    text = (made.data or b"").decode()
    parts = (wanted or given).split("#")
    filled = "".join(
        f"ParameterFile({it}, allow_substs=True)" if at % 2 else it for at, it in enumerate(parts)
    )
    more = "from launch_ros.parameter_descriptions import ParameterFile\n"
    assert (made.filled, more in text) == (("c.yaml",) * bool(wanted), bool(wanted))
    assert node.format(filled) in text


NODE = 'Node(package="robot_state_publisher", executable="robot_state_publisher")'
IN_SPACE = NODE.replace(",", ', namespace=LaunchConfiguration("namespace"),', 1)


@pytest.mark.parametrize("of_xacro", [True, False])
def test_what_belongs_to_the_description_is_in_the_namespace(of_xacro: bool) -> None:
    others = (
        'Node(package="rviz2", executable="rviz2")',
        'Node(package="p", parameters=[{"robot_description": t}])',
        'Node(package="p", arguments=["-topic", "/other"])',
        'Other(package="robot_state_publisher")',
        "Node(package=P)",
        "Node()",
    )
    spawner = 'Node(package="gazebo_ros", arguments=["-topic", "robot_description"])'
    command = 't = Command(["xacro ", "r.urdf.xacro"])'
    source = f"{HEAD}{command}\nx = LaunchDescription([{', '.join((NODE, spawner, *others))}])\n"
    space = Space("namespace", of_xacro)
    made = with_argument("a.launch.py", source.encode(), "prefix", ["r.urdf.xacro"], (), space)
    text = (made.data or b"").decode()
    assert IN_SPACE in text and f", {', '.join(others)}])" in text and made.spaced
    assert 'package="gazebo_ros", namespace=LaunchConfiguration("namespace"),' in text
    assert text.count('DeclareLaunchArgument("namespace", default_value="")') == 1
    assert ('" namespace:=", LaunchConfiguration("namespace")' in text) == of_xacro


@pytest.mark.parametrize(
    ("package", "of_robot"),
    [
        ("robot_state_publisher", True), ("joint_state_publisher", True),
        ("joint_state_publisher_gui", True), ("controller_manager", True), ("rviz2", False),
    ],
)  # fmt: skip
def test_a_namespace_that_no_xacro_takes_is_for_what_belongs_to_the_description(
    package: str, of_robot: bool
) -> None:
    command = 't = Command(["xacro ", "r.urdf.xacro"])'
    source = f'{HEAD}{command}\nx = LaunchDescription([Node(package="{package}")])\n'
    xml = XML.replace("robot_state_publisher", package)
    space = Space("namespace", False)
    for path, text in (("a.launch.py", source), ("a.launch.xml", xml)):
        made = with_argument(path, text.encode(), "prefix", ["r.urdf.xacro"], (), space)
        assert made.spaced == of_robot
        assert made.data and (b"namespace" in made.data) == of_robot


def test_an_xml_launch_file_puts_it_there_too() -> None:
    made = with_argument(
        "a.launch.xml", XML.encode(), "prefix", ["r.urdf.xacro"], (), Space("namespace", True)
    )
    text = (made.data or b"").decode()
    assert '<node pkg="robot_state_publisher" namespace="$(var namespace)" exec=' in text
    assert "prefix:=$(var prefix) namespace:=$(var namespace)'" in text
    assert '<arg name="namespace" default=""/>' in text and made.spaced


def test_a_launch_file_with_a_namespace_keeps_that() -> None:
    before, _ = PYTHON["one line"]
    source = f"{HEAD}namespace = 1\n{before}".encode()
    made = with_argument(
        "a.launch.py", source, "prefix", ["r.urdf.xacro"], (), Space("namespace", True)
    )
    assert (made.spaced, [it.place for it in made.left]) == (False, ["a.launch.py:4"])
    assert made.data and GIVEN.encode() in made.data
    # What is left anyway has one reason.
    source = f'{HEAD}namespace = 1\np = "r.urdf.xacro"\n'.encode()
    made = with_argument(
        "a.launch.py", source, "prefix", ["r.urdf.xacro"], (), Space("namespace", True)
    )
    assert [it.why for it in made.left] == ["give its xacro the argument by hand"]


def test_a_literal_parameter_has_its_place_its_node_and_its_key() -> None:
    named = b'<node pkg="a" exec="b" name="n"><param name="f" value="x"/></node>'
    data = b"<launch>%s%s<param value='x'/></launch>" % (named, named.replace(b' name="n"', b""))
    first = data.index(b'"x"') + 1
    second = data.index(b'"x"', first) + 1
    found = [*literal_parameters("a.launch.xml", data, "x")]
    assert found == [(first, "n", "f"), (second, "b", "f")]
