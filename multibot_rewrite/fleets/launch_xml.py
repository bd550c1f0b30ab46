"""What a fleet starts -> ``fleet.launch.xml``: the same as ``fleet.launch.py``, in launch's XML.

Source: launch_xml and launch_ros of humble to lyrical (``node``, ``node_container``, ``group``).
"""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Iterator, Mapping
from typing import Any
from xml.sax.saxutils import quoteattr

from multibot_rewrite.fleets.launch_python import CLASSIC, GZ, FleetStarts, launch_arguments
from multibot_rewrite.fleets.launch_records import Component, File, Start, Text

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
_CHOSEN = (
    "$(eval '\\'{0}\\' in \\'$(var robots)\\'.replace(\\',\\', \\' \\').split()"
    " or not \\'$(var robots)\\'"
    " or (\\'$(var robots)\\'.isdigit() and {1} < int(\\'$(var robots)\\'))')"
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
    for simulator in it.simulators:
        file, arguments = _SIMULATORS[simulator]
        yield f"  {_tag('include', '>', file=file, **{'if': '$(var simulator)'})}"
        yield from (f"    {_tag('arg', name=name, value=text)}" for name, text in arguments)
        yield "  </include>"
    for start in it.shared:
        yield from _process(start, 2)
    for at, robot in enumerate(it.robots):
        yield f"  <!-- {robot.about} -->"
        yield f"  {_tag('group', '>', **{'if': _CHOSEN.format(robot.name, at)})}"
        yield from _group(robot.starts, 4)
        for command in robot.commands:
            yield f"    {_tag('executable', cmd=shlex.join(['sh', '-c', command]))}"
        if robot.spawned:
            yield f"    {_tag('group', '>', **{'if': '$(var simulator)'})}"
            yield from _group(robot.spawned, 6)
            yield "    </group>"
        yield "  </group>"
    if it.windows:
        yield f"  {_tag('group', '>', **{'if': '$(var rviz)'})}"
        yield from _group(it.windows, 4)
        yield "  </group>"
    yield "</launch>"


def _group(starts: Iterable[Start], indent: int) -> Iterator[str]:
    for start in starts:
        yield from _process(start, indent)


def _tag(tag: str, end: str = "/>", /, **attributes: str) -> str:
    written = "".join(f" {key}={quoteattr(value)}" for key, value in attributes.items())
    return f"<{tag}{written}{end}"


def _process(it: Start, indent: int) -> Iterator[str]:
    space = " " * indent
    tag = "node_container" if it.components else "node"
    named = {"name": it.name} if it.name else {}
    spaced = {"namespace": it.namespace} if it.namespace else {}
    words = " ".join(_word(word) for word in it.arguments)
    given = {"args": words} if words else {}
    program = {"pkg": it.package, "exec": it.executable}
    yield space + _tag(tag, ">", **program, **named, **spaced, **given, output="screen")
    yield from _given(it.parameters, it.remappings, indent + 2)
    for one in it.components:
        yield from _component(one, indent + 2)
    yield f"{space}</{tag}>"


def _component(it: Component, indent: int) -> Iterator[str]:
    words = {"pkg": it.package, "plugin": it.plugin, "name": it.name, "namespace": it.namespace}
    yield " " * indent + _tag("composable_node", ">", **words)
    yield from _given(it.parameters, it.remappings, indent + 2)
    yield " " * indent + "</composable_node>"


def _given(
    parameters: Iterable[File | Mapping[str, Any]],
    remappings: Iterable[tuple[str, str]],
    indent: int,
) -> Iterator[str]:
    space = " " * indent
    for one in parameters:
        if isinstance(one, File):
            yield space + _tag("param", **{"from": f"$(var folder)/{one.path}"})
        else:
            yield from (space + _parameter(name, value) for name, value in one.items())
    yield space + _tag("param", name="use_sim_time", value="$(var use_sim_time)")
    yield from (space + _tag("remap", **{"from": old, "to": new}) for old, new in remappings)


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
