"""The robots of a fleet file -> their descriptions, rewritten: robots of one source share a parse."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite import pipeline
from multibot_rewrite.companions.respell import Names
from multibot_rewrite.fleets.fleet import Member, member
from multibot_rewrite.fleets.fleet_file import RobotSpec
from multibot_rewrite.job import Job, read_job
from multibot_rewrite.library import Rewrite, rewrite_job
from multibot_rewrite.model import Finding
from multibot_rewrite.naming import Naming
from multibot_rewrite.rewriters.forms import Declared
from multibot_rewrite.steps.collect import NOTHING

# Kinds that are names in the ROS graph; the others are the description's own.
GRAPH_KINDS = frozenset({"namespace", "node", "topic", "subtopic", "service", "stem"})
# What decides a robot's texts but its names: its description, its SRDF, its xacro arguments.
Sources = tuple[str, str, tuple[tuple[str, str], ...]]


class Jobs(NamedTuple):
    """What is rewritten for the robots of the same sources."""

    description: Job
    srdf: Job | None


class Described(NamedTuple):
    """A robot with its rewritten description and SRDF (empty where it has none).

    ``names`` is the rename map of what it declares, ``topics`` that of its ROS names; ``semantics``
    is what its SRDF declares, not rewritten. ``findings`` are warnings about the source.
    """

    spec: RobotSpec
    description: bytes
    srdf: bytes
    names: Names
    topics: Names
    semantics: Declared
    member: Member
    findings: tuple[Finding, ...]


def read_jobs(
    robots: Sequence[RobotSpec], naming: Naming, vocabulary: Sequence[str]
) -> dict[Sources, Jobs]:
    """Read every description and SRDF once; raises as ``read_job``."""
    found: dict[Sources, Jobs] = {}
    for it in robots:
        if _sources(it) not in found:
            more = it.arguments, vocabulary
            description = read_job(it.description, naming, None, *more)
            srdf = read_job(it.srdf, naming, it.description, *more) if it.srdf else None
            found[_sources(it)] = Jobs(description, srdf)
    return found


def _sources(robot: RobotSpec) -> Sources:
    return robot.description, robot.srdf, tuple(robot.arguments.items())


def describe(robots: Sequence[RobotSpec], jobs: Mapping[Sources, Jobs]) -> list[Described]:
    """Rewrite every robot's description and SRDF, in the order of the robots.

    Raises as ``rewrite_all``.
    """
    groups: dict[Sources, list[RobotSpec]] = {}
    for robot in robots:
        groups.setdefault(_sources(robot), []).append(robot)
    made = (it for key, group in groups.items() for it in _described(group, jobs[key]))
    found = {it.spec.name: it for it in made}
    return [found[robot.name] for robot in robots]


def _described(group: Sequence[RobotSpec], jobs: Jobs) -> Iterator[Described]:
    naming = jobs.description.naming
    robots = [robot.namespace for robot in group]
    texts = rewrite_job(jobs.description, robots)
    semantics: Iterable[Rewrite | None] = [None] * len(group)
    if jobs.srdf:
        semantics = rewrite_job(jobs.srdf, robots)
    for robot, text, semantic in zip(group, texts, semantics, strict=True):
        data = _spelled(text, robot, naming)
        declared = text.template.inventory.declared
        yield Described(
            robot,
            data,
            _spelled(semantic, robot, naming) if semantic else b"",
            Names(declared, naming, robot.spelled),
            Names(declared, naming, robot.namespace),
            semantic.template.inventory.declared if semantic else NOTHING,
            member(text, data, robot.spelled),
            (*text.findings, *(semantic.findings if semantic else ())),
        )


def _spelled(text: Rewrite, robot: RobotSpec, naming: Naming) -> bytes:
    """The text with the robot's two names where each belongs: two rewrites, each proved, where the
    namespace and what is spelled into frames are not one word."""
    if robot.spelled == robot.namespace:
        return text.data
    template = text.template
    source, file = template.inventory.document.source, template.inventory.document.file
    data = _half(source, file, robot.namespace, _kinds(naming, graph=True), template)
    return _half(data, file, robot.spelled, _kinds(naming, graph=False), template)


def _kinds(naming: Naming, graph: bool) -> Naming:
    kept = {kind: it for kind, it in naming.separators.items() if (kind in GRAPH_KINDS) == graph}
    return naming._replace(separators=kept)


def _half(
    source: bytes, file: str, robot: str, naming: Naming, template: pipeline.Template
) -> bytes:
    # What the second half finds is rewritten already, for another word.
    prepared = pipeline.prepare(source, file, naming, template.tree, template.outside)
    return next(pipeline.render(prepared, [robot], again=True))
