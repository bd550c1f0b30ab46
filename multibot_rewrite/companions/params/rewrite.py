"""ROS 2 parameter files and controllers' files for any number of robots.

What stands where is read from ``params.yaml`` (``known_params``); how sections are found and named,
which values are names, what those become and which lines are missing are steps of their own.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.bulk import uncollected
from multibot_rewrite.companions.context import Companion, Context
from multibot_rewrite.companions.names.node_topics import facts_by_name
from multibot_rewrite.companions.params.known_nodes import KnownNodes, built_in_nodes
from multibot_rewrite.companions.params.name_sites import SectionNames, find_names
from multibot_rewrite.companions.params.sections import (
    ParamSection,
    RawSection,
    identify_node,
    identify_sections,
    key_splices,
    raw_sections,
    section_findings,
)
from multibot_rewrite.companions.params.shared_defaults import (
    default_lines,
    sources_without_topic,
    without_section,
)
from multibot_rewrite.companions.params.values import (
    ParamsJob,
    name_findings,
    name_splices,
    robot_in_name,
    unclaimed_names,
)
from multibot_rewrite.companions.template import (
    NAMESPACE_SLOT,
    TAG_SLOT,
    FileTemplate,
    make_template,
)
from multibot_rewrite.companions.yaml_text import Splice, YamlText
from multibot_rewrite.model import Finding, InputError
from multibot_rewrite.remap.records import NodeFacts

Page = tuple[ParamSection, SectionNames]


def rewrite_params(
    document: YamlText,
    context: Context,
    known: KnownNodes | None = None,
    beside: Sequence[YamlText] = (),
    facts: Iterable[NodeFacts] = (),
    robots: Iterable[str] = (),
) -> Companion:
    """A parameter file with holes for a robot, and what a person should know about it.

    ``known`` is what is known of nodes' parameters, ``beside`` the other parameter files that the
    robot's nodes get: what they set is not inserted here. ``facts`` are those of the robot's nodes,
    whose remap rules move topics too. ``robots`` are the words that stand for robots in names: it is
    an error to have one of them in a name. Raises InputError for a file that is none or that rcl
    refuses.
    """
    with uncollected():
        _check_holes(document)
        words = frozenset(robots)
        desk = ParamsJob(document, context, known or built_in_nodes(), facts_by_name(facts), words)
        return _params(desk, beside)


def _params(desk: ParamsJob, beside: Sequence[YamlText]) -> Companion:
    document, context, known = desk.document, desk.context, desk.known
    sections = identify_sections(raw_sections(document), context, known)
    pages = [(it, find_names(document, it, known)) for it in sections if not it.shared]
    others = [it for other in beside for it in raw_sections(other)]
    made = list(_made(desk, sections, pages, others))
    splices = [it for it in made if isinstance(it, Splice)]
    told = [it for it in made if isinstance(it, Finding)]
    template = make_template(document.text, splices)
    pieces = (document.bom + template.pieces[0], *template.pieces[1:])
    return Companion(FileTemplate(pieces), _once(told))


def _check_holes(document: YamlText) -> None:
    for hole in (NAMESPACE_SLOT, TAG_SLOT):
        if hole in document.text:
            raise InputError(f"{document.file}: the word {hole} is this tool's own; write another")


def _made(
    desk: ParamsJob,
    sections: Sequence[ParamSection],
    pages: Sequence[Page],
    others: Sequence[RawSection],
) -> Iterator[Splice | Finding]:
    yield from key_splices(desk.document, sections)
    yield from section_findings(desk.document, sections, desk.context)
    yield from robot_in_name(desk, sections, [uses for _, uses in pages])
    for section, uses in pages:
        yield from name_splices(desk, section, uses)
        yield from name_findings(desk, section, uses)
        yield from sources_without_topic(desk, section)
    yield from unclaimed_names(desk, [uses for _, uses in pages])
    yield from default_lines(desk, pages, others)


def _once(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """What is the same at many places is told at the first."""
    first: dict[tuple[str, str], Finding] = {}
    for found in sorted(findings, key=lambda it: (it.line, it.column, it.code)):
        first.setdefault((found.code, found.message), found)
    return tuple(_in_words(it) for it in first.values())


def _in_words(found: Finding) -> Finding:
    """A finding is about every robot: no name stands in its holes."""
    message, hint = (
        text.replace(NAMESPACE_SLOT, "<robot>").replace(TAG_SLOT, "<robot>")
        for text in (found.message, found.hint)
    )
    return found._replace(message=message, hint=hint)


def without_sections(
    documents: Sequence[YamlText], context: Context, known: KnownNodes | None = None
) -> tuple[Finding, ...]:
    """Nodes of the stack that none of a robot's parameter files has a section for, though what they
    take by default is every robot's; told at the first file."""
    known = known or built_in_nodes()
    if not documents:
        return ()
    sections = [identify_sections(raw_sections(it), context, known) for it in documents]
    full = [it.full for found in sections for it in found if it.path != "**"]
    nodes = {
        name: node
        for name in context.nodes
        if (node := identify_node(name.rpartition("/")[2], None, known, {}))
    }
    return _once(without_section(documents[0], full, context, nodes))
