# SPDX-License-Identifier: Apache-2.0
"""Every kind of related file, rewritten: its sites and their new texts -> splices."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from multibot_rewrite.base.loose_xml import ESCAPES
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import NAMESPACE
from multibot_rewrite.related_files.context import (
    NAMESPACE_SLOT,
    TAG_SLOT,
    Context,
    check_no_slots,
    make_template,
)
from multibot_rewrite.related_files.named_file import NamedFile, RelatedFile
from multibot_rewrite.related_files.names.by_kind import SPELLERS, is_plain
from multibot_rewrite.related_files.names.node_topics import Facts, TopicText, spell_topic
from multibot_rewrite.related_files.names.rename_map import spell
from multibot_rewrite.related_files.sites import AS_IS, UNCLEAR, XML, Site, Slot
from multibot_rewrite.related_files.yaml_text import Splice, quoted

# Names that the remap rules of their node move, too.
GRAPH = ("topic", "service")
_IN_QUOTES = {**ESCAPES, ord("'"): "&apos;"}
# An anchor or a tag before the value.
_MARKS = re.compile(r"(?:[&!][^\s,\[\]{}]*\s+)*")


def spell_site(context: Context, facts: Facts, site: Site) -> TopicText:
    """Return a site's name for a robot; ``facts``: its nodes, whose remap rules move topics."""
    if site.kind in GRAPH:
        return spell_topic(context, site.node, site.kind, site.text, site.reach, facts)
    if site.kind == "controller_topic":
        return _controller_topic(context, facts, site)
    speller = SPELLERS.get(site.kind)
    return TopicText(speller(context, site.text) if speller else site.text)


def _controller_topic(context: Context, facts: Facts, site: Site) -> TopicText:
    """Return ``/arm_controller/joint_trajectory``: a topic below a node is renamed with the node."""
    head, slash, rest = site.text.rpartition("/")
    if not is_plain(site.text) or not head or head.startswith("~"):
        return spell_site(context, facts, site._replace(kind="topic"))
    if context.topics.naming.topics == NAMESPACE:
        return TopicText(spell(context.topics, "topic", site.text))
    return TopicText(SPELLERS["node"](context, head) + slash + rest)


def text_of(context: Context, facts: Facts, site: Site) -> str:
    """Return the text of a site's new name; raises nothing."""
    return spell_site(context, facts, site).text


def with_slots(file: NamedFile, facts: Facts, more: Iterable[Splice] = ()) -> RelatedFile:
    """Return a file with slots in its names, and ``more`` splices; raises InputError."""
    # As ``check_no_slots`` and ``splices_of``.
    check_no_slots(file.text, file.file)
    made = ((it, text_of(file.context, facts, it)) for it in file.names)
    return RelatedFile(
        make_template(file.text, [*more, *splices_of(file.text, file.file, made)]), file
    )


def splices_of(text: str, file: str, made: Iterable[tuple[Site, str]]) -> Iterator[Splice]:
    """Yield the splices that give each site its new text.

    A value may hold several names, and an alias may reach one twice; a block of text stays. Raises
    InputError for one text that would need two names, and for a value that cannot be edited.
    """
    values: dict[int, dict[int, tuple[Site, str]]] = {}
    for site, new in made:
        _, other = values.setdefault(site.slot.start, {}).setdefault(site.at, (site, new))
        if other != new:
            kinds = f"two kinds of name, {other!r} and {new!r}"
            what = f"{file}:{site.line}: an alias uses {site.text!r} as {kinds};"
            what = what.replace(NAMESPACE_SLOT, "ROBOT").replace(TAG_SLOT, "ROBOT")
            raise InputError(f"{what} write the value out in both places")
    for parts in values.values():
        slot = next(iter(parts.values()))[0].slot
        value = slot.value
        for at, (site, new) in sorted(parts.items(), reverse=True):
            value = value[:at] + new + (value[at + site.size :] if site.size >= 0 else "")
        if value != slot.value and not slot.is_block:
            yield written(text, file, slot, value)


def written(text: str, file: str, slot: Slot, new: str) -> Splice:
    """Return the splice that gives a slot another value; an anchor and a tag before it stay."""
    if slot.style == UNCLEAR:
        place = f"{file}:{slot.line}"
        raise InputError(f"{place}: {slot.value!r} cannot be edited in place; write it on one line")
    if slot.style == AS_IS:
        return Splice(slot.start, slot.end, new)
    if slot.style == XML:
        return Splice(slot.start, slot.end, new.translate(_IN_QUOTES))
    marks = _MARKS.match(text, slot.start, slot.end)
    return Splice(marks.end() if marks else slot.start, slot.end, quoted(new, slot.style))
