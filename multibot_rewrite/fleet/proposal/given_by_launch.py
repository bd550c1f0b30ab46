# SPDX-License-Identifier: Apache-2.0
"""What launch files themselves give to nodes that a fleet starts: parameters in their text, and remap
rules. A fleet has neither, so ``init`` names them.
"""

from __future__ import annotations

import ast
import os
from collections.abc import Collection, Iterable, Iterator
from itertools import pairwise

from multibot_rewrite.fleet.proposal.searching import text_of
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.knowledge.stacks import load_stack

_ACTIONS = ("Node", "LifecycleNode", "ComposableNode")
# What a build gives each node anyway, or what is of one machine.
_USUAL = frozenset(
    ("use_sim_time", "robot_description", "autostart", "node_names", "yaml_filename")
)
_USUAL_TOPICS = frozenset(("tf", "tf_static", "robot_description"))


def given_by_launch(
    launch: Iterable[str], stacks: Iterable[str], release: str
) -> Iterator[tuple[str, int, str]]:
    """File, line and what it is, for the nodes of these stacks; of launch files in Python, as far as it
    stands in them. A file that Python cannot parse has none."""
    nodes = [node for stack in stacks for node in load_stack(stack, release)]
    names = {word for node in nodes for word in _called(node)}
    for path in (it for it in launch if it.endswith(".py")):
        for call in _calls(text_of(path)):
            given = {it.arg: it.value for it in call.keywords if it.arg}
            who = _word(given.get("name")) or _word(given.get("executable"))
            own = {who, _word(given.get("executable"))}
            said = [*_parameters(given.get("parameters")), *_rules(given.get("remappings"))]
            if said and own & names:
                yield path, call.lineno, f"{who}: {', '.join(said)}"


def _called(node: NodeFacts) -> Collection[str]:
    return {os.path.basename(node.name), *map(os.path.basename, node.programs)}


def _calls(text: str) -> Iterator[ast.Call]:
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError):
        return
    for it in ast.walk(tree):
        named = it.func if isinstance(it, ast.Call) else None
        name = getattr(named, "id", "") or getattr(named, "attr", "")
        if isinstance(it, ast.Call) and name in _ACTIONS:
            yield it


def _word(it: ast.expr | None) -> str:
    found = it.value if isinstance(it, ast.Constant) else ""
    return found if isinstance(found, str) else ""


def _parameters(it: ast.expr | None) -> Iterator[str]:
    for each in it.elts if isinstance(it, ast.List | ast.Tuple) else ():
        for key in each.keys if isinstance(each, ast.Dict) else ():
            if _word(key) and _word(key) not in _USUAL:
                yield _word(key)


def _rules(it: ast.expr | None) -> Iterator[str]:
    for each in it.elts if isinstance(it, ast.List | ast.Tuple) else ():
        words = [_word(one) for one in each.elts] if isinstance(each, ast.Tuple) else []
        yield from (f"{a}:={b}" for a, b in pairwise(words) if a and b and _is_moved(a))


def _is_moved(topic: str) -> bool:
    return topic.rpartition("/")[2] not in _USUAL_TOPICS
