# SPDX-License-Identifier: Apache-2.0
"""Tries whether a proposal builds, with which files and in which layout; writes nothing."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, by_place
from multibot_rewrite.base.findings.formats.plain import said
from multibot_rewrite.base.findings.selection import grouped
from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.base.naming import LAYOUTS
from multibot_rewrite.checks.as_planned import is_of_sources
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.checks.judged_plan import plan_fleet
from multibot_rewrite.checks.read_back import read_back
from multibot_rewrite.description.checks.links_and_joints import read_robot, weighs
from multibot_rewrite.description.sources.access import Reach
from multibot_rewrite.description.sources.expand import once_kept
from multibot_rewrite.fleet.file.fleet_data import FleetSource, FleetText, without_place
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.proposal.fleet_text import text_of
from multibot_rewrite.proposal.looking import (
    NO_SIMULATOR,
    Looked,
    with_hardware_loaded,
    without_names,
)
from multibot_rewrite.proposal.propose import Choice, Proposal, affix_of, propose
from multibot_rewrite.proposal.searching import Found, Undecided
from multibot_rewrite.proposal.seeing import Seen, Wanted, with_arguments

# Builds without files that turned out not to go with a robot, and descriptions that are tried.
MOST_ROUNDS, MOST_TRIED = 10, 5


def first_that_builds(seen: Seen, wanted: Wanted) -> Proposal:
    """Return the fleet of the likeliest description that builds, or of the first."""
    # Raises Undecided if another one that builds may be meant as well.
    likely = [seen.robots[0], *seen.rivals]
    if len(likely) > MOST_TRIED:
        _refuse_to_choose(likely, seen.found)
    tried: list[Proposal] = []
    for it in likely:
        tried.append(that_builds([it], seen.found, wanted))
        if sum(not one.notes for one in tried) > 1:
            _refuse_to_choose(likely, seen.found)
    for it in seen.alike[:MOST_TRIED] if all(one.notes for one in tried) else ():
        tried.append(that_builds([it], seen.found, wanted))
    return next((it for it in tried if not it.notes), tried[0])


def as_named(seen: Seen, wanted: Wanted) -> Proposal:
    """Return the fleet of the named descriptions, or of their other file if only that builds."""
    made = that_builds(seen.robots, seen.found, wanted)
    if not made.notes or list(seen.alike) in ([], list(seen.robots)):
        return made
    other = that_builds(seen.alike, seen.found, wanted)
    return made if other.notes else other


def _refuse_to_choose(likely: Sequence[Looked], found: Found) -> None:
    what = f"{len(likely)} descriptions are as likely to be the robot"
    raise Undecided(what, {it.path: "" for it in likely}, found)


def that_builds(
    robots: Sequence[Looked], found: Found, wanted: Wanted, refused: Mapping[str, str] | None = None
) -> Proposal:
    """Return the fleet of these robots without ``refused`` files, in a layout that builds."""
    # Arguments that name robots stay empty if it builds only so.
    wanted.tell(f"does a fleet of {', '.join(it.path for it in robots)} build?")
    own = with_arguments(robots, wanted, found)
    made, errors = _without_blamed(own, found, wanted, refused or {})
    bare = [without_names(it, wanted.arguments) for it in own] if errors else own
    if bare != own:
        other, wrong = _without_blamed(bare, found, wanted, refused or {})
        made, errors = (made, errors) if wrong else (other, wrong)
    made = in_a_layout_that_builds(made, errors, wanted)
    if made.notes:
        for other, what in _in_another_world(made, own, found, wanted, refused or {}):
            lost = any(it.bringup for it in made.members) and not all(
                it.bringup for it in other.members
            )
            if not lost and not errors_of(_fleet_text(other, wanted), wanted.trust):
                why = f"{what}, since it does not build as it is: {errors[0][1]}"
                simulator = Choice(other.keys["simulator"].value, why)
                return other._replace(keys={**other.keys, "simulator": simulator}, chosen=why)
    return made


def _in_another_world(
    made: Proposal, own: Sequence[Looked], found: Found, wanted: Wanted, refused: Mapping[str, str]
) -> Iterator[tuple[Proposal, str]]:
    """Yield (proposal, how it differs): robots real, or hardware loaded."""
    # Real are those that no simulator can run; a simulator that was asked for stays.
    if wanted.simulator or made.keys["simulator"].value == REAL:
        return
    real = [not _can_be_simulated(it.looked) for it in made.members]
    if all(real):
        robots = with_arguments(own, wanted._replace(simulator=REAL), found)
        other, _ = _without_blamed(robots, found, wanted._replace(simulator=REAL), refused)
        yield other, "the robots are real"
    elif any(real):
        members = [it._replace(is_real=one) for it, one in zip(made.members, real, strict=True)]
        what = "robots that no simulator is for are real"
        yield made._replace(members=members, notes=()), what
    switched = [with_hardware_loaded(it, Reach(trust=wanted.trust)) for it in own]
    if switched != [*own]:
        given = {it.switch: dict(it.arguments)[it.switch] for it in switched if it.switch}
        what = f"arguments {given} make the simulated robot"
        yield _without_blamed(switched, found, wanted, refused)[0], what


def _can_be_simulated(it: Looked) -> bool:
    """Return whether a description has something for a simulator, and a mass."""
    # The mass of an SDF's link that gives none is 1 (sdformat).
    has_mass = it.root is not None and (it.tag == "sdf" or weighs(read_robot(it.root)))
    return it.simulator != NO_SIMULATOR and has_mass


def _without_blamed(
    own: Sequence[Looked], found: Found, wanted: Wanted, refused: Mapping[str, str]
) -> tuple[Proposal, list[tuple[str, str]]]:
    """Return the proposal without faulty files, and the (file, message) pairs that are left."""
    out = dict(refused)
    for _ in range(MOST_ROUNDS):
        made = propose(own, found, wanted, out)
        errors = errors_of(_fleet_text(made, wanted), wanted.trust)
        blamed = dict(_faulty_files(made, errors))
        if not blamed:
            break
        out |= blamed
    return made, errors


def _fleet_text(it: Proposal, wanted: Wanted) -> FleetText:
    """Return the fleet file as it will be written."""
    return FleetText(wanted.file, text_of(it, wanted.file))


def _faulty_files(it: Proposal, errors: Iterable[tuple[str, str]]) -> Iterator[tuple[str, str]]:
    """Yield (path, message) for each related file that has one of the errors."""
    paths = (path for member in it.members for path in member.related_files.paths)
    files = {os.path.abspath(path): path for path in paths}
    for file, line in errors:
        place, _, why = line.partition(": ")
        own = file or os.path.abspath(place.partition(":")[0])
        if own in files:
            yield files[own], line if file else why


def errors_of(
    source: FleetSource, trust: bool = False, of_sources: bool = False
) -> list[tuple[str, str]]:
    """Return (file or "", message) pairs: why a fleet does not build."""
    # It is read back as a build does; faults ``of_sources`` are in any layout.
    try:
        plan, found, back = once_kept((source, trust), lambda: _build_results(source, trust))
    except MultibotError as error:
        place = (source.path,) if isinstance(source, FleetText) else ()
        return [("", without_place(str(error), *place))]
    told = {it for it in back if it._replace(level=WARNING) in found or is_of_sources(it)}
    asked = (it for it in back if of_sources or it not in told)
    errors = sorted((it for it in (*found, *asked) if it.level == ERROR), key=by_place)
    lines = []
    for it in grouped(errors, plan.words):
        who = f"{it.node}: " if it.node else ""
        file = os.path.abspath(it.file) if it.file else ""
        lines.append((file, f"{who}{it.code} {said(it)}"))
    return lines


def _build_results(
    source: FleetSource, trust: bool
) -> tuple[FleetPlan, Set[Finding], Set[Finding]]:
    """Return a plan, its findings as in a build, and those of reading it back."""
    folder = os.path.abspath("out")
    plan = plan_fleet(read_fleet(source, "", os.environ), trust=trust)
    made = make_outputs(plan, folder)
    found = frozenset((*made.findings, *plan.fleet.table.problems))
    wrong = any(it.level == ERROR for it in found)
    back = frozenset(() if wrong else read_back(plan, made, folder)) - found
    return plan, found, back


def in_a_layout_that_builds(
    it: Proposal, own: Sequence[tuple[str, str]], wanted: Wanted
) -> Proposal:
    """Return the proposal in the first layout that builds; with notes if none does."""
    first = it.keys["layout"].value
    if not own:
        return it
    for layout in (one.name for one in LAYOUTS if one.name != first):
        why = f"layout {first} does not work for these files: {own[0][1]}"
        other = in_layout(it, Choice(layout, why))
        if not errors_of(_fleet_text(other, wanted), wanted.trust):
            return other
    return _with_notes(it, own)


def with_faults_of_sources(it: Proposal, wanted: Wanted) -> Proposal:
    """Return the chosen proposal; faults that no choice mends are notes as well."""
    if it.notes:
        return it
    return _with_notes(it, errors_of(_fleet_text(it, wanted), wanted.trust, True))


def _with_notes(it: Proposal, errors: Sequence[tuple[str, str]]) -> Proposal:
    lines = (f"It does not build yet: {line}" for _, line in errors[:3])
    return it._replace(notes=(*it.notes, *lines))


def in_layout(it: Proposal, layout: Choice) -> Proposal:
    """Return the proposal in another layout."""
    keys = {key: one for key, one in it.keys.items() if key not in ("layout", "affix")}
    affix = affix_of(layout.value)
    more = {"affix": affix} if affix else {}
    return it._replace(keys={"layout": layout, **more, **keys})
