"""Rewrite a robot description for one robot or many, and prove that nothing was missed."""

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

__version__ = "0.1.0"

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
