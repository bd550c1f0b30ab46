# SPDX-License-Identifier: Apache-2.0
"""Chains of names, where each name leads to the next."""

from __future__ import annotations

from collections.abc import Mapping


def chain_ends(next_of: Mapping[str, str]) -> dict[str, str]:
    """Return what each name leads to in the end; an empty string for one that leads into a circle.

    Each name is passed once, however long the chains are.
    """
    ends: dict[str, str] = {}
    for start in next_of:
        passed: dict[str, None] = {}
        name = start
        while name in next_of and name not in ends and name not in passed:
            passed[name] = None
            name = next_of[name]
        end = "" if name in passed else ends.get(name, name)
        ends.update(dict.fromkeys(passed, end))
    return ends
