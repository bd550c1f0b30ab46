# SPDX-License-Identifier: Apache-2.0
"""What a fleet starts -> ``fleet.launch.py``: plain launch and launch_ros, to be read and edited."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from textwrap import wrap
from typing import Any

from multibot_rewrite.fleet.launch.each_robot import Written, functions
from multibot_rewrite.fleet.launch.starts import (
    CLASSIC,
    GZ,
    Component,
    File,
    FleetStarts,
    RobotStarts,
    Start,
    Text,
    launch_arguments,
)
from multibot_rewrite.fleet.outputs.relays import BRIDGE, not_bridged

_Files = tuple[File, ...]
# What brings topics of a simulator is of no use without it.
BRIDGES = "ros_gz_bridge"
# What ament_flake8 allows, what stays in one line, and robots of which each has its line to drive.
WIDTH, _SHORT, _DRIVING = 99, 64, 4
_FLAG = re.compile(r"-{1,2}[A-Za-z][\w-]*")
_TEXTS = re.compile(r'"(?:[^"\\]|\\.)*"')
# A key with its value, which may be a list or a call.
# A docstring, a comment, a string: whichever begins first.
_TOKEN = re.compile(r'"""[\s\S]*?"""|#[^\n]*|\'(?:[^\'\\\n]|\\.)*\'|f?"(?:[^"\\\n]|\\.)*"')
_ENTRY = re.compile(rf"{_TEXTS.pattern}: (?:\[[^\]]*\]|\{{[^}}]*\}}|\w+\([^)]*\)|[^,\[{{]+)")


# The names that it imports where it uses them, in this order.
_IMPORTS = {
    "ament_index_python.packages": ("PackageNotFoundError", "get_package_prefix"),
    "launch": ("LaunchDescription",),
    "launch.actions": (
        *("DeclareLaunchArgument", "EmitEvent", "GroupAction", "IncludeLaunchDescription"),
        *("LogInfo", "OpaqueFunction", "RegisterEventHandler"),
    ),
    "launch.conditions": ("IfCondition",),
    "launch.events": ("matches_action",),
    "launch.substitutions": ("LaunchConfiguration", "PathJoinSubstitution", "PythonExpression"),
    "launch_ros.actions": ("ComposableNodeContainer", "LifecycleNode", "Node"),
    "launch_ros.descriptions": ("ComposableNode",),
    "launch_ros.event_handlers": ("OnStateTransition",),
    "launch_ros.events.lifecycle": ("ChangeState",),
    "launch_ros.parameter_descriptions": ("ParameterValue",),
    "launch_ros.substitutions": ("FindPackageShare",),
    "lifecycle_msgs.msg": ("Transition",),
}
_BODY = '''\
FOLDER = Path(__file__).resolve().parent
CLOCK = {"use_sim_time": ParameterValue(LaunchConfiguration("use_sim_time"), value_type=bool)}


def file(name):
    """Return the path of a file beside this one."""
    return str(FOLDER / name)


def text(name):
    """Return what a file beside this one holds, as a parameter."""
    return ParameterValue((FOLDER / name).read_text(), value_type=str)
'''
_INSTALLED = '''\
def if_installed(package, otherwise, actions):
    """Return the actions if the package is installed, else a line that says what is missing."""
    try:
        get_package_prefix(package)
    except PackageNotFoundError:
        return [LogInfo(msg=otherwise)]
    return actions
'''
_BROUGHT_UP = '''\
def brought_up(node):
    """Start a node with a life cycle: configure it, and activate it when that is done."""

    def change(transition):
        matched = matches_action(node)
        event = ChangeState(lifecycle_node_matcher=matched, transition_id=transition)
        return EmitEvent(event=event)

    configured = OnStateTransition(
        target_lifecycle_node=node,
        start_state="configuring",
        goal_state="inactive",
        entities=[change(Transition.TRANSITION_ACTIVATE)],
    )
    return [node, RegisterEventHandler(configured), change(Transition.TRANSITION_CONFIGURE)]
'''
_CHOSEN = '''\
def first(count):
    """Return the names of so many robots."""
    if not 0 < count <= len(ROBOTS):
        more = f"multibot build FLEET -o {FOLDER} --count {count}"
        raise RuntimeError(f"robots:={count}: {len(ROBOTS)} robots were built; for more: {more}")
    return list(ROBOTS)[:count]


def chosen(context):
    """Start the robots that robots:= names, or so many of them; all of them by default."""
    words = LaunchConfiguration("robots").perform(context).replace(",", " ").split()
    if len(words) == 1 and words[0].isdigit():
        words = first(int(words[0]))
    unknown = [it for it in words if it not in ROBOTS]
    if unknown:
        known = ", ".join(ROBOTS)
        raise RuntimeError(f"robots:={unknown[0]} is not in this fleet; it has {known}")
    return [action for name in words or ROBOTS for action in ROBOTS[name]()]
'''


def to_python(it: FleetStarts) -> str:
    """The text of the file."""
    body = _text(_BODY.splitlines(), *_parts(it))
    return _single_quoted(_text(_head(it), _imports(body)) + body)


def _single_quoted(text: str) -> str:
    """The text as ament_flake8 wants it: single quotes but for a string that has one."""
    return _TOKEN.sub(lambda it: _quotes_of(it[0]), text)


def _quotes_of(token: str) -> str:
    inner = token.removeprefix("f")[1:-1]
    is_plain = token.removeprefix("f").startswith('"') and not token.endswith('"""')
    if not is_plain or "'" in inner or "\\" in inner:
        return token
    return f"{'f' * token.startswith('f')}'{inner}'"


