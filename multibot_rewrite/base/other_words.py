# SPDX-License-Identifier: Apache-2.0
"""Words that people write for what is called otherwise here."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from multibot_rewrite.base.bounded import load_own_yaml


@cache
def other_words(what: str) -> Mapping[str, str]:
    """Return the table of ``commands``, ``options`` or ``keys``: each word, and what does it."""
    words: Mapping[str, str] = load_own_yaml(__file__, "other_words.yaml")[what]
    return words
