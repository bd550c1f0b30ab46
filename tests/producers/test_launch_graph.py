# SPDX-License-Identifier: Apache-2.0
"""What a launch file would start, read with the real launch and launch_ros; without them skipped.

Expectations: what launch_ros passes to the processes, read in actions/node.py and
actions/load_composable_nodes.py.
"""

from __future__ import annotations

import sys
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
import yaml
from launched_here import read_here
from launched_programs import launched
from paths import ROOT, fixture_text
from waiting import wait_until

from multibot_rewrite import InputError
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.launch import missing
from multibot_rewrite.producers.launch import child
from multibot_rewrite.producers.launch.child import launch_graph
from multibot_rewrite.producers.launch.door import of_launch_ros
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchGraph, LaunchOrder


def without() -> str:
    """Why launch_ros cannot be imported here; empty if it can."""
    try:
        of_launch_ros("actions")
    except ImportError as error:
        return str(error)
    return missing()


REASON = f"not tried in the real launch_ros, which is not here: {without()}"
in_launch = pytest.mark.skipif(bool(without()), reason=REASON)
HEAD = """\
from launch import LaunchDescription
from launch.actions import *
from launch.conditions import *
from launch.event_handlers import *
from launch.launch_description_sources import *
from launch.substitutions import *
from launch_ros.actions import *
from launch_ros.descriptions import *
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import *


def generate_launch_description():
    return LaunchDescription([
"""
NAMES = HEAD.count("\n")


# They are read in a process of their own, as by every command.
IN_THE_CHILD = (
    "test_a_node_is_under_the_group_that_has_it",
    "test_a_launch_file_that_cannot_be_read_is_one_line",
    "test_nothing_of_a_launch_file_stays",
    "test_without_launch_a_stand_in_reads_and_says_so",
)


@pytest.fixture(autouse=True)
def quick(
    request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch, tmp_path_factory: Any
) -> None:
    """Read in this process what the stand-in reads: a test is done in a hundredth of the time."""
    if without() and request.node.originalname not in IN_THE_CHILD:
        read_here(monkeypatch, tmp_path_factory.mktemp("launch"))


def read(folder: Path, actions: str, *arguments: tuple[str, str], roots: str = "") -> LaunchGraph:
    file = folder / "bringup.launch.py"
    file.write_text(f"{HEAD}{actions}\n    ])\n")
    return launch_graph(LaunchOrder(str(file), arguments, (roots,) if roots else (), True))


def one(graph: LaunchGraph) -> LaunchedNode:
    assert graph.notes == ()
    (node,) = graph.nodes
    return node


@pytest.mark.more
def test_a_node_is_under_the_group_that_has_it(tmp_path: Path) -> None:
    (tmp_path / "p.yaml").write_text("/**: {ros__parameters: {a: 1}}\n")
    found = one(
        read(
            tmp_path,
            f"""\
        DeclareLaunchArgument("robot", default_value="robot9"),
        GroupAction([
            PushROSNamespace(LaunchConfiguration("robot")),
            SetRemap("scan", "front/scan"),
            SetParameter("use_sim_time", True),
            Node(package="acme", executable="driver", name="d", namespace="left", arguments=["-v"],
                 parameters=[{str(tmp_path / "p.yaml")!r}, {{"rate": 5.0, "n": {{"m": "y"}}}}],
                 remappings=[("a", "b")]),
        ]),
        SetLaunchConfiguration("robot", "later"),""",
            ("robot", "robot1"),
        )
    )
    assert found[:4] == ("acme", "driver", "d", "/robot1/left")
    assert found.remappings == (("scan", "front/scan"), ("a", "b"))
    assert found.arguments == ("-v",)
    assert (Path(found.place.file).name, found.place.line) == ("bringup.launch.py", NAMES + 6)
    files = [it.file for it in found.parameters]
    assert files == ["", str(tmp_path / "p.yaml"), "", ""]
    assert "use_sim_time: True" in found.parameters[0].text
    assert "m: y" in found.parameters[3].text.replace("'", "")


def test_includes_get_their_arguments_and_conditions_decide(tmp_path: Path) -> None:
    (tmp_path / "inner.launch.xml").write_text(
        '<launch>\n  <arg name="which"/>\n'
        "  <node pkg=\"acme\" exec=\"one\" if=\"$(eval '\\'$(var which)\\' == \\'one\\'')\"/>\n"
        '  <node pkg="acme" exec="two" name="$(var which)"/>\n</launch>\n'
    )
    found = one(
        read(
            tmp_path,
            f"""\
        IncludeLaunchDescription({str(tmp_path / "inner.launch.xml")!r},
                                 launch_arguments=[("which", "other")]),
        Node(package="acme", executable="never", condition=IfCondition("false")),""",
        )
    )
    assert (found.executable, found.name, found.namespace) == ("two", "other", "/")
    assert (Path(found.place.file).name, found.place.line) == ("inner.launch.xml", 4)


IN_XML = fixture_text("launch_graph_in_xml.xml")
IN_YAML = fixture_text("launch_graph_in_yaml.txt")


