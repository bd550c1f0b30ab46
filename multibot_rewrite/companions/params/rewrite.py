"""ROS 2 parameter files and controllers' files for any number of robots.

What stands where is read from ``params.yaml`` (``known_params``); how sections are found and named,
which values are names, what those become and which lines are missing are steps of their own.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.companions.context import Companion, Context
from multibot_rewrite.companions.params.inserted import (
    inserted,
    sources_without_topic,
    without_section,
)
from multibot_rewrite.companions.params.known import Known, built_in_params
from multibot_rewrite.companions.params.sections import (
    Found,
    Section,
    about_sections,
    found_sections,
    identified,
    key_splices,
    known_sections,
)
from multibot_rewrite.companions.params.topics import facts_by_name
from multibot_rewrite.companions.params.uses import Uses, read_uses
from multibot_rewrite.companions.params.values import (
    Desk,
    about_names,
    already,
    respelled,
    unclaimed,
)
from multibot_rewrite.companions.template import GRAPH, SPELLED, Template, cut
from multibot_rewrite.companions.yaml_text import Splice, YamlText
from multibot_rewrite.gc_pause import gc_paused
from multibot_rewrite.model import Finding, InputError
from multibot_rewrite.remap.records import NodeFacts

Page = tuple[Section, Uses]


def params(
    document: YamlText,
    context: Context,
    known: Known | None = None,
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
    with gc_paused():
        _check_holes(document)
        words = frozenset(robots)
        desk = Desk(document, context, known or built_in_params(), facts_by_name(facts), words)
        return _params(desk, beside)


def _params(desk: Desk, beside: Sequence[YamlText]) -> Companion:
    document, context, known = desk.document, desk.context, desk.known
    sections = known_sections(found_sections(document), context, known)
    pages = [(it, read_uses(document, it, known)) for it in sections if not it.shared]
    others = [it for other in beside for it in found_sections(other)]
    made = list(_made(desk, sections, pages, others))
    splices = [it for it in made if isinstance(it, Splice)]
    told = [it for it in made if isinstance(it, Finding)]
    template = cut(document.text, splices)
    pieces = (document.bom + template.pieces[0], *template.pieces[1:])
    return Companion(Template(pieces), _once(told))


def _check_holes(document: YamlText) -> None:
    for hole in (GRAPH, SPELLED):
        if hole in document.text:
            raise InputError(f"{document.file}: the word {hole} is this tool's own; write another")


def _made(
    desk: Desk, sections: Sequence[Section], pages: Sequence[Page], others: Sequence[Found]
) -> Iterator[Splice | Finding]:
    yield from key_splices(desk.document, sections)
    yield from about_sections(desk.document, sections, desk.context)
    yield from already(desk, sections, [uses for _, uses in pages])
    for section, uses in pages:
        yield from respelled(desk, section, uses)
        yield from about_names(desk, section, uses)
        yield from sources_without_topic(desk, section)
    yield from unclaimed(desk, [uses for _, uses in pages])
    yield from inserted(desk, pages, others)


def _once(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """What is the same at many places is told at the first."""
    first: dict[tuple[str, str], Finding] = {}
    for found in sorted(findings, key=lambda it: (it.line, it.column, it.code)):
        first.setdefault((found.code, found.message), found)
    return tuple(_in_words(it) for it in first.values())


def _in_words(found: Finding) -> Finding:
    """A finding is about every robot: no name stands in its holes."""
    message, hint = (
        text.replace(GRAPH, "<robot>").replace(SPELLED, "<robot>")
        for text in (found.message, found.hint)
    )
    return found._replace(message=message, hint=hint)


def without_sections(
    documents: Sequence[YamlText], context: Context, known: Known | None = None
) -> tuple[Finding, ...]:
    """Nodes of the stack that none of a robot's parameter files has a section for, though what they
    take by default is every robot's; told at the first file."""
    known = known or built_in_params()
    if not documents:
        return ()
    sections = [known_sections(found_sections(it), context, known) for it in documents]
    full = [it.full for found in sections for it in found if it.path != "**"]
    nodes = {
        name: node
        for name in context.nodes
        if (node := identified(name.rpartition("/")[2], None, known, {}))
    }
    return _once(without_section(documents[0], full, context, nodes))
