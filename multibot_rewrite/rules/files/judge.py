# SPDX-License-Identifier: Apache-2.0
"""A related file of a description -> what the rules for its kind find in it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import cache
from typing import Any

from multibot_rewrite.base.findings.finding import WARNING, Finding, Rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.related_files.named_file import PARAMS, NamedFile
from multibot_rewrite.rules import declaration
from multibot_rewrite.rules.declaration import rules_in
from multibot_rewrite.rules.description import names as description_names, rewriting
from multibot_rewrite.rules.description.files import reading, values
from multibot_rewrite.rules.description.multirobot import named_robots
from multibot_rewrite.rules.files import (
    controllers,
    declared,
    demands,
    names,
    plugin_names,
    rcl_rules,
    ros_names,
    same_for_all,
)
from multibot_rewrite.rules.system import clocks


def _rule_of_files(
    asked: Rule, *finders: Callable[[NamedFile], Iterator[Finding]], **changed: Any
) -> Rule:
    """Return a rule of files that a rule of descriptions stands for: any of the finders reports it."""

    def found(file: NamedFile) -> Iterator[Finding]:
        for find in finders:
            yield from find(file)

    return asked._replace(check=found, **changed)


_UNREADABLE = declared.wrong_types, rcl_rules.rejected_values, rcl_rules.outside_of_marks
SHARED = (
    _rule_of_files(reading.leftover, ros_names.placeholders, ros_names.unfilled),
    _rule_of_files(description_names.invalid_ros_name, ros_names.invalid_names),
    _rule_of_files(description_names.leading_slash, ros_names.slashes),
    _rule_of_files(rewriting.unclaimed_mention, names.unknown_uses),
    _rule_of_files(
        values.misspelt,
        declared.unknown_parameters,
        rcl_rules.misspelt_marks,
        plugin_names.renamed_nodes,
    ),
    _rule_of_files(
        values.not_read, declared.not_read, declared.below_unknown_names, declared.in_the_manager
    ),
    _rule_of_files(values.missing, plugin_names.without_plugin, plugin_names.missing_parameters),
    _rule_of_files(values.unreadable_value, *_UNREADABLE, level=WARNING),
    _rule_of_files(values.unknown_word, plugin_names.unknown_classes),
    _rule_of_files(clocks.clocks_mixed, rcl_rules.mixed_clocks, level=WARNING, formats=(PARAMS,)),
    _rule_of_files(declaration.ONE_DEVICE, same_for_all.one_device, formats=(PARAMS,)),
    _rule_of_files(
        declaration.NOT_EXPORTED, controllers.not_exported, formats=(PARAMS,), options={}
    ),
    _rule_of_files(named_robots.prefix_only, same_for_all.prefix_only),
    _rule_of_files(
        values.out_of_range, declared.out_of_bounds, demands.above_others, level=WARNING
    ),
)
# Up to a reason, which is behind a dash.
_COMMENT = lazy_compile(r"(?:#|--)\s*urdf-lint:\s*ignore\s+((?:MB\d+[,\s]*)+)(?:$|[-:])")


@cache
def rules_for(kind: str) -> tuple[Rule, ...]:
    """Return the rules for files of a kind, by their codes."""
    return tuple(sorted((it for it in _all_rules() if kind in it.formats), key=lambda it: it.code))


@cache
def codes() -> frozenset[str]:
    """Return the codes of all rules for files."""
    return frozenset(it.code for it in _all_rules())


def _all_rules() -> Iterator[Rule]:
    yield from (*rules_in("files"), *SHARED)


def judged(file: NamedFile, rules: Iterable[Rule]) -> Iterator[Finding]:
    """Yield what rules find in a file, without what a comment at the end of a line silences."""
    lines = file.text.split("\n")
    for rule in rules:
        for it in rule.check(file) if rule.check else ():
            # The codes in a comment at the end of a line.
            line = lines[it.line - 1]
            found = _COMMENT.search(line) if "urdf-lint" in line else None
            if rule.code not in (found[1].replace(",", " ").split() if found else []):
                said = it.hint or rule.advice
                level = it.level or rule.level
                yield it._replace(code=rule.code, level=level, hint=said, file=file.file)


def judged_once(file: NamedFile) -> list[Finding]:
    """Return what all rules find in a file, each finding at its first place, ordered by place."""
    first: dict[tuple[str, str], Finding] = {}
    for it in sorted(judged(file, rules_for(file.kind)), key=lambda it: (it.line, it.column)):
        first.setdefault((it.code, it.message), it)
    return list(first.values())
