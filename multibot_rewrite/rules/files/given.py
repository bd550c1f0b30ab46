# SPDX-License-Identifier: Apache-2.0
"""What a file, and the parameter files of the same robot, set for nodes."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.kinds import PARAMS, is_beside, kind_of
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.yaml_text import YamlText, read_yaml
from multibot_rewrite.description.sources.packages import entries
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.sources.trace import alike
from multibot_rewrite.knowledge.parameters import built_in_nodes
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.knowledge.stacks import load_nodes
from multibot_rewrite.producers.evidence.parameter_files import given_nodes
from multibot_rewrite.spelling.records import Run
from multibot_rewrite.system.records import NOWHERE, Place


class Beside(NamedTuple):
    """What all parameter files of a robot set for nodes, and the nodes that are known by name."""

    given: tuple[Run, ...]
    known: Mapping[str, NodeFacts]


def beside(file: NamedFile) -> Beside:
    """Of the robot that a file is for; of a file alone, by the parameter files in its folder."""
    if Beside not in file.memo:
        release = file.context.distro
        file.memo[Beside] = Beside(_given(file, _in_folder(file)), load_nodes(release))
    found: Beside = file.memo[Beside]
    return found


def given_in(file: NamedFile) -> tuple[Run, ...]:
    """What is set for nodes where the file is for a certain robot, else what the file sets."""
    if file.is_certain:
        return beside(file).given
    return _given(file, [file.document] if file.document else [])


def is_set_beside(file: NamedFile, title: str, name: str) -> bool:
    """Does a parameter file of the robot have it for the node of a section, or of its plugin?"""
    node = _last(title.partition(":")[0])
    return any(name in it.values for it in beside(file).given if _last(it.node) == node)


def _last(name: str) -> str:
    return name.rpartition("/")[2]


def is_in(file: NamedFile, place: Place) -> bool:
    """Is the place in this file?"""
    return os.path.abspath(place.file) == os.path.abspath(file.file)


def did_you_mean_at(near: str, place: Place) -> str:
    """The hint: the name that is there, and its place."""
    if place == NOWHERE:
        return f"did you mean {near}?"
    return f"did you mean {near} ({shown(place)})?" if near else f"see {shown(place)}"


def shown(place: Place) -> str:
    """A place of a file below the current folder by its path from there."""
    return str(place._replace(file=alike(place.file, os.curdir)))


def _given(file: NamedFile, documents: Iterable[YamlText]) -> tuple[Run, ...]:
    """Nothing where a file cannot be read: that is told where it is linted itself."""
    try:
        return tuple(given_nodes(documents, built_in_nodes(file.context.distro)))
    except InputError:
        return ()


def _in_folder(file: NamedFile) -> Iterator[YamlText]:
    folder = os.path.dirname(os.path.abspath(file.file))
    for name in sorted(entries(folder)):
        path = os.path.join(folder, name)
        data = read_file(path) if is_beside(name) else b""
        if kind_of(data) == PARAMS:
            yield read_yaml(data, path)
