# SPDX-License-Identifier: Apache-2.0
"""<gazebo> blocks that contradict each other, or whose reference has two meanings."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import NOTE, WARNING, rule
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.references import ambiguous
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.description.rewriters.tree import library_key
from multibot_rewrite.rules.subject import Subject

_OF_JOINTS = ("force_torque", "wrench")
# The values of a <gazebo> block of which a link has one each (libsdformat parser_urdf.cc); some have
# two tags.
SINGLE = {
    "material": "material",
    "mu1": "mu1",
    "mu2": "mu2",
    "kp": "kp",
    "kd": "kd",
    "maxVel": "max_vel",
    "max_vel": "max_vel",
    "minDepth": "min_depth",
    "min_depth": "min_depth",
    "maxContacts": "max_contacts",
    "max_contacts": "max_contacts",
    "laserRetro": "laser_retro",
    "laser_retro": "laser_retro",
    "selfCollide": "self_collide",
    "self_collide": "self_collide",
    "gravity": "gravity",
    "dampingFactor": "dampingFactor",
    "stopCfm": "stop_cfm",
    "stop_cfm": "stop_cfm",
    "stopErp": "stop_erp",
    "stop_erp": "stop_erp",
    "fudgeFactor": "fudge_factor",
    "fudge_factor": "fudge_factor",
    "implicitSpringDamper": "implicit_spring_damper",
    "implicit_spring_damper": "implicit_spring_damper",
    "provideFeedback": "provide_feedback",
    "provide_feedback": "provide_feedback",
}


@rule("MB203", "link-and-joint", WARNING)
def link_and_joint(subject: Subject) -> Iterator[Problem]:
    """Every such reference."""
    yield from ambiguous(subject.inventory)


@rule("MB210", "contradicting-blocks", NOTE)
def contradicting_blocks(subject: Subject) -> Iterator[Problem]:
    """Properties of which a link or joint has one."""
    values: dict[tuple[str, str], str] = {}
    for block in subject.elements.tops("gazebo"):
        target = block.get("reference", "")
        for it in block if target else ():
            if it.tag not in SINGLE:
                continue
            text = " ".join((it.text or "").split())
            earlier = values.setdefault((target, SINGLE[it.tag]), text)
            if earlier != text:
                message = f"{it.tag} of {target!r} is {text!r} here and was {earlier!r} before"
                yield Problem(it, message, "", "keep one")


def sensors_elsewhere(subject: Subject) -> Iterator[Problem]:
    """Sensors of Gazebo in a link of a URDF, which sdformat's converter passes over; those of other
    readers name their parent, and have their rate in an attribute."""
    for it in subject.elements.every("sensor"):
        above = it.getparent()
        link = None if above is None else subject.robot.link.get(above.get("name", ""))
        is_ours = it.find("update_rate") is not None and it.find("parent") is None
        if link and link.element is above and is_ours:
            message = f"sensor {it.get('name')!r} is in <link>, where no simulator looks"
            yield Problem(it, message, None, f"move it into <gazebo reference={link.name!r}>")


def sensors_of_joints(subject: Subject) -> Iterator[Problem]:
    """Sensors in the block of a joint: SDF has only those of forces there (sdformat joint.sdf)."""
    for block_ in subject.elements.tops("gazebo"):
        name = block_.get("reference", "")
        if name in subject.robot.joint and name not in subject.robot.link:
            for it in block_.iterchildren("sensor"):
                if it.get("type") not in _OF_JOINTS:
                    message = f"sensor {it.get('name')!r} is in the block of joint {name!r}"
                    child = subject.robot.joint[name].child
                    yield Problem(it, message, None, f"refer to a link: {child!r}?")


@rule("MB241", "topic-of-two-sensors", WARNING)
def topic_of_two_sensors(subject: Subject) -> Iterator[Problem]:
    """Topics as they are written; the first sensor keeps its own."""
    first: dict[str, str] = {}
    for sensor in subject.elements.every("sensor"):
        topic, name = text_at(sensor, "topic"), sensor.get("name", "")
        element = sensor.find("topic")
        if not topic or "$" in topic or element is None or sensor.getparent() is None:
            continue
        other = first.setdefault(topic, name)
        if other != name:
            yield Problem(element, f"sensors {other!r} and {name!r} have one topic, {topic!r}", "")


@rule("MB243", "topic-of-two-systems", WARNING)
def topic_of_two_systems(subject: Subject) -> Iterator[Problem]:
    """Yield each system that sends on a topic which an earlier one has."""
    if sum("::" in it.get("name", "") for it in subject.elements.every("plugin")) < 2:
        return
    from multibot_rewrite.base.naming import make_naming
    from multibot_rewrite.spelling.bridged_topics import DIRECTIONS, model_name, plugin_topics

    inventory = subject.inventory
    model = model_name(inventory) or "MODEL"
    senders: dict[str, str] = {}
    for plugin, topics, _ in plugin_topics(inventory, model, model, make_naming("tf-per-robot")):
        own = {f"/{it.gz.lstrip('/')}" for it in topics if it.direction == DIRECTIONS["in"]}
        who = library_key(plugin.get("filename", ""))
        for topic in sorted(own):
            if topic in senders:
                message = f"{who} sends on {topic!r}, and so does {senders[topic]}"
                yield Problem(plugin, message, None, "give one of them a topic of its own")
            senders.setdefault(topic, who)
