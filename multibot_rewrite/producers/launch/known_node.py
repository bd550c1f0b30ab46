# SPDX-License-Identifier: Apache-2.0
"""A launched node -> what is known of it, as this program has it with these arguments."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.rosnames import check_namespace, check_node_name, propose_token
from multibot_rewrite.knowledge.programs import runs
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.producers.launch.deciding import as_started
from multibot_rewrite.producers.launch.programs import programs
from multibot_rewrite.producers.launch.records import LaunchedNode

_CAMEL = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")


def own_name(it: LaunchedNode, facts: NodeFacts | None) -> str:
    """The name that a node has by its code; empty where it is not known."""
    return programs().names.get(f"{it.package}/{it.executable}") or (facts.name if facts else "")


def guessed_name(it: LaunchedNode) -> str:
    """Return a name for a node whose own one nobody knows, by its program, as ROS takes it."""
    return propose_token(_last_word(it))


def check_names(it: LaunchedNode) -> None:
    """Raise InputError where ROS refuses the name or the namespace that a launch file gives a node."""
    fault = check_node_name(it.name) if it.name else None
    what, given = "name", it.name
    if fault is None:
        fault = check_namespace(f"/{it.namespace.strip('/')}")
        what, given = "namespace", it.namespace
    if fault is not None:
        said = f"a node has the {what} {given!r}, which ROS refuses: {fault.reason}"
        raise InputError(f"{it.place}: {said}; write letters, digits and underscores")


def _last_word(it: LaunchedNode) -> str:
    """The program, or the class of a component, without its namespace."""
    return it.executable.rpartition(":")[2].removesuffix(".py")


def _snake(name: str) -> str:
    return _CAMEL.sub("_", name).lower()


def known_node(
    it: LaunchedNode, stack: Sequence[NodeFacts], known: Mapping[str, NodeFacts]
) -> NodeFacts | None:
    """What is known of a node: by its name in a stack, else by its package and executable."""
    executable = _snake(_last_word(it))
    program = f"{it.package}/{it.executable}"
    of_stack = (node for node in stack if node.name == it.name and node.package == it.package)
    wanted = {it.name, it.executable, executable, executable.removesuffix("_node")}
    of_package = (node for node in known.values() if node.package == it.package and not node.host)
    # A component that has a program of its own is called as its class: RectifyNode, rectify_node.
    by_word = (node for node in of_package if {node.name, _snake(node.name)} & wanted)
    chosen = (node for node in known.values() if runs(node, program))
    found = next(of_stack, None) or next(chosen, None) or next(by_word, None)
    return as_started(found, it.executable, it.arguments) if found else None
