# SPDX-License-Identifier: Apache-2.0
"""A description package for one robot gets an argument that puts a prefix before its names.

Which values hold names of the robot is what a rewrite with ``--affix prefix`` asks, too. ``${prefix}``
goes where a name is used, into the xacro sources; where one place makes names of the robot and others,
it goes where the name is made. Verified by expansion: with an empty prefix nothing changes, with
``robot1_`` the result is what the rewrite makes. The name of the robot itself stays. Next to it is
an argument for a namespace where plugins and sensors have names of ROS (``namespaces.py``)."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import redirect_stderr
from io import StringIO
from itertools import chain
from types import MappingProxyType
from typing import Any, NamedTuple

from multibot_rewrite.base.arguments import checked
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import PREFIX, affix
from multibot_rewrite.base.releases import release_here
from multibot_rewrite.description.joining.part import PREFIXED, prefixing
from multibot_rewrite.description.reports.xacro_arguments import (
    Argument,
    find_arguments,
    names_robots,
)
from multibot_rewrite.description.rewriters.contact import respell_collisions
from multibot_rewrite.description.rewriters.insert import insertions
from multibot_rewrite.description.rewriters.tree import Tree, builtin_tree
from multibot_rewrite.description.sources.access import BOUNDED, TRUSTED
from multibot_rewrite.description.sources.expand import kept_expansions
from multibot_rewrite.description.sources.included_by import robot_instead
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.description.steps.renames import make_renames, respeller
from multibot_rewrite.refactor.launch_argument import Space
from multibot_rewrite.refactor.launches import Trial, fillable, with_launches
from multibot_rewrite.refactor.named_elsewhere import named_elsewhere, plain_named, root_sections
from multibot_rewrite.refactor.namespaces import namespaced, space_verified
from multibot_rewrite.refactor.package import (
    Description,
    Expanding,
    Package,
    as_named,
    configurations,
    inventory_of,
    read_package,
    read_text,
    texts_of,
)
from multibot_rewrite.refactor.placing import Left, placed
from multibot_rewrite.refactor.source_edits import (
    SourceEdit,
    ValueEdit,
    change_of,
    edited,
    expected,
    first_difference,
    place_of,
)
from multibot_rewrite.refactor.xacro_sources import (
    MARK,
    NAMES,
    SPACES,
    Compared,
    Sources,
    compared,
    declared,
)

_PARTS = ("link", "joint")
TRIED = "robot1_"
_TRIED = re.compile(TRIED.encode())
# So many links may lack an argument that is not empty: the world.
_FEW = 2
# So many calls and properties are tried.
_PLACES = 999
_ALONE = "wherever the prefix is put, it changes more than names"


class Adopted(NamedTuple):
    """A package with its new argument; ``before`` and ``after`` are bytes by path, empty if new.

    ``verified`` descriptions take it, ``left`` could not be changed, ``unread`` could not be
    read, with the reason. ``already`` have such an argument, with its name: they stay but for the
    verified ones, in which it reaches all names now. ``launches`` are launch files that are
    verified to hand it on, ``configurations`` those that were verified besides the default one,
    as ``robot.urdf.xacro gripper:=true``. ``namespace`` is the argument for a namespace, empty if
    not needed, ``spaced`` are the descriptions that take it. ``bare`` are names that stay without
    the prefix, by description."""

    argument: str
    before: Mapping[str, bytes]
    after: Mapping[str, bytes]
    verified: tuple[str, ...]
    left: tuple[Left, ...]
    unread: Mapping[str, str]
    already: Mapping[str, str] = MappingProxyType({})
    launches: tuple[str, ...] = ()
    configurations: tuple[str, ...] = ()
    namespace: str = ""
    spaced: tuple[str, ...] = ()
    bare: Mapping[str, tuple[str, ...]] = MappingProxyType({})


@checked
def adopt(
    folder: str,
    *,
    xacro_args: Mapping[str, str] | None = None,
    definitions: Iterable[str] = (),
    trust: bool = False,
    distro: str = "",
) -> Adopted:
    """Give every description of ``folder`` an argument for a prefix, in its xacro sources.

    A plain URDF becomes a xacro; an argument that reaches some names only is made to reach all.
    Writes nothing. Raises InputError where there is no description that can be expanded, or
    wherever the prefix is put, it changes more than names."""
    tree = builtin_tree(tuple(definitions), release_here(distro))
    how = Expanding(TRUSTED if trust else BOUNDED, xacro_args or {})
    with kept_expansions():
        package = read_package(folder, tree, how)
        return _adopted(_Job(folder, package, tree, how, dict(package.unread)))


def _adopted(job: _Job) -> Adopted:
    """Return the package with partial arguments completed, and a new argument where it has none."""
    descriptions = job.package.descriptions
    arguments = {it.path: _arguments(it, job) for it in descriptions}
    partial = {path: name for path, its in arguments.items() if (name := _incomplete_argument(its))}
    already = {path: name for path, its in arguments.items() if (name := _prefix_argument(its))}
    # An SRDF follows its URDF.
    whole = {already[it.path] for it in descriptions if it.path in already.keys() - partial.keys()}
    for srdf in filter(_is_srdf, descriptions):
        if partial.get(srdf.path) in whole:
            del partial[srdf.path]
    names = already | partial
    lacks = {
        it.path: _names_without(it, names[it.path], job) for it in descriptions if it.path in names
    }
    spaces = {path: name for path, its in arguments.items() if (name := _namespace_argument(its))}
    job = job._replace(spaces=spaces)
    made = Adopted("", {}, {}, (), (), {})
    found: list[Description] = []
    for argument in (*dict.fromkeys(partial.values()), ""):
        some = [it for it in descriptions if argument == partial.get(it.path, "")]
        some = some if argument else [it for it in some if it.path not in lacks]
        found = list(_in_configurations(list(_as_xacros(some, job)), job))
        if argument:
            # What another configuration has may lack it, too.
            short = {it.path for it in found if lacks[it.path] or _names_without(it, argument, job)}
            found = [it for it in found if it.path in short]
        made = _with_more(made, found, argument, job) if found else made
    if not found and not lacks:
        nothing = f"{job.folder}: there is no description of a robot in it"
        raise InputError(next(iter(job.unread.values()), nothing))
    bare = {it: lacks[it] for it in lacks if lacks[it] and it not in made.verified}
    return made._replace(unread=job.unread, already=names, bare={**bare, **made.bare})


def _with_more(made: Adopted, found: Sequence[Description], argument: str, job: _Job) -> Adopted:
    """Return the result with more descriptions, that have the argument or get one."""
    # Raises InputError if there is nothing else.
    texts = {os.path.realpath(path): data for path, data in made.after.items()}
    try:
        if not texts.keys().isdisjoint(texts_of(found)):
            found = [_expanded_again(it, texts, {}, job) for it in found]
        more = _with_related_files(_best(found, argument, job), found, job)
    except InputError as error:
        if not argument and not made.argument:
            raise
        left = Left(found[0].path, f"its names are not verified: {error}")
        bare = {it.path: _changed_names(_prefix_edits(it)) for it in found} | dict(made.bare)
        return made._replace(left=(*made.left, left), bare=bare)
    return Adopted(*(_combined(*pair) for pair in zip(made, more, strict=True)))


def _combined(one: Any, two: Any) -> Any:
    """Return what two mappings or tuples have; of two words the second, unless it is empty."""
    if isinstance(one, Mapping):
        return {**one, **two}
    return tuple(dict.fromkeys((*one, *two))) if isinstance(one, tuple) else two or one


class _Job(NamedTuple):
    """The package to adopt; ``unread`` gets what cannot be expanded.

    ``spaces`` are arguments for a namespace that descriptions have already, by path."""

    folder: str
    package: Package
    tree: Tree
    how: Expanding
    unread: dict[str, str]
    spaces: Mapping[str, str] = MappingProxyType({})


def _with_related_files(made: Adopted, found: Sequence[Description], job: _Job) -> Adopted:
    """Return the result with launch files, the parameters that they fill in, and other files."""
    there, shared = job.package.found, prefixing().shared_frames
    # What gets the prefix.
    declared = (it.inventory.declared.get(kind, ()) for it in found for kind in PREFIXED)
    names = {name for its in declared for name in its if name not in shared}
    urdfs = [it.inventory.document.source for it in found if not _is_srdf(it)]
    filled = fillable(there.params, urdfs, names, made.argument, TRIED)
    space = Space(made.namespace or SPACES[0], bool(made.namespace))
    how = Trial(made.argument, TRIED, job.how.reach.trust, filled, space)
    launches = with_launches(job.folder, there.launch, made.after, how)
    # A plain description that becomes a xacro is one of them.
    files = {file for it in found for file in (*it.sources, it.path.removesuffix(".xacro"))}
    files |= {it.path for it in filled.values() if it.path in launches.after}
    elsewhere = [*named_elsewhere(job.folder, names, set(map(os.path.realpath, files)))]
    elsewhere += root_sections(there.params) if made.namespace else ()
    elsewhere += plain_named(job.folder, (it for it in made.after if not os.path.exists(it)))
    return made._replace(
        before={**made.before, **{path: read_file(path) for path in launches.after}},
        after={**made.after, **launches.after},
        left=tuple(dict.fromkeys((*made.left, *launches.left, *elsewhere))),
        launches=launches.verified,
    )


def _in_configurations(found: Sequence[Description], job: _Job) -> Iterator[Description]:
    """Yield each description with its other configurations; SRDFs after the URDFs they are for."""
    urdfs: list[Inventory] = []
    for it in sorted(found, key=_is_srdf):
        own = [it, *configurations(it, job.how, job.tree, urdfs, job.unread)]
        urdfs += () if _is_srdf(it) else (one.inventory for one in own)
        yield from own


class _Attempt(NamedTuple):
    """Descriptions whose sources get an argument: ``texts`` by real path, changed so far.

    ``carriers`` are parameters and properties that have its value. ``bases`` are expanded without
    the argument, ``found`` with it, and ``asked`` are the changes that those lack."""

    argument: str
    is_new: bool
    texts: Mapping[str, bytes]
    carriers: Collection[tuple[str, str]]
    bases: Sequence[Description]
    found: Sequence[Description] = ()
    asked: Sequence[Sequence[ValueEdit]] = ()

    @property
    def tops(self) -> set[str]:
        """The files of the descriptions themselves, by real path, if they have to declare it."""
        return {os.path.realpath(it.path) for it in self.bases} if self.is_new else set()


def _best(found: Sequence[Description], argument: str, job: _Job) -> Adopted:
    """Return the better result of two: the argument in calls that take one, or before names alone."""
    # Without an ``argument`` of their own the descriptions get a new one.
    texts = texts_of(found)
    sources = Sources(texts)
    # One that another description of the same files has would be before its names twice.
    others = (it for it in job.package.descriptions if not _is_srdf(it) and it.read)
    near = [it for it in others if not texts.keys().isdisjoint(texts_of([it]))]
    name = argument or Sources({**texts_of(near), **texts}).free_name(NAMES)
    made: list[Adopted] = []
    wrong: list[InputError] = []
    for in_calls in (True, False):
        try:
            attempt = _Attempt(name, not argument, texts, sources.carriers(name), found)
            attempt = _with_lacking_edits(attempt, job)
            attempt = _with_calls(attempt, sources, job) if in_calls else attempt
            made.append(_with_namespace(attempt, job))
        except InputError as error:
            wrong.append(error)
        if made and len(made[-1].verified) == len({it.path for it in found}):
            break
    if not made:
        raise wrong[-1]
    return max(made, key=lambda it: (len(it.verified), -sum(map(len, it.bare.values()))))


def _with_lacking_edits(attempt: _Attempt, job: _Job) -> _Attempt:
    """Return the attempt with the changes that descriptions lack with the argument."""
    # Raises InputError for a new one that is in other values.
    found = [
        _expanded_again(it, attempt.texts, {attempt.argument: TRIED}, job) for it in attempt.bases
    ]
    every = [_compared_descriptions(*pair) for pair in zip(attempt.bases, found, strict=True)]
    if attempt.is_new and any(it.astray for it in every):
        raise InputError(f"{job.folder}: {attempt.argument} would be elsewhere, too")
    return attempt._replace(found=found, asked=[it.lacks for it in every])


def _compared_descriptions(it: Description, other: Description) -> Compared:
    wanted, document = [*_prefix_edits(it)], it.inventory.document
    return compared(document, wanted, other.inventory.document, _TRIED)


def _with_calls(attempt: _Attempt, sources: Sources, job: _Job) -> _Attempt:
    """Return the attempt with the argument in calls and properties where it reaches names alone."""
    # Raises InputError if there are none.
    argument, _, texts, *_ = attempt
    # Those outside of macros are first.
    places = sorted(sources.places, key=lambda it: bool(sources.macro_at(it.spot)))
    some = [it for it in places if it.may_be_prefix][:_PLACES]
    marks = {f"qz{at:03}z": it for at, it in enumerate(some)}
    marked = edited(texts, [it.edit(mark) for mark, it in marks.items()])
    seen: set[str] = set()
    astray: set[str] = set()
    for found, asked in zip(attempt.found, attempt.asked, strict=True):
        other = _expanded_again(found, {**texts, **marked}, {argument: TRIED}, job)
        document = other.inventory.document
        seen |= {mark.decode() for mark in MARK.findall(document.source)}
        astray |= compared(found.inventory.document, asked, document, MARK).astray
    chosen = [it for mark, it in marks.items() if mark in seen - astray]
    if "" in astray or not chosen:
        raise InputError(f"{job.folder}: no call takes the argument alone")
    files = edited(texts, [it.edit(f"$(arg {argument})") for it in chosen])
    carriers = Sources({**texts, **files}).carriers(argument)
    own = {it for it in carriers if it[0]}
    edits = [it.edit(sources.word_at(it.spot, argument, own, False)) for it in chosen]
    edits += [*declared(texts, edits, attempt.tops, argument, False)]
    texts = {**texts, **edited(texts, edits)}
    bases = [it._replace(read=_expanded_again(it, texts, {}, job).read) for it in attempt.bases]
    return _with_lacking_edits(attempt._replace(texts=texts, carriers=carriers, bases=bases), job)


def _expanded_again(
    it: Description, texts: Mapping[str, bytes], more: Mapping[str, str], job: _Job
) -> Description:
    """Return a description expanded from other texts, or with more arguments."""
    given = Expanding(job.how.reach, {**job.how.arguments, **it.arguments, **more})
    own = {path: texts.get(path, data) for path, data in texts_of([it]).items()}
    # What is as on the disk is expanded once.
    there = {path: os.path.exists(path) and read_file(path) for path in own}
    changed = {path: data for path, data in own.items() if data != there[path]}
    data, read = read_text(it.path, given, changed)
    inventory = it.inventory._replace(document=read_document(data, it.path))
    return it._replace(inventory=inventory, read=read)


def _with_argument(
    attempt: _Attempt, job: _Job, more: Collection[SourceEdit] = ()
) -> tuple[Adopted, Mapping[str, bytes]]:
    """Return the descriptions with the argument, and the changed files by real path."""
    # They are verified together with ``more`` edits.
    argument, _, texts, carriers, bases, found, asked = attempt
    sources = Sources(texts)
    # Where something is called so, it is no property.
    as_property = attempt.is_new and argument not in sources.hiding
    made = placed(
        found, asked, lambda spot, _: sources.word_at(spot, argument, carriers, as_property)
    )
    names = declared(texts, made.edits, attempt.tops, argument, as_property)
    after = {**texts, **edited(texts, {*made.edits, *names, *more})}
    every = [*zip(bases, found, made.changes, strict=True)]
    wrong = {it[0].words: _prefix_fault(*it, after, argument, job.how) for it in every}
    wrong = {name: why for name, why in wrong.items() if why}
    bare = {
        it.words: _changed_names(one for one in its if one not in own)
        for (it, _, own), its in zip(every, asked, strict=True)
        if len(its) > len(own)
    }
    # Verified is a description none of whose configurations is wrong or lacks a prefix.
    paths = dict.fromkeys(it.path for it in bases)
    if len({it.path for it in bases if it.words in wrong}) == len(paths):
        name, why = next(iter(wrong.items()))
        raise InputError(f"{name}: {_ALONE}; {why}")
    unmade = {it.path for it in bases if it.words in wrong or it.words in bare}
    verified = tuple(path for path in paths if path not in unmade)
    left = (
        *made.left,
        *chain.from_iterable(map(_unwritten_defaults, bases)),
        *(Left(name, f"its names are not verified: {why}") for name, why in wrong.items()),
    )
    there = {path: read_file(path) if os.path.exists(path) else b"" for path in after}
    named = as_named({path: data for path, data in after.items() if data != there[path]}, bases)
    before = {path: data for path, data in as_named(there, bases).items() if path in named}
    others = tuple(it.words for it in bases if it.arguments and it.words not in wrong)
    return Adopted(
        argument, before, named, verified, left, {}, configurations=others, bare=bare
    ), after


def _with_namespace(attempt: _Attempt, job: _Job) -> Adopted:
    """Return the result with an argument for a namespace, if one changes names alone."""
    found, prefix = attempt.bases, attempt.argument
    has = {it.path: job.spaces[it.path] for it in found if it.path in job.spaces}
    # An argument that is made whole is one change.
    none = has or not attempt.is_new
    space = namespaced([] if none else found, attempt.texts, job.tree)
    why = "it has an argument for a namespace"
    left = [*space.left, *(Left(path, f"{why}: {it}") for path, it in has.items())]
    if space.argument:
        try:
            made, after = _with_argument(attempt, job, space.edits)
            verified, wrong = space_verified(space, prefix, TRIED, after, job.how, job.tree)
        except InputError as error:
            verified, wrong = (), (Left(found[0].path, f"it gets no namespace: {error}"),)
        left += wrong
        if verified:
            return made._replace(
                left=(*made.left, *left), namespace=space.argument, spaced=verified
            )
    made, _ = _with_argument(attempt, job)
    return made._replace(left=(*made.left, *left))


def _is_srdf(it: Description) -> bool:
    return it.inventory.format != "robot"


def _arguments(it: Description, job: _Job) -> Sequence[Argument]:
    """Return the arguments of a xacro that are named as those for a robot's names."""
    if it.read is None:
        return ()
    # What xacro warns about is not said here.
    with redirect_stderr(StringIO()):
        reach, given = job.how
        found = find_arguments(
            it.path, given, job.tree, reach=reach, wanted=names_robots, read=it.read
        )
    return found.arguments


