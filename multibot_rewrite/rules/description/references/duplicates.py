# SPDX-License-Identifier: Apache-2.0
"""Names that are declared twice, and <gazebo> blocks that contradict each other or are ambiguous."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator
from itertools import zip_longest

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, locate, rule
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import Claim
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.references import ambiguous, repeated
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.description.rewriters.tree import library_key
from multibot_rewrite.rules.facts.memo import since_jazzy
from multibot_rewrite.rules.schema.faults import canonical
from multibot_rewrite.rules.subject import Subject, name_of


@rule("MB201", "duplicate-name", ERROR)
def duplicate_name(subject: Subject) -> Iterator[Problem]:
    """Report names of one kind, every one except the first."""
    yield from declared_twice(subject)
    for mild in (repeated_joint, system_twice):
        yield from (it._replace(level=WARNING) for it in mild(subject))
    for fatal in (duplicate_part, duplicate_sensor, one_node_twice):
        yield from fatal(subject)


def declared_twice(subject: Subject) -> Iterator[Problem]:
    """Report links and joints; one finding for all that one macro call repeats."""
    pairs = repeated(subject.inventory)
    calls = lists_by_key((_repeated_by(subject, *pair) or pair[0], pair) for pair in pairs)
    for (claim, first), *more in calls.values():
        text = f"{claim.site.kinds[0]} {claim.value!r} is declared twice"
        are = "are" if len(more) > 1 else "is"
        also = f", and so {are} {len(more)} more from the same call" if more else ""
        hint = "give each call its own prefix" if more else "rename one"
        # Lines of an expanded document are in no file.
        line, _ = locate(subject.document.source, first.start)
        message = text + ("" if subject.origins else f", first at line {line}") + also
        yield Problem(claim.element, message, claim.attribute, hint)


def _repeated_by(subject: Subject, claim: Claim, first: Claim) -> object:
    """Return why xacro wrote an element twice: the macro call, or the file included again."""
    if not subject.origins:
        return None
    starts = (bisect_left(subject.document.starts, it.start) for it in (first, claim))
    one, other = map(subject.origins.of, starts)
    if one is None or other is None or (one.file, one.start) != (other.file, other.start):
        return None
    outer = zip_longest(reversed(other.calls), reversed(one.calls))
    return next((new for new, old in outer if new != old), (other.file, other.calls))


def repeated_joint(subject: Subject) -> Iterator[Problem]:
    """Report components of one kind and name in one system."""
    for system in subject.elements.every("ros2_control"):
        components = system.iterchildren("joint", "sensor", "gpio")
        keys = (((it.tag, name_of(it)), it) for it in components if name_of(it))
        for it in _repeated(keys):
            message = f"{it.tag} {name_of(it)!r} appears twice in this <ros2_control>"
            yield Problem(it, message, "name", "put its interfaces in one element")


def duplicate_sensor(subject: Subject) -> Iterator[Problem]:
    """Report sensors in blocks for one link, or for links that Gazebo merges at fixed joints."""
    root = subject.document.root
    inside = ((it.getparent(), it) for it in subject.elements.every("sensor"))
    bodies = subject.robot.body
    sensors = (
        ((bodies.get(link := block.get("reference", ""), link), name_of(it)), it)
        for block, it in inside
        if block is not None and block.tag == "gazebo" and block.getparent() is root
        if block.get("reference") and name_of(it)
    )
    for it in _repeated(sensors):
        from multibot_rewrite.planning.bridged_topics import is_for_classic

        link = it.getparent().get("reference", "")  # type: ignore[union-attr]
        body = bodies.get(link, link)
        merged = "" if body == link else f", into which fixed joints merge {link!r},"
        message = f"{body!r}{merged} has another sensor {name_of(it)!r}"
        # Gazebo Classic reads no SDF model by its names.
        level = WARNING if merged and is_for_classic(subject.inventory) else ""
        yield Problem(it, message, "name", "rename one", level=level)


def duplicate_part(subject: Subject) -> Iterator[Problem]:
    """Report parts of the robot, right below the root; a link may repeat a material."""
    alike = "delete one: urdfdom rejects both even if they are alike"
    for tag, level, message, hint in (
        (
            "ros2_control",
            since_jazzy(subject),
            "there is another <ros2_control> {!r}",
            "rename one",
        ),
        ("transmission", WARNING, "there is another transmission {!r}", "rename one"),
        ("material", "", "material {!r} is defined twice", alike),
    ):
        tops = subject.elements.tops(tag)
        for it in _repeated((name_of(one), one) for one in tops if name_of(one)):
            yield Problem(it, message.format(name_of(it)), "name", hint, level=level)


def one_node_twice(subject: Subject) -> Iterator[Problem]:
    """Report plugins whose name is that of a node."""
    nodes = [it for it in subject.inventory.claims if it.site.kinds == ("node",)]
    found = (
        ((text_at(it.element, "ros/namespace").strip("/"), it.value.strip()), it.element)
        for it in nodes
        if it.site.path == "@name" and it.element.find("ros") is not None
    )
    for it in _repeated(found):
        message = f"another plugin has the node name {name_of(it)!r}"
        yield Problem(it, message, "name", "rename one, or give them namespaces")


def system_twice(subject: Subject) -> Iterator[Problem]:
    """Report identical systems of a model: both publish on the same topics."""
    systems = [it for it in subject.elements.every("plugin") if "::" in it.get("name", "")]
    if len(systems) < 2:
        return
    found = ((_scope(it), it.get("name"), canonical(it)) for it in systems)
    for it in _repeated(zip(found, systems, strict=True)):
        yield Problem(it, f"{it.get('name')} is loaded twice with the same parameters", "name")


def _scope(plugin: _Element) -> object:
    """Return the model, world or sensor of a plugin; the model for a block without a reference."""
    above = plugin.getparent()
    root = plugin.getroottree().getroot()
    whole = above is not None and above.tag == "gazebo" and not above.get("reference")
    return root if whole else above


def _repeated(found: Iterable[tuple[object, _Element]]) -> Iterator[_Element]:
    """Yield the elements whose key an earlier one has."""
    seen = set()
    for key, element in found:
        if key in seen:
            yield element
        seen.add(key)


# The values of a <gazebo> block of which a link has one each (libsdformat parser_urdf.cc); some have
# two tags, as max_vel and maxVel.
_SINGLE = (
    *("material", "mu1", "mu2", "kp", "kd", "gravity", "dampingFactor", "max_vel", "min_depth"),
    *("max_contacts", "laser_retro", "self_collide", "stop_cfm", "stop_erp", "fudge_factor"),
    *("implicit_spring_damper", "provide_feedback"),
)


def _camel_case(tag: str) -> str:
    first, *others = tag.split("_")
    return first + "".join(map(str.capitalize, others))


SINGLE = {form: it for it in _SINGLE for form in (it, _camel_case(it))}


@rule("MB203", "link-and-joint", WARNING)
def link_and_joint(subject: Subject) -> Iterator[Problem]:
    """Report every reference that is a link and a joint."""
    yield from ambiguous(subject.inventory)


@rule("MB210", "contradicting-blocks", NOTE)
def contradicting_blocks(subject: Subject) -> Iterator[Problem]:
    """Report properties of which a link or joint has only one."""
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
    """Report sensors of Gazebo in a link of a URDF, which sdformat's converter passes over."""
    for it in subject.elements.every("sensor"):
        above = it.getparent()
        link = None if above is None else subject.robot.link.get(above.get("name", ""))
        is_ours = it.find("update_rate") is not None and it.find("parent") is None
        if link and link.element is above and is_ours:
            message = f"sensor {it.get('name')!r} is in <link>, where no simulator looks"
            yield Problem(it, message, None, f"move it into <gazebo reference={link.name!r}>")


