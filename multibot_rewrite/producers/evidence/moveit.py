# SPDX-License-Identifier: Apache-2.0
"""Files of MoveIt -> its controllers, and the joints that a robot's SRDF plans for.

Sources: moveit2 moveit_simple_controller_manager_plugin.cpp (``controller_names``, of each a map);
trajectory_execution_manager.cpp ("Unable to identify any set of controllers that can actuate the
specified joints").
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import yaml

from multibot_rewrite.companions.moveit.file_kind import NAMES, SIMPLE
from multibot_rewrite.companions.yaml_text import YamlText, items, line_of, pairs
from multibot_rewrite.knowledge.records import MOVE_GROUP
from multibot_rewrite.producers.evidence.semantics import Semantics
from multibot_rewrite.system.records import CLAIMS, EXPORTS, JOINT, Interface, Place, System


def managers(node: yaml.Node | None) -> Iterator[yaml.Node]:
    """The manager's map, at the top of a file or below a node's parameters."""
    for key, value in pairs(node):
        if key.value == SIMPLE:
            yield value
        elif isinstance(value, yaml.MappingNode):
            yield from managers(value)


def controllers_of(manager: yaml.Node) -> Iterator[tuple[yaml.ScalarNode, yaml.Node]]:
    """The listed controllers that have a map: its key and the map."""
    below = {key.value: (key, value) for key, value in pairs(manager)}
    yield from (below[str(it.value)] for it in names_of(manager) if it.value in below)


def names_of(manager: yaml.Node) -> list[yaml.ScalarNode]:
    """The list of controllers."""
    listed = next((value for key, value in pairs(manager) if key.value == NAMES), None)
    return [it for it in items(listed) if isinstance(it, yaml.ScalarNode)]


def joints_of(controller: yaml.Node) -> Iterator[yaml.ScalarNode]:
    """The joints in the map of a controller."""
    listed = next((value for key, value in pairs(controller) if key.value == "joints"), None)
    return (it for it in items(listed) if isinstance(it, yaml.ScalarNode))


def planning_system(documents: Iterable[YamlText], semantics: Semantics) -> System:
    """The joints that controllers of MoveIt move, and those that groups of the SRDF are planned for."""
    moved = (
        Interface(JOINT, str(joint.value), f"/{key.value}", EXPORTS, _place(document, joint))
        for document in documents
        for manager in managers(document.root)
        for key, body in controllers_of(manager)
        for joint in joints_of(body)
    )
    planned = (
        Interface(JOINT, joint, f"/{MOVE_GROUP}", CLAIMS, group.place)
        for group in semantics.groups
        for joint in group.joints
    )
    return System(interfaces=(*moved, *planned))


def _place(document: YamlText, node: yaml.Node) -> Place:
    return Place(document.file, line_of(node))
