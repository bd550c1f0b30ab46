# SPDX-License-Identifier: Apache-2.0
"""Put a robot's name into all names that robots must not share, and verify it."""

from __future__ import annotations

from multibot_rewrite.version import __version__ as __version__

# For checkers of types, as typing has it. Nothing is imported here: Ctrl-C is not quiet before the
# command begins, and to import typing or importlib takes longer than all else until then.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from multibot_rewrite.base.findings.finding import Finding, RewriteRefused
    from multibot_rewrite.base.model import (
        Change,
        DefinitionsError,
        InputError,
        MultibotError,
        ProofError,
        Unusable,
        UsageError,
    )
    from multibot_rewrite.description.joining.part import Part
    from multibot_rewrite.description.library import Rewrite, explain, rewrite, rewrite_all, strip
    from multibot_rewrite.fleet.robots.loaded_robot import LoadedRobot
    from multibot_rewrite.library.loaded_fleet import LoadedFleet, load_fleet
    from multibot_rewrite.library.one_file import RewrittenFile, rewrite_file, rewrite_files
    from multibot_rewrite.library.systems import (
        compare,
        judge,
        system_of_bag,
        system_of_description,
        system_of_files,
        system_of_fleet,
        system_of_folder,
        system_of_graph,
        system_of_launch,
    )
    from multibot_rewrite.refactor.adopt import Adopted, adopt
    from multibot_rewrite.refactor.rename import Renaming, rename_symbol
    from multibot_rewrite.related_files.join import Joined, join, split
    from multibot_rewrite.system.records import System

__all__ = [
    "Adopted",
    "Change",
    "DefinitionsError",
    "Finding",
    "InputError",
    "Joined",
    "LoadedFleet",
    "LoadedRobot",
    "MultibotError",
    "Part",
    "ProofError",
    "Renaming",
    "Rewrite",
    "RewriteRefused",
    "RewrittenFile",
    "System",
    "Unusable",
    "UsageError",
    "adopt",
    "compare",
    "explain",
    "join",
    "judge",
    "load_fleet",
    "rename_symbol",
    "rewrite",
    "rewrite_all",
    "rewrite_file",
    "rewrite_files",
    "split",
    "strip",
    "system_of_bag",
    "system_of_description",
    "system_of_files",
    "system_of_fleet",
    "system_of_folder",
    "system_of_graph",
    "system_of_launch",
]  # fmt: skip
_SOURCES = ("bag", "description", "files", "fleet", "folder", "graph", "launch")
_HOMES = {
    "base.findings.finding": ("Finding", "RewriteRefused"),
    "related_files.join": ("Joined", "join", "split"),
    "description.joining.part": ("Part",),
    "description.library": ("Rewrite", "explain", "rewrite", "rewrite_all", "strip"),
    "library.systems": ("compare", "judge", *(f"system_of_{it}" for it in _SOURCES)),
    "library.one_file": ("RewrittenFile", "rewrite_file", "rewrite_files"),
    "fleet.robots.loaded_robot": ("LoadedRobot",),
    "library.loaded_fleet": ("LoadedFleet", "load_fleet"),
    "refactor.adopt": ("Adopted", "adopt"),
    "refactor.rename": ("Renaming", "rename_symbol"),
    "system.records": ("System",),
}


def __getattr__(name: str) -> object:
    # A command loads what it needs: each of them starts by importing this package.
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    home = next((it for it, names in _HOMES.items() if name in names), "base.model")
    return getattr(import_module(f"{__name__}.{home}"), name)
