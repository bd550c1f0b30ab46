"""Rewrite a robot description for one robot or many, and prove that nothing was missed."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from multibot_rewrite.version import __version__ as __version__

if TYPE_CHECKING:
    from multibot_rewrite.library import Rewrite, explain, rewrite, rewrite_all, strip
    from multibot_rewrite.model import (
        Change,
        Finding,
        InputError,
        MultibotError,
        ProofError,
        RewriteRefused,
        UsageError,
        VocabularyError,
    )

__all__ = [
    "Change",
    "Finding",
    "InputError",
    "MultibotError",
    "ProofError",
    "Rewrite",
    "RewriteRefused",
    "UsageError",
    "VocabularyError",
    "explain",
    "rewrite",
    "rewrite_all",
    "strip",
]
_LIBRARY = frozenset({"Rewrite", "explain", "rewrite", "rewrite_all", "strip"})


def __getattr__(name: str) -> object:
    # A command loads what it needs: each of them starts by importing this package.
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = "library" if name in _LIBRARY else "model"
    return getattr(import_module(f"{__name__}.{module}"), name)
