# SPDX-License-Identifier: Apache-2.0
"""The calls that launch files and scripts use; the commands use them too."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

from multibot_rewrite.base.arguments import checked
from multibot_rewrite.base.conventions import SHARED_TOPICS, WORLD_FRAMES
from multibot_rewrite.base.findings.finding import WARNING, Finding, RewriteRefused
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import Change
from multibot_rewrite.base.naming import DEFAULT_LAYOUT, leaves_world_systems, make_naming
from multibot_rewrite.base.releases import RELEASES, release_chosen_here
from multibot_rewrite.base.rosnames import check_robot_name, check_robot_names
from multibot_rewrite.description import pipeline
from multibot_rewrite.description.checks.meeting import not_verified, said_of
from multibot_rewrite.description.checks.problem import to_findings
from multibot_rewrite.description.readback.meeting import OPENED
from multibot_rewrite.description.rewriters.plugin_definitions.grammar import split_opens
from multibot_rewrite.description.sources.job import Job, read_job, read_jobs
from multibot_rewrite.description.sources.own_names import filled
from multibot_rewrite.description.sources.read import Source, is_xacro
from multibot_rewrite.description.sources.world_systems import left_to_world, put_back
from multibot_rewrite.description.steps.apply import Template
from multibot_rewrite.description.steps.collect import NOTHING, collect
from multibot_rewrite.description.steps.document import Document, read_document

if TYPE_CHECKING:
    from multibot_rewrite.description.reports.explain import Explanation, OnLine


class Prepared:
    """A job and its template; copies and pickles hold the job alone and make the template again."""

    def __init__(self, job: Job) -> None:
        self.job = job

    @cached_property
    def template(self) -> Template:
        """The description ready for any number of robots; raises as ``pipeline.prepare``."""
        job = self.job
        naming, urdf, tree = job.naming, job.urdf, job.tree
        beside = pipeline.prepare(*urdf, naming, tree).inventory.declared if urdf else NOTHING
        return pipeline.prepare(job.data, job.file, naming, tree, beside, job.own)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Prepared) and self.job == other.job

    def __hash__(self) -> int:
        return hash((self.job.file, self.job.data))

    def __repr__(self) -> str:
        return f"Prepared({self.job.file!r})"

    def __reduce__(self) -> tuple[type[Prepared], tuple[Job]]:
        return Prepared, (self.job,)


class Rewrite(NamedTuple):
    """A description as one robot needs it.

    ``data`` are the output bytes, ``text`` the same as str (for ``robot_description``).
    ``findings`` are warnings about the input. ``changes`` lists every renamed and inserted value.
    It can be compared, copied and pickled.
    """

    robot: str
    data: bytes
    findings: tuple[Finding, ...]
    prepared: Prepared

    @property
    def template(self) -> Template:
        """The template of the text; a copy makes it again and raises as ``rewrite``."""
        return self.prepared.template

    @property
    def text(self) -> str:
        """The output as str; raises nothing."""
        return self.data.decode()

    @property
    def not_verified(self) -> tuple[str, ...]:
        """Why robots may collide, with counts; empty if the rewrite is verified. Raises nothing."""
        return not_verified(self.findings)

    @property
    def not_proved(self) -> tuple[str, ...]:
        """Why robots may collide, for scripts written for 0.2; raises nothing."""
        return self.not_verified

    @property
    def distro(self) -> str:
        """The ROS 2 release whose facts it was made with; raises nothing."""
        return self.prepared.job.release

    @property
    def changes(self) -> list[Change]:
        """Every renamed, inserted or numbered value, in source order; raises as ``template`` does."""
        # Few ask for it.
        from multibot_rewrite.description.own_ports import number_changes
        from multibot_rewrite.description.steps.apply import list_changes

        every = list_changes(self.template, self.robot)
        return sorted([*every, *number_changes(self.template, self.data)])


@checked
def rewrite(
    source: Source,
    robot: str,
    *,
    layout: str = DEFAULT_LAYOUT,
    affix: str | None = None,
    topics: str | None = None,
    separators: Mapping[str, str] | None = None,
    shared_frames: Iterable[str] = WORLD_FRAMES,
    shared_topics: Iterable[str] = SHARED_TOPICS,
    groups: str = "keep",
    urdf: Source | None = None,
    xacro_args: Mapping[str, str] | None = None,
    definitions: Iterable[str] = (),
    again: bool = False,
    file: str = "",
    trust: bool = False,
    distro: str = "",
    world_systems: str | None = None,
) -> Rewrite:
    """Rewrite a robot description for ``robot`` and prove it; ``.not_verified`` says what is open.

    ``source`` is a path (str or PathLike), XML text (a str that starts with ``<``), bytes, an open file
    or a parsed element (lxml, ElementTree); a path ending in ``.xacro`` is expanded. The options are
    those of ``rewrite_all``. In a launch file:

        parameters=[{"robot_description": rewrite("rover.urdf", "robot1").text}]

    Raises InputError (cannot be read), UsageError (a wrong argument or robot name), RewriteRefused
    (the content does not allow it; ``.findings``), DefinitionsError, ProofError.
    """
    naming = make_naming(layout, affix, topics, separators, shared_frames, shared_topics, groups)
    check_robot_name(robot)
    given = (urdf, xacro_args, definitions, file, [robot], trust)
    aside = leaves_world_systems(world_systems, [robot])
    job = read_job(source, naming, *given, release=release_chosen_here(distro), aside=aside)
    return next(rewrite_job(job, [robot], again))


@checked
def rewrite_all(
    source: Source,
    robots: Iterable[str],
    *,
    layout: str = DEFAULT_LAYOUT,
    affix: str | None = None,
    topics: str | None = None,
    separators: Mapping[str, str] | None = None,
    shared_frames: Iterable[str] = WORLD_FRAMES,
    shared_topics: Iterable[str] = SHARED_TOPICS,
    groups: str = "keep",
    urdf: Source | None = None,
    xacro_args: Mapping[str, str] | None = None,
    definitions: Iterable[str] = (),
    again: bool = False,
    file: str = "",
    trust: bool = False,
    distro: str = "",
    world_systems: str | None = None,
) -> Iterator[Rewrite]:
    """Rewrite one description for several robots: one parse, then about a copy of the text each.

    ``layout`` is a name of ``multibot_rewrite.base.naming.LAYOUTS``, such as tf-per-robot or
    postfix; ``affix`` is postfix or prefix, ``topics`` is postfix, prefix or namespace (default:
    what the layout implies); ``separators`` maps kinds to separators; ``groups`` is keep or rename:
    what becomes of an SRDF's groups and end effectors; ``urdf`` is the description an SRDF belongs
    to; ``xacro_args`` are the arguments of a xacro, ``{robot}`` in them is the robot's name: what
    they name after the robot stays as it is, and each robot is an expansion of its own;
    ``definitions`` are definition files in addition to the built-in one; ``again`` allows a second
    rewrite; ``file`` is the name used in messages; ``trust`` lets xacro files do anything: without
    it they only compute, and read what is near them (SECURITY.md); ``distro`` is the ROS 2 release
    that the robots run (default: ROS_DISTRO, else what is sourced, else what the description loads,
    else the newest LTS); ``world_systems`` is keep or leave: leave makes comments of the systems
    that the world has to load once, as Sensors (default: keep for one robot, leave for several, and
    a note says what to load). Raises as ``rewrite`` does, before the first result."""
    naming = make_naming(layout, affix, topics, separators, shared_frames, shared_topics, groups)
    names = check_robot_names(robots)
    given = (urdf, xacro_args, definitions, file, trust, release_chosen_here(distro))
    jobs = read_jobs(names, source, naming, *given, leaves_world_systems(world_systems, names))
    return _with_own_ports(rewrite_jobs(jobs, again))


def _with_own_ports(made: Iterator[Rewrite]) -> Iterator[Rewrite]:
    """Yield rewrites in which each of several robots has its own ports, if their use is known."""
    first = next(made, None)
    served = first.template.inventory.served if first else ()
    words = (word for _, section in served for word in section.opens)
    if first is None or not any(split_opens(it).step for it in words):
        return chain(() if first is None else (first,), made)
    every = [first, *made]
    if len(every) == 1:
        return iter(every)
    from multibot_rewrite.description.own_ports import judged_together  # few descriptions have any

    texts, said = judged_together(first.template, {it.robot: it.data for it in every})
    return (
        it._replace(
            data=text, findings=(*(old for old in it.findings if old.code != OPENED), *said)
        )
        for it, text in zip(every, texts, strict=True)
    )


def rewrite_job(job: Job, robots: Sequence[str], again: bool = False) -> Iterator[Rewrite]:
    """Rewrite a job for some robots; raises as ``rewrite_all``."""
    check_robot_names(robots)
    prepared = Prepared(job)
    template = prepared.template
    left = left_to_world(template.inventory.document, job.aside)
    unread: Iterable[Finding] = ()
    if job.read.unread:
        from multibot_rewrite.description.checks.references import unread_arguments

        document = template.inventory.document
        found = unread_arguments(document.root, job.read.unread, job.read.arguments)
        unread = to_findings(document, found, WARNING, of_file=True)
    findings = (*unread, *left, *said_of(next(iter(robots), ""), template.findings))
    texts = pipeline.render(template, robots, again)
    # Nothing here holds a text while the next one is made: it may take the same memory.
    return (Rewrite(robot, next(texts), findings, prepared) for robot in robots)


def rewrite_jobs(jobs: Mapping[str, Job], again: bool = False) -> Iterator[Rewrite]:
    """Rewrite the job of each robot, in their order; raises as ``rewrite_all``."""
    if not jobs:
        return iter(())
    groups = lists_by_key((id(job), robot) for robot, job in jobs.items())
    if len(groups) == 1:
        return rewrite_job(next(iter(jobs.values())), tuple(jobs), again)
    made = {
        it.robot: it
        for robots in groups.values()
        for it in rewrite_job(jobs[robots[0]], robots, again)
    }
    pipeline.check_apart({robot: it.template for robot, it in made.items()})
    return iter([made[robot] for robot in jobs])


@checked
def explain(
    source: Source,
    line: int,
    robot: str = "robot1",
    *,
    layout: str = DEFAULT_LAYOUT,
    affix: str | None = None,
    topics: str | None = None,
    separators: Mapping[str, str] | None = None,
    shared_frames: Iterable[str] = WORLD_FRAMES,
    shared_topics: Iterable[str] = SHARED_TOPICS,
    groups: str = "keep",
    urdf: Source | None = None,
    xacro_args: Mapping[str, str] | None = None,
    definitions: Iterable[str] = (),
    file: str = "",
    trust: bool = False,
    distro: str = "",
) -> list[Explanation]:
    """Return what is known about the values that start on ``line``, and their names for ``robot``.

    Of a xacro it is about the values that something on this line makes, and from which pieces: an
    element, the call of a macro, a property. Of a file that others include, it is what the line makes
    in one of them. The options are those of ``rewrite_all``. A description that a rewrite refuses is
    explained all the same. Raises InputError, UsageError and DefinitionsError as ``rewrite`` does.
    """
    naming = make_naming(layout, affix, topics, separators, shared_frames, shared_topics, groups)
    check_robot_name(robot)
    release = release_chosen_here(distro)
    # A rewrite does not need it.
    from multibot_rewrite.description.reports.explain import explain_line, explain_source

    given = (naming, urdf, xacro_args, definitions, file, [robot], trust)

    def explaining(whole: Source) -> tuple[Document, OnLine]:
        """Return the document of a description, and a function that explains a line of it."""
        job = read_job(whole, *given, release=release)
        document = read_document(job.data, job.file)
        inventory = collect(document, job.tree, job.urdf_declarations, job.naming.read_as)
        pipeline.check_urdf(inventory, job.urdf_declarations)
        return document, partial(explain_line, inventory, job.naming, job.tree, robot)

    if isinstance(source, bytes) or not is_xacro(os.fspath(source)):
        return explaining(source)[1](line)
    arguments = filled(xacro_args or {}, robot)
    return explain_source(os.fspath(source), line, arguments, trust, explaining)


@checked
def strip(
    source: Source,
    robot: str,
    *,
    layout: str = DEFAULT_LAYOUT,
    affix: str | None = None,
    topics: str | None = None,
    separators: Mapping[str, str] | None = None,
    shared_frames: Iterable[str] = WORLD_FRAMES,
    shared_topics: Iterable[str] = SHARED_TOPICS,
    groups: str = "keep",
    urdf: Source | None = None,
    xacro: Source | None = None,
    xacro_args: Mapping[str, str] | None = None,
    definitions: Iterable[str] = (),
    file: str = "",
    trust: bool = False,
    distro: str = "",
) -> bytes:
    """Undo ``rewrite`` from the rewritten text alone, and prove it by rewriting again.

    The options are those that the text was rewritten with; ``urdf`` is the rewritten description
    that a rewritten SRDF belongs to. Where arguments named the robot, ``xacro`` is the file and
    ``xacro_args`` are the arguments: what they named stays, so the result is that xacro's
    expansion. Raises as ``rewrite`` does.
    """
    naming = make_naming(layout, affix, topics, separators, shared_frames, shared_topics, groups)
    check_robot_name(robot)
    refused: RewriteRefused | None = None
    # What said the release, as its package, need not be beside the rewritten description.
    for release in (release_chosen_here(distro), *(() if distro else RELEASES)):
        job = read_job(source, naming, urdf, None, definitions, file, (), trust, release=release)
        before = b""
        if xacro is not None:
            made, beside = (xacro, None) if urdf is None else (source, xacro)
            of = read_job(
                made, naming, beside, xacro_args, definitions, "", [robot], trust, release=release
            )
            job, before = job._replace(naming=of.naming), b"" if beside else of.data
        source, file, urdf_names = job.data, job.file, job.urdf_declarations
        try:
            made = pipeline.strip(source, file, robot, job.naming, job.tree, urdf_names, before)
            return put_back(made, file, job.tree)
        except RewriteRefused as error:
            refused = refused or error
    raise refused or AssertionError
