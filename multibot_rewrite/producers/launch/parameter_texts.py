# SPDX-License-Identifier: Apache-2.0
"""The texts with parameters that a launch file gives a node, as parameter files."""

from __future__ import annotations

from functools import lru_cache

from multibot_rewrite.base.model import InputError
from multibot_rewrite.companions.params.sections import raw_sections
from multibot_rewrite.companions.yaml_text import YamlText, read_yaml
from multibot_rewrite.producers.launch.records import ParameterText

# The name of a file for what a launch file gives itself.
OWN = "parameters of a launch file"


@lru_cache(maxsize=64)
def has_sections(it: ParameterText) -> bool:
    """Is it a parameter file with sections of nodes?"""
    try:
        return any(True for _ in raw_sections(document_of(it.file, it.text)))
    except InputError:
        return False


@lru_cache(maxsize=64)
def document_of(file: str, text: str) -> YamlText:
    """A parameter file, or with no ``file`` what a launch file sets itself; raises InputError."""
    return read_yaml(text.encode(), file or OWN)
