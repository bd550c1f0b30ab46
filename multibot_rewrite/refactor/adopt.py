# SPDX-License-Identifier: Apache-2.0
"""A description package for one robot gets an argument that puts a prefix before its names.

Which values hold names of the robot is what a rewrite with ``--affix prefix`` asks, too. ``${prefix}``
goes where a name is used, into the xacro sources; where one place makes names of the robot and others,
it goes where the name is made. Verified by expansion: with an empty prefix nothing changes, with
``robot1_`` the result is what the rewrite makes. The name of the robot itself stays. Next to it is
an argument for a namespace where plugins and sensors have names of ROS (``namespaces.py``)."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import redirect_stderr
from io import StringIO
from itertools import chain
from types import MappingProxyType
from typing import NamedTuple

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
from multibot_rewrite.description.sources.included_by import robot_instead
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.renames import make_renames, respeller
from multibot_rewrite.refactor.launch_argument import Space
from multibot_rewrite.refactor.launches import Trial, fillable, with_launches
from multibot_rewrite.refactor.named_elsewhere import named_elsewhere, root_sections
from multibot_rewrite.refactor.namespaces import (
    SPACES,
    declared,
    free_name,
    namespaced,
    space_verified,
)
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

_PARTS = ("link", "joint")
TRIED = "robot1_"
_ALONE = "wherever the prefix is put, it changes more than names"


class Adopted(NamedTuple):
    """A package with its new argument; ``before`` and ``after`` are bytes by path, empty if new.

    ``verified`` descriptions take it, ``left`` could not be changed, ``unread`` could not be
    read, with the reason. ``already`` have such an argument, with its name: they stay.
    ``launches`` are launch files that are verified to hand it on, ``configurations`` those that
    were verified besides the default one, as ``robot.urdf.xacro gripper:=true``. ``namespace``
    is the argument for a namespace, empty if not needed, ``spaced`` are the descriptions that
    take it."""

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

    A plain URDF becomes a xacro. Writes nothing. Raises InputError where there is no description
    that can be expanded, or wherever the prefix is put, it changes more than names."""
    tree = builtin_tree(tuple(definitions), release_here(distro))
    how = Expanding(TRUSTED if trust else BOUNDED, xacro_args or {})
    package = read_package(folder, tree, how)
    job = _Job(folder, package, tree, how, dict(package.unread))
    arguments = {it.path: _arguments(it, job) for it in package.descriptions}
    already = {path: name for path, its in arguments.items() if (name := _prefix_argument(its))}
    found = list(_as_xacros((it for it in package.descriptions if it.path not in already), job))
    if not found and not already:
        nothing = f"{folder}: there is no description of a robot in it"
        raise InputError(next(iter(job.unread.values()), nothing))
    if not found:
        return Adopted("", {}, {}, (), (), job.unread, already)
    own = {path: _namespace_argument(its) for path, its in arguments.items()}
    found = list(_in_configurations(found, job))
    made = _with_related_files(_with_namespace(found, own, job), found, job)
    return made._replace(unread=job.unread, already=already)


class _Job(NamedTuple):
    """The package to adopt; ``unread`` gets what cannot be expanded."""

    folder: str
    package: Package
    tree: Tree
    how: Expanding
    unread: dict[str, str]


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


