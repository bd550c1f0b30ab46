# SPDX-License-Identifier: Apache-2.0
"""Checkouts of vendors' repositories as packages that are found as installed ones.

MULTIBOT_SOURCES names a folder with the checkouts.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

import pytest

VARIABLE = "MULTIBOT_SOURCES"
WITHOUT = f"no vendors' sources: set {VARIABLE} to a folder with their checkouts"
EMPTY = """\
from launch import LaunchDescription


def generate_launch_description():
    return LaunchDescription([])
"""
_NAME = re.compile(r"<name>\s*([\w-]+)\s*</name>")


def sources_folder() -> Path | None:
    """Return the folder with the checkouts; None if none is named."""
    folder = os.environ.get(VARIABLE, "")
    return Path(folder).resolve() if folder else None


def packages_below(folder: Path) -> dict[str, Path]:
    """Name and folder of every package; the first of a name counts."""
    found: dict[str, Path] = {}
    for at, _, names in sorted(os.walk(folder, followlinks=True)):
        if "package.xml" in names:
            text = (Path(at) / "package.xml").read_text(encoding="utf-8", errors="replace")
            name = _NAME.search(text)
            if name:
                found.setdefault(name[1], Path(at))
    return found


def install(
    packages: Mapping[str, Path], prefix: Path, empty: Mapping[str, Iterable[str]]
) -> dict[str, str]:
    """Make packages known below a prefix, with empty launch files where they are named; the
    environment in which they are found."""
    index = prefix / "share/ament_index/resource_index/packages"
    index.mkdir(parents=True)
    for name in {*packages, *empty}:
        (index / name).touch()
        share = prefix / "share" / name
        share.mkdir()
        for path in packages[name].iterdir() if name in packages else ():
            if not any(it.partition("/")[0] == path.name for it in empty.get(name, ())):
                (share / path.name).symlink_to(path)
        for file in empty.get(name, ()):
            (share / file).parent.mkdir(parents=True, exist_ok=True)
            (share / file).write_text(EMPTY)
    python = [
        str(path) for name, path in packages.items() if (path / name / "__init__.py").exists()
    ]
    above = {key: os.environ.get(key, "") for key in ("AMENT_PREFIX_PATH", "PYTHONPATH")}
    return {
        "AMENT_PREFIX_PATH": os.pathsep.join(
            filter(None, (str(prefix), above["AMENT_PREFIX_PATH"]))
        ),
        "PYTHONPATH": os.pathsep.join(filter(None, (above["PYTHONPATH"], *python))),
    }


def installed_sources(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Yield the folder of checkouts, with its packages to be found as installed ones."""
    folder = sources_folder()
    if folder is None:
        pytest.skip(WITHOUT)
    environment = install(packages_below(folder), tmp_path_factory.mktemp("sources") / "prefix", {})
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("AMENT_PREFIX_PATH", environment["AMENT_PREFIX_PATH"])
        yield folder
