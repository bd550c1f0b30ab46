# SPDX-License-Identifier: Apache-2.0
"""What a joint_state_publisher of a launch file reads.

Source: joint_state_publisher humble to jazzy, joint_state_publisher.py (source_list).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.producers.launch.launched import Launched
from multibot_rewrite.rules.launch.declaration import at, launch_rule
from multibot_rewrite.spelling.records import Run
from multibot_rewrite.system.records import PUBLISHES, RUNS, SUBSCRIBES

_KINDS = ("joint_state_publisher", "joint_state_publisher_gui")


def read_by_joints(launched: Launched) -> Iterator[tuple[Run, str]]:
    """What each joint_state_publisher subscribes to."""
    known = {it.full_name: it for it in launched.nodes if it.fact.kind in _KINDS}
    for end in launched.system.ends:
        if end.role == SUBSCRIBES and end.node in known and end.sure == RUNS:
            yield known[end.node], end.name


@launch_rule("MG716", "joints-of-itself", level=WARNING)
def of_itself(launched: Launched) -> Iterator[Finding]:
    """Where all nodes are known."""
    senders: dict[str, set[str]] = defaultdict(set)
    for end in launched.system.ends:
        if end.role == PUBLISHES:
            senders[end.name].add(end.node)
    for node, topic in read_by_joints(launched) if launched.whole else ():
        if senders[topic] == {node.full_name}:
            message = f"{node.full_name} reads {topic}, which it sends itself"
            hint = "name another topic in source_list, or leave it out"
            yield at(of_itself, node.place, message, hint, names=(topic,))
