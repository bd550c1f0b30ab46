"""Formats of meshes that not every program reads."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.meshes.shared import MESH, Used, problem, used_files
from multibot_rewrite.rules.subject import Subject

READABLE = frozenset(("stl", "dae", "obj"))
# Programs that cannot read a format which RViz reads (through assimp).
PARTLY = {
    "gltf": "Gazebo Classic and gz before Garden cannot read glTF",
    "glb": "Gazebo Classic and gz before Garden cannot read glTF",
    "fbx": "Gazebo Classic and gz before Garden cannot read FBX",
    "ply": "Gazebo cannot read PLY",
    "mesh": "only RViz reads Ogre's format",
}


@rule(
    "MB707",
    "mesh-format-unknown",
    WARNING,
    what="The file name of a mesh has no extension, or that of a format that neither RViz nor "
    "Gazebo reads.",
    why="Both choose the loader by the extension: the link has no shape.",
    fix="Convert it to STL, COLLADA (.dae) or OBJ.",
    bad=MESH % "package://arm/meshes/base.step",
    good=MESH % "package://arm/meshes/base.stl",
)
def mesh_format_unknown(subject: Subject) -> Iterator[Problem]:
    """Extensions of meshes that no program knows."""
    for it in _meshes(subject):
        ending = _ending(it)
        if ending not in READABLE and ending not in PARTLY:
            fault = f"no program can load .{ending}" if ending else "it has no extension"
            yield problem(it, f"{it.name!r}: {fault}", "use .stl, .dae or .obj")


def _meshes(subject: Subject) -> list[Used]:
    used = used_files(subject)
    return [it for it in used if it.element.tag == "mesh" and "$" not in it.name]


def _ending(it: Used) -> str:
    base = it.name.replace("\\", "/").rpartition("/")[2]
    return base.rpartition(".")[2].lower() if "." in base else ""


@rule(
    "MB708",
    "mesh-format-partly",
    NOTE,
    what="A mesh has a format that some of RViz, Gazebo Classic and gz cannot read.",
    why="In those programs the link has no shape: Gazebo Classic loads STL, COLLADA and OBJ, gz "
    "also glTF and FBX from Garden on, RViz what assimp reads.",
    fix="Convert it if the robot is to be shown in those programs too.",
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
            yield problem(it, f"{it.name!r}: {PARTLY[ending]}", "use .stl, .dae or .obj")
