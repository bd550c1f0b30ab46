# SPDX-License-Identifier: Apache-2.0
"""What changes where one window shows several robots: its frame, its tf topic, its view, its panels."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeGuard

import yaml

from multibot_rewrite.base.findings.finding import WARNING, Finding, declare
from multibot_rewrite.planning.planned_system import tf_topic
from multibot_rewrite.related_files.rviz.display_groups import Robots, for_one_process, leaves
from multibot_rewrite.related_files.rviz.read_config import (
    ABSOLUTE,
    DOCK,
    PROCESS,
    RvizConfig,
    fixed_frame,
    frame_of,
    value,
    views_of,
)
from multibot_rewrite.related_files.yaml_text import found_at, pairs

ONE_TF_TOPIC = declare("MF203", "rviz-one-tf-topic", WARNING, formats=("fleet",))


def _tf_topic_findings(config: RvizConfig, robots: Robots, together: bool) -> Iterator[Finding]:
    layout = robots[0].names.naming.layout
    if together and not layout.tf_per_robot:
        return
    first = tf_topic(robots[0].topics.robot, robots[0].topics.naming)
    if together:
        message = "one window shows all robots only if each robot's tf is relayed to /tf"
        hint = f"ros2 run topic_tools relay {first} /tf, and the same for tf_static"
    else:
        message = (
            f"one rviz2 reads one tf topic, but in layout {layout.name} each robot has its own"
        )
        hint = (
            "each robot gets its own config; for one window write layout: frames-per-robot, or"
            " relayed: true, in the fleet file"
        )
    yield found_at(config.document, config.manager, ONE_TF_TOPIC, message, hint)


OWN_FIXED_FRAME = declare("MF201", "rviz-fixed-frame-of-one-robot", WARNING, formats=("rviz",))


FIRST_ROBOT_VIEW = declare("MF213", "rviz-view-follows-first-robot", WARNING, formats=("rviz",))


LEFT_OUT = declare("MF202", "rviz-panel-left-out", WARNING, formats=("rviz",))


def _left_out_items(config: RvizConfig, robots: Robots) -> Iterator[Finding]:
    everywhere = all(it.has_process for it in robots)
    for one in (*leaves(config.displays), *config.tools, *config.panels):
        if for_one_process(one) and not (everywhere and one.flag == PROCESS):
            title = f"{one.cls} {one.name!r}" if one.name else one.cls
            message = (
                f"{title} is left out: it works only for the robot whose namespace rviz2 runs in"
            )
            hint = "name the node set rviz_moveit or rviz_nav2: each robot gets an rviz2 with its rules"
            if one.flag == ABSOLUTE:
                hint = (
                    "its topics are absolute: delete it here, and open it in an rviz2 that has a rule"
                    " for each of them, one for each robot"
                )
            yield found_at(config.document, one.node, LEFT_OUT, message, hint)


VISIBILITY_RESET = declare("MF212", "rviz-camera-visibility-reset", WARNING, formats=("rviz",))


def config_findings(
    config: RvizConfig, robots: Robots, world: str, together: bool
) -> Iterator[Finding]:
    """Yield the findings in the order of the file.

    ``together``: one window shows all ``robots``, in the frame ``world``.
    """
    found = [*_tf_topic_findings(config, robots, together), *_left_out_items(config, robots)]
    found += _in_one_window(config, robots, world) if together else ()
    yield from sorted(found, key=lambda it: (it.line, it.column, it.code))


def _in_one_window(config: RvizConfig, robots: Robots, world: str) -> Iterator[Finding]:
    """Yield findings for a fixed frame or a view that cannot be that of all robots."""

    def differs(node: yaml.Node | None) -> TypeGuard[yaml.ScalarNode]:
        if not isinstance(node, yaml.ScalarNode):
            return False
        return any(frame_of(node, robot) != node.value for robot in robots)

    document, node = config.document, fixed_frame(config)
    if differs(node):
        now = f"it is {world!r} now" if world else "no frame is shared by all robots"
        message = f"Fixed Frame {node.value!r} differs from robot to robot; {now}"
        hint = "publish a transform from it to each robot, see pose:" if world else "set world:"
        yield found_at(document, node, OWN_FIXED_FRAME, message, hint)
    node = value(views_of(config)[0], "Target Frame")
    if len(robots) > 1 and differs(node):
        message = f"the view follows {node.value!r}; it now follows robot {robots[0].name!r}"
        hint = "each robot has a saved view"
        yield found_at(document, node, FIRST_ROBOT_VIEW, message, hint)
    for one in (it for it in leaves(config.displays) if it.flag == DOCK):
        for key, there in pairs(one.node):
            if key.value == "Visibility" and pairs(there):
                message = f"Visibility of {one.name!r} is reset: the displays are in groups now"
                hint = "choose the displays again in rviz2"
                yield found_at(document, key, VISIBILITY_RESET, message, hint)
