# SPDX-License-Identifier: Apache-2.0
"""Every process of a launch file is in the fleet: started as the vendor starts it, for each robot."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
import yaml
from paths import fixture_text
from rule_examples import DESCRIPTION

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.producers.launch.performed import Action, Launching, performed

AFFIX = {
    "postfix": "postfix",
    **dict.fromkeys(("both", "tf-per-robot", "frames-per-robot"), "prefix"),
}
FLEET = """\
layout: {layout}
affix: {affix}
distro: jazzy
launch: up.launch.py
{more}
robots:
  - {{name: robot1, description: robot.urdf}}
  - {{name: robot2, description: robot.urdf}}
"""
WEIGHED = """<link name="{}"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>"""
LAUNCH = fixture_text("launched_processes_launch.txt")


def actions(
    folder: Path,
    body: str,
    setup: str = "first = here('first')",
    more: str = "simulator: none",
    layout: str = "both",
    given: dict[str, str] | None = None,
) -> list[Action]:
    """Return what the launch file of a build does, but for its own arguments."""
    text = LAUNCH.replace("SETUP", setup).replace("BODY", body)
    description = DESCRIPTION
    for link in ("base_link", "lidar_link", "wheel") if "gazebo" in more else ():
        description = description.replace(f'<link name="{link}"/>', WEIGHED.format(link))
    (folder / "robot.urdf").write_text(description)
    (folder / "up.launch.py").write_text(text)
    (folder / "fleet.yaml").write_text(FLEET.format(more=more, layout=layout, affix=AFFIX[layout]))
    assert main(["build", str(folder / "fleet.yaml"), "-o", str(folder / "out")]) == 0
    lasts(folder / "out")
    launches = [Launching(given or {"robots": "robot2"})]
    (done,) = performed(str(folder / "out/fleet.launch.py"), launches)
    assert not done.error
    return [it for it in done.actions if it.kind != "DeclareLaunchArgument"]


def lasts(folder: Path) -> None:
    """Nothing that is written has what is there only while launch files are read."""
    files = [it for it in folder.rglob("*") if it.is_file()]
    texts = [it.read_text(errors="replace") for it in files]
    for word in ("multibot_launch_", "python/object", "unknown_modules", "made_by_the_launch"):
        assert not [it for it, text in zip(files, texts, strict=True) if word in text], word


def told(found: Sequence[Action]) -> list[str]:
    """Return the actions in their order, by what they start; without the robot_state_publisher."""
    words = [_word(it) for it in found]
    return [it for it in words if it != "robot_state_publisher"]


def _word(it: Action) -> str:
    first = it.values.get("executable") or it.values.get("cmd", [it.kind])[0]
    target = it.values.get("target_action", {}).get("executable", "")
    return f"{it.kind} of {target}" if target else str(first)


def of(found: Sequence[Action], word: str) -> dict[str, Any]:
    """Return the values of the one action that starts something."""
    (values,) = (it.values for it in found if _word(it) == word)
    return dict(values)


def test_a_command_is_started_for_each_robot(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    body = """
        ExecuteProcess(cmd=['MicroXRCEAgent', 'serial', '--dev', '/dev/ttyS1'], cwd='/srv',
            additional_env={'LEVEL': '4'}, respawn=True, respawn_delay=2.5, prefix='nice'),
        ExecuteProcess(cmd=['cat /proc/uptime | wc'], shell=True),
    """
    found = actions(tmp_path, body, given={"robots": "2"})
    every = [it.values for it in found if it.kind == "ExecuteProcess"]
    agent = {
        "cmd": ["MicroXRCEAgent", "serial", "--dev", "/dev/ttyS1"],
        "additional_env": {"LEVEL": "4"},
        **{"prefix": "nice", "respawn": True, "respawn_delay": 2.5, "cwd": "/srv"},
        **{"output": "screen", "environment": {}},
    }
    shell = {"cmd": ["cat /proc/uptime | wc"], "shell": True, "output": "screen", "environment": {}}
    assert every == [agent, shell, agent, shell]
    said = capsys.readouterr().err
    assert said.count("MF859") == 2
    assert "process MicroXRCEAgent (MicroXRCEAgent, serial, --dev" in said
    assert "2 other processes started as they are" in said


PACKAGE = "<package><name>own</name></package>"
SCRIPT_BY = (
    "lib('own'), '/lib/own/a.py'",
    "share('own'), '/../../lib/own/a.py'",
    "run('a.py', 'own')",
)


@pytest.mark.parametrize("found", SCRIPT_BY)
def test_a_program_of_a_package_that_is_not_built_is_found_when_it_starts(
    found: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Where it is installed is known then: its package is here as sources alone."""
    (tmp_path / "package.xml").write_text(PACKAGE)
    setup = "from launch_ros.substitutions import ExecutableInPackage as run, FindPackagePrefix as "
    setup += "lib, FindPackageShare as share"
    body = f"ExecuteProcess(cmd=['python3', [{found}], '9']),"
    every = [it.values for it in actions(tmp_path, body, setup) if it.kind == "ExecuteProcess"]
    assert [it["cmd"] for it in every] == [["python3", "/own/lib/own/a.py", "9"]]
    said = capsys.readouterr().err
    assert "process a.py (python3, " in said
    assert "MF823 " not in said.replace("MF823 launch is not installed here", "")


def test_a_command_runs_once_where_the_fleet_file_says_so(tmp_path: Path) -> None:
    body = "ExecuteProcess(cmd=['MicroXRCEAgent']), ExecuteProcess(cmd=['ros2', 'bag', 'record']),"
    found = told(actions(tmp_path, body, given={"robots": "2"}))
    assert (found.count("MicroXRCEAgent"), found.count("ros2")) == (2, 1)
    more = "simulator: none\nshared_nodes: [MicroXRCEAgent]\nown_nodes: [ros2]"
    found = told(actions(tmp_path, body, more=more, given={"robots": "2"}))
    assert (found.count("MicroXRCEAgent"), found.count("ros2")) == (1, 2)


def test_a_script_of_a_shell_is_called_by_its_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    actions(tmp_path, "ExecuteProcess(cmd=['python3', '-u', '/opt/acme/wheels.py', '--fast']),")
    assert "process wheels.py (python3, -u" in capsys.readouterr().err


ORDER = """
        RegisterEventHandler(OnProcessExit(target_action=first, on_exit=[
            here('second'),
            TimerAction(period=2.0, actions=[here('third')]),
        ])),
        RegisterEventHandler(OnProcessStart(target_action=first, on_start=[
            ExecuteProcess(cmd=['beep'])])),
        first,
        TimerAction(period=4.0, actions=[here('late', on_exit=[here('last')])]),
"""


@pytest.mark.parametrize("layout", ["both", "tf-per-robot", "frames-per-robot", "postfix"])
def test_order_and_delays_are_those_of_the_vendor(tmp_path: Path, layout: str) -> None:
    found = actions(tmp_path, ORDER, layout=layout)
    assert told(found) == [
        *("OnProcessStart of first", "beep", "end"),
        *("OnProcessExit of first", "second", "TimerAction", "third", "end", "end"),
        "first",
        *("TimerAction", "OnProcessExit of late", "last", "end", "late", "end"),
    ]
    assert [it.values["period"] for it in found if it.kind == "TimerAction"] == [2.0, 4.0]


def test_what_waits_for_a_process_that_is_not_there_starts_at_once(tmp_path: Path) -> None:
    """The build puts robots into their simulator itself; output of a process is no event of it."""
    body = """
        RegisterEventHandler(OnProcessExit(target_action=never, on_exit=[here('second')])),
        RegisterEventHandler(OnProcessIO(target_action=first, on_stdout=lambda event: None)),
        first, never,
    """
    setup = "first = here('first'); never = here('never', condition=IfCondition('false'))"
    assert told(actions(tmp_path, body, setup)) == ["first", "second"]


def test_a_process_in_a_domain_of_its_own_starts_later_in_it(tmp_path: Path) -> None:
    """What a timer starts is outside of the group that sets the domain (launch_service.py)."""
    more = "simulator: none\ndomains: {robot1: 11, robot2: 12}"
    found = actions(tmp_path, ORDER, more=more)
    for word in ("second", "third", "late", "last", "beep"):
        assert of(found, word)["additional_env"] == {"ROS_DOMAIN_ID": "12"}
    assert "additional_env" not in of(found, "first")


INCLUDE = """
        GroupAction([
            PushRosNamespace('front'),
            SetEnvironmentVariable('SIDE', 'left'),
            IncludeLaunchDescription(
                PathJoinSubstitution([FindPackageShare('lidar_x'), 'launch', 'x.launch.py']),
                launch_arguments={'port': '/dev/ttyUSB1', 'id': WHO}.items()),
        ]),
"""


