"""A parameter file as rules ask it: its sections and the names in them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.kinds import PARAMS
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.names.placeholders import without_robot
from multibot_rewrite.companions.params.name_sites import (
    NO_NAMES,
    Page,
    SectionNames,
    find_names,
)
from multibot_rewrite.companions.params.sections import (
    ParamSection,
    identify_sections,
    raw_sections,
    without_own,
)
from multibot_rewrite.companions.sites import SECTION, Site, site_at
from multibot_rewrite.companions.yaml_text import YamlText
from multibot_rewrite.knowledge.parameters import KnownNodes


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