def _text(*parts: Iterable[str]) -> str:
    return "".join(f"{line}\n" for part in parts for line in part)


def _parts(it: FleetStarts) -> Iterator[Iterable[str]]:
    if any(robot.bridged_tf for robot in it.robots):
        yield "", "", *_INSTALLED.splitlines()
    if any(start.brought_up for robot in it.robots for start in robot.starts):
        yield "", "", *_BROUGHT_UP.splitlines()
    made = functions([_written(robot) for robot in it.robots])
    for own in made:
        yield ("", "", *own.lines)
    calls = dict(call for own in made for call in own.calls)
    names = (f'    "{robot.name}": {calls[robot.name]},' for robot in it.robots)
    yield "", "", "ROBOTS = {", *names, "}", "", "", *_CHOSEN.splitlines()
    yield from (("", "", *_SWITCHES[one]) for one in it.simulators)
    yield "", "", *_description(it)


def _head(it: FleetStarts) -> Iterator[str]:
    yield f'"""{it.head}'
    yield ""
    yield "Plain launch and launch_ros: read it, edit it, or include it from another launch file."
    yield ""
    yield "    ros2 launch fleet.launch.py"
    yield f"    ros2 launch fleet.launch.py robots:={it.robots[0].name}"
    if it.driving:
        yield ""
        shown = it.driving if len(it.driving) <= _DRIVING else it.driving[:1]
        yield "In other terminals, to drive:"
        yield ""
        yield from (line for one in shown for line in _shell(one))
        if len(shown) < len(it.driving):
            yield ""
            yield f"The other robots likewise: with their names in the place of {it.robots[0].name}."
    yield '"""'
    yield ""


def _imports(body: str) -> Iterator[str]:
    if "partial(" in body:
        yield "from functools import partial"
    yield from ("from pathlib import Path", "")
    used = frozenset(re.findall(r"\w+", body))
    for module, every in _IMPORTS.items():
        names = [name for name in every if name in used]
        if module == "launch.actions" and names:
            yield from (f"from {module} import (", *(f"    {name}," for name in names), ")")
        elif names:
            yield f"from {module} import {', '.join(names)}"
    yield ""


def _shell(line: str) -> Iterator[str]:
    """A command for a shell, at most as wide as the file."""
    words = wrap(line, WIDTH - 6, break_long_words=False, break_on_hyphens=False)
    for number, it in enumerate(words):
        indent, more = "    " * bool(number), " \\" * (number + 1 < len(words))
        yield f"    {indent}{it}{more}"


def _written(it: RobotStarts) -> Written:
    return Written(it.name, it.about, it.about.partition(".")[0], list(_robot(it)))


