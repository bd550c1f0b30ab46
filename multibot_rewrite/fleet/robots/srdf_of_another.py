# SPDX-License-Identifier: Apache-2.0
"""An SRDF that was not written for its URDF: one finding, in place of one for each name."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.description.library import Rewrite
from multibot_rewrite.description.sources.job import PARTS

# The rules about single names.
LOOSE = ("MB803", "MB804", "MB807")
# Fewer names are mistakes in an SRDF that is meant.
FEWEST = 3

_URDF = """\
<robot name="arm">
  <link name="base"/><link name="upper"/><link name="tool"/>
  <joint name="shoulder" type="fixed"><parent link="base"/><child link="upper"/></joint>
  <joint name="wrist" type="fixed"><parent link="upper"/><child link="tool"/></joint>
</robot>
"""
_SRDF = """\
<robot name="arm">
  <group name="arm"><chain base_link="{0}base" tip_link="{0}tool"/></group>
  <disable_collisions link1="{0}base" link2="{0}upper" reason="Adjacent"/>
</robot>
"""
OF_ANOTHER = declare(
    "MF832",
    "srdf-of-another-robot",
    ERROR,
    what="Most links and joints that an SRDF names are not in the URDF of its robot.",
    why="MoveIt leaves out what it does not find: the groups are empty, no pair of links is excepted "
    "from collision checking, and nothing can be planned. Often the xacro of one of the two got a "
    "prefix that the other did not get, or puts it otherwise.",
    fix="Give both the same arguments, in the fleet file, or name the SRDF of this robot.",
    bad="srdf: other.srdf\nrobots: [{name: robot1, description: arm.urdf}]\n",
    good="srdf: arm.srdf\nrobots: [{name: robot1, description: arm.urdf}]\n",
    line=2,  # of other.srdf
    formats=("fleet",),
    beside={
        "arm.urdf": _URDF,
        "arm.srdf": _SRDF.format(""),
        "other.srdf": _SRDF.format("left"),
    },
)


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
    yield OF_ANOTHER.finding(message, hint, **place)
    yield from (it for it in semantic.findings if it.code not in LOOSE)
