# SPDX-License-Identifier: Apache-2.0
"""Programs of a launch file that end as soon as they start.

Source: robot_state_publisher jazzy robot_state_publisher.cpp (its robot_description is XML); rmw
validate_node_name.c; ros_gz_sim jazzy create.cpp (gflags: a double); ros_gz_bridge jazzy
parameter_bridge.cpp.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.rosnames import check_node_name
from multibot_rewrite.description.checks.numbers import number
from multibot_rewrite.producers.launch.bridges import refused_rows
from multibot_rewrite.producers.launch.launched import Launched
from multibot_rewrite.producers.launch.programs import programs
from multibot_rewrite.rules.declaration import launch_rule
from multibot_rewrite.rules.places import at
from multibot_rewrite.spelling.records import Run
from multibot_rewrite.spelling.transforms import STATE_PUBLISHER

_NUMBERS = frozenset({"-x", "-y", "-z", "-R", "-P", "-Y"})


@launch_rule("MG729", "program-ends-at-once")
def ends(launched: Launched) -> Iterator[Finding]:
    """Where all that a node gets is known."""
    unsure = {(it.place.file, it.place.line) for it in launched.graph.notes}
    for it in launched.graph.nodes:
        fault = check_node_name(it.name) if it.name else None
        if fault:
            message = (
                f"node {it.name!r} of {it.package} has a name that ROS refuses: {fault.reason}"
            )
            yield at(ends, it.place, message, "write it with letters, digits and underscores")
        if f"{it.package}/{it.executable}" in programs().spawners:
            for flag, word in pairwise(it.arguments):
                if flag in _NUMBERS and number(word) is None:
                    message = f"{it.executable}: {flag} {word} is no number"
                    yield at(ends, it.place, message, "write a number")
    for node in launched.nodes:
        for word in refused_rows(node):
            message = f"{node.full_name}: {word!r} is no row of a bridge"
            yield at(ends, node.place, message, "write TOPIC@ROS_TYPE[GZ_TYPE, or ] to Gazebo")
        if (node.place.file, node.place.line) not in unsure:
            yield from _described(node)


def _described(it: Run) -> Iterator[Finding]:
    """An empty text is the output of a program that is not run here (producers/launch/commands.py)."""
    is_one = it.fact.known == STATE_PUBLISHER
    if not is_one or it.arguments or it.is_untold("robot_description"):
        return
    given = it.value("robot_description")
    text = given.strip() if isinstance(given, str) else given
    if text is None:
        message = f"{it.full_name} gets no robot_description, and ends"
        yield at(ends, it.place, message, "give it robot_description, the text of the URDF")
    elif isinstance(text, str) and text and "<" not in text:
        message = f"{it.full_name}: robot_description is {text[:60]!r}, and no XML"
        yield at(ends, it.place, message, "give it the text of the file, not its path")
