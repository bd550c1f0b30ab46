# SPDX-License-Identifier: Apache-2.0
"""Topics, namespaces, frames and descriptions that two robots of one description would share."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from operator import itemgetter

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import NOTE, WARNING, rule
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import Claim
from multibot_rewrite.base.naming import FRAME_KINDS, NOT_PLAIN, TF_TOPICS, make_naming
from multibot_rewrite.base.rosnames import split_remap
from multibot_rewrite.description.checks import hazards
from multibot_rewrite.description.checks.hazards import ignored_namespaces, used_namespaces
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.insert import Insertion, insertions, lacks_namespace
from multibot_rewrite.description.rewriters.own_defaults import switched_off
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.knowledge.controller_ways import controller_way
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.facts.source_values import claim_is_fixed, is_fixed, starts_of
from multibot_rewrite.rules.subject import Subject

# Frames, tf and topics are all per robot: what a rewrite inserts for that is shared by copies.
APART = make_naming("both")
AS_WRITTEN = make_naming("tf-per-robot")
ONE_TF = make_naming("frames-per-robot")


def claims_of(subject: Subject, kinds: tuple[str, ...]) -> list[Claim]:
    """Return claims whose first kind is one of ``kinds`` and that name no link or joint."""
    by_kind = _claims_by_kind(subject) if subject.inventory.hosts else {}
    found = [it for kind in kinds for it in by_kind.get(kind, ())]
    return [claim for _, claim in sorted(found, key=itemgetter(0))]


@memoized
def _claims_by_kind(subject: Subject) -> Mapping[str, Sequence[tuple[int, Claim]]]:
    """Return the numbered claims by their first kind, without those that name a link or joint."""
    claims = [(at, it.site, it) for at, it in enumerate(subject.inventory.claims)]
    left = (it for it in claims if not it[1].whole_value_kind)
    return lists_by_key((site.kinds[0], (at, claim)) for at, site, claim in left)


def is_plain(text: str) -> bool:
    """Return whether a text is a name: not empty and not a placeholder."""
    return bool(text.strip("/")) and NOT_PLAIN.isdisjoint(text) and not text.startswith("__")


def tag_of(claim: Claim) -> str:
    """Return how a message names the element of a claim."""
    name = claim.element.get("name") if claim.element.tag == "param" else None
    return f"parameter {name!r}" if name else f"<{claim.element.tag}>"


def process_wide_plugins(subject: Subject) -> set[_Element]:
    """Return the plugins that give their remap rules to the whole Gazebo process."""
    hosts = subject.inventory.hosts
    return {it.element for it in hosts if it.node.section and it.node.section.process_wide}


def inserted(subject: Subject) -> Iterator[tuple[_Element, tuple[str, str, str]]]:
    """Yield (plugin, (kind, default, tag)) for what urdf-postfix would insert, but no namespaces."""
    for host, it in _insertions(subject):
        tag = it.xml[1:].partition(">")[0].partition(" ")[0]
        if it.shared and it.kind != "namespace" and tag != "remapping":
            yield host, (it.kind, it.old, tag)


def missing_defaults(subject: Subject) -> Iterator[tuple[_Element, Insertion]]:
    """Yield (plugin, default) for names that urdf-postfix would replace, except shared ones."""
    yield from ((host, it) for host, it in _insertions(subject) if not it.shared)


@memoized
def _insertions(subject: Subject) -> list[tuple[_Element, Insertion]]:
    """Return what a rewrite would insert, with the plugin it is for."""
    declared, hosts = subject.inventory.declared, subject.inventory.served
    may = [
        (host, section)
        for host, section in hosts
        if any(site.default and "namespace" not in site.kinds for site in section.sites)
    ]
    plugins = {host for host, _ in may}
    found = []
    for it in insertions(may, declared, APART):
        inside = it.parent
        while inside not in plugins:
            inside = inside.getparent()  # type: ignore[assignment]
        found.append((inside, it))
    return found


ROS_KINDS = ("topic", "service")
REMAP_FORMS = ("remap", "argument")
# What a plugin has a default of, in a message.
NOUNS = {"topic": "topic", "service": "service", "stem": "name"}
GZ_SECTIONS = ("plugin gz-", "element sensor", "element gazebo", "sensor ")


@rule("MB401", "absolute-topic", NOTE)
def absolute_topic(subject: Subject) -> Iterator[Problem]:
    """Report absolute ROS names that are not shared by the settings."""
    has_wide = controller_way(subject.inventory.release).process_wide
    wide = process_wide_plugins(subject) if has_wide else set()
    shared = subject.settings.naming.shared_topics | set(TF_TOPICS)
    for claim in claims_of(subject, ROS_KINDS):
        name = _target(claim)
        is_gz = claim.site.section.startswith(GZ_SECTIONS)
        if name[:1] != "/" or not is_plain(name) or is_gz or name.strip("/") in shared:
            continue
        # MB426 reports these.
        above = claim.element.iterancestors("plugin") if claim.site.form in REMAP_FORMS else ()
        if wide.isdisjoint(above) and claim_is_fixed(subject, claim):
            message = f"{tag_of(claim)} {name!r} is absolute: a namespace does not move it"
            hint = f"{name[1:]!r} follows the robot's namespace"
            yield Problem(claim.element, message, claim.attribute, hint)


def _target(claim: Claim) -> str:
    """Return the topic that a claim names; for a remap rule, its target."""
    if claim.site.form not in REMAP_FORMS:
        return claim.value.strip()
    found = split_remap(claim.value)
    return found.target if found else ""


@rule("MB402", "gz-topic-shared", NOTE)
def gz_topic_shared(subject: Subject) -> Iterator[Problem]:
    """Report literal gz topics."""
    claims = [it for it in claims_of(subject, ROS_KINDS) if it.site.section.startswith(GZ_SECTIONS)]
    if not claims or _is_classic(subject):
        return
    for claim in claims:
        topic = claim.value.strip()
        shared = topic.strip("/") in subject.settings.naming.shared_topics
        if is_plain(topic) and not shared and claim_is_fixed(subject, claim):
            message = f"{tag_of(claim)} {topic!r} is the same gz topic for every copy of the robot"
            hint = "leave it out, or set one for each robot"
            yield Problem(claim.element, message, claim.attribute, hint)


def _is_classic(subject: Subject) -> bool:
    """Return whether a file is for Gazebo Classic, which names sensor topics after the model."""
    from multibot_rewrite.planning.bridged_topics import GZ_LIBRARIES, plugin_libraries

    keys = plugin_libraries(subject.inventory)
    return bool(keys) and not any(key.startswith(GZ_LIBRARIES) for key in keys)


@rule("MB413", "default-topic-shared", NOTE)
def default_topic_shared(subject: Subject) -> Iterator[Problem]:
    """Report topics, services and prefixes of names that would have to be inserted for a robot."""
    for element, (kind, old, _) in inserted(subject):
        if kind in NOUNS:
            message = f"its default {NOUNS[kind]} {old!r} is the same for every robot"
            yield Problem(element, message, None, "set it for each robot")


@rule("MB403", "hard-coded-namespace", NOTE)
def hard_coded_namespace(subject: Subject) -> Iterator[Problem]:
    """Report each literal namespace, at its first place."""
    plain = (it for it in claims_of(subject, ("namespace",)) if is_plain(it.value))
    found = lists_by_key((it.value, it) for it in plain if claim_is_fixed(subject, it))
    for value, claims in found.items():
        where = f" in {len(claims)} plugins" if len(claims) > 1 else ""
        message = f"the namespace {value!r}{where} is the same for every copy of the robot"
        yield Problem(claims[0].element, message, claims[0].attribute, "make it a xacro argument")


@rule("MB409", "no-namespace", NOTE)
def no_namespace(subject: Subject) -> Iterator[Problem]:
    """Yield a problem for the first plugin without a namespace, with their number."""
    inventory = subject.inventory
    bare = [
        element
        for element, section in inventory.served
        if lacks_namespace(element, section, inventory.declared, APART)
    ]
    if bare:
        have = f"and {len(bare) - 1} more have" if len(bare) > 1 else "has"
        message = f"plugin {bare[0].get('name', '')!r} {have} no namespace"
        yield Problem(bare[0], message, None, "give each robot its own")


@rule("MB410", "one-robot-description", NOTE)
def one_robot_description(subject: Subject) -> Iterator[Problem]:
    """Report absolute names of descriptions and of the nodes that hold them."""
    found = [*hazards.one_description(subject.inventory, AS_WRITTEN)]
    starts = starts_of(subject, [it.element for it in found])
    yield from (it for it in found if is_fixed(subject, starts[it.element], ""))


@rule("MB419", "ignored-model-namespace", WARNING)
def ignored_model_namespace(subject: Subject) -> Iterator[Problem]:
    """Report each model's namespace that the release's Gazebo does not read."""
    return ignored_namespaces(subject.inventory, subject.tree)


@rule("MB429", "model-namespace-in-use", WARNING, options={"distro": "rolling"})
def model_namespace_in_use(subject: Subject) -> Iterator[Problem]:
    """Report each model's namespace that plugins put in front of their relative topics."""
    return used_namespaces(subject.inventory, subject.tree)


