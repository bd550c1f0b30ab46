"""A snapshot beside its plan, and what the rules say of it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from difflib import get_close_matches
from typing import NamedTuple

from multibot_rewrite.graph.expectation import Expectation
from multibot_rewrite.graph.snapshot import GraphEndpoint, Snapshot

INCONCLUSIVE = "inconclusive"


class GraphFinding(NamedTuple):
    """Something wrong in the graph: what was expected, what is seen, and the likely cause.

    ``level`` is ``error``, ``warning`` or ``inconclusive``.
    """

    code: str
    level: str
    robot: str
    node: str
    message: str
    cause: str

    def __str__(self) -> str:
        cause = f" ({self.cause})" if self.cause else ""
        who = self.node or self.robot or "graph"
        return f"{who}: {self.level}: {self.code} {self.message}{cause}"


class View(NamedTuple):
    """A snapshot beside the plan, with the look-ups that several rules need."""

    plan: Expectation
    graph: Snapshot
    by_node: dict[str, list[GraphEndpoint]]
    by_name: dict[str, list[GraphEndpoint]]
    robot_of: dict[str, str]


def make_view(plan: Expectation, graph: Snapshot) -> View:
    """The look-ups, made once."""
    by_node: dict[str, list[GraphEndpoint]] = defaultdict(list)
    by_name: dict[str, list[GraphEndpoint]] = defaultdict(list)
    for endpoint in graph.endpoints:
        by_node[endpoint.node].append(endpoint)
        by_name[endpoint.name].append(endpoint)
    robot_of = {node: robot.name for robot in plan.robots for node in robot.nodes}
    return View(plan, graph, by_node, by_name, robot_of)


def owner(name: str, plan: Expectation) -> str:
    """The robot whose name stands in a graph name: a segment, or one end of a segment."""
    segments = name.strip("/").split("/")
    names = sorted((robot.name for robot in plan.robots), key=len, reverse=True)
    for robot in names:
        if robot in segments:
            return robot
    for robot in names:
        if any(s.endswith(f"_{robot}") or s.startswith(f"{robot}_") for s in segments):
            return robot
    return ""


def nearest(name: str, known: Iterable[str]) -> str:
    """The known name most like ``name``, or an empty string."""
    return next(iter(get_close_matches(name, list(known), 1, 0.6)), "")
