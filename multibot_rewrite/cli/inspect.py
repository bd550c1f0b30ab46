"""``multibot inspect``: what is known of a plugin, of descriptions, of a xacro's arguments."""

from __future__ import annotations

import argparse
import os

from multibot_rewrite.cli import coverage, vocabulary
from multibot_rewrite.cli.usage import plain_words, xacro_args

# A word that ends so is a file, there or not.
_FILES = (".urdf", ".sdf", ".srdf", ".xacro", ".xml")


def run(options: argparse.Namespace) -> int:
    """Look up a name, look at files, or draft what is missing; returns the exit code."""
    if options.suggest is not None:
        return vocabulary.draft(options)
    words = plain_words(options)
    if len(words) > 1 or xacro_args(options) or any(map(_is_path, words)):
        return coverage.run(options)
    return vocabulary.show(options, next(iter(words), None))


def _is_path(word: str) -> bool:
    return os.path.lexists(word) or word.endswith(_FILES)
