"""What is wrong with the values in a behavior tree."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.companions.behavior_tree.ports import GRAPH_KINDS, Port, port_data
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.names.by_kind import is_plain
from multibot_rewrite.companions.names.undeclared import (
    holds_a_name,
    is_undeclared,
    renamed_names,
    undeclared_message,
)
from multibot_rewrite.findings.finding import WARNING, Finding
from multibot_rewrite.findings.place import locate
from multibot_rewrite.findings.rule import Rule, declare
from multibot_rewrite.rosnames import check_topic_name
from multibot_rewrite.steps.document import Document, value_slot

# The rule, the message and the hint.
_Problem = tuple[Rule, str, str]


def port_findings(document: Document, context: Context, ports: Iterable[Port]) -> Iterator[Finding]:
    """What is wrong with the ports, in their order; an undeclared frame only at its first place."""
    reported: set[str] = set()
    names = renamed_names(context)
    for port in ports:
        problem = _problem_with(context, port, names)
        if problem is None or (problem[0] is UNDECLARED_FRAME and port.value in reported):
            continue
        rule, message, hint = problem
        if rule is UNDECLARED_FRAME:
            reported.add(port.value)
        slot = value_slot(document.source, port.start, port.attribute, port.value)
        line, column = locate(document.source, slot[0] if slot else port.start)
        yield rule.finding(message, hint, file=document.file, line=line, column=column)


def _problem_with(context: Context, port: Port, names: frozenset[str]) -> _Problem | None:
    if port.element.tag == "include":
        message = f"includes another tree, {port.value!r}"
        return INCLUDE, message, "list that file under behavior_trees as well"
    if port.kind == "frame":
        return _frame(context, port.value)
    if port.kind in GRAPH_KINDS:
        return _graph_name(port)
    return None if port.kind else _mention(port, names)


INCLUDE = declare(
    "MF403",
    "tree-includes-file",
    WARNING,
    what="A behavior tree includes another file.",
    why="The included file is not rewritten with this one. The names in it are then the same for "
    "all robots.",
    fix="List that file under behavior_trees as well.",
    bad="""\
<root BTCPP_format="4">
  <include path="recovery.xml"/>
</root>
""",
    good="""\
<root BTCPP_format="4">
  <BehaviorTree ID="Recovery"><Spin spin_dist="1.57"/></BehaviorTree>
</root>
""",
    line=2,
    formats=("tree",),
)
UNDECLARED_FRAME = declare(
    "MF401",
    "tree-undeclared-frame",
    WARNING,
    what="A frame in a behavior tree is neither in the description nor published by a known node.",
    why="It stays unchanged. The node of the tree waits for a transform that nobody publishes and "
    "fails.",
    fix="Correct the name, or let a node publish the frame with the robot's name.",
    bad="""\
<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    <IsPathValid robot_base_frame="base_lnk"/>
  </BehaviorTree>
</root>
""",
    good="""\
<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    <IsPathValid robot_base_frame="base_link"/>
  </BehaviorTree>
</root>
""",
    line=3,
    formats=("tree",),
)


def _frame(context: Context, value: str) -> _Problem | None:
    if not is_undeclared(context, "frame", value):
        return None
    return UNDECLARED_FRAME, *undeclared_message(context, "frame", value)


PORT_INVALID = declare(
    "MF404",
    "tree-port-invalid",
    WARNING,
    what="The service, action or topic in a port is not a valid ROS name.",
    why="It stays unchanged. The BT navigator fails when it loads the tree, and no robot "
    "navigates.",
    fix="Correct the name: letters, digits, _ and /, and no digit at the start of a part.",
    bad="""\
<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    <ClearEntireCostmap service_name="1/clear_costmap"/>
  </BehaviorTree>
</root>
""",
    good="""\
<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    <ClearEntireCostmap service_name="local_costmap/clear_entirely_local_costmap"/>
  </BehaviorTree>
</root>
""",
    line=3,
    formats=("tree",),
)


def _graph_name(port: Port) -> _Problem | None:
    fault = check_topic_name(port.value) if is_plain(port.value) else None
    if fault is None:
        return None
    message = f"{port.value!r} is not a valid {port.kind} name: {fault.reason}"
    return PORT_INVALID, message, "it stays unchanged; correct it"


UNKNOWN_PORT = declare(
    "MF402",
    "tree-name-in-unknown-port",
    WARNING,
    what="A port or script holds a name of the robot or an absolute ROS name, but its use is not "
    "known.",
    why="It stays unchanged. If the node takes it as a frame or topic, all robots use the same "
    "one, or one that does not exist.",
    fix="If each robot needs its own, rename it by hand, or pass it in a blackboard entry such as "
    "{target}.",
    bad="""\
<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    <LookAt target="lidar_link"/>
  </BehaviorTree>
</root>
""",
    good="""\
<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    <LookAt target="{target}"/>
  </BehaviorTree>
</root>
""",
    line=3,
    formats=("tree",),
)


def _mention(port: Port, names: frozenset[str]) -> _Problem | None:
    held = next((it for it in _words(port) if holds_a_name(it, names)), "")
    if not held:
        return None
    message = f"{port.attribute} holds the name {held!r}, but its use here is not known"
    hint = "it stays unchanged; if each robot needs its own, rename it by hand"
    return UNKNOWN_PORT, message, hint


def _words(port: Port) -> list[str]:
    """What may be a name: the whole value, or the strings of a script."""
    known = port_data()
    if port.attribute in known["keep"]:
        return []
    if port.attribute not in known["scripts"]:
        return [port.value]
    return [it.strip() for it in port.value.replace('"', "'").split("'")[1::2]]
