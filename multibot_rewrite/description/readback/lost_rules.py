"""Remap rules that matched a name of their plugin before a rewrite, and match none after it."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.rosnames import expand
from multibot_rewrite.description.readback.nodes import ReadEndpoint, ReadNode, full_name, itself
from multibot_rewrite.description.readback.reading import Reading


class LostRule(NamedTuple):
    """A rule, the full name that it was for, and the plugin: the ``number``-th of the file."""

    number: int
    rule: str
    name: str


def lost_rules(before: Reading, after: Reading) -> Iterator[LostRule]:
    """Each rule once for each name."""
    now = {node.number: node for node in after.nodes}
    for node in before.nodes:
        if node.rules and node.number in now:
            yield from dict.fromkeys(_lost(node, now[node.number]))


def _lost(node: ReadNode, new: ReadNode) -> Iterator[LostRule]:
    for old, end in zip(node.endpoints, new.endpoints, strict=False):
        name, at = _applied(node, old)
        if at is None:
            continue
        now = _applied(new, end)[1]
        # An inserted rule may do its work: /tf:=x for tf:=x, which is another name in a namespace.
        if now is None or new.rules[now].rule.target != new.rules[at].rule.target:
            rule = node.rules[at].rule
            yield LostRule(node.number, f"{rule.source}:={rule.target}", name)


def _applied(node: ReadNode, end: ReadEndpoint) -> tuple[str, int | None]:
    """The full name of an endpoint without rules for topics, and the number of the one that gives it
    another; None where it keeps its own.

    Those of ``<remapping>`` are counted from the end: what is inserted stands before them.
    """
    bound = itself(node)
    name = full_name(end.name, end.kind, bound)
    sources = [expand(it.rule.source, bound.namespace, bound.node) for it in node.rules]
    if end.full == name or name not in sources:
        return name, None
    at = sources.index(name)
    return name, at if node.rules[at].tag == "argument" else at - len(sources)
