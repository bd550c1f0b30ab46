# SPDX-License-Identifier: Apache-2.0
"""ROS 2 parameter files and controllers' files for any number of robots.

``knowledge.parameters`` knows which parameters hold names. One step each: ``sections`` finds
and renames sections, ``name_sites`` finds names, ``values`` renames them, ``shared_defaults`` inserts
what is missing. They tell what only a rewrite knows; ``rules.files`` asks all else.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Sequence

import yaml

from multibot_rewrite.base.findings.finding import ERROR, Finding, declare
from multibot_rewrite.base.gc_pause import gc_paused
from multibot_rewrite.companions.context import (
    NAMESPACE_SLOT,
    TAG_SLOT,
    Context,
    FileTemplate,
    check_no_slots,
    make_template,
)
from multibot_rewrite.companions.named_file import PARAMS, Companion, NamedFile
from multibot_rewrite.companions.names.node_topics import facts_by_name
from multibot_rewrite.companions.names.placeholders import without_robot
from multibot_rewrite.companions.params.name_sites import NO_NAMES, Page, SectionNames, find_names
from multibot_rewrite.companions.params.sections import (
    ParamSection,
    RawSection,
    identify_sections,
    raw_sections,
    without_own,
)
from multibot_rewrite.companions.params.shared_defaults import default_lines, lacking_sections
from multibot_rewrite.companions.params.values import ParamsJob, clock_splices, name_splices
from multibot_rewrite.companions.sites import SECTION, Site, site_at
from multibot_rewrite.companions.yaml_text import Splice, YamlText, found_at, replaced
from multibot_rewrite.knowledge.parameters import KnownNodes, built_in_nodes
from multibot_rewrite.knowledge.records import NodeFacts


def rewrite_params(
    document: YamlText,
    context: Context,
    known: KnownNodes | None = None,
    beside: Sequence[YamlText] = (),
    facts: Iterable[NodeFacts] = (),
    own: Iterable[str] = (),
    at_run_time: Iterable[str] = (),
    clock: bool | None = None,
    is_first: bool = False,
) -> Companion:
    """A parameter file with slots for a robot, and the findings about it.

    ``known`` are the known nodes, ``beside`` the other parameter files that the robot's nodes get:
    what they set is not inserted here. ``facts`` are those of the robot's nodes, whose remap rules
    move topics too.
    A file for one robot may have its sections below one of ``own``. ``at_run_time`` are the nodes that
    put the robot's name before their frames themselves. ``clock`` is the ``use_sim_time`` of all its
    nodes, None if they keep their own. The robot's first file gets sections of nodes of the stack that
    no file has one for. Raises InputError for a file that
    is not a parameter file or that rcl rejects.
    """
    with gc_paused():
        check_no_slots(document.text, document.file)
        job = ParamsJob(
            document,
            context,
            known or built_in_nodes(context.distro),
            facts_by_name(facts, context.distro),
            tuple(own),
            frozenset(at_run_time),
            clock,
        )
        return _params(job, beside, is_first)


def rewrite_values(job: ParamsJob) -> Companion:
    """Parameters of one node with slots for a robot: nothing is inserted, and no other file is asked.

    Raises InputError as ``rewrite_params``.
    """
    with gc_paused():
        check_no_slots(job.document.text, job.document.file)
        file = read_params(job.document, job.context, job.known)
        job = job._replace(known=job.known._replace(sent=file.sent))
        pages = (it for it in file.pages if not it[0].shared)
        made = [one for it in pages for one in name_splices(job, *it)]
        splices = [it for it in made if isinstance(it, Splice)]
        findings = [it for it in made if isinstance(it, Finding)]
        return Companion(make_template(job.document.text, splices), file, _once(findings))


def _params(job: ParamsJob, beside: Sequence[YamlText], is_first: bool) -> Companion:
    document, context = job.document, job.context
    file = read_params(document, context, job.known, job.own)
    job = job._replace(known=job.known._replace(sent=file.sent))
    found = [RawSection(*section[:3]) for section, _ in file.pages]
    others = [it for other in beside for it in without_own(raw_sections(other), job.own)]
    made = [*_made(job, file.pages, others), *lacking_sections(job, found, others, is_first)]
    splices = [it for it in made if isinstance(it, Splice)]
    findings = [it for it in made if isinstance(it, Finding)]
    template = make_template(document.text, splices)
    pieces = (document.bom + template.pieces[0], *template.pieces[1:])
    return Companion(FileTemplate(pieces), file, _once(findings))


def _made(
    job: ParamsJob, every: Sequence[Page], others: Sequence[RawSection]
) -> Iterator[Splice | Finding]:
    sections = [section for section, _ in every]
    pages = [it for it in every if not it[0].shared]
    yield from key_splices(job.document, sections)
    for section in sections:
        yield from clock_splices(job, section)
    for section, names in pages:
        yield from name_splices(job, section, names)
    yield from default_lines(job, pages, others)


def _once(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """What is the same at many places is reported at the first."""
    first: dict[tuple[str, str], Finding] = {}
    for found in sorted(findings, key=lambda it: (it.line, it.column, it.code)):
        first.setdefault((found.code, found.message), found)
    return tuple(_in_words(it) for it in first.values())


def _in_words(found: Finding) -> Finding:
    """A finding is about every robot: its slots read ``<robot>``."""
    message, hint = (
        text.replace(NAMESPACE_SLOT, "<robot>").replace(TAG_SLOT, "<robot>")
        for text in (found.message, found.hint)
    )
    return found._replace(message=message, hint=hint)


def read_params(
    document: YamlText, context: Context, known: KnownNodes, own: Collection[str] = ()
) -> NamedFile:
    """The names of a file; ``own`` are words for the one robot that it is for. Raises InputError for a
    file that is not a parameter file or that rcl rejects."""
    found = without_own(raw_sections(document), own)
    sections = identify_sections(found, context, known)
    pages = tuple(
        (it, NO_NAMES if it.shared else find_names(document, it, known, context.distro))
        for it in sections
    )
    names = (
        *(site for it in sections for site in _keys(it, own)),
        *(it for _, names in pages for it in names.sites),
    )
    return NamedFile(
        PARAMS,
        document.file,
        document.text,
        context,
        {},
        names,
        tuple(it for _, page in pages for it in _others(page)),
        tuple(site_at(key, "", str(key.value)) for _, page in pages for key in page.twice),
        document,
        pages,
        known,
        sent=known.sent | _own_frames(pages),
        is_for_one=bool(own),
    )


def _own_frames(pages: Iterable[Page]) -> frozenset[str]:
    """The frames that nodes of the file make themselves: no description has them."""
    sites = (site for _, names in pages for site in names.sites)
    return frozenset(it.text.lstrip("/") for it in sites if it.own)


def _keys(section: ParamSection, own: Collection[str]) -> Iterator[Site]:
    """The keys above a section, without what its path has not: the robot that the file is for. A
    namespace that is the root's or the robot's alone is no name of a node."""
    first, *rest = section.keys
    name = _without(first.value, own)
    if not rest or not first.value or name not in ("", "/"):
        yield site_at(first, SECTION, without_robot(name or first.value))
    yield from (site_at(it, SECTION, without_robot(it.value), in_key=True) for it in rest)


def _without(key: str, own: Collection[str]) -> str:
    bare = key.strip("/")
    words = (it for it in own if f"{bare}/".startswith(f"{it}/"))
    return next((bare.removeprefix(it).strip("/") for it in words), key)


def _others(names: SectionNames) -> Iterator[Site]:
    yield from (site_at(it, "", str(it.value)) for it in names.unclaimed)
    yield from (site_at(it, "", str(it.value), in_key=True) for it in names.keys)


_PATTERN = re.compile(r"/[A-Za-z0-9_/*]+")

MIXED_KEY = declare("MF101", "mixed-section-key", ERROR, formats=("params",))


def key_splices(document: YamlText, sections: Sequence[ParamSection]) -> list[Splice | Finding]:
    """The new keys above the sections."""
    new: dict[int, tuple[yaml.ScalarNode, str]] = {}
    made: list[Splice | Finding] = []
    for section in sections:
        kept = section.shared or section.full == section.path
        texts = [key.value for key in section.keys] if kept else _texts(section)
        for key, text in zip(section.keys, texts, strict=True):
            _, other = new.setdefault(id(key), (key, text))
            if other != text:
                message = f"the sections below {key.value!r} need different names: {other}, {text}"
                hint = "write each section under its own key, as in node: ros__parameters:"
                made.append(found_at(document, key, MIXED_KEY, message, hint))
    made += [_key_splice(key, text) for key, text in new.values() if text != key.value]
    return made


def _key_splice(key: yaml.ScalarNode, text: str) -> Splice:
    """A pattern needs no quotes unless it starts with a star."""
    splice = replaced(key, text)
    return splice if key.style or not _PATTERN.fullmatch(text) else splice._replace(new=text)


def _texts(section: ParamSection) -> list[str]:
    """The full name, divided over the keys as before; the namespace goes into the first key."""
    tokens = section.full.strip("/").split("/")
    texts = []
    for key in reversed(section.keys[1:]):
        count = key.value.strip("/").count("/") + 1
        texts.append("/".join(tokens[-count:]))
        tokens = tokens[:-count]
    # Without namespaces nothing is left of a key that was the robot's own.
    first = "/" + ("/".join(tokens) or "**")
    return [first, *reversed(texts)]