def _robot(it: RobotStarts) -> Iterator[str]:
    for name, why in it.left:
        if why:
            text = f"Not started: {name} ({why})"
            yield from (f"    # {line}" for line in wrap(text, WIDTH - 6))
    if it.files:
        yield f"    params = [{', '.join(_value(File(path)) for path in it.files)}]"
    own = tuple(File(path) for path in it.files)
    yield "    return ["
    for start in it.starts:
        yield from _process(start, 8, own)
    if it.bridged_tf:
        yield "        *if_installed("
        yield f"            {_quoted(BRIDGE)},"
        yield f"            {_quoted(not_bridged(it.name))},"
        yield "            ["
        for start in it.bridged_tf:
            yield from _process(start, 16)
        yield "            ],"
        yield "        ),"
    yield from _group(it.spawned, "simulator", 8)
    yield from _group(it.windows, "rviz", 8)
    yield "    ]"


def _group(starts: Sequence[Start], argument: str, indent: int) -> Iterator[str]:
    """What is started where a launch argument is true."""
    if not starts:
        return
    space = " " * indent
    yield f"{space}GroupAction("
    yield f"{space}    ["
    for start in starts:
        yield from _process(start, indent + 8)
    yield f"{space}    ],"
    yield f'{space}    condition=IfCondition(LaunchConfiguration("{argument}")),'
    yield f"{space}),"


def _process(it: Start, indent: int, own: _Files = (), action: str = "Node") -> Iterator[str]:
    space = " " * indent
    if it.brought_up:
        yield f"{space}*brought_up("
        yield from _process(it._replace(brought_up=False), indent + 4, own, "LifecycleNode")
        yield f"{space}),"
        return
    yield f"{space}{'ComposableNodeContainer' if it.components else action}("
    yield from (f"{space}    {line}" for line in _keywords(it, own))
    if it.components:
        yield f"{space}    composable_node_descriptions=["
        for one in it.components:
            yield from _component(one, indent + 8, own)
        yield f"{space}    ],"
    yield f"{space}),"


def _keywords(it: Start, own: _Files) -> Iterator[str]:
    yield f'package="{it.package}",'
    yield f'executable="{it.executable}",'
    yield from _names(it.namespace, it.name)
    if it.arguments:
        yield from _list("arguments", [*_pairs(it.arguments)])
    yield from _given(it.parameters, it.remappings, own)
    yield 'output="screen",'


def _names(namespace: str, name: str) -> Iterator[str]:
    if namespace:
        yield f'namespace="{namespace}",'
    if name:
        yield f'name="{name}",'


def _given(
    parameters: Sequence[File | Mapping[str, Any]],
    remappings: Iterable[tuple[str, str]],
    own: _Files,
) -> Iterator[str]:
    """``own`` are the files that the robot's function calls ``params``."""
    common = bool(own) and tuple(parameters[: len(own)]) == own
    words = ["*params"] if common else []
    words += [_value(it) for it in parameters[len(own) * common :]]
    yield from _list("parameters", [*words, "CLOCK"])
    pairs = list(remappings)
    if pairs:
        yield "remappings=["
        yield from (f"    ({_value(old)}, {_value(new)})," for old, new in pairs)
        yield "],"


def _list(key: str, items: Sequence[str]) -> Iterator[str]:
    """A keyword with a list: in one line where that is short, whatever the names of robots are."""
    line = f"{key}=[{', '.join(items)}],"
    if _is_short(line):
        yield line
        return
    yield f"{key}=["
    yield from (f"    {line}" for it in items for line in _item(it))
    yield "],"


def _is_short(text: str) -> bool:
    """Does it stay in one line? Robots that only a number tells apart look the same."""
    return len(re.sub(r"\d", "", text)) <= _SHORT


def _item(it: str) -> Iterator[str]:
    """An item of a list; a long dictionary or list of words in several lines."""
    if _is_short(it) or not it.startswith("{"):
        yield f"{it},"
        return
    yield "{"
    for text in _ENTRY.findall(it[1:-1]):
        yield from (f"    {line}" for line in _entry(text))
    yield "},"


