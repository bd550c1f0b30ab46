# SPDX-License-Identifier: Apache-2.0
"""The robots of a fleet file with their rewritten descriptions; one parse for each source."""

from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from functools import cache
from types import MappingProxyType
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import ERROR, NOTE, Finding, Rule, declare
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import without_comments
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import Naming
from multibot_rewrite.description import pipeline
from multibot_rewrite.description.checks.references import UNREAD
from multibot_rewrite.description.checks.twice import CARRYING
from multibot_rewrite.description.library import Rewrite, rewrite_job
from multibot_rewrite.description.own_ports import numbered, ports_of
from multibot_rewrite.description.readback.meeting import NUMBERED, SHARED_CODES
from multibot_rewrite.description.rewriters.model_namespaces import given_topics, words_of
from multibot_rewrite.description.sources.job import (
    PARTS,
    FilesRead,
    Job,
    Reader,
    job_for,
    joined_reads,
    reader,
)
from multibot_rewrite.description.sources.own_names import ROBOT, Arguments, common_to, filled
from multibot_rewrite.description.sources.read import is_xacro
from multibot_rewrite.description.steps.apply import Template
from multibot_rewrite.description.steps.collect import NOTHING
from multibot_rewrite.fleet.file.robot_spec import REAL, RobotSpec, Sources
from multibot_rewrite.fleet.file.simulator_switch import hardware_classes, may_be_simulated
from multibot_rewrite.fleet.launch.launched_robot import launch_of
from multibot_rewrite.fleet.robots.member import Member, member, with_text
from multibot_rewrite.fleet.robots.own_values import Written
from multibot_rewrite.planning.transforms import links_of, tree_of
from multibot_rewrite.producers.launch.describe import CLASSIC, SIMULATORS
from multibot_rewrite.related_files.names.rename_map import (
    RelatedNames,
    related_file_names,
    with_srdf,
)
from multibot_rewrite.system.records import Edge

# Kinds that are ROS names and get the namespace; the others get the tag.
GRAPH_KINDS = frozenset({"namespace", "node", "topic", "subtopic", "service", "stem"})


class Jobs(NamedTuple):
    """The description, SRDF and simulated model to rewrite for robots of the same sources."""

    description: Job
    srdf: Job | None
    simulated: Job | None = None


# The rule about such names, and what to do.
PREFIX_ONLY = "MB422"
SET_PREFIX = "its plugin can only put the robot's name in front of names: set affix: prefix"

# The rules about single names.
_LOOSE = ("MB803", "MB804", "MB807")
# Fewer names are mistakes in an SRDF that is meant.
_FEWEST = 3


NO_SYSTEMS: Mapping[str, str] = MappingProxyType({})


# How the files of the plugins of Gazebo Classic begin.
CLASSIC_PLUGIN = b"libgazebo_ros"


class RewrittenRobot(NamedTuple):
    """A robot with its rewritten description and SRDF (empty if it has none).

    ``names`` is the rename map of frames, joints and planning groups, ``topics`` that of ROS names.
    ``findings`` are warnings about the source. ``simulated`` is the model for the simulator,
    empty where that is the description. ``world_systems`` are plugins that were in it, by library, and
    are loaded by the world. ``is_classic``: its simulator is Gazebo Classic.
    """

    spec: RobotSpec
    description: bytes
    srdf: bytes
    names: RelatedNames
    topics: RelatedNames
    member: Member
    findings: tuple[Finding, ...]
    simulated: bytes = b""
    world_systems: Mapping[str, str] = NO_SYSTEMS
    is_classic: bool = False

    @property
    def written(self) -> Written:
        """The file that it is made of, and the arguments that it gets."""
        path = self.spec.simulated or self.spec.description
        return Written(path, filled(self.spec.arguments, self.spec.name))

    @property
    def tree(self) -> list[Edge]:
        """The transforms that its robot_state_publisher sends."""
        return list(tree_of(self.member.described, self.names.naming, self.spec.tag))

    @property
    def links(self) -> list[str]:
        """The links of the robot, as frames."""
        return links_of(self.member.described, self.names.naming, self.spec.tag)

    @property
    def frame_prefix(self) -> str:
        """What its robot_state_publisher puts before the links; empty where they have its name."""
        return f"{self.spec.tag}/" if self.names.naming.layout.at_run_time else ""

    @property
    def needs_prefix(self) -> bool:
        """Return whether a plugin puts a prefix before names, and the layout has a postfix."""
        return any(it.code == PREFIX_ONLY for it in self.findings)


