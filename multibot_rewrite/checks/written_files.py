# SPDX-License-Identifier: Apache-2.0
"""What the rules of files find in a fleet's files, and in written MoveIt files and bridges."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence

from multibot_rewrite.base.findings.finding import ERROR, NOTE, Finding, Rule
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_file import (
    FilesAndFindings,
    FilesToCheck,
    OutputFile,
    ReadFile,
    line_in_source,
    without_slots,
)
from multibot_rewrite.fleet.outputs.world_file import world_topics
from multibot_rewrite.fleet.robots.member import line_of
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.robot_groups import RobotGroup
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.planning.bridged_topics import DIRECTIONS, bridged_topics
from multibot_rewrite.producers.ends import BRIDGE_FILE
from multibot_rewrite.producers.evidence.parameter_files import given_nodes
from multibot_rewrite.related_files.context import Context
from multibot_rewrite.related_files.moveit.file_kind import SIMPLE
from multibot_rewrite.related_files.named_file import BRIDGE, MOVEIT, PARAMS, NamedFile
from multibot_rewrite.related_files.params.sections import PARAMETERS
from multibot_rewrite.rules.files.bridges import GzTopic, GzTopics, no_gz_topic
from multibot_rewrite.rules.files.controllers import undeclared_controller
from multibot_rewrite.rules.files.judge import codes, judged, judged_once
from multibot_rewrite.rules.files.section_facts import Beside
from multibot_rewrite.rules.files.wheels import with_description
from multibot_rewrite.system.records import NOWHERE, Place


def checked(plan: FleetPlan, made: FilesToCheck) -> FilesAndFindings:
    """Yield the files and the findings, and for each file to check what the rules find in it."""
    for it in made:
        yield from wrong_in_file(plan, *it) if isinstance(it, ReadFile) else (it,)


def wrong_in_file(
    plan: FleetPlan, file: NamedFile, robots: Sequence[RewrittenRobot]
) -> list[Finding]:
    """Return what all rules find in a file for some robots, with what the fleet knows."""
    known = load_known_nodes(plan.file.nodes, plan.file.distro)
    words = {name for it in plan.robots for name in (it.spec.namespace, it.spec.tag)}
    own = frozenset(robots[0].spec.words if len(robots) == 1 else ())
    evidence = plan.evidence_of(robots[0])
    file.memo[Beside] = Beside(evidence.given, evidence.known)
    whole = with_description(file, robots[0].member.source)
    sent = file.sent | known.sent
    found = judged_once(whole._replace(robots=frozenset(words), own=own, sent=sent))
    return [without_slots(it, robots[0].spec) for it in found]


def of_files(found: Iterable[Finding]) -> set[Finding]:
    """Return the findings of the rules for files that are more than a note."""
    asked = codes()
    return {it for it in found if it.code in asked and it.level != NOTE}


def written_findings(
    plan: FleetPlan, group: RobotGroup, texts: Sequence[OutputFile], known: Collection[Finding]
) -> Iterator[Finding]:
    """Yield faults of a robot's written files, at their sources; errors if the rewrite made them.

    ``known`` is what was found in the sources."""
    robot, context = group.robots[0], group.context
    own = [it for it in texts if it.path.startswith(f"{robot.spec.name}/") and it.sources]
    bridges = [it for it in own if it.path == f"{robot.spec.name}/{BRIDGE_FILE}"]
    memo: dict[object, object] = {GzTopics: GzTopics(_gz_topics(plan, robot) if bridges else {})}
    for text in bridges:
        yield from _findings_of_rule(no_gz_topic, BRIDGE, text, context, memo)
    opened = {it.file for it in known if it.code == undeclared_controller.code}
    moveit = [it for it in own if SIMPLE in it.text and opened.isdisjoint(it.sources)]
    # What the parameter files of the robot set as they are written.
    parameters = (it.yaml for it in own if moveit and PARAMETERS in it.text)
    given = given_nodes(parameters, load_known_nodes(plan.file.nodes, plan.file.distro))
    memo = {Beside: Beside(tuple(given), plan.evidence_of(robot).known)}
    for text in moveit:
        kind = PARAMS if PARAMETERS in text.text else MOVEIT
        for it in _findings_of_rule(undeclared_controller, kind, text, context, memo):
            yield it._replace(level=ERROR)


def _findings_of_rule(
    rule: Rule, kind: str, text: OutputFile, context: Context, memo: dict[object, object]
) -> Iterator[Finding]:
    written = NamedFile(kind, text.path, text.text, context, memo, document=text.yaml)
    for it in judged(written, [rule]):
        file, line = line_in_source(text, it.line)
        yield it._replace(file=file, line=line, column=1)


def _gz_topics(plan: FleetPlan, robot: RewrittenRobot) -> dict[str, GzTopic]:
    own = {robot.spec.namespace: robot.member.inventory}
    topics, _ = bridged_topics(own, plan.fleet.naming, plan.fleet.models)
    # The topic of each sensor -> its line in the source: inserted text moves those of the result.
    sensors = robot.member.inventory.document.root.iter("sensor")
    source, lines = robot.member.source, {}
    for number, sensor in enumerate(sensors):
        if topic := text_at(sensor, "topic"):
            lines[f"/{topic.lstrip('/')}"] = Place(source.file, line_of(source, "sensor", number))
    world = world_topics(plan.file.simulator_world).items()
    found = {it: GzTopic(type_, DIRECTIONS["in"] if type_ else "") for it, type_ in world}
    for it in topics:
        name = f"/{it.gz.lstrip('/')}"
        bases = [one for one in lines if name == one or name.startswith(f"{one}/")]
        place = lines[max(bases, key=len)] if bases else NOWHERE
        found[name] = GzTopic(it.gz_type, it.direction, place)
    return found
