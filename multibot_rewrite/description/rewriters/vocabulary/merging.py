# SPDX-License-Identifier: Apache-2.0
"""What two sections of vocabulary files say of one thing."""

from __future__ import annotations

from collections.abc import Iterable

from multibot_rewrite.base.model import SiteRow, VocabularyError
from multibot_rewrite.base.releases import share_release
from multibot_rewrite.description.rewriters.vocabulary.grammar import VocabularySection


def merge(first: VocabularySection, second: VocabularySection) -> VocabularySection:
    """What two sections say of one thing: a user's file may add to what is known.

    Raises VocabularyError where both say something of one path or set one setting differently.
    """
    there: dict[str, list[SiteRow]] = {}
    for site in first.sites:
        there.setdefault(site.path, []).append(site)
    new = [it for it in second.sites if not _same_block(it, there.get(it.path, ()))]
    for site in new:
        if any(share_release(site.releases, it.releases) for it in there.get(site.path, ())):
            raise VocabularyError(
                f"{second.file}:{site.line}: {site.path} is there already, in {first.file}"
            )
    below = _either(first, second, "model_namespace")
    sites = first.sites + tuple(new)
    return first._replace(
        sites=tuple(site._replace(below_model=below) for site in sites),
        model_namespace=below,
        at=first.at + tuple(name for name in second.at if name not in first.at),
        blocks=first.blocks + tuple(name for name in second.blocks if name not in first.blocks),
        select=_either(first, second, "select"),
        unique=_either(first, second, "unique"),
        helper=_either(first, second, "helper"),
        wired=first.wired + second.wired,
        switches=first.switches + second.switches,
        hardwired=first.hardwired + second.hardwired,
        inserts=first.inserts and second.inserts,
        process_wide=first.process_wide or second.process_wide,
        tags=first.tags | second.tags,
        opens=tuple(dict.fromkeys((*first.opens, *second.opens))),
    )


def _same_block(site: SiteRow, others: Iterable[SiteRow]) -> bool:
    """Two sections with one block: its lines are not there twice."""
    is_block = site.section[:6] == "block "
    return is_block and any(site.section == it.section for it in others)


def _either(first: VocabularySection, second: VocabularySection, setting: str) -> str:
    old, new = getattr(first, setting), getattr(second, setting)
    if old and new and old != new:
        place = f"{second.file}:{second.line}"
        raise VocabularyError(f"{place}: {setting}: is {old!r} already, in {first.file}")
    return str(old or new)
