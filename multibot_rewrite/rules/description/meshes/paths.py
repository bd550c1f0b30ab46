# SPDX-License-Identifier: Apache-2.0
"""The mesh and texture files that a description names: absolute paths, schemes, odd formats."""

from collections.abc import Iterator
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.conventions import ROWS
from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.facts.source_values import is_fixed, starts_of
from multibot_rewrite.rules.subject import Subject

_SCHEME = lazy_compile(r"([A-Za-z][A-Za-z0-9+.-]+)://")
# The same without a host, which libcurl takes (RFC 8089).
_SHORT = "file:/"
# A letter and a colon is a drive of Windows.
_MACHINE = lazy_compile(r"/|[A-Za-z]:[/\\]")


class Used(NamedTuple):
    """A mesh or texture.

    ``scheme`` is what is before ``://``, ``file`` for a path from the root of the disk, empty for a
    relative one. ``path`` is the rest of it."""

    element: _Element
    name: str
    scheme: str
    path: str


@memoized
def used_files(subject: Subject) -> tuple[Used, ...]:
    """Return every file that a link's shapes and materials name, in document order."""
    tags, elements = ("mesh", "texture"), subject.elements
    files = elements.root.iter(*tags) if elements.every("texture") else elements.every("mesh")
    found = ((it, it.get("filename")) for it in files)
    return tuple(_used_file(it, name.strip()) for it, name in found if name and name.strip())


def _used_file(element: _Element, name: str) -> Used:
    """Return the file that an element names, with the parts of its name."""
    if scheme := _SCHEME.match(name):
        return Used(element, name, scheme[1].lower(), name[scheme.end() :])
    if name.lower().startswith(_SHORT):
        return Used(element, name, "file", name[len(_SHORT) - 1 :])
    return Used(element, name, "file" if _MACHINE.match(name) else "", name)


def problem(it: Used, message: str, hint: str) -> Problem:
    """Return a problem at the file's name."""
    return Problem(it.element, message, "filename", hint)


def and_more(count: int) -> str:
    """Return the end of a message about the first of many: `` (and N more)``; empty for one."""
    return f" (and {count - 1} more)" if count > 1 else ""


def _with_scheme(subject: Subject, *schemes: str) -> list[Used]:
    return [it for it in used_files(subject) if it.scheme in schemes]


@rule("MB704", "path-of-one-machine", WARNING)
def path_of_one_machine(subject: Subject) -> Iterator[Problem]:
    """Yield a problem for the first absolute path that is written out, with the number of all."""
    found = [it for it in _with_scheme(subject, "file") if "$" not in it.name]
    starts = starts_of(subject, [it.element for it in found])
    found = [
        it for it in found if is_fixed(subject, starts[it.element], "filename", constants=False)
    ]
    if found:
        message = f"{found[0].name!r} is a path of one machine{and_more(len(found))}"
        yield problem(found[0], message, "write package://NAME/...")


@rule("MB705", "backslash-in-path", WARNING)
def backslash_in_path(subject: Subject) -> Iterator[Problem]:
    """Report file names with a backslash."""
    for it in used_files(subject):
        if "\\" in it.name:
            right = it.name.replace("\\", "/")
            yield problem(it, f"{it.name!r} has backslashes", f"write {right!r}")


@rule("MB706", "mesh-without-file", ERROR)
def mesh_without_file(subject: Subject) -> Iterator[Problem]:
    """Report meshes of a link's shapes with an empty name or none; SDF's have a ``<uri>``."""
    for mesh in subject.elements.every("mesh"):
        name = mesh.get("filename")
        if (name is None or not name.strip()) and _is_shape(mesh):
            fault = "no file" if name is None else "an empty file name"
            yield Problem(mesh, f"<mesh> has {fault}", None if name is None else "filename")


def _is_shape(mesh: _Element) -> bool:
    """Return whether a mesh is the shape of a visual or collision of a link."""
    above = [str(it.tag) for it in mesh.iterancestors()][:4]
    return above[:1] + above[2:] == ["geometry", "link", "robot"] and mesh.find("uri") is None


@rule("MB709", "mixed-schemes", NOTE)
def mixed_schemes(subject: Subject) -> Iterator[Problem]:
    """Yield a problem for the first file whose name has another scheme than the first one."""
    used = [it for it in used_files(subject) if "$" not in it.name]
    other = next((it for it in used if it.scheme != used[0].scheme), None)
    if other is not None:
        message = f"{other.name!r} and {used[0].name!r}: two ways to name meshes"
        yield problem(other, message, "use package:// for all")


@rule("MB710", "model-uri", WARNING)
def model_uri(subject: Subject) -> Iterator[Problem]:
    """Yield a problem for the first ``model://`` name, with their number."""
    if found := _with_scheme(subject, "model"):
        message = f"RViz cannot load {found[0].name!r}{and_more(len(found))}"
        yield problem(found[0], message, "write package://")


@rule("MB711", "mesh-from-the-net", NOTE)
def mesh_from_the_net(subject: Subject) -> Iterator[Problem]:
    """Yield a problem for the first mesh from the network, with their number."""
    if found := _with_scheme(subject, "http", "https"):
        message = f"{found[0].name!r} needs the network{and_more(len(found))}"
        yield problem(found[0], message, "put it into a package")


@rule("MB712", "find-left-over", WARNING)
def find_left_over(subject: Subject) -> Iterator[Problem]:
    """Yield a problem for the first name with ``$(find``, with their number; in xacro MB105 has it."""
    if any("xacro" in str(uri) for uri in subject.document.root.nsmap.values()):
        return
    if found := [it for it in used_files(subject) if "$(find" in it.name]:
        message = f"{found[0].name!r} holds a xacro substitution{and_more(len(found))}"
        yield problem(found[0], message, "write package://NAME/...")


# Programs that cannot read a format which RViz reads (through assimp).
PARTLY = {ending: said for (ending,), said in ROWS["meshes"]}


@rule("MB707", "mesh-format-unknown", WARNING)
def mesh_format_unknown(subject: Subject) -> Iterator[Problem]:
    """Report extensions of meshes that no program knows."""
    for it in _meshes(subject):
        ending = _extension(it)
        if ending not in ("stl", "dae", "obj") and ending not in PARTLY:
            fault = f"no program can load .{ending}" if ending else "it has no extension"
            yield problem(it, f"{it.name!r}: {fault}", "use .stl, .dae or .obj")


def _meshes(subject: Subject) -> list[Used]:
    used = used_files(subject)
    return [it for it in used if it.element.tag == "mesh" and "$" not in it.name]


def _extension(it: Used) -> str:
    base = it.name.replace("\\", "/").rpartition("/")[2]
    return base.rpartition(".")[2].lower() if "." in base else ""


@rule("MB708", "mesh-format-partly", NOTE)
def mesh_format_partly(subject: Subject) -> Iterator[Problem]:
    """Report each mesh format that only some programs read, once."""
    seen = set()
    for it in _meshes(subject):
        ending = _extension(it)
        if ending in PARTLY and ending not in seen:
            seen.add(ending)
            yield problem(it, f"{it.name!r}: {PARTLY[ending]}", "use .stl, .dae or .obj")
