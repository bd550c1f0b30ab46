# SPDX-License-Identifier: Apache-2.0
"""The nodes that the text of a parameter file has sections for."""

from __future__ import annotations

from collections.abc import Mapping

from multibot_rewrite.knowledge.parameters import built_in_nodes
from multibot_rewrite.knowledge.records import UNKNOWN
from multibot_rewrite.planning.records import Given, Run
from multibot_rewrite.producers.evidence.parameter_files import given_nodes
from multibot_rewrite.related_files.yaml_text import read_yaml
from multibot_rewrite.system.records import Place


def run_given(
    name: str,
    known: str,
    type_: str,
    values: Mapping[str, Given],
    place: Place,
    manager: str = "",
) -> Run:
    """Return what the files set for a node; of a controller its type and manager, too."""
    fact = UNKNOWN._replace(known=known)
    own = Run("", name, "", name.rpartition("/")[2], (), fact, host_name=manager)
    return own._replace(values=values, program=type_, place=place)


def given_in(text: str, release: str = "jazzy", file: str = "params.yaml") -> list[Run]:
    """Return the sections of the text, each with the values that it has."""
    return given_nodes([read_yaml(text.encode(), file)], built_in_nodes(release))