def sensors_of_joints(subject: Subject) -> Iterator[Problem]:
    """Report sensors in a joint's block: SDF has only those of forces there (sdformat joint.sdf)."""
    for block_ in subject.elements.tops("gazebo"):
        name = block_.get("reference", "")
        if name in subject.robot.joint and name not in subject.robot.link:
            for it in block_.iterchildren("sensor"):
                if it.get("type") not in ("force_torque", "wrench"):
                    message = f"sensor {it.get('name')!r} is in the block of joint {name!r}"
                    child = subject.robot.joint[name].child
                    yield Problem(it, message, None, f"refer to a link: {child!r}?")


@rule("MB241", "topic-of-two-sensors", WARNING)
def topic_of_two_sensors(subject: Subject) -> Iterator[Problem]:
    """Report topics as they are in the file; the first sensor keeps its own."""
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
    from multibot_rewrite.planning.bridged_topics import DIRECTIONS, plugin_topics

    inventory = subject.inventory
    model = inventory.model or "MODEL"
    senders: dict[str, str] = {}
    for plugin, topics, _ in plugin_topics(inventory, model, model, make_naming("tf-per-robot")):
        own = {f"/{it.gz.lstrip('/')}" for it in topics if it.direction == DIRECTIONS["in"]}
        who = library_key(plugin.get("filename", ""))
        for topic in sorted(own):
            if topic in senders:
                message = f"{who} sends on {topic!r}, and so does {senders[topic]}"
                yield Problem(plugin, message, None, "give one of them a topic of its own")
            senders.setdefault(topic, who)
