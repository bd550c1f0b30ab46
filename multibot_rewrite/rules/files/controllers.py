# SPDX-License-Identifier: Apache-2.0
"""Controllers in parameter files: what MoveIt sends to, and sections that no manager declares.

Sources: moveit2 moveit_simple_controller_manager_plugin.cpp (``controller_names``; of each the
``type``, ``action_ns`` and ``joints``; a FollowJointTrajectory goes to the action ``NAME/ACTION_NS``);
ros2_control controller_manager.cpp (a controller is what ``NAME.type`` of the manager names, or a
``type`` in its own section).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import yaml

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding, rule
from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.knowledge.records import MANAGER, NodeFacts
from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.evidence.hardware import TYPE, control_system, exported
from multibot_rewrite.producers.evidence.semantics import JOINTS, controllers_of, listed, managers
from multibot_rewrite.related_files.moveit.file_kind import NAMES
from multibot_rewrite.related_files.named_file import MOVEIT, PARAMS, NamedFile
from multibot_rewrite.related_files.yaml_text import pairs
from multibot_rewrite.rules.declaration import remark, remark_at
from multibot_rewrite.rules.description.references.controllers import missing_in
from multibot_rewrite.rules.files.section_facts import beside, did_you_mean_at, is_in, shown
from multibot_rewrite.rules.subject import Robots
from multibot_rewrite.rules.system.states import missing_message
from multibot_rewrite.system.records import ACTION, SERVES, Place


@rule("MB857", "undeclared-controller-in-file", WARNING, formats=(MOVEIT, PARAMS))
def undeclared_controller(file: NamedFile) -> Iterator[Finding]:
    """Yield the controllers of ``moveit_simple_controller_manager`` that none of the files declares."""
    found = [*managers(file.document.root)] if file.document else []
    given = beside(file).given if found else ()
    declared = {it.node.rpartition("/")[2]: it for it in given if it.host_name}
    for manager in found if declared else ():
        # Listed controllers that have no parameters, which may be in another file.
        keys = {str(key.value): key for key, _ in pairs(manager) if key.value != NAMES}
        names = listed(manager, NAMES)
        left = keys.keys() - {it.value for it in names}
        for it in names:
            near = nearest(str(it.value), left) if it.value not in keys else ""
            if near:
                place = Place(file.file, keys[near].start_mark.line + 1)
                yield from _missing(it, f"controller {it.value}", did_you_mean_at(near, place))
        for key, body in controllers_of(manager):
            yield from _lacking_of_controller(file, key, body, declared)


def _lacking_of_controller(
    file: NamedFile, key: yaml.ScalarNode, body: yaml.Node, declared: Mapping[str, Run]
) -> Iterator[Finding]:
    """Yield what MoveIt uses of one controller and the parameter files lack."""
    name = str(key.value)
    controller = declared.get(name.rpartition("/")[2])
    if controller is None:
        near = nearest(name, declared)
        hint = did_you_mean_at(near, declared[near].place) if near else ""
        yield from _missing(key, f"controller {name}", hint)
        return
    # The joints of a controller; none where its parameters do not list any.
    own: dict[str, Place] = {}
    for given in filter(None, map(controller.values.get, ("joints", "joint"))):
        words = given.value if isinstance(given.value, list) else [given.value]
        own |= {str(it): given.place for it in words}
    for joint in listed(body, JOINTS) if own else ():
        if joint.value not in own:
            near = nearest(joint.value, own)
            hint = did_you_mean_at(near, own.get(near) or next(iter(own.values())))
            yield from _missing(joint, f"joint {joint.value} of {name}", hint)
    facts = beside(file).known.get(controller.fact.known)
    if facts is not None and not controller.unknown_type:
        yield from _action_faults(key, body, controller, facts)


def _action_faults(
    key: yaml.ScalarNode, body: yaml.Node, controller: Run, facts: NodeFacts
) -> Iterator[Finding]:
    """Yield a finding if MoveIt calls an action that the controller does not serve."""
    ends = (it for it in facts.endpoints if (it.kind, it.role) == (ACTION, SERVES))
    served = {it.name.removeprefix("~/"): it.type.rpartition("/")[2] for it in ends}
    row = {it.value: value for it, value in pairs(body) if isinstance(value, yaml.ScalarNode)}
    given, type_ = row.get("action_ns"), row.get("type")
    if given is None or type_ is None:
        return
    called = f"{key.value}/{given.value}"
    if given.value not in served:
        near = next((f"{key.value}/{it}" for it in served), "")
        yield from _missing(given, f"action {called}", did_you_mean_at(near, controller.place))
    elif served[given.value] != type_.value:
        hint = did_you_mean_at(served[given.value], controller.place)
        yield from _missing(type_, f"{called} as {type_.value}", hint)


def _missing(node: yaml.Node, name: str, hint: str) -> Iterator[Finding]:
    """Yield the finding about a name of MoveIt's file; none for a placeholder."""
    # Launch files fill in placeholders.
    if not PLACEHOLDER.search(name):
        yield remark_at(node, f"MoveIt uses {name}, which no parameter file of the robot has", hint)


def not_exported(file: NamedFile) -> Iterator[Finding]:
    """Report interfaces that controllers of a file claim and the robot that is named has not."""
    robots = file.memo.get(Robots) if file.is_certain else None
    for robot in robots.subjects if robots else ():
        exports = exported(robot.document.root, robot.document.file)
        claimed = control_system(*beside(file), exports).interfaces
        for it in missing_in(robot, claimed):
            if is_in(file, it.claims[0].place):
                place = it.claims[0].place._replace(column=1)
                yield remark(place, *missing_message(it, None if robot.origins else shown))


@rule("MB878", "section-of-no-controller", WARNING, formats=(PARAMS,))
def section_of_no_controller(file: NamedFile) -> Iterator[Finding]:
    """Report sections without a controller, if a parameter file of the robot declares any."""
    given, known = beside(file)
    declared = {it.node: it for it in given if it.host_name}
    bare = [name for name, it in declared.items() if not it.values]
    here = (it for it in given if is_in(file, it.place) and not it.host_name)
    nodes = ((it, known.get(it.fact.known)) for it in here if TYPE not in it.values)
    loose = [it for it, node in nodes if node and node.host == MANAGER]
    for it in loose:
        alike = [one for one in loose if one.fact.known == it.fact.known]
        same = [name for name in bare if declared[name].fact.known == it.fact.known]
        # The one section of a kind, and the one controller of that kind that has none.
        near = nearest(it.node, bare) or (same[0] if len(alike) == len(same) == 1 else "")
        if not declared or not (near or file.is_certain):
            continue
        place = declared[near or next(iter(declared))].place
        hint = f"declare it as at {shown(place)}, or leave it out"
        hint = did_you_mean_at(near, place) if near else hint
        message = f"{it.node} has parameters of a controller that nothing declares"
        yield remark(it.place._replace(column=1), message, hint, WARNING if near else NOTE)
