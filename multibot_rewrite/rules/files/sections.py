# SPDX-License-Identifier: Apache-2.0
"""Sections of a parameter file that robots cannot have each for itself."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.naming import NAMESPACE
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.kinds import PARAMS
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.params.sections import ANY, ParamSection, flattened, scalars
from multibot_rewrite.knowledge.parameters import is_absolute
from multibot_rewrite.rules.declaration import TWO, robots_rule
from multibot_rewrite.rules.places import remark_at


@robots_rule("MB883", "section-of-one-robot", ERROR, PARAMS)
def section_of_one_robot(file: NamedFile) -> Iterator[Finding]:
    """A namespace in a section's name: that of one robot, or one below each robot's."""
    for section, _ in file.pages:
        if not section.shared:
            yield from _namespace(section, file.context)


def _namespace(section: ParamSection, context: Context) -> Iterator[Finding]:
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
        yield remark_at(key, message, hint)
    elif tails and not section.wild and not tokens[-1].startswith(tokens[0]):
        message = (
            f"section {section.path} has a namespace; it is placed below each robot's namespace"
        )
        hint = f"if {tokens[0]} is the name of a robot, write {tails[0]}: instead"
        yield remark_at(key, message, hint, WARNING)


@rule(
    "MB886",
    "section-of-shared-node",
    WARNING,
    formats=(PARAMS,),
    options={"build": True, "stack": "own", "nodes": "nodes.yaml"},
)
def shared_section(file: NamedFile) -> Iterator[Finding]:
    """Each node that serves all robots, at its first section."""
    shared = (it for it, _ in reversed(file.pages) if it.shared and file.is_certain)
    first = {it.path: it for it in shared}
    for path, section in first.items():
        message = f"{path} serves all robots, so its section stays as it is"
        yield remark_at(section.keys[-1], message, "start it once, with this file")


@robots_rule(
    "MB885",
    "costmap-source-without-topic",
    WARNING,
    PARAMS,
    options={"robots": TWO, "distro": "jazzy"},
)
def source_without_topic(file: NamedFile) -> Iterator[Finding]:
    """Observation sources of a costmap layer without a topic: their id is the topic."""
    for section, _ in file.pages:
        if not section.shared and _resolves_below(section, file.context):
            yield from _without_topic(section)


def _resolves_below(section: ParamSection, context: Context) -> bool:
    """Is the id of a source another name than that of the robot's topic?"""
    param = section.node.params.get("<id>.<id>.topic") if section.node else None
    namespaced = context.topics.naming.topics == NAMESPACE
    return param is not None and (not namespaced or is_absolute(param, context.distro))


def _without_topic(section: ParamSection) -> Iterator[Finding]:
    names = dict(flattened(section.body))
    values = {id(key): str(value.value) for key, value in scalars(section.body)}
    for name, key in names.items():
        layer, _, last = name.rpartition(".")
        if last != "observation_sources" or not layer:
            continue
        for source in values.get(id(key), "").split():
            if f"{layer}.{source}.topic" not in names:
                message = f"source {source} of {layer} has no topic, so it subscribes to {source!r}"
                hint = f"add {layer}.{source}.topic: /{source}; it is renamed for each robot"
                yield remark_at(key, message, hint)
