"""Sections with the parameters of a controller that no controller manager declares.

Source: ros2_control controller_manager.cpp (a controller is what ``NAME.type`` of the manager names, or
a ``type`` in its own section).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.producers.evidence.claims import TYPE
from multibot_rewrite.producers.evidence.nodes import MANAGER
from multibot_rewrite.producers.evidence.records import GivenNode
from multibot_rewrite.rules.closure.gap import Gap

SECTION = "section"


def undeclared_gaps(given: Sequence[GivenNode], known: Mapping[str, NodeFacts]) -> Iterator[Gap]:
    """Sections of controllers that nobody declares; ``near`` is a declared one without a section.

    Nothing is said where no parameter file declares a controller.
    """
    declared = {it.name: it for it in given if it.manager}
    bare = [name for name, it in declared.items() if not it.values]
    for it in given if declared else ():
        node = known.get(it.known)
        if it.manager or TYPE in it.values or node is None or node.host != MANAGER:
            continue
        near = nearest(it.name, bare)
        where = declared[near].place if near else next(iter(declared.values())).place
        yield Gap(SECTION, it.name, it.name, (SECTION, it.known, it.name), it.place, near, where)
