"""The ROS nodes in a rewritten description, as the second reading has them: facts and tables."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.description.readback.nodes import ReadNode
from multibot_rewrite.description.readback.reading import Reading
from multibot_rewrite.knowledge.records import Endpoint, FrameParameter, NodeFacts, SentTransform
from multibot_rewrite.spelling.records import Home, NodeRule, NodeTable


def plugin_nodes(reading: Reading, robot: str) -> Iterator[tuple[NodeFacts, NodeTable]]:
    """Each ROS 2 plugin of ``robot``'s rewritten description: its endpoints, its names and rules."""
    for node in reading.nodes:
        rules = tuple(_rules(node, robot))
        section = node.section
        home = Home("", "", section.names[0], written=True, process_wide=section.process_wide)
        yield _facts(node), NodeTable(robot, node.name, node.namespace, node.name, rules, home)


def _facts(node: ReadNode) -> NodeFacts:
    endpoints = (
        Endpoint(it.kind, it.role, it.name, it.type, parameter=it.parameter, when=it.off)
        for it in node.endpoints
    )
    frames = tuple(FrameParameter(*frame) for frame in node.frames)
    package = node.section.names[0]
    sends = tuple(SentTransform(*it) for it in node.sends)
    return NodeFacts(node.name, package, tuple(endpoints), frames=frames, sends=sends)


def _rules(node: ReadNode, robot: str) -> Iterator[NodeRule]:
    for rule, line, _ in node.rules:
        why = f"in the description, line {line}"
        lead = f"{rule.node}:" if rule.node else ""
        yield NodeRule(robot, node.name, f"{lead}{rule.source}", rule.target, "", why)
