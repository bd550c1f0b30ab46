# SPDX-License-Identifier: Apache-2.0
"""What one rewrite works on: everything it depends on but the robots, read once."""

import re
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from functools import cache
from typing import NamedTuple

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.naming import MODEL, SEPARATORS, Naming, OwnNames
from multibot_rewrite.base.releases import ROS_2
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.tree import Tree, builtin_tree
from multibot_rewrite.description.sources.dialect import ros_shown
from multibot_rewrite.description.sources.own_names import (
    OF_ALL,
    Arguments,
    OwnSource,
    as_twin,
    filled,
    has_mark,
    marked,
    marked_texts,
    name_robot,
    own_affixes,
    own_names,
    own_texts,
    templates,
)
from multibot_rewrite.description.sources.read import JOIN, Source, SourceText, args_for, read_alone
from multibot_rewrite.description.sources.release_said import release_said
from multibot_rewrite.description.sources.world_systems import set_aside
from multibot_rewrite.description.steps.apply import cut, fill
from multibot_rewrite.description.steps.collect import (
    NOTHING,
    Inventory,
    collect,
    declarations,
    values_with_own_model,
)
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.description.steps.plan import make_plan

# What an SRDF names of its URDF.
PARTS = frozenset({"link", "joint"})
_MODEL = lazy_compile(rb"""<(?:robot|model)\b[^<>]*?\sname\s*=\s*["']([^"'<]+)["']""")
# A value that may name the model, as its declaration does.
_IN_VALUE = rb"""(?:>\s*|["'/])%s(?:\s*<|["'/]|::)"""


class FilesRead(NamedTuple):
    """The files read for a job, the xacro arguments they know, and given ones that none knows."""

    files: tuple[str, ...] = ()
    arguments: tuple[str, ...] = ()
    unread: tuple[str, ...] = ()


NO_FILES = FilesRead()


def joined_reads(one: FilesRead, other: FilesRead) -> FilesRead:
    """Return the files and arguments read for two descriptions of one robot."""
    known = dict.fromkeys((*one.arguments, *other.arguments))
    unread = dict.fromkeys(it for it in (*one.unread, *other.unread) if it not in known)
    return FilesRead((*one.files, *other.files), tuple(known), tuple(unread))


class Job(NamedTuple):
    """All that a rewrite depends on but the robots: bytes, options and names; it can be pickled.

    ``file`` is the name in messages; ``urdf`` bytes and name of the URDF of an SRDF; ``own`` is
    of a source made for one robot; ``why`` is the reason for the release; ``aside`` are names
    and texts of the systems that the world has to load."""

    data: bytes
    file: str
    naming: Naming
    definitions: tuple[str, ...]
    urdf: tuple[bytes, str] | None
    release: str
    why: str = ""
    ros: str = ""
    own: OwnSource = OF_ALL
    read: FilesRead = NO_FILES
    aside: tuple[tuple[str, str], ...] = ()

    @property
    def tree(self) -> Tree:
        """The rewriters; raises DefinitionsError."""
        return builtin_tree(self.definitions, self.release, self.ros)

    @property
    def urdf_declarations(self) -> Declared:
        """What the URDF of an SRDF declares; raises InputError."""
        return declarations(*self.urdf, self.tree) if self.urdf else NOTHING

    @property
    def inventories(self) -> list[Inventory]:
        """What is in the description, and in the URDF of an SRDF; raises InputError."""
        tree, layout = self.tree, self.naming.read_as
        own = collect(read_document(self.data, self.file), tree, self.urdf_declarations, layout)
        urdf = [collect(read_document(*self.urdf), tree, layout=layout)] if self.urdf else []
        return [own, *urdf]


def read_whole(source: Source, xacro_args: Mapping[str, str], trust: bool = False) -> SourceText:
    """Return a source's bytes and the files that were read; ``trust``: xacro without the sandbox."""
    if not isinstance(source, bytes) and str(source).endswith(JOIN) and not xacro_args:
        from multibot_rewrite.description.joining.from_file import read_joined

        return read_joined(str(source), trust)
    return read_alone(source, xacro_args, trust)