@pytest.mark.parametrize(("name", "text"), [("a.launch.xml", IN_XML), ("a.launch.yaml", IN_YAML)])
def test_a_launch_file_in_xml_and_in_yaml(name: str, text: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text(text)
    graph = launch_graph(LaunchOrder(str(tmp_path / name), (("robot", "robot2"),), (), True))
    driver, _, part, command, late = graph.nodes
    assert (command.package, command.executable, command.arguments) == ("", "ls", ("-l",))
    assert driver[:4] == ("acme", "driver", "d", "/robot2")
    assert driver.arguments == ("--id", "robot2_a", "-v")
    assert driver.remappings == (("scan", "front/scan"), ("tf", "robot2/tf"))
    given: dict[str, object] = {}
    for it in driver.parameters:
        given |= yaml.safe_load(it.text)["/**"]["ros__parameters"]
    assert given == {"all": 1, "rate": 5.5, "word": "5", "list": [1, 2], "inner.on": True}
    assert (late.executable, late.namespace, bool(late.later)) == ("late", "/", True)
    assert (part.executable, part.name, part.container) == ("acme::Part", "part", "/box")
    assert not graph.notes


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ('<launch><node pkg="a" exec="b" nam="c"/></launch>', "Unexpected attribute"),
        ('<launch><node pkg="a" exec="b"><parm/></node></launch>', "Unexpected nested tag"),
        ('<launch><node pkg="a"/></launch>', "exec"),
        ('<launch><node pkg="a" exec="b" if="1" unless="1"/></launch>', "simultaneously"),
        (
            '<launch><node exec="b"><param name="a" value="1" type="string"/></node></launch>',
            "Got invalid type identifier 'string'",
        ),
        ('<launch><include file="$(find acme)/a.launch"/></launch>', "a launch file of ROS 1"),
        ('<launch><rosparam file="a.yaml"/></launch>', "a launch file of ROS 1"),
        ("<lunch/>", "Expected 'launch' as root tag"),
        ("<launch>", "launch"),
    ],
)
def test_a_wrong_launch_file_in_xml(text: str, fault: str, tmp_path: Path) -> None:
    file = tmp_path / "a.launch.xml"
    file.write_text(text)
    with pytest.raises(InputError) as caught:
        launch_graph(LaunchOrder(str(file), (), (), True))
    assert fault in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("value", "told"),
    [
        (
            "LaunchDescription([])",
            "NameError: name 'LaunchDescription' is not defined (a.launch.py:2)",
        ),
        (
            '__import__("launch_ros").actions.Node(executable="b", parameters=[{"a": None}])',
            "TypeError: Unexpected type for parameter value None (a.launch.py:2)",
        ),
    ],
)
def test_what_python_refuses_is_told_with_its_line(value: str, told: str, tmp_path: Path) -> None:
    file = tmp_path / "a.launch.py"
    file.write_text(f"def generate_launch_description():\n    return {value}\n")
    with pytest.raises(InputError) as caught:
        launch_graph(LaunchOrder(str(file), (), (), True))
    assert told in str(caught.value)


def test_components_are_in_their_container(tmp_path: Path) -> None:
    graph = read(
        tmp_path,
        """\
        PushROSNamespace("robot1"),
        ComposableNodeContainer(package="rclcpp_components", executable="component_container",
            name="box", namespace="", composable_node_descriptions=[
                ComposableNode(package="acme", plugin="acme::One", name="one"),
                ComposableNode(package="acme", plugin="acme::No", condition=IfCondition("0")),
            ]),
        LoadComposableNodes(target_container="/robot1/box", composable_node_descriptions=[
            ComposableNode(package="acme", plugin="acme::Two", name="two", namespace="in",
                           remappings=[("a", "b")]),
        ]),""",
    )
    assert graph.notes == ()
    box, first, second = graph.nodes
    assert (box.name, box.namespace, box.container) == ("box", "/robot1", "")
    assert first[1:4] == ("acme::One", "one", "/robot1")
    assert second[1:5] == ("acme::Two", "two", "/robot1/in", (("a", "b"),))
    assert {first.container, second.container} == {"/robot1/box"}


def test_functions_run_and_what_starts_later_says_so(tmp_path: Path) -> None:
    graph = read(
        tmp_path,
        """\
        OpaqueFunction(function=lambda context: [Node(package="acme", executable="f")]),
        TimerAction(period=5.0, actions=[Node(package="acme", executable="t")]),
        RegisterEventHandler(OnProcessExit(on_exit=[Node(package="acme", executable="e")])),
        RegisterEventHandler(OnProcessIO(on_stdout=lambda event: None)),
        RegisterEventHandler(OnShutdown(on_shutdown=[Node(package="acme", executable="end")])),
        LifecycleNode(package="acme", executable="l", name="l", namespace=""),
        ExecuteProcess(cmd=["ros2 run acme r", "--ros-args", "-r", "__node:=n", "-r", "a:=b"]),
        ExecuteProcess(cmd=["rm", "-rf", "build"]),""",
    )
    assert [(it.executable, bool(it.later)) for it in graph.nodes] == [
        ("f", False),
        ("l", False),
        ("r", False),
        ("rm", False),
        ("t", True),
        ("e", True),
    ]
    assert (graph.nodes[2].name, graph.nodes[2].remappings) == ("n", (("a", "b"),))
    assert [it.process.delay for it in graph.nodes] == [0.0, 0.0, 0.0, 0.0, 5.0, 0.0]
    (note,) = graph.notes
    assert (note.place.line, "run time" in note.message) == (NAMES + 4, True)


