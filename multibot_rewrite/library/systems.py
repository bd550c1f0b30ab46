# SPDX-License-Identifier: Apache-2.0
"""A system from each of its sources, and what the rules say of one or of two: the library's calls.

They are the functions that ``plan``, ``check-launch``, ``snapshot``, ``check`` and ``doctor`` use.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from multibot_rewrite.base.bounded import MAX_FLEET_BYTES
from multibot_rewrite.base.file_kinds import PLAN, recognised
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.naming import Policy
from multibot_rewrite.base.releases import release_chosen_here
from multibot_rewrite.checks.closed_plan import closed_plan
from multibot_rewrite.checks.judged_plan import make_fleet, plan_fleet
from multibot_rewrite.description.sources.read import Source, read_file
from multibot_rewrite.description.sources.release_said import release_of_launch
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.fleet.fleet import expected, known_nodes
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.planning.plan import read_plan
from multibot_rewrite.producers.snapshot_file import read_snapshots
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.environment import settings
from multibot_rewrite.system.parameters import ANSWER_SECONDS, questions, with_answers
from multibot_rewrite.system.records import Caveat, System

if TYPE_CHECKING:
    from multibot_rewrite.producers.launch.launched import Launched
    from multibot_rewrite.producers.launch.records import LaunchOrder

RELEASE = "release"
NO_ARGUMENTS: Mapping[str, str] = {}
AS_USUAL: Policy = {}
Path = str | os.PathLike[str]


def system_of_description(
    source: Source,
    robots: Sequence[str],
    *,
    node_sets: Sequence[str] = (),
    policy: Policy = AS_USUAL,
    xacro_args: Mapping[str, str] = NO_ARGUMENTS,
    trust: bool = False,
    distro: str = "",
) -> System:
    """Return what robots of a description should run, with the nodes of ``node_sets``: a plan.

    ``policy`` are naming options of ``rewrite``. Raises as ``rewrite_all``, and UsageError for
    an unknown node set."""
    given = (source, robots, node_sets, policy)
    return expected(make_fleet(*given, xacro_args=xacro_args, trust=trust, release=distro))


def system_of_fleet(path: Path, *, trust: bool = False, distro: str = "") -> System:
    """Return what the robots of a fleet file should run: a plan. Raises as ``load_fleet``."""
    file = read_fleet(os.fspath(path), distro, os.environ)
    return expected(closed_plan(plan_fleet(file, trust=trust)))


def system_of_launch(
    path: Path,
    arguments: Mapping[str, str] = NO_ARGUMENTS,
    *,
    roots: Sequence[str] = (),
    trust: bool = False,
    distro: str = "",
) -> System:
    """Return what a launch file would start; raises InputError for one that cannot be read.

    It is a program: with ``trust`` it may do anything, without it only compute and read
    (SECURITY.md). ``roots`` are folders with the sources of packages."""
    from multibot_rewrite.producers.launch.records import LaunchOrder

    order = LaunchOrder(os.fspath(path), tuple(arguments.items()), tuple(roots), trust)
    return launched_by([order], release_chosen_here(distro)).system


def launched_by(
    orders: Sequence[LaunchOrder],
    told: str = "",
    nodes: str | None = None,
    nodl: Sequence[str] = (),
) -> Launched:
    """Return what launch files would start together; raises InputError for one that is unreadable.

    The release is ``told``, or the one that they are for; ``nodes`` and ``nodl`` are the user's
    files."""
    from multibot_rewrite.producers.launch.child import launch_graph
    from multibot_rewrite.producers.launch.known_node import with_sources
    from multibot_rewrite.producers.launch.records import joined
    from multibot_rewrite.producers.launch.running import Knowledge
    from multibot_rewrite.producers.launch.snapshot import launched

    graph = joined([launch_graph(it) for it in orders])
    said = release_of_launch(told, graph.packages, graph.texts, orders[0].file)
    library = known_nodes(nodes, said.release, nodl).library
    parameters = load_known_nodes(nodes or "", said.release)
    known = with_sources(library.nodes, graph.nodes, orders, said.release)
    made = launched(graph, Knowledge(known, parameters, said.release))
    seen = made.system.environment
    why = said.why or "the newest long-term release, as nothing says which; see --distro"
    which = Caveat(RELEASE, False, f"read for ROS 2 {said.release}: {why}")
    environment = seen._replace(caveats=(*([] if told else [which]), *seen.caveats))
    return made._replace(system=made.system._replace(environment=environment))


def system_of_folder(path: Path, *, distro: str = "") -> System:
    """Return what a built folder would start, without its plan; raises InputError for another."""
    from multibot_rewrite.fleet.launch.launch_file import LAUNCH

    return system_of_launch(os.path.join(os.fspath(path), LAUNCH), distro=distro)


def system_of_files(*paths: Path) -> System:
    """Return the system of a plan or of snapshots; raises InputError with file and place."""
    if len(paths) == 1:
        file = os.fspath(paths[0])
        data = read_file(file, MAX_FLEET_BYTES)
        if recognised(data) == PLAN:
            return read_plan(data, file)
    return read_snapshots([os.fspath(it) for it in paths])


def system_of_bag(path: Path) -> System:
    """Return the system in a recording; raises InputError, and MultibotError without extra ``bags``."""
    from multibot_rewrite.producers.bags.read import read_bag
    from multibot_rewrite.producers.bags.recording import as_snapshot

    return as_snapshot(read_bag(os.fspath(path)))


def system_of_graph(
    *, seconds: float = 30.0, domain: int | None = None, states: bool = False
) -> System:
    """Return the running ROS graph, observed until it no longer changes.

    With ``states`` its nodes are asked for theirs. Raises MultibotError if rclpy is missing or
    does not start."""
    from multibot_rewrite.producers.ros.child import ask, observe
    from multibot_rewrite.producers.ros.request import Request

    around = dict(os.environ) | ({} if domain is None else {"ROS_DOMAIN_ID": str(domain)})
    settings(around)
    seen = observe(Request(seconds), around)
    asked = [*questions(seen)] if states else []
    return with_answers(seen, ask(asked, ANSWER_SECONDS, around) if states else (), asked)


def judge(system: System) -> list[Finding]:
    """Return what is wrong with a system, as ``multibot check`` reports it. Raises nothing."""
    return list(diagnose(system).findings)


def compare(plan: System, seen: System) -> list[Finding]:
    """Return where a system differs from its plan, as ``multibot check`` reports it. Raises nothing."""
    return check(plan, seen)
