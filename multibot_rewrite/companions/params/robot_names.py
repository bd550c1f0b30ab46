"""Sections of files that were written for a certain robot."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.params.sections import ANY, ParamSection
from multibot_rewrite.companions.yaml_text import YamlText, found_at

ONE_ROBOT = declare(
    "MF104",
    "section-of-one-robot",
    ERROR,
    what="The name of a section has a namespace before a node of the stack or before a wildcard.",
    why="The build puts each robot's namespace before it, so /rover/amcl becomes /robot1/rover/amcl. "
    "No node has that name, and a node without a section runs with its defaults and does not say so.",
    fix="Write the node's name without a namespace.",
    bad="""\
/rover/**:
  ros__parameters:
    use_sim_time: true
""",
    good="""\
/**:
  ros__parameters:
    use_sim_time: true
""",
    formats=("params",),
)

NAMESPACE_KEPT = declare(
    "MF105",
    "section-with-namespace",
    WARNING,
    what="The name of a section has a namespace, which is placed below each robot's.",
    why="That is right for a namespace inside of a robot, such as front/driver. If it is the name of a "
    "robot, no node has the resulting name, and the parameters have no effect.",
    fix="If the namespace is the name of a robot, remove it.",
    bad="""\
rover/driver:
  ros__parameters:
    rate: 10
""",
    good="""\
driver:
  ros__parameters:
    rate: 10
""",
    formats=("params",),
)


def namespace_findings(
    document: YamlText, section: ParamSection, context: Context
) -> Iterator[Finding]:
    """A namespace in the section's name: that of one robot, or one below each robot's."""
    tokens = section.path.split("/")
    key = section.keys[0]
    if section.path in context.nodes or tokens[0] == "**" or section.full == section.path:
        return
    if section.path != "/".join(it.value.strip("/") for it in section.keys):
        return  # what is below the robot's own namespace is meant to be there
    tails = ["/".join(tokens[at:]) for at in range(1, len(tokens))]
    stack = next((tail for tail in tails if tail in context.nodes), "")
    if stack or (tokens[-1] in ANY and tokens[0] not in ANY):
        message = f"section {section.path} is for one robot only: its name includes a namespace"
        hint = f"write {stack or '/**'}: instead; the build adds each robot's namespace"
        yield found_at(document, key, ONE_ROBOT, message, hint)
    elif tails and not section.wild and not tokens[-1].startswith(tokens[0]):
        message = (
            f"section {section.path} has a namespace; it is placed below each robot's namespace"
        )
        hint = f"if {tokens[0]} is the name of a robot, write {tails[0]}: instead"
        yield found_at(document, key, NAMESPACE_KEPT, message, hint)
