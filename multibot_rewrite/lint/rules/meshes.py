"""MB7: mesh and texture files, and the packages they are in."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from functools import cache, lru_cache
from typing import NamedTuple
from urllib.parse import unquote

from lxml.etree import _Element

from multibot_rewrite.lazy import lazy_compile
from multibot_rewrite.lint.elements import Elements
from multibot_rewrite.lint.packages import entries, find_in, package_folders
from multibot_rewrite.lint.records import NOTE, Problem, Subject, rule
from multibot_rewrite.lint.written import is_fixed, starts_of
from multibot_rewrite.model import ERROR, WARNING

_SCHEME = lazy_compile(r"([A-Za-z][A-Za-z0-9+.-]+)://")
# A letter and a colon is a drive of Windows.
_MACHINE = lazy_compile(r"/|[A-Za-z]:[/\\]")
READABLE = frozenset(("stl", "dae", "obj"))
# Who cannot read the rest of what RViz reads through assimp.
PARTLY = {
    "gltf": "Gazebo Classic and gz before Garden cannot read glTF",
    "glb": "Gazebo Classic and gz before Garden cannot read glTF",
    "fbx": "Gazebo Classic and gz before Garden cannot read FBX",
    "ply": "Gazebo cannot read PLY",
    "mesh": "only RViz reads Ogre's format",
}
MESH = '<link name="a"><visual><geometry><mesh filename="%s"/></geometry></visual></link>'


class Used(NamedTuple):
    """A mesh or texture; ``scheme`` is what stands before ``://``, ``file`` for a path from the
    root of the disk, empty for a relative one. ``path`` is the rest of it."""

    element: _Element
    name: str
    scheme: str
    path: str


@lru_cache(maxsize=1)
def _used(elements: Elements) -> tuple[Used, ...]:
    """Every file that a link's shapes and materials name, in document order."""
    tags = ("mesh", "texture")
    files = elements.root.iter(*tags) if elements.every("texture") else elements.every("mesh")
    found = ((it, it.get("filename")) for it in files)
    return tuple(_read(it, name.strip()) for it, name in found if name and name.strip())


def _read(element: _Element, name: str) -> Used:
    scheme = _SCHEME.match(name)
    if scheme:
        return Used(element, name, scheme[1].lower(), name[scheme.end() :])
    return Used(element, name, "file" if _MACHINE.match(name) else "", name)


def _with(subject: Subject, *schemes: str) -> list[Used]:
    return [it for it in _used(subject.elements) if it.scheme in schemes]


def _problem(it: Used, message: str, hint: str) -> Problem:
    return Problem(it.element, message, "filename", hint)


def _and_more(count: int) -> str:
    return f" (and {count - 1} more)" if count > 1 else ""


class Lookup(NamedTuple):
    """A file that was looked for: the folders it may be below, its path there, and the path as it
    is written on the disk, empty where it is not there."""

    used: Used
    folders: tuple[str, ...]
    path: str
    found: str


@lru_cache(maxsize=1)
def _lookups(elements: Elements, file: str, roots: tuple[str, ...]) -> tuple[Lookup, ...]:
    """Each file once that somebody can look for, by the first element that names it."""
    first = {it.name: it for it in reversed(_used(elements)) if it.scheme in ("package", "")}
    asked = (it for it in reversed(first.values()) if "$" not in it.name and "\\" not in it.name)
    folders_of = cache(lambda name: package_folders(name, file, roots))
    return tuple(_looked_up(it, *_bases(it, file, folders_of)) for it in asked)


def _looked_up(it: Used, folders: tuple[str, ...], path: str) -> Lookup:
    found = [find_in(folder, path) for folder in folders]
    exact = os.path.normpath(path)
    return Lookup(it, folders, path, exact if exact in found else next(filter(None, found), ""))