def read_job(
    source: Source,
    naming: Naming,
    urdf: Source | None = None,
    xacro_args: Arguments | None = None,
    definitions: Iterable[str] = (),
    file: str = "",
    words: Sequence[str] = (),
    trust: bool = False,
    *,
    release: str,
    aside: bool = False,
) -> Job:
    """Read the sources; raises InputError, and UsageError for arguments that no xacro takes.

    ``words`` are those of the robot that the job is for: the first one is filled into the arguments,
    and what they name after any of the words is the robot's own. ``trust`` lets xacro files do
    anything. ``aside`` sets systems of the world aside.
    """
    read = reader(source, naming, urdf, tuple(definitions), file, trust, release, aside)
    return job_for(read, xacro_args or {}, words)


def read_jobs(
    robots: Sequence[str],
    source: Source,
    naming: Naming,
    urdf: Source | None,
    xacro_args: Arguments | None,
    definitions: Iterable[str],
    file: str,
    trust: bool,
    release: str,
    aside: bool = False,
) -> dict[str, Job]:
    """Return the job of each robot, one for all unnamed in the arguments. Raises as ``read_job``."""
    given = xacro_args or {}
    read = reader(source, naming, urdf, tuple(definitions), file, trust, release, aside)
    named = [robot for robot in robots if name_robot(given, [robot])]
    others = [robot for robot in robots if robot not in named]
    jobs = {robot: job_for(read, given, [robot]) for robot in named}
    if others:
        _check_meant(given, {robot: job for robot, job in jobs.items() if job.naming.own}, others)
        jobs |= dict.fromkeys(others, job_for(read, given, others[:1]))
    return {robot: jobs[robot] for robot in robots}


def _check_meant(given: Arguments, own: Iterable[str], others: Sequence[str]) -> None:
    """Raise UsageError if an argument is given to a robot and names another one."""
    for robot in own:
        named = {name: text for name, text in given.items() if name_robot({name: text}, [robot])}
        values = " ".join(f"{name}:={text}" for name, text in named.items())
        hint = " ".join(f"{name}:={text}" for name, text in templates(named, robot).items())
        what = f"{values} puts {robot} into names"
        raise UsageError(f"{what}, and {others[0]} gets it, too; write {hint}")


Reader = Callable[[Arguments], Job]


def reader(
    source: Source,
    naming: Naming,
    urdf: Source | None,
    definitions: tuple[str, ...],
    file: str,
    trust: bool,
    release: str,
    aside: bool = False,
) -> Reader:
    """Return a function that reads the sources with arguments, once each; raises as ``read_job``.

    Without a ``release`` it is the one in the sources.
    """

    @cache
    def read(pairs: frozenset[tuple[str, str]]) -> Job:
        args = dict(pairs)
        own = read_whole(source, args_for(source, urdf, args), trust)
        beside = None if urdf is None else read_whole(urdf, args_for(urdf, source, args), trust)
        found = _files_read(args, [own, beside] if beside else [own])
        pair = (beside.data, beside.file) if beside else None
        name = file or own.file
        said = release_said(release, own.data + (beside.data if beside else b""), own.file)
        tree = builtin_tree(definitions, said.release)
        ros = ROS_2 if release else ros_shown(own.data, own.file, tree)
        job = Job(own.data, name, naming, definitions, pair, *said, ros, read=found)
        job = job._replace(naming=_naming_of(job))
        if not aside:
            return job
        data, left = set_aside(job.data, job.file, job.tree)
        return job._replace(data=data, aside=left)

    return lambda args: read(frozenset(args.items()))


def _naming_of(job: Job) -> Naming:
    """Return the naming of a description, which renames a model that a plugin looks for by its name."""
    naming = job.naming
    name = _MODEL.search(job.urdf[0] if job.urdf else job.data)
    found = name and re.findall(_IN_VALUE % re.escape(name[1]), name.string)
    if naming.layout.renames_models or not found or len(found) == 1:
        return naming
    layout = naming.layout._replace(models=True)
    separators = {**naming.separators, MODEL: SEPARATORS[MODEL]}
    renamed = naming._replace(layout=layout, separators=separators)
    described = job._replace(naming=renamed).inventories[-1]
    return renamed if any(values_with_own_model(described)) else naming


