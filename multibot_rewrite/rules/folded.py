# SPDX-License-Identifier: Apache-2.0
"""Findings -> one for each cause, the likeliest first, with its consequences and repetitions."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from itertools import product

from multibot_rewrite.base.bounded import own_rows
from multibot_rewrite.base.conventions import WORLD_FRAMES
from multibot_rewrite.base.findings.finding import (
    ERROR,
    INCONCLUSIVE,
    NOTE,
    WARNING,
    Finding,
    Remap,
)
from multibot_rewrite.base.grouping import lists_by_key, sets_by_key
from multibot_rewrite.base.wording import SEVERAL, shorten, unique
from multibot_rewrite.system.index import TF, Index, ends_of, once
from multibot_rewrite.system.records import PUBLISHES, SERVES, End

GIVES = (PUBLISHES, SERVES)


def _ends(seen: Index | None, names: Iterable[str]) -> Iterator[End]:
    """Yield the ends of these names, of whatever kind."""
    return (end for name in names for end in ends_of(seen, name)) if seen else iter(())


def _planned_ends(seen: Index, it: Finding) -> Sequence[End]:
    return seen.expected.by_node.get(it.node, ()) if seen.expected else ()


def unplanned_ends_of(seen: Index, it: Finding) -> Iterator[End]:
    """Yield the ends of a finding's names that the plan has not."""
    known = seen.expected.by_key if seen.expected else seen.by_key
    return (x for x in _ends(seen, it.names) if (x.node, x.kind, x.role, x.name) not in known)


def has_to_give(seen: Index, it: Finding) -> bool:
    """Return whether a node has to send or serve, by the plan, what others wait for."""
    planned = _ends(seen.expected, it.names[:1])
    return any(end.node == it.node and end.role in GIVES for end in planned)


def _robots_of_description(seen: Index, it: Finding) -> Iterable[str]:
    """Return the robots of a description, by its topic and by its links."""
    own = (one for one in seen.system.descriptions if one.topic in it.names)
    return {it.robot, *(seen.frame_robot(link) for one in own for link in one.links)} - {""}


@once
def _senders(seen: Index) -> Mapping[str, Set[str]]:
    """Return by topic the nodes that send it in any robot, all without the robots' names."""
    ends = (x for it in seen.topics if seen.robot(it.name) for x in it.publishers)
    return sets_by_key((seen.plain(it.name), seen.plain(it.node)) for it in ends)


@once
def _frame_senders(seen: Index) -> Mapping[str, Sequence[str]]:
    edges = (edge for tree in seen.trees for edge in tree.edges)
    return lists_by_key((edge.child, node) for edge in edges for node in edge.publishers)


# What a finding has in common with another one, by the words of explains.schema.
_FACETS: Mapping[str, Callable[[Index, Finding], Iterable[str]]] = {
    "anything": lambda seen, it: ("",),
    "robot": lambda seen, it: (it.robot,),
    "robot twice": lambda seen, it: (it.robot, "") if len(it.names) > 1 else (),
    "node": lambda seen, it: filter(None, (it.node,)),
    "plain node": lambda seen, it: (seen.plain(it.node),),
    "names": lambda seen, it: it.names,
    "own names": lambda seen, it: (f"{seen.frame_robot(x) or it.robot} {x}" for x in it.names),
    "plain names": lambda seen, it: map(seen.plain, it.names),
    # A prefix may be there twice.
    "frames": lambda seen, it: map(seen.plain_frame, map(seen.plain_frame, it.names)),
    "users": lambda seen, it: (end.node for end in _ends(seen, it.names)),
    "senders": lambda seen, it: (x.node for x in _ends(seen, it.names) if x.role == PUBLISHES),
    "frame senders": lambda seen, it: (x for name in it.names for x in _frame_senders(seen)[name]),
    "server": lambda seen, it: (seen.plain(name.rpartition("/")[0]) for name in it.names),
    "givers": lambda seen, it: (x for name in it.names for x in _senders(seen)[seen.plain(name)]),
    "planned names": lambda seen, it: (seen.plain(end.name) for end in _planned_ends(seen, it)),
    "unplanned": lambda seen, it: (x.node for x in unplanned_ends_of(seen, it)),
    "new nodes' names": lambda seen, it: (
        seen.plain(x.name)
        for x in unplanned_ends_of(seen, it)
        if x.role in GIVES and seen.expected and x.node not in seen.expected.by_node
    ),
    "plain given names": lambda seen, it: (
        seen.plain(x.name) for x in _planned_ends(seen, it) if x.role in GIVES
    ),
    "lacking": lambda seen, it: (x.node for x in _planned_ends(seen, it) if x.name in it.names[:1]),
    "given names": lambda seen, it: (x.name for x in _planned_ends(seen, it) if x.role in GIVES),
    "wanted names": lambda seen, it: it.names[:1] * (not has_to_give(seen, it)),
    "described robots": _robots_of_description,
    "a clock": lambda seen, it: ("",) * is_about_a_clock(seen, it),
    "a map": lambda seen, it: ("" for x in it.names if seen.plain_frame(x) in WORLD_FRAMES),
    "a frame": lambda seen, it: ("" for x in it.names[:1] if not x.startswith("/")),
    "a tf topic": lambda seen, it: ("" for x in _ends(seen, it.names) if x.type == TF),
    "no tf": lambda seen, it: ("" for x in _ends(seen.expected, it.names[:1]) if x.type == TF),
    "sent tf": lambda seen, it: (
        "" for x in _planned_ends(seen, it) if x.type == TF and x.role == PUBLISHES
    ),
}


