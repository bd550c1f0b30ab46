# SPDX-License-Identifier: Apache-2.0
"""What is found of a system, and what only its plan shows -> one finding for each cause.

What is found without a plan is found with one, unless it is meant, or the plan has the cause of it: a
name that a node lacks, in place of those who wait for it. What only the plan shows is the hint of a
finding about the same, or else a finding of its own.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from fnmatch import fnmatchcase

from multibot_rewrite.base.findings.finding import ERROR, NOTE, Finding, Remap, Rule
from multibot_rewrite.base.wording import shorten, unique
from multibot_rewrite.rules.folded import GIVES, has_to_give, of_one_target, unplanned_ends_of
from multibot_rewrite.rules.system.changed import untold
from multibot_rewrite.rules.system.differing import BETWEEN_ROBOTS, unexplained
from multibot_rewrite.rules.system.planned_ends import (
    matches,
    missing,
    missing_endpoint,
    unplanned_nodes,
)
from multibot_rewrite.rules.system.planned_frames import frame_without_robot_name
from multibot_rewrite.rules.system.planned_nodes import sender_not_planned
from multibot_rewrite.rules.system.unsent import nothing_known_sends
from multibot_rewrite.system.index import TF, Index, ends_of
from multibot_rewrite.system.records import PUBLISHES, End
from multibot_rewrite.system.tf_copies import tree_topic

# A node, or a name and whose it is: a node's or robot's, or beside which other name; empty for all.
_About = tuple[str, str]


def one_for_a_cause(
    seen: Index,
    plan: Index,
    found: Sequence[Finding],
    by_plan: Sequence[Finding],
    rules: Mapping[str, Rule],
    in_doubt: bool,
) -> list[Finding]:
    """Return the findings of a system and its plan, one for each cause.

    ``in_doubt``: the system may have more than was seen."""
    left = [it for it in found if not _is_meant(plan, seen, it, rules[it.code])]
    # What is there counts before what is missing, then the first.
    places: list[dict[_About, int]] = [{}, {}]
    for at, it in reversed([*enumerate(left)]):
        places[_is_absence(it, rules)].update(dict.fromkeys(_subjects(it, rules), at))
    causes: dict[int, list[Finding]] = defaultdict(list)
    others: list[Finding] = []
    for it in by_plan:
        keys = [*_same_causes(seen, it, rules)]
        same = [them[key] for them in places for key in keys if key in them]
        (causes[same[0]] if same else others).append(it)
    said = {at: _with_cause(seen, left[at], own, rules, in_doubt) for at, own in causes.items()}
    lost = {name for node, *_, name in missing(plan, seen) if node not in plan.may_miss}
    loose = {name for node, *_, name in missing(plan, seen)} - lost
    new = {*unplanned_nodes(plan, seen)} - {*matches(plan, seen).values()}
    kept = []
    for at, it in enumerate(left):
        is_lost = at not in causes and _is_absence(it, rules)
        given = (x for x in unplanned_ends_of(seen, it) if x.role in GIVES) if is_lost else ()
        # What a node gives that is no planned one is of that node's making.
        names = set() if not is_lost or any(x.node in new for x in given) else {*it.names}
        if not (names & lost or (names and names <= loose)):
            kept.append(said.get(at, it))
    every = {*unexplained([*kept, *by_plan])}
    # Nothing sends it by the plan either, whatever another robot has.
    return [
        it._replace(level=NOTE) if it.code == nothing_known_sends.code else it
        for it in untold(it for it in (*kept, *others) if it in every)
    ]


def subject_of(plan: Index, it: Finding) -> tuple[str, ...]:
    """Return the key by which a finding about a plan's sources and one about the graph are the same."""
    # The code, and the names without those of robots, or else the message.""
    return (it.code, *map(plan.plain, it.names)) if it.names else (it.code, it.message)


def _is_absence(it: Finding, rules: Mapping[str, Rule]) -> bool:
    return bool(rules[it.code].options["absence"])


def _subjects(it: Finding, rules: Mapping[str, Rule]) -> Iterator[_About]:
    """Yield what a finding is about: its node, its robot, and its names."""
    if it.code in BETWEEN_ROBOTS:
        return
    yield it.node, ""
    # What is missing at one robot is no cause of what another one lacks.
    whose = {it.node, it.robot} if _is_absence(it, rules) else {it.node, it.robot, ""}
    yield from ((one, name) for name in it.names for one in whose)
    if len(it.names) == 2:
        yield from ((f"with {it.names[1 - at]}", name) for at, name in enumerate(it.names))


def _is_of_an_end(it: Finding, rules: Mapping[str, Rule]) -> bool:
    """Return whether a finding is of ``missing_endpoint``, whatever its name."""
    return it.code == missing_endpoint.code or not rules[it.code].options["planned"]


