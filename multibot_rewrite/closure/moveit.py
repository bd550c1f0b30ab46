"""MoveIt's controllers against the controllers that the robot's files declare.

Source: moveit2 moveit_simple_controller_manager_plugin.cpp (``controller_names``; of each the ``type``,
``action_ns`` and ``joints``); a FollowJointTrajectory goes to the action ``NAME/ACTION_NS``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

import yaml

from multibot_rewrite.closure.gap import Gap
from multibot_rewrite.companions.yaml_text import YamlText, items, line_of, pairs
from multibot_rewrite.evidence.records import Given, GivenNode, Place
from multibot_rewrite.nearest import nearest

CONTROLLER, JOINT = "controller", "joint"
MANAGER, NAMES = "moveit_simple_controller_manager", "controller_names"


def moveit_gaps(documents: Iterable[YamlText], given: Sequence[GivenNode]) -> Iterator[Gap]:
    """Controllers of MoveIt that no file declares, and their joints that the controller has not.

    Nothing is said where no parameter file declares a controller.
    """
    declared = {it.name.rpartition("/")[2]: it for it in given if it.manager}
    for document in documents if declared else ():
        for at, (key, body) in enumerate(_controllers(document)):
            yield from _of_one(document, key, body, declared, str(at))


def _controllers(document: YamlText) -> Iterator[tuple[yaml.ScalarNode, yaml.Node]]:
    for node in _managers(document.root):
        below = {key.value: (key, value) for key, value in pairs(node)}
        names = items(below[NAMES][1]) if NAMES in below else []
        words = [str(it.value) for it in names if isinstance(it, yaml.ScalarNode)]
        yield from (below[name] for name in words if name in below)


def _managers(node: yaml.Node | None) -> Iterator[yaml.Node]:
    """The manager's map, at the top of a file or below a node's parameters."""
    for key, value in pairs(node):
        if key.value == MANAGER:
            yield value
        elif isinstance(value, yaml.MappingNode):
            yield from _managers(value)


def _of_one(
    document: YamlText,
    key: yaml.ScalarNode,
    body: yaml.Node,
    declared: Mapping[str, GivenNode],
    at: str,
) -> Iterator[Gap]:
    """The gaps of one controller; ``at`` is its place in the list, the same after a rewrite."""
    name, place = str(key.value), Place(document.file, line_of(key))
    controller = declared.get(name.rpartition("/")[2])
    if controller is None:
        near = nearest(name, declared)
        where = declared[near].place if near else None
        yield Gap(CONTROLLER, f"controller {name}", "MoveIt", (CONTROLLER, at), place, near, where)
        return
    own = _own_joints(controller)
    for number, joint in enumerate(_joints(body) if own else ()):
        if joint.value not in own:
            near = nearest(str(joint.value), own)
            what, needed = f"joint {joint.value} of {name}", Place(document.file, line_of(joint))
            where = own.get(near) or next(iter(own.values()))
            yield Gap(JOINT, what, "MoveIt", (JOINT, at, str(number)), needed, near, where)


def _joints(body: yaml.Node) -> Iterator[yaml.ScalarNode]:
    for key, value in pairs(body):
        if key.value == "joints":
            yield from (it for it in items(value) if isinstance(it, yaml.ScalarNode))


def _own_joints(controller: GivenNode) -> dict[str, Place]:
    """The joints of a controller; none where its parameters do not list any."""
    found: dict[str, Place] = {}
    for name in ("joints", "joint"):
        given: Given | None = controller.values.get(name)
        if given:
            words = given.value if isinstance(given.value, list) else [given.value]
            found |= {str(it): given.place for it in words}
    return found
