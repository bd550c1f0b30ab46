# SPDX-License-Identifier: Apache-2.0
"""Plugin definitions of installed packages: entry points ``multibot_rewrite.plugin_definitions``.

An entry point names a package whose ``*.vocab`` files are read; its code is not imported.
"""

import os
import re
import sys
from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import NamedTuple

from multibot_rewrite.base.model import DefinitionsError

GROUP = "multibot_rewrite.plugin_definitions"
_METADATA = (".dist-info", ".egg-info")


class Installed(NamedTuple):
    """One definition file of an installed distribution."""

    distribution: str
    version: str
    path: str

    @property
    def name(self) -> str:
        """The file as messages call it: ``acme-robots 1.0: /…/acme.vocab``."""
        return f"{self.distribution} {self.version}: {self.path}"


@lru_cache(maxsize=1)
def installed() -> tuple[Installed, ...]:
    """Return the definition files of all installed packages, by distribution, entry point and file.

    Raises DefinitionsError, naming distribution and version, if one cannot be found.
    """
    found = [file for folder in announcing(sys.path) for file in _files(folder)]
    found.sort(key=lambda file: _key(file.distribution))
    return tuple({os.path.realpath(file.path): file for file in found}.values())


def advice(message: str) -> str:
    """Return the hint for an error in a file of an installed package; empty for other files."""
    owner = next((file for file in installed() if message.startswith(f"{file.name}:")), None)
    return _reinstall_hint(owner.distribution) if owner else ""


def announcing(folders: Iterable[str]) -> list[str]:
    """Return the metadata folders below ``folders`` that name the group.

    It searches bytes, because importlib.metadata takes longer to import than a rewrite takes. Of a
    distribution that is there twice the first one counts, as it does for imports.
    """
    paths = [
        os.path.join(folder, name)
        for folder in folders
        for name in _sorted_names(folder or ".")
        if name.endswith(_METADATA) and not name.startswith("~")  # pip's half-removed ones
    ]
    named = {path for path in paths if GROUP.encode() in _entry_points_bytes(path)}
    # Usually none does: then the order of the folders does not matter.
    first = {_key(os.path.basename(path)): path for path in reversed(paths)} if named else {}
    return [path for path in first.values() if path in named]


def _sorted_names(folder: str) -> list[str]:
    try:
        return sorted(os.listdir(folder))
    except OSError:  # a zip file, or nothing: sys.path may name anything
        return []


def _key(name: str) -> str:
    """Return the normalized name of a distribution, also from its ``name-version.dist-info``."""
    for end in _METADATA:
        if name.endswith(end):
            name = name.removesuffix(end).partition("-")[0]
    return re.sub(r"[-_.]+", "-", name).lower()


def _entry_points_bytes(folder: str) -> bytes:
    path = f"{folder}/entry_points.txt"
    if not os.access(path, os.R_OK):
        return b""  # as most packages, of which there may be hundreds: an error would take longer
    try:
        with open(path, "rb", buffering=0) as file:
            return file.read()
    except OSError:
        return b""


def _files(folder: str) -> Iterator[Installed]:
    """Yield the definition files of the distribution with this metadata folder."""
    from importlib.metadata import Distribution  # the few that get here pay for it

    about = Distribution.at(folder)
    name, version = about.metadata["Name"], about.version
    try:
        points = sorted(about.entry_points.select(group=GROUP), key=lambda point: point.name)
    except (TypeError, ValueError, AttributeError) as error:
        what = f"{folder}/entry_points.txt cannot be read: {error}"
        raise DefinitionsError(f"{name} {version}: {what}{_reinstall_hint(name)}") from None
    for point in points:
        try:
            paths = definitions_files(point.value)
        except DefinitionsError as error:
            what = f"entry point {point.name} = {point.value}: {error}"
            raise DefinitionsError(f"{name} {version}: {what}{_reinstall_hint(name)}") from None
        yield from (Installed(name, version, path) for path in paths)


def _reinstall_hint(distribution: str) -> str:
    return f"; correct and reinstall it, or: pip uninstall {distribution}"


def definitions_files(package: str) -> list[str]:
    """Return the ``*.vocab`` files directly in a package, found without importing it.

    Raises DefinitionsError if there is no such package or no file in it.
    """
    top, *below = package.split(".")
    if not all(word.isidentifier() for word in (top, *below)):
        raise DefinitionsError(f"{package!r} is no package's name; write it as in an import")
    places = [os.path.join(place, *below) for place in _places(top)]
    folders = [place for place in places if os.path.isdir(place)]
    if not folders:
        raise DefinitionsError(f"there is no package {package!r}; install it, or correct the name")
    files = [os.path.join(f, name) for f in folders for name in _definition_files(f)]
    if not files:
        raise DefinitionsError(f"no *.vocab file in {folders[0]}, is it in the package data?")
    return files


def _places(package: str) -> list[str]:
    """Return the folders of a top-level package: one, or more of a namespace package."""
    from importlib.util import find_spec

    try:
        spec = find_spec(package)
    except (ImportError, ValueError):
        return []
    return list(spec.submodule_search_locations or ()) if spec else []


def _definition_files(folder: str) -> list[str]:
    try:
        return sorted(name for name in os.listdir(folder) if name.endswith(".vocab"))
    except OSError as error:
        raise DefinitionsError(f"{folder} cannot be read, permit it: {error.strerror}") from None
