# SPDX-License-Identifier: Apache-2.0
"""What of a launch file does not start, ends as soon as it starts, or waits for ever.

The launch itself, programs, controllers, models.

Source: launch jazzy launch_service.py (an exception ends it); ros2_control spawner.py (it waits for
the services of its manager; what is loaded already is not loaded again) and controller_manager.cpp
(a controller without a type is not loaded); nav2_lifecycle_manager jazzy (``autostart``,
``node_names``); joint_state_publisher humble to jazzy, joint_state_publisher.py (source_list);
robot_state_publisher jazzy robot_state_publisher.cpp (its robot_description is XML); rmw
validate_node_name.c; ros_gz_sim jazzy create.cpp (gflags: a double); ros_gz_bridge jazzy
parameter_bridge.cpp."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import pairwise

from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, WARNING, Finding
from multibot_rewrite.base.grouping import sets_by_key
from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.base.rosnames import check_node_name, expand, resolve_bound
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.description.checks.numbers import number
from multibot_rewrite.knowledge.programs import LIFECYCLE_MANAGER, NAV2
from multibot_rewrite.knowledge.records import MANAGER, NodeFacts, names_its_process
from multibot_rewrite.planning.records import Run
from multibot_rewrite.planning.transforms import STATE_PUBLISHER
from multibot_rewrite.producers.evidence.hardware import COMMAND, claims_of
from multibot_rewrite.producers.launch import spawners
from multibot_rewrite.producers.launch.bridges import refused_rows
from multibot_rewrite.producers.launch.launched import Launched
from multibot_rewrite.producers.launch.programs import programs
from multibot_rewrite.producers.launch.running import SIMULATED, UNTYPED, bound_of
from multibot_rewrite.rules.declaration import LAUNCH, at, launch_rule
from multibot_rewrite.system.records import PUBLISHES, RUNS, SERVICE, SUBSCRIBES
from multibot_rewrite.system.words import last_word

_START_MANAGER = (
    "start ros2_control_node there, load gz_ros2_control in the description, or name the launch file "
    "that starts it in addition to this one"
)
_CHANGE, _BOND = "/change_state", "bond"
_UNSURE = "an unknown node may do it: see what is reported as incomplete"
_ELSEWHERE = "name the launch file that starts it in addition to this one, if there is one"


@launch_rule("MG721", "launch-fails")
def fails(launched: Launched) -> Iterator[Finding]:
    """Yield what ends the launch: an exception of the file, or a file that is missing."""
    for it in launched.graph.notes:
        if it.fails:
            yield at(fails, it.place, f"the launch ends here: {it.message}", "correct it")


@launch_rule("MG722", "controller-spawned-twice")
def spawned_twice(launched: Launched) -> Iterator[Finding]:
    """Report controllers that are spawned twice, at the last spawner."""
    spawned = launched.spawned
    for (name, manager), count in Counter((it.name, it.manager) for it in spawned).items():
        if count > 1:
            last = next(it for it in reversed(spawned) if (it.name, it.manager) == (name, manager))
            message = f"{manager} gets {name} from {count} spawners"
            yield at(spawned_twice, last.place, message, "is one of them another robot's?")


def _no_manager(launched: Launched) -> Iterator[Finding]:
    """Yield the spawners whose manager nothing starts; inconclusive if other files may start it."""
    there = [it.full_name for it in launched.nodes if _is_known_as(it, MANAGER)]
    described = bool(launched.models.found) and not launched.models.lost
    for manager in dict.fromkeys(it.manager for it in launched.spawned):
        if manager in there:
            continue
        mine = [it for it in launched.spawned if it.manager == manager]
        names = ", ".join(dict.fromkeys(it.name for it in mine))
        message = f"nothing starts {manager}: {names} will not be loaded"
        if near := nearest(manager, there) or next(iter(there), ""):
            hint = f"did you mean {near}?"
            yield at(no_manager, mine[0].place, message, hint, names=(manager, near))
        elif described and _is_known(launched):
            yield at(no_manager, mine[0].place, message, _START_MANAGER, names=(manager,))
        else:
            hint = _ELSEWHERE if _is_known(launched) else _UNSURE
            yield at(no_manager, mine[0].place, message, hint, level=INCONCLUSIVE)


no_manager = spawners.NO_MANAGER._replace(
    check=_no_manager, formats=(LAUNCH,), examples="MG723-launch"
)


@launch_rule("MG730", "name-of-a-whole-process", distro="humble")
def names_all(launched: Launched) -> Iterator[Finding]:
    """Yield the nodes that get a name which all nodes of their process get with it."""
    given = {(it.place, it.name) for it in launched.graph.nodes}
    for run in (it for it in launched.nodes if (it.place, it.name) in given):
        hint, others = "leave name= out: its code names each node", {*run.fact.together}
        if names_its_process(run.fact.known, launched.release):
            hint = "leave name= out: its code calls it controller_manager"
            others = {it.name for it in launched.spawned if it.manager == run.full_name}
        if others:
            who = shorten(sorted(others))
            message = f"name= renames every node of the process: {who} become {run.node}"
            yield at(names_all, run.place, message, hint)


@launch_rule("MG731", "no-container")
def no_container(launched: Launched) -> Iterator[Finding]:
    """Yield the components of a container that nothing starts; inconclusive if none is called so."""
    nodes = launched.graph.nodes
    there = [f"{it.namespace.rstrip('/')}/{it.name}" for it in nodes if not it.container]
    components = {it.container: it for it in reversed(nodes) if it.container}
    for container, it in components.items():
        same = (one for one in there if last_word(one) == last_word(container))
        near = next(same, "") or nearest(container, there)
        if container not in there:
            hint, level = (f"did you mean {near}?", ERROR) if near else (_ELSEWHERE, INCONCLUSIVE)
            message = f"{it.name} waits for the container {container}, which nothing starts"
            yield at(no_container, it.place, message, hint, level=level)


def _is_known_as(it: Run, known: str) -> bool:
    return it.fact.known == known


def _is_known(launched: Launched) -> bool:
    """Return whether all nodes of the launch are known."""
    nodes = all(it.is_known for it in launched.nodes)
    return nodes and all(it.parameters or it.fails for it in launched.graph.notes)


@launch_rule("MG724", "model-without-description")
def no_description(launched: Launched) -> Iterator[Finding]:
    """Yield the spawners whose description nothing sends; inconclusive if nothing sends any."""
    names = (it.name for it in launched.system.ends if it.role == PUBLISHES)
    sent = [it for it in names if it.endswith("robot_description")]
    level = {} if sent else {"level": INCONCLUSIVE}
    for it in launched.models.lost:
        words = dict(zip(it.arguments, it.arguments[1:], strict=False))
        topic = expand(words["-topic"], it.namespace, "") if "-topic" in words else ""
        if topic and topic not in sent and (sent or _is_known(launched)):
            near = nearest(topic, sent)
            other = f"did you mean {near}?" if near else "name the topic that has it"
            message = f"waits for a description on {topic}, where nothing sends one"
            hint = other if sent else _ELSEWHERE
            yield at(no_description, it.place, message, hint, names=(topic,), **level)
    waiting = read_by_joints(launched) if launched.whole else ()
    for node, topic in waiting:
        if topic.endswith("robot_description") and topic not in sent:
            who = node.full_name
            message = f"{who} waits for a description on {topic}, where nothing sends one"
            other = "start a robot_state_publisher there; no parameter changes the topic"
            hint = other if sent else _ELSEWHERE
            yield at(no_description, node.place, message, hint, names=(topic,), **level)


@launch_rule("MG728", "controller-without-type")
def no_type(launched: Launched) -> Iterator[Finding]:
    """Report controllers without a type, if all parameter files are known."""
    if any(it.parameters for it in launched.graph.notes):
        return
    own = (it for it in launched.nodes if it.process != SIMULATED)
    managers = {it.full_name for it in own if _is_known_as(it, MANAGER)}
    spawned = {(it.full_name, it.place): it.manager for it in launched.spawned}
    for it in launched.nodes:
        manager = spawned.get((it.full_name, it.place), "")
        if it.program == UNTYPED and manager in managers:
            message = f"no parameter of {manager} says the type of {it.name}"
            hint = f"add {it.name}: {{type: ...}} to its parameters"
            yield at(no_type, it.place, message, hint, names=(manager,))


@launch_rule("MG725", "controller-without-joints")
def no_joints(launched: Launched) -> Iterator[Finding]:
    """Report spawned controllers without a joint in their parameters, if all files are known."""
    if any(it.parameters for it in launched.graph.notes):
        return
    spawned = {(it.full_name, it.place) for it in launched.spawned}
    for it in launched.nodes:
        typed = (it.full_name, it.place) in spawned and it.program != UNTYPED
        if typed and moves_nothing(it.fact, it):
            message = f"controller {it.full_name} gets no parameter that names a joint"
            hint = f"write its parameters in a section {it.full_name}"
            yield at(no_joints, it.place, message, hint)


def moves_nothing(facts: NodeFacts, given: Run) -> bool:
    """Return whether a controller commands the joints of its parameters, and these name none."""
    commands = [claim for claim in facts.claims if claim.kind == COMMAND]
    by_joint = bool(commands) and all(claim.template.startswith("<") for claim in commands)
    owners = (it._replace(template=it.template.partition("/")[0], condition="") for it in commands)
    return by_joint and not any(True for _ in claims_of(owners, given))


@launch_rule("MG726", "not-activated")
def not_listed(launched: Launched) -> Iterator[Finding]:
    """Report lifecycle nodes that no manager lists under their full name."""
    managers = [it for it in launched.nodes if _is_known_as(it, LIFECYCLE_MANAGER)]
    listed = {name: it for it in managers for name in _managed_nodes(it)}
    known = all(isinstance(it.value("node_names"), list) for it in managers)
    started = {it.full_name: it for it in launched.nodes}
    for it in launched.nodes if managers and known else ():
        kind = it.fact.kind
        activates_itself = it.value("autostart_node") is True
        if is_managed(kind) and not activates_itself and it.full_name not in listed:
            message = f"{it.full_name} is in the list of no lifecycle manager"
            hint = f"add it to node_names of {managers[0].full_name}"
            yield at(not_listed, it.place, message, hint)
    for name, manager in listed.items() if _is_known(launched) else ():
        runs = started.get(name)
        if runs and keeps_no_bond(runs.fact) and manager.value("bond_timeout") != 0:
            yield at(not_listed, manager.place, *bond_message(manager.full_name, name))
        if name not in started:
            near = nearest(name, started).rpartition("/")[2]
            hint = f"did you mean {near}?" if near else "start it, or leave it out"
            message = f"{manager.full_name} waits for {name}, which the launch file does not start"
            yield at(not_listed, manager.place, message, hint)


def keeps_no_bond(node: NodeFacts) -> bool:
    """Return whether a node has a life cycle and keeps no bond: its manager then aborts.

    Source: nav2_lifecycle_manager jazzy, lifecycle_manager.cpp (``bond_timeout``)."""
    names = [it.name for it in node.endpoints]
    return f"~{_CHANGE}" in names and _BOND not in names


def bond_message(manager: str, name: str) -> tuple[str, str]:
    """Return the message that a manager waits for the bond of a node, and the hint."""
    hint = "set use_lifecycle_manager: true for the node, or bond_timeout: 0.0 for the manager"
    return f"{manager} waits for a bond with {name}, which keeps none", hint


# Some releases of it have no life cycle, in others its own launch file brings it up.
_SELF = (LIFECYCLE_MANAGER, "slam_toolbox", "map_saver", "costmap_filter_info_server")


def is_managed(kind: str) -> bool:
    """Return whether a lifecycle manager of Nav2 alone activates a node of this kind."""
    return kind in NAV2 and kind not in _SELF


def _managed_nodes(it: Run) -> Iterator[str]:
    """Yield the nodes whose services a manager calls, after its remap rules.

    Source: nav2_lifecycle_manager, lifecycle_service_client.cpp."""
    names = it.value("node_names")
    bound = bound_of(it.name, it.namespace, it.rules)
    for one in names if isinstance(names, list) else ():
        yield resolve_bound(f"{one}{_CHANGE}", SERVICE, bound).removesuffix(_CHANGE)


@launch_rule("MG727", "manager-waits", level=WARNING)
def waits(launched: Launched) -> Iterator[Finding]:
    """Report managers without autostart, which is false by default."""
    for it in launched.nodes:
        given = it.values.get("autostart")
        if _is_known_as(it, LIFECYCLE_MANAGER) and (given is None or given.value is False):
            message = f"{it.full_name} activates no node by itself: autostart is not true"
            yield at(waits, it.place, message, "set autostart to true")


def read_by_joints(launched: Launched) -> Iterator[tuple[Run, str]]:
    """Yield each joint_state_publisher with the topics that it subscribes to."""
    kinds = ("joint_state_publisher", "joint_state_publisher_gui")
    known = {it.full_name: it for it in launched.nodes if it.fact.kind in kinds}
    for end in launched.system.ends:
        if end.role == SUBSCRIBES and end.node in known and end.sure == RUNS:
            yield known[end.node], end.name


@launch_rule("MG716", "joints-of-itself", level=WARNING)
def of_itself(launched: Launched) -> Iterator[Finding]:
    """Report nodes that read their own topic, if all nodes are known."""
    sent = (it for it in launched.system.ends if it.role == PUBLISHES)
    senders = sets_by_key((it.name, it.node) for it in sent)
    for node, topic in read_by_joints(launched) if launched.whole else ():
        if senders[topic] == {node.full_name}:
            message = f"{node.full_name} reads {topic}, which it sends itself"
            hint = "name another topic in source_list, or leave it out"
            yield at(of_itself, node.place, message, hint, names=(topic,))


@launch_rule("MG729", "program-ends-at-once")
def ends(launched: Launched) -> Iterator[Finding]:
    """Report nodes that end at once, if all that a node gets is known."""
    unsure = {(it.place.file, it.place.line) for it in launched.graph.notes}
    for it in launched.graph.nodes:
        fault = check_node_name(it.name) if it.name else None
        if fault:
            who = f"node {it.name!r} of {it.package}"
            message = f"{who} has a name that ROS refuses: {fault.reason}"
            yield at(ends, it.place, message, "write it with letters, digits and underscores")
        if f"{it.package}/{it.executable}" in programs().spawners:
            for flag, word in pairwise(it.arguments):
                if flag in {"-x", "-y", "-z", "-R", "-P", "-Y"} and number(word) is None:
                    message = f"{it.executable}: {flag} {word} is no number"
                    yield at(ends, it.place, message, "write a number")
    for node in launched.nodes:
        for word in refused_rows(node):
            message = f"{node.full_name}: {word!r} is no row of a bridge"
            yield at(ends, node.place, message, "write TOPIC@ROS_TYPE[GZ_TYPE, or ] to Gazebo")
        if (node.place.file, node.place.line) not in unsure:
            yield from _publishers_without_description(node)


def _publishers_without_description(it: Run) -> Iterator[Finding]:
    """Yield robot_state_publishers without a description, or with one that is no XML."""
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
