# SPDX-License-Identifier: Apache-2.0
"""Parameters that a file does not set, with a default that all robots would share: lines to insert."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence

import yaml

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.names.by_kind import SPELLERS, expressible
from multibot_rewrite.companions.params.name_sites import SectionNames
from multibot_rewrite.companions.params.sections import (
    ParamSection,
    RawSection,
    flattened,
    pattern_of,
)
from multibot_rewrite.companions.params.values import NO_PREFIX, ParamsJob, frames_stay
from multibot_rewrite.companions.template import NAMESPACE_SLOT
from multibot_rewrite.companions.yaml_blocks import newline
from multibot_rewrite.companions.yaml_text import Splice, YamlText, found_at, quoted
from multibot_rewrite.knowledge.parameter_entries import PREFIX_KINDS
from multibot_rewrite.knowledge.parameters import KnownNode

DEFAULT = "# multibot: the default is every robot's"
OFF = "# multibot: the default puts the namespace before frames"
_FRAMES = ("frame", "link", "stem", "interface", *PREFIX_KINDS)


class DefaultLine(NamedTuple):
    """A parameter to insert: its comment, path and value as YAML."""

    comment: str
    path: str
    value: str


def default_lines(
    job: ParamsJob,
    pages: Sequence[tuple[ParamSection, SectionNames]],
    beside: Sequence[RawSection],
) -> Iterator[Splice | Finding]:
    """Lines for the first section of each known node, without those that ``beside`` sets."""
    everywhere = _set_anywhere(pages, beside)
    done: set[str] = set()
    for section, _ in pages:
        if section.node is None or section.shared or section.inner or section.full in done:
            continue
        done.add(section.full)
        same = [names.known for other, names in pages if other.full == section.full]
        here = set().union(*same) | _set_for(section, everywhere)
        bare = {it.path for it in section.node.defaults if it.kind == "frame"}
        there = here | bare if frames_stay(job, section) else here
        lines = list(missing_defaults(job.context, section.node, there))
        if lines:
            yield inserted(job.document, section.body, lines)


def missing_defaults(context: Context, node: KnownNode, here: set[str]) -> Iterator[DefaultLine]:
    """The parameters of a node whose default must differ from robot to robot."""
    for param in node.defaults:
        if param.path in here:
            continue
        if param.kind == "off":
            yield DefaultLine(OFF, param.path, "false")
        elif param.kind == "no_prefix":
            yield DefaultLine(OFF, param.path, quoted(NO_PREFIX))
        elif param.kind in _FRAMES and expressible(context, param.kind):
            text = SPELLERS[param.kind](context, param.default)
            if text != param.default:
                yield DefaultLine(DEFAULT, param.path, quoted(text))


def _set_anywhere(
    pages: Sequence[tuple[ParamSection, SectionNames]], beside: Sequence[RawSection]
) -> list[tuple[str, set[str]]]:
    """What is set for which nodes, if patterns or other files set more than the section itself."""
    if not beside and not any(it.wild for it, _ in pages):
        return []
    bodies = [(it.full, it.body) for it, _ in pages]
    bodies += [(f"/{it.path}", it.body) for it in beside]
    return [(full, {name for name, _ in flattened(body)}) for full, body in bodies]


def _set_for(section: ParamSection, everywhere: Iterable[tuple[str, set[str]]]) -> set[str]:
    """What is set by any section that is, or may be, for the same node."""
    found: set[str] = set()
    for full, names in everywhere:
        if (
            f"/{section.path}" == full
            or _matches(full, section.full)
            or _matches(section.full, full)
        ):
            found |= names
    return found


def _matches(pattern: str, full: str) -> bool:
    return "*" in pattern and re.fullmatch(pattern_of(pattern), full) is not None


NOT_INSERTED = declare(
    "MF124",
    "default-not-inserted",
    WARNING,
    what="All robots would share the default of a parameter, and the section has no place for a line "
    "that sets it.",
    why="The default has no robot's name in it: the node looks for base_link, but the robot's frame is "
    "robot1/base_link.",
    fix="Write each parameter on its own line, as in name: value.",
    bad="""\
smoother_server:
  ros__parameters:
    ? smoother_plugins
    : [simple_smoother]
""",
    good="""\
smoother_server:
  ros__parameters:
    smoother_plugins: [simple_smoother]
""",
    line=3,
    formats=("params",),
)


def inserted(
    document: YamlText, body: yaml.MappingNode, lines: Sequence[DefaultLine]
) -> Splice | Finding:
    """The lines before the first parameter, with its indentation."""
    if not body.value:
        text = ", ".join(f"{line.path}: {line.value}" for line in lines)
        at = body.start_mark.index + 1
        return Splice(at, at, text)
    at = body.value[0][0].start_mark.index
    before = document.text[document.text.rfind("\n", 0, at) + 1 : at]
    if body.flow_style:
        text = "".join(f"{line.path}: {line.value}, " for line in lines)
        return Splice(at, at, text)
    if before.strip():
        names = ", ".join(line.path for line in lines)
        message = f"{names}: all robots would share the default, and no line can be inserted here"
        hint = "write each parameter on its own line"
        return found_at(document, body, NOT_INSERTED, message, hint)
    end = newline(document) + before
    return Splice(at, at, "".join(f"{text}{end}" for text in _texts(lines)))


def _texts(lines: Sequence[DefaultLine]) -> Iterator[str]:
    for comment in dict.fromkeys(line.comment for line in lines):
        yield comment
        yield from (f"{it.path}: {it.value}" for it in lines if it.comment == comment)


NO_SECTION = declare(
    "MF125",
    "node-without-section",
    WARNING,
    what="A node of the stack has no section in any parameter file of the robot, so all robots would "
    "share its defaults.",
    why="Defaults have no robot's name in them: amcl looks for base_footprint, but the robot's frame "
    "is robot1/base_footprint. Without a section there is no place to insert the parameters.",
    fix="Add a section for the node; use_sim_time is enough in it.",
    bad="""\
map_server:
  ros__parameters:
    use_sim_time: true
""",
    good="""\
amcl:
  ros__parameters:
    use_sim_time: true
""",
    formats=("params",),
    beside={"nodes.yaml": "stacks: {own: {nodes: [amcl]}}"},
    options={"stack": "own", "nodes": "nodes.yaml"},
)


def without_section(
    document: YamlText, sections: Iterable[str], context: Context, nodes: Mapping[str, KnownNode]
) -> Iterator[Finding]:
    """Nodes of the stack without a section, whose defaults all robots would share.

    ``nodes`` are the known ones by the stack's name, ``sections`` the full names that have one.
    """
    patterns = [re.compile(pattern_of(full)) for full in sections]
    for name, node in nodes.items():
        place = context.nodes[name]
        if NAMESPACE_SLOT not in place or any(it.fullmatch(place) for it in patterns):
            continue
        lines = list(missing_defaults(context, node, set()))
        if lines:
            words = ", ".join(it.path for it in lines)
            message = f"{name} has no section, so all robots would share its defaults for {words}"
            hint = "add a section for it (use_sim_time is enough); the lines are inserted there"
            yield NO_SECTION.finding(message, hint, file=document.file, line=1)
