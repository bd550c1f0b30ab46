"""What a fleet starts -> ``fleet.launch.xml``: the same as ``fleet.launch.py``, in launch's XML.

Source: launch_xml and launch_ros of humble to lyrical (``node``, ``node_container``, ``group``,
``let``, ``log``, ``shutdown``).
"""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any
from xml.sax.saxutils import quoteattr

from multibot_rewrite.fleets.fleet_starts import (
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
from multibot_rewrite.fleets.relays import BRIDGE, not_bridged

_HEADLESS = "$(eval '\\'%s\\' if \\'$(var headless)\\'.lower() == \\'true\\' else \\'%s\\'')"
_SIMULATORS: Mapping[str, tuple[str, tuple[tuple[str, str], ...]]] = {
    GZ: (
        "$(find-pkg-share ros_gz_sim)/launch/gz_sim.launch.py",
        (("gz_args", f'-r {_HEADLESS % ("-s", "")} "$(var world)"'),),
    ),
    CLASSIC: (
        "$(find-pkg-share gazebo_ros)/launch/gazebo.launch.py",
        (("gui", _HEADLESS % ("false", "true")), ("world", "$(var world)")),
    ),
}
# Names that are worked out before anything starts; quotes inside eval are escaped.
_ASKED = "$(eval '\\'$(var robots)\\'.replace(\\',\\', \\' \\').split() or $(var fleet)')"
_REFUSED = (
    "$(eval 'not set($(var asked)) <= set($(var fleet))"
    " and \\'$(var robots)\\' not in map(str, range(1, len($(var fleet)) + 1))')"
)
_CHOSEN = (
    "$(eval '$(var fleet)[:int(\\'$(var robots)\\')]"
    " if \\'$(var robots)\\'.isdigit() else $(var asked)')"
)
_IS_CHOSEN = "$(eval '\\'{0}\\' in $(var chosen)')"
_MORE = "for more: multibot build FLEET -o $(var folder) --count N"
# launch's XML has no word for a life cycle. A transition that is refused ends with 0 (ros2lifecycle
# verb/set.py), so the state is asked for.
_BROUGHT_UP = (
    "until ros2 lifecycle get {0} | grep -q ^active; do ros2 lifecycle set {0} configure;"
    " ros2 lifecycle set {0} activate; sleep 1; done"
)
_INSTALLED = (
    "$(command 'sh -c \"ros2 pkg prefix {0} > /dev/null 2>&1 && echo true || echo false\"')"
)


def to_xml(it: FleetStarts) -> str:
    """The text of the file."""
    return "".join(f"{line}\n" for line in _lines(it))


def _lines(it: FleetStarts) -> Iterator[str]:
    yield '<?xml version="1.0"?>'
    yield f"<!-- {it.head.replace('--', '- -')} -->"
    yield "<launch>"
    for name, default, about in launch_arguments(it):
        told = f"$(dirname)/{default.path}" if isinstance(default, File) else default
        yield f"  {_tag('arg', name=name, default=told, description=about)}"
    # Behind an include $(dirname) may be the folder of the included file.
    yield f"  {_tag('let', name='folder', value='$(dirname)')}"
    yield from _below(_choice([robot.name for robot in it.robots]))
    if any(robot.bridged_tf for robot in it.robots):
        yield f"  {_tag('let', name=BRIDGE, value=_INSTALLED.format(BRIDGE))}"
    yield from _below(_group(_started(it), unless="$(var refused)"))
    yield "</launch>"


def _choice(names: Sequence[str]) -> Iterator[str]:
    """Which robots are started; robots that were not built are refused."""
    yield "<!-- robots:= has names of robots, or their number. -->"
    yield _tag("let", name="fleet", value=str(list(names)))
    yield _tag("let", name="asked", value=_ASKED)
    yield _tag("let", name="refused", value=_REFUSED)
    yield _tag("let", name="chosen", value=_CHOSEN, unless="$(var refused)")
    what = f"robots:=$(var robots): this fleet has {', '.join(names)}"
    yield _tag("log", message=f"{what}; {_MORE}", **{"if": "$(var refused)"})
    yield _tag("shutdown", reason=what, **{"if": "$(var refused)"})


def _started(it: FleetStarts) -> Iterator[str]:
    for simulator in it.simulators:
        file, arguments = _SIMULATORS[simulator]
        yield _tag("include", ">", file=file, **{"if": "$(var simulator)"})
        yield from (f"  {_tag('arg', name=name, value=text)}" for name, text in arguments)
        yield "</include>"
    for start in it.shared:
        yield from _process(start)
    for robot in it.robots:
        yield f"<!-- {robot.about} -->"
        yield from _group(_robot(robot), **{"if": _IS_CHOSEN.format(robot.name)})
    if it.windows:
        yield from _group(_processes(it.windows), **{"if": "$(var rviz)"})


def _robot(it: RobotStarts) -> Iterator[str]:
    yield from _processes(it.starts)
    if it.bridged_tf:
        yield from _group(_processes(it.bridged_tf), **{"if": f"$(var {BRIDGE})"})
        yield _tag("log", message=not_bridged(it.name), unless=f"$(var {BRIDGE})")
    if it.spawned:
        yield from _group(_processes(it.spawned), **{"if": "$(var simulator)"})
    if it.windows:
        yield from _group(_processes(it.windows), **{"if": "$(var rviz)"})


def _group(lines: Iterable[str], **condition: str) -> Iterator[str]:
    yield _tag("group", ">", **condition)
    yield from _below(lines)
    yield "</group>"


def _below(lines: Iterable[str]) -> Iterator[str]:
    return (f"  {line}" for line in lines)


def _processes(starts: Iterable[Start]) -> Iterator[str]:
    for start in starts:
        yield from _process(start)


def _tag(tag: str, end: str = "/>", /, **attributes: str) -> str:
    written = "".join(f" {key}={quoteattr(value)}" for key, value in attributes.items())
    return f"<{tag}{written}{end}"


def _process(it: Start) -> Iterator[str]:
    tag = "node_container" if it.components else "node"
    named = {"name": it.name} if it.name else {}
    spaced = {"namespace": it.namespace} if it.namespace else {}
    words = " ".join(_word(word) for word in it.arguments)
    given = {"args": words} if words else {}
    program = {"pkg": it.package, "exec": it.executable}
    yield _tag(tag, ">", **program, **named, **spaced, **given, output="screen")
    yield from _below(_given(it.parameters, it.remappings))
    for one in it.components:
        yield from _below(_component(one))
    yield f"</{tag}>"
    if it.brought_up:
        command = _BROUGHT_UP.format(f"{it.namespace.rstrip('/')}/{it.name}")
        yield _tag("executable", cmd=shlex.join(["sh", "-c", command]))


def _component(it: Component) -> Iterator[str]:
    words = {"pkg": it.package, "plugin": it.plugin, "name": it.name, "namespace": it.namespace}
    yield _tag("composable_node", ">", **words)
    yield from _below(_given(it.parameters, it.remappings))
    yield "</composable_node>"


def _given(
    parameters: Iterable[File | Mapping[str, Any]],
    remappings: Iterable[tuple[str, str]],
) -> Iterator[str]:
    for one in parameters:
        if isinstance(one, File):
            yield _tag("param", **{"from": f"$(var folder)/{one.path}"})
        else:
            yield from (_parameter(name, value) for name, value in one.items())
    yield _tag("param", name="use_sim_time", value="$(var use_sim_time)")
    yield from (_tag("remap", **{"from": old, "to": new}) for old, new in remappings)


def _parameter(name: str, value: Any) -> str:
    if isinstance(value, Text):
        content = f"$(command 'cat \"$(var folder)/{value.path}\"')"
        return _tag("param", name=name, value=content, type="str")
    if isinstance(value, File):
        return _tag("param", name=name, value=f"$(var folder)/{value.path}")
    if isinstance(value, list):
        return _tag("param", name=name, value=",".join(value), **{"value-sep": ","})
    return _tag("param", name=name, value=str(value).lower())


def _word(word: str | File) -> str:
    return f"$(var folder)/{word.path}" if isinstance(word, File) else shlex.quote(word)
