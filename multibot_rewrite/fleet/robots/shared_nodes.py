"""Nodes of the stacks that run once for all robots of a fleet, as one map_server with one map."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from multibot_rewrite.base.findings.finding import NOTE, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.nearest import did_you_mean_one_of
from multibot_rewrite.fleet.file.fleet_file import FleetFile
from multibot_rewrite.knowledge.records import NodeFacts

MANAGERS = "nav2_lifecycle_manager"
NOT_MANAGED = declare(
    "MF803",
    "shared-node-not-managed",
    NOTE,
    what="A node that all robots share is managed by a lifecycle manager that each robot has; it is "
    "left out of the plan there.",
    why="Each manager configures it: the second one fails, since it is active already, and the whole "
    "bringup of that robot stops.",
    fix="Remove it from node_names of the robots' managers, and start it with a lifecycle manager of "
    "its own.",
    bad="""\
shared_nodes: [map_server]
shared_topics: [/map, /clock, /rosout, /parameter_events, /diagnostics]
layout: both
stack: nav2
robots:
  - {name: robot1, description: robot.urdf}
  - {name: robot2, description: robot.urdf}
""",
    good="""\
layout: both
stack: nav2
robots:
  - {name: robot1, description: robot.urdf}
  - {name: robot2, description: robot.urdf}
""",
    line=1,
    formats=("fleet",),
)


def apart(
    nodes: Sequence[NodeFacts], file: FleetFile
) -> tuple[tuple[NodeFacts, ...], tuple[Finding, ...]]:
    """The nodes, those that all robots share marked; findings about managers that would manage them."""
    if not file.shared_nodes:
        return tuple(nodes), ()
    marked = [it._replace(shared=it.shared or it.name in file.shared_nodes) for it in nodes]
    managers = [it for it in marked if it.package == MANAGERS and not it.shared]
    left = {it.name: _without(it, file.shared_nodes) for it in managers}
    kept = tuple(left.get(it.name, it) for it in marked)
    return kept, tuple(_notes(managers, file))


def _without(manager: NodeFacts, shared: Collection[str]) -> NodeFacts:
    ends = (it for it in manager.endpoints if it.name.partition("/")[0] not in shared)
    return manager._replace(endpoints=tuple(ends))


def _notes(managers: Sequence[NodeFacts], file: FleetFile) -> Iterator[Finding]:
    for it in managers:
        heads = {end.name.partition("/")[0] for end in it.endpoints}
        for name in (name for name in file.shared_nodes if name in heads):
            message = f"{it.name} of each robot manages {name}, which all robots share"
            hint = f"remove {name} from its node_names, and start {name} with a manager of its own"
            yield NOT_MANAGED.finding(message, hint, file=file.file, line=1, column=1)


def check_shared(file: FleetFile, run: Mapping[str, object]) -> None:
    """Raises InputError for a shared node that is not among the nodes that robots ``run``."""
    for name in file.shared_nodes:
        if name not in run:
            near = did_you_mean_one_of(name, tuple(run)) or "name a node of a robot's stack"
            raise InputError(f"{file.file}: shared_nodes: no robot has a node {name!r}; {near}")
