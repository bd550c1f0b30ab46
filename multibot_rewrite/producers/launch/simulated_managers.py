"""Descriptions that a launch publishes -> the controller managers that plugins of a simulator make of
them, as nodes that the launch would start.

Source: gz_ros2_control of humble to rolling, gz_ros2_control_plugin.cpp: each file of ``<parameters>``
is an argument ``--params-file``, rules of ``<ros>`` are arguments, too; ``use_sim_time`` is true.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping

from multibot_rewrite.model import InputError
from multibot_rewrite.producers.launch.records import LaunchedNode, ParameterText
from multibot_rewrite.readback.nodes import ReadNode
from multibot_rewrite.readback.reading import read
from multibot_rewrite.readback.xml import read_xml, values_at
from multibot_rewrite.record import NamedTuple
from multibot_rewrite.rewriters.vocabulary import load_vocabulary
from multibot_rewrite.system.records import Place

_NAMED = "controller_manager_name"
_PROGRAM = ("controller_manager", "ros2_control_node")
_CLOCK = ParameterText("", "/**:\n  ros__parameters: {use_sim_time: true}\n")


class Published(NamedTuple):
    """A description that a node of the launch has as a parameter, and where the launch file says it."""

    text: str
    place: Place


def simulated_managers(
    published: Iterable[Published],
    files: Mapping[str, ParameterText],
    asked: Collection[str],
    release: str,
) -> Iterator[LaunchedNode]:
    """The managers of the descriptions that spawners ask for, by their full names; ``files`` are those
    that descriptions name."""
    for it in dict.fromkeys(published) if asked else ():
        try:
            nodes = read(it.text.encode(), it.place.file, load_vocabulary((), release)).nodes
            plugins = [*read_xml(it.text.encode(), it.place.file).iter("plugin")]
        except InputError:
            # That nothing is known of the description is said where its transforms are asked for.
            continue
        for node in nodes:
            if _is_manager(node) and node.full_name in asked:
                named = values_at(plugins[node.number], "parameters")
                texts = (files[path.strip()] for path in named if path.strip() in files)
                yield _manager(node, texts, it.place)


def _is_manager(node: ReadNode) -> bool:
    return any(site.path == _NAMED for site in node.section.sites)


def _manager(node: ReadNode, texts: Iterable[ParameterText], place: Place) -> LaunchedNode:
    read_rules = (it.rule for it in node.rules)
    rules = ((f"{it.node}:{it.source}".lstrip(":"), it.target) for it in read_rules)
    given = (*texts, _CLOCK)
    home = node.namespace or "/"
    return LaunchedNode(*_PROGRAM, node.name, home, tuple(rules), given, "", (), "", place)