def at_robot(
    rule: Rule, robot: RewrittenRobot, message: str, hint: str, level: str = ""
) -> Finding:
    """Return a finding of ``rule`` at the robot's line of the fleet file, at its level if not given."""
    level, spec = level or rule.level, robot.spec
    return rule.finding(message, hint, level=level, file=spec.file, line=spec.line)


def read_jobs(
    robots: Sequence[RobotSpec],
    naming: Naming,
    definitions: Sequence[str],
    trust: bool,
    release: str,
) -> dict[Sources, Jobs]:
    """Return the jobs of each description and SRDF, read once; ``trust``: xacro without sandbox."""

    @cache
    def read_in(source: str, urdf: str | None, file: str) -> Reader:
        return reader(source, naming, urdf, tuple(definitions), file, trust, release)

    def read(robot: RobotSpec, path: str, urdf: str = "") -> Reader:
        """Return the reader of one of a robot's files, which may be made for it."""
        made = dict(robot.filled)
        text, beside = made.get(path, path), made.get(urdf, urdf) or None
        return read_in(text, beside, path if path in made else "")

    found: dict[Sources, Jobs] = {}
    given_to = lists_by_key((it.description, (it.arguments, it.words)) for it in robots)
    common = {source: common_to(each) for source, each in given_to.items()}
    for it in robots:
        if it.sources not in found:
            found[it.sources] = _jobs(it, read, (it.words, common[it.description]))
    own = {it.sources[:3]: it for it in robots if found[it.sources].description.naming.own}
    for it in robots:
        first = own.get(it.sources[:3])
        # An argument that makes names of one robot is not for another one.
        if first and not found[it.sources].description.naming.own:
            both = (
                f"{it.name!r} has the arguments of {first.name!r}, which put that name into names"
            )
            raise InputError(f"{it.file}:{it.line}: {both}; write {ROBOT} in its place")
    return found


def _jobs(
    it: RobotSpec, read: Callable[..., Reader], words: tuple[Sequence[str], Set[str]]
) -> Jobs:
    """Return the jobs of a robot's files; an argument may be for one of them alone."""
    taken = _taken_arguments(it, it.description, it.srdf)
    description = job_for(read(it, it.description), taken, *words)
    srdf = job_for(read(it, it.srdf, it.description), taken, *words) if it.srdf else None
    # The SRDF is read beside the description.
    description = description._replace(read=(srdf or description).read)
    model = None
    if it.simulated:
        model = job_for(read(it, it.simulated), _taken_arguments(it, it.simulated), *words)
        both = joined_reads(description.read, model.read)
        description, model = description._replace(read=both), model._replace(read=both)
    if it.parts:
        files = FilesRead((*description.read.files, *it.files))
        description = description._replace(read=files)
    return Jobs(description, srdf, model)


def _taken_arguments(robot: RobotSpec, *files: str) -> Arguments:
    """Return the arguments for a robot's description or model, if one of these is a xacro."""
    return robot.arguments if any(map(is_xacro, files)) else {}


