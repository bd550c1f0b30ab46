# SPDX-License-Identifier: Apache-2.0
"""Files beside a description that are large in one thing, and the commands that read them."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from fleet_folder import ARM
from paths import FIXTURES, fixture_text, write_files

# File -> its text, for a number of what it is large in.
Files = Callable[[int], Mapping[str, str]]

LAUNCH_PY = fixture_text("growing_files_launch_py.txt")
ROVER = '<robot name="rover"><link name="base_link"/></robot>\n'
NODE = 'Node(package="demo_nodes_cpp", executable="talker", name="n#"),\n'
XML_NODE = '<node pkg="demo_nodes_cpp" exec="talker" name="n#"/>\n'
_TALKER = "'ros2', 'run', 'demo_nodes_cpp', 'talker', '--ros-args'"
YAML_NODE = "- node: {pkg: demo_nodes_cpp, exec: talker, name: n#}\n"


def each(count: int, text: str) -> str:
    """Return the text for 0, 1, 2 ..., the number in place of ``#``, the next one in place of
    ``@``; ``##`` is a #."""
    return "".join(_numbered(text, at) for at in range(count))


def _numbered(text: str, at: int) -> str:
    plain = text.replace("##", "\0").replace("#", str(at)).replace("@", str(at + 1))
    return plain.replace("\0", "#")


def within(count: int, before: str, inner: str, after: str) -> str:
    """Return the inner text with so many others around it."""
    return f"{each(count, before)}{inner}{after * count}"


def _python(made: Callable[[int], str], name: str = "a.launch.py") -> Files:
    return lambda count: {name: LAUNCH_PY.format(made(count))}


def _xml(made: Callable[[int], str]) -> Files:
    return lambda count: {"a.launch.xml": f"<launch>\n{made(count)}</launch>\n"}


def _yaml(made: Callable[[int], str]) -> Files:
    return lambda count: {"a.launch.yaml": f"launch:\n{made(count)}"}


def _include(name: str, python: bool = True) -> str:
    if python:
        return (
            "IncludeLaunchDescription(PythonLaunchDescriptionSource("
            f'[ThisLaunchFileDir(), "/{name}"]), launch_arguments={{"a": "b"}}.items()),'
        )
    return f'<include file="$(dirname)/{name}"/>\n'


def _chain_of_includes(count: int) -> Mapping[str, str]:
    last = {f"i{count}.launch.xml": f"<launch>{XML_NODE}</launch>"}
    files = {
        f"i{at}.launch.xml": f"<launch>{_include(f'i{at + 1}.launch.xml', False)}</launch>"
        for at in range(count)
    }
    return {**files, **last, "a.launch.xml": f"<launch>{_include('i0.launch.xml', False)}</launch>"}


def _wide_includes(count: int) -> Mapping[str, str]:
    made = {f"i{at}.launch.py": LAUNCH_PY.format(NODE.replace("#", str(at))) for at in range(count)}
    return {**made, "a.launch.py": LAUNCH_PY.format("\n".join(map(_include, made)))}


def _same_include(count: int) -> Mapping[str, str]:
    each_ = each(
        count,
        f"<group><push-ros-namespace namespace='r#'/>{_include('b.launch.xml', False)}</group>",
    )
    return {
        "a.launch.xml": f"<launch>{each_}</launch>",
        "b.launch.xml": f"<launch>{XML_NODE}</launch>",
    }


def _with_params(count: int) -> Mapping[str, str]:
    node = 'Node(package="demo_nodes_cpp", executable="talker", name="n0", parameters=["p.yaml"]),'
    values = "".join(f"    p{at}: v{at}\n" for at in range(count))
    return {
        "a.launch.py": LAUNCH_PY.format(
            node.replace('"p.yaml"', '[ThisLaunchFileDir(), "/p.yaml"]')
        ),
        "p.yaml": f"n0:\n  ros__parameters:\n{values}",
    }


def _shared_params(count: int) -> Mapping[str, str]:
    node = NODE.replace("),", ', parameters=[[ThisLaunchFileDir(), "/p.yaml"]]),')
    sections = each(count, "n#:\n  ros__parameters: {frame_id: f#}\n")
    return {"a.launch.py": LAUNCH_PY.format(each(count, node)), "p.yaml": sections}