def _files_read(args: Arguments, texts: Sequence[SourceText]) -> FilesRead:
    """Return the files and arguments that were read; an argument is for a URDF, its SRDF, or both."""
    each = [it.known for it in texts if it.known is not None]
    files = tuple(path for it in texts for path in it.read)
    if not each:
        return FilesRead(files)
    from multibot_rewrite.description.sources.known_arguments import joined  # of xacros alone

    known = joined(each)
    return FilesRead(files, known.names, known.lacks(sorted(args)))


def job_for(
    read: Reader, given: Arguments, words: Sequence[str], common: Collection[str] = ()
) -> Job:
    """Return the job of the robot with these names; ``common`` arguments do not name a robot."""
    job = read(filled(given, *words[:1]))
    if not name_robot(given, words, common):
        return job
    other = _marked_job(read, given, words, common)
    own = {key: None for part in other.inventories for key in own_names(part, words)}
    _check_links(job, own, given, words)
    twin = as_twin(other.data) if has_mark(other.data) else b""
    job = job._replace(naming=job.naming._replace(own=own), own=OwnSource(words[0], twin=twin))
    plain = _unnamed_job(read, given, words, common)
    if plain is None:
        return job
    if twin and job.urdf and _lacks_declarations(job) and not _lacks_declarations(plain):
        # The arguments make an SRDF of it that is not the URDF's: the one without them follows that.
        job, twin = job._replace(data=plain.data), b""
        texts = marked_texts(plain.inventories[1], other.inventories[1])
    else:
        pairs = zip(plain.inventories, other.inventories, strict=True)
        texts = {key: text for pair in pairs for key, text in marked_texts(*pair).items()}
    job = job._replace(own=OwnSource(words[0], own_texts(texts, words), twin))
    affixes = own_affixes(texts) if job.urdf and not twin else None
    if not affixes:
        return job
    if len(set(words)) > 1:
        # A robot with several words: its SRDF as the arguments would have made it.
        inventory = collect(read_document(job.data, job.file), job.tree, plain.urdf_declarations)
        naming = job.naming._replace(separators={}, own=affixes)
        edits = make_plan(inventory, naming).edits
        return job._replace(data=fill(cut(job.data, edits), job.own.robot))
    # It knows nothing of the arguments: its names are those of the URDF without them, and become what
    # the arguments make of these.
    return job._replace(urdf=plain.urdf, naming=job.naming._replace(own=affixes))


def _unnamed_job(
    read: Reader, given: Arguments, words: Sequence[str], common: Collection[str]
) -> Job | None:
    """Return the job with empty values for arguments that name the robot; None if that fails."""
    named = [name for name, text in given.items() if name_robot({name: text}, words, common)]
    kept = {name: text for name, text in given.items() if name not in named}
    for empty in ([], *([it] for it in named), named):
        with suppress(InputError):
            return read({**kept, **dict.fromkeys(empty, "")})
    return None


def _check_links(job: Job, own: OwnNames, given: Arguments, words: Sequence[str]) -> None:
    """Raise InputError if arguments and nodes both put the robot's name before links."""
    links = sorted(text for kind, text in own if kind == "link")
    if job.naming.layout.at_run_time and links:
        named = [f"{it}:={text}" for it, text in given.items() if words[0] in text or "{" in text]
        what = f"{job.file}: {', '.join(named)} puts the robot's name into the link {links[0]!r}"
        again = f"robot_state_publisher would add it once more in layout {job.naming.layout.name}"
        raise InputError(f"{what}, and {again}; leave it out, or take frames-per-robot")


def _marked_job(
    read: Reader, given: Arguments, words: Sequence[str], common: Collection[str]
) -> Job:
    """Return the job with marks in place of the robot's name in all arguments."""
    with suppress(InputError):
        return read(marked(given, words, common))
    # Some file takes only words that it knows for one of them.
    args = filled(given, words[0])
    for name, text in marked(given, words, common).items():
        with suppress(InputError):
            read({**args, name: text})
            args[name] = text
    return read(args)


def _lacks_declarations(job: Job) -> bool:
    said = job.inventories[0]
    found = (name for names in said.names for name in names if not name.kind)
    return any(not PARTS.isdisjoint(name.kinds) for name in found)