def rewrite_robots(
    robots: Sequence[RobotSpec], jobs: Mapping[Sources, Jobs]
) -> list[RewrittenRobot]:
    """Rewrite every robot's description and SRDF, in their order; raises as ``rewrite_all``."""
    # One that says nothing of a simulator is in that of the others.
    groups = lists_by_key((robot.sources, robot) for robot in robots)
    made = (it for key, group in groups.items() for it in _rewritten_group(group, jobs[key]))
    found = {it.spec.name: it for it in made}
    classic = any(it.is_classic for it in found.values())
    alike = [
        it._replace(is_classic=it.is_classic or (classic and not _names_simulator(it)))
        for it in (found[robot.name] for robot in robots)
    ]
    return [*map(_in_launched_simulator, alike)]


def _in_launched_simulator(it: RewrittenRobot) -> RewrittenRobot:
    """Return a robot in the simulator that its launch files start, if they start one."""
    nodes = launch_of(it.spec.launch, it.spec.words[0]).nodes if it.spec.launch else ()
    kinds = {node.package == CLASSIC for node in nodes if node.package in SIMULATORS}
    return it._replace(is_classic=kinds.pop()) if len(kinds) == 1 else it


def _names_simulator(it: RewrittenRobot) -> bool:
    """Return whether its description has what one simulator alone loads: plugins, hardware, SDF."""
    root = it.member.inventory.document.root
    parts = any(root.find(f"gazebo//{it}") is not None for it in ("plugin", "sensor"))
    return root.tag == "sdf" or parts or any(map(may_be_simulated, hardware_classes(root)))


def _rewritten_group(group: Sequence[RobotSpec], jobs: Jobs) -> Iterator[RewrittenRobot]:
    naming, own = jobs.description.naming, jobs.description.own.plain
    if jobs.srdf:
        own = {**jobs.srdf.own.plain, **own}
    texts = _namespaced_texts(jobs.description, group)
    nothing = [None] * len(group)
    semantics = _namespaced_texts(jobs.srdf, group) if jobs.srdf else nothing
    models = _namespaced_texts(jobs.simulated, group) if jobs.simulated else nothing
    for robot, text, semantic, model in zip(group, texts, semantics, models, strict=True):
        data = _final_description(text, robot, naming)
        made, simulated = member(text, data, robot.tag, robot.simulator == REAL), b""
        said = semantic.template.inventory.declared if semantic else NOTHING
        declared = with_srdf(text.template.inventory.declared, said)
        found = (*text.findings, *(_srdf_findings(semantic) if semantic else ()))
        if model and jobs.simulated:
            both = model.template.inventory.declared
            declared = {
                kind: {**both.get(kind, {}), **declared.get(kind, {})}
                for kind in {*declared, *both}
            }
            simulated = _final_description(model, robot, jobs.simulated.naming)
            found = (*found, *model.findings)
            made = member(model, simulated, robot.tag, described=made)
        simulated_parts = (model or text).template.inventory
        claims, in_full = simulated_parts.claims, simulated_parts.topics_in_full
        more = words_of(claims), in_full, given_topics(claims)
        names = related_file_names(declared, naming, robot.tag, own, *more)
        yield RewrittenRobot(
            robot,
            data,
            _final_description(semantic, robot, naming) if semantic else b"",
            names,
            names._replace(robot=robot.namespace),
            made._replace(name=robot.name),
            # These the fleet says, of the robots that it has.
            tuple(it for it in found if it.code not in (*SHARED_CODES, UNREAD)),
            simulated,
            is_classic=CLASSIC_PLUGIN in without_comments(simulated or data),
        )


def _srdf_findings(semantic: Rewrite) -> Iterator[Finding]:
    """Yield the findings of an SRDF; a single one if most of its links and joints are missing."""
    # Then it was not written for its URDF.
    named = {
        (kind, name.text): name.kind
        for names in semantic.template.inventory.names
        for name in names
        for kind in (name.kind or name.kinds[0],)
        if kind in PARTS
    }
    missing = [text for (_, text), kind in named.items() if not kind]
    loose = [it for it in semantic.findings if it.code in _LOOSE]
    if len(missing) < _FEWEST or 2 * len(missing) <= len(named) or not loose:
        yield from semantic.findings
        return
    message = f"{len(missing)} of the {len(named)} links and joints that the SRDF names are not in "
    message += f"the URDF: {missing[0]}, {missing[1]} and others"
    first = min(loose, key=lambda it: it.line)
    hint = "; ".join((*filter(None, [first.hint]), "give both the same arguments:"))
    place = {"file": first.file, "line": first.line, "column": first.column}
    yield OF_ANOTHER_ROBOT.finding(message, hint, **place)
    yield from (it for it in semantic.findings if it.code not in _LOOSE)


