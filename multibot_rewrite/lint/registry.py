# SPDX-License-Identifier: Apache-2.0
"""All rules, by code."""

from __future__ import annotations

from multibot_rewrite.lint.groups import GROUPS, rules_of

_FOUND = [rule for group in GROUPS for rule in rules_of(group)]
RULES = {it.code: it for it in sorted(_FOUND, key=lambda it: it.code)}
assert len(RULES) == len(_FOUND), "two rules have one code"
