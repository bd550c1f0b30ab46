# SPDX-License-Identifier: Apache-2.0
"""A description whole, whatever its file is: URDF, xacro, SDF or a list of parts that are joined."""

from __future__ import annotations

from collections.abc import Mapping

from multibot_rewrite.description.sources.read import JOIN, Source, SourceText, read_alone


def read_whole(source: Source, xacro_args: Mapping[str, str], trust: bool = False) -> SourceText:
    """Return a source's bytes and the files that were read; ``trust``: xacro without the sandbox."""
    if not isinstance(source, bytes) and str(source).endswith(JOIN) and not xacro_args:
        from multibot_rewrite.description.joining.from_file import read_joined

        return read_joined(str(source), trust)
    return read_alone(source, xacro_args, trust)
