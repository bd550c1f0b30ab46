"""A file that a build writes, and what each step of a build yields: files and findings."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import NamedTuple, TypeAlias

from multibot_rewrite.companions.yaml_text import YamlText, read_yaml
from multibot_rewrite.findings.finding import Finding
from multibot_rewrite.fleets.fleet_file import RobotSpec
from multibot_rewrite.fleets.rewritten_robots import RewrittenRobot
from multibot_rewrite.sources.read import read_file


class OutputFile(NamedTuple):
    """A file to be written: its path below the output folder, its bytes, the files it is made from."""

    path: str
    data: bytes
    sources: tuple[str, ...] = ()


FilesAndFindings: TypeAlias = Iterator[OutputFile | Finding]


def path_for(robot: RewrittenRobot, source: str) -> str:
    """Where the robot's version of a source file goes: ``robot1/params.yaml``.

    Of two files with one name each is in a folder called as its own: ``robot1/base/params.yaml``. A
    vendor's launch files may want it in a place of their own.
    """
    name = os.path.basename(source)
    every = (it for its in robot.spec.companions.values() for it in its)
    alike = {it for it in every if os.path.basename(it) == name}
    if len(alike) > 1 and source in alike:
        name = f"{os.path.basename(os.path.dirname(os.path.abspath(source)))}/{name}"
    return f"{robot.spec.name}/{dict(robot.spec.places).get(name, name)}"


def expanded_name(path: str) -> str:
    """The file's name once xacro is expanded."""
    name = os.path.basename(path).removesuffix(".xacro")
    return name if "." in name else f"{name}.urdf"


def params_of(spec: RobotSpec) -> dict[str, YamlText]:
    """A robot's parameter files by path, as a launch fills them; raises InputError as ``read_yaml``."""
    filled = dict(spec.filled)
    return {
        it: read_yaml(filled[it].encode(), it) if it in filled else yaml_of(it)
        for it in spec.companions.get("params", ())
    }


def yaml_of(path: str) -> YamlText:
    """Read a YAML file; raises InputError as ``read_yaml``."""
    return read_yaml(read_file(path), path)