@pytest.mark.parametrize(
    ("layout", "space", "rules"),
    [
        ("both", "/robot2/front", [["/tf", "tf"], ["/tf_static", "tf_static"]]),
        ("tf-per-robot", "/robot2/front", [["/tf", "tf"], ["/tf_static", "tf_static"]]),
        ("frames-per-robot", "/robot2/front", []),
    ],
)
def test_a_launch_file_that_is_not_here_is_included_for_each_robot(
    layout: str,
    space: str,
    rules: list[list[str]],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    body = INCLUDE.replace("WHO", "'7'")
    found = actions(tmp_path, body, layout=layout)
    values = of(found, "IncludeLaunchDescription")
    assert values.pop("remappings", []) == rules
    assert values == {
        "launch_description_source": "/lidar_x/share/lidar_x/launch/x.launch.py",
        "launch_arguments": [["port", "/dev/ttyUSB1"], ["id", "7"]],
        "namespace": space,
        "environment": {"SIDE": "left"},
    }
    said = capsys.readouterr().err
    assert "package 'lidar_x' is not installed here" in said
    assert "build starts it in each robot's namespace" in said
    assert "1 part of launch files not read" in said


def test_an_argument_of_an_include_may_name_the_robot(tmp_path: Path) -> None:
    body = f"DeclareLaunchArgument('who', default_value=''), {INCLUDE}"
    body = body.replace("WHO", "['unit_', LaunchConfiguration('who')]")
    found = actions(tmp_path, body, given={"robots": "2"})
    # Nothing of the launch file names a robot here.
    assert {
        it.values["launch_arguments"][1][1] for it in found if "launch_arguments" in it.values
    } == {"unit_"}
    text = (tmp_path / "fleet.yaml").read_text()
    (tmp_path / "fleet.yaml").write_text(
        text.replace("up.launch.py", '"up.launch.py who:={robot}"')
    )
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "out")]) == 0
    (done,) = performed(str(tmp_path / "out/fleet.launch.py"), [Launching({})])
    given = [
        it.values["launch_arguments"] for it in done.actions if "launch_arguments" in it.values
    ]
    assert [it[1] for it in given] == [["id", "unit_robot1"], ["id", "unit_robot2"]]


def test_the_environment_of_a_launch_is_that_of_all(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("OLD_PATH", "/old")
    body = """
        SetEnvironmentVariable('RMW', 'zenoh'),
        AppendEnvironmentVariable('OLD_PATH', '/more'),
        SetEnvironmentVariable('GZ_SIM_RESOURCE_PATH', '/meshes'),
        here('first'),
        GroupAction([SetEnvironmentVariable('SIDE', 'left'), here('second')]),
    """
    found = actions(tmp_path, body, "__import__('os').environ['MODE'] = 'fast'")
    common = {
        "MODE": "fast",
        "RMW": "zenoh",
        "OLD_PATH": "/more",
        "GZ_SIM_RESOURCE_PATH": "/meshes",
    }
    assert of(found, "first")["environment"] == common
    assert "additional_env" not in of(found, "first")
    assert of(found, "second")["additional_env"] == {"SIDE": "left"}
    printed = (tmp_path / "out/fleet.launch.py").read_text()
    assert "AppendEnvironmentVariable('OLD_PATH', '/more')" in printed
    assert "AppendEnvironmentVariable('GZ_SIM_RESOURCE_PATH', '/meshes')" in printed
    assert "SetEnvironmentVariable('RMW', 'zenoh')" in printed


def test_values_of_known_nodes_are_given_with_the_names_of_the_robot(tmp_path: Path) -> None:
    body = """
        Node(package='robot_state_publisher', executable='robot_state_publisher',
            parameters=[{'robot_description': 'x', 'publish_frequency': 50.0}], respawn=True),
        Node(package='slam_toolbox', executable='async_slam_toolbox_node', name='slam',
            parameters=[{'base_frame': 'base_link', 'max_laser_range': 7.5}]),
        Node(package='tf2_ros', executable='static_transform_publisher',
            arguments=['0', '0', '1', '0', '0', '0', 'base_link', 'mast']),
        Node(package='tf2_ros', executable='static_transform_publisher',
            arguments=['--z', '1', '--frame-id', 'mast', '--child-frame-id', 'eye']),
        here('omni.py', parameters=[{'odom_frame_id': 'odom', 'base_frame_id': 'base_link'}]),
    """
    found = actions(tmp_path, body, layout="frames-per-robot")
    state = of(found, "robot_state_publisher")
    assert state["parameters"][0] == {"publish_frequency": 50.0} and state["respawn"] is True
    slam = of(found, "async_slam_toolbox_node")
    # By default both would have one odom.
    assert slam["parameters"][0] == {
        **{"base_frame": "robot2/base_link", "max_laser_range": 7.5},
        "odom_frame": "robot2/odom",
    }
    one, other = (it.values for it in found if _word(it) == "static_transform_publisher")
    assert one["arguments"][-2:] == ["robot2/base_link", "robot2/mast"]
    assert other["arguments"][2:] == [
        *("--frame-id", "robot2/mast", "--child-frame-id", "robot2/eye"),
    ]
    assert one["name"] != other["name"]
    own = {"odom_frame_id": "robot2/odom", "base_frame_id": "robot2/base_link"}
    assert of(found, "omni.py")["parameters"][0] == own


def test_a_container_is_the_one_of_the_vendor(tmp_path: Path) -> None:
    body = """
        ComposableNodeContainer(package='rclcpp_components', executable='component_container_mt',
            name='box', namespace='front', composable_node_descriptions=[
                ComposableNode(package='q', plugin='q::Q', name='part',
                    parameters=[{'rate': 1.5, 'frame_id': 'base_link'}])]),
    """
    box = of(actions(tmp_path, body, layout="tf-per-robot"), "component_container_mt")
    assert (box["namespace"], box["name"]) == ("/robot2/front", "box")
    (part,) = box["composable_node_descriptions"]
    assert (part["plugin"], part["name"]) == ("q::Q", "part")
    assert part["parameters"][0] == {"rate": 1.5, "frame_id": "base_link"}


def test_two_nodes_of_one_name_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    row = "Node(package='acme', executable='{}', name='eyes'),\n"
    body = "".join(map(row.format, ("eyes", "eyes", "ears")))
    found = told(actions(tmp_path, body))
    assert found == ["eyes", "ears"]
    said = [it for it in capsys.readouterr().err.splitlines() if "MF860" in it]
    assert len(said) == 2 and "node eyes is started twice, also in up.launch.py" in said[0]


def test_two_nodes_without_a_name_both_run(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    body = "here('eyes', arguments=['left']), here('eyes', arguments=['right']),"
    every = [it.values for it in actions(tmp_path, body) if _word(it) == "eyes"]
    assert [it["arguments"] for it in every] == [["left"], ["right"]]
    # What the code calls the first one is not known; two of one name would disturb each other.
    assert [it.get("name") for it in every] == [None, "eyes_2"]
    assert "MF860" not in capsys.readouterr().err


def test_robots_with_different_bringups_have_each_its_own(tmp_path: Path) -> None:
    other = LAUNCH.replace("SETUP", "pass").replace(
        "BODY", "ExecuteProcess(cmd=['winch']), here('crane', prefix='nice'),"
    )
    (tmp_path / "crane.launch.py").write_text(other)
    text = FLEET.replace("name: robot2,", "name: robot2, launch: crane.launch.py,")
    fleet = text.format(more="simulator: none", layout="both", affix="prefix")
    actions(tmp_path, "here('first'), ExecuteProcess(cmd=['agent']),")
    (tmp_path / "fleet.yaml").write_text(fleet)
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "out")]) == 0
    (done,) = performed(str(tmp_path / "out/fleet.launch.py"), [Launching({})])
    found = [it for it in done.actions if it.kind != "DeclareLaunchArgument"]
    assert told(found) == ["first", "agent", "winch", "crane"]
    assert of(found, "crane")["prefix"] == "nice"


