"""What one rewrite works on: everything it depends on but the robots, read once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property
from typing import NamedTuple

from multibot_rewrite import pipeline
from multibot_rewrite.naming import Naming
from multibot_rewrite.rewriters.builtin import builtin_tree
from multibot_rewrite.rewriters.forms import Declared
from multibot_rewrite.rewriters.tree import Tree
from multibot_rewrite.sources.read import Source, args_for, read_source
from multibot_rewrite.steps.collect import NOTHING


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
    def outside(self) -> Declared:
        """What the URDF beside an SRDF declares; raises InputError."""
        return pipeline.declarations(*self.urdf, self.tree) if self.urdf else NOTHING


def read_job(
    source: Source,
    naming: Naming,
    urdf: Source | None = None,
    xacro_args: Mapping[str, str] | None = None,
    vocabulary: Iterable[str] = (),
    file: str = "",
) -> Job:
    """Read the sources; raises InputError, and UsageError for arguments that no xacro takes."""
    args = xacro_args or {}
    data, name = read_source(source, args_for(source, urdf, args))
    beside = None if urdf is None else read_source(urdf, args_for(urdf, source, args))
    return Job(data, file or name, naming, tuple(vocabulary), beside)


class Prepared:
    """A job and its template. A copy and a pickle hold the job alone: lxml's elements cannot be
    copied to another process, and the template is made again when something asks for it."""

    def __init__(self, job: Job) -> None:
        self.job = job

    @cached_property
    def template(self) -> pipeline.Prepared:
        """The description ready for any number of robots; raises as ``pipeline.prepare``."""
        data, file, naming, _, urdf = self.job
        tree = self.job.tree
        beside = pipeline.prepare(*urdf, naming, tree).inventory.declared if urdf else NOTHING
        return pipeline.prepare(data, file, naming, tree, beside)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Prepared) and self.job == other.job

    def __hash__(self) -> int:
        return hash((self.job.file, self.job.data))

    def __repr__(self) -> str:
        return f"Prepared({self.job.file!r})"

    def __reduce__(self) -> tuple[type[Prepared], tuple[Job]]:
        return Prepared, (self.job,)
