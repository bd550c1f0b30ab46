"""The robots of a fleet file -> their descriptions, rewritten: robots of one source share a parse."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from multibot_rewrite import pipeline
from multibot_rewrite.companions.respell import Names
from multibot_rewrite.fleets.fleet import Member, member
from multibot_rewrite.fleets.fleet_file import RobotSpec
from multibot_rewrite.library import Rewrite, rewrite_all
from multibot_rewrite.model import Finding
from multibot_rewrite.naming import Naming, make_naming
from multibot_rewrite.rewriters.builtin import builtin_tree
from multibot_rewrite.rewriters.forms import Declared
from multibot_rewrite.steps.collect import NOTHING

# Kinds that are names in the ROS graph; the others are the description's own.
GRAPH_KINDS = frozenset({"namespace", "node", "topic", "subtopic", "service", "stem"})


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


def describe(
    robots: Sequence[RobotSpec], policy: Mapping[str, Any], vocabulary: Sequence[str]
) -> list[Described]:
    """Rewrite every robot's description and SRDF, in the order of the robots.

    Raises as ``rewrite_all``.
    """
    groups: dict[object, list[RobotSpec]] = {}
    for robot in robots:
        key = robot.description, robot.srdf, tuple(robot.arguments.items())
        groups.setdefault(key, []).append(robot)
    found = {
        it.spec.name: it
        for group in groups.values()
        for it in _described(group, dict(policy), tuple(vocabulary))
    }
    return [found[robot.name] for robot in robots]


def _described(
    group: Sequence[RobotSpec], policy: dict[str, Any], vocabulary: tuple[str, ...]
) -> Iterator[Described]:
    first, naming, tree = group[0], make_naming(**policy), builtin_tree(vocabulary)
    more: dict[str, Any] = {"vocabulary": vocabulary, "xacro_args": first.arguments}
    robots = [robot.namespace for robot in group]
    texts = list(rewrite_all(first.description, robots, **more, **policy))
    semantics: Sequence[Rewrite | None] = [None] * len(group)
    if first.srdf:
        beside = {**more, "urdf": first.description}
        semantics = list(rewrite_all(first.srdf, robots, **beside, **policy))
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
            member(text, data, robot.spelled, tree),
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
    source: bytes, file: str, robot: str, naming: Naming, template: pipeline.Prepared
) -> bytes:
    # What the second half finds is rewritten already, for another word.
    prepared = pipeline.prepare(source, file, naming, template.tree, template.urdf_declarations)
    return next(pipeline.render(prepared, [robot], again=True))
