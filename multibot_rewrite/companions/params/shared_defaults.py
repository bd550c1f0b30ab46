# SPDX-License-Identifier: Apache-2.0
"""Parameters that a file does not set, with a default that all robots would share: lines to insert."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import yaml

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.names.by_kind import SPELLERS, expressible
from multibot_rewrite.companions.params.name_sites import SectionNames
from multibot_rewrite.companions.params.sections import ParamSection, RawSection, flattened, is_for
from multibot_rewrite.companions.params.values import NO_PREFIX, ParamsJob, frames_stay
from multibot_rewrite.companions.yaml_blocks import line_start, newline
from multibot_rewrite.companions.yaml_text import Splice, YamlText, found_at, quoted
from multibot_rewrite.knowledge.parameter_entries import PREFIX_KINDS
from multibot_rewrite.knowledge.records import NodeParameters

DEFAULT = "# multibot: the default is every robot's"
OFF = "# multibot: the default puts the namespace before frames"
OWN_FRAME = "# multibot: the robot has this frame in the place of the default"
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
        there = here | bare_frames(section.node) if frames_stay(job, section) else here
        lines = list(missing_defaults(job.context, section.node, there))
        if lines:
            yield inserted(job.document, section.body, lines)


def bare_frames(node: NodeParameters) -> set[str]:
    """The parameters of a node that hold frames, and have a default."""
    return {it.path for it in node.defaults if it.kind == "frame"}


def missing_defaults(
    context: Context, node: NodeParameters, here: set[str]
) -> Iterator[DefaultLine]:
    """The parameters of a node whose default must differ from robot to robot."""
    for param in node.defaults:
        if param.path in here:
            continue
        if param.kind == "off":
            yield DefaultLine(OFF, param.path, "false")
        elif param.kind == "no_prefix":
            yield DefaultLine(OFF, param.path, quoted(NO_PREFIX))
        elif param.kind in _FRAMES and expressible(context, param.kind):
            own = context.frames.get((node.name, param.path), param.default)
            text = SPELLERS[param.kind](context, own)
            if text != param.default:
                yield DefaultLine(
                    DEFAULT if own == param.default else OWN_FRAME, param.path, quoted(text)
                )


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
            or ("*" in full and is_for(full, section.full))
            or (section.wild and is_for(section.full, full))
        ):
            found |= names
    return found


NOT_INSERTED = declare("MF124", "default-not-inserted", WARNING, formats=("params",))


def inserted(
    document: YamlText, body: yaml.MappingNode, lines: Sequence[DefaultLine]
) -> Splice | Finding:
    """The lines before the first parameter, with its indentation."""
    if not body.value:
        text = ", ".join(f"{line.path}: {line.value}" for line in lines)
        at = body.start_mark.index + 1
        return Splice(at, at, text)
    at = body.value[0][0].start_mark.index
    before = document.text[line_start(document, at) : at]
    if body.flow_style:
        text = "".join(f"{line.path}: {line.value}, " for line in lines)
        return Splice(at, at, text)
    if before.strip():
        return not_inserted(document, body, lines)
    end = newline(document) + before
    return Splice(at, at, "".join(f"{text}{end}" for text in _texts(lines)))


def not_inserted(
    document: YamlText, node: yaml.Node, lines: Sequence[DefaultLine], of: str = ""
) -> Finding:
    """That there is no place for lines in a node of a document, ``of`` a ROS node without a section."""
    names = ", ".join(line.path for line in lines)
    whose = f"{of} has no section: " if of else ""
    message = (
        f"{whose}{names}: all robots would share the default, and no line can be inserted here"
    )
    return found_at(document, node, NOT_INSERTED, message, "write each parameter on its own line")


def _texts(lines: Sequence[DefaultLine]) -> Iterator[str]:
    for comment in dict.fromkeys(line.comment for line in lines):
        yield comment
        yield from (f"{it.path}: {it.value}" for it in lines if it.comment == comment)
