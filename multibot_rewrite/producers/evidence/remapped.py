# SPDX-License-Identifier: Apache-2.0
"""A known node under the remap rules of a launch file, or of the plugin that loads it."""

from __future__ import annotations

from collections.abc import Iterable

from multibot_rewrite.base.rosnames import RemapRule, expand
from multibot_rewrite.knowledge.controller_ways import controller_way
from multibot_rewrite.knowledge.records import NodeFacts

_TF = ("/tf", "/tf_static")


def remapped(node: NodeFacts, rules: Iterable[tuple[str, str]], namespace: str) -> NodeFacts:
    """The node with the remap rules of its launch file, started in a namespace; those of tf belong to
    the layout."""
    above = namespace.rstrip("/")
    below, _, name = node.name.rpartition("/")
    home = above.removesuffix(f"/{below}") if below else above
    targets = {
        expand(old, above, name): _target(new, above, home)
        for old, new in reversed([it for it in rules if it[0] not in _TF])
    }
    ends = []
    for it in node.endpoints:
        target = targets.get(expand(it.name, above, name), it.name)
        ends.append(it._replace(remapped=target) if target != it.name else it)
    return node._replace(endpoints=tuple(ends))


def under_plugin(node: NodeFacts, rules: Iterable[RemapRule], release: str) -> NodeFacts:
    """A controller under the rules of the plugin that loads it, where these reach it."""
    if not (node.is_controller and controller_way(release).of_manager):
        return node
    own = node.name.rpartition("/")[2]
    mine = ((it.source, it.target) for it in rules if it.node in ("", own))
    return remapped(node, mine, "")


def _target(new: str, above: str, home: str) -> str:
    """The target of a rule as its robot has it, of a node in the namespace ``above`` whose robot is in
    ``home``."""
    inner = above != home and not new.startswith(("/", "~"))
    full = f"{above}/{new}" if inner else new
    mine = full.removeprefix(f"{home}/") if home else full
    # From a namespace in that of the robot, only this leads to the robot's.
    return f"/{mine}" if above != home and mine[0] not in "/~" else mine