def test_one_device_for_two_robots_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    body = """
        DeclareLaunchArgument('who', default_value='x'),
        ExecuteProcess(cmd=['MicroXRCEAgent', 'serial', '--dev', '/dev/ttyUSB0']),
        here('lidar', arguments=['/dev/ttyUSB1', '--rate', '5']),
        here('mcu', parameters=[{'port': '/dev/ttyACM0'}]),
        here('stick', parameters=[{'device_id': 0}]),
        here('web', arguments=['--port=8080', ['--out=/dev/', LaunchConfiguration('who')]]),
    """
    actions(tmp_path, body)
    text = (tmp_path / "fleet.yaml").read_text()
    (tmp_path / "fleet.yaml").write_text(
        text.replace("up.launch.py", '"up.launch.py who:={robot}"')
    )
    capsys.readouterr()
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "out"), "-v"]) == 0
    said = [it for it in capsys.readouterr().err.splitlines() if "MB412" in it]
    devices = ("dev /dev/ttyUSB0", "/dev/ttyUSB1", "port /dev/ttyACM0", "device_id 0", "port 8080")
    for device in devices:
        assert [device in it for it in said].count(True) == 1, (device, said)
    assert len(said) == len(devices)


def test_a_node_gets_the_parameter_files_of_its_own(tmp_path: Path) -> None:
    """A section for all nodes reaches those alone that the launch file gives it to."""
    for name in ("one", "two", "own"):
        (tmp_path / f"{name}.yaml").write_text(f"/**:\n  ros__parameters: {{{name}: 1}}\n")
    body = """
        here('one', parameters=['FOLDER/one.yaml']),
        here('two', parameters=['FOLDER/two.yaml', {'rate': 5}]),
        here('none'),
    """.replace("FOLDER", str(tmp_path))
    found = actions(tmp_path, body, more="simulator: none\nrelated_files: {params: own.yaml}")
    files = {
        name: [Path(it).name for it in of(found, name)["parameters"] if isinstance(it, str)]
        for name in ("one", "two", "none")
    }
    # What the user names is for all.
    assert files == {
        "one": ["own.yaml", "one.yaml"],
        "two": ["own.yaml", "two.yaml"],
        "none": ["own.yaml"],
    }


def test_rules_and_words_of_known_programs_are_kept(tmp_path: Path) -> None:
    body = """
        Node(package='robot_state_publisher', executable='robot_state_publisher',
            remappings=[('/joint_states', '/arm/joint_states'), ('more', '/arm/more')]),
        Node(package='controller_manager', executable='ros2_control_node',
            parameters=['FOLDER/c.yaml']),
        Node(package='controller_manager', executable='spawner', arguments=[
            'joints', '--controller-manager-timeout', '120', '--activate-as-group']),
    """.replace("FOLDER", str(tmp_path))
    text = "{joints: {type: joint_state_broadcaster/JointStateBroadcaster}}"
    (tmp_path / "c.yaml").write_text(f"controller_manager:\n  ros__parameters: {text}\n")
    found = actions(tmp_path, body, layout="tf-per-robot")
    rules = of(found, "robot_state_publisher")["remappings"]
    assert ["joint_states", "arm/joint_states"] in rules and ["more", "arm/more"] in rules
    words = of(found, "spawner")["arguments"]
    assert words[-3:] == ["--controller-manager-timeout", "120", "--activate-as-group"]


@pytest.mark.parametrize(("more", "clock"), [("simulator: none", "false"), ("", "true")])
def test_nodes_on_simulated_time_are_on_it(more: str, clock: str, tmp_path: Path) -> None:
    """The launch file says so, whatever simulates them; the fleet file says that they are real."""
    body = "here('one', parameters=[{'use_sim_time': True}]), here('two'),"
    actions(tmp_path, body, more=more)
    printed = (tmp_path / "out/fleet.launch.py").read_text()
    assert f"'use_sim_time',\n                default_value='{clock}'" in printed


def test_what_is_added_to_a_path_is_added_to_that_of_the_machine(tmp_path: Path) -> None:
    """What the variable has where the launch file is read is not for the robot."""
    body = """
        ExecuteProcess(cmd=['a'], additional_env={'PATH': '/own:' + OLD, 'X': 'y'}),
        ExecuteProcess(cmd=['b'], additional_env={'PATH': OLD + ':/own'}),
    """
    found = actions(tmp_path, body.replace("OLD", "__import__('os').environ['PATH']"))
    assert of(found, "a")["additional_env"] == {"PATH": ["/own:", ""], "X": "y"}
    assert of(found, "b")["additional_env"] == {"PATH": ["", ":/own"]}
    assert os.environ["PATH"] not in (tmp_path / "out/fleet.launch.py").read_text()


def test_a_folder_of_packages_is_that_of_their_sources(tmp_path: Path) -> None:
    """The folder with links to sources is gone when the launch has been read."""
    package = tmp_path / "ws/acme"
    (package / "launch").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>acme</name></package>")
    share = "__import__('ament_index_python').get_package_share_directory('acme')"
    body = f"SetEnvironmentVariable('GZ_SIM_RESOURCE_PATH', {share} + '/..'), here('first'),"
    text = LAUNCH.replace("SETUP", "pass").replace("BODY", body)
    (package / "launch/up.launch.py").write_text(text)
    (tmp_path / "robot.urdf").write_text(DESCRIPTION)
    fleet = FLEET.replace("up.launch.py", "ws/acme/launch/up.launch.py")
    (tmp_path / "fleet.yaml").write_text(
        fleet.format(more="simulator: none", layout="both", affix="prefix")
    )
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "out")]) == 0
    (done,) = performed(str(tmp_path / "out/fleet.launch.py"), [Launching({"robots": "1"})])
    environment = of(done.actions, "first")["environment"]
    assert [Path(it) for it in environment["GZ_SIM_RESOURCE_PATH"].split(":")] == [tmp_path / "ws"]


def test_files_of_what_is_not_here_are_the_robots(tmp_path: Path) -> None:
    """A parameter file among the arguments of an include, and that of a spawner."""
    (tmp_path / "lidar.yaml").write_text("lidar:\n  ros__parameters: {frame_id: base_link}\n")
    text = "{joints: {type: joint_state_broadcaster/JointStateBroadcaster}}"
    (tmp_path / "c.yaml").write_text(f"controller_manager:\n  ros__parameters: {text}\n")
    body = INCLUDE.replace("'id': WHO", "'params_file': 'FOLDER/lidar.yaml'")
    body += """
        Node(package='controller_manager', executable='ros2_control_node',
            parameters=['FOLDER/c.yaml']),
        Node(package='controller_manager', executable='spawner',
            arguments=['joints', '--param-file', 'FOLDER/c.yaml']),
    """
    found = actions(tmp_path, body.replace("FOLDER", str(tmp_path)), layout="frames-per-robot")
    given = dict(of(found, "IncludeLaunchDescription")["launch_arguments"])
    own = tmp_path / "out/robot2/lidar.yaml"
    assert given == {"port": "/dev/ttyUSB1", "params_file": str(own)}
    assert "frame_id: robot2/base_link" in own.read_text()
    words = of(found, "spawner")["arguments"]
    assert words[-2:] == ["--param-file", str(tmp_path / "out/robot2/c.yaml")]


def test_a_node_set_stands_for_a_launch_file_that_is_not_here(tmp_path: Path) -> None:
    """Its nodes are known; started both ways each robot would have them twice."""
    body = INCLUDE.replace("'id': WHO", "'id': '7'").replace("lidar_x", "slam_toolbox")
    found = told(actions(tmp_path, body, more="node_sets: slam_toolbox"))
    assert "IncludeLaunchDescription" not in found
    assert any("slam_toolbox_node" in it for it in found)