def _facet_values(seen: Index, it: Finding, common: str, side: int) -> Set[tuple[str, ...]]:
    """Return the values that a cause (side 0), or what comes of it (-1), has in ``common``."""
    facets = (one.split(" = ")[side] for one in common.split(" and "))
    return {*product(*(_FACETS[facet](seen, it) for facet in facets))}


_EXPLAINS = own_rows(__file__, "explains.schema")
# What so many findings of a code have in common that are one.
_ONE_OF = {
    **dict.fromkeys(("MG303", "MG306", "MG307", "MG501"), ("names", 2)),
    **{"MG102": ("node", 2), "MG304": ("node", 3), "MG101": ("robot", 3), "MG322": ("robot", 3)},
}
_UNPLANNED, _LACKING = "MG108", ("MG101", "MG102")
# From bad to good.
_BAD = (ERROR, INCONCLUSIVE, WARNING, NOTE)
# The codes of each kind of cause, as they begin; what is in none comes last.
_ORDER = (
    ("MG50",),
    ("MG101", "MG109", "MG322", "MG301", "MG302", "MG511", "MG513"),
    ("MG102", "MG303", "MG304", "MG305", "MG308", "MG31", "MG320", "MG321", "MG323"),
    ("MG306", "MG307", "MG309"),
    ("MG2", "MG4"),
)


def folded(seen: Index, found: Sequence[Finding]) -> list[Finding]:
    """Return one finding for each cause."""
    by_code = lists_by_key((it.code, at) for at, it in enumerate(found))
    below: dict[int, list[int]] = defaultdict(list)
    gone: set[int] = set()
    for code, codes, common in _EXPLAINS if len(found) > 1 else ():
        causes = [it for it in by_code[code] if it not in gone]
        others = [it for other in codes.split() for it in by_code[other] if it not in gone]
        pairs = ((key, it) for it in causes for key in _facet_values(seen, found[it], common, 0))
        by_key = lists_by_key(pairs if others else ())
        for at in others if by_key else ():
            # Each robot's cause has it, so that the robots' findings stay one.
            keys = _facet_values(seen, found[at], common, -1)
            for cause in {it for key in keys for it in by_key[key]}:
                below[cause].append(at)
                gone.add(at)
    left = [
        _with_explained(it, [found[one] for one in below.get(at, ())])
        for at, it in enumerate(found)
        if at not in gone
    ]
    return _without_unplanned(seen, _merged(left))


def _with_explained(it: Finding, explained: Sequence[Finding]) -> Finding:
    """Return a cause with its consequences in the hint, at the worst of their levels."""
    if not explained:
        return it
    # What the plan has and no rule brings: the rules alone would show it.
    ruled = {rule.node for rule in it.remaps} if it.code not in _LACKING else ()
    lost = [x.node for x in explained if x.code in _LACKING and not x.remaps]
    if lost := [node for node in unique(lost) if ruled and node not in ruled]:
        told = (
            f"by the plan {shorten(lost)} has to give what is waited for: start it, or see its log"
        )
        it = it._replace(hint=told, remaps=(), settings=())
    first = explained[0]
    others = unique(one.code for one in explained if one.code != first.code)
    more = f", and {shorten(others)}" if others else ""
    told = f"so {first.node or first.robot or 'tf'}: {first.message} ({first.code}{more})"
    level = min((it.level, *(one.level for one in explained)), key=_BAD.index)
    # Of one name each has the rules for a part of its nodes.
    same = (one for one in explained if one.names == it.names)
    remaps = (*it.remaps, *(rule for one in same for rule in one.remaps)) if it.remaps else ()
    hint = f"{it.hint}; {told}" if it.hint else told
    return it._replace(hint=hint, level=level, remaps=of_one_target(remaps))


def of_one_target(rules: Iterable[Remap]) -> tuple[Remap, ...]:
    """Return the rules, except those that lead one name of a node to two targets."""
    each = tuple(dict.fromkeys(rules))
    targets = Counter((it.node, it.old) for it in each)
    return tuple(it for it in each if targets[it.node, it.old] == 1)


