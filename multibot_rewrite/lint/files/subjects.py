# SPDX-License-Identifier: Apache-2.0
"""A file -> what rules check: its document, once for each set of xacro arguments."""

import os
from collections.abc import Iterator
from contextlib import redirect_stderr
from functools import partial
from io import StringIO
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import SRDF, XACRO
from multibot_rewrite.base.model import NO_ARGUMENT, InputError
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.sources.dialect import ros_shown
from multibot_rewrite.description.sources.packages import package_folder
from multibot_rewrite.description.sources.read import JOIN, XACRO as ENDING, has_xacro
from multibot_rewrite.description.steps.collect import NOTHING, SRDF as SRDF_SECTION, collect
from multibot_rewrite.description.steps.document import Document, read_document
from multibot_rewrite.lint.files.named import SRDF_MARK
from multibot_rewrite.rules.settings import ArgumentSet, Settings, matches
from multibot_rewrite.rules.subject import EXPANDED, Subject, subject_of

# Makes the reader treat the root as that of an SRDF, whatever it contains.
NO_URDF: Declared = {"link": {}}
DEFAULT = ArgumentSet("*", ())
ROOTS = ("robot", "sdf")
DEFINITIONS = frozenset({"macro", "property", "arg", "include"})


class Failed(NamedTuple):
    """An expansion that failed: why, and the arguments that it was made with."""

    error: InputError
    arguments: str


def read_subjects(path: str, data: bytes, settings: Settings) -> Iterator[Subject | Failed]:
    """Yield every subject of a file; raises InputError if it cannot be read.

    What others include is linted where it is used. Such a xacro file, or one that only defines what
    others use, is not expanded alone, and may have any root element."""
    if path.endswith(JOIN):
        from multibot_rewrite.description.joining.from_file import read_joined  # few are joined

        made = read_joined(path, settings.trust)
        yield make_subject(read_document(made.data, made.file), settings)
        return
    document = read_document(data, path)
    xacro, included = path.endswith(ENDING) or has_xacro(data), path in settings.included
    part = included or (xacro and _only_defines(document.root))
    if part and (not xacro or document.root.tag not in ROOTS):
        return
    if not xacro and b"<include" in data:
        yield _with_models(document, settings)
        return
    written = make_subject(document, settings)
    yield written._replace(format=XACRO) if xacro else written
    if xacro and not part:
        yield from _expansions(path, data, settings)


def _with_models(document: Document, settings: Settings) -> Subject:
    """Return the subject of a model with those that it includes, each at the line of its include."""
    from multibot_rewrite.description.sources.included_models import with_includes

    whole = with_includes(document.source, document.file)
    if whole == document.source:
        return make_subject(document, settings)
    found = make_subject(read_document(whole, document.file), settings)
    return found._replace(sources={document.file: document.source})


def _expansions(path: str, data: bytes, settings: Settings) -> Iterator[Subject | Failed]:
    """Yield the subjects of a xacro file: with its default arguments, and each set of the settings."""
    sets = [given for given in settings.arguments if matches(path, given.pattern)]
    for given in (DEFAULT, *sets):
        try:
            # A URDF needs none of it.
            from multibot_rewrite.description.sources.expand import expand_traced
            from multibot_rewrite.lint.files.pairing import reach_of

            find = partial(package_folder, file=path, roots=settings.readable)
            # Warnings of xacro are not findings, and would be printed between them.
            with redirect_stderr(StringIO()):
                found = expand_traced(path, data, dict(given.arguments), find, reach_of(settings))
            subject = make_subject(read_document(found.data, path + EXPANDED), settings)
            names = tuple(name for name, _ in given.arguments)
            yield subject._replace(
                origins=found.origins, sources=found.sources, arguments=str(given), given=names
            )
        except InputError as error:
            # With arguments that have no default there is no default expansion.
            if given is not DEFAULT or not sets or error.cause != NO_ARGUMENT:
                yield Failed(error, str(given))


def _only_defines(root: _Element) -> bool:
    """Return whether a file only defines what others use: expanded alone it is an empty robot."""
    parts = (str(child.tag).rpartition("}") for child in root.iterchildren("*"))
    tags = {name if "xacro" in space else "" for space, _, name in parts}
    return tags <= DEFINITIONS and ("include" not in tags or "macro" in tags)


def make_subject(document: Document, settings: Settings) -> Subject:
    """Return the subject of a document."""
    tree = builtin_tree(settings.definitions, settings.distro)
    ros = settings.ros or ros_shown(document.source, document.file, tree)
    tree = builtin_tree(settings.definitions, settings.distro, ros)
    called = SRDF_MARK in os.path.basename(document.file)
    inventory = collect(document, tree, NO_URDF if called else NOTHING)
    written = subject_of(inventory, tree, settings)
    # In the source of a xacro file names are not complete yet.
    if (
        inventory.format != SRDF_SECTION
        or document.file.endswith(XACRO)
        or has_xacro(document.source)
    ):
        return written
    from multibot_rewrite.lint.files.pairing import find_pair  # neither of this

    pair = find_pair(document.file.removesuffix(EXPANDED), inventory, settings)
    inventory = collect(document, tree, pair.declared or NO_URDF)
    return written._replace(format=SRDF, inventory=inventory, beside=pair.robot)
