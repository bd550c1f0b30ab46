"""Learned nodes as a file of nodes and stacks, proved by reading it as ``--nodes`` does."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from textwrap import wrap

from multibot_rewrite.graph.learning.learn import Learned
from multibot_rewrite.model import ProofError, UsageError
from multibot_rewrite.remap.node_library import NodeLibrary, extend, stack_of
from multibot_rewrite.remap.records import ROLES, Endpoint

HEAD = """\
# Nodes as they were seen in a running graph, written by multibot learn for --nodes.
# The code and the rules of a running node are not seen, only the names they led to:
#   /x   may be x or /x in the code: the rule for /x serves both, in every layout
#   x    was seen in a namespace with the node; if the code says /x and a rule led it there, write /x
#   ~/x  was seen below the node's name; if the code does not say ~/x, write /node/x
# Not seen at all: conditions (when), parameters, frames, nodes that serve all robots (shared: true).
"""
WIDTH = 100
_ENDLESS = 1 << 30


def to_yaml(learned: Sequence[Learned], stack: str, library: NodeLibrary) -> str:
    """The text of a file with the nodes and one stack of them.

    Raises ProofError where reading it does not give the same nodes.
    """
    text = "".join(f"{line}\n" for line in _lines(learned, stack))
    facts = tuple(node.facts for node in learned)
    try:
        read = stack_of(extend(library, text, stack), stack)
    except UsageError as error:
        raise ProofError(f"what was learned cannot be read: {error}") from None
    if read != facts:
        wrong = ", ".join(node.name for node in facts if node not in read)
        raise ProofError(f"what was learned is read as something else: {wrong}")
    return text


def _lines(learned: Sequence[Learned], stack: str) -> Iterator[str]:
    yield from HEAD.splitlines()
    yield from _comment(f"Of: {' '.join(node.seen for node in learned)}", "")
    yield from ("", "nodes:")
    for node in learned:
        yield from _node(node)
        yield ""
    yield from ("stacks:", f"  {_scalar(stack)}:", "    about: Learned from a running graph")
    yield "    nodes:"
    yield from (f"      - {_scalar(node.facts.name)}" for node in learned)


def _node(node: Learned) -> Iterator[str]:
    facts = node.facts
    for remark in node.remarks:
        yield from _comment(remark, "  ")
    yield f"  {_scalar(facts.name)}:"
    yield f"    note: {_scalar(facts.note)}"
    if node.parts:
        yield f"    with: {_flow(list(node.parts))}"
    for role in ROLES:
        own = [end for end in node.own if end.role == role]
        if own:
            yield f"    {role}:"
        yield from (f"      {_scalar(end.name)}: {_value(end)}" for end in own)


def _value(end: Endpoint) -> str:
    """An endpoint's type alone, or all that is known of it."""
    told = {
        "type": end.type,
        "also": list(end.also),
        "transport": end.transport,
        "when": end.when,
        "helper": end.helper,
        "note": end.note,
    }
    there = {key: value for key, value in told.items() if value}
    return _scalar(end.type) if list(there) == ["type"] else _flow(there)


def _scalar(text: str) -> str:
    import yaml

    return str(yaml.safe_dump(text, width=_ENDLESS)).removesuffix("...\n").rstrip("\n")


def _flow(value: object) -> str:
    import yaml

    dumped = yaml.safe_dump(value, width=_ENDLESS, default_flow_style=True, sort_keys=False)
    return str(dumped).rstrip("\n")


def _comment(text: str, indent: str) -> list[str]:
    lead = f"{indent}# "
    return wrap(
        text, WIDTH, initial_indent=lead, subsequent_indent=f"{lead}  ", break_long_words=False
    )