def _namespace_argument(arguments: Iterable[Argument]) -> str:
    """Return the argument that is a namespace of plugins, or in one; empty if there is none."""
    return next(
        (it.name for it in arguments if any(one.kind == "namespace" for one in it.uses)), ""
    )


def _prefix_argument(arguments: Iterable[Argument]) -> str:
    """Return the argument that is before links and differs by robot; empty if there is none."""
    # Of two arms both are returned. ``world`` and some that were forgotten may lack it.
    uses = [(it, use) for it in arguments for use in it.uses if not it.fault]
    uses = [(it, use) for it, use in uses if (use.kind, use.how) == ("link", PREFIX)]
    for argument, use in uses:
        lacking = use.total - use.names
        if (argument.value and lacking <= use.names) or (not argument.missed and lacking < _FEW):
            return argument.name
    reached = sum(use.names for it, use in uses if not it.missed)
    is_whole = bool(uses) and reached + _FEW > uses[0][1].total
    return ", ".join(dict.fromkeys(it.name for it, _ in uses)) if is_whole else ""


def _incomplete_argument(arguments: Iterable[Argument]) -> str:
    """Return the argument that is empty by default and before some names or none; else empty."""
    empty = [it for it in arguments if not it.default and not it.fault]
    for argument in empty:
        parts = [use for use in argument.uses if use.kind in _PARTS]
        if parts and all((use.how, use.separator) == (PREFIX, "") for use in parts):
            return argument.name
    unused = (it.name for it in empty if not it.uses and not it.others)
    return next((name for name in unused if "prefix" in name), "")