EVENTS = fixture_text("launch_graph_events.txt")


@in_launch
def test_what_starts_later_is_outside_of_its_group(tmp_path: Path) -> None:
    """As in the real launch: a group has ended by then, and a configuration has its last value."""
    file = tmp_path / "events.launch.py"
    file.write_text(EVENTS)
    programs = ("first", "second", "late", "last", "ended", "timed")
    told, _ = launched(file, tmp_path, programs=dict.fromkeys(programs, "acme"))
    real = [
        (
            Path(it["words"][0]).name,
            next((w[6:] for w in it["words"] if w.startswith("__ns:=")), "/"),
        )
        for it in told
    ]
    graph = launch_graph(LaunchOrder(str(file), (), (), True))
    assert graph.notes == ()
    found = [(it.executable, it.namespace) for it in graph.nodes]
    assert sorted(found) == sorted(real)
    assert found.count(("late", "/robot2")) == 2


AGAIN = """\
from launch import LaunchDescription
from launch.actions import OpaqueFunction, TimerAction
from launch_ros.actions import Node


def again(context):
    timer = TimerAction(period=1.0, actions=[OpaqueFunction(function=again)])
    return [Node(package="acme", executable="d"), timer]


def generate_launch_description():
    return LaunchDescription([OpaqueFunction(function=again)])
"""


def test_a_timer_knows_the_folder_of_its_launch_file(tmp_path: Path) -> None:
    """It keeps the locals of its place (timer_action.py), an event handler does not."""
    inner = 'Node(package="acme", executable="d", arguments=[ThisLaunchFileDir()])'
    graph = read(tmp_path, f"        TimerAction(period=1.0, actions=[{inner}]),")
    assert one(graph).arguments == (str(tmp_path),)


def test_a_timer_that_starts_itself_again_is_told(tmp_path: Path) -> None:
    file = tmp_path / "again.launch.py"
    file.write_text(AGAIN)
    graph = launch_graph(LaunchOrder(str(file), (), (), True))
    (note,) = graph.notes
    assert "again and again" in note.message
    assert 1 < len(graph.nodes) < 100


def test_a_configuration_that_is_gone_at_an_event_is_told(tmp_path: Path) -> None:
    late = 'Node(package="acme", executable="e", namespace=LaunchConfiguration("robot"))'
    event = f"RegisterEventHandler(OnProcessExit(on_exit=[{late}]))"
    actions = f'GroupAction([SetLaunchConfiguration("robot", "r"), {event}]),'
    (note,) = read(tmp_path, f'        Node(package="a", executable="b"),\n{actions}').notes
    assert note.message.startswith("at an event (OnProcessExit) the launch configuration")
    assert "'robot' is not set; groups and their launch configurations have ended" in note.message


def test_a_node_without_its_parameter_file_is_known(tmp_path: Path) -> None:
    """launch_ros warns of the file and starts the node (``_perform_substitutions`` of Node)."""
    graph = read(tmp_path, 'Node(package="acme", executable="d", parameters=["none.yaml"]),')
    assert [it.executable for it in graph.nodes] == ["d"]
    assert ([it.parameters for it in graph.notes], graph.whole) == ([True], True)


def test_nothing_is_started(tmp_path: Path) -> None:
    made = tmp_path / "made"
    command, found = read(
        tmp_path,
        f"""\
        ExecuteProcess(cmd=["touch", {str(made)!r}]),
        Node(package="acme", executable="d", parameters=[
            {{"robot_description": Command(["touch ", {str(made)!r}]), "rate": 1}}]),""",
    ).nodes
    assert (command.package, command.executable, command.arguments) == ("", "touch", (str(made),))
    assert not made.exists()
    assert any("rate: 1" in it.text for it in found.parameters)


def test_a_missing_package_is_named_and_found_in_its_sources(tmp_path: Path) -> None:
    share = 'FindPackageShare("acme_bringup")'
    include = f'        IncludeLaunchDescription([{share}, "/launch/a.launch.py"]),'
    (note,) = read(tmp_path, include).notes
    assert note.place.line == NAMES + 1
    assert "package 'acme_bringup' is not installed here" in note.message
    sources = tmp_path / "src" / "deep" / "bringup"
    (sources / "launch").mkdir(parents=True)
    (sources / "package.xml").write_text("<package><name>acme_bringup</name></package>")
    inner = HEAD + '        Node(package="acme", executable="d"),\n    ])\n'
    (sources / "launch" / "a.launch.py").write_text(inner)
    found = one(read(tmp_path, include, roots=str(tmp_path / "src")))
    assert found.place[:2] == (str(sources / "launch" / "a.launch.py"), NAMES + 1)


