# SPDX-License-Identifier: Apache-2.0
"""Topics that two robots of one description would share."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import NOTE
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.model import Claim
from multibot_rewrite.base.naming import TF_TOPICS
from multibot_rewrite.base.rosnames import split_remap
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.knowledge.controller_ways import controller_way
from multibot_rewrite.rules.description.multirobot.shared import (
    claims_of,
    inserted,
    is_plain,
    process_wide_plugins,
    tag_of,
)
from multibot_rewrite.rules.facts.source_values import claim_is_fixed
from multibot_rewrite.rules.subject import Subject

ROS_KINDS = ("topic", "service")
REMAP_FORMS = ("remap", "argument")
# What a plugin has a default of, in a message.
NOUNS = {"topic": "topic", "service": "service", "stem": "name"}
GZ_SECTIONS = ("plugin gz-", "element sensor", "element gazebo", "sensor ")


@rule("MB401", "absolute-topic", NOTE)
def absolute_topic(subject: Subject) -> Iterator[Problem]:
    """Absolute ROS names that are not shared by the settings."""
    has_wide = controller_way(subject.inventory.release).process_wide
    wide = process_wide_plugins(subject) if has_wide else set()
    for claim in claims_of(subject, ROS_KINDS):
        name = _target(claim)
        if name[:1] != "/" or not is_plain(name) or _is_gz(claim):
            continue
        if name.strip("/") in subject.settings.naming.shared_topics | set(TF_TOPICS):
            continue
        # MB426 reports these.
        above = claim.element.iterancestors("plugin") if claim.site.form in REMAP_FORMS else ()
        if not wide.isdisjoint(above):
            continue
        if claim_is_fixed(subject, claim):
            message = f"{tag_of(claim)} {name!r} is absolute: a namespace does not move it"
            hint = f"{name[1:]!r} follows the robot's namespace"
            yield Problem(claim.element, message, claim.attribute, hint)


def _target(claim: Claim) -> str:
    """The topic that a claim names; of a remap rule, its target."""
    if claim.site.form not in REMAP_FORMS:
        return claim.value.strip()
    found = split_remap(claim.value)
    return found.target if found else ""


@rule("MB402", "gz-topic-shared", NOTE)
def gz_topic_shared(subject: Subject) -> Iterator[Problem]:
    """Literal gz topics."""
    claims = [it for it in claims_of(subject, ROS_KINDS) if _is_gz(it)]
    if not claims or _is_classic(subject):
        return
    for claim in claims:
        topic = claim.value.strip()
        if not is_plain(topic) or topic.strip("/") in subject.settings.naming.shared_topics:
            continue
        if not claim_is_fixed(subject, claim):
            continue
        message = f"{tag_of(claim)} {topic!r} is the same gz topic for every copy of the robot"
        yield Problem(
            claim.element, message, claim.attribute, "leave it out, or set one for each robot"
        )


def _is_gz(claim: Claim) -> bool:
    return claim.site.section.startswith(GZ_SECTIONS)


def _is_classic(subject: Subject) -> bool:
    """Is it for Gazebo Classic, which itself puts the model's name before sensor topics?"""
    from multibot_rewrite.spelling.bridged_topics import GZ_LIBRARIES, plugin_libraries

    keys = plugin_libraries(subject.inventory)
    return bool(keys) and not any(key.startswith(GZ_LIBRARIES) for key in keys)


@rule("MB413", "default-topic-shared", NOTE)
def default_topic_shared(subject: Subject) -> Iterator[Problem]:
    """Topics, services and prefixes of names that would have to be inserted for a robot."""
    for element, (kind, old, _) in inserted(subject):
        if kind in NOUNS:
            message = f"its default {NOUNS[kind]} {old!r} is the same for every robot"
            yield Problem(element, message, None, "set it for each robot")
