"""Where the robots of a fleet meet, by the second reading of what was written for each."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.naming import Naming
from multibot_rewrite.description.checks.meeting import CONTROLLERS, SHARED_LOOKUP, code_of
from multibot_rewrite.description.readback.meeting import Meeting, meetings
from multibot_rewrite.fleet.robots.member import Member, line_of
from multibot_rewrite.spelling.records import Table


def with_meetings(table: Table, members: Sequence[Member], naming: Naming) -> Table:
    """The table with an error for each name that two robots have and that is not shared.

    The table's own checks name the topics of ROS nodes; these are the topics of the simulator, nodes
    and frames besides. Controllers that a stack names are in the table, with their spawners' rules.
    """
    named = {name for it in table.problems for name in it.names}
    found = [it for it in _meetings(members, naming) if named.isdisjoint(it.names)]
    kept = dict.fromkeys(without_started(found, table, [it.robot for it in members]))
    return table._replace(problems=(*table.problems, *kept))


def without_started(
    findings: Iterable[Finding], table: Table, robots: Iterable[str]
) -> Iterator[Finding]:
    """The findings about these robots without those of controllers, if their spawners have rules."""
    spawned = {it.robot for it in table.nodes if it.home.is_controller}
    started = spawned.issuperset(robots)
    return (it for it in findings if not (started and it.code == CONTROLLERS))


def _meetings(members: Sequence[Member], naming: Naming) -> Iterator[Finding]:
    if len(members) == 1:
        # There is no second robot: what a rewrite says of any two of them.
        yield from (it._replace(level=_level(it.code)) for it in members[0].shared)
        return
    by_robot = {it.robot: it for it in members}
    for it in meetings({it.robot: it.reading for it in members}, naming):
        if not it.name.of_controllers:
            yield _finding(it, by_robot[it.robot])
    # The rewrite says what to do about these.
    yield from (it for member in members for it in member.shared if it.code == CONTROLLERS)


def _finding(met: Meeting, member: Member) -> Finding:
    name, source = met.name, member.source
    line = line_of(source, name.tag, name.number)
    message = f"{met.robot} and {met.other} would both have the {name.kind} {name.name!r}"
    hint = f"it comes from {name.path} here; urdf-postfix on this file says more"
    code = code_of(name)
    return Finding(code, _level(code), message, hint, source.file, line, 1, names=(name.name,))


def _level(code: str) -> str:
    """Whether one robot finds another's sensor depends on the order in which they are spawned."""
    return WARNING if code in (SHARED_LOOKUP, CONTROLLERS) else ERROR
