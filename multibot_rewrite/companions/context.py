# SPDX-License-Identifier: Apache-2.0
"""What a companion file is rewritten with; the same for every robot of one description."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from multibot_rewrite.base.naming import Naming
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.names.rename_map import NO_OWN, CompanionNames
from multibot_rewrite.companions.template import NAMESPACE_SLOT, TAG_SLOT
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.made_topics import NO_WORDS, Stems
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.spelling.targets import placed

Frames = Mapping[tuple[str, str], str]
NO_FRAMES: Frames = {}


class Context(NamedTuple):
    """``names`` is the rename map of links, joints and frames, ``topics`` that of ROS names, both
    with a slot for the robot. ``nodes`` maps a node's name in the stack to the full name it runs
    under; nodes that serve all robots keep theirs. ``distro`` is the ROS release. ``frames`` are
    those that the robots have in the place of a default: by the node's last name and the parameter.
    """

    names: CompanionNames
    topics: CompanionNames
    nodes: Mapping[str, str]
    distro: str
    frames: Frames = NO_FRAMES


def make_context(
    declared: Declared,
    naming: Naming,
    facts: Iterable[NodeFacts],
    distro: str,
    own: Mapping[tuple[str, str], str] = NO_OWN,
    words: Stems = NO_WORDS,
) -> Context:
    """The context of a description (not rewritten) and the nodes that its robots run; ``own`` and
    ``words`` as in ``CompanionNames``."""
    nodes = {
        it.name: f"/{it.name}" if it.shared else full_name(it.name, naming, it.apart)
        for it in facts
    }
    names = CompanionNames(declared, naming, TAG_SLOT, own, words)
    return Context(names, names._replace(robot=NAMESPACE_SLOT), nodes, distro)


def full_name(node: str, naming: Naming, apart: bool = False) -> str:
    """The full name that a robot's node runs under, with a slot for the robot; ``apart`` as in
    ``NodeFacts``."""
    namespace, name = placed(NAMESPACE_SLOT, node, naming, apart)
    return f"{namespace.rstrip('/')}/{name}"
