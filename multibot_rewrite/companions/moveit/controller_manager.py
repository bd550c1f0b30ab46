"""Where MoveIt looks for the controller manager of ros2_control: below the root, or in a namespace."""

from __future__ import annotations

from collections.abc import Iterator

import yaml

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.base.naming import NAMESPACE
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.moveit.name_sites import entries
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.names.by_kind import SPELLERS
from multibot_rewrite.companions.sites import found_in, slot_of
from multibot_rewrite.companions.yaml_text import Splice, YamlText

# moveit_ros_control_interface looks for the manager below the root unless the namespace is set.
_MANAGER = "moveit_controller_manager"
_ROS_CONTROL, _CONTROL_NAMESPACE = "moveit_ros_control_interface/", "ros_control_namespace"


def inserted_namespace(document: YamlText, context: Context) -> Iterator[Splice]:
    """The namespace of the controller manager, if it is not set: the default is the root."""
    key = _asks_below_root(document)
    default = SPELLERS["namespace"](context, "/")
    flow = isinstance(document.root, yaml.MappingNode) and document.root.flow_style
    if key is None or default == "/":
        return
    if flow:
        at = key.start_mark.index
        yield Splice(at, at, f"{_CONTROL_NAMESPACE}: {default}, ")
        return
    end = "\r\n" if "\r\n" in document.text else "\n"
    at = key.start_mark.index
    yield Splice(at, at, f"{_CONTROL_NAMESPACE}: {default}{end}{' ' * key.start_mark.column}")


ONE_CONTROLLER_MANAGER = declare(
    "MF308",
    "moveit-one-controller-manager",
    WARNING,
    what="A file selects Ros2ControlManager, but in this layout the controller manager of each "
    "robot has another name.",
    why="Ros2ControlManager looks for a node called controller_manager, at the root or in the "
    "namespace ros_control_namespace. In a layout without namespaces there is "
    "controller_manager_robot1 only: move_group finds no controllers and executes no trajectory.",
    fix="Use moveit_simple_controller_manager, which calls the actions of the controllers, or a "
    "layout with namespaces.",
    bad="""\
moveit_controller_manager: moveit_ros_control_interface/Ros2ControlManager
""",
    good="""\
moveit_controller_manager: moveit_simple_controller_manager/MoveItSimpleControllerManager
""",
    formats=("moveit",),
    options={"layout": "postfix"},
)


def unreachable_managers(document: YamlText, file: NamedFile) -> Iterator[Finding]:
    """Places that select a controller manager which no robot has."""
    if file.context.names.naming.topics == NAMESPACE:
        return
    key = _asks_below_root(document)
    slots = [slot_of(key)] if key else []
    for slot in (*slots, *(it.slot for it in file.names if it.kind == "namespace")):
        message = "MoveIt looks for /controller_manager, but each robot's has a different name"
        hint = "use moveit_simple_controller_manager or a layout with namespaces"
        yield found_in(file.file, slot, ONE_CONTROLLER_MANAGER, message, hint)


def _asks_below_root(document: YamlText) -> yaml.ScalarNode | None:
    """The key that selects ros2_control, if the file does not set the manager's namespace."""
    keys = {str(key.value): (key, value) for key, value in entries(document.root)}
    if _MANAGER not in keys or _CONTROL_NAMESPACE in keys:
        return None
    key, value = keys[_MANAGER]
    return key if str(value.value).startswith(_ROS_CONTROL) else None