LAUNCHED: Mapping[str, Files] = {
    "py nodes": _python(lambda n: each(n, NODE)),
    "py nodes of robots": _python(lambda n: each(n, NODE.replace("),", ', namespace="robot#"),'))),
    "py comments": _python(lambda n: NODE + each(n, "## comment # (of [many\n")),
    "py groups": _python(lambda n: each(n, f"GroupAction([PushRosNamespace('r#'), {NODE}]),")),
    "py nested groups": _python(
        lambda n: within(n // 5, "GroupAction([PushRosNamespace('r#'), ", NODE, "]),")
    ),
    "py remaps": _python(
        lambda n: NODE.replace("),", ", remappings=[" + each(n, "('a#', 'b#'),") + "]),")
    ),
    "py parameters": _python(
        lambda n: NODE.replace("),", ", parameters=[{" + each(n, "'a#': 'b#',") + "}]),")
    ),
    "py parameter dicts": _python(
        lambda n: NODE.replace("),", ", parameters=[" + each(n, "{'a#': 'b#'},") + "]),")
    ),
    "py arguments": _python(
        lambda n: each(n, "DeclareLaunchArgument('a#', default_value='b'),") + NODE
    ),
    "py arguments of arguments": _python(
        lambda n: (
            "DeclareLaunchArgument('a0', default_value='b'),"
            + each(n, "DeclareLaunchArgument('a@', default_value=LaunchConfiguration('a#')),")
            + NODE
        )
    ),
    "py set parameters": _python(lambda n: each(n, "SetParameter('a#', 1),") + NODE),
    "py set remaps": _python(lambda n: each(n, "SetRemap('a#', 'b#'),") + NODE),
    "py long name": _python(lambda n: NODE.replace("n#", "n" * 200 * n)),
    "py long text": _python(lambda n: NODE + f"LogInfo(msg='{'x ' * 200 * n}'),"),
    "py timers": _python(lambda n: each(n, f"TimerAction(period=1.0, actions=[{NODE}]),")),
    "py components": _python(
        lambda n: (
            "ComposableNodeContainer(package='rclcpp_components', name='c', namespace='',"
            "executable='component_container', composable_node_descriptions=["
            + each(n, "ComposableNode(package='a', plugin='a::B', name='n#'),")
            + "]),"
        )
    ),
    "py processes": _python(
        lambda n: each(n, f"ExecuteProcess(cmd=[{_TALKER}, '-r', '__node:=n#']),")
    ),
    "py words of a process": _python(
        lambda n: (
            "ExecuteProcess(cmd=['ros2', 'run', 'demo_nodes_cpp', 'talker', '--ros-args', "
            + each(n, "'-r', 'a#:=b#',")
            + "]),"
        )
    ),
    "py static transforms": _python(
        lambda n: each(
            n,
            "Node(package='tf2_ros', executable='static_transform_publisher', name='s#',"
            " arguments=['--frame-id', 'f#', '--child-frame-id', 'f@']),",
        )
    ),
    "py conditions": _python(
        lambda n: (
            "DeclareLaunchArgument('a', default_value='true'),"
            + each(n, NODE.replace("),", ", condition=IfCondition(LaunchConfiguration('a'))),"))
        )
    ),
    "py unknown actions": _python(
        lambda n: each(n, "OpaqueFunction(function=lambda c: 1/0),") + NODE
    ),
    "py bridges": _python(
        lambda n: (
            "Node(package='ros_gz_bridge', executable='parameter_bridge', name='b', arguments=["
            + each(
                n,
                "'/t#@std_msgs/msg/String[gz.msgs.StringMsg'.replace('@', chr(64)),".replace(
                    "@s", "\0s"
                ).replace("'@'", "'\0'"),
            ).replace("\0", "@")
            + "]),"
        )
    ),
    "py wide includes": _wide_includes,
    "py parameter file": _with_params,
    "py parameter file of all": _shared_params,
    "xml nodes": _xml(lambda n: each(n, XML_NODE)),
    "xml comments": _xml(lambda n: XML_NODE + each(n, "<!-- part # of <many> -->\n")),
    "xml groups": _xml(
        lambda n: each(n, f"<group><push-ros-namespace namespace='r#'/>{XML_NODE}</group>")
    ),
    "xml nested groups": _xml(lambda n: within(n // 5, "<group>", XML_NODE, "</group>")),
    "xml remaps": _xml(
        lambda n: XML_NODE.replace("/>", ">" + each(n, '<remap from="a#" to="b#"/>') + "</node>")
    ),
    "xml parameters": _xml(
        lambda n: XML_NODE.replace("/>", ">" + each(n, '<param name="a#" value="b#"/>') + "</node>")
    ),
    "xml parameters in parameters": _xml(
        lambda n: XML_NODE.replace(
            "/>",
            ">"
            + within(n // 5, '<param name="a#">', '<param name="b" value="c"/>', "</param>")
            + "</node>",
        )
    ),
    "xml arguments": _xml(lambda n: each(n, '<arg name="a#" default="b"/>') + XML_NODE),
    "xml substitutions": _xml(
        lambda n: '<arg name="a" default="b"/>' + XML_NODE.replace("n#", "$(var a)" * n)
    ),
    "xml nested substitutions": _xml(
        lambda n: (
            '<arg name="b" default="b"/>'
            + XML_NODE.replace("n#", within(n // 5, "$(var ", "b", ")"))
        )
    ),
    "xml expression": _xml(lambda n: XML_NODE.replace("n#", "$(eval '" + "1+" * n + "1')")),
    "xml lets": _xml(
        lambda n: (
            '<let name="a0" value="b"/>' + each(n, '<let name="a@" value="$(var a#)"/>') + XML_NODE
        )
    ),
    "xml chain of includes": lambda n: _chain_of_includes(n // 5),
    "xml one include": _same_include,
    "yaml nodes": _yaml(lambda n: each(n, YAML_NODE)),
    "yaml comments": _yaml(lambda n: YAML_NODE + each(n, "## part # of [many\n")),
    "yaml remaps": _yaml(
        lambda n: YAML_NODE.replace("n#}", "n#, remap: [" + each(n, "{from: a#, to: b#},") + "]}")
    ),
    "yaml parameters": _yaml(
        lambda n: YAML_NODE.replace(
            "n#}", "n#, param: [" + each(n, "{name: a#, value: b#},") + "]}"
        )
    ),
    "yaml arguments": _yaml(lambda n: each(n, "- arg: {name: a#, default: b}\n") + YAML_NODE),
    "yaml groups": _yaml(
        lambda n: each(
            n,
            "- group: [{push_ros_namespace: {namespace: r#}},"
            " {node: {pkg: demo_nodes_cpp, exec: talker, name: n#}}]\n",
        )
    ),
}


def launch_file(files: Mapping[str, str]) -> str:
    """Return the one that includes the others."""
    return next(it for it in files if it.startswith("a.launch"))


def written(folder: Path, files: Mapping[str, str]) -> Path:
    """Return the folder, with these files in it."""
    folder.mkdir(exist_ok=True)
    write_files(folder, files)
    return folder


# ---- graphs

QOS = {"history": "keep_last", "depth": 10, "reliability": "reliable", "durability": "volatile"}


def _end(
    node: str,
    topic: str,
    role: str = "publishes",
    type_: str = "std_msgs/msg/String",
    kind: str = "topic",
) -> dict[str, object]:
    return {
        "kind": kind,
        "role": role,
        "name": topic,
        "type": type_,
        "type_hash": "",
        "node": node,
        "qos": None,
        "process": "",
    }


def _edge(child: str, parent: str, static: bool = False, sender: str = "/n0") -> dict[str, object]:
    return {
        "child": child,
        "parent": parent,
        "topic": "/tf_static" if static else "/tf",
        "static": static,
        "publishers": [sender],
        "transform": [],
    }


def snapshot(nodes: Iterable[str], ends: Iterable[object], edges: Iterable[object] = ()) -> str:
    """Return a saved graph."""
    environment = json.loads((FIXTURES / "graphs" / "healthy.json").read_text())["environment"]
    return json.dumps(
        {
            "schema": 2,
            "nodes": [{"name": it} for it in nodes],
            "ends": [*ends],
            "edges": [*edges],
            "environment": environment,
        },
        indent=0,
    )


def _many(count: int, text: str) -> list[str]:
    return [text.replace("#", str(at)) for at in range(count)]


GRAPHS: Mapping[str, Callable[[int], str]] = {
    "nodes": lambda n: snapshot(_many(n, "/n#"), []),
    "nodes of one name": lambda n: snapshot(["/n"] * n, []),
    "robots": lambda n: snapshot(
        _many(n, "/robot#/n"),
        [
            _end(f"/robot{at}/n", f"/robot{at}/scan", role, "sensor_msgs/msg/LaserScan")
            for at in range(n)
            for role in ("publishes", "subscribes")
        ],
    ),
    "robots with one tf": lambda n: snapshot(
        _many(n, "/robot#/rsp") + _many(n, "/robot#/amcl"),
        [
            _end(f"/robot{at}/{node}", "/tf", "publishes", "tf2_msgs/msg/TFMessage")
            for at in range(n)
            for node in ("rsp", "amcl")
        ],
        [
            _edge(f"robot{at}/l{link + 1}", f"robot{at}/l{link}", sender=f"/robot{at}/rsp")
            for at in range(n)
            for link in range(4)
        ],
    ),
    "robots by postfix": lambda n: snapshot(
        _many(n, "/n_robot#"),
        [
            _end(f"/n_robot{at}", f"/scan_robot{at}", role, "sensor_msgs/msg/LaserScan")
            for at in range(n)
            for role in ("publishes", "subscribes")
        ],
    ),
    "topics of a node": lambda n: snapshot(["/n0"], [_end("/n0", it) for it in _many(n, "/t#")]),
    "topics read, none sent": lambda n: snapshot(
        ["/n0"], [_end("/n0", it, "subscribes") for it in _many(n, "/t#")]
    ),
    "senders of a topic": lambda n: snapshot(
        _many(n, "/n#"),
        [_end(it, "/cmd_vel", "publishes", "geometry_msgs/msg/Twist") for it in _many(n, "/n#")],
    ),
    "ends of a topic": lambda n: snapshot(
        _many(n, "/n#"),
        [_end(it, "/t", role) for it in _many(n, "/n#") for role in ("publishes", "subscribes")],
    ),
    "types of a topic": lambda n: snapshot(
        _many(n, "/n#"), [_end(f"/n{at}", "/t", "publishes", f"a/msg/T{at}") for at in range(n)]
    ),
    "services": lambda n: snapshot(
        _many(n, "/n#"),
        [
            _end(f"/n{at}", f"/n{at}/set", "serves", "std_srvs/srv/Trigger", "service")
            for at in range(n)
        ],
    ),
    "servers of a service": lambda n: snapshot(
        _many(n, "/n#"),
        [_end(f"/n{at}", "/set", "serves", "std_srvs/srv/Trigger", "service") for at in range(n)],
    ),
    "actions": lambda n: snapshot(
        _many(n, "/n#"),
        [_end(f"/n{at}", f"/n{at}/go", "serves", "a/action/Go", "action") for at in range(n)],
    ),
    "frames in a chain": lambda n: snapshot(
        ["/n0"],
        [_end("/n0", "/tf", "publishes", "tf2_msgs/msg/TFMessage")],
        [_edge(f"f{at + 1}", f"f{at}") for at in range(n)],
    ),
    "frames in a star": lambda n: snapshot(
        ["/n0"],
        [_end("/n0", "/tf", "publishes", "tf2_msgs/msg/TFMessage")],
        [_edge(f"f{at + 1}", "f") for at in range(n)],
    ),
    "frames apart": lambda n: snapshot(
        ["/n0"],
        [_end("/n0", "/tf", "publishes", "tf2_msgs/msg/TFMessage")],
        [_edge(f"f{at}", f"g{at}") for at in range(n)],
    ),
    "parents of a frame": lambda n: snapshot(
        ["/n0"],
        [_end("/n0", "/tf", "publishes", "tf2_msgs/msg/TFMessage")],
        [_edge("f", f"g{at}") for at in range(n)],
    ),
    "frames in a circle": lambda n: snapshot(
        ["/n0"],
        [_end("/n0", "/tf", "publishes", "tf2_msgs/msg/TFMessage")],
        [_edge(f"f{(at + 1) % n}", f"f{at}") for at in range(n)],
    ),
    "deep namespaces": lambda n: snapshot(
        ["/a" * (n // 5) + "/n"], [_end("/a" * (n // 5) + "/n", "/a" * (n // 5) + "/t")]
    ),
    "long names": lambda n: snapshot(
        ["/" + "a" * 100 * n], [_end("/" + "a" * 100 * n, "/" + "b" * 100 * n)]
    ),
}


def graph_of(name: str, count: int, folder: Path) -> Path:
    """Return the graph as a file."""
    path = folder / f"{count}.json"
    path.write_text(GRAPHS[name](count))
    return path


# ---- fleets

TWO = "robots: [{name: a}, {name: b}]\n"
COMMON = f"layout: frames-per-robot\ndescription: rover.urdf\n{TWO}"


def _of_rover(key: str, file: str, text: Callable[[int], str]) -> Files:
    """Return a fleet of two rovers with one file that grows; its name has __ for its dot."""
    named = file.replace("__", ".")
    fleet = f"{COMMON}related_files: {{{key}: {named}}}\n"
    return lambda n: {"fleet": fleet, file: text(n)}


def _semantic(inner: str) -> Files:
    robots = (f"  - {{name: {it}, description: rover.urdf, srdf: rover.srdf}}\n" for it in "ab")
    fleet = f"robots:\n{''.join(robots)}"
    return lambda n: {
        "fleet": fleet,
        "rover__srdf": f'<robot name="rover">{each(n, inner)}</robot>',
    }


_LUA = 'x# = "odom", -- [[ a\\ntracking_frame = "lidar_link",\\n'
FLEETS: Mapping[str, Files] = {
    "robots": lambda n: {
        "fleet": "layout: both\nnode_sets: nav2\ndescription: rover.urdf\nrobots:\n"
        + each(n // 8, "- {name: robot#}\n")
    },
    "comments": lambda n: {"fleet": each(n, "## comment # {of [many\n") + COMMON},
    "shared topics": lambda n: {"fleet": COMMON + "shared_topics:\n" + each(n, "- /t#\n")},
    "shared frames": lambda n: {"fleet": COMMON + "shared_frames:\n" + each(n, "- t#\n")},
    "arguments": lambda n: {
        "fleet": "robots:\n- {name: a, description: arm.urdf.xacro, srdf: arm.srdf, arguments: {"
        + each(n, "x#: y, ")
        + "}}\n",
        "arm__urdf__xacro": ARM.replace(
            "<xacro:arg", each(n, '<xacro:arg name="x#" default="1"/>') + "<xacro:arg", 1
        ),
    },
    "Lua": _of_rover("lua", "slam__lua", lambda n: "a = {" + each(n, _LUA) + "}"),
    "displays": _of_rover(
        "rviz",
        "one_robot__rviz",
        lambda n: (
            "Visualization Manager:\n  Displays:\n"
            + each(
                n, "    - {Class: rviz_default_plugins/LaserScan, Name: d#, Topic: {Value: /s#}}\n"
            )
        ),
    ),
    "nodes of parameters": _of_rover(
        "params", "params__yaml", lambda n: each(n, "n#:\n  ros__parameters:\n    topic: s#\n")
    ),
    "parameters": _of_rover(
        "params",
        "params__yaml",
        lambda n: "amcl:\n  ros__parameters:\n" + each(n, "    x#_frame: base_link\n"),
    ),
    "bridged topics": _of_rover(
        "bridge",
        "bridge__yaml",
        lambda n: each(
            n,
            "- {ros_topic_name: s#, gz_topic_name: s#, direction: GZ_TO_ROS,"
            " ros_type_name: sensor_msgs/msg/LaserScan, gz_type_name: gz.msgs.LaserScan}\n",
        ),
    ),
    "pairs of an SRDF": _semantic(
        '<disable_collisions link1="base_link" link2="lidar_link" reason="Never"/>\n'
    ),
    "groups of an SRDF": _semantic('<group name="g#"><joint name="lidar_joint"/></group>\n'),
}
MESSAGE = fixture_text("growing_files_message.yaml")


def message(count: int) -> str:
    """Return what ``ros2 topic echo`` prints of a rosgraph_msgs/Graph."""
    return f"nodes:\n{each(count, MESSAGE)}"


# ---- graphs in the lines of the examples of rules

_ROBOT, _NAME = re.compile(r"robot(\d+)"), re.compile(r"(^|\s)/(\w+)")
_OF_ALL = ("tf", "tf_static", "clock", "map")


def copies(example: str, count: int) -> str:
    """Return the example for so many other robots and nodes, each of its lines once."""
    lines = (line for at in range(count) for line in _copy(example, at).splitlines())
    return "\n".join(dict.fromkeys(lines))


def _copy(example: str, at: int) -> str:
    def named(it: re.Match[str]) -> str:
        kept = it[2] in _OF_ALL or _ROBOT.fullmatch(it[2])
        return it[0] if kept else f"{it[1]}/{it[2]}_{at}"

    return _NAME.sub(named, _ROBOT.sub(lambda it: f"robot{int(it[1]) + 10 * at}", example))