def _names_without(it: Description, name: str, job: _Job) -> tuple[str, ...]:
    """Return the names that an argument of a description does not reach."""
    other = _expanded_again(it, {}, dict.fromkeys(name.split(", "), TRIED), job)
    return _changed_names(_compared_descriptions(it, other).lacks)


def _changed_names(edits: Iterable[ValueEdit]) -> tuple[str, ...]:
    """Return the values that edits change, each once."""
    return tuple(dict.fromkeys(it.value.strip() for it in edits))


def _as_xacros(descriptions: Iterable[Description], job: _Job) -> Iterator[Description]:
    """Return each description as a xacro; those that cannot be one are noted as unread."""
    for it in descriptions:
        if it.inventory.format not in ("robot", "srdf.robot"):
            continue
        why = ""
        if not _is_srdf(it) and not it.inventory.declared.get("link"):
            why = f"it has no link; {robot_instead(it.path)}"
        elif it.read is None and os.path.exists(f"{it.path}.xacro"):
            why = "its xacro is in the same folder; generate it again from that"
        if why:
            job.unread[it.path] = f"{it.path}: {why}"
            continue
        try:
            yield it if it.read else _as_xacro(it, job.tree, job.how)
        except InputError as error:
            job.unread[it.path] = str(error)


def _as_xacro(it: Description, tree: Tree, how: Expanding) -> Description:
    """Return a plain description as the xacro that it becomes."""
    path = f"{it.path}.xacro"
    data, read = read_text(path, how, {os.path.realpath(path): it.inventory.document.source})
    return Description(path, inventory_of(data, path, tree), read)