@rule("MB404", "robot-name-in-frame", WARNING)
def robot_name_in_frame(subject: Subject) -> Iterator[Problem]:
    """Report frames that are a link with something and a slash in front."""
    links = subject.inventory.declared["link"]
    for claim in subject.inventory.claims if subject.inventory.hosts else ():
        if "/" not in claim.value or "frame" not in claim.site.kinds:
            continue
        value = claim.value.strip("/")
        if "/" not in value or value in links:
            continue
        link = value.partition("/")[2].strip("/")
        if link in links and is_plain(value) and claim_is_fixed(subject, claim):
            fault = f"has a robot's name in front, the link is called {link!r}"
            message = f"frame {claim.value!r} {fault}"
            yield Problem(claim.element, message, claim.attribute, f"use {link!r}")


@rule("MB406", "default-frame-shared", NOTE)
def default_frame_shared(subject: Subject) -> Iterator[Problem]:
    """Report frames that would have to be inserted for a robot."""
    for element, item in inserted(subject):
        if item[0] in ("frame", "link"):
            message = f"without <{item[2]}> the plugin uses {item[1]!r}, the same for every robot"
            yield Problem(element, message, None, f"set <{item[2]}> for each robot")


@rule("MB433", "default-frame-below-model", NOTE)
def default_frame_below_model(subject: Subject) -> Iterator[Problem]:
    """Report frames that would be below the name by which the model is spawned."""
    for element, item in missing_defaults(subject):
        if item.kind in FRAME_KINDS:
            tag = item.xml[1:].partition(">")[0]
            was = item.old.replace("{model}", "MODEL")
            message = f"without <{tag}> the frame is {was!r}, which no robot has in tf"
            yield Problem(element, message, None, f"set <{tag}>; urdf-postfix does")