def _same_causes(seen: Index, it: Finding, rules: Mapping[str, Rule]) -> Iterator[_About]:
    """Yield the keys of findings that have the same cause as one by the plan."""
    if it.code in (sender_not_planned.code, frame_without_robot_name.code):
        yield from ((whose, name) for name in it.names for whose in (it.node, it.robot, ""))
    elif _is_of_an_end(it, rules) and _has_instead(it):
        used = it.names[-1]
        is_tf = any(end.type == TF for end in ends_of(seen, used))
        about = tree_topic(used) if is_tf else used
        yield from ((whose, about) for whose in (it.node, f"with {it.names[0]}", it.robot, ""))
    elif _is_of_an_end(it, rules):
        # What all robots have, such as /clock, the nodes of a robot lack together; whoever has to send
        # it is not one of them, but the cause.
        alone = seen.robot(it.names[0]) or has_to_give(seen, it)
        lacks = (it.node,) if alone else (it.node, it.robot)
        yield from ((whose, it.names[0]) for whose in lacks)


def _has_instead(it: Finding) -> bool:
    """Return whether the node of a finding has another name in place of what it lacks."""
    return len(it.names) > 1 or it.code != missing_endpoint.code


def _with_cause(
    seen: Index,
    it: Finding,
    by_plan: Sequence[Finding],
    rules: Mapping[str, Rule],
    in_doubt: bool,
) -> Finding:
    """Return the finding with the plan's remedy, or the plan's finding if that is the certain one."""
    place = by_plan[0]
    if in_doubt and _is_absence(it, rules) and not _is_absence(place, rules):
        return place
    hint, remaps = _hint_of_plan(seen, it, by_plan, rules)
    level = ERROR if any(one.level == ERROR for one in by_plan) else it.level
    found = it._replace(hint=hint, level=level, remaps=remaps)
    if not place.file:
        return found
    return found._replace(file=place.file, line=place.line, column=place.column)


def _hint_of_plan(
    seen: Index, it: Finding, by_plan: Sequence[Finding], known: Mapping[str, Rule]
) -> tuple[str, tuple[Remap, ...]]:
    """Return (the plan's hint, the remap rules that it names, those of all nodes named)."""
    first, *others = by_plan
    if not _is_of_an_end(first, known):
        return first.hint, first.remaps
    if it.settings or not _has_instead(first):
        return it.hint, it.remaps
    who = "it" if first.node == it.node else first.node
    led = [rule for one in by_plan for rule in one.remaps]
    # Those of which the plan says nothing, such as tools, have the finding's own rule.
    olds, planned = {rule.old for rule in led}, {one.node for one in by_plan}
    led += (rule for rule in it.remaps if rule.old in olds and rule.node not in planned)
    places = {one.node: f" (see {one.file}:{one.line})" for one in others if one.file}
    nodes = unique([*(it.node for it in others), *(it.node for it in led)])
    more = [f"{node}{places.get(node, '')}" for node in nodes if node != first.node]
    same = f"; the same for {shorten(more)}" if more else ""
    remaps = of_one_target(led)
    # Of no robot, and sends it to all: a command that would come to nobody.
    sent = (end for old in olds & seen.orders.keys() for end in seen.orders[old].publishers)
    several = {it.node for it in sent if not seen.robot(it.node)} - planned
    if several := several.union(it.node for it in {*led}.difference(remaps)):
        look = f"see their rules, and why {shorten(sorted(several))} uses one name for all robots"
        return f"by the plan {who} {first.message}{same}; {look}", ()
    if not all(one.remaps for one in by_plan):
        remaps = ()
    return f"by the plan {who} {first.message}: {first.hint}{same}", remaps


def _is_meant(plan: Index, seen: Index, it: Finding, rule: Rule) -> bool:
    """Return whether all nodes with its names are planned to do what it is about."""
    key, memo = (it.code, it.names), seen.memo.setdefault(_is_meant, {})
    if key not in memo:
        roles = rule.options["meant"]
        ends = [end for name in it.names for end in ends_of(seen, name)] if roles else []
        about = [end for end in ends if isinstance(roles, tuple) and end.role in roles]
        memo[key] = bool(about) and all(_is_planned(plan, end) for end in about)
    return bool(memo[key])


def _is_planned(plan: Index, end: End) -> bool:
    if (end.node, end.kind, end.role, end.name) in plan.by_key:
        return True
    topics = (it for it in plan.system.topics if it.name == end.name and end.role == PUBLISHES)
    return any(fnmatchcase(end.node, pattern) for it in topics for pattern in it.senders)
