"""MoveIt's controllers against the controllers that the robot's files declare.

Source: moveit2 moveit_simple_controller_manager_plugin.cpp (``controller_names``; of each the ``type``,
``action_ns`` and ``joints``); a FollowJointTrajectory goes to the action ``NAME/ACTION_NS``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

import yaml

from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.companions.yaml_text import YamlText, items, line_of, pairs
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.producers.evidence.records import Given, GivenNode
from multibot_rewrite.rules.closure.gap import Gap
from multibot_rewrite.system.records import ACTION, SERVES, Place

CONTROLLER, JOINT = "controller", "joint"
NOTHING: Mapping[str, NodeFacts] = {}
MANAGER, NAMES = "moveit_simple_controller_manager", "controller_names"


def moveit_gaps(
    documents: Iterable[YamlText],
    given: Sequence[GivenNode],
    known: Mapping[str, NodeFacts] = NOTHING,
) -> Iterator[Gap]:
    """Controllers of MoveIt that no file declares, their joints that the controller has not, and
    actions that it does not serve.

    Nothing is said where no parameter file declares a controller.
    """
    declared = {it.name.rpartition("/")[2]: it for it in given if it.manager}
    managers = [(it, node) for it in documents for node in _managers(it.root)]
    for document, manager in managers if declared else ():
        yield from _without_body(document, manager)
        for at, (key, body) in enumerate(_controllers(manager)):
            yield from _of_one(document, key, body, declared, str(at))
            controller = declared.get(str(key.value).rpartition("/")[2])
            if controller and controller.known in known and not controller.unknown_type:
                node = known[controller.known]
                yield from _action(document, key, body, controller, node, str(at))


def moved_joints(documents: Iterable[YamlText]) -> frozenset[str]:
    """The joints of all controllers that MoveIt knows."""
    managers = (it for document in documents for it in _managers(document.root))
    bodies = (body for manager in managers for _, body in _controllers(manager))
    return frozenset(str(it.value) for body in bodies for it in _joints(body))


def _controllers(manager: yaml.Node) -> Iterator[tuple[yaml.ScalarNode, yaml.Node]]:
    below = {key.value: (key, value) for key, value in pairs(manager)}
    yield from (below[str(it.value)] for it in _names(manager) if it.value in below)


def _names(manager: yaml.Node) -> list[yaml.ScalarNode]:
    listed = next((value for key, value in pairs(manager) if key.value == NAMES), None)
    return [it for it in items(listed) if isinstance(it, yaml.ScalarNode)]


def _without_body(document: YamlText, manager: yaml.Node) -> Iterator[Gap]:
    """Listed controllers that have no parameters."""
    keys = {str(key.value): key for key, _ in pairs(manager) if key.value != NAMES}
    names = _names(manager)
    left = keys.keys() - {it.value for it in names}
    for at, it in enumerate(names):
        near = nearest(str(it.value), left) if it.value not in keys else ""
        # Its parameters may be in another file.
        if near:
            where = Place(document.file, line_of(keys[near]))
            what, place = f"controller {it.value}", Place(document.file, line_of(it))
            yield Gap(CONTROLLER, what, "MoveIt", (NAMES, str(at)), place, near, where)


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


def _action(
    document: YamlText,
    key: yaml.ScalarNode,
    body: yaml.Node,
    controller: GivenNode,
    node: NodeFacts,
    at: str,
) -> Iterator[Gap]:
    """The action that MoveIt calls, if the controller serves others alone."""
    served = {
        it.name.removeprefix("~/"): it.type
        for it in node.endpoints
        if it.kind == ACTION and it.role == SERVES
    }
    row = {it.value: value for it, value in pairs(body) if isinstance(value, yaml.ScalarNode)}
    given, type_ = row.get("action_ns"), row.get("type")
    if given is None or type_ is None:
        return
    if given.value not in served:
        wrong, name = given, f"action {key.value}/{given.value}"
        near = next((f"{key.value}/{it}" for it in served), "")
    elif served[given.value].rpartition("/")[2] != type_.value:
        wrong, name = type_, f"{key.value}/{given.value} as {type_.value}"
        near = served[given.value].rpartition("/")[2]
    else:
        return
    place = Place(document.file, line_of(wrong))
    yield Gap(ACTION, name, "MoveIt", (ACTION, at), place, near, controller.place)


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
