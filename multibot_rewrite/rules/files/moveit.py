"""MoveIt's controllers against the parameter files beside them."""

from __future__ import annotations

import os
from collections.abc import Iterator

import yaml

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.model import InputError
from multibot_rewrite.companions.kinds import PARAMS, is_beside, kind_of
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.yaml_text import YamlText, line_of, read_yaml
from multibot_rewrite.description.sources.packages import entries
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.knowledge.parameters import built_in_nodes
from multibot_rewrite.knowledge.stacks import load_nodes
from multibot_rewrite.producers.evidence.parameter_files import given_nodes
from multibot_rewrite.rules.closure.moveit import moveit_gaps
from multibot_rewrite.rules.files.records import Remark, remark_at


def unknown_controllers(file: NamedFile) -> Iterator[Remark]:
    """Controllers that no parameter file in the folder declares, though one declares others."""
    release, document = file.context.distro, file.document
    assert document is not None
    try:
        given = given_nodes(_parameter_files(file), built_in_nodes(release))
    except InputError:  # it is told where that file is linted
        return
    for gap in moveit_gaps([document], given, load_nodes(release)):
        node = _at(document, gap.place.line) if gap.place else None
        if node is not None and not PLACEHOLDER.search(gap.name):
            hint = f"did you mean {gap.near}?" if gap.near else ""
            yield remark_at(node, f"MoveIt uses {gap.name}, which no parameter file here has", hint)


def _parameter_files(file: NamedFile) -> Iterator[YamlText]:
    folder = os.path.dirname(os.path.abspath(file.file))
    for name in sorted(entries(folder)):
        path = os.path.join(folder, name)
        data = read_file(path) if is_beside(name) else b""
        if kind_of(data) == PARAMS:
            yield read_yaml(data, path)


def _at(document: YamlText, line: int) -> yaml.Node | None:
    """The first scalar in a line."""
    waiting = [document.root] if document.root is not None else []
    for node in waiting:  # grows
        if isinstance(node, yaml.ScalarNode):
            if line_of(node) == line:
                return node
            continue
        for it in node.value:
            waiting += it if isinstance(it, tuple) else (it,)
    return None
