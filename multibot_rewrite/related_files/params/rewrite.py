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
from multibot_rewrite.base.lazy import gc_paused
from multibot_rewrite.knowledge.parameters import KnownNodes, built_in_nodes
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.related_files.context import (
    NAMESPACE_SLOT,
    TAG_SLOT,
    Context,
    FileTemplate,
    check_no_slots,
    make_template,
)
from multibot_rewrite.related_files.named_file import PARAMS, NamedFile, RelatedFile
from multibot_rewrite.related_files.names.node_topics import facts_by_name
from multibot_rewrite.related_files.names.placeholders import without_robot
from multibot_rewrite.related_files.params.name_sites import NO_NAMES, SectionNames, find_names
from multibot_rewrite.related_files.params.sections import (
    ParamSection,
    RawSection,
    identify_sections,
    raw_sections,
    without_own,
)
from multibot_rewrite.related_files.params.shared_defaults import default_lines, lacking_sections
from multibot_rewrite.related_files.params.values import ParamsJob, clock_splices, name_splices
from multibot_rewrite.related_files.sites import SECTION, Site, site_at
from multibot_rewrite.related_files.yaml_text import Splice, YamlText, found_at, replaced


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
) -> RelatedFile:
    """Return a parameter file with slots for a robot, and the findings about it.

    ``known`` are the known nodes, ``beside`` the other parameter files that the robot's nodes get: what
    they set is not inserted here. ``facts`` are those of the robot's nodes, whose remap rules move
    topics too. A file for one robot may have its sections below one of ``own``. ``at_run_time`` are the
    nodes that put the robot's name before their frames themselves. ``clock`` is the ``use_sim_time`` of
    all its nodes, None if they keep their own. The robot's first file gets sections of nodes of the
    node set that no file has one for. Raises InputError for a file that is not a parameter file or that
    rcl rejects.
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
        file = read_params(document, context, job.known, job.own)
        job = job._replace(known=job.known._replace(sent=file.sent))
        sections = [section for section, _ in file.pages]
        pages = [it for it in file.pages if not it[0].shared]
        found = [RawSection(*it[:3]) for it in sections]
        others = [it for other in beside for it in without_own(raw_sections(other), job.own)]
        made = [
            *key_splices(document, sections),
            *(it for section in sections for it in clock_splices(job, section)),
            *(it for page in pages for it in name_splices(job, *page)),
            *default_lines(job, pages, others),
            *lacking_sections(job, found, others, is_first),
        ]
        template = make_template(document.text, [it for it in made if isinstance(it, Splice)])
        pieces = (document.bom + template.pieces[0], *template.pieces[1:])
        return RelatedFile(FileTemplate(pieces), file, _once_each(made))


def rewrite_values(job: ParamsJob) -> RelatedFile:
    """Return parameters of one node with slots for a robot; raises as ``rewrite_params``."""
    # No other file is read, nothing inserted.
    with gc_paused():
        check_no_slots(job.document.text, job.document.file)
        file = read_params(job.document, job.context, job.known)
        job = job._replace(known=job.known._replace(sent=file.sent))
        pages = (it for it in file.pages if not it[0].shared)
        made = [one for it in pages for one in name_splices(job, *it)]
        splices = [it for it in made if isinstance(it, Splice)]
        return RelatedFile(make_template(job.document.text, splices), file, _once_each(made))


def _once_each(made: Iterable[Splice | Finding]) -> tuple[Finding, ...]:
    """Return findings, equal ones once, with ``<robot>`` in place of slots."""
    findings = [it for it in made if isinstance(it, Finding)]
    first: dict[tuple[str, str], Finding] = {}
    for found in sorted(findings, key=lambda it: (it.line, it.column, it.code)):
        message, hint = (
            text.replace(NAMESPACE_SLOT, "<robot>").replace(TAG_SLOT, "<robot>")
            for text in (found.message, found.hint)
        )
        first.setdefault((found.code, found.message), found._replace(message=message, hint=hint))
    return tuple(first.values())


def read_params(
    document: YamlText, context: Context, known: KnownNodes, own: Collection[str] = ()
) -> NamedFile:
    """Return the names of a parameter file; ``own`` are the names of its one robot."""
    # Raises InputError for another file, or one that rcl rejects.
    found = without_own(raw_sections(document), own)
    sections = identify_sections(found, context, known)
    pages = tuple(
        (it, _own_names(it, find_names(document, it, known, context.distro))) for it in sections
    )
    # The frames that nodes of the file make themselves: no description has them.
    sites = [site for _, page in pages for site in page.sites]
    sent = frozenset(it.text.lstrip("/") for it in sites if it.own)
    others = (
        site_at(it, "", str(it.value), in_key=in_key)
        for _, page in pages
        for found, in_key in ((page.unclaimed, False), (page.keys, True))
        for it in found
    )
    names = (*(site for it in sections for site in _section_keys(it, own)), *sites)
    return NamedFile(
        PARAMS,
        document.file,
        document.text,
        context,
        {},
        names,
        tuple(others),
        tuple(site_at(key, "", str(key.value)) for _, page in pages for key in page.twice),
        document,
        pages,
        known,
        sent=known.sent | sent,
        is_for_one=bool(own),
    )


def _own_names(section: ParamSection, found: SectionNames) -> SectionNames:
    """Return the names of a section; of a node that all robots share only patterns for their names."""
    patterns = [it for it in found.sites if it.kind == "pattern"]
    return NO_NAMES._replace(sites=patterns) if section.shared else found


def _section_keys(section: ParamSection, own: Collection[str]) -> Iterator[Site]:
    """Yield the keys above a section, without the robot that the file is for."""
    # A namespace that is the root's or the robot's alone is no name of a node.
    first, *rest = section.keys
    bare = first.value.strip("/")
    words = (it for it in own if f"{bare}/".startswith(f"{it}/"))
    name = next((bare.removeprefix(it).strip("/") for it in words), first.value)
    if not rest or not first.value or name not in ("", "/"):
        yield site_at(first, SECTION, without_robot(name or first.value))
    yield from (site_at(it, SECTION, without_robot(it.value), in_key=True) for it in rest)


_PATTERN = re.compile(r"/[A-Za-z0-9_/*]+")

MIXED_KEY = declare("MF101", "mixed-section-key", ERROR, formats=("params",))


def key_splices(document: YamlText, sections: Sequence[ParamSection]) -> list[Splice | Finding]:
    """Return the new keys above the sections, and findings for keys that cannot change."""
    new: dict[int, tuple[yaml.ScalarNode, str]] = {}
    made: list[Splice | Finding] = []
    for section in sections:
        kept = section.shared or section.full == section.path
        texts = [key.value for key in section.keys] if kept else _new_key_texts(section)
        for key, text in zip(section.keys, texts, strict=True):
            _, other = new.setdefault(id(key), (key, text))
            if other != text:
                message = f"the sections below {key.value!r} need different names: {other}, {text}"
                hint = "write each section under its own key, as in node: ros__parameters:"
                made.append(found_at(document, key, MIXED_KEY, message, hint))
    for key, text in new.values():
        if text != key.value:
            splice = replaced(key, text)
            # A pattern needs no quotes unless it starts with a star.
            is_plain = not key.style and _PATTERN.fullmatch(text)
            made.append(splice._replace(new=text) if is_plain else splice)
    return made


def _new_key_texts(section: ParamSection) -> list[str]:
    """Return the full name, divided over the keys as before; the namespace goes into the first key."""
    tokens = section.full.strip("/").split("/")
    texts = []
    for key in reversed(section.keys[1:]):
        count = key.value.strip("/").count("/") + 1
        texts.append("/".join(tokens[-count:]))
        tokens = tokens[:-count]
    # Without namespaces nothing is left of a key that was the robot's own.
    first = "/" + ("/".join(tokens) or "**")
    return [first, *reversed(texts)]