def test_what_stands_for_a_package_is_no_value(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A launch file may write down what it has of a package that is not here."""
    setup = "import moveit_configs_utils as m, yaml; made = yaml.dump({'a': m.make('x')})"
    found = actions(tmp_path, "here('n', parameters=[{'text': made, 'b': 2}]),", setup)
    assert of(found, "n")["parameters"][0] == {"b": 2}
    assert (
        "the parameter text of n comes from a package that is not installed"
        in capsys.readouterr().err
    )


UNKNOWN = """
        SetEnvironmentVariable('LIBS', get_package_prefix('acme_here') + '/lib'),
        SetEnvironmentVariable('DATA', get_package_share_directory('acme_cfg')),
        here('n', arguments=['--x', made, '-v', '--file', CFG + '/a.yaml', str(made)],
            remappings=[('a', made), ('b', 'c')], additional_env={'E': f'{made}', 'F': 'f'},
            parameters=[{'a': made, 'b': 3}, Parameter('c', made), {'d': {'e': made, 'f': 1}},
                {'g': ParameterValue(made), 'where': CFG}, made]),
        here('m', namespace=made, name=made),
        ExecuteProcess(cmd=['run', '--from', CFG, made]), ExecuteProcess(cmd=[f'x {made}']),
""".replace("CFG", "get_package_share_directory('acme_cfg')")


def test_of_what_is_not_known_only_that_is_left_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The node is started with all else; the share folder of a package is asked for when it starts."""
    (tmp_path / "acme_here").mkdir()
    (tmp_path / "acme_here/package.xml").write_text("<package><name>acme_here</name></package>")
    setup = """import moveit_configs_utils; made = moveit_configs_utils.make('x')
    from ament_index_python.packages import get_package_prefix, get_package_share_directory
    from launch_ros.parameter_descriptions import Parameter, ParameterValue"""
    found = actions(tmp_path, UNKNOWN, setup, more="simulator: none\nlaunch_roots: [.]")
    own, share = of(found, "n"), "/acme_cfg/share/acme_cfg"
    assert own["arguments"] == ["-v", "--file", f"{share}/a.yaml"]
    assert ["b", "c"] in own["remappings"] and "a" not in dict(own["remappings"])
    assert own["additional_env"] == {"F": "f"}
    values = {
        key: it for row in own["parameters"] if isinstance(row, dict) for key, it in row.items()
    }
    assert values == {"b": 3, "d.f": 1, "where": share, "use_sim_time": False}
    assert of(found, "m")["namespace"] == "/robot2"
    assert of(found, "run")["cmd"] == ["run", "--from", share]
    assert own["environment"] == {"DATA": share}
    assert "x" not in told(found)
    assert "of this kind in the file, at lines" in capsys.readouterr().err
    named = (tmp_path / "out/plan.yaml").read_text()
    of_n = (
        "an argument of acme n --x",
        "a remap rule of a",
        "variable E",
        "the parameter d.e of n",
    )
    for word in (*of_n, "variable LIBS", "the namespace of acme m", "the name of acme m"):
        assert word in named, word


def test_words_of_ros2_name_what_the_robot_has(tmp_path: Path) -> None:
    body = """
        ExecuteProcess(cmd=['ros2', 'topic', 'pub', '/arm/cmd', 'std_msgs/msg/String', '{}']),
        ExecuteProcess(cmd=['/opt/ros/bin/ros2', 'lifecycle', 'set', '/amcl', 'configure']),
        ExecuteProcess(cmd=['cat', '/amcl']),
        ExecuteProcess(cmd=['ros2', 'control', 'load_controller', '-c', '/controller_manager', 'a']),
        ExecuteProcess(cmd=['ros2', 'topic', 'pub', 'cmd_vel', 'geometry_msgs/msg/Twist', '{}']),
        ExecuteProcess(cmd=['bash', '-c', 'sleep 5 && ros2 service call /go a/srv/B; ls /go']),
        ExecuteProcess(cmd=['ros2 param set /amcl alpha1 0.5'], shell=True),
    """
    found = actions(tmp_path, body, layout="tf-per-robot")
    words = [it.values["cmd"] for it in found if it.kind == "ExecuteProcess"]
    assert [it[3] for it in words[:2]] == ["/robot2/arm/cmd", "/robot2/amcl"]
    assert words[2] == ["cat", "/amcl"]
    assert words[3][3:] == ["-c", "/robot2/controller_manager", "a"]
    assert words[4][3:5] == ["/robot2/cmd_vel", "geometry_msgs/msg/Twist"]
    assert words[5][2] == "sleep 5 && ros2 service call /robot2/go a/srv/B; ls /go"
    assert words[6] == ["ros2 param set /robot2/amcl alpha1 0.5"]


def test_spawners_wait_for_each_other_as_in_the_launch_file(tmp_path: Path) -> None:
    """In the lines of commands.md they stand in another order."""
    text = "{a: {type: T}, b: {type: T}}".replace(
        "T", "joint_state_broadcaster/JointStateBroadcaster"
    )
    (tmp_path / "c.yaml").write_text(f"controller_manager:\n  ros__parameters: {text}\n")
    body = """
        Node(package='controller_manager', executable='ros2_control_node',
            parameters=['FOLDER/c.yaml']),
        RegisterEventHandler(OnProcessExit(target_action=second, on_exit=[
            Node(package='controller_manager', executable='spawner', arguments=['a'])])),
        second,
    """.replace("FOLDER", str(tmp_path))
    setup = "second = Node(package='controller_manager', executable='spawner', arguments=['b'])"
    found = actions(tmp_path, body, setup)
    words = [it.values["arguments"][0] for it in found if _word(it) == "spawner"]
    assert words == ["a", "b"]
    assert told(found)[-4:] == ["OnProcessExit of spawner", "spawner", "end", "spawner"]


def test_a_node_of_all_robots_keeps_its_names(tmp_path: Path) -> None:
    own = "{'base_frame_id': 'base_link', 'odom_frame_id': 'odom'}"
    more = "simulator: none\nshared_nodes: [eyes]"
    body = f"here('eyes', name='eyes', parameters=[{own}]),"
    found = actions(tmp_path, body, more=more, layout="frames-per-robot")
    assert of(found, "eyes")["parameters"][0] == {
        **{"base_frame_id": "base_link", "odom_frame_id": "odom"}
    }


def test_a_bridge_under_another_name_is_that_of_the_build(tmp_path: Path) -> None:
    """Both would bring the clock, and topics that the vendor's robot alone has."""
    body = """
        Node(package='ros_gz_bridge', executable='parameter_bridge', name='sensor_bridge',
            arguments=['/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock']),
        Node(package='rviz2', executable='rviz2', name='view'), here('first'),
    """
    assert told(actions(tmp_path, body)) == ["first", "rviz2"]


def test_a_controller_manager_gets_the_description_that_its_launch_file_gives_it(
    tmp_path: Path,
) -> None:
    """Humble's reads a parameter; nothing leads its own topic to robot_state_publisher's."""
    own = "[{'robot_description': 'x', 'update_rate': 50}]"
    body = f"""
        Node(package='controller_manager', executable='ros2_control_node', parameters={own}),
    """
    manager = of(actions(tmp_path, body), "ros2_control_node")["parameters"]
    assert {"update_rate": 50} in manager
    (text,) = (it["robot_description"] for it in manager if "robot_description" in it)
    assert "robot2" in text and text.startswith("<")


BRIDGED = """
        Node(package='ros_gz_bridge', executable='parameter_bridge', name='sensor_bridge',
            arguments=['/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock',
                '/model/bot/imu@sensor_msgs/msg/Imu[gz.msgs.IMU',
                '/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist'],
            remappings=[('/model/bot/imu', '/imu/out')]),
        Node(package='ros_gz_bridge', executable='parameter_bridge', name='head', namespace='head',
            arguments=['points@sensor_msgs/msg/PointCloud2[gz.msgs.PointCloudPacked']),
        Node(package='ros_gz_image', executable='image_bridge', arguments=['/eye/image']),
"""


def test_topics_of_the_bridges_of_a_launch_file_are_bridged_for_each_robot(tmp_path: Path) -> None:
    """Its clock once; under the rules and in the namespace of each bridge."""
    found = actions(tmp_path, BRIDGED, more="simulator: gazebo", given={"robots": "2"})
    assert told(found).count("parameter_bridge") == 3
    assert "image_bridge" not in told(found)
    rows = {
        name: yaml.safe_load((tmp_path / "out" / name / "bridge.yaml").read_text())
        for name in ("", "robot2")
    }
    assert [it["topic_name"] for it in rows[""]] == ["/clock"]
    both = [
        (it.get("ros_topic_name", it.get("topic_name")), it.get("gz_topic_name"), it["direction"])
        for it in rows["robot2"]
    ]
    assert both == [
        ("/robot2/imu/out", "/model/robot2/imu", "GZ_TO_ROS"),
        ("/robot2/cmd_vel", None, "ROS_TO_GZ"),
        ("/robot2/head/points", "/robot2/points", "GZ_TO_ROS"),
        ("/robot2/eye/image", None, "GZ_TO_ROS"),
    ]


NAMED = """
        Node(package='ros_gz_bridge', executable='parameter_bridge', name='sensors',
            arguments=['/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock',
                '/cmd_vel@geometry_msgs/msg/Twist@gz.msgs.Twist@/model/bot/drive',
                '/world/w/create@ros_gz_interfaces/srv/SpawnEntity',
                '/world/w/set@ros_gz_interfaces/srv/ControlWorld@gz.msgs.A@gz.msgs.B']),
        Node(package='ros_gz_bridge', executable='bridge_node', name='more', namespace='head',
            parameters=[{'config_file': 'FOLDER/more.yaml'}]),
        Node(package='ros_gz_image', executable='image_bridge', name='eye', arguments=['/image']),
"""
MORE = """\
- ros_topic_name: imu
  gz_topic_name: /model/bot/imu
  ros_type_name: sensor_msgs/msg/Imu
  gz_type_name: gz.msgs.IMU
  direction: GZ_TO_ROS
"""


@pytest.mark.parametrize("layout", AFFIX)
def test_the_plan_has_what_bridges_with_names_carry_and_not_the_bridges(
    layout: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The bridges of the build stand for them: whoever compares a plan misses no other ones."""
    (tmp_path / "more.yaml").write_text(MORE)
    body = NAMED.replace("FOLDER", str(tmp_path))
    found = actions(tmp_path, body, more="simulator: gazebo", layout=layout, given={"robots": "2"})
    bridges = [it.values for it in found if _word(it) == "parameter_bridge"]
    services = [
        "/world/w/create@ros_gz_interfaces/srv/SpawnEntity",
        "/world/w/set@ros_gz_interfaces/srv/ControlWorld@gz.msgs.A@gz.msgs.B",
    ]
    assert [it.get("arguments", []) for it in bridges] == [services, [], []]
    plan = yaml.safe_load((tmp_path / "out/plan.yaml").read_text())
    topics = {it["name"]: it["bridge"] for it in plan["topics"] if "bridge" in it}
    mine = "{}/robot1".format if layout == "postfix" else "/robot1{}".format
    for name in ("/image", "/head/imu"):
        assert topics[mine(name)] == ["publishes"]
    assert topics[mine("/cmd_vel")] == ["publishes", "subscribes"]
    assert [topics[it] for it in ("/world/w/create", "/world/w/set")] == [["serves"]] * 2
    rows = yaml.safe_load((tmp_path / "out/robot1/bridge.yaml").read_text())
    inside = {it.get("gz_topic_name", it.get("topic_name")) for it in rows}
    assert {"/model/robot1/drive", "/model/robot1/imu"} <= inside
    capsys.readouterr()
    words = ["check-launch", str(tmp_path / "out/fleet.launch.py"), "--plan"]
    main([*words, str(tmp_path / "out/plan.yaml")])
    assert "MG101" not in "".join(capsys.readouterr())


GZ = """
        IncludeLaunchDescription([FindPackageShare('ros_gz_sim'), '/launch/gz_sim.launch.py'],
            launch_arguments={'gz_args': 'ARGS'}.items()),
        TimerAction(period=5.0, actions=[create]),
"""
CREATE = "create = Node(package='ros_gz_sim', executable='create', arguments=['-world', 'w'])"


@pytest.mark.parametrize(
    ("words", "given", "headless"),
    [
        ("-r -v 4 -s --headless-rendering WORLD", "-r -v 4 --headless-rendering ", "true"),
        ("-r -v4 WORLD", "-r -v4 ", "false"),
        ("WORLD -v", "-r -v ", "false"),
    ],
)
def test_the_simulator_has_the_options_and_the_world_of_its_launch_file(
    words: str, given: str, headless: str, tmp_path: Path
) -> None:
    world = tmp_path / "maze.sdf"
    world.write_text('<sdf version="1.8"><world name="maze"/></sdf>')
    body = GZ.replace("ARGS", words.replace("WORLD", str(world)))
    found = actions(tmp_path, body, CREATE, more="simulator: gazebo")
    (gz,) = (dict(it.values["launch_arguments"]) for it in found if "launch_arguments" in it.values)
    silent = "-s " if headless == "true" else ""
    assert gz["gz_args"] == f'{given}{silent}"{tmp_path}/out/world.sdf"'
    assert 'name="maze"' in (tmp_path / "out/world.sdf").read_text()
    assert (
        f"'headless',\n                default_value='{headless}'"
        in (tmp_path / "out/fleet.launch.py").read_text()
    )
    assert [it.values for it in found if it.kind == "TimerAction"] == [{"period": 5.0}]
    assert of(found, "create")["arguments"][-2:] == ["-world", "w"]


def test_a_world_that_cannot_be_read_is_given_as_it_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It is the vendor's: a build says what is wrong with it, and starts what he starts."""
    world = tmp_path / "maze.sdf"
    world.write_text(
        '<!-- mine -->\n<?xml version="1.0"?>\n<sdf version="1.8"><world name="m"/></sdf>'
    )
    found = actions(tmp_path, GZ.replace("ARGS", f"-r {world}"), CREATE, more="simulator: gazebo")
    (gz,) = (dict(it.values["launch_arguments"]) for it in found if "launch_arguments" in it.values)
    assert gz["gz_args"] == f'-r "{world}"'
    said = capsys.readouterr().err
    assert f"MF823 the simulator gets a world that cannot be read: {world}:2" in said


@pytest.mark.parametrize("robot", ["'-topic', 'robot_description'", "'-file', 'robot.urdf'"])
@pytest.mark.parametrize("given", ["true", "false"])
def test_what_is_put_beside_the_robot_is_there_once(robot: str, given: str, tmp_path: Path) -> None:
    """Of the files that are spawned the first is the robot, where none is its published description."""
    spawner = "Node(package='ros_gz_sim', executable='create', arguments=[{}])"
    box = spawner.format("'-file', '/srv/box.sdf', '-name', 'box', '-x', '3'")
    order = [spawner.format(robot), box][:: 1 if "file" in robot else -1]
    body = GZ.replace("ARGS", "-r").replace("create]", f"{order[0]}]") + f"{order[1]},"
    switches = {"robots": "2", "simulator": given}
    found = actions(tmp_path, body, "pass", more="simulator: gazebo", given=switches)
    words = [it.values["arguments"] for it in found if _word(it) == "create"]
    boxes = [it for it in words if "/srv/box.sdf" in it]
    assert len(words) - len(boxes) == (2 if given == "true" else 0)
    assert boxes == [["-file", "/srv/box.sdf", "-name", "box", "-x", "3"]] * (given == "true")
    real = actions(tmp_path, body, "pass", more="simulator: none", given={"robots": "2"})
    assert "create" not in told(real)


SEVERAL = """
        *[GroupAction([PushRosNamespace(name),
            Node(package='robot_state_publisher', executable='robot_state_publisher'),
            here('driver', name='driver', parameters=[f'FOLDER/{name}.yaml', {'frame': 'laser'}],
                remappings=[('/scan', f'/{name}/front')]),
            RegisterEventHandler(OnProcessExit(target_action=first, on_exit=[here('late')])),
            ]) for name in NAMES],
        ExecuteProcess(cmd=['call', 'NAME2']), ExecuteProcess(cmd=['all']), first,
"""


def test_a_launch_file_of_several_robots_is_that_of_its_first(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """What it starts for the first is started for each of the fleet, under the names of these."""
    for name in ("tb1", "tb2"):
        text = f"/**:\n  ros__parameters: {{topic: /{name}/scan, rate: {name[-1]}}}\n"
        (tmp_path / f"{name}.yaml").write_text(text)
    body = SEVERAL.replace("FOLDER", str(tmp_path)).replace("NAME2", "/tb2/go")
    found = actions(tmp_path, body.replace("NAMES", "('tb1', 'tb2')"), given={"robots": "2"})
    drivers = [it.values for it in found if _word(it) == "driver"]
    assert [it["namespace"] for it in drivers] == ["/robot1", "/robot2"]
    assert ["/scan", "front"] in drivers[1]["remappings"]
    names = [Path(it).name for it in drivers[1]["parameters"] if isinstance(it, str)]
    assert names == ["tb1.yaml"]
    written = yaml.safe_load((tmp_path / "out/robot2/tb1.yaml").read_text())
    values = written["/**"]["ros__parameters"]
    assert (values["rate"], "tb" in values["topic"]) == (1, False)
    assert "call" not in told(found) and told(found).count("OnProcessExit of first") == 2
    said = capsys.readouterr().err
    assert "the launch file starts tb1, tb2: each robot is as tb1 is" in said


@pytest.mark.parametrize("spawner", ["", "Node(package='ros_gz_sim', executable='create'),"])
def test_two_sides_of_a_robot_are_no_two_robots(spawner: str, tmp_path: Path) -> None:
    """Two that are spawned are two robots, whatever they are called."""
    for name in ("left", "right"):
        (tmp_path / f"{name}.yaml").write_text("/**:\n  ros__parameters: {rate: 1}\n")
    body = SEVERAL.replace("FOLDER", str(tmp_path)).replace("NAMES", "('left', 'right')")
    body = body.replace("PushRosNamespace(name),", f"PushRosNamespace(name), {spawner}")
    found = actions(tmp_path, body, more="simulator: gazebo")
    own = [it.values["namespace"] for it in found if _word(it) == "driver"]
    assert own == (["/robot2"] if spawner else ["/robot2/left", "/robot2/right"])


@pytest.mark.parametrize("simulator", ["true", "false"])
def test_spawners_start_when_the_robot_is_in_its_simulator(simulator: str, tmp_path: Path) -> None:
    """Without the simulator of the launch file they do not wait for it."""
    text = "{a: {type: T}, b: {type: T}}".replace(
        "T", "joint_state_broadcaster/JointStateBroadcaster"
    )
    (tmp_path / "c.yaml").write_text(f"controller_manager:\n  ros__parameters: {text}\n")
    body = """
        Node(package='controller_manager', executable='ros2_control_node',
            parameters=['FOLDER/c.yaml']),
        create,
        RegisterEventHandler(OnProcessExit(target_action=create, on_exit=[a])),
        RegisterEventHandler(OnProcessExit(target_action=a, on_exit=[
            Node(package='controller_manager', executable='spawner', arguments=['b'])])),
    """.replace("FOLDER", str(tmp_path))
    setup = f"""{CREATE}
    a = Node(package='controller_manager', executable='spawner', arguments=['a'])"""
    given = {"robots": "robot2", "simulator": simulator}
    found = told(actions(tmp_path, body, setup, more="simulator: gazebo", given=given))
    inside = ["OnProcessExit of spawner", "spawner", "end", "spawner"]
    waits = ["OnProcessExit of create", *inside, "end", "create"]
    started = [it for it in found if it in waits]
    assert started == (waits if simulator == "true" else inside)


@pytest.mark.parametrize("words", ["'--param', 'robot_description'", ""])
def test_a_vendors_own_spawner_is_the_only_one(words: str, tmp_path: Path) -> None:
    """A second spawner would put the robot into the simulator twice; each robot has its own place."""
    given = "" if words else "parameters=[{'robot_description': 'x'}],"
    body = f"""
        IncludeLaunchDescription([FindPackageShare('ros_gz_sim'), '/launch/gz_sim.launch.py']),
        Node(package='acme', executable='spawn_it', {given}
            arguments=[{words}{", " if words else ""}'--model-name', 'rover', '--x', '1.5',
                       '--Y', '0.3', '--keep']),
    """
    more = "simulator: gazebo"
    text = FLEET.replace("robot2,", "robot2, pose: {{x: 4, y: 1, yaw: 2}},")
    with pytest.MonkeyPatch.context() as patched:
        patched.setitem(globals(), "FLEET", text)
        found = actions(tmp_path, body, more=more)
    assert "create" not in told(found)
    wanted = ["--model-name", "robot2", "--x", "4.0", "--Y", "2.0", "--keep"]
    assert of(found, "spawn_it")["arguments"][-7:] == wanted
    assert told(found).count("spawn_it") == 1


def test_a_program_without_the_description_is_no_spawner_of_the_robot(tmp_path: Path) -> None:
    body = """
        IncludeLaunchDescription([FindPackageShare('ros_gz_sim'), '/launch/gz_sim.launch.py']),
        here('spawn_boxes', arguments=['--x', '1.5']),
    """
    found = actions(tmp_path, body, more="simulator: gazebo")
    assert "create" in told(found)
    assert of(found, "spawn_boxes")["arguments"] == ["--x", "1.5"]


CONDITIONS = """
        DeclareLaunchArgument('joy', default_value='false'),
        DeclareLaunchArgument('mode', default_value='real'),
        here('yes', condition=UnlessCondition(joy)),
        here('stick', condition=IfCondition(joy)),
        GroupAction([here('a'), here('b')], condition=LaunchConfigurationEquals('mode', 'sim')),
        IncludeLaunchDescription([FindPackageShare('acme'), '/launch/more.launch.py'],
            condition=IfCondition(PythonExpression(["'", joy, "' == '1' or '", mode, "' == 'sim'"]))),
        ExecuteProcess(cmd=['/usr/bin/thing'], condition=IfCondition(joy)),
        TimerAction(period=1.0, actions=[here('late')], condition=IfCondition(joy)),
        OpaqueFunction(function=lambda context: [here('made', condition=IfCondition(joy))]),
        ComposableNodeContainer(package='rclcpp_components', executable='component_container',
            name='box', namespace='', composable_node_descriptions=[
                ComposableNode(package='acme', plugin='acme::P', condition=IfCondition(joy))]),
"""


def test_what_a_condition_keeps_out_is_named_with_the_arguments_that_decide(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The conditions count with the arguments of the fleet file; others start what they kept out."""
    setup = """from launch.conditions import LaunchConfigurationEquals, UnlessCondition
    from launch.substitutions import PythonExpression
    joy, mode = LaunchConfiguration('joy'), LaunchConfiguration('mode')"""
    assert told(actions(tmp_path, CONDITIONS, setup)) == ["yes", "component_container"]
    text = (tmp_path / "out/fleet.launch.py").read_text()
    comments = " ".join(it.strip("# ") for it in text.splitlines() if it.strip()[:1] == "#")
    left = dict(it.split(" (", 1) for it in comments.split("Not started: ")[1:])
    assert {name: why.split(" has ")[1].split(";")[0] for name, why in left.items()} == {
        "acme stick": "joy:=false",
        "acme a, acme b": "mode:=real",
        "more.launch.py": "joy:=false, mode:=real",
        "thing": "joy:=false",
        "acme late": "joy:=false",
        "acme made": "joy:=false",
        "acme acme::P": "joy:=false",
    }, "joy decides more than what it turns on"
    capsys.readouterr()
    words = ["init", str(tmp_path), "--launch", str(tmp_path / "up.launch.py"), "-o", "-", "--yes"]
    main(words)
    assert "#   acme a, acme b: mode:=real" in capsys.readouterr().out.splitlines()
    fleet = (tmp_path / "fleet.yaml").read_text()
    (tmp_path / "fleet.yaml").write_text(
        fleet.replace("up.launch.py", "up.launch.py joy:=true mode:=sim")
    )
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "other")]) == 0
    text = (tmp_path / "other/fleet.launch.py").read_text()
    assert "Not started: acme yes" in text and text.count("Not started") == 1


SWITCHES = fixture_text("launched_processes_switches.txt")
# What is off by default.
OFF = ["camera", "acme::Q", "record", "IncludeLaunchDescription", "logger", "logged", "fake"]
OFF += ["another", "instead"]


@pytest.mark.parametrize(
    ("given", "gone"),
    [
        ({}, OFF),
        ({"cam": "true"}, OFF[2:]),
        ({"two": "true", "log": "true"}, [*OFF[:2], *OFF[6:]]),
        ({"joy": "false"}, ["stick", "inner", "TimerAction", "late", "waits", *OFF]),
        ({"mock": "true"}, ["driver", "inner", *OFF]),
        ({"sim": "0"}, ["OnProcessExit of first", "after", "first", "waits", *OFF]),
        ({"mode": "b", "rviz": "false"}, ["other", "unless_b", *OFF[:7], "instead"]),
        ({"mode": "c"}, ["other", *OFF]),
        ({"both": "false"}, ["real", *OFF[:6], *OFF[7:]]),
        ({"part": "false", "twin": "true"}, ["with_part", "acme::P", *OFF[:-1]]),
    ],
)
def test_a_launch_argument_turns_off_or_on_what_its_condition_starts(
    given: dict[str, str], gone: list[str], tmp_path: Path
) -> None:
    """One that is of every build, or chooses between two nodes of one name, does not: what it decides
    is decided in the fleet file."""
    setup = """from launch.conditions import LaunchConfigurationEquals, UnlessCondition
    from launch.substitutions import PythonExpression
    joy, both, mode = map(LaunchConfiguration, ('joy', 'both', 'mode'))
    first = here('first')"""
    done = actions(tmp_path, SWITCHES, setup, given={"robots": "2", **given})
    loaded = (one for it in done for one in it.values.get("composable_node_descriptions", ()))
    found = [*told(done), *(it["plugin"] for it in loaded)]
    every = ["stick", "driver", "real", "other", "inner", "TimerAction", "late", "first", "map"]
    every += ["unless_b", "OnProcessExit of first", "after", "waits", "with_part", "acme::P", *OFF]
    left = [it for it in every if it not in gone]
    assert {it: found.count(it) for it in every} == {it: 2 * (it in left) for it in every}
    text = (tmp_path / "out/fleet.launch.py").read_text()
    declared = text.split("def generate_launch_description")[1]
    kept = ("joy", "mock", "sim", "both", "mode", "cam", "two", "log", "part")
    own = {
        it: f"            '{it}',\n                default_value=" in declared
        for it in (*kept, "rviz", "twin")
    }
    assert own == dict.fromkeys(own, False) | dict.fromkeys(kept, True)
    assert "'mock',\n                default_value='False'" in declared
    assert "what starts depends on a, b" in declared


def test_an_argument_with_two_values_turns_nothing_off(tmp_path: Path) -> None:
    """Robots with other values of it would need two arguments of one name."""
    body = "DeclareLaunchArgument('joy', default_value='true'), here('a', condition=If(joy)),"
    body += "here('b', condition=UnlessCondition(joy)),"
    body = body.replace("If(", "IfCondition(")
    setup = "from launch.conditions import UnlessCondition\n    joy = LaunchConfiguration('joy')"
    actions(tmp_path, body, setup)
    fleet = (tmp_path / "fleet.yaml").read_text()
    other = "robot2, launch: up.launch.py joy:=false,"
    (tmp_path / "fleet.yaml").write_text(fleet.replace("robot2,", other))
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "more")]) == 0
    assert "'joy'," not in (tmp_path / "more/fleet.launch.py").read_text()


ODOMETRY = """<gazebo>
      <plugin filename="gz-sim-odometry-publisher-system" name="gz::sim::systems::OdometryPublisher">
      <odom_topic>/model/bot/odometry</odom_topic><odom_frame>odom</odom_frame>
      <robot_base_frame>base_link</robot_base_frame></plugin></gazebo></robot>"""
GROUND_TRUTH = ODOMETRY.replace("odom_frame>odom", "odom_frame>world")
TWO_OF_THEM = ODOMETRY.replace("</robot>", ODOMETRY.replace("<odom_frame>odom", "<odom_frame>map"))


@pytest.mark.parametrize(
    ("is_bridged", "systems"),
    [(True, ODOMETRY), (False, ODOMETRY), (False, GROUND_TRUTH), (False, TWO_OF_THEM)],
)
def test_transforms_of_a_system_are_bridged_where_no_node_sends_them(
    is_bridged: bool, systems: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The vendor's bridge has other topics, and his filter places the robot, or another system does:
    two would do so."""
    values = "{'world_frame': 'odom', 'base_link_frame': 'base_link', 'publish_tf': True}"
    body = """Node(package='ros_gz_bridge', executable='parameter_bridge',
            arguments=['/model/bot/odometry@nav_msgs/msg/Odometry[gz.msgs.Odometry']),"""
    if not is_bridged and systems != TWO_OF_THEM:
        body += "Node(package='robot_localization', executable='ekf_node', name='ekf_filter_node',"
        body += f"parameters=[{values}]),"
    with pytest.MonkeyPatch.context() as patched:
        patched.setitem(globals(), "DESCRIPTION", DESCRIPTION.replace("</robot>", systems))
        actions(tmp_path, body, more="simulator: gazebo")
    rows = yaml.safe_load((tmp_path / "out/robot1/bridge.yaml").read_text())
    types = {it["ros_type_name"] for it in rows}
    assert ("tf2_msgs/msg/TFMessage" in types) is is_bridged
    assert "MG408" not in capsys.readouterr().err


@pytest.mark.parametrize("layout", AFFIX)
def test_a_bridge_has_topics_of_a_model_as_the_description_gives_them(
    layout: str, tmp_path: Path
) -> None:
    """A topic that a system is told in full is no default: it has not the name of the spawned model."""
    row = "/model/bot/odometry@nav_msgs/msg/Odometry[gz.msgs.Odometry"
    body = f"Node(package='ros_gz_bridge', executable='parameter_bridge', arguments=['{row}']),"
    text = DESCRIPTION.replace("</robot>", ODOMETRY)
    text = text.replace(text[text.index("<robot") : text.index(">") + 1], '<robot name="bot">')
    with pytest.MonkeyPatch.context() as patched:
        patched.setitem(globals(), "DESCRIPTION", text)
        actions(tmp_path, body, more="simulator: gazebo", layout=layout)
    written = (tmp_path / "out/robot1/robot.urdf").read_text()
    told = written.split("<odom_topic>")[1].split("</odom_topic>")[0]
    rows = yaml.safe_load((tmp_path / "out/robot1/bridge.yaml").read_text())
    inside = [it.get("gz_topic_name", it.get("topic_name")) for it in rows]
    assert told in inside and "/model/robot1/odometry" not in inside


def test_move_group_has_what_its_launch_file_and_its_files_say_of_pipelines(tmp_path: Path) -> None:
    """What a build makes of MoveIt's files comes before them; the last value counts (rcl)."""
    mine = "move_group:\n  ros__parameters:\n    ompl: {request_adapters: [mine/One]}\n"
    (tmp_path / "pipes.yaml").write_text(mine)
    srdf = '<robot name="r"><group name="g"><link name="wheel"/></group></robot>'
    (tmp_path / "arm.srdf").write_text(srdf)
    (tmp_path / "kinematics.yaml").write_text("g: {kinematics_solver: k/K}\n")
    body = f"""Node(package='moveit_ros_move_group', executable='move_group', name='move_group',
        parameters=['{tmp_path}/pipes.yaml', {{'ompl.planning_plugin': 'mine/Two'}}]),
        Node(package='rviz2', executable='rviz2', parameters=[
            {{'pilz.planning_plugins': 'a/B', 'robot_description_kinematics.g.x': 1}}]),"""
    more = "simulator: none\nsrdf: arm.srdf\nrelated_files: {moveit: [kinematics.yaml]}"
    found = actions(tmp_path, body, more=more)
    told = of(found, "move_group")["parameters"]
    files = [Path(it).name for it in told if isinstance(it, str)]
    assert files.index("moveit_parameters.yaml") < files.index("pipes.yaml")
    rows = [at for at, it in enumerate(told) if "ompl.planning_plugin" in it]
    assert rows[-1] > max(at for at, it in enumerate(told) if isinstance(it, str))
    # A window for one robot has them as well; names of joints are those of its own files.
    made, own, *_ = of(found, "rviz2")["parameters"]
    assert made.endswith("moveit_parameters.yaml") and own == {"pilz.planning_plugins": "a/B"}


@pytest.mark.parametrize(
    "file",
    [
        "ros_gz_sim/launch/gz_sim.launch.py",
        "ros_ign_gazebo/launch/ign_gazebo.launch.py",
        "gazebo_ros/launch/gazebo.launch.py",
    ],
)
def test_a_simulator_is_started_once_by_its_launch_file(file: str, tmp_path: Path) -> None:
    """No package has a program gzserver but gazebo_ros: ros2 launch would end."""
    package, _, path = file.partition("/")
    body = f"IncludeLaunchDescription([FindPackageShare('{package}'), '/{path}']),"
    found = actions(tmp_path, body, more="simulator: gazebo")
    assert [it.kind for it in found].count("IncludeLaunchDescription") == 1
    assert "gzserver" not in told(found)
    # The description says nothing of a simulator.
    assert ("spawn_entity.py" in told(found)) is (package == "gazebo_ros")


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (
            ["ros2", "control", "load_controller", "--set-state", "active", "arm"],
            [*("ros2", "control", "load_controller", "-c", "{}"), "--set-state", "active", "arm"],
        ),
        (["ros2 control list_controllers; date"], ["ros2 control list_controllers -c {}; date"]),
        (
            ["ros2", "control", "load_controller", "arm", "-c", "/controller_manager"],
            ["ros2", "control", "load_controller", "arm", "-c", "{}"],
        ),
    ],
)
@pytest.mark.parametrize("layout", ["both", "postfix"])
def test_a_command_asks_for_the_manager_of_its_robot(
    layout: str, words: list[str], expected: list[str], tmp_path: Path
) -> None:
    """ros2 control asks for /controller_manager where none is named, which is no robot's."""
    found = actions(tmp_path, f"ExecuteProcess(cmd={words!r}),", layout=layout)
    manager = "/controller_manager_robot2" if layout == "postfix" else "/robot2/controller_manager"
    (told,) = (it.values["cmd"] for it in found if it.kind == "ExecuteProcess")
    assert told == [it.format(manager) for it in expected]


def test_a_manager_of_what_runs_once_for_all_runs_once(tmp_path: Path) -> None:
    body = """Node(package='nav2_map_server', executable='map_server',
            parameters=[{'yaml_filename': '/maps/hall.yaml'}]),
        Node(package='nav2_lifecycle_manager', executable='lifecycle_manager', name='manager',
            parameters=[{'autostart': True, 'node_names': ['map_server']}]), here('first'),"""
    found = actions(tmp_path, body)
    managers = [it.values for it in found if it.values.get("executable") == "lifecycle_manager"]
    assert [it["parameters"][0]["node_names"] for it in managers] == [["map_server"]]
    assert "Not started: manager (what it manages" in (tmp_path / "out/fleet.launch.py").read_text()


@pytest.mark.parametrize(
    ("layout", "windows"), [("both", ["robot1", "robot2"]), ("frames-per-robot", ["out"])]
)
def test_a_window_without_a_config_that_is_here_opens_for_each_robot_or_for_all(
    layout: str, windows: list[str], tmp_path: Path
) -> None:
    body = """Node(package='rviz2', executable='rviz2', arguments=['-d', [
        FindPackageShare('gone'), '/a.rviz']]), here('first'),"""
    found = actions(tmp_path, body, layout=layout, given={"robots": "2"})
    seen = [it.values for it in found if it.values.get("package") == "rviz2"]
    assert [Path(it["arguments"][1]).parent.name for it in seen] == windows


SHOWN = """Visualization Manager:
  Global Options:
    Fixed Frame: map
  Tools:
    - Class: rviz_default_plugins/MoveCamera
"""
GOALS = "    - Class: nav2_rviz_plugins/GoalTool\n"


@pytest.mark.parametrize(
    ("layout", "tool", "windows"),
    [
        ("frames-per-robot", "", ["", ""]),
        # Beside it a window for all robots would show them twice.
        ("frames-per-robot", GOALS, ["robot1", "robot2"]),
        ("tf-per-robot", "", ["robot1", "robot2"]),
    ],
)
def test_a_launch_file_that_opens_a_window_opens_one_for_a_robot_or_for_all(
    layout: str, tool: str, windows: list[str], tmp_path: Path
) -> None:
    (tmp_path / "robot.rviz").write_text(f"{SHOWN}{tool}")
    body = (
        "Node(package='rviz2', executable='rviz2', arguments=['-d', 'robot.rviz']), here('first'),"
    )
    more = "simulator: none\nrelated_files: {rviz: robot.rviz}"
    opened = []
    for robot in ("robot1", "robot2"):
        found = actions(tmp_path, body, more=more, layout=layout, given={"robots": robot})
        seen = [it.values for it in found if it.values.get("package") == "rviz2"]
        opened += [it.get("namespace", "") for it in seen]
    assert [it.strip("/") for it in opened] == windows
    # A person may open the others.
    assert "robot.rviz" in (tmp_path / "out/commands.md").read_text()


DOCK = (
    '<robot name="dock"><link name="base_link"/><link name="tag"/><joint name="t" type="fixed">'
    + ('<parent link="base_link"/><child link="tag"/></joint></robot>')
)


@pytest.mark.parametrize(
    ("layout", "prefix", "rule"),
    [
        ("tf-per-robot", "dock/", ""),
        ("frames-per-robot", "robot2/dock/", ""),
        ("both", "robot2/dock/", ""),
        ("both", "robot2/dock/", "remappings=[('robot_description', 'dock_description')],"),
    ],
)
def test_a_second_publisher_sends_what_the_launch_file_gives_it(
    layout: str, prefix: str, rule: str, tmp_path: Path
) -> None:
    """The robot's own tree is sent once; two trees with one base_link would be one frame with two
    parents. By a rule for its topic it is the second one wherever it is."""
    (tmp_path / "dock.urdf").write_text(DOCK)
    given = f"'robot_description': open({str(tmp_path / 'dock.urdf')!r}).read()"
    rsp = "Node(package='robot_state_publisher', executable='robot_state_publisher'"
    body = [
        f"{rsp}, parameters=[{{'robot_description': '<robot/>'}}]),",
        f"{rsp}, namespace='dock', {rule} parameters=[{{{given}, 'frame_prefix': 'dock/'}}]),",
    ]
    own, dock = (
        {
            name: one
            for row in it.values["parameters"]
            if isinstance(row, dict)
            for name, one in row.items()
        }
        for it in actions(tmp_path, "".join(body[:: -1 if rule else 1]), layout=layout)[
            :: -1 if rule else 1
        ]
        if it.values.get("package") == "robot_state_publisher"
    )
    assert own["robot_description"] == (tmp_path / "out/robot2/robot.urdf").read_text()
    assert dock["robot_description"].strip() == DOCK
    assert dock["frame_prefix"] == prefix


def test_what_is_put_beside_the_robot_into_a_simulator_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    spawn = "Node(package='ros_gz_sim', executable='create', arguments=['-topic', '{}'])"
    body = f"{spawn.format('robot_description')}, {spawn.format('dock/robot_description')},"
    found = actions(tmp_path, body, more="simulator: gazebo")
    assert told(found).count("create") == 1
    (line,) = (
        it for it in capsys.readouterr().err.splitlines() if "in addition to the robot" in it
    )
    assert "up.launch.py:" in line and "create" in line and "warning: MF823" in line


def test_a_manager_that_the_plugin_makes_is_named_as_not_started(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plugin = '<gazebo><plugin filename="libgz_ros2_control-system.so" name="m"/></gazebo></robot>'
    own = DESCRIPTION.replace("</robot>", plugin)
    body = "Node(package='controller_manager', executable='ros2_control_node'), here('first'),"
    (tmp_path / "plugin.urdf").write_text(own)
    more = "simulator: gazebo\ndescription: plugin.urdf"
    for link in ("base_link", "lidar_link", "wheel"):
        own = own.replace(f'<link name="{link}"/>', WEIGHED.format(link))
    (tmp_path / "plugin.urdf").write_text(own)
    text = FLEET.format(more=more, layout="both", affix="prefix").replace(
        ", description: robot.urdf", ""
    )
    (tmp_path / "fleet.yaml").write_text(text)
    (tmp_path / "up.launch.py").write_text(LAUNCH.replace("SETUP", "").replace("BODY", body))
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "out")]) == 0
    (line,) = (it for it in capsys.readouterr().err.splitlines() if "MF821" in it)
    assert "ros2_control_node is not started" in line and "up.launch.py:" in line


