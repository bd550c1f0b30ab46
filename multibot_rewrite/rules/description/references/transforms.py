"""Frames that the joints of a description place, and a plugin of it as well."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.own_defaults import frame_sites
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.rules.description.references.shared import FIXED, a_plugin
from multibot_rewrite.rules.subject import Subject

AS_WRITTEN = make_naming("tf-per-robot")


@rule(
    "MB230",
    "frame-of-joint-and-plugin",
    WARNING,
    what="A plugin sends the transform from its odometry frame to a link that is a joint's child.",
    why="robot_state_publisher sends the joint's transform: the frame has two parents and jumps "
    "between them, and tf loses the way from odom to the robot's root.",
    fix="Let the plugin send the root link of the robot, or switch its transform off.",
    bad=FIXED
    + a_plugin(
        "gazebo_ros_diff_drive",
        "drive",
        "<ros/>",
        "<publish_odom_tf>true</publish_odom_tf>",
        "<robot_base_frame>b</robot_base_frame>",
    ),
    good=FIXED
    + a_plugin(
        "gazebo_ros_diff_drive",
        "drive",
        "<ros/>",
        "<publish_odom_tf>true</publish_odom_tf>",
        "<robot_base_frame>a</robot_base_frame>",
    ),
    line=7,
)
def frame_with_two_parents(subject: Subject) -> Iterator[Problem]:
    """Plugins that send odometry to a link below the root."""
    for plugin, parent, child in _sent(subject):
        for joint in subject.robot.above.get(child, ())[:1]:
            message = (
                f"sends {parent} -> {child}, and so does joint {joint.name!r} from {joint.parent}"
            )
            hint = f"name the robot's root link, or switch one of them off; joint {joint.name}"
            line = "" if subject.origins else f": line {joint.element.sourceline}"
            yield Problem(plugin, message, None, hint + line)


def _sent(subject: Subject) -> Iterator[tuple[_Element, str, str]]:
    """Each plugin with the transform of odometry that it sends."""
    document, vocabulary = subject.document, subject.tree.vocabulary
    for host, section in subject.inventory.served:
        # gz-sim's send theirs by a bridge.
        frames = [text_at(host, it.path) for it in frame_sites(host, section, AS_WRITTEN)]
        if len(frames) == 2 and all(frames):
            yield host, frames[0], frames[1]
    if any("/tf" in section.publishes for _, section in subject.inventory.served):
        from multibot_rewrite.description.readback.reading import (
            read,  # most descriptions need none of it
        )

        plugins = [*document.root.iter("plugin")]
        for node in read(document.source, document.file, vocabulary).nodes:
            frames_of = dict(node.frames)
            for parent, child in node.sends:
                yield plugins[node.number], frames_of[parent], frames_of[child]