def _prefix_edits(it: Description) -> Iterator[ValueEdit]:
    """Yield where the prefix goes in the values of a description."""
    # A link or joint that it does not have is one of another description with the same file.
    document, claims, _, declared, *_ = it.inventory
    naming = prefixing()
    renames = make_renames(it.inventory, naming)
    for claim, names, spelling in zip(claims, it.inventory.names, renames.values, strict=True):
        places = [found.affix.at for found in spelling]
        for name in names:
            kind = "" if name.kind else next((it for it in name.kinds if it in _PARTS), "")
            there = affix(naming, kind, name.text) if kind else None
            places += [name.at + there.at] if there else []
        for at in places:
            yield change_of(document, claim, at, at, TRIED)
    # The name that Gazebo makes of a collision begins with that of its link.
    respell = respeller(renames, TRIED)
    for claim, text in respell_collisions(document.root, claims, declared, respell):
        if text == f"{TRIED}{claim.value}":
            yield change_of(document, claim, 0, 0, TRIED)


def _unwritten_defaults(it: Description) -> Iterator[Left]:
    """Yield defaults of plugins, such as a sensor's name, that need an element of their own."""
    document, _, _, declared, *_ = it.inventory
    for one in insertions(it.inventory.served, declared, prefixing()):
        if it.read:
            where = place_of(it.read, document.elements.index(one.parent)) or it.path
            what = f"it takes {one.old!r} where no element says a {one.kind}; write it out"
            yield Left(where, what)


def _prefix_fault(
    it: Description,
    found: Description,
    changes: Collection[ValueEdit],
    after: Mapping[str, bytes],
    argument: str,
    how: Expanding,
) -> str:
    """Return what is wrong with a description with a prefix: only the names may change."""
    # Raises InputError for one that differs without a prefix.
    with_prefix = expected(found.inventory.document, changes)
    for prefix, wanted in (("", it.inventory.document.source), (TRIED, with_prefix)):
        more = {argument: prefix} if prefix else {}
        given = Expanding(how.reach, {**how.arguments, **it.arguments, **more})
        made, _ = read_text(it.path, given, after, False)
        if made != wanted:
            other = first_difference(made, wanted)
            if not prefix:
                raise InputError(f"{it.words}: {_ALONE}; without it has {other}")
            return f"with {argument}:={prefix} it has {other}"
    return ""