def _merged(found: Iterable[Finding]) -> Iterator[Finding]:
    """Yield the findings; those that several nodes share become one, at the first and worst."""
    groups: dict[tuple[object, ...], list[Finding]] = {}
    every = [*found]
    # Those with one name in place of a planned one have one rule, whatever this breaks.
    ruled = Counter(it.names for it in every if _has_one_rule(it))
    for it in every:
        by, _ = _ONE_OF.get(it.code, ("", 0))
        common = (it.code, getattr(it, by, ""), it.hint if by == "robot" else "")
        one = not it.remaps and it.robot if by == "robot" else it.node
        key: tuple[object, ...] = common if by and one else (it,)
        key = it.names if _has_one_rule(it) and ruled[it.names] > 1 else key
        groups.setdefault(key, []).append(it)
    for group, own in groups.items():
        code, one_name = own[0].code, group == own[0].names
        if len(own) == 1 or not (one_name or len(own) >= _ONE_OF[code][1]):
            yield from own
        else:
            by_node = one_name or _ONE_OF[code][0] == "names" or code == "MG101"
            yield _merged_finding(own, by_node)


def _has_one_rule(it: Finding) -> bool:
    """Return whether a finding's rules lead the second of its names to the first one."""
    return {(rule.new, rule.old) for rule in it.remaps} == {it.names}


def _merged_finding(own: Sequence[Finding], by_node: bool) -> Finding:
    """Return one finding for several of a code that differ in the node or the name."""
    first = min(own, key=lambda it: (_BAD.index(it.level), it.code == "MG102"))
    others = [it for it in own if it is not first]
    if by_node:
        same = unique(it.node for it in others if it.node != first.node)
    else:
        same = unique(it.names[0] for it in others if it.names)
    remaps = of_one_target(rule for it in own for rule in it.remaps)
    if any(not it.remaps for it in own):
        remaps = first.remaps
    more = f"; the same for {shorten(same, SEVERAL)}" if same else ""
    names = unique(name for it in (first, *others) for name in it.names)
    settings = tuple(dict.fromkeys(one for it in own for one in it.settings))
    message = f"{first.message}{more}"
    return first._replace(message=message, names=names, remaps=remaps, settings=settings)


def _without_unplanned(seen: Index, found: Iterable[Finding]) -> list[Finding]:
    """Return the findings; an unplanned node is named in the first one about it or its likes."""
    every = [*found]
    nodes = {it.node: at for at, it in enumerate(every) if it.code == _UNPLANNED}
    likes = lists_by_key((seen.plain(one), one) for one in nodes)
    gone: set[int] = set()
    for at, it in enumerate(every) if nodes else ():
        users = _users(seen, it) if it.level in (ERROR, WARNING) and it.code != _UNPLANNED else ()
        plain = {seen.plain(one) for one in users if one in nodes and nodes[one] not in gone}
        ats = sorted({nodes[like] for one in plain for like in likes[one]} - gone)
        if left := [every[one].node for one in ats]:
            gone.update(ats)
            verb = "is" if len(left) == 1 else "are"
            hint = f"{it.hint}; {shorten(left, SEVERAL)} {verb} not in the plan"
            every[at] = it._replace(hint=hint)
    return [it for at, it in enumerate(every) if at not in gone]


def _users(seen: Index, it: Finding) -> Sequence[str]:
    """Return the nodes that have the names that a finding is about, or send its frames."""
    own = (x for name in it.names for x in _frame_senders(seen)[name] if seen.robot(x) == it.robot)
    # Of a node that is missing, those of what it has to give.
    gone = () if it.node in seen.node else _planned_ends(seen, it)
    names = (*it.names, *(x.name for x in gone if x.role in GIVES and x.type != TF))
    return unique((it.node, *(end.node for end in _ends(seen, names)), *own))


def is_about_a_clock(seen: Index, it: Finding) -> bool:
    """Return whether a finding is about the time that nodes get."""
    return any(end.type == "rosgraph_msgs/msg/Clock" for end in _ends(seen, it.names))


def in_order(seen: Index, found: Iterable[Finding]) -> list[Finding]:
    """Return the findings by their kind of cause, then by level; notes come last."""
    return sorted(found, key=lambda it: (it.level == NOTE, *_rank(seen, it), it.code))


def _rank(seen: Index, it: Finding) -> tuple[int, int]:
    """Return the sort key of a finding: its kind of cause, and its level."""
    kinds = (at for at, codes in enumerate(_ORDER) if it.code.startswith(codes))
    rank = 0 if is_about_a_clock(seen, it) else next(kinds, len(_ORDER))
    return rank, _BAD.index(it.level)
