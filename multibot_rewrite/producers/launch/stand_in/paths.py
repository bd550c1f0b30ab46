# SPDX-License-Identifier: Apache-2.0
"""Paths and joined texts of the stand-in for launch.

Source: launch rolling, substitutions/path_join_substitution.py, string_join_substitution.py; ``/`` is
in humble 1.0.9, jazzy 3.4.5 and kilted 3.8.2, that of folders in 1.0.13, 3.4.9 and 3.8.6.
"""

from __future__ import annotations

import os
from typing import Any

from multibot_rewrite.producers.launch.stand_in.values import (
    Kept,
    LaunchContext,
    Substitution,
    SubstitutionFailure,
    Text,
    normalize_to_list_of_substitutions,
    text_of,
)


class Joined(Substitution):
    """A path, to which ``/`` adds more."""

    def __truediv__(self, additional_path: Text) -> PathJoinSubstitution:
        return PathJoinSubstitution([self, additional_path])


class PathJoinSubstitution(Kept, Joined):
    """A path of parts; each is a text, a substitution, or several that are put together."""

    names = ("substitutions",)
    substitutions: Any

    def perform(self, context: LaunchContext) -> str:
        return os.path.join(*(text_of(context, it) for it in self.substitutions))


class PathSubstitution(Kept, Joined):
    """A path of one text or substitution; those of a list are parts."""

    names = ("path",)
    path: Text

    def perform(self, context: LaunchContext) -> str:
        parts = normalize_to_list_of_substitutions(self.path)
        return PathJoinSubstitution(parts).perform(context)


class StringJoinSubstitution(Kept, Substitution):
    """Texts with a delimiter between them."""

    names = ("substitutions", "delimiter")
    substitutions: Any
    delimiter: Text

    def perform(self, context: LaunchContext) -> str:
        delimiter = text_of(context, "" if self.delimiter is None else self.delimiter)
        return delimiter.join(text_of(context, it) for it in self.substitutions)


class ThisLaunchFile(Kept, Substitution):
    """The path of the launch file."""

    def perform(self, context: LaunchContext) -> str:
        return str(context.get_locals_as_dict()["current_launch_file_path"])


class ThisLaunchFileDir(Kept, Joined):
    """The folder of the launch file."""

    def perform(self, context: LaunchContext) -> str:
        return os.path.dirname(ThisLaunchFile().perform(context))


class LaunchLogDir(Kept, Joined):
    """The folder of the logs, where the environment names one."""

    def perform(self, context: LaunchContext) -> str:
        return os.environ.get("ROS_LOG_DIR", "")


class FileContent(Kept, Substitution):
    """The text of a file."""

    names = ("path",)
    path: Text

    def perform(self, context: LaunchContext) -> str:
        path = text_of(context, self.path)
        if not os.path.isfile(path):
            raise SubstitutionFailure(f"File not found: {path}")
        with open(path, encoding="utf-8") as file:
            return file.read()
