"""A proposal tried: does it build, and in which layout? Nothing is written."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from multibot_rewrite.findings.finding import ERROR, Finding
from multibot_rewrite.fleets.build import make_outputs
from multibot_rewrite.fleets.fleet_file import read_fleet
from multibot_rewrite.fleets.fleet_plan import plan_fleet
from multibot_rewrite.model import MultibotError
from multibot_rewrite.naming import LAYOUTS
from multibot_rewrite.proposal.choosing import Choice, affix_of
from multibot_rewrite.proposal.fleet_text import Proposal, data_of


def errors_of(data: Mapping[str, Any], release: str, trust: bool = False) -> list[str]:
    """Why a fleet does not build, in a line each; paths are relative to the working directory."""
    try:
        plan = plan_fleet(read_fleet(data, release, os.environ), trust=trust)
        made = make_outputs(plan, os.path.abspath("out"))
    except MultibotError as error:
        return [str(error)]
    found = {*made.findings, *plan.fleet.table.problems}
    return [_line(it) for it in sorted(found, key=lambda it: it.code) if it.level == ERROR]


def _line(it: Finding) -> str:
    return f"{it.code} {it.message}"


def in_a_layout_that_builds(it: Proposal, release: str, trust: bool = False) -> Proposal:
    """The proposal in its own layout if it builds so, else in the first one that does.

    Where none does it is left as it is, and its first errors are notes.
    """
    first = it.keys["layout"].value
    own = errors_of(data_of(it, os.curdir), release, trust)
    if not own:
        return it
    for layout in (one.name for one in LAYOUTS if one.name != first):
        why = f"layout {first} does not work for these files: {own[0]}"
        other = in_layout(it, Choice(layout, why))
        if not errors_of(data_of(other, os.curdir), release, trust):
            return other
    notes = (f"It does not build yet: {line}" for line in own[:3])
    return it._replace(notes=(*it.notes, *notes))


def in_layout(it: Proposal, layout: Choice) -> Proposal:
    """The proposal in another layout."""
    keys = {key: one for key, one in it.keys.items() if key not in ("layout", "affix")}
    affix = affix_of(layout.value)
    more = {"affix": affix} if affix else {}
    return it._replace(keys={"layout": layout, **more, **keys})
