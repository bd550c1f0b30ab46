# SPDX-License-Identifier: Apache-2.0
"""A launch file by its package and name, as ``ros2 launch`` finds it.

Source: ros2launch api.py get_share_file_path_from_package (any file of that name below the package's
share folder; none and several are errors).
"""

from __future__ import annotations

import os
from collections.abc import Iterator

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.description.sources.packages import package_folders

ROOTS = "source its workspace, or give the folder of its sources with --roots (launch_roots:)"


def file_of_package(package: str, name: str, roots: tuple[str, ...]) -> str:
    """The path of a file in a package that is installed or, as sources, below ``roots``.

    Raises UsageError where there is no such package, and not one file of that name in it.
    """
    # What is installed counts first, as for the includes of a launch.
    folders = package_folders(package, os.sep, ()) or package_folders(package, os.sep, roots)
    if not folders:
        raise UsageError(f"launch {package} {name}: package {package!r} is not found; {ROOTS}")
    found = sorted(_called(name, folders[0]))
    if len(found) == 1:
        return found[0]
    if found:
        both = " and ".join(os.path.relpath(it, folders[0]) for it in found[:2])
        raise UsageError(f"launch {package} {name}: it has {both}; give the path of one")
    raise UsageError(f"launch {package} {name}: {folders[0]} has no such file; correct the name")


def _called(name: str, folder: str) -> Iterator[str]:
    for above, folders, files in os.walk(folder):
        folders[:] = [it for it in folders if not it.startswith(".")]
        yield from (os.path.join(above, it) for it in files if it == name)
