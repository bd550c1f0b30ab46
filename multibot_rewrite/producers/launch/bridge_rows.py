"""The arguments of a bridge to Gazebo -> the topics and services that it has in ROS.

Source: ros_gz jazzy 739cb42, ros_gz_bridge/src/parameter_bridge.cpp (``TOPIC@TYPE[GZ_TYPE``, with ``[``
from Gazebo, ``]`` to Gazebo, ``@`` both; ``SERVICE@TYPE``) and ros_gz_image/src/image_bridge.cpp.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator

from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.producers.launch.records import LaunchedNode
from multibot_rewrite.system.records import PUBLISHES, SERVES, SERVICE, SUBSCRIBES, TOPIC

_ROW = re.compile(r"(?P<name>[^@]+)@(?P<type>[\w/]+)(?P<way>[@\[\]]?)(?P<gz>.*)")
_ROLES = {"[": (PUBLISHES,), "]": (SUBSCRIBES,), "@": (PUBLISHES, SUBSCRIBES)}
_IMAGE = "sensor_msgs/msg/Image"
_BRIDGES = ("ros_gz_bridge/parameter_bridge", "ros_ign_bridge/parameter_bridge")
_OF_IMAGES = ("ros_gz_image/image_bridge", "ros_ign_image/image_bridge")


def bridge_rows(node: LaunchedNode, words: Collection[str]) -> tuple[Endpoint, ...]:
    """What the arguments of a bridge say that it has in ROS; nothing for another program.

    The same text names the topic in Gazebo. With one of ``words`` in it, it is that of one robot: then
    its remap rule counts, and without a rule the name is left out.
    """
    rows = [*_rows(node)]
    rules = {f"/{old.lstrip('/')}": new for old, new in node.remappings}
    return tuple(end for it in rows for end in _for_any_robot(it, rules, words))


def _rows(node: LaunchedNode) -> Iterator[Endpoint]:
    program = f"{node.package}/{node.executable}"
    for word in node.arguments:
        row = _ROW.fullmatch(word)
        if program in _BRIDGES and row is not None:
            yield from _row(row)
        elif program in _OF_IMAGES and row is None and not word.startswith("-"):
            yield Endpoint(TOPIC, PUBLISHES, word, _IMAGE, transport=True)


def _row(row: re.Match[str]) -> Iterator[Endpoint]:
    name, type_, way, _ = row.groups()
    if "/srv/" in type_:
        yield Endpoint(SERVICE, SERVES, name, type_)
        return
    full = type_ if type_.count("/") > 1 else type_.replace("/", "/msg/")
    yield from (Endpoint(TOPIC, role, name, full) for role in _ROLES.get(way, ()))


def _for_any_robot(
    it: Endpoint, rules: dict[str, str], words: Collection[str]
) -> Iterator[Endpoint]:
    if not set(it.name.split("/")) & set(words):
        yield it
        return
    target = rules.get(f"/{it.name.lstrip('/')}", "")
    if target and not set(target.split("/")) & set(words):
        # The layout decides where tf is, as for every node.
        yield it._replace(name=f"/{target}" if target in ("tf", "tf_static") else target)
