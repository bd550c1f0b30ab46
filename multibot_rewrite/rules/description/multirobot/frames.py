# SPDX-License-Identifier: Apache-2.0
"""Frames and tf that two robots of one description would share."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.model import Claim
from multibot_rewrite.base.naming import FRAME_KINDS
from multibot_rewrite.base.rosnames import split_remap
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.switches import switched_off
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.rules.description.multirobot.topics import inserted, is_plain, missed, tag_of
from multibot_rewrite.rules.facts.source_values import claim_is_fixed
from multibot_rewrite.rules.subject import Subject


@rule("MB404", "robot-name-in-frame", WARNING)
def robot_name_in_frame(subject: Subject) -> Iterator[Problem]:
    """Frames that are a link with something and a slash in front."""
    links = subject.inventory.declared["link"]
    for claim in subject.inventory.claims if subject.inventory.hosts else ():
        if "/" not in claim.value or "frame" not in claim.site.kinds:
            continue
        value = claim.value.strip("/")
        if "/" not in value or value in links:
            continue
        link = value.partition("/")[2].strip("/")
        if link in links and is_plain(value) and claim_is_fixed(subject, claim):
            message = (
                f"frame {claim.value!r} has a robot's name in front, the link is called {link!r}"
            )
            yield Problem(claim.element, message, claim.attribute, f"use {link!r}")


@rule("MB406", "default-frame-shared", NOTE)
def default_frame_shared(subject: Subject) -> Iterator[Problem]:
    """Frames that would have to be inserted for a robot."""
    for element, item in inserted(subject):
        if item[0] in ("frame", "link"):
            message = f"without <{item[2]}> the plugin uses {item[1]!r}, the same for every robot"
            yield Problem(element, message, None, f"set <{item[2]}> for each robot")


@rule("MB433", "default-frame-below-model", NOTE)
def default_frame_below_model(subject: Subject) -> Iterator[Problem]:
    """Frames that would be below the name by which the model is spawned."""
    for element, item in missed(subject):
        if item.kind in FRAME_KINDS:
            tag = item.xml[1:].partition(">")[0]
            was = item.old.replace("{model}", "MODEL")
            message = f"without <{tag}> the frame is {was!r}, which no robot has in tf"
            yield Problem(element, message, None, f"set <{tag}>; urdf-postfix does")


@rule("MB407", "fixed-odometry-frame", NOTE)
def fixed_odometry_frame(subject: Subject) -> Iterator[Problem]:
    """Literal odometry frames that are no links and hold no robot's name."""
    if not subject.inventory.hosts:
        return
    links, shared = subject.inventory.declared["link"], subject.settings.naming.shared_frames
    for claim in subject.inventory.claims:
        if "frame" not in claim.site.kinds or claim.site.form != "whole":
            continue
        name = claim.value.strip("/")
        if "odom" not in _words(claim) or {name, name.rpartition("/")[2]} & (links.keys() | shared):
            continue
        if is_plain(name) and claim_is_fixed(subject, claim):
            message = (
                f"{tag_of(claim)} {claim.value!r} is the same frame for every copy of the robot"
            )
            yield Problem(
                claim.element, message, claim.attribute, "use a different one for each robot"
            )


def _words(claim: Claim) -> str:
    return f"{claim.value} {claim.site.path}".lower()


@rule("MB408", "tf-not-remapped", NOTE)
def tf_not_remapped(subject: Subject) -> Iterator[Problem]:
    """Plugins with tf switched on and no rule for it, unless the robots share one /tf."""
    if subject.settings.robots and not subject.settings.naming.layout.tf_per_robot:
        return
    for host in subject.inventory.hosts:
        section = host.node.section
        if section is None or "/tf" not in section.publishes or not section.inserts:
            continue
        if "/tf" in switched_off(host.element, section) or _moves_tf(host.element):
            continue
        of = "the controllers it loads publish" if section.process_wide else "it publishes"
        message = (
            f"plugin {host.element.get('name', '')!r}: {of} on /tf, which a namespace does not move"
        )
        yield Problem(host.element, message, None, "add <remapping>/tf:=tf</remapping>")


def _moves_tf(plugin: _Element) -> bool:
    rules = (split_remap(text_of(it)) for it in plugin.iter("remapping", "argument"))
    return any(it is not None and it.source.strip("/") == "tf" for it in rules)