def _entry(text: str) -> Iterator[str]:
    key, _, value = text.partition(": ")
    if _is_short(text) or not value.startswith("["):
        yield f"{text},"
        return
    yield f"{key}: ["
    yield from (f"    {it}," for it in _TEXTS.findall(value))
    yield "],"


def _pairs(words: Iterable[str | File]) -> Iterator[str]:
    """The arguments of a program: a flag and its value stand together."""
    flag = ""
    for it in words:
        is_flag = isinstance(it, str) and _FLAG.fullmatch(it) is not None
        if flag and is_flag:
            yield flag
            flag = ""
        if is_flag:
            flag = _value(it)
        else:
            yield f"{flag}, {_value(it)}" if flag else _value(it)
            flag = ""
    if flag:
        yield flag


def _component(it: Component, indent: int, own: _Files) -> Iterator[str]:
    space = " " * indent
    yield f"{space}ComposableNode("
    yield f'{space}    package="{it.package}",'
    yield f'{space}    plugin="{it.plugin}",'
    lines = (*_names(it.namespace, it.name), *_given(it.parameters, it.remappings, own))
    yield from (f"{space}    {line}" for line in lines)
    yield f"{space}),"


def _value(it: Any) -> str:
    if isinstance(it, File):
        return f"file({_quoted(it.path)})"
    if isinstance(it, Text):
        return f"text({_quoted(it.path)})"
    if isinstance(it, str):
        return _quoted(it)
    if isinstance(it, Mapping):
        return "{" + ", ".join(f"{_quoted(key)}: {_value(one)}" for key, one in it.items()) + "}"
    if isinstance(it, list):
        return f"[{', '.join(map(_value, it))}]"
    return repr(it)


def _quoted(text: str) -> str:
    import json

    return json.dumps(text)


def _description(it: FleetStarts) -> Iterator[str]:
    yield "def generate_launch_description():"
    yield '    """Start the simulator, then robot by robot, then the windows for all."""'
    yield "    return LaunchDescription("
    yield "        ["
    for name, default, about in launch_arguments(it):
        yield "            DeclareLaunchArgument("
        yield f'                "{name}",'
        yield f"                default_value={_value(default)},"
        yield f'                description="{about}",'
        yield "            ),"
    for simulator in it.simulators:
        yield from (f"            {line}" for line in _SIMULATORS[simulator])
    inside = [start for start in it.shared if it.simulators and start.package == BRIDGES]
    yield from _group(inside, "simulator", 12)
    for start in (start for start in it.shared if start not in inside):
        yield from _process(start, 12)
    yield "            OpaqueFunction(function=chosen),"
    yield from _group(it.windows, "rviz", 12)
    yield "        ]"
    yield "    )"


_SIMULATORS: Mapping[str, tuple[str, ...]] = {
    GZ: (
        "IncludeLaunchDescription(",
        "    PathJoinSubstitution(",
        '        [FindPackageShare("ros_gz_sim"), "launch", "gz_sim.launch.py"]',
        "    ),",
        "    launch_arguments=[",
        '        ("gz_args", ["-r ", HEADLESS, \'"\', LaunchConfiguration("world"), \'"\']),',
        "    ],",
        '    condition=IfCondition(LaunchConfiguration("simulator")),',
        "),",
    ),
    CLASSIC: (
        "IncludeLaunchDescription(",
        "    PathJoinSubstitution(",
        '        [FindPackageShare("gazebo_ros"), "launch", "gazebo.launch.py"]',
        "    ),",
        "    launch_arguments=[",
        '        ("gui", GUI),',
        '        ("world", LaunchConfiguration("world")),',
        "    ],",
        '    condition=IfCondition(LaunchConfiguration("simulator")),',
        "),",
    ),
}
_SWITCHES: Mapping[str, tuple[str, ...]] = {
    GZ: (
        "HEADLESS = PythonExpression(",
        """    ["'-s ' if '", LaunchConfiguration("headless"), "'.lower() == 'true' else ''"]""",
        ")",
    ),
    CLASSIC: (
        "GUI = PythonExpression(",
        """    ["'false' if '", LaunchConfiguration("headless"), "'.lower() == 'true' else 'true'"]""",
        ")",
    ),
}
