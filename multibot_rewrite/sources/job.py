"""What one rewrite works on: everything it depends on but the robots, read once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from functools import partial
from typing import NamedTuple

from multibot_rewrite.model import InputError, UsageError
from multibot_rewrite.naming import Naming, OwnNames
from multibot_rewrite.rewriters.builtin import builtin_tree
from multibot_rewrite.rewriters.forms import Declared
from multibot_rewrite.rewriters.tree import Tree
from multibot_rewrite.sources.own_names import (
    ROBOT,
    Arguments,
    filled,
    marked,
    name_robot,
    own_names,
)
from multibot_rewrite.sources.read import Source, args_for, read_source
from multibot_rewrite.steps.collect import NOTHING, collect, declarations
from multibot_rewrite.steps.document import read_document


class Job(NamedTuple):
    """Bytes, options and file names; ``file`` is the name in messages, ``urdf`` the bytes and the
    name of the URDF beside an SRDF. It holds no parsed document, so it can be pickled."""

    data: bytes
    file: str
    naming: Naming
    vocabulary: tuple[str, ...]
    urdf: tuple[bytes, str] | None

    @property
    def tree(self) -> Tree:
        """The rewriters; raises VocabularyError."""
        return builtin_tree(self.vocabulary)

    @property
    def urdf_declarations(self) -> Declared:
        """What the URDF beside an SRDF declares; raises InputError."""
        return declarations(*self.urdf, self.tree) if self.urdf else NOTHING


def read_job(
    source: Source,
    naming: Naming,
    urdf: Source | None = None,
    xacro_args: Arguments | None = None,
    vocabulary: Iterable[str] = (),
    file: str = "",
    words: Sequence[str] = (),
    trust: bool = False,
) -> Job:
    """Read the sources; raises InputError, and UsageError for arguments that no xacro takes.

    ``words`` are those of the robot that the job is for: the first one is filled into the arguments,
    and what they name after any of the words is the robot's own. ``trust`` lets xacro files do
    anything.
    """
    given = xacro_args or {}
    read = partial(_read, source, naming, urdf, tuple(vocabulary), file, trust)
    job = read(filled(given, *words[:1]))
    if not name_robot(given, words):
        return job
    return job._replace(naming=naming._replace(own=_own_names(read, given, words)))


def read_jobs(
    robots: Sequence[str],
    source: Source,
    naming: Naming,
    urdf: Source | None,
    xacro_args: Arguments | None,
    vocabulary: Iterable[str],
    file: str,
    trust: bool = False,
) -> dict[str, Job]:
    """The job of each robot: one for all that the arguments do not name. Raises as ``read_job``."""
    given = xacro_args or {}
    read = partial(read_job, source, naming, urdf, given, tuple(vocabulary), file, trust=trust)
    named = [robot for robot in robots if name_robot(given, [robot])]
    others = [robot for robot in robots if robot not in named]
    jobs = {robot: read(words=[robot]) for robot in named}
    if others:
        _check_meant(given, {robot: job for robot, job in jobs.items() if job.naming.own}, others)
        jobs |= dict.fromkeys(others, read(words=others[:1]))
    return {robot: jobs[robot] for robot in robots}


def _check_meant(given: Arguments, own: Iterable[str], others: Sequence[str]) -> None:
    """An argument that makes names of one robot is not for another one."""
    for robot in own:
        values = [
            f"{name}:={text}" for name, text in given.items() if name_robot({name: text}, [robot])
        ]
        hint = " ".join(values).replace(robot, ROBOT)
        what = f"{' '.join(values)} puts {robot} into names"
        raise UsageError(f"{what}, and {others[0]} gets it, too; write {hint}")


def _read(
    source: Source,
    naming: Naming,
    urdf: Source | None,
    vocabulary: tuple[str, ...],
    file: str,
    trust: bool,
    args: Arguments,
) -> Job:
    data, name = read_source(source, args_for(source, urdf, args), trust)
    beside = None if urdf is None else read_source(urdf, args_for(urdf, source, args), trust)
    return Job(data, file or name, naming, vocabulary, beside)


def _own_names(
    read: Callable[[Arguments], Job], given: Arguments, words: Sequence[str]
) -> OwnNames:
    """The names that the arguments make of the robot's words, found with other words in their place."""
    with suppress(InputError):
        return _marked_names(read(marked(given, words)), words)
    # Some file takes only words that it knows for one of them.
    found: OwnNames = {}
    plain = filled(given, words[0])
    for name, text in marked(given, words).items():
        with suppress(InputError):
            found = {**found, **_marked_names(read({**plain, name: text}), words)}
    return found


def _marked_names(job: Job, words: Sequence[str]) -> OwnNames:
    inventories = [collect(read_document(job.data, job.file), job.tree, job.urdf_declarations)]
    if job.urdf:
        inventories.append(collect(read_document(*job.urdf), job.tree))
    return {key: None for it in inventories for key in own_names(it, words)}
