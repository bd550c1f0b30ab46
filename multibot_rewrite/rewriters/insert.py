"""What has to be added: defaults and hard-wired topics that every robot would share otherwise."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.naming import NAMESPACE, POSTFIX, Naming, spelled
from multibot_rewrite.rewriters.forms import Declared
from multibot_rewrite.rewriters.spelling import ROBOT_SLOT, respelled, spell_default
from multibot_rewrite.rewriters.switches import is_true
from multibot_rewrite.rewriters.vocabulary import VocabularySection, split_path, split_step
from multibot_rewrite.rosnames import expand, split_remap

_ESCAPES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;"})
# Read from the plugin itself where it has no <ros>; a <ros> would hide them (gazebo_ros node.cpp).
ROS_CHILDREN = ("namespace", "remapping", "argument", "parameter", "qos")


class Insertion(NamedTuple):
    """An element to insert into ``parent``, inside a new ``wrap`` element unless that is empty.

    ``xml`` and ``new`` hold ``ROBOT_SLOT`` where the robot's name goes; ``old`` is what the consumer
    would use without it.
    """

    parent: etree._Element
    wrap: str
    xml: str
    kind: str
    old: str
    new: str


def insertions(
    host: etree._Element, section: VocabularySection, declared: Declared, naming: Naming
) -> list[Insertion]:
    """Everything ``host``, served by ``rewriter``, needs beyond what it says itself."""
    if not section.inserts:
        return []
    hidden = "ros/" if _ros_home(host) is host else ""
    found = list(_defaults(host, section, declared, naming, hidden))
    if any(site.path == "ros/remapping" for site in section.sites):
        found += _remaps(host, section, naming)
    return found


def _ros_home(host: etree._Element) -> etree._Element | None:
    """Where ROS settings of a plugin go; None where a ``<ros>`` must be made first."""
    ros = host.find("ros")
    if ros is not None:
        return ros
    return host if any(host.find(tag) is not None for tag in ROS_CHILDREN) else None


def _defaults(
    host: etree._Element,
    section: VocabularySection,
    declared: Declared,
    naming: Naming,
    hidden: str,
) -> Iterator[Insertion]:
    for site in section.sites:
        default = _default(host, site.default, naming)
        if not default:
            continue
        path = site.path.removeprefix(hidden)
        if _present(host, path):
            continue
        spelling = spell_default(site, default, declared, naming)
        if spelling:
            new = respelled(default, spelling, ROBOT_SLOT)
            yield _insertion(host, path, spelling[0].kind, default, new)


def _default(host: etree._Element, default: str, naming: Naming) -> str:
    """The value in force where the site is absent: a literal, or made from another topic."""
    conditions, asked, default = default.rpartition("?")
    if asked and not all(_holds(host, condition) for condition in conditions.split(",")):
        return ""
    sibling, derived, last = default.partition("/../")
    if not derived:
        return default
    # Only a postfix is in the segment that is replaced.
    topic = host.findtext(sibling, "").strip() if naming.topics == POSTFIX else ""
    return topic[: topic.rfind("/") + 1] + last if topic else ""


def _holds(host: etree._Element, condition: str) -> bool:
    child, _, wanted = condition.partition("=")
    text = host.findtext(child, "")
    return is_true(text) if wanted == "true" else text.strip() == wanted


def _present(host: etree._Element, path: str) -> bool:
    steps, attribute = split_path(path)
    found = host.find("/".join(_query(step) for step in steps))
    return found is not None and (not attribute or found.get(attribute) is not None)


def _query(step: str) -> str:
    """The step as lxml's find takes it."""
    tag, attribute, value = split_step(step)
    return f"{tag}[@{attribute}='{value}']" if attribute else tag


def _insertion(host: etree._Element, path: str, kind: str, old: str, new: str) -> Insertion:
    steps, attribute = split_path(path)
    parent, wrap = host, ""
    for step in steps[:-1]:
        child = parent.find(_query(step))
        if child is None:
            wrap = split_step(step)[0]
        else:
            parent = child
    tag, key, value = split_step(steps[-1])
    given = f' {key}="{value}"' if key else ""
    text = new.translate(_ESCAPES)
    xml = f'<{tag}{given} {attribute}="{text}"/>' if attribute else f"<{tag}{given}>{text}</{tag}>"
    return Insertion(parent, wrap, xml, kind, old, new)


def _remaps(
    host: etree._Element, section: VocabularySection, naming: Naming
) -> Iterator[Insertion]:
    """A rule for each topic that only a remap can move, unless the file has one."""
    home = _ros_home(host)
    texts = (
        [] if home is None else [e.text or "" for e in home.iterchildren("remapping", "argument")]
    )
    rules = [split_remap(text.strip()) for text in texts]
    namespace = "" if home is None else (home.findtext("namespace") or "").strip()
    node = host.get("name", "")
    taken = {expand(rule.source, namespace, node) for rule in rules if rule is not None}
    for topic in section.topics:
        target = _remap_target(topic, naming)
        if target and expand(topic, namespace, node) not in taken:
            parent, wrap = (host, "ros") if home is None else (home, "")
            xml = f"<remapping>{topic}:={target}</remapping>"
            yield Insertion(parent, wrap, xml, "topic", topic, target)


def _remap_target(topic: str, naming: Naming) -> str:
    """Where a topic goes, always relative: gz_ros2_control makes a robot's rules process-wide, and
    a relative target still ends in each robot's own namespace. Empty where it may stay."""
    relative = topic.lstrip("/")
    if topic.startswith("~") or relative in naming.shared_topics:
        return ""
    if naming.topics == NAMESPACE:
        return relative if topic.startswith("/") else ""
    target = spelled(naming, ROBOT_SLOT, "topic", relative)
    return target if target != relative else ""
