# SPDX-License-Identifier: Apache-2.0
"""The nodes that the text of a parameter file has sections for."""

from __future__ import annotations

from multibot_rewrite.companions.yaml_text import read_yaml
from multibot_rewrite.knowledge.parameters import built_in_nodes
from multibot_rewrite.producers.evidence.parameter_files import given_nodes
from multibot_rewrite.spelling.records import GivenNode


def given_in(text: str, release: str = "jazzy", file: str = "params.yaml") -> list[GivenNode]:
    """The sections of the text, each with the values that it has."""
    return given_nodes([read_yaml(text.encode(), file)], built_in_nodes(release))