MISSING = """\
import os
from acme_tools import name
from acme_configs.builders import Builder
from ament_index_python.packages import get_package_share_directory
SHARE = get_package_share_directory("acme_files")
TEXT = open(os.path.join(SHARE, "urdf", "rover.urdf")).read()
CONFIG = Builder("arm", package="acme").of_file(os.path.join(SHARE, "a.yaml")).made()
"""


def test_a_package_that_a_function_misses_costs_its_part(tmp_path: Path) -> None:
    """Nodes that the function starts besides are read; the package is named once."""
    (tmp_path / "bringup.launch.py").write_text(
        HEAD.replace(
            "def generate_launch_description",
            "from launch.actions import OpaqueFunction\n"
            "from ament_index_python.packages import get_package_share_directory as share\n\n\n"
            "def later(context):\n"
            '    return [Node(package="acme", executable=share("acme_files") and "d")]\n\n\n'
            "def generate_launch_description",
        )
        + "        OpaqueFunction(function=later),\n    ])\n"
    )
    graph = launch_graph(LaunchOrder(str(tmp_path / "bringup.launch.py"), trusted=True))
    assert [it.executable for it in graph.nodes] == ["d"]
    assert ["acme_files" in it.message for it in graph.notes] == [True] and not graph.whole


@pytest.mark.parametrize("place", ['FindPackageShare("acme_gazebo")', "HERE"])
def test_a_launch_file_that_is_called_as_one_of_a_simulator_is_read(
    place: str, tmp_path: Path
) -> None:
    """It asks for the simulator's package, which is not here, as soon as it is read."""
    launch = tmp_path / "src/acme/launch"
    launch.mkdir(parents=True)
    (tmp_path / "src/acme/package.xml").write_text("<package><name>acme_gazebo</name></package>")
    ask = '    share = get_package_share_directory("gazebo_ros")\n    return'
    text = HEAD.replace("    return", ask).replace(
        "def gen", "from ament_index_python import get_package_share_directory\n\n\ndef gen"
    )
    own = '        IncludeLaunchDescription(share + "/launch/gazebo.launch.py"),\n'
    more = '        Node(package="acme", executable="d"),\n    ])\n'
    (launch / "gazebo.launch.py").write_text(f"{text}{own}{more}")
    where = place.replace("HERE", repr(str(tmp_path / "src/acme")))
    include = f'        IncludeLaunchDescription([{where}, "/launch/gazebo.launch.py"]),'
    graph = read(tmp_path, include, roots=str(tmp_path / "src"))
    assert [it.executable for it in graph.nodes] == ["gzserver", "d"]


def test_a_package_that_a_file_goes_on_without_is_named(tmp_path: Path) -> None:
    """What it starts with that package alone is in no graph."""
    tried = """from ament_index_python.packages import get_package_share_directory as share
try:
    share("acme_files")
    MORE = [Node(package="acme_files", executable="e")]
except LookupError:
    MORE = []
"""
    path = tmp_path / "bringup.launch.py"
    path.write_text(
        HEAD.replace("def generate_launch_description", f"{tried}\ndef generate_launch_description")
        + '        *MORE, Node(package="acme", executable="d"),\n    ])\n'
    )
    graph = launch_graph(LaunchOrder(str(path)))
    assert [it.executable for it in graph.nodes] == ["d"] and not graph.whole
    assert ["package 'acme_files' is not installed" in it.message for it in graph.notes] == [True]


def test_what_is_missing_costs_its_part(tmp_path: Path) -> None:
    """Packages and Python modules that are nowhere: the rest of the launch file is read."""
    (tmp_path / "bringup.launch.py").write_text(
        MISSING
        + HEAD
        + """\
        Node(package="acme", executable="d", parameters=[
            CONFIG.description, CONFIG.to_dict(), os.path.join(SHARE, "b.yaml"), {"rate": 1}]),
        IncludeLaunchDescription(os.path.join(SHARE, "launch", "a.launch.py")),
        name(CONFIG),
        Node(package="acme", executable="e"),
    ])
"""
    )
    graph = launch_graph(LaunchOrder(str(tmp_path / "bringup.launch.py"), trusted=True))
    assert [it.executable for it in graph.nodes] == ["d", "launch/a.launch.py", "e"]
    assert ["rate: 1" in it.text for it in graph.nodes[0].parameters].count(True) == 1
    told = [it.message for it in graph.notes]
    for package in ("acme_tools", "acme_configs", "acme_files"):
        assert any(f"package '{package}' is not installed here" in it for it in told), told
    assert not graph.whole and not any(it.fails for it in graph.notes)


@pytest.mark.parametrize(("made", "said"), [("None", "nothing"), ("[1]", "a value of type list")])
def test_a_launch_file_that_makes_no_description(made: str, said: str, tmp_path: Path) -> None:
    file = tmp_path / "odd.launch.py"
    file.write_text(f"def generate_launch_description():\n    return {made}\n")
    with pytest.raises(InputError) as caught:
        launch_graph(LaunchOrder(str(file), trusted=True))
    why = f"its generate_launch_description() returns {said}; return a LaunchDescription"
    assert str(caught.value) == f"{file}: the launch file cannot be read: {why}"