@rule("MB407", "fixed-odometry-frame", NOTE)
def fixed_odometry_frame(subject: Subject) -> Iterator[Problem]:
    """Report literal odometry frames that are no links and hold no robot's name."""
    if not subject.inventory.hosts:
        return
    links, shared = subject.inventory.declared["link"], subject.settings.naming.shared_frames
    for claim in subject.inventory.claims:
        if "frame" not in claim.site.kinds or claim.site.form != "whole":
            continue
        name = claim.value.strip("/")
        words = f"{claim.value} {claim.site.path}".lower()
        if "odom" not in words or {name, name.rpartition("/")[2]} & (links.keys() | shared):
            continue
        if is_plain(name) and claim_is_fixed(subject, claim):
            fault = "is the same frame for every copy of the robot"
            message = f"{tag_of(claim)} {claim.value!r} {fault}"
            hint = "use a different one for each robot"
            yield Problem(claim.element, message, claim.attribute, hint)


@rule("MB408", "tf-not-remapped", NOTE)
def tf_not_remapped(subject: Subject) -> Iterator[Problem]:
    """Report plugins that send tf without a rule for it, unless the robots share one /tf."""
    if subject.settings.robots and not subject.settings.naming.layout.tf_per_robot:
        return
    for host in subject.inventory.hosts:
        section = host.node.section
        if section is None or "/tf" not in section.publishes or not section.inserts:
            continue
        rules = (split_remap(text_of(it)) for it in host.element.iter("remapping", "argument"))
        moved = any(it is not None and it.source.strip("/") == "tf" for it in rules)
        if moved or "/tf" in switched_off(host.element, section):
            continue
        name = host.element.get("name", "")
        of = "the controllers it loads publish" if section.process_wide else "it publishes"
        message = f"plugin {name!r}: {of} on /tf, which a namespace does not move"
        yield Problem(host.element, message, None, "add <remapping>/tf:=tf</remapping>")
