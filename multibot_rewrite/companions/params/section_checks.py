"""Sections of nodes that serve all robots."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.companions.params.sections import ParamSection
from multibot_rewrite.companions.yaml_text import YamlText, found_at

SHARED_NODE = declare(
    "MF103",
    "section-of-shared-node",
    WARNING,
    what="A section is for a node that serves all robots, so it stays as it is.",
    why="The file of every robot has this section. If the node is started with each of them, several "
    "nodes of one name publish the same topics.",
    fix="Start the node once, with one of the files, or move its section to a file of its own.",
    bad="""\
map_server:
  ros__parameters:
    yaml_filename: hall.yaml
""",
    good="""\
amcl:
  ros__parameters:
    alpha1: 0.1
""",
    formats=("params",),
    beside={"nodes.yaml": "stacks: {own: {nodes: [amcl, {node: map_server, shared: true}]}}"},
    options={"stack": "own", "nodes": "nodes.yaml"},
)


def shared_findings(document: YamlText, sections: Sequence[ParamSection]) -> Iterator[Finding]:
    """Each node that serves all robots, at its first section."""
    first = {it.path: it for it in reversed(sections) if it.shared}
    for path, section in first.items():
        message = f"{path} serves all robots, so its section stays as it is"
        hint = "start it once, with this file"
        yield found_at(document, section.keys[-1], SHARED_NODE, message, hint)
