# SPDX-License-Identifier: Apache-2.0
"""Substitutions of launch_ros, and the index of packages, for machines without them.

Source: launch_ros jazzy, substitutions/; ament_index_python jazzy, packages.py and resources.py.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import ClassVar

from multibot_rewrite.producers.launch.stand_in.values import (
    Kept,
    LaunchContext,
    Substitution,
    SubstitutionFailure,
    Text,
    normalize_to_list_of_substitutions,
    str_of,
    text_of,
)


class Joined(Substitution):
    """A path, to which ``/`` adds more."""

    def __truediv__(self, additional_path: Text) -> PathJoinSubstitution:
        return PathJoinSubstitution([self, additional_path])


class PathJoinSubstitution(Kept, Joined):
    """A path of parts; each is a text, a substitution, or several that are put together."""

    names = ("substitutions",)

    def perform(self, context: LaunchContext) -> str:
        return os.path.join(*(text_of(context, it) for it in self.substitutions))


class PathSubstitution(Kept, Joined):
    """A path of one text or substitution; those of a list are parts."""

    names = ("path",)

    def perform(self, context: LaunchContext) -> str:
        parts = normalize_to_list_of_substitutions(self.path)
        return PathJoinSubstitution(parts).perform(context)


class StringJoinSubstitution(Kept, Substitution):
    """Texts with a delimiter between them."""

    names = ("substitutions", "delimiter")

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

    def perform(self, context: LaunchContext) -> str:
        path = text_of(context, self.path)
        if not os.path.isfile(path):
            raise SubstitutionFailure(f"File not found: {path}")
        with open(path, encoding="utf-8") as file:
            return file.read()


_INDEX = os.path.join("share", "ament_index", "resource_index")


class PackageNotFoundError(KeyError):
    """A package is not installed. ``asked`` are all that were: a launch file may go on without one."""

    asked: ClassVar[dict[str, None]] = {}


class FindPackage(Kept, Joined):
    """A folder of a package."""

    names: tuple[str, ...] = ("package",)

    def perform(self, context: LaunchContext) -> str:
        return self.find(text_of(context, self.package))

    def find(self, package_name: str) -> str:
        raise NotImplementedError


class FindPackagePrefix(FindPackage):
    """The folder that a package is installed in."""

    def find(self, package_name: str) -> str:
        return get_package_prefix(package_name)


class FindPackageShare(FindPackage):
    """The share folder of a package."""

    def find(self, package_name: str) -> str:
        return get_package_share_directory(package_name)


class ExecutableInPackage(FindPackagePrefix):
    """The path of a program."""

    names = ("executable", "package")

    def perform(self, context: LaunchContext) -> str:
        name = text_of(context, self.package)
        path = os.path.join(
            super().perform(context), "lib", name, text_of(context, self.executable)
        )
        if not os.path.isfile(path):
            raise SubstitutionFailure(f"executable not found: {path}")
        return path


class ParameterSubstitution(Kept, Substitution):
    """A parameter that is set for all nodes."""

    names = ("name", "default")

    def perform(self, context: LaunchContext) -> str:
        name = text_of(context, self.name)
        known = (
            it for it in context.launch_configurations.get("global_params", ()) if it[0] == name
        )
        found = next((str(it[1]) for it in known if isinstance(it, tuple)), None)
        if found is None and self.default is None:
            raise SubstitutionFailure(f"parameter '{name}' not found")
        return text_of(context, str_of(self.default)) if found is None else found


def get_package_prefix(package_name: str) -> str:
    """Return the folder that a package is installed in; raises PackageNotFoundError."""
    found = has_resource("packages", package_name)
    if not isinstance(found, str):
        PackageNotFoundError.asked[package_name] = None
        raise PackageNotFoundError(f"package '{package_name}' not found")
    return found


def get_package_share_directory(package_name: str, print_warning: bool = True) -> str:
    """Return the share folder of a package; raises PackageNotFoundError."""
    return os.path.join(get_package_prefix(package_name), "share", package_name)


def get_package_share_path(package_name: str, print_warning: bool = True) -> Path:
    """Return the share folder of a package as a path; raises PackageNotFoundError."""
    return Path(get_package_share_directory(package_name))


def get_packages_with_prefixes() -> dict[str, str]:
    """Return each package with the folder that it is installed in."""
    prefixes = reversed(_prefixes())
    return {
        name: it for it in prefixes for name in os.listdir(os.path.join(it, _INDEX, "packages"))
    }


def has_resource(resource_type: str, resource_name: str) -> str | bool:
    """Return the folder that has a resource, False for none."""
    own = os.path.join(_INDEX, resource_type, resource_name)
    return next((it for it in _prefixes() if os.path.isfile(os.path.join(it, own))), False)


def get_resource(resource_type: str, resource_name: str) -> tuple[str, str]:
    """Return the text of a resource and the folder that has it; raises LookupError."""
    found = has_resource(resource_type, resource_name)
    if not isinstance(found, str):
        raise LookupError(f"no resource {resource_name!r} of type {resource_type!r}")
    path = Path(found, _INDEX, resource_type, resource_name)
    return path.read_text(encoding="utf-8"), found


def _prefixes() -> list[str]:
    named = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    return [it for it in named if it and os.path.isdir(os.path.join(it, _INDEX, "packages"))]
