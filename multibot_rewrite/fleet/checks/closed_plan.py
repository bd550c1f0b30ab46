"""The fleet of a fleet file with what is open in its robots: plan, remap, rehearse and check say it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.gc_pause import gc_paused
from multibot_rewrite.companions.yaml_text import read_yaml
from multibot_rewrite.fleet.checks.closing import closing
from multibot_rewrite.fleet.fleet import Fleet
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.bridge_outputs import bridge_outputs
from multibot_rewrite.fleet.outputs.bridged import BOTH, once
from multibot_rewrite.fleet.outputs.companion_files import companion_files
from multibot_rewrite.fleet.outputs.output_file import OutputFile
from multibot_rewrite.fleet.outputs.output_values import OutputText
from multibot_rewrite.fleet.robots.robot_groups import group_robots
from multibot_rewrite.fleet.robots.with_start_pose_nodes import with_start_pose_nodes
from multibot_rewrite.producers.ends import BRIDGE_FILE, bridge_ends
from multibot_rewrite.system.records import Topic

# Rules about a file that names what the robot does not have.
NAMES_NOTHING = frozenset(
    "MB803 MB804 MB805 MB810 MB853 MB854 MB874 MF127".split()  # noqa: SIM905
)


def closed_plan(plan: FleetPlan) -> Fleet:
    """The fleet with all nodes that are started, and its ``gaps``.

    Raises InputError for a companion that cannot be read or rewritten.
    """
    with gc_paused():
        fleet, few = with_start_pose_nodes(plan), _one_of_each(plan)
        made = [*companion_files(few), *bridge_outputs(few)]
        texts = texts_of(it for it in made if isinstance(it, OutputFile))
        found = [it for it in made if isinstance(it, Finding)]
        found += (it for robot in few.robots for it in robot.findings)
        gaps = gaps_of(plan, fleet, texts, found)
        rows = [it for it in bridge_outputs(plan) if isinstance(it, OutputFile)]
        return fleet._replace(gaps=gaps, bridged=bridged_by(demanded(plan, texts_of(rows))))


def bridged_by(texts: Iterable[OutputText]) -> tuple[Topic, ...]:
    """What the bridge files among the texts carry."""
    files = [it for it in texts if it.path.rpartition("/")[2] == BRIDGE_FILE]
    rows = (end for it in files for end in bridge_ends(read_yaml(it.text.encode(), it.path)))
    return once(
        Topic(end.name, bridge=(end.role,) if end.role else BOTH, type=end.type) for end in rows
    )


def demanded(plan: FleetPlan, texts: Iterable[OutputText]) -> Iterator[OutputText]:
    """The files without the bridges of robots that may be real, and without that of what all share
    where all may be."""
    maybe = plan.fleet.maybe_real
    names = {it.spec.name for it in plan.robots if it.spec.namespace in maybe}
    left = {f"{it}/{BRIDGE_FILE}" for it in names}
    left |= {BRIDGE_FILE} if len(names) == len(plan.robots) else set()
    return (it for it in texts if it.path not in left)


def texts_of(files: Iterable[OutputFile]) -> list[OutputText]:
    """Files of a build as texts."""
    return [OutputText(it.path, it.data.decode("utf-8", "replace"), it.sources) for it in files]


def gaps_of(
    plan: FleetPlan, fleet: Fleet, texts: Sequence[OutputText], of_files: Iterable[Finding]
) -> tuple[Finding, ...]:
    """What is open in the robots of a fleet, by place; ``of_files`` is what was found as ``texts`` were
    made."""
    named = (it for it in of_files if it.code in NAMES_NOTHING)
    found = {*named, *closing(plan, fleet, texts)}
    return tuple(sorted(found, key=lambda it: (it.file, it.line, it.column, it.code, it.message)))


def _one_of_each(plan: FleetPlan) -> FleetPlan:
    """A plan of one robot for each that differs in more than its names: the others close as it does."""
    robots = tuple(it.robots[0] for it in group_robots(plan))
    own = {it.spec.namespace: plan.fleet.inventories[it.spec.namespace] for it in robots}
    return plan._replace(robots=robots, fleet=plan.fleet._replace(inventories=own))
