"""The planning groups of an SRDF against MoveIt's controllers, its virtual joints against tf.

Source: moveit2 trajectory_execution_manager.cpp ("Unable to identify any set of controllers that can
actuate the specified joints"), current_state_monitor.cpp (a virtual joint that is not fixed has the
transform from its parent frame to its child link as state).
"""

from __future__ import annotations

from collections.abc import Collection, Iterator

from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.producers.evidence.semantics import FIXED, Semantics
from multibot_rewrite.rules.closure.gap import Gap

GROUP, VIRTUAL = "group", "virtual joint"


def group_gaps(found: Semantics, moved: Collection[str]) -> Iterator[Gap]:
    """Groups with joints that no controller of MoveIt moves; nothing without any controller."""
    for at, group in enumerate(found.groups if moved else ()):
        for number, joint in enumerate(group.joints):
            if joint not in moved:
                key = (GROUP, str(at), str(number))
                yield Gap(GROUP, joint, group.name, key, group.place, nearest(joint, moved))


def virtual_gaps(found: Semantics, sent: Collection[str]) -> Iterator[Gap]:
    """Virtual joints that move, and whose child no known node sends a transform to."""
    for it in found.virtual:
        if it.type != FIXED and it.child not in sent:
            yield Gap(VIRTUAL, f"{it.parent} -> {it.child}", it.name, (VIRTUAL, it.name), it.place)
