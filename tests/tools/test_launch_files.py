# SPDX-License-Identifier: Apache-2.0
"""Nodes of launch files in Python, XML and YAML; the files are written here."""

from __future__ import annotations

import pytest

from tools.interfaces.launch_files import LaunchedNode, launched_nodes

PYTHON = """\
def generate_launch_description():
    namespace = LaunchConfiguration('namespace')
    common = [('/tf', 'tf'), ('/tf_static', 'tf_static')]
    return LaunchDescription([
        Node(package='nav', executable='server', remappings=common + [('cmd_vel', 'cmd_vel_nav')]),
        launch_ros.actions.LifecycleNode(
            package='nav', executable='server', name='planner', namespace=namespace),
        ComposableNodeContainer(
            package='rclcpp_components', executable='component_container',
            name=[namespace, '_box'], namespace='',
            composable_node_descriptions=[
                ComposableNode(package='nav', plugin='nav::Server', name='smoother', remappings=common),
            ]),
        Node(package='tool', executable=compute(), name=name_of(), remappings=rules()),
    ])
"""


def test_a_launch_file_in_python() -> None:
    found = {it.line: it for it in launched_nodes("a.launch.py", PYTHON)}
    tf = "/tf:=tf /tf_static:=tf_static"
    assert sorted(found) == [5, 6, 8, 12, 14]
    assert found[5] == LaunchedNode(
        "node", "nav", "server", "", "", f"{tf} cmd_vel:=cmd_vel_nav", 5
    )
    assert found[6][:5] == ("lifecycle_node", "nav", "server", "planner", "$(var namespace)")
    assert found[8][3:5] == ("$(var namespace)_box", "")
    assert found[12][:6] == ("component", "nav", "nav::Server", "smoother", "", tf)
    assert found[14][2:6] == ("<...>", "<...>", "", "<...>")


def test_a_launch_file_is_never_run() -> None:
    assert (
        launched_nodes("a.py", "raise SystemExit\nNode(package='a', executable='b')")[0].line == 2
    )


XML = """\
<launch>
  <!-- <node pkg="no" exec="no"/> -->
  <group>
    <node pkg="joy" exec="joy_node" name="joy" namespace="$(var ns)">
      <remap from="joy" to="pad"/>
      <remap from="/tf" to="tf"/>
    </node>
  </group>
  <node_container pkg="rclcpp_components" exec="component_container" name="box">
    <composable_node pkg="nav" plugin="nav::Server" name="planner"/>
  </node_container>
  <arg name="node"/>
</launch>
"""


def test_a_launch_file_in_xml() -> None:
    assert launched_nodes("a.launch.xml", XML) == (
        LaunchedNode("node", "joy", "joy_node", "joy", "$(var ns)", "joy:=pad /tf:=tf", 4),
        LaunchedNode("container", "rclcpp_components", "component_container", "box", "", "", 9),
        LaunchedNode("component", "nav", "nav::Server", "planner", "", "", 10),
    )


YAML = """\
launch:
- arg: {name: x}
- node:
    pkg: joy
    exec: joy_node
    name: joy
    remap:
    - {from: joy, to: pad}
- node_container:
    pkg: rclcpp_components
    exec: component_container
    name: box
    composable_node:
    - {pkg: nav, plugin: "nav::Server", name: planner}
"""


def test_a_launch_file_in_yaml() -> None:
    assert [it[:6] for it in launched_nodes("a.launch.yaml", YAML)] == [
        ("node", "joy", "joy_node", "joy", "", "joy:=pad"),
        ("container", "rclcpp_components", "component_container", "box", "", ""),
        ("component", "nav", "nav::Server", "planner", "", ""),
    ]


@pytest.mark.parametrize(
    ("file", "text"), [("a.py", "def ("), ("a.xml", "<launch>"), ("a.yaml", "a: [")]
)
def test_a_file_that_cannot_be_read_has_no_nodes(file: str, text: str) -> None:
    assert launched_nodes(file, text) == ()
