"""The ROS nodes in a rewritten description, as the second reading has them: facts and tables."""

from __future__ import annotations

from collections.abc import Iterator

<<<<<<< HEAD
from multibot_rewrite.readback.nodes import ReadNode
from multibot_rewrite.readback.reading import Reading
from multibot_rewrite.remap.records import Endpoint, FrameParameter, NodeFacts, NodeRule, NodeTable
=======
from lxml import etree

from multibot_rewrite.findings.place import locate
from multibot_rewrite.model import Claim, Site
from multibot_rewrite.naming import TOPIC_KINDS
from multibot_rewrite.remap.records import (
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Endpoint,
    FrameParameter,
    NodeFacts,
    NodeRule,
    NodeTable,
)
from multibot_rewrite.rewriters.switches import switched_off, switches
from multibot_rewrite.rewriters.text import text_at, text_of
from multibot_rewrite.rewriters.vocabulary import VocabularySection
from multibot_rewrite.rosnames import parse_remap
from multibot_rewrite.steps.collect import Host, Inventory

ROS_NODE = "ros/remapping"
>>>>>>> main


def plugin_nodes(reading: Reading, robot: str) -> Iterator[tuple[NodeFacts, NodeTable]]:
    """Each ROS 2 plugin of ``robot``'s rewritten description: its endpoints, its names and rules."""
    for node in reading.nodes:
        rules = tuple(_rules(node, robot))
        yield _facts(node), NodeTable(robot, node.name, node.namespace, node.name, rules)


<<<<<<< HEAD
def _facts(node: ReadNode) -> NodeFacts:
    endpoints = (
        Endpoint(it.kind, it.role, it.name, parameter=it.parameter, when=it.off)
        for it in node.endpoints
=======
def plugin_places(inventory: Inventory) -> list[str]:
    """The places (``file:line``) of the plugins of ``plugin_nodes``, in its order.

    A rewrite keeps the order of elements, so those of the source are those of its results.
    """
    document = inventory.document
    lines = (locate(document.source, host.start)[0] for host, _ in _ros_nodes(inventory))
    return [f"{document.file}:{line}" for line in lines]


def _ros_nodes(inventory: Inventory) -> Iterator[tuple[Host, VocabularySection]]:
    for host in inventory.hosts:
        section = host.node.section
        if section is not None and any(site.path == ROS_NODE for site in section.sites):
            yield host, section


def _node_name(plugin: etree._Element, section: VocabularySection) -> str:
    """A Gazebo Classic plugin's own name, or that of the controller manager it loads."""
    sites = [site for site in section.sites if site.kinds[:1] == ("node",) and site.default]
    if any(site.path == "@name" for site in section.sites if site.role == "declares"):
        return plugin.get("name", "").strip()
    named = (text_at(plugin, site.path) or site.default for site in sites)
    return next(named, "") or section.names[0].replace("-", "_")


def _endpoints(inventory: Inventory, host: Host) -> Iterator[Endpoint]:
    """Names in the plugin's code, and names that its parameters set."""
    section = host.node.section
    assert section is not None
    wired = (
        (PUBLISHES, TOPIC, section.publishes),
        (SUBSCRIBES, TOPIC, section.subscribes),
        (SERVES, SERVICE, section.serves),
>>>>>>> main
    )
    frames = tuple(FrameParameter(*frame) for frame in node.frames)
    package = node.section.names[0]
    return NodeFacts(node.name, package, tuple(endpoints), frames=frames, sends=node.sends)


<<<<<<< HEAD
def _rules(node: ReadNode, robot: str) -> Iterator[NodeRule]:
    for rule, line in node.rules:
        why = f"in the description, line {line}"
        yield NodeRule(robot, node.name, rule.source, rule.target, "", why)
=======
def _frames(inventory: Inventory, host: Host) -> Iterator[FrameParameter]:
    """The frames in its parameters, as in the description, or their defaults."""
    given = {
        claim.site.path: claim.value
        for claim in inventory.claims
        if _is_frame(claim.site) and host.element in claim.element.iterancestors()
    }
    assert host.node.section is not None
    for site in filter(_is_frame, host.node.section.sites):
        value = given.get(site.path, site.default)
        if value:
            yield FrameParameter(site.path, value)


def _is_frame(site: Site) -> bool:
    return site.form == "whole" and site.kinds[:1] == ("frame",)


def _odometry_is_off(host: Host, section: VocabularySection) -> bool:
    """Is odometry off? The first switch of tf is for odometry, others are for wheels."""
    found = [it for it in switches(host.element, section) if it.topic == "/tf"]
    return bool(found) and not found[0].on


def _sends(
    section: VocabularySection, frames: tuple[FrameParameter, ...], links: Container[str], off: bool
) -> Iterator[tuple[str, str]]:
    """The transform of a plugin that publishes tf: from its odometry frame to a link."""
    own = [frame.parameter for frame in frames if frame.default not in links]
    base = [frame.parameter for frame in frames if frame.default in links]
    if "/tf" in section.publishes and own and base and not off:
        yield own[0], base[0]


def _sets_topic(claim: Claim) -> bool:
    site = claim.site
    return site.form == "whole" and site.kinds[0] in TOPIC_KINDS and "qos" not in site.path


def _rules(host: Host, robot: str, node: str) -> Iterator[NodeRule]:
    for element in (host.element.find("ros"), host.element):
        for remapping in element.iterchildren("remapping") if element is not None else ():
            rule = parse_remap(text_of(remapping))
            if rule is not None:
                why = f"in the description, line {remapping.sourceline}"
                yield NodeRule(robot, node, rule.source, rule.target, "", why)


def _ros_text(element: etree._Element, tag: str) -> str:
    ros = element.find("ros")
    return text_at(element if ros is None else ros, tag)
>>>>>>> main
