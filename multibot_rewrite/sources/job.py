"""What one rewrite works on: everything it depends on but the robots, read once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from multibot_rewrite.naming import Naming
from multibot_rewrite.rewriters.builtin import builtin_tree
from multibot_rewrite.rewriters.forms import Declared
from multibot_rewrite.rewriters.tree import Tree
from multibot_rewrite.sources.read import Source, args_for, read_source
from multibot_rewrite.steps.collect import NOTHING, declarations


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
    xacro_args: Mapping[str, str] | None = None,
    vocabulary: Iterable[str] = (),
    file: str = "",
    trust: bool = False,
) -> Job:
    """Read the sources; raises InputError, and UsageError for arguments that no xacro takes.

    ``trust`` lets xacro files do anything.
    """
    args = xacro_args or {}
    data, name = read_source(source, args_for(source, urdf, args), trust)
    beside = None if urdf is None else read_source(urdf, args_for(urdf, source, args), trust)
    return Job(data, file or name, naming, tuple(vocabulary), beside)