def _bases(
    it: Used, file: str, folders_of: Callable[[str], tuple[str, ...]]
) -> tuple[tuple[str, ...], str]:
    """The folders in which a file may be, and its path below them."""
    if it.scheme == "":
        here = os.path.dirname(os.path.abspath(file))
        return (here, os.path.dirname(here)), it.path
    package, _, path = unquote(it.path).partition("/")
    if not package or not path:
        return (), ""
    path = path.lstrip("/")
    first = path.partition("/")[0].lower()
    # A folder that is only called like the package must look like it.
    return tuple(it for it in folders_of(package) if _looks_like_it(entries(it), first)), path


def _looks_like_it(names: frozenset[str], first: str) -> bool:
    return "package.xml" in names or any(name.lower() == first for name in names)


def _asked(subject: Subject) -> tuple[Lookup, ...]:
    file = subject.document.file.removesuffix(" (expanded)")
    return _lookups(subject.elements, file, subject.settings.roots)


@rule(
    "MB701",
    "mesh-missing",
    ERROR,
    what="A mesh or texture file is not there, though its package is.",
    why="RViz shows the link without a shape and marks the robot as faulty; Gazebo spawns it "
    "without that visual or collision, so a wheel falls through the ground.",
    fix="Correct the path, or add the file to the package and to what it installs.",
    bad=MESH % "package://arm_description/meshes/base.stl",
    good=MESH % "package://arm_description/meshes/link.stl",
    beside={
        "arm_description/package.xml": "<package><name>arm_description</name></package>",
        "arm_description/meshes/link.stl": "solid",
    },
)
def mesh_missing(subject: Subject) -> Iterator[Problem]:
    """Files of packages that were found, and relative ones."""
    for it in _asked(subject):
        if it.folders and not it.found:
            near = _nearest(it)
            hint = f"did you mean {near!r}?" if near else f"looked in {it.folders[0]}"
            yield _problem(it.used, f"{it.used.name!r} is not there", hint)


def _nearest(it: Lookup) -> str:
    from multibot_rewrite.checks.audit import nearest

    folder = os.path.join(it.folders[0], os.path.dirname(it.path))
    return nearest(os.path.basename(it.path), sorted(entries(folder)))


@rule(
    "MB702",
    "package-not-found",
    NOTE,
    what="A package that holds meshes is not below the folders that were searched.",
    why="Whether its files are there was not checked; at run time they are looked for in the "
    "packages of the sourced workspace.",
    fix="Name the folder of the workspace's sources as a root, or source the workspace.",
    bad=MESH % "package://arm_description/meshes/base.stl",
    good=MESH % "package://hand_description/meshes/base.stl",
    beside={
        "hand_description/package.xml": "<package><name>hand_description</name></package>",
        "hand_description/meshes/base.stl": "solid",
    },
)
def package_not_found(subject: Subject) -> Iterator[Problem]:
    """Once for each package."""
    lost = [it for it in _asked(subject) if it.path and not it.folders]
    for package, it in {_package(it): it for it in reversed(lost)}.items():
        yield _problem(
            it.used, f"package {package!r} was not found", "name a folder it is in: --roots"
        )


def _package(it: Lookup) -> str:
    return it.used.path.partition("/")[0]


@rule(
    "MB703",
    "mesh-name-case",
    ERROR,
    what="A mesh file has another spelling on the disk: capitals where there are none.",
    why="macOS and Windows find it all the same, Linux does not: on the robot and in CI the link has "
    "no shape.",
    fix="Write it as the file is called.",
    bad=MESH % "package://arm_description/meshes/base.stl",
    good=MESH % "package://arm_description/meshes/Base.STL",
    beside={
        "arm_description/package.xml": "<package><name>arm_description</name></package>",
        "arm_description/meshes/Base.STL": "solid",
    },
)
def mesh_name_case(subject: Subject) -> Iterator[Problem]:
    """Paths that are there but for capitals."""
    for it in _asked(subject):
        if it.found and it.found != os.path.normpath(it.path):
            message = f"{it.path!r} is called {it.found!r} on the disk"
            yield _problem(it.used, message, f"write {it.found!r}")


