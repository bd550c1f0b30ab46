# SPDX-License-Identifier: Apache-2.0
"""Findings -> one for each cause, the likeliest cause first: what another finding explains is folded
below it, and what several nodes do alike, or one node does often, is one line."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.base.bounded import own_rows
from multibot_rewrite.base.findings.finding import (
    ERROR,
    INCONCLUSIVE,
    NOTE,
    WARNING,
    Finding,
    Remap,
)
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.wording import SEVERAL, shorten, unique
from multibot_rewrite.system.index import TF, Index, ends_of
from multibot_rewrite.system.records import PUBLISHES, SERVES


def _names(_: Index, cause: Finding, it: Finding) -> bool:
    return not {*cause.names}.isdisjoint(it.names)


def _robot(_: Index, cause: Finding, it: Finding) -> bool:
    return cause.robot == it.robot


def _served(seen: Index, cause: Finding, it: Finding) -> bool:
    """Return whether the node of the first finding serves what the second is about."""
    return any(end.node == cause.node for name in it.names for end in ends_of(seen, name))


def _same_node(seen: Index, cause: Finding, it: Finding) -> bool:
    """Return whether the first finding's missing node is the second's, robots' names aside."""
    return seen.plain(cause.node) == it.node


def _two_robots(_: Index, cause: Finding, it: Finding) -> bool:
    """Return whether the nodes of a whole robot run twice, and so what they send."""
    return len(cause.names) > 1 and cause.robot == it.robot


def _sends_tf(seen: Index, cause: Finding, it: Finding) -> bool:
    """Return whether the missing node has to send its robot's tf, by the plan."""
    planned = seen.expected.by_node.get(cause.node, ()) if seen.expected else ()
    tf = any((end.type, end.role) == (TF, PUBLISHES) for end in planned)
    return tf and cause.robot == it.robot


def _lacks_tf(seen: Index, cause: Finding, it: Finding) -> bool:
    """Return whether the node of the first finding lacks tf, by the plan."""
    planned = ends_of(seen.expected, cause.names[0]) if seen.expected and cause.names else ()
    return any(end.type == TF for end in planned) and cause.robot == it.robot


def _described(seen: Index, cause: Finding, it: Finding) -> bool:
    """Return whether it is about the robot whose description it is, or whose frames it has."""
    links = (
        link for one in seen.system.descriptions if one.topic in cause.names for link in one.links
    )
    return it.robot in {cause.robot, *map(seen.frame_robot, links)} - {""}


def _clock(seen: Index, cause: Finding, it: Finding) -> bool:
    return is_about_a_clock(seen, cause) and cause.robot == it.robot


# What a cause and what comes of it have in common -> does the first finding explain the second?
_ALIKE = _names, _robot, _served, _same_node, _two_robots, _sends_tf, _lacks_tf, _described, _clock
_IN_COMMON = {"anything": lambda *_: True, **{it.__name__[1:]: it for it in _ALIKE}}
_EXPLAINS = own_rows(__file__, "explains.schema")
# What several nodes have with one name is one of the first, what one node has so often of the second.
_OF_NAMES = frozenset(("MG303", "MG306", "MG307"))
_OF_NODES = {"MG102": 2, "MG304": 3}
_UNPLANNED = "MG108"
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
    """One finding for each cause."""
    by_code = lists_by_key((it.code, at) for at, it in enumerate(found))
    below: dict[int, list[int]] = defaultdict(list)
    gone: set[int] = set()
    for code, codes, common in _EXPLAINS if len(found) > 1 else ():
        causes = [it for it in by_code.get(code, ()) if it not in gone]
        for at in (
            it for other in codes.split() for it in by_code.get(other, ()) if it not in gone
        ):
            # Each robot's cause has it, so that the robots' findings stay one.
            why = [it for it in causes if _IN_COMMON[common](seen, found[it], found[at])]
            for cause in why:
                below[cause].append(at)
            gone.update([at] if why else [])
    left = [
        _with_explained(it, [found[one] for one in below.get(at, ())])
        for at, it in enumerate(found)
        if at not in gone
    ]
    return _without_unplanned(seen, _alike(left))