@pytest.mark.parametrize(("layout", "tf"), [("both", "/robot2/tf"), ("frames-per-robot", "/tf")])
def test_the_quality_of_service_that_a_bridge_sets_is_kept(
    layout: str, tf: str, tmp_path: Path
) -> None:
    """rclcpp names the parameter after the topic as it is resolved (qos_parameters.hpp)."""
    qos = "'qos_overrides./{}.publisher.{}': '{}'".format
    given = f"{qos('imu/out', 'reliability', 'best_effort')}, {qos('tf', 'durability', 'volatile')}"
    more = f"remappings=[('/model/bot/imu', '/imu/out')], parameters=[{{{given}}}])"
    body = BRIDGED.replace("remappings=[('/model/bot/imu', '/imu/out')])", more)
    found = actions(tmp_path, body, more="simulator: gazebo", layout=layout, given={"robots": "2"})
    bridges = [it.values for it in found if it.values.get("executable") == "parameter_bridge"]
    values = [
        {key: one for row in it["parameters"] for key, one in row.items() if "config" not in key}
        for it in bridges
        if it.get("namespace") == "/robot2" or not it.get("namespace")
    ]
    assert {f"qos_overrides.{tf}.publisher.durability": "volatile"}.items() <= values[-1].items()
    assert values[-1]["qos_overrides./robot2/imu/out.publisher.reliability"] == "best_effort"
    # Only what all robots share is set for the bridge of all.
    of_all = [it for it in values[0] if it.startswith("qos")]
    assert of_all == ([f"qos_overrides.{tf}.publisher.durability"] if tf == "/tf" else [])


def test_an_include_without_an_argument_that_is_known_is_named_and_not_started(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """launch ends where such a file asks for it; another one starts with all that it is given."""
    include = "IncludeLaunchDescription([FindPackageShare('gone'), '/launch/{}.launch.py'], {})"
    given = "launch_arguments=[('config', {}), ('gui', 'false')]"
    body = ", ".join(
        include.format(name, given.format(value))
        for name, value in (("one", "moveit_configs_utils.dump()"), ("two", "'a'"))
    )
    found = actions(tmp_path, f"{body}, here('first'),", setup="import moveit_configs_utils")
    includes = [it for it in found if it.kind == "IncludeLaunchDescription"]
    assert [it.values["launch_arguments"] for it in includes] == [
        [["config", "a"], ["gui", "false"]]
    ]
    (line,) = (it for it in capsys.readouterr().err.splitlines() if "is not started" in it)
    assert "launch/one.launch.py of gone is not started: its argument config comes from" in line
    assert "up.launch.py:" in line