@rule(
    "MB704",
    "path-of-one-machine",
    WARNING,
    what="A mesh is named by a path from the root of one machine's disk.",
    why="On every other machine, in CI and in a container the file is not there: the link has no "
    "shape in RViz and none in Gazebo.",
    fix="Write package://NAME/..., or file://$(find NAME)/... in xacro.",
    bad=MESH % "file:///home/me/ws/src/arm/meshes/base.stl",
    good=MESH % "package://arm/meshes/base.stl",
)
def path_of_one_machine(subject: Subject) -> Iterator[Problem]:
    """The first absolute path that no xacro substitution makes, and how many there are."""
    found = [it for it in _with(subject, "file") if "$" not in it.name]
    starts = starts_of(subject, [it.element for it in found])
    found = [it for it in found if _is_literal(subject, starts[it.element])]
    if found:
        message = f"{found[0].name!r} is a path of one machine{_and_more(len(found))}"
        yield _problem(found[0], message, "write package://NAME/...")


def _is_literal(subject: Subject, start: int) -> bool:
    return is_fixed(subject, start, "filename", constants=False)


@rule(
    "MB705",
    "backslash-in-path",
    WARNING,
    what="A mesh's path has backslashes.",
    why="On Linux a backslash is a letter like any other: no such file is found, in no program.",
    fix="Write slashes.",
    bad=MESH % r"package://arm\meshes\base.stl",
    good=MESH % "package://arm/meshes/base.stl",
)
def backslash_in_path(subject: Subject) -> Iterator[Problem]:
    """File names with a backslash."""
    for it in _used(subject.elements):
        if "\\" in it.name:
            right = it.name.replace("\\", "/")
            yield _problem(it, f"{it.name!r} has backslashes", f"write {right!r}")


@rule(
    "MB706",
    "mesh-without-file",
    ERROR,
    what="A mesh names no file.",
    why="Without the attribute urdfdom refuses the robot (urdf_parser link.cpp); with an empty one "
    "RViz and Gazebo find nothing to load.",
    fix="Name the file, or take the visual or collision out.",
    bad='<link name="a"><visual><geometry><mesh filename=""/></geometry></visual></link>',
    good=MESH % "package://arm/meshes/base.stl",
)
def mesh_without_file(subject: Subject) -> Iterator[Problem]:
    """Meshes of a link's shapes with an empty name or none; SDF's have a ``<uri>``."""
    for mesh in subject.elements.every("mesh"):
        name = mesh.get("filename")
        if (name is None or not name.strip()) and _is_shape(mesh):
            said = "no file" if name is None else "an empty file name"
            yield Problem(mesh, f"<mesh> has {said}", None if name is None else "filename")


def _is_shape(mesh: _Element) -> bool:
    """Does it stand at link/*/geometry?"""
    above = [str(it.tag) for it in mesh.iterancestors()][:4]
    return above[:1] + above[2:] == ["geometry", "link", "robot"] and mesh.find("uri") is None


@rule(
    "MB707",
    "mesh-format-unknown",
    WARNING,
    what="A mesh's name has no ending, or one of a format that neither RViz nor Gazebo reads.",
    why="Both choose the loader by the ending: the link has no shape.",
    fix="Convert it to STL, COLLADA (.dae) or OBJ.",
    bad=MESH % "package://arm/meshes/base.step",
    good=MESH % "package://arm/meshes/base.stl",
)
def mesh_format_unknown(subject: Subject) -> Iterator[Problem]:
    """Endings that nobody knows; textures are images."""
    for it in _meshes(subject):
        ending = _ending(it)
        if ending not in READABLE and ending not in PARTLY:
            said = f"ends in .{ending}, which" if ending else "has no ending, so that"
            yield _problem(it, f"{it.name!r} {said} no program can load", "use .stl, .dae or .obj")


def _meshes(subject: Subject) -> list[Used]:
    used = _used(subject.elements)
    return [it for it in used if it.element.tag == "mesh" and "$" not in it.name]


def _ending(it: Used) -> str:
    base = it.name.replace("\\", "/").rpartition("/")[2]
    return base.rpartition(".")[2].lower() if "." in base else ""