def _with_explained(it: Finding, explained: Sequence[Finding]) -> Finding:
    """Return a cause with its consequences in the hint, at the worst of their levels."""
    if not explained:
        return it
    first, *others = explained
    more = f", and {shorten(unique(one.code for one in others))}" if others else ""
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


def _alike(found: Iterable[Finding]) -> Iterator[Finding]:
    """Yield the findings; those that several nodes share become one, at the first and worst."""
    groups: dict[tuple[object, ...], list[Finding]] = {}
    for it in found:
        key: tuple[object, ...] = (it,)
        if it.code in _OF_NAMES and it.node:
            key = it.code, it.names
        elif it.code in _OF_NODES and it.node:
            key = it.code, it.node
        groups.setdefault(key, []).append(it)
    for (code, *_), own in groups.items():
        if len(own) == 1 or len(own) < _OF_NODES.get(str(code), 0):
            yield from own
        else:
            yield _one_of(own, str(code))


def _one_of(own: Sequence[Finding], code: str) -> Finding:
    first = min(own, key=lambda it: _BAD.index(it.level))
    others = [it for it in own if it is not first]
    if code in _OF_NAMES:
        same = unique(it.node for it in others if it.node != first.node)
    else:
        same = unique(it.names[0] for it in others if it.names)
    remaps = of_one_target(rule for it in own for rule in it.remaps)
    if any(not it.remaps for it in own):
        remaps = first.remaps
    more = f"; the same for {shorten(same, SEVERAL)}" if same else ""
    names = unique(name for it in (first, *others) for name in it.names)
    return first._replace(message=f"{first.message}{more}", names=names, remaps=remaps)


def _without_unplanned(seen: Index, found: Iterable[Finding]) -> list[Finding]:
    """Return the findings; an unplanned node is named in the error that it causes, if there is one."""
    every = [*found]
    nodes = {it.node: at for at, it in enumerate(every) if it.code == _UNPLANNED}
    gone = set()
    for at, it in enumerate(every) if nodes else ():
        if it.level == ERROR and it.code != _UNPLANNED:
            left = [one for one in _makers(seen, it) if one in nodes and nodes[one] not in gone]
            for node in left:
                gone.add(nodes[node])
                hint = f"{every[at].hint}; {node} is not in the plan"
                every[at] = every[at]._replace(hint=hint)
    return [it for at, it in enumerate(every) if at not in gone]


def _makers(seen: Index, it: Finding) -> Sequence[str]:
    """Return the nodes that send or serve what a finding is about."""
    ends = (end for name in it.names for end in ends_of(seen, name))
    sent = (end.node for end in ends if end.role in (PUBLISHES, SERVES))
    edges = (one for tree in seen.trees for one in tree.edges if one.child in it.names)
    own = (node for edge in edges for node in edge.publishers if seen.robot(node) == it.robot)
    return unique((*sent, *own))


def is_about_a_clock(seen: Index, it: Finding) -> bool:
    """Return whether it is about the time that nodes get."""
    ends = (end for name in it.names for end in ends_of(seen, name))
    return any(end.type == "rosgraph_msgs/msg/Clock" for end in ends)


def in_order(seen: Index, found: Iterable[Finding]) -> list[Finding]:
    """Return the findings by their kind of cause, then by level; notes come last."""
    return sorted(found, key=lambda it: (it.level == NOTE, *_place(seen, it), it.code))


def _place(seen: Index, it: Finding) -> tuple[int, int]:
    kinds = (at for at, codes in enumerate(_ORDER) if it.code.startswith(codes))
    rank = 0 if is_about_a_clock(seen, it) else next(kinds, len(_ORDER))
    return rank, _BAD.index(it.level)
