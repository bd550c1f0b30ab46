"""Where MoveIt looks for the controller manager of ros2_control: below the root, or in a namespace."""

from __future__ import annotations

from collections.abc import Iterator

import yaml

from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.moveit.name_sites import entries
from multibot_rewrite.companions.names.by_kind import SPELLERS
from multibot_rewrite.companions.yaml_text import Splice, YamlText

# moveit_ros_control_interface looks for the manager below the root unless the namespace is set.
_MANAGER = "moveit_controller_manager"
_ROS_CONTROL, _CONTROL_NAMESPACE = "moveit_ros_control_interface/", "ros_control_namespace"


def inserted_namespace(document: YamlText, context: Context) -> Iterator[Splice]:
    """The namespace of the controller manager, if it is not set: the default is the root."""
    key = asks_below_root(document)
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


def asks_below_root(document: YamlText) -> yaml.ScalarNode | None:
    """The key that selects ros2_control, if the file does not set the manager's namespace."""
    keys = {str(key.value): (key, value) for key, value in entries(document.root)}
    if _MANAGER not in keys or _CONTROL_NAMESPACE in keys:
        return None
    key, value = keys[_MANAGER]
    return key if str(value.value).startswith(_ROS_CONTROL) else None
