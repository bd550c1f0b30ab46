# SPDX-License-Identifier: Apache-2.0
"""Learned nodes as a file of nodes and stacks, checked by reading it as ``--nodes`` does."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from textwrap import wrap

from multibot_rewrite.base.model import ProofError, UsageError
from multibot_rewrite.knowledge.node_library import NodeLibrary, extend, stack_of
from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.live.learning.learn import LearnedNode
from multibot_rewrite.system.records import ROLES

HEAD = """\
# Nodes as they were seen in a running graph, written by multibot snapshot for --nodes.
# The code and the remap rules of a running node are not visible, only the resulting names:
#   /x   may be x or /x in the code: the rule for /x is right for both, in every layout
#   x    was seen in the node's namespace; if the code has /x and a rule remapped it, write /x
#   ~/x  was seen below the node's name; if the code does not have ~/x, write /node/x
# Not visible: conditions (when), parameters, frames, nodes that serve all robots (shared: true).
"""
WIDTH = 100
_NO_WRAP = 1 << 30


def to_yaml(learned: Sequence[LearnedNode], stack: str, library: NodeLibrary) -> str:
    """The text of a file with the nodes and one stack of them.

    Raises ProofError if reading it does not give the same nodes.
    """
    text = "".join(f"{line}\n" for line in _lines(learned, stack))
    facts = tuple(node.facts for node in learned)
    try:
        found = stack_of(extend(library, text, stack), stack)
    except UsageError as error:
        raise ProofError(f"the learned nodes cannot be read back: {error}") from None
    # Frames are those of known parameters: the file says nothing of either.
    read = tuple(it._replace(frames=()) for it in found)
    if read != facts:
        wrong = ", ".join(node.name for node in facts if node not in read)
        raise ProofError(f"the learned nodes are read back differently: {wrong}")
    return text


def _lines(learned: Sequence[LearnedNode], stack: str) -> Iterator[str]:
    yield from HEAD.splitlines()
    yield from _comment(f"Of: {' '.join(node.seen for node in learned)}", "")
    yield from ("", "nodes:")
    for node in learned:
        yield from _node(node)
        yield ""
    yield from ("stacks:", f"  {_scalar(stack)}:", "    about: Learned from a running graph")
    yield "    nodes:"
    yield from (f"      - {_scalar(node.facts.name)}" for node in learned)


def _node(node: LearnedNode) -> Iterator[str]:
    facts = node.facts
    for remark in node.remarks:
        yield from _comment(remark, "  ")
    yield f"  {_scalar(facts.name)}:"
    yield f"    note: {_scalar(facts.note)}"
    yield from ["    apart: true"] * facts.apart
    if node.parts:
        yield f"    with: {_flow(list(node.parts))}"
    for role in ROLES:
        own = [end for end in node.own if end.role == role]
        if own:
            yield f"    {role}:"
        yield from (f"      {_scalar(end.name)}: {_value(end)}" for end in own)


def _value(end: Endpoint) -> str:
    """An endpoint's type alone, or all that is known of it."""
    fields = {
        "type": end.type,
        "also": list(end.also),
        "transport": end.transport,
        "when": end.when,
        "helper": end.helper,
        "note": end.note,
    }
    known = {key: value for key, value in fields.items() if value}
    return _scalar(end.type) if list(known) == ["type"] else _flow(known)


def _scalar(text: str) -> str:
    import yaml

    return str(yaml.safe_dump(text, width=_NO_WRAP)).removesuffix("...\n").rstrip("\n")


def _flow(value: object) -> str:
    import yaml

    dumped = yaml.safe_dump(value, width=_NO_WRAP, default_flow_style=True, sort_keys=False)
    return str(dumped).rstrip("\n")


def _comment(text: str, indent: str) -> list[str]:
    lead = f"{indent}# "
    return wrap(
        text, WIDTH, initial_indent=lead, subsequent_indent=f"{lead}  ", break_long_words=False
    )