@pytest.mark.slow
@pytest.mark.skipif(not without(), reason="launch_ros is here")
@pytest.mark.skipif(not without(), reason="launch is here")
def test_without_launch_a_stand_in_reads_and_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = read(tmp_path, 'Node(package="acme", executable="driver", name="d"),')
    assert found.stood_in and one(found).name == "d"
    main(["check-launch", str(tmp_path / "bringup.launch.py")])
    assert (
        "launch is not installed here: a stand-in read the launch file" in capsys.readouterr().err
    )
    file = tmp_path / "bringup.launch.xml"
    file.write_text('<launch>\n <gz_server/>\n <node pkg="acme" exec="driver"/>\n</launch>')
    found = launch_graph(LaunchOrder(str(file), (), (), True))
    assert [it.message for it in found.notes] == [
        "NotImplementedError: <gz_server> is not read: it needs launch itself"
    ]
    assert [it.executable for it in found.nodes] == ["driver"]


def test_the_command_itself_imports_no_launch() -> None:
    assert "launch_ros" not in sys.modules or not without()


def test_the_file_of_a_rewritten_one_is_found(tmp_path: Path) -> None:
    source, name = tmp_path / "p.yaml", repr(str(tmp_path / "p.yaml"))
    source.write_text("/**:\n  ros__parameters: {rate: 5}\n")
    # As nav2_common's: ``name`` is what it reads, and what it makes is a temporary file.
    made = """
import tempfile
class RewrittenYaml(Substitution):
    def __init__(self, name):
        super().__init__()
        self.name = [TextSubstitution(text=name)] if isinstance(name, str) else [name]
    def perform(self, context):
        with open(self.name[0].perform(context)) as old:
            with tempfile.NamedTemporaryFile("w", delete=False) as new:
                new.write("# made\\n" + old.read())
        return new.name
"""
    head = f"from launch import Substitution{made}"
    file = tmp_path / "bringup.launch.py"
    nodes = f"Node(package='a', executable='b', parameters=[RewrittenYaml(RewrittenYaml({name}))])"
    file.write_text(
        f"{HEAD.partition('def generate')[0]}{head}\ndef generate_launch_description():\n"
        f"    return LaunchDescription([{nodes}])\n"
    )
    (given,) = one(launch_graph(LaunchOrder(str(file), (), (), True))).parameters
    assert (given.file, given.source) == ("", str(source))
    assert given.text.startswith("# made\n# made\n")


def test_a_launch_file_sees_the_command_line_of_ros2_launch(tmp_path: Path) -> None:
    """As nav2_common's ParseMultiRobotPose looks at it."""
    file = tmp_path / "bringup.launch.py"
    file.write_text(
        "import sys\n"
        "from launch import LaunchDescription\n"
        "from launch_ros.actions import Node\n"
        "def generate_launch_description():\n"
        "    names = sys.argv[4].partition(':=')[2].split(';')\n"
        "    return LaunchDescription([\n"
        "        Node(package='a', executable='b', namespace=it) for it in names])\n"
    )
    order = LaunchOrder(str(file), (("robots", "r1;r2"),), (), True, "my_package")
    assert [it.namespace for it in launch_graph(order).nodes] == ["/r1", "/r2"]


def test_the_text_of_a_file_that_the_launch_makes_is_kept(tmp_path: Path) -> None:
    made = "tempfile.NamedTemporaryFile('w', suffix='.yaml', delete=False)"
    file = tmp_path / "bringup.launch.py"
    file.write_text(
        "import tempfile\n"
        "from launch import LaunchDescription\n"
        "from launch_ros.actions import Node\n"
        "def generate_launch_description():\n"
        f"    with {made} as out:\n"
        "        out.write('- {topic_name: scan}\\n')\n"
        "    bridge = {'parameters': [{'config_file': out.name}]}\n"
        "    return LaunchDescription([\n"
        "        Node(package='ros_gz_bridge', executable='parameter_bridge', **bridge)])\n"
    )
    (node,) = launch_graph(LaunchOrder(str(file), (), (), True)).nodes
    assert "- {topic_name: scan}\n" in [it.text for it in node.parameters]


XACRO = """\
<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="rover"><xacro:arg name="end" default="tip"/>
<link name="base_link"/><link name="$(arg end)"/><joint name="j" type="fixed">
<parent link="base_link"/><child link="$(arg end)"/></joint></robot>
"""
COMMANDS = """\
["xacro ", FILE, " end:=", "lidar"]
[FindExecutable(name="xacro"), " ", FILE, " -o here.urdf end:=a"]
["urdf-postfix ", FILE, " robot1 end:=eye --layout postfix"]
["urdf-postfix ", FILE, " robot1 -o there.urdf"]
["touch there.urdf"]
["xacro /nowhere.xacro"]
"""