@rule(
    "MB708",
    "mesh-format-partly",
    NOTE,
    what="A mesh has a format that some of RViz, Gazebo Classic and gz cannot read.",
    why="There the link has no shape: Gazebo Classic loads STL, COLLADA and OBJ, gz also glTF and "
    "FBX from Garden on, RViz what assimp reads.",
    fix="Convert it where the robot is to be seen in those programs too.",
    bad=MESH % "package://arm/meshes/base.glb",
    good=MESH % "package://arm/meshes/base.dae",
)
def mesh_format_partly(subject: Subject) -> Iterator[Problem]:
    """Once for each such format."""
    seen = set()
    for it in _meshes(subject):
        ending = _ending(it)
        if ending in PARTLY and ending not in seen:
            seen.add(ending)
            yield _problem(it, f"{it.name!r}: {PARTLY[ending]}", "use .stl, .dae or .obj")


@rule(
    "MB709",
    "mixed-schemes",
    NOTE,
    what="The meshes of one robot are named in several ways: package://, model://, paths.",
    why="Each program resolves only some of them, so some links have a shape and others none.",
    fix="Name all of them by package://.",
    bad=(MESH % "package://arm/meshes/a.stl")
    + '<link name="b"><visual><geometry><mesh filename="meshes/b.stl"/></geometry></visual></link>',
    good=(MESH % "package://arm/meshes/a.stl"),
)
def mixed_schemes(subject: Subject) -> Iterator[Problem]:
    """The first file that is named in another way than the first."""
    used = [it for it in _used(subject.elements) if "$" not in it.name]
    other = next((it for it in used if it.scheme != used[0].scheme), None)
    if other is not None:
        message = f"{other.name!r} beside {used[0].name!r}: two ways to name meshes"
        yield _problem(other, message, "use package:// for all")


@rule(
    "MB710",
    "model-uri",
    WARNING,
    what="A mesh is named by model://.",
    why="Gazebo finds it through its resource path; RViz's resource_retriever knows package://, "
    "file:// and http:// only, and shows the link without a shape.",
    fix="Write package://NAME/...; both Gazebos turn that into model:// when a URDF is loaded.",
    bad=MESH % "model://arm/meshes/base.stl",
    good=MESH % "package://arm/meshes/base.stl",
)
def model_uri(subject: Subject) -> Iterator[Problem]:
    """The first of them, and how many there are."""
    found = _with(subject, "model")
    if found:
        message = f"RViz cannot load {found[0].name!r}{_and_more(len(found))}"
        yield _problem(found[0], message, "write package://")


@rule(
    "MB711",
    "mesh-from-the-net",
    NOTE,
    what="A mesh is loaded from the network.",
    why="RViz fetches it at every start, Gazebo takes only Fuel's addresses: without a network, or "
    "when the page moves, the link has no shape.",
    fix="Put the file into a package.",
    bad=MESH % "https://example.org/base.stl",
    good=MESH % "package://arm/meshes/base.stl",
)
def mesh_from_the_net(subject: Subject) -> Iterator[Problem]:
    """The first of them, and how many there are."""
    found = _with(subject, "http", "https")
    if found:
        message = f"{found[0].name!r} needs the network{_and_more(len(found))}"
        yield _problem(found[0], message, "put it into a package")


@rule(
    "MB712",
    "find-left-over",
    ERROR,
    what="A mesh's path holds $(find ...), which only xacro understands.",
    why="In a plain URDF nothing replaces it: no program finds the file.",
    fix="Name the file .xacro and expand it, or write package://NAME/....",
    bad=MESH % "file://$(find arm)/meshes/base.stl",
    good=MESH % "package://arm/meshes/base.stl",
)
def find_left_over(subject: Subject) -> Iterator[Problem]:
    """The first of them, and how many; a xacro file in disguise is for MB105 to tell."""
    if any("xacro" in str(uri) for uri in subject.document.root.nsmap.values()):
        return
    found = [it for it in _used(subject.elements) if "$(find" in it.name]
    if found:
        message = f"{found[0].name!r} holds a xacro substitution{_and_more(len(found))}"
        yield _problem(found[0], message, "write package://NAME/...")
