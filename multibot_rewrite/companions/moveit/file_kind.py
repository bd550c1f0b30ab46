# SPDX-License-Identifier: Apache-2.0
"""Which kind of MoveIt file a YAML file is: by its content, else by its name."""

from __future__ import annotations

import os
from collections.abc import Iterator

import yaml

from multibot_rewrite.companions.moveit.name_sites import MoveitKind, entries, kinds
from multibot_rewrite.companions.params.sections import PARAMETERS
from multibot_rewrite.companions.yaml_text import YamlText, refused

EMPTY = "empty"
OF_SERVO, PLANNING, SIMPLE = "servo", "planning", "moveit_simple_controller_manager"
# Its controllers.
NAMES = "controller_names"
# Below which parameter MoveItConfigsBuilder puts the content of a file; that of others is at the top.
ABOVE = {
    "kinematics": "robot_description_kinematics",
    "joint_limits": "robot_description_planning",
    OF_SERVO: "moveit_servo",
}
_PIPELINE = "_planning"
# What a file of one pipeline has at its top, whatever it is called.
_OF_PIPELINE = frozenset(("planning_plugin", "planning_plugins", "request_adapters"))
_DEPTH = 4


def file_kind(document: YamlText) -> str:
    """Which kind of MoveIt file this is, by its content, else by its name; ``empty`` if it is empty.

    Raises InputError if it is not a MoveIt file.
    """
    kind = find_kind(document)
    return kind.name if kind else EMPTY


def find_kind(document: YamlText) -> MoveitKind | None:
    """The kind of a file, None if it is empty; InputError if it is not a MoveIt file."""
    root = document.root
    if root is None or root.tag == "tag:yaml.org,2002:null":
        return None
    if not isinstance(root, yaml.MappingNode):
        what = "not a MoveIt file: it is not a map of keys and values"
        raise refused(document, root, what)
    _refuse_params(document, root, _DEPTH)
    paths = set(_paths(root))
    known = (kind for kind in kinds() if not paths.isdisjoint(kind.marks))
    if kind := next(known, None) or _by_values(root) or _by_name(document.file):
        return kind
    words = ", ".join(str(key.value) for key, _ in list(entries(root))[:4])
    what = f"not a known kind of MoveIt file: it starts with {words or 'nothing'}; leave it out,"
    raise refused(document, root, f"{what} or list a parameter file under params")


def pipeline_of(path: str) -> str:
    """``ompl`` of ``ompl_planning.yaml``; empty for a file that is of no pipeline."""
    stem = os.path.splitext(os.path.basename(path))[0]
    return stem.removesuffix(_PIPELINE) if stem.endswith(_PIPELINE) else ""


def parameter_above(kind: MoveitKind, document: YamlText) -> str:
    """What stands before the names of a file's parameters: ``ompl.``, or nothing."""
    keys = {str(key.value) for key, _ in entries(document.root)}
    above = ABOVE.get(kind.name, "")
    if kind.name == PLANNING:
        above = pipeline_of(document.file)
        above = above if above or keys.isdisjoint(_OF_PIPELINE) else "pipeline"
    if NAMES in keys:
        above = SIMPLE
    return f"{above}." if above and above not in keys else ""


def _refuse_params(document: YamlText, node: yaml.Node, depth: int) -> None:
    for key, value in entries(node) if depth else ():
        if key.value == PARAMETERS:
            what = f"{PARAMETERS} makes it a parameter file; list it under params"
            raise refused(document, key, what)
        _refuse_params(document, value, depth - 1)


def _paths(root: yaml.Node) -> Iterator[str]:
    """The keys of the first two levels, the second with ``*`` for the first as well."""
    for key, value in entries(root):
        first, _, rest = str(key.value).partition(".")
        yield from (str(key.value), first)
        for word in (rest.partition(".")[0], *(str(below.value) for below, _ in entries(value))):
            yield from (f"{first}.{word}", f"*.{word}")


def _by_values(root: yaml.Node) -> MoveitKind | None:
    """A file of numbers only holds joint positions."""
    values = [value for _, value in entries(root)]
    if values and all(it.tag.endswith((":float", ":int", "!degrees", "!radians")) for it in values):
        return next(kind for kind in kinds() if kind.name == "initial_positions")
    return None


def _by_name(file: str) -> MoveitKind | None:
    name = os.path.basename(file).lower()
    return next((kind for kind in kinds() if any(it in name for it in kind.files)), None)
