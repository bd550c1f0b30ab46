"""MoveIt's YAML files for any number of robots: the new text of their names.

MoveItConfigsBuilder reads them with PyYAML and passes them to move_group as parameters. So there are
no sections of nodes, anchors are legal, and of a repeated key the last value counts.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

import yaml

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import NAMESPACE
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.companion import Companion
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.moveit.checks import GRAPH_WORDS, file_findings
from multibot_rewrite.companions.moveit.controller_manager import inserted_namespace
from multibot_rewrite.companions.moveit.file_kind import find_kind
from multibot_rewrite.companions.moveit.name_sites import MoveitName, find_names
from multibot_rewrite.companions.moveit.read import named
from multibot_rewrite.companions.names.by_kind import SPELLERS, is_plain
from multibot_rewrite.companions.names.by_kind import node as node_name
from multibot_rewrite.companions.names.node_topics import (
    FROM_NODE,
    Facts,
    facts_by_name,
    spell_topic,
)
from multibot_rewrite.companions.names.rename_map import spell
from multibot_rewrite.companions.template import TAG_SLOT, check_no_slots, make_template
from multibot_rewrite.companions.yaml_text import Splice, YamlText, line_of, quoted
from multibot_rewrite.knowledge.records import NodeFacts

# The nodes that read these files, as the stacks call them.
MOVE_GROUP, SERVO = "move_group", "servo_node"
# An anchor or a tag before the value.
_MARKS = re.compile(r"(?:[&!][^\s,\[\]{}]*\s+)*")


class _MoveitJob(NamedTuple):
    """One file to rewrite, and all that its steps need; ``node`` is the node that reads it."""

    document: YamlText
    context: Context
    node: str
    facts: Facts


def rewrite_moveit(
    document: YamlText, context: Context, facts: Iterable[NodeFacts] = ()
) -> Companion:
    """A MoveIt file with slots for a robot, and the findings about it.

    Groups of an SRDF are known if they are declared (``with_srdf``); ``facts`` are those of the robot's
    nodes, whose remap rules move topics too. Raises InputError for a file that is not MoveIt's, and
    for an alias whose value would need two new names.
    """
    try:
        return _moveit(document, context, facts_by_name(facts, context.distro))
    except RecursionError:
        raise InputError(
            f"{document.file}:1: the YAML is nested too deeply for a MoveIt file"
        ) from None


def _moveit(document: YamlText, context: Context, facts: Facts) -> Companion:
    check_no_slots(document.text, document.file)
    kind = find_kind(document)
    sites = find_names(document.root, kind.names if kind else {}, context.names)
    file = named(document, context, sites)
    node = SERVO if kind and kind.name == "servo" else MOVE_GROUP
    job = _MoveitJob(document, context, node, facts)
    splices = [*_spliced(job, sites.names), *inserted_namespace(document, context)]
    shift = [Splice(0, 0, document.bom)] if document.bom else []
    template = make_template(document.text, [*shift, *splices])
    return Companion(template, file_findings(document, context, sites), file)


def _spliced(job: _MoveitJob, sites: Iterable[MoveitName]) -> Iterator[Splice]:
    """One splice for each scalar; a key may hold several names, an alias may reach one twice."""
    texts: dict[int, dict[int, tuple[MoveitName, str]]] = {}
    for site in sites:
        new = _new_text(job, site.word, site.text)
        _, other = texts.setdefault(id(site.scalar), {}).setdefault(site.at, (site, new))
        if other != new:
            place = f"{job.document.file}:{line_of(site.scalar)}"
            raise InputError(
                f"{place}: an alias uses {site.text!r} as two kinds of name, {other!r} and {new!r};"
                " write the value out in both places".replace(TAG_SLOT, "ROBOT")
            )
    for parts in texts.values():
        scalar, value = next(iter(parts.values()))[0].scalar, ""
        value = str(scalar.value)
        for at, (site, new) in sorted(parts.items(), reverse=True):
            value = value[:at] + new + value[at + len(site.text) :]
        if value != scalar.value:
            yield _replaced(job.document, scalar, value)


def _replaced(document: YamlText, scalar: yaml.ScalarNode, new: str) -> Splice:
    """The splice for a scalar's value; its anchor and tag stay."""
    start, end = scalar.start_mark.index, scalar.end_mark.index
    if scalar.style in ("|", ">"):
        place = f"{document.file}:{line_of(scalar)}"
        raise InputError(
            f"{place}: a name is written as a block of text; write it on the line of its key"
        )
    marks = _MARKS.match(document.text, start, end)
    return Splice(marks.end() if marks else start, end, quoted(new, scalar.style or ""))


def _new_text(job: _MoveitJob, word: str, value: str) -> str:
    if word == "id":
        return value
    if word in GRAPH_WORDS:
        return spell_topic(job.context, job.node, word, value, FROM_NODE, job.facts).text
    if word == "controller_topic":
        return _controller_topic(job, value)
    if word == "controller":
        return node_name(job.context, value) if is_plain(value) else value
    return SPELLERS[word](job.context, value)


def _controller_topic(job: _MoveitJob, value: str) -> str:
    """``/arm_controller/joint_trajectory``: a topic below a node is renamed with the node."""
    head, slash, rest = value.rpartition("/")
    if not is_plain(value) or not head or value.startswith("~"):
        return spell_topic(job.context, job.node, "topic", value, FROM_NODE, job.facts).text
    if job.context.topics.naming.topics == NAMESPACE:
        return spell(job.context.topics, "topic", value)
    return node_name(job.context, head) + slash + rest
