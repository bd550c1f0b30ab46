# SPDX-License-Identifier: Apache-2.0
"""An SRDF that was not written for its URDF: one finding, in place of one for each name."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.description.library import Rewrite
from multibot_rewrite.description.sources.job import PARTS
from multibot_rewrite.rules.files.names import of_another_robot

# The rules about single names.
LOOSE = ("MB803", "MB804", "MB807")
# Fewer names are mistakes in an SRDF that is meant.
FEWEST = 3


def srdf_findings(semantic: Rewrite) -> Iterator[Finding]:
    """The findings of an SRDF; one in place of all about links and joints where most are not there."""
    named = {
        (kind, name.text): name.kind
        for names in semantic.template.inventory.names
        for name in names
        for kind in (name.kind or name.kinds[0],)
        if kind in PARTS
    }
    missing = [text for (_, text), kind in named.items() if not kind]
    loose = [it for it in semantic.findings if it.code in LOOSE]
    if len(missing) < FEWEST or 2 * len(missing) <= len(named) or not loose:
        yield from semantic.findings
        return
    message = f"{len(missing)} of the {len(named)} links and joints that the SRDF names are not in "
    message += f"the URDF: {missing[0]}, {missing[1]} and others"
    first = min(loose, key=lambda it: it.line)
    hint = "; ".join((*filter(None, [first.hint]), "give both the same arguments:"))
    place = {"file": first.file, "line": first.line, "column": first.column}
    yield of_another_robot.finding(message, hint, **place)
    yield from (it for it in semantic.findings if it.code not in LOOSE)
