# SPDX-License-Identifier: Apache-2.0
"""The window for all robots where a bridge puts their names before the frames on their way to ``/tf``.

Links have bare names and frames the robot's, as with robot_state_publisher's ``frame_prefix``; those in
headers of messages stay bare. Source: tf_namespace_bridge src/tf_namespace_bridge.cpp; rviz_common
src/rviz_common/transformation (displays of messages look their header's frame up in tf).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.base.naming import PREFIX, make_naming
from multibot_rewrite.companions.rviz.display_groups import leaves
from multibot_rewrite.companions.rviz.read_config import TOPIC, RvizItem, read_config
from multibot_rewrite.companions.rviz.rewrite import RvizText, rewrite_rviz
from multibot_rewrite.companions.rviz.values import TF_PREFIX, RvizRobot
from multibot_rewrite.companions.yaml_text import YamlText, found_at

AT_RUN_TIME = "frame-prefix"

BARE_HEADERS = declare("MF216", "rviz-bridged-messages", WARNING, formats=("fleet",))


def bridged_window(
    document: YamlText, robots: Sequence[RvizRobot], world: str
) -> tuple[RvizText, tuple[Finding, ...]]:
    """The config for all robots, and what it cannot show; raises as ``rewrite_rviz``."""
    texts, _ = rewrite_rviz(document, [_bridged(it, world) for it in robots], world=world)
    shown = next(it for it in texts if not it.robot)
    return shown, tuple(_bare_headers(document))


def _bridged(robot: RvizRobot, world: str) -> RvizRobot:
    """The robot as it is on ``/tf``."""
    shared = [world] if world else []
    naming = make_naming(layout=AT_RUN_TIME, affix=PREFIX, shared_frames=shared)
    own = robot.topics.robot
    names = robot.names._replace(naming=naming, robot=own)
    return robot._replace(names=names, tf_prefix=own)


def _bare_headers(document: YamlText) -> Iterator[Finding]:
    found = [it for it in leaves(read_config(document).displays) if _shows_messages(it)]
    if found:
        names = ", ".join(it.name or it.cls for it in found)
        message = (
            f"in the window for all robots nothing is shown by {names}: headers have bare frames"
        )
        hint = "each robot has a window for it; or take layout both"
        yield found_at(document, found[0].node, BARE_HEADERS, message, hint)


def _shows_messages(one: RvizItem) -> bool:
    kinds = {it.kind for it in one.places}
    return TOPIC in kinds and TF_PREFIX not in kinds
