# SPDX-License-Identifier: Apache-2.0
"""Real robot files: the corpus beside the repository, and installed description packages."""

from __future__ import annotations

import importlib.metadata
from collections.abc import Iterator, Mapping
from functools import cache
from itertools import islice
from pathlib import Path

from paths import CORPUS

WHEELS = (
    "airo-models",
    "dexmate-urdf",
    "hello-robot-stretch-urdf",
    "hex-util-urdf",
    "icub-models",
    "robot-properties-fingers",
)
OPTIONAL_WHEELS = ("example-robot-data",)


@cache
def corpus_files() -> dict[str, Path]:
    """Every URDF of the corpus, by its path there; empty where there is none."""
    home = CORPUS / "urdf"
    return {str(path.relative_to(home)): path for path in sorted(home.rglob("*.urdf"))}


@cache
def wheel_files() -> dict[str, Path]:
    """Every URDF of the installed description wheels."""
    found: dict[str, Path] = {}
    for name in (*WHEELS, *OPTIONAL_WHEELS):
        found |= {f"{name}/{path.as_posix().lstrip('./')}": full for path, full in _urdfs(name)}
    return found


def _urdfs(name: str) -> Iterator[tuple[importlib.metadata.PackagePath, Path]]:
    try:
        wheel = importlib.metadata.distribution(name)
    except importlib.metadata.PackageNotFoundError:
        return
    for path in sorted(wheel.files or ()):
        if path.suffix == ".urdf":
            yield path, Path(str(wheel.locate_file(path))).resolve()


def spread(files: Mapping[str, Path], count: int) -> dict[str, Path]:
    """About ``count`` of the files, at equal distances."""
    step = max(1, len(files) // count)
    return dict(islice(list(files.items())[::step], count))
