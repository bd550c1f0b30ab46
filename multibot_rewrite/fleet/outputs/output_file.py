# SPDX-License-Identifier: Apache-2.0
"""A file that a build writes, with the source line of each line."""

import os
from collections.abc import Collection, Iterable, Iterator
from functools import lru_cache
from typing import NamedTuple, TypeAlias

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.read import JOIN, XACRO, read_file
from multibot_rewrite.fleet.file.robot_spec import RobotSpec
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.producers.ends import BRIDGE_FILE
from multibot_rewrite.related_files.context import NAMESPACE_SLOT, TAG_SLOT
from multibot_rewrite.related_files.named_file import NamedFile
from multibot_rewrite.related_files.yaml_text import YamlText, read_yaml

# The plan of a built fleet.
PLAN = "plan.yaml"
# The parameter file of a robot that has none, with what its nodes need.
DEFAULTS = "params.yaml"
# The options of Cartographer of a robot that has none.
OPTIONS = "cartographer.lua"


class OutputFile(NamedTuple):
    """A file to be written: its path below the output folder, its bytes, the files it is made from."""

    path: str
    data: bytes
    sources: tuple[str, ...] = ()

    @property
    def text(self) -> str:
        """The bytes as str; raises nothing."""
        return self.data.decode("utf-8", "replace")

    @property
    def yaml(self) -> YamlText:
        """The file as YAML; raises InputError as ``read_yaml``."""
        return read_yaml(self.data, self.path)


class ReadFile(NamedTuple):
    """A related file as it was read, to be checked for the robots that it is rewritten for."""

    file: NamedFile
    robots: tuple[RewrittenRobot, ...]


FilesAndFindings: TypeAlias = Iterator[OutputFile | Finding]
FilesToCheck: TypeAlias = Iterator[OutputFile | ReadFile | Finding]


def described_path(robot: RewrittenRobot, node: str) -> str:
    """Return the path of the description that a node publishes in addition to the robot's."""
    return path_for(robot, f"{node.replace('/', '_')}.urdf")


def path_for(robot: RewrittenRobot, source: str) -> str:
    """Return where the robot's version of a source file goes: ``robot1/params.yaml``."""
    # Files of one name go into folders, as many as tell them apart: ``robot1/base/params.yaml``. A
    # vendor's launch files may want one in a place of its own.
    kinds = robot.spec.related_files
    name = name_among(source, (it for its in kinds.values() for it in its))
    kind = next((kind for kind, its in kinds.items() if source in its), "")
    above, last = os.path.split(name)
    if last == BRIDGE_FILE and kind != "bridge":
        # The robot's bridge is called so.
        name = os.path.join(above, f"{kind}_{last}")
    return placed_path(robot, name)


def gz_bridge_path(robot: RewrittenRobot) -> str:
    """Return where the file of the robot's bridge goes."""
    return placed_path(robot, BRIDGE_FILE)


def placed_path(robot: RewrittenRobot, name: str) -> str:
    """Return where an output of a robot goes, by its name: a vendor's place, if it has one there."""
    return f"{robot.spec.name}/{dict(robot.spec.places).get(name, name)}"


def name_among(source: str, every: Iterable[str]) -> str:
    """Return the name of a file, with as many of its folders as tell it from others of that name."""
    name = os.path.basename(source)
    alike = {os.path.abspath(it) for it in every if os.path.basename(it) == name}
    one_of_several = len(alike) > 1 and os.path.abspath(source) in alike
    return _shortest_own_end(os.path.abspath(source), alike) if one_of_several else name


def _shortest_own_end(path: str, alike: Collection[str]) -> str:
    """Return the shortest end of a path, in whole steps, that no other one ends with."""
    steps = os.path.relpath(path, os.path.commonpath(map(os.path.dirname, alike))).split(os.sep)
    ends = (os.sep.join(steps[at:]) for at in range(len(steps) - 1, -1, -1))
    found = (end for end in ends if sum(it.endswith(f"/{end}") for it in alike) == 1)
    return next(found, os.sep.join(steps))


def expanded_name(path: str) -> str:
    """Return the file's name once xacro is expanded, or parts are joined."""
    name = os.path.basename(path).removesuffix(XACRO).removesuffix(JOIN)
    return name if "." in name else f"{name}.urdf"


def params_paths(robot: RewrittenRobot, files: Collection[str]) -> tuple[str, ...]:
    """Return a robot's parameter files among the ``files`` of a build; the default one if none."""
    named = robot.spec.related_files.get("params", ())
    paths = tuple(path_for(robot, it) for it in named or (DEFAULTS,))
    return tuple(it for it in paths if it in files)


def params_of(spec: RobotSpec) -> dict[str, YamlText]:
    """Return a robot's parameter files by path, as a launch fills them; raises as ``read_yaml``."""
    return {it: own_yaml(spec, it) for it in spec.related_files.get("params", ())}


def text_of(spec: RobotSpec, path: str) -> bytes:
    """Return the bytes of a file of a robot, which may be made for it; raises as ``read_file``."""
    filled = dict(spec.filled)
    return filled[path].encode() if path in filled else read_file(path)


def own_yaml(spec: RobotSpec, path: str) -> YamlText:
    """Return a YAML file of a robot; raises as ``yaml_of``."""
    return read_yaml(text_of(spec, path), path)


def yaml_of(path: str) -> YamlText:
    """Return a YAML file, parsed; raises InputError as ``read_yaml``."""
    return read_yaml(read_file(path), path)


def line_in_source(file: OutputFile, line: int) -> tuple[str, int]:
    """Return (source of a file, its line) that a line of the file was made from."""
    for start, end, first, last in _changed_ranges(file):
        if first < line <= last:
            return file.sources[0], max(1, min(start + line - first, end))
    return file.sources[0], 1


@lru_cache(maxsize=16)
def _changed_ranges(file: OutputFile) -> tuple[tuple[int, int, int, int], ...]:
    """Return the changed ranges: lines of the source, and lines of the file made from them."""
    from difflib import SequenceMatcher

    try:
        old = read_file(file.sources[0]).decode("utf-8", "replace").splitlines()
    except InputError:
        return ()
    codes = SequenceMatcher(None, old, file.text.splitlines(), False).get_opcodes()
    return tuple(it[1:] for it in codes)


def without_slots(it: Finding, spec: RobotSpec) -> Finding:
    """Return a finding about the file of any robot with the names of one in place of slots."""
    message, hint = (
        text.replace(NAMESPACE_SLOT, spec.namespace).replace(TAG_SLOT, spec.tag)
        for text in (it.message, it.hint)
    )
    return it._replace(message=message, hint=hint)
