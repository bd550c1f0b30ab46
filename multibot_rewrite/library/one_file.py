# SPDX-License-Identifier: Apache-2.0
"""Rewrites a related file of a description for robots without a fleet file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.arguments import checked
from multibot_rewrite.base.conventions import ROWS, SHARED_TOPICS, WORLD_FRAMES
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import DEFAULT_LAYOUT, Naming, make_naming
from multibot_rewrite.base.releases import release_here
from multibot_rewrite.base.rosnames import check_robot_names
from multibot_rewrite.base.wording import plural
from multibot_rewrite.description.rewriters.model_namespaces import given_topics, words_of
from multibot_rewrite.description.sources.job import Job, read_jobs, read_whole
from multibot_rewrite.description.sources.read import Source
from multibot_rewrite.related_files.context import Context, make_context
from multibot_rewrite.related_files.formats import kind_alone, read_named, rewrite_alone
from multibot_rewrite.related_files.named_file import NamedFile
from multibot_rewrite.related_files.names.rename_map import KINDS, NO_OWN, related_file_names
from multibot_rewrite.rules.files.judge import judged_once
from multibot_rewrite.rules.files.wheels import with_description

# Code -> what is counted and what is said of it. A file with one of these findings is not verified.
REASONS = {code: (" ".join(what), said) for (code, *what), said in ROWS["reasons"]}
_DECLARED = frozenset(it for kinds in KINDS.values() for it in kinds)
# Kinds of names that are spelled without a description.
_IN_GRAPH = frozenset(("topic", "service"))


class RewrittenFile(NamedTuple):
    """A file as one robot needs it, with its kind (params, rviz, moveit, bridge, tree, lua).

    ``not_verified`` says why robots may collide all the same; it is empty if verified."""

    robot: str
    kind: str
    data: bytes
    findings: tuple[Finding, ...]
    not_verified: tuple[str, ...]

    @property
    def text(self) -> str:
        """The result as str; raises nothing."""
        return self.data.decode()


@checked
def rewrite_file(
    source: Source,
    robot: str,
    *,
    urdf: Source | None = None,
    layout: str = DEFAULT_LAYOUT,
    affix: str | None = None,
    topics: str | None = None,
    separators: Mapping[str, str] | None = None,
    shared_frames: Iterable[str] = WORLD_FRAMES,
    shared_topics: Iterable[str] = SHARED_TOPICS,
    groups: str = "keep",
    xacro_args: Mapping[str, str] | None = None,
    definitions: Iterable[str] = (),
    file: str = "",
    trust: bool = False,
    distro: str = "",
) -> RewrittenFile:
    """Rewrite a related file of a description for ``robot``, by what is in it.

    Kinds are parameters, RViz, MoveIt, ros_gz_bridge, behavior trees of Nav2, Cartographer's
    Lua. ``urdf`` is the robot's description, not rewritten; the other options are those of
    ``rewrite``. Raises InputError (cannot be read), UsageError (a wrong argument, or a
    description is needed)."""
    naming = make_naming(layout, affix, topics, separators, shared_frames, shared_topics, groups)
    given = (urdf, xacro_args, definitions, file, trust, release_here(distro))
    return next(_rewritten_files(source, (robot,), naming, *given))


@checked
def rewrite_files(
    source: Source,
    robots: Iterable[str],
    *,
    urdf: Source | None = None,
    layout: str = DEFAULT_LAYOUT,
    affix: str | None = None,
    topics: str | None = None,
    separators: Mapping[str, str] | None = None,
    shared_frames: Iterable[str] = WORLD_FRAMES,
    shared_topics: Iterable[str] = SHARED_TOPICS,
    groups: str = "keep",
    xacro_args: Mapping[str, str] | None = None,
    definitions: Iterable[str] = (),
    file: str = "",
    trust: bool = False,
    distro: str = "",
) -> Iterator[RewrittenFile]:
    """Yield the file for several robots; raises as ``rewrite_file``, before the first result.

    What a bridge carries for all, such as the clock, is in the file of the first."""
    naming = make_naming(layout, affix, topics, separators, shared_frames, shared_topics, groups)
    given = (urdf, xacro_args, definitions, file, trust, release_here(distro))
    return _rewritten_files(source, tuple(robots), naming, *given)


def names_in_file(data: bytes, file: str, urdf: bytes) -> NamedFile:
    """Return the names in a related file of the description ``urdf``; raises as ``rewrite_file``."""
    naming, release = make_naming(), release_here("")
    job = read_jobs(["r"], urdf, naming, None, None, (), "", False, release)["r"]
    return read_named(kind_alone(data, file), data, file, _context_of_job(job, naming, release))


def _rewritten_files(
    source: Source,
    robots: Sequence[str],
    naming: Naming,
    urdf: Source | None,
    xacro_args: Mapping[str, str] | None,
    definitions: Iterable[str],
    file: str,
    trust: bool,
    release: str,
) -> Iterator[RewrittenFile]:
    check_robot_names(robots)
    read = read_whole(source, {}, trust)
    name = file or read.file
    kind = kind_alone(read.data, name)
    jobs: Mapping[str, Job] = {}
    if urdf is not None:
        given = (xacro_args, definitions, "", trust, release)
        jobs = read_jobs(robots, urdf, naming, None, *given)
    contexts = {it: _context_of_job(jobs.get(it), naming, release) for it in robots}
    if urdf is None:
        # Without a description only files whose names do not rest on one can be rewritten.
        context = contexts[robots[0]]
        spelled = (_DECLARED - _IN_GRAPH).intersection(context.names.naming.separators)
        named = read_named(kind, read.data, name, context)
        shared = context.names.naming.shared_frames
        rests = (it for it in named.names if not spelled.isdisjoint(KINDS.get(it.kind, ())))
        found = next((it for it in rests if it.text.strip("/") not in shared), None)
        if found:
            what = f"{name}:{found.line} names the {found.kind} {found.text!r}"
            raise UsageError(f"{what}; give the robot's description with --urdf")
    made = [
        _file_for_robot(kind, read.data, name, it, robots, contexts[it], jobs.get(it))
        for it in robots
    ]
    return iter(made)


def _context_of_job(job: Job | None, naming: Naming, release: str) -> Context:
    if job is None:
        return make_context({kind: {} for kind in _DECLARED}, naming, (), release)
    described, own = job.inventories[0], job.own.plain or NO_OWN
    made = words_of(described.claims), given_topics(described.claims)
    in_full = described.topics_in_full
    names = related_file_names(described.declared, job.naming, "", own, in_full=in_full)
    return make_context(names.declared, job.naming, (), release, names.own, *made)


def _file_for_robot(
    kind: str,
    data: bytes,
    file: str,
    robot: str,
    robots: Sequence[str],
    context: Context,
    job: Job | None,
) -> RewrittenFile:
    made = rewrite_alone(kind, data, file, context, robot, robots.index(robot))
    named = made.file._replace(
        robots=frozenset(robots), own=frozenset(robots if len(robots) == 1 else ())
    )
    named = with_description(named, job.inventories[0].document) if job else named
    findings = tuple(dict.fromkeys((*made.findings, *judged_once(named))))
    ordered = tuple(sorted(findings, key=lambda it: (it.line, it.column, it.code)))
    counted = Counter(it.code for it in findings)
    reasons = [
        f"{plural(counted[code], what)} {why}"
        for code, (what, why) in REASONS.items()
        if counted[code]
    ]
    if made.kept:
        reasons.append(f"{plural(made.kept, 'name')} not the robot's")
    return RewrittenFile(robot, kind, made.text.encode(), ordered, tuple(reasons))
