# SPDX-License-Identifier: Apache-2.0
"""Dangers of what only one process can have: a device, a port or a file that two robots name."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding
from multibot_rewrite.rules import of_both
from multibot_rewrite.rules.places import see, where
from multibot_rewrite.system.index import Index
from multibot_rewrite.system.records import CALIBRATION, COMPUTER, DEVICE, OWN, Address

_ADVICE = {
    DEVICE: "one device has one driver: give each robot its own",
    CALIBRATION: "each device has its own: name the file that was measured with this one",
    COMPUTER: "the second one on a computer cannot open it: give each robot its own, or a computer",
    OWN: "only one node can have it: give each robot its own",
}


def _one_device(seen: Index) -> Iterator[Finding]:
    """All that two nodes of two robots have, by kind, at the second one."""
    first: dict[tuple[str, str, str], Address] = {}
    met: dict[tuple[str, str, str], list[tuple[Address, Address]]] = defaultdict(list)
    for it in seen.system.addresses:
        other = first.setdefault((it.kind, it.name, it.value), it)
        if seen.robot(it.node) != seen.robot(other.node):
            met[it.kind, it.node, other.node].append((other, it))
    for (kind, node, other_node), pairs in met.items():
        given = ", ".join(f"{it.name} {it.value}" for _, it in pairs)
        yield one_device.finding(
            f"has the same as {other_node}: {given}", _ADVICE[kind] + see(pairs[0]),
            level=NOTE if kind == COMPUTER else WARNING,
            robot=seen.robot(node), node=node, names=(other_node,), **where(pairs[0]),
        )  # fmt: skip


one_device = of_both.ONE_DEVICE._replace(check=_one_device)
