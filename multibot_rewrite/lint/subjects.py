"""A file -> what rules look at: its document, once for each set of xacro arguments."""

from __future__ import annotations

from collections.abc import Iterator
from fnmatch import fnmatch

from multibot_rewrite.library import builtin_tree
from multibot_rewrite.lint.records import SRDF, URDF, XACRO, Subject
from multibot_rewrite.lint.robot import Robot, read_robot
from multibot_rewrite.lint.settings import ArgumentSet, Settings
from multibot_rewrite.rewriters.forms import Declared
from multibot_rewrite.rewriting.collect import NOTHING, collect
from multibot_rewrite.rewriting.collect import SRDF as SRDF_SECTION
from multibot_rewrite.rewriting.document import Document, read_document
from multibot_rewrite.sources import read_file, read_source
from multibot_rewrite.xacro_source import expand_traced
from multibot_rewrite.xacro_trace import Trace

DEFAULT = ArgumentSet("*", ())


def read_subjects(path: str, settings: Settings) -> Iterator[Subject]:
    """Every subject of a file; raises InputError where it cannot be read or expanded."""
    if not path.endswith(".xacro"):
        yield _subject(read_document(read_file(path), path), settings)
        return
    source = _subject(read_document(read_file(path), path), settings)
    yield source._replace(format=XACRO)
    for given in (DEFAULT, *settings.arguments):
        if fnmatch(path, given.pattern):
            yield _expanded(path, given, settings)


def _expanded(path: str, given: ArgumentSet, settings: Settings) -> Subject:
    trace = Trace()
    data, origins = expand_traced(path, dict(given.arguments), trace)
    subject = _subject(read_document(data, f"{path} (expanded)"), settings)
    return subject._replace(origins=origins, sources=trace.sources, arguments=str(given))


def _subject(document: Document, settings: Settings) -> Subject:
    tree = builtin_tree(settings.vocabulary)
    inventory = collect(document, tree)
    if inventory.format != SRDF_SECTION:
        robot = read_robot(document.root)
        return Subject(URDF, document, inventory, tree, robot, settings)
    beside, outside = _urdf_beside(settings)
    inventory = collect(document, tree, outside)
    robot = read_robot(document.root)
    return Subject(SRDF, document, inventory, tree, robot, settings, beside)


def _urdf_beside(settings: Settings) -> tuple[Robot | None, Declared]:
    """The robot an SRDF belongs to and what its description declares."""
    if not settings.urdf:
        return None, NOTHING
    data, name = read_source(settings.urdf, {})
    inventory = collect(read_document(data, name), builtin_tree(settings.vocabulary))
    return read_robot(inventory.document.root), inventory.declared
