"""Where the robots of a fleet meet, by the second reading of what was written for each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from multibot_rewrite.checks.meeting import SHARED_LOOKUP, code_of
from multibot_rewrite.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.fleets.member import Member, line_of
from multibot_rewrite.naming import Naming
from multibot_rewrite.readback.meeting import Meeting, meetings
from multibot_rewrite.remap.records import Table


def with_meetings(table: Table, members: Sequence[Member], naming: Naming) -> Table:
    """The table with an error for each name that two robots have and that is not shared.

    The table's own checks name the topics of ROS nodes; these are the topics of the simulator, nodes
    and frames besides.
    """
    named = {name for it in table.problems for name in it.names}
    found = [it for it in _meetings(members, naming) if named.isdisjoint(it.names)]
    return table._replace(problems=(*table.problems, *found))


def _meetings(members: Sequence[Member], naming: Naming) -> Iterator[Finding]:
    if len(members) == 1:
        # There is no second robot: what a rewrite says of any two of them.
        yield from (it._replace(level=_level(it.code)) for it in members[0].shared)
        return
    by_robot = {it.robot: it for it in members}
    for it in meetings({it.robot: it.reading for it in members}, naming):
        yield _finding(it, by_robot[it.robot])


def _finding(met: Meeting, member: Member) -> Finding:
    name, source = met.name, member.source
    line = line_of(source, name.tag, name.number)
    message = f"{met.robot} and {met.other} would both have the {name.kind} {name.name!r}"
    hint = f"it comes from {name.path} here; urdf-postfix on this file says more"
    code = code_of(name)
    return Finding(code, _level(code), message, hint, source.file, line, 1, names=(name.name,))


def _level(code: str) -> str:
    """Whether one robot finds another's sensor depends on the order in which they are spawned."""
    return WARNING if code == SHARED_LOOKUP else ERROR