@pytest.mark.slow
def test_the_output_of_commands_is_known_and_nothing_is_started(tmp_path: Path) -> None:
    file, plain = tmp_path / "rover.urdf.xacro", tmp_path / "plain.txt"
    file.write_text(XACRO)
    plain.write_text("wheel: left: 1")
    there = str(tmp_path / "there.urdf")
    lines = COMMANDS.replace("FILE", repr(str(file))).replace("there.urdf", there).splitlines()
    texts = [f"ParameterValue(Command({it}), value_type=str)" for it in lines]
    nodes = [
        f'        Node(package="a", executable="b", parameters=[{{"text": {it}}}]),'
        for it in (*texts, f"Command(['cat ', {str(plain)!r}])")
    ]
    before = {*tmp_path.iterdir()}
    graph = read(tmp_path, "\n".join(nodes))
    values = [
        yaml.safe_load(it.parameters[0].text)["/**"]["ros__parameters"]["text"]
        for it in graph.nodes
        if it.parameters and not it.parameters[0].untold
    ]
    xacro, unknown, postfix, other, touch, nowhere = values
    assert '<child link="lidar"/>' in xacro
    assert '<child link="eye/robot1"/>' in postfix
    # Options that write a file, and other programs: their output is not known.
    assert (unknown, other, touch, nowhere) == ("", "", "", "")
    # launch_ros refuses a text that is no YAML, and says what to do.
    note, fault = graph.notes
    assert fault.parameters and "'xacro /nowhere.xacro'" in fault.message
    assert "/nowhere.xacro: cannot be read" in fault.message
    assert note.parameters and "as yaml" in note.message and "value_type=str" in note.message
    made = {it for it in tmp_path.iterdir() if it.name != "__pycache__"}
    assert made - before == {tmp_path / "bringup.launch.py"}