def _namespaced_texts(job: Job, group: Sequence[RobotSpec]) -> Iterator[Rewrite]:
    """Yield the text of each robot; raises if it has one of the robot's names already."""
    # A namespace of several levels is no robot's name: its text is made from its halves alone.
    words = [it.tag if "/" in it.namespace else it.namespace for it in group]
    for number, text in enumerate(rewrite_job(job, words, again=True)):
        if not number:
            # A robot's namespace and tag may be in names that get the other word.
            apart = [it for it in group if it.tag != it.namespace]
            alike = [it.namespace for it in group if it.tag == it.namespace]
            pipeline.check_new(text.template, alike, CARRYING)
            pipeline.check_new(text.template, [it.namespace for it in apart], GRAPH_KINDS)
            pipeline.check_new(text.template, [it.tag for it in apart], CARRYING - GRAPH_KINDS)
        yield text._replace(robot=group[number].namespace)


def _final_description(text: Rewrite, robot: RobotSpec, naming: Naming) -> bytes:
    """Return the description of a robot; if namespace and tag differ, two rewrites, each verified."""
    if robot.tag == robot.namespace:
        return text.data
    template = text.template
    source, file = template.inventory.document.source, template.inventory.document.file
    data = _half_text(source, file, robot.namespace, _naming_of_kinds(naming, graph=True), template)
    return _half_text(data, file, robot.tag, _naming_of_kinds(naming, graph=False), template)


def _naming_of_kinds(naming: Naming, graph: bool) -> Naming:
    kept = {kind: it for kind, it in naming.separators.items() if (kind in GRAPH_KINDS) == graph}
    return naming._replace(separators=kept)


def _half_text(source: bytes, file: str, robot: str, naming: Naming, template: Template) -> bytes:
    """Return a description rewritten with one half of the naming."""
    # The second rewrite finds names that the first one has rewritten for the other word.
    prepared = pipeline.prepare(source, file, naming, template.tree, template.urdf_declarations)
    return next(pipeline.render(prepared, [robot], again=True))


# The rule for related files says the same of one alone.
OF_ANOTHER_ROBOT = declare("MB875", "file-of-another-robot", ERROR, formats=("fleet",))
OWN_PORTS = declare(NUMBERED, "own-ports", NOTE, formats=("fleet",))


def with_own_ports(robots: Sequence[RewrittenRobot]) -> list[RewrittenRobot]:
    """Return the robots with ports that no earlier one has; the first that changes has the note."""
    sources = [it.member.inventory.document.source for it in robots]
    made = numbered(
        {
            it.spec.name: (
                text,
                () if it.spec.simulator == REAL else [*ports_of(it.member.inventory)],
            )
            for it, text in zip(robots, sources, strict=True)
        }
    )
    every = [
        it if new == old else robot_with_text(it, new)
        for it, old, new in zip(robots, sources, made.texts, strict=True)
    ]
    first = next((n for n, old in enumerate(sources) if old != made.texts[n]), 0)
    if made.notes:
        said = (at_robot(OWN_PORTS, every[first], *it) for it in made.notes)
        every[first] = every[first]._replace(findings=(*every[first].findings, *said))
    return every


def robot_with_text(robot: RewrittenRobot, data: bytes) -> RewrittenRobot:
    """Return the robot with another text of what its simulator gets."""
    robot = robot._replace(member=with_text(robot.member, data))
    return robot._replace(simulated=data) if robot.simulated else robot._replace(description=data)