def _with_argument(
    found: Sequence[Description],
    texts: Mapping[str, bytes],
    argument: str,
    how: Expanding,
    more: Collection[SourceEdit] = (),
) -> tuple[Adopted, Mapping[str, bytes]]:
    """Return the descriptions with the argument, and the changed files by real path."""
    # They are verified together with ``more`` edits.
    word = b"${%s}" % argument.encode()
    asked = [list(_prefix_edits(it)) for it in found]
    made = placed(found, asked, lambda _: word)
    edits = {*made.edits, *declared(found, texts, {it.file for it in made.edits}, argument), *more}
    after = edited(texts, edits)
    every = zip(found, made.changes, strict=True)
    wrong = {at: _prefix_fault(it, its, after, argument, how) for at, (it, its) in enumerate(every)}
    wrong = {at: why for at, why in wrong.items() if why}
    lacking = {at for at, its in enumerate(asked) if len(its) > len(made.changes[at])}
    # Proved is a description none of whose configurations is wrong or lacks a prefix.
    paths = dict.fromkeys(it.path for it in found)
    if len({found[at].path for at in wrong}) == len(paths):
        at, why = next(iter(wrong.items()))
        raise InputError(f"{found[at].words}: {_ALONE}; {why}")
    unmade = {found[at].path for at in (*wrong, *lacking)}
    verified = tuple(path for path in paths if path not in unmade)
    left = (
        *made.left,
        *chain.from_iterable(map(_unwritten_defaults, found)),
        *(Left(found[at].words, f"its names are not verified: {it}") for at, it in wrong.items()),
    )
    named = as_named(after, found)
    before = {path: data for path, data in as_named(texts, found).items() if path in named}
    before |= dict.fromkeys((path for path in before if not os.path.exists(path)), b"")
    others = tuple(it.words for at, it in enumerate(found) if it.arguments and at not in wrong)
    return Adopted(argument, before, named, verified, left, {}, configurations=others), after


def _with_namespace(found: Sequence[Description], own: Mapping[str, str], job: _Job) -> Adopted:
    """Return the result with an argument for a namespace, if one changes names alone."""
    # ``own`` are such arguments that descriptions have already, by path.
    texts, prefix = texts_of(found), free_name(found)
    has = {it.path: own.get(it.path, "") for it in found}
    space = namespaced([] if any(has.values()) else found, texts, job.tree)
    left = [*space.left]
    left += (
        Left(path, f"it has an argument for a namespace: {it}") for path, it in has.items() if it
    )
    if space.argument:
        try:
            made, after = _with_argument(found, texts, prefix, job.how, space.edits)
            verified, wrong = space_verified(space, prefix, TRIED, after, job.how, job.tree)
        except InputError as error:
            verified, wrong = (), (Left(found[0].path, f"it gets no namespace: {error}"),)
        left += wrong
        if verified:
            return made._replace(
                left=(*made.left, *left), namespace=space.argument, spaced=verified
            )
    made, _ = _with_argument(found, texts, prefix, job.how)
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
        found = find_arguments(it.path, given, job.tree, reach=reach, wanted=names_robots)
    return found.arguments


def _namespace_argument(arguments: Iterable[Argument]) -> str:
    """Return the argument that is a namespace of plugins, or in one; empty if there is none."""
    return next(
        (it.name for it in arguments if any(one.kind == "namespace" for one in it.uses)), ""
    )


def _prefix_argument(arguments: Iterable[Argument]) -> str:
    """Return the argument that is before links and differs by robot; empty if there is none."""
    # ``world`` and some that were forgotten may lack it.
    for it in arguments:
        links = (use for use in it.uses if (use.kind, use.how) == ("link", PREFIX))
        if it.value and any(2 * use.names >= use.total for use in links):
            return it.name
    return ""


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
    changes: Collection[ValueEdit],
    after: Mapping[str, bytes],
    argument: str,
    how: Expanding,
) -> str:
    """Return what is wrong with a description with a prefix: only the names may change."""
    # Raises InputError for one that differs without a prefix.
    document = it.inventory.document
    for prefix, wanted in (("", document.source), (TRIED, expected(document, changes))):
        more = {argument: prefix} if prefix else {}
        given = Expanding(how.reach, {**how.arguments, **it.arguments, **more})
        made, _ = read_text(it.path, given, after)
        if made != wanted:
            other = first_difference(made, wanted)
            if not prefix:
                raise InputError(f"{it.words}: {_ALONE}; without it has {other}")
            return f"with {argument}:={prefix} it has {other}"
    return ""