TWO = fixture_text("launch_graph_two.txt")


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("rules", "code"),
    [("[]", 1), ("[('/tf', 'tf'), ('/tf_static', 'tf_static')]", 0), ("[('/tf', '1tf')]", 3)],
)
def test_the_whole_command(
    rules: str, code: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Two robots whose descriptions a xacro makes: on one /tf, apart, with a rule that rcl refuses."""
    (tmp_path / "rover.urdf.xacro").write_text(XACRO)
    file = tmp_path / "two.launch.py"
    file.write_text(TWO.replace("RULES", rules))
    plan = tmp_path / "plan.yaml"
    assert main(["check-launch", str(file), "--distro", "jazzy"]) == code
    told = capsys.readouterr()
    assert ("MG402" in told.out) == (code == 1)
    assert ("rcl refuses 2 nodes" in told.err) == (code == 3)
    assert "description is not known" not in told.err
    if code == 0:
        words = ["plan", str(file), "--distro", "jazzy", "-o", str(plan)]
        assert main(words) == 0
        assert "tip" in plan.read_text()
        other = tmp_path / "other.launch.py"
        other.write_text(TWO.replace("RULES", "[]"))
        assert main(["check-launch", str(other), "--plan", str(plan), "--distro", "jazzy"]) == 1
        told = capsys.readouterr().out
        assert "MG402" in told and "should publish topic /robot1/tf" in told


@pytest.mark.more
@pytest.mark.parametrize(
    "name", ["two.launch.py", "three.launch.py", pytest.param("three.launch.xml", marks=in_launch)]
)
def test_actions_for_robots_are_read_with_their_names(name: str) -> None:
    """Their names are known when they run: of two robots with everything of their own."""
    file = ROOT / "examples" / "launch_tutorial" / name
    graph = launch_graph(LaunchOrder(str(file), (), (), True))
    state = [it for it in graph.nodes if it.package == "robot_state_publisher"]
    assert [(it.namespace, it.name) for it in state] == [
        ("/robot1", "robot_state_publisher"),
        ("/robot2", "robot_state_publisher"),
    ]
    for robot, it in zip(("robot1", "robot2"), state, strict=True):
        assert any(f"{robot}/base_link" in text.text for text in it.parameters)
        assert it.place.file == str(file)
        assert it.place.line > 1 or file.suffix == ".xml"
    placed = [it for it in graph.nodes if it.package == "tf2_ros"]
    assert [it.name for it in placed] == ["start_pose", "start_pose"]
    words = ["check-launch", str(file), "--plan", str(file.with_name("fleet.yaml"))]
    assert main(words) == 0


# By launch jazzy, substitutions/ and utilities/type_utils.py.
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("made", "said"),
    [
        ("AndSubstitution('true', '0')", "false"),
        ("OrSubstitution('false', 'true')", "true"),
        ("AnySubstitution('false', 'on', '0')", "true"),
        ("AllSubstitution('true', 'no')", "false"),
        ("NotSubstitution('1')", "false"),
        ("EqualsSubstitution('1', 'True')", "true"),
        ("EqualsSubstitution(2, '2.0')", "true"),
        ("NotEqualsSubstitution(None, '')", "false"),
        ("IfElseSubstitution('false', 'a')", ""),
        ("IfElseSubstitution(EqualsSubstitution('x', 'x'), 'a', 'b')", "a"),
        ("LocalSubstitution('current_launch_file_path[-3:]')", ".py"),
        (
            "[LaunchConfiguration('no', default=5), EnvironmentVariable('NO', default_value='z')]",
            "5z",
        ),
        ("launch_ros.substitutions.Parameter('rate', default=5)", "5"),
    ],
)
def test_a_substitution_has_the_value_that_launch_gives_it(
    tmp_path: Path, made: str, said: str
) -> None:
    node = f"Node(package='a', executable='b', arguments=[{made}]),"
    file = tmp_path / "bringup.launch.py"
    file.write_text(f"import launch_ros.substitutions\n{HEAD}{node}\n    ])\n")
    found = one(launch_graph(LaunchOrder(str(file), (), (), True)))
    assert found.arguments == (said,)


# launch jazzy, actions/append_environment_variable.py, group_action.py (a group pushes them).
def test_variables_are_those_of_their_group(tmp_path: Path) -> None:
    graph = read(
        tmp_path,
        """
        SetEnvironmentVariable('HOW', 'a'),
        GroupAction([
            AppendEnvironmentVariable('HOW', 'b', separator='-'),
            AppendEnvironmentVariable('HOW', 'c', prepend=True, separator='+'),
            Node(package='a', executable='b', name=EnvironmentVariable('HOW')),
            UnsetEnvironmentVariable('HOW'),
            Node(package='a', executable='b',
                 name=EnvironmentVariable('HOW', default_value='none')),
        ]),
        Node(package='a', executable='b', name=EnvironmentVariable('HOW')),""",
    )
    assert [it.name for it in graph.nodes] == ["c+a-b", "none", "a"]


# launch jazzy, group_action.py, reset_launch_configurations.py, unset_launch_configuration.py.
def test_launch_configurations_are_set_and_forgotten(tmp_path: Path) -> None:
    said = "Node(package='a', executable='b', name=LaunchConfiguration('x', default='none')),"
    graph = read(
        tmp_path,
        f"""
        SetLaunchConfiguration('x', 'one'),
        GroupAction([{said}], forwarding=False),
        GroupAction([UnsetLaunchConfiguration('x'), {said}]),
        {said}
        GroupAction([{said}], scoped=False, launch_configurations={{'x': 'two'}}),
        {said}
        ResetLaunchConfigurations({{'x': [LaunchConfiguration('x'), '3']}}),
        {said}
        Node(package='a', executable='b', name='equal',
             condition=LaunchConfigurationEquals('x', 'two3')),
        Node(package='a', executable='b', name='unset',
             condition=LaunchConfigurationNotEquals('y', None)),""",
    )
    assert [it.name for it in graph.nodes] == [
        *("none", "none", "one", "two", "two", "two3"),
        "equal",
    ]


# launch_ros jazzy, utilities/normalize_parameters.py and evaluate_parameters.py.
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("given", "kept"),
    [
        ("'5'", "5"),
        ("LaunchConfiguration('n', default='5')", 5),
        ("['5', LaunchConfiguration('n', default='5')]", 55),
        ("[1, 2.5]", [1.0, 2.5]),
        ("['a', '1']", ["a", "1"]),
        ("['a', [LaunchConfiguration('n', default='b')]]", ["a", "b"]),
        ("ParameterValue(LaunchConfiguration('n', default='5'), value_type=str)", "5"),
        ("ParameterValue('1', value_type=str)", "1"),
    ],
)
def test_a_parameter_has_the_type_that_launch_gives_it(
    tmp_path: Path, given: str, kept: object
) -> None:
    found = one(
        read(
            tmp_path, f"Node(package='a', executable='b', parameters=[{{'p': {{'q': {given}}}}}]),"
        )
    )
    (text,) = found.parameters
    values = yaml.safe_load(text.text)["/**"]["ros__parameters"]
    assert values == {"p.q": kept} and type(values["p.q"]) is type(kept)


@pytest.mark.parametrize(
    ("value", "told", "unset"),
    [
        ("LaunchConfiguration('n', default='a: b: c')", "try wrapping it", False),
        ("LaunchConfiguration('none')", "'none' is not set; give it with none:=VALUE", True),
    ],
)
def test_a_value_that_is_none_is_told_and_the_others_are_kept(
    value: str, told: str, unset: bool, tmp_path: Path
) -> None:
    """launch_ros jazzy, evaluate_parameters.py: what is no YAML is an error."""
    values = f"{{'p': {value}, 'q': '1'}}"
    graph = read(tmp_path, f"Node(package='a', executable='b', parameters=[{values}]),")
    (note,) = graph.notes
    assert (note.parameters, note.file, note.fails, note.unset) == (True, "", False, unset)
    assert told in note.message
    (node,) = graph.nodes
    assert [it.untold for it in node.parameters] == ["p", ""]
    assert yaml.safe_load(node.parameters[1].text) == {"/**": {"ros__parameters": {"q": "1"}}}


@pytest.mark.parametrize(
    ("command", "package"),
    [
        ("gz", "ros_gz_sim"), ("ign", "ros_gz_sim"), ("gazebo", "gazebo_ros"),
        ("/usr/bin/gzserver", "gazebo_ros"), ("gzclient", ""), ("ros2", ""), ("", ""),
    ],
)  # fmt: skip
def test_a_command_that_is_a_simulator_is_a_node(
    command: str, package: str, tmp_path: Path
) -> None:
    process = f"ExecuteProcess(cmd=[{command!r}, '-s -r', 'a.sdf'])"
    *made, _ = read(tmp_path, f"{process}, Node(package='a', executable='b'),").nodes
    found = [(it.package, it.executable, it.name, it.namespace, it.arguments) for it in made]
    words = ("-s", "-r", "a.sdf")
    other = [("", command, "", "/", ("-s -r", "a.sdf"))] if command else []
    assert found == ([(package, "gzserver", "", "/", words)] if package else other)


# launch jazzy, include_launch_description.py: it looks for arguments before anything is started.
@pytest.mark.parametrize("given", ["", "launch_arguments=[('ip', '1')]"])
def test_an_include_without_a_required_argument_starts_nothing(tmp_path: Path, given: str) -> None:
    inner = tmp_path / "inner.launch.py"
    own = "GroupAction([DeclareLaunchArgument('ip', description='Its address')]),"
    inner.write_text(f"{HEAD}Node(package='a', executable='b'), {own}\n    ])\n")
    graph = read(tmp_path, f"IncludeLaunchDescription({str(inner)!r}, {given}),")
    missing = "missing required argument 'ip' (description: 'Its address')"
    assert [missing in it.message for it in graph.notes] == ([] if given else [True])
    assert len(graph.nodes) == bool(given)


def test_an_argument_below_a_condition_need_not_be_given(tmp_path: Path) -> None:
    """launch jazzy, launch_description.py: get_launch_arguments passes such actions over."""
    inner = tmp_path / "inner.launch.py"
    own = "GroupAction([DeclareLaunchArgument('ip')], condition=IfCondition('false')),"
    inner.write_text(f"{HEAD}Node(package='a', executable='b'), {own}\n    ])\n")
    graph = read(tmp_path, f"IncludeLaunchDescription({str(inner)!r}),")
    assert (len(graph.nodes), graph.notes) == (1, ())


# launch jazzy, share/launch/frontend/grammar.lark.
def test_substitutions_in_a_parameter_file_are_read(tmp_path: Path) -> None:
    (tmp_path / "p.yaml").write_text(
        "/**:\n  ros__parameters:\n    a: $(var one)\n    b: $(not $(var yes))\n"
        "    c: \"$(env NOWHERE 'x y')\"\n    d: $(if $(equals $(var one) 1) 'a b' c)\n"
        "    e: \\$(var one) $x\n"
    )
    file = str(tmp_path / "p.yaml")
    found = one(
        read(
            tmp_path,
            f"""SetLaunchConfiguration('one', '1'), SetLaunchConfiguration('yes', 'true'),
        Node(package='a', executable='b', parameters=[ParameterFile({file!r}, allow_substs=True)]),""",
        )
    )
    (text,) = found.parameters
    values = yaml.safe_load(text.text)["/**"]["ros__parameters"]
    assert values == {"a": 1, "b": False, "c": "x y", "d": "a b", "e": "$(var one) $x"}


@pytest.mark.sample(1)
@pytest.mark.parametrize("coroutine", ["OpaqueCoroutine(coroutine=None)", "launch.LaunchService()"])
@pytest.mark.skipif(not without(), reason="launch is here")
def test_what_the_stand_in_does_not_read_has_its_name_in_a_note(
    tmp_path: Path, coroutine: str
) -> None:
    file = tmp_path / "bringup.launch.py"
    file.write_text(f"import launch\n{HEAD}{coroutine},\n    ])\n")
    (note,) = launch_graph(LaunchOrder(str(file), (), (), True)).notes
    assert "OpaqueCoroutine" in note.message or "LaunchService" in note.message


@pytest.mark.slow
@pytest.mark.parametrize("waits", [False, True])
def test_nothing_of_a_launch_file_stays(
    waits: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A program that it starts itself, folders for what it makes; whether it ends or is ended."""
    made, file, number = tmp_path / "made", tmp_path / "a.launch.py", tmp_path / "number"
    made.mkdir()
    monkeypatch.setattr(child, "SECONDS", 3 if waits else 120)
    monkeypatch.setattr("tempfile.tempdir", str(made))
    started = f"subprocess.Popen(['sleep', '987'], cwd={str(tmp_path)!r})"
    kept = f"open({str(number)!r}, 'w').write(str({started}.pid))"
    file.write_text(f"import subprocess, time\n{kept}\ntime.sleep({987 if waits else 0})\n")
    with pytest.raises(InputError, match="took more than 3 s" if waits else "cannot be read"):
        launch_graph(LaunchOrder(str(file), (), (), True))
    assert not [*made.iterdir()]
    wait_until(lambda: not runs(number.read_text()))


def runs(process: str) -> bool:
    """Not as one that has ended, which nobody asks for."""
    with suppress(OSError):
        return bool(Path("/proc", process, "cmdline").read_bytes())
    return False
