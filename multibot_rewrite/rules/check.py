# SPDX-License-Identifier: Apache-2.0
"""A system, alone or with its plan -> findings, in the order of the codes.

All that is found without a plan is found with one, but for what the plan means. Where the view may be
incomplete, a finding about something missing is *inconclusive*.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from fnmatch import fnmatchcase
from types import ModuleType

from multibot_rewrite.base.conventions import WORLD_FRAMES
from multibot_rewrite.base.findings.finding import INCONCLUSIVE, NOTE, Finding
from multibot_rewrite.base.findings.rule import Rule
from multibot_rewrite.base.gc_pause import gc_paused
from multibot_rewrite.producers.bags.recording import is_recorded
from multibot_rewrite.rules.declaration import PAIR, SYSTEM, Finder
from multibot_rewrite.rules.pair import (
    demands,
    endpoints,
    frame_names,
    frames_heard,
    in_enclaves,
    leaks,
    nodes,
    planned_states,
    publishers,
    transforms,
    types,
)
from multibot_rewrite.rules.pair.meeting import missing
from multibot_rewrite.rules.system import (
    addresses,
    clocks,
    commands,
    differing,
    equal_robots,
    frame_ids,
    interfaces,
    likes,
    localized,
    lookups,
    matching,
    names,
    refused,
    relays,
    sharing,
    stamps,
    states,
    tf_pieces,
    tf_topics,
    unsent,
)
from multibot_rewrite.rules.system import nodes as running_nodes
from multibot_rewrite.rules.system import transforms as any_transforms
from multibot_rewrite.rules.system.commands import command_to_nobody
from multibot_rewrite.rules.system.names import topic_names_miss
from multibot_rewrite.rules.system.unsent import nothing_known_sends
from multibot_rewrite.system.index import NO_COUNTS, Index, beside, ends_of, index
from multibot_rewrite.system.ownership import whose_by_plan
from multibot_rewrite.system.patterns import fitted
from multibot_rewrite.system.records import PUBLISHES, SIM_TIME, Caveat, End, System, incomplete
from multibot_rewrite.system.records import clocks as time_by_node
from multibot_rewrite.system.tf_copies import without_bridged

_SYSTEM = (
    *(running_nodes, names, matching, commands, relays, sharing, any_transforms, tf_topics),
    *(
        tf_pieces,
        frame_ids,
        lookups,
        localized,
        refused,
        stamps,
        clocks,
        states,
        equal_robots,
        likes,
        differing,
        unsent,
        interfaces,
        addresses,
    ),
)
_PAIR = (
    *(nodes, endpoints, leaks, types, publishers, demands, in_enclaves, planned_states),
    *(transforms, frame_names, frames_heard),
)


def _declared(modules: Sequence[ModuleType], kind: str) -> Iterator[Rule]:
    for module in modules:
        found = (it for it in vars(module).values() if isinstance(it, Rule))
        yield from (it for it in found if it.formats == (kind,))


def _finders() -> Iterator[Finder]:
    for module in _PAIR:
        yield from (it for it in vars(module).values() if isinstance(it, Finder))
    for rule in _declared(_PAIR, PAIR):
        if rule.check:
            yield Finder(rule, rule.check, bool(rule.options["nodes"]))


SYSTEM_RULES = {it.code: it for it in sorted(_declared(_SYSTEM, SYSTEM), key=lambda it: it.code)}
FINDERS = tuple(sorted(_finders(), key=lambda it: it.rule.code))
RULES = {**{it.code: it for it in _declared(_PAIR, PAIR)}, **SYSTEM_RULES}
WAITED_FOR = "expected-not-seen"
_LACKS = likes.lacks_what_its_likes_have
# Findings about something missing: an incomplete view cannot prove them.
ABSENCE = frozenset(it.code for it in RULES.values() if it.options["absence"])


def judge(seen: Index) -> list[Finding]:
    """What is wrong with a system; empty for one that is as it should be."""
    return _judged(seen, SYSTEM_RULES.values())


def _judged(seen: Index, rules: Iterable[Rule]) -> list[Finding]:
    with gc_paused():
        found = [it for rule in rules if rule.check for it in rule.check(seen)]
        return differing.unexplained(_of_localizers(seen, _of_readers(found)))


def _of_localizers(seen: Index, found: Sequence[Finding]) -> list[Finding]:
    """Where nothing joins a robot with the map, its map in the frame `map` is no fault of its own."""
    lost = {it.robot for it in found if it.code == localized.map_not_joined.code}
    unknown = frame_ids.frame_id_unknown.code
    return [
        it
        for it in found
        if it.code != unknown
        or it.robot not in lost
        or not {*WORLD_FRAMES}.issuperset(map(seen.plain_frame, it.names))
    ]


def _of_readers(found: Sequence[Finding]) -> list[Finding]:
    """A sender and a reader that miss each other are one finding: that of the reader."""
    missed = {frozenset(it.names) for it in found if it.code == topic_names_miss.code}
    sender = command_to_nobody.code
    return [it for it in found if it.code != sender or frozenset(it.names) not in missed]


def contradictions(seen: Index) -> list[Finding]:
    """What two ends, senders or nodes do to each other: true whatever else runs."""
    return _part(seen, absent=False)


def absences(seen: Index) -> list[Finding]:
    """What is missing, as far as the system is known."""
    return _part(seen, absent=True)


def _part(seen: Index, absent: bool) -> list[Finding]:
    found = _judged(seen, (it for it in SYSTEM_RULES.values() if (it.code in ABSENCE) is absent))
    # What is found of robots held against each other is left to any other finding.
    if any(it.code in differing.COMPARED for it in found):
        found = judge(seen)
    return [it for it in found if (it.code in ABSENCE) is absent]


def check(plan: System, graph: System, messages: Mapping[str, int] = NO_COUNTS) -> list[Finding]:
    """What is wrong with a system, and other than planned; empty for a fleet as planned. ``messages``
    counts those of each topic, where they were counted."""
    with gc_paused():
        by_plan, seen = side_by_side(plan, graph, messages)
        finders = [it for it in FINDERS if not (it.nodes and is_recorded(graph))]
        found = [finding for it in finders for finding in it.find(by_plan, seen)]
        found += _besides(by_plan, seen, found)
    return inconclusive_where_in_doubt(sorted(found, key=lambda it: it.code), graph)


def side_by_side(
    plan: System, graph: System, messages: Mapping[str, int] = NO_COUNTS
) -> tuple[Index, Index]:
    """The look-ups of a plan and a system, with the same words for what is made at run time."""
    fitting, there = fitted(plan, graph)
    by_plan = index(fitting, whose_by_plan(fitting))
    edges = without_bridged(fitting, there.edges)
    return by_plan, beside(by_plan, there._replace(edges=edges), messages)


def _besides(plan: Index, seen: Index, found: Sequence[Finding]) -> Iterator[Finding]:
    """What is wrong with the system, without what is meant, and what is found with its cause by the
    plan: under the same code, or as an end that is missing."""
    said = {(it.code, about) for it in found for about in (*it.names, it.node) if about}
    said |= {(it.code, f"of {it.robot}") for it in found if it.robot}
    lost = {name for node, *_, name in missing(plan, seen) if node not in plan.may_miss}
    loose = {name for node, *_, name in missing(plan, seen)} - lost
    told = {name for it in found for name in it.names}
    # What a robot has not and others have is meant where nothing that is planned is missing.
    asked = [it for it in SYSTEM_RULES.values() if it is not _LACKS or lost or loose]
    for it in _judged(seen._replace(system=_without_planned(plan, seen.system)), asked):
        options = RULES[it.code].options
        abouts = (*it.names, it.node, *[f"of {it.robot}"] * bool(options["robot_wide"]))
        by_plan = any((it.code, about) in said for about in abouts)
        absent = options["absence"] and (not lost.isdisjoint(it.names) or _all_in(it, loose))
        compared = it.code in differing.COMPARED and not told.isdisjoint(it.names)
        if not (by_plan or absent or compared or _is_meant(plan, seen, it)):
            # Nothing sends it by the plan either, whatever another robot has.
            yield it._replace(level=NOTE) if it.code == nothing_known_sends.code else it


def _all_in(finding: Finding, loose: Set[str]) -> bool:
    """Is it only about what need not be there by the plan?"""
    return bool(finding.names) and {*finding.names} <= loose


def _is_meant(plan: Index, seen: Index, finding: Finding) -> bool:
    """Whether all who do with its names what it is about are planned to."""
    key, memo = (finding.code, finding.names), seen.memo.setdefault(_is_meant, {})
    if key not in memo:
        memo[key] = _are_meant(plan, seen, finding)
    return bool(memo[key])


def _are_meant(plan: Index, seen: Index, finding: Finding) -> bool:
    roles = RULES[finding.code].options["meant"]
    ends = [end for name in finding.names for end in ends_of(seen, name)]
    about = [end for end in ends if isinstance(roles, tuple) and end.role in roles]
    return bool(about) and all(_is_planned(plan, end) for end in about)


def _is_planned(plan: Index, end: End) -> bool:
    if (end.node, end.kind, end.role, end.name) in plan.by_key:
        return True
    topics = (it for it in plan.system.topics if it.name == end.name and end.role == PUBLISHES)
    return any(fnmatchcase(end.node, pattern) for it in topics for pattern in it.senders)


def _without_planned(plan: Index, graph: System) -> System:
    """The graph without the states that the plan has: they are compared with it."""
    states_ = {it.name for it in plan.system.nodes if it.lifecycle}
    timed = dict(planned_states.planned_clocks(plan.system))
    nodes_ = (it._replace(lifecycle="") if it.name in states_ else it for it in graph.nodes)
    parameters = (it for it in graph.parameters if it.name != SIM_TIME or it.node not in timed)
    return graph._replace(nodes=tuple(nodes_), parameters=tuple(parameters))


def inconclusive_where_in_doubt(found: list[Finding], graph: System) -> list[Finding]:
    """The findings; those about something missing are inconclusive in an incomplete view. What a
    parameter says of the time of a node is known there, too."""
    if not doubts(graph):
        return found
    told, mixed = time_by_node(graph), clocks.clocks_mixed.code
    sure = {it for it in found if it.code not in ABSENCE or (it.code == mixed and it.node in told)}
    return [it if it in sure else _inconclusive(it) for it in found]


def doubts(graph: System) -> tuple[Caveat, ...]:
    """The caveats that make a view incomplete.

    That an expected node did not come is not one of them: once the graph is quiet it is missing.
    """
    return tuple(caveat for caveat in incomplete(graph) if caveat.code != WAITED_FOR)


def _inconclusive(finding: Finding) -> Finding:
    hint = "the view of the graph may be incomplete: the line `incomplete:` says why"
    return finding._replace(level=INCONCLUSIVE, hint=hint, file="", line=0)
